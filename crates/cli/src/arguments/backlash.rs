//! Arguments of `armill backlash`.
//!
//! `--circles` and `--simulate` do not estimate backlash; they exclude each other.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

const AFTER: &str = "\
STUDY contains circles (analyses of kind = \"path\") and, to estimate backlash, the ball-bar records measured on them:
[[ballbar]] with the keys analysis and files. Its keys zero_deg and mirrored convert the angles of the files to those of \
the circle.
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
    /// Highest lobe (per revolution) removed from each circle; lobes up to this one are not attributed to backlash
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub lobes: usize,
    /// Standard deviation of the noise of a sample [default: from the residuals; 1 with --circles, 0 with --simulate]
    #[arg(long, value_name = "UM")]
    pub noise_um: Option<f64>,
    /// Propose N circles to measure in addition to those of the study
    #[arg(long, value_name = "N", conflicts_with = "simulate")]
    pub circles: Option<usize>,
    /// Half the size of the box of proposed centres, about the centre of the first circle of the study (with --circles)
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        default_value = "200,200,200"
    )]
    pub within_mm: Vec<f64>,
    /// Radii of the proposed circles (with --circles) [default: that of the first circle, and 1.5 times that]
    #[arg(long, value_name = "R,...", value_delimiter = ',')]
    pub radii_mm: Vec<f64>,
    /// Write ball-bar records predicted from the robot file into this folder, one file per circle
    #[arg(long, value_name = "FOLDER")]
    pub simulate: Option<PathBuf>,
    /// Runs in each direction (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub runs: usize,
    /// Seed of the noise (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Name of a circle of the study (with --circles or --simulate; repeatable) [default: all circles]
    #[arg(long, value_name = "NAME")]
    pub analysis: Vec<String>,
    /// Folder for the result, the table and the pictures [default: nothing is written]
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["circles", "simulate"])]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
