//! Arguments of `armill pose-accuracy`.

use std::path::PathBuf;

use clap::Args;

use super::poses::PosesOptions;
use super::robots::ROBOT_HELP;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
FILE has one row for each visit of a pose: joint positions (q1_deg ...), the measured point in tracker axes (x_mm, y_mm, \
z_mm) and, if known, the columns pose, direction, rx_deg ... Guide: docs/guide/calibrate.md

Examples:
  armill pose-accuracy poses.csv --robot universal-robots/ur10
  armill pose-accuracy tracker.csv --robot arm.toml --columns \"x_mm=Measured X,y_mm=Measured Y,z_mm=Measured Z\" --json"
)]
pub(crate) struct PoseAccuracyArguments {
    /// Measured poses (CSV)
    pub file: PathBuf,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    #[command(flatten)]
    pub poses: PosesOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
