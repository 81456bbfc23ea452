//! `armill compensate STUDY`: the paths that must be commanded so that the tool goes where it is drawn.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill compensate cell                   every path of the study, into cell/compensated
  armill compensate cell --ask ring --out fixed
The table NAME.commanded.csv is a path that `program.file` of a study reads, with spin = \"given\".")]
pub(crate) struct CompensateArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// The path to compensate, by its name (every path if left out)
    #[arg(long, value_name = "NAME")]
    pub ask: Option<String>,
    /// Folder for the results (STUDY/compensated if left out)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the answer as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
