//! Arguments of `armill budget`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

const AFTER: &str = "\
Compares the measurements of a circle of the study ([measured]: the profile of the part, circular tests without load) \
with the deviation predicted under load. Reports each contribution to the error with its bias and scatter, their sums, \
and how much of the measured error they explain, also per harmonic. Guide: docs/guide/budget.md

Examples:
  armill budget experiment
  armill budget experiment --out budget
  armill budget experiment --json";

#[derive(Debug, Args)]
#[command(after_help = AFTER)]
pub(crate) struct BudgetArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Folder for the table and the pictures [default: nothing is written]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
