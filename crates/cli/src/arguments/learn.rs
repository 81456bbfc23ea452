//! Arguments of `armill learn`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::poses::PosesOptions;
use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
POSES_FILE as for `armill calibrate`: joint positions and the measured point. The chain is calibrated, and what the calibrated \
chain leaves is learnt as a function of the joint positions. Each stretch of the file is held out once, and predicted from the \
others with the nominal, the calibrated and the learnt model.
Guide: docs/guide/learn.md

Examples:
  armill learn poses.csv --robot staubli/tx90 --out my-tx90.toml
  armill learn poses.csv --robot arm.toml --other path.csv --drawing errors.svg --json
  armill learn poses.csv --robot my-calibrated.toml --unknowns none --stretches 10"
)]
pub(crate) struct LearnArguments {
    /// Measured poses (CSV)
    pub poses_file: PathBuf,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// Parameters of the chain that are calibrated before
    #[arg(long, value_enum, default_value_t = LearnUnknownsArgument::Geometry)]
    pub unknowns: LearnUnknownsArgument,
    /// Prior: standard deviation of the lengths from nominal
    #[arg(long, value_name = "MM", default_value_t = 0.5)]
    pub prior_mm: f64,
    /// Prior: standard deviation of the angles
    #[arg(long, value_name = "DEG", default_value_t = 0.05)]
    pub prior_deg: f64,
    /// Number of stretches of POSES_FILE, each held out once
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub stretches: usize,
    /// Predict other poses too: another file, measured from any position of the tracker
    #[arg(long, value_name = "FILE")]
    pub other: Option<PathBuf>,
    /// The measured point was not mounted again for the other file
    #[arg(long, requires = "other")]
    pub same_point: bool,
    #[command(flatten)]
    pub poses: PosesOptions,
    /// Write the calibrated robot with the learnt residual to this file, and the residuals to its folder
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write a drawing of the errors to this file (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Parameters to calibrate before learning.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LearnUnknownsArgument {
    /// Joint zeros, lengths and angles
    Geometry,
    /// Joint zeros
    Zeros,
    /// None: base and tool only
    None,
}
