//! What can be typed behind `armill backlash`.
//!
//! `--circles` and `--simulate` ask for something else than the gaps, and exclude each other.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

const AFTER: &str = "\
STUDY has circles (asks of kind = \"path\") and, for the gaps, what a ball-bar measured on them: [[ballbar]] with ask and files.
Angles of the files are turned onto the circle by zero_deg and mirrored. The guide: docs/guide/ballbar.md

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
    /// Lobes a turn that are no backlash and taken off each circle
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub lobes: usize,
    /// Standard deviation of a sample [gaps: from the residuals; --circles: 1; --simulate: 0]
    #[arg(long, value_name = "UM")]
    pub noise_um: Option<f64>,
    /// Propose N circles to drive beside those of the study
    #[arg(long, value_name = "N", conflicts_with = "simulate")]
    pub circles: Option<usize>,
    /// Half of the box of their centres about the first circle of the study (with --circles)
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        default_value = "200,200,200"
    )]
    pub within_mm: Vec<f64>,
    /// Their radii (with --circles) [that of the first circle, and one and a half of it]
    #[arg(long, value_name = "R,...", value_delimiter = ',')]
    pub radii_mm: Vec<f64>,
    /// Write what a ball-bar would show of the robot file into this folder, a file a circle
    #[arg(long, value_name = "FOLDER")]
    pub simulate: Option<PathBuf>,
    /// Runs each way (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub runs: usize,
    /// Seed of the noise (with --simulate)
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Circles of the study, by name, where not all are meant (with --circles and --simulate)
    #[arg(long, value_name = "NAME")]
    pub analysis: Vec<String>,
    /// Folder for answer, table and pictures (nothing is written if left out)
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["circles", "simulate"])]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Machine-readable answer and errors
    #[arg(long)]
    pub json: bool,
}
