//! Arguments of `armill backlash`.
//!
//! `--circles` and `--simulate` do not estimate backlash; they exclude each other.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

const AFTER: &str = "\
STUDY has circles (analyses of kind = \"path\") and, to estimate backlash, the ball-bar records measured on them:
[[ballbar]] with analysis and files. zero_deg and mirrored relate the angles of the files to the circle.
Guide: docs/guide/ballbar.md

Examples:
  armill backlash cell
  armill backlash cell --out backlash
  armill backlash cell --circles 3
  armill backlash cell --simulate runs --noise-um 2 --seed 7";

#[derive(Debug, Args)]
#[command(after_help = AFTER)]
pub(crate) struct BacklashArguments {
    /// Folder with a study.toml, the file itself, or the name of an example study
    pub study: PathBuf,
    /// Lobes per revolution that are removed from each circle because they are not caused by backlash
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub lobes: usize,
    /// Standard deviation of a sample [estimate: from the residuals; --circles: 1; --simulate: 0]
    #[arg(long, value_name = "UM")]
    pub noise_um: Option<f64>,
    /// Propose N circles to measure in addition to those of the study
    #[arg(long, value_name = "N", conflicts_with = "simulate")]
    pub circles: Option<usize>,
    /// Half the size of the box for their centres, about the first circle of the study (with --circles)
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        default_value = "200,200,200"
    )]
    pub within_mm: Vec<f64>,
    /// Their radii (with --circles) [that of the first circle, and 1.5 times it]
    #[arg(long, value_name = "R,...", value_delimiter = ',')]
    pub radii_mm: Vec<f64>,
    /// Simulate the ball-bar records of the robot file and write them into this folder, one file per circle
    #[arg(long, value_name = "FOLDER")]
    pub simulate: Option<PathBuf>,
    /// Runs in each direction (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub runs: usize,
    /// Seed of the noise (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Circles of the study, by name; all if not given (with --circles and --simulate)
    #[arg(long, value_name = "NAME")]
    pub analysis: Vec<String>,
    /// Folder for the result, the table and the pictures (nothing is written if not given)
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["circles", "simulate"])]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result and errors as JSON
    #[arg(long)]
    pub json: bool,
}
