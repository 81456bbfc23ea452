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
POSES_FILE has one row per pose: joint positions (q1_deg ...) and the measured point in tracker axes (x_mm, y_mm, z_mm).
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
    /// Validate with other poses: a file, or a fraction of POSES_FILE that is set aside, such as 0.2
    #[arg(long, value_name = "FILE|FRACTION")]
    pub validation: Option<String>,
    /// The validation file was measured with the same tracker position and the same point on the flange
    #[arg(long, requires = "validation")]
    pub same_set_up: bool,
    /// Prior: standard deviation of the lengths from nominal for robots of this type (with --prior-deg)
    #[arg(long, value_name = "MM", requires = "prior_deg")]
    pub prior_mm: Option<f64>,
    /// Prior: standard deviation of the angles (with --prior-mm); poorly determined parameters then stay near nominal
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
    /// Write a drawing of the errors before and after calibration to this file (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
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
