//! Arguments of `armill run`.
//!
//! The study defines what is computed; options only define where and how much is written, and the number of
//! threads.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill run studies/mh12-groove
  armill run cell/study.toml --out results --no-pictures
  armill run cell --json --strict && echo \"the tolerance is met everywhere\"")]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub run: RunOptions,
}

// Options of every command that runs a study.
#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Folder for the results [default: a folder next to the study, named by command: out, posture, ...]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write tables only: no pictures, no report
    #[arg(long)]
    pub no_pictures: bool,
    /// Also write CSV files of series and volumes, not only of maps and paths
    #[arg(long)]
    pub csv: bool,
    /// Number of threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with code 1 unless every point is within the tolerance and inside the joint limits
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print all results as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
