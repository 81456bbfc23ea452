//! Arguments of `armill new`.
//!
//! The folder may exist, a study in it may not. `--robot` is the robot of the new study; an example has its own.

use std::path::PathBuf;

use clap::Args;

use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill new cell
  armill new cell --robot kuka/kr120r2500pro
  armill new pocket --example r2000ic-pocket")]
pub(crate) struct NewArguments {
    /// Folder to create
    pub dir: PathBuf,
    #[arg(long, value_name = "NAME", default_value = "yaskawa/mh12", help = ROBOT_HELP)]
    pub robot: String,
    /// Copy this example with all of its files: mh12-groove, kr120-groove, r2000ic-pocket, kr210-rivets, mh12-ballbar,
    /// r2000ic-measured
    #[arg(long, value_name = "NAME", conflicts_with = "robot")]
    pub example: Option<String>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print what was created as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
