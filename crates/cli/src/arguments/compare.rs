//! What can be typed behind `armill compare`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill compare cell-a cell-b                              two set-ups, asks of the same name side by side
  armill compare cell --robot kuka/kr120r2500pro --robot yaskawa/mh50
  armill compare studies/* --out decision --json
A robot in place of a study's own brings its own compliances, or assumed ones by its payload; part, tool and load stay.")]
pub(crate) struct CompareArguments {
    /// Studies: folders with a study.toml, files, or names of example studies
    #[arg(required = true, value_name = "STUDY")]
    pub studies: Vec<PathBuf>,
    /// A robot in place of that of each study, as a further cell (repeatable): library name or robot file
    #[arg(long = "robot", value_name = "NAME")]
    pub robots: Vec<String>,
    /// Folder for the results (compare beside the first study if left out)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write the table only: no pictures, no report
    #[arg(long)]
    pub no_pictures: bool,
    /// Threads to use (all processors if left out)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the whole comparison as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
