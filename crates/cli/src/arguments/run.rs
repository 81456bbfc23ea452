//! What can be typed behind `armill run`.
//!
//! What is computed stands in the study; options only say where it goes, how much of it, and on how many
//! threads.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill run studies/mh12-groove
  armill run cell/study.toml --out results --no-pictures
  armill run cell --json --strict && echo \"the tolerance holds everywhere\"")]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub run: RunOptions,
}

// What every command that runs a study takes.
#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Folder for the results (beside the study if left out: out, posture, ... by the command)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write tables only: no pictures, no report
    #[arg(long)]
    pub no_pictures: bool,
    /// Write a CSV of series and volumes too, not of maps and paths only
    #[arg(long)]
    pub csv: bool,
    /// Threads to use (all processors if left out)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with 1 unless every point holds the tolerance
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the whole result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
