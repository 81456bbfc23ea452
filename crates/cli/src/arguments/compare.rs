//! Arguments of `armill compare`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill compare cell-a cell-b                              two set-ups; analyses of the same name are compared
  armill compare cell --robot kuka/kr120r2500pro --robot yaskawa/mh50
  armill compare studies/* --out decision --json
A robot given with --robot has its own compliances or, if they are not known, those assumed for its payload; all other \
inputs are those of the study. Where robots differ, the first common path or set of holes is also compared at the best \
placement of the part for each robot.")]
pub(crate) struct CompareArguments {
    /// Studies: folders with a study.toml, files, or names of example studies
    #[arg(required = true, value_name = "STUDY")]
    pub studies: Vec<PathBuf>,
    /// Add, for each study, a cell with this robot in place of its own (repeatable): library name or robot file
    #[arg(long = "robot", value_name = "NAME")]
    pub robots: Vec<String>,
    /// Compare at the given placement only: no search for the best placement of the part for each robot
    #[arg(long)]
    pub given_placement: bool,
    /// Folder for the results [default: compare, next to the first study]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write tables only: no pictures, no report
    #[arg(long)]
    pub no_pictures: bool,
    /// Number of threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the whole comparison as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
