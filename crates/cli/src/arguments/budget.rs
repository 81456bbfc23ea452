//! What can be typed behind `armill budget`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

const AFTER: &str = "\
Puts what was measured on a circle of the study ([measured]: the profile of the part, circular tests of the path without
load) beside the deviation that is predicted under load: each part of the error with bias and scatter, their sums, how
much of the part they explain, wave by wave. The guide: docs/guide/budget.md

Examples:
  armill budget experiment
  armill budget experiment --out budget
  armill budget experiment --json";

#[derive(Debug, Args)]
#[command(after_help = AFTER)]
pub(crate) struct BudgetArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Folder for table and pictures (nothing is written if left out)
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Machine-readable answer and errors
    #[arg(long)]
    pub json: bool,
}
