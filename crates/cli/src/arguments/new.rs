//! What can be typed behind `armill new`.
//!
//! The folder may exist, a study in it may not. The robot is the one that the new study names.

use std::path::PathBuf;

use clap::Args;

use super::ROBOT_HELP;

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  armill new cell
  armill new cell --robot kuka/kr120r2500pro")]
pub(crate) struct NewArguments {
    /// Folder to make
    pub dir: PathBuf,
    #[arg(long, value_name = "NAME", default_value = "yaskawa/mh12", help = ROBOT_HELP)]
    pub robot: String,
    /// Print what was made as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
