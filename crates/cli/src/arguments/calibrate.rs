//! Arguments of `armill calibrate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::poses::PosesOptions;
use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
POSES has one row per pose: joint positions (q1_deg ...) and the measured point in tracker axes (x_mm, y_mm, z_mm).
Guide: docs/guide/calibrate.md

Examples:
  armill calibrate poses.csv --robot yaskawa/mh12 --validation 0.2 --out my-mh12.toml
  armill calibrate poses.csv --robot arm.toml --validation others.csv --residuals residuals.csv --json
  armill calibrate few.csv --robot arm.toml --prior-mm 0.5 --prior-deg 0.05 --validation 0.3 --drawing errors.svg"
)]
pub(crate) struct CalibrateArguments {
    /// Measured poses (CSV)
    pub poses_file: PathBuf,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// Parameters to identify
    #[arg(long, value_enum, default_value_t = UnknownsArgument::Geometry)]
    pub unknowns: UnknownsArgument,
    /// Validate with other poses: a file, or a fraction of this one, such as 0.2
    #[arg(long, value_name = "FILE|PART")]
    pub validation: Option<String>,
    /// The tracker and the measured point had the same position for the validation file
    #[arg(long, requires = "validation")]
    pub same_set_up: bool,
    /// Standard deviation of the lengths of robots of this type from nominal; with --prior-deg
    #[arg(long, value_name = "MM", requires = "prior_deg")]
    pub prior_mm: Option<f64>,
    /// Standard deviation of their angles: parameters that the poses hardly determine stay near nominal
    #[arg(long, value_name = "DEG", requires = "prior_mm")]
    pub prior_deg: Option<f64>,
    #[command(flatten)]
    pub poses: PosesOptions,
    /// Write the calibrated robot to this file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the residuals of all poses to this file (CSV)
    #[arg(long, value_name = "FILE")]
    pub residuals: Option<PathBuf>,
    /// Draw the errors before and after calibration to this file (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Parameters to identify.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnknownsArgument {
    /// Joint zeros, lengths and angles
    Geometry,
    /// Joint zeros
    Zeros,
}
