//! What can be typed behind `armill calibrate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::ROBOT_HELP;
use super::poses::PosesOptions;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
POSES has one row a pose: joint positions (q1_deg ...) and the measured point in the tracker's axes (x_mm, y_mm, z_mm).
The guide: docs/guide/calibrate.md

Examples:
  armill calibrate poses.csv --robot yaskawa/mh12 --hold-out 0.2 --out my-mh12.toml
  armill calibrate poses.csv --robot arm.toml --hold-out others.csv --residuals residuals.csv --json
  armill calibrate few.csv --robot arm.toml --prior-mm 0.5 --prior-deg 0.05 --hold-out 0.3 --drawing errors.svg"
)]
pub(crate) struct CalibrateArguments {
    /// Measured poses (CSV)
    pub poses_file: PathBuf,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// What to find of the chain
    #[arg(long, value_enum, default_value_t = UnknownsArgument::Geometry)]
    pub unknowns: UnknownsArgument,
    /// Judge by other poses: a file, or a part of this one, such as 0.2
    #[arg(long, value_name = "FILE|PART")]
    pub hold_out: Option<String>,
    /// Tracker and measured point stood for the held-out file where they stood before
    #[arg(long, requires = "hold_out")]
    pub same_set_up: bool,
    /// Arms of this kind are off by so much along an axis (standard deviation); with --prior-deg
    #[arg(long, value_name = "MM", requires = "prior_deg")]
    pub prior_mm: Option<f64>,
    /// And by so much about an axis: what poses hardly tell stays near the drawing
    #[arg(long, value_name = "DEG", requires = "prior_mm")]
    pub prior_deg: Option<f64>,
    #[command(flatten)]
    pub poses: PosesOptions,
    /// Write the calibrated robot to this file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the residuals of every pose to this file (CSV)
    #[arg(long, value_name = "FILE")]
    pub residuals: Option<PathBuf>,
    /// Draw errors before and after to this file (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// What of the chain is found.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnknownsArgument {
    /// Where joints count from, lengths and angles
    Geometry,
    /// Where joints count from
    Zeros,
}
