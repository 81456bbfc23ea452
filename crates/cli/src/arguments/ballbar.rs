//! What can be typed behind `armill ballbar`.
//!
//! `--radius-mm`, `--direction`, `--start-deg`, `--feed-mm-per-min` and `--plane` tell what files do not; `--cyclic` stays text
//! until `command::ballbar` reads it, since it is a period or a word.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::program::ProgramOptions;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
FILE is a CSV whose names end in units (angle_deg,radius_dev_um,direction,run; a line `# radius_mm: 100` above), or results of
a Renishaw ball-bar (.b5r), which are shown beside. All files are of one circle. The guide: docs/guide/ballbar.md

Examples:
  armill ballbar runs.csv
  armill ballbar cw.csv ccw.csv --radius-mm 100 --plane XY --out test
  armill ballbar first.csv --teach points.csv
  armill ballbar first.csv --program ring.src --study cell --feed-mm-per-min 1000
  armill ballbar second.csv --before first.csv --json"
)]
pub(crate) struct BallbarArguments {
    /// Runs of one circle
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Nominal radius, where the files do not tell it
    #[arg(long, value_name = "MM")]
    pub radius_mm: Option<f64>,
    /// Way round of all runs, where the files do not tell it: CW or CCW
    #[arg(long, value_name = "WAY")]
    pub direction: Option<String>,
    /// Angle of the first sample, of runs without angles
    #[arg(long, value_name = "DEG")]
    pub start_deg: Option<f64>,
    /// Speed along the circle, where the files do not tell it
    #[arg(long, value_name = "MM/MIN")]
    pub feed_mm_per_min: Option<f64>,
    /// The plane by its two axes, where the files do not tell it: XY
    #[arg(long, value_name = "AXES")]
    pub plane: Option<String>,
    /// From which centre radii are counted
    #[arg(long, value_name = "CENTRE", value_enum, default_value_t = CentreChoice::LeastSquares)]
    pub centre: CentreChoice,
    /// Lobes a turn that are told and taken into account
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub lobes: usize,
    /// Look for an error that repeats along the axes: its period in mm, or `found`
    #[arg(long, value_name = "MM|found")]
    pub cyclic: Option<String>,
    /// An angle where something else reverses, both ways round (once an angle)
    #[arg(long, value_name = "DEG")]
    pub reversal_deg: Vec<f64>,
    /// The axes of the plane are no drives: they do not reverse at 0, 90, 180 and 270 deg
    #[arg(long)]
    pub no_axes: bool,
    /// Leave out samples that their neighbours contradict
    #[arg(long)]
    pub leave_out_outliers: bool,
    /// The test before this one, to compare with (once a file)
    #[arg(long, value_name = "FILE")]
    pub before: Vec<PathBuf>,
    /// Write the points of the circle to teach instead
    #[arg(long, value_name = "FILE")]
    pub teach: Option<PathBuf>,
    /// How many points to teach: 72, of a program as many as --within-um needs, if left out
    #[arg(long, value_name = "N")]
    pub points: Option<usize>,
    /// Lobes up to which the taught circle corrects
    #[arg(long, value_name = "N", default_value_t = 12)]
    pub teach_lobes: usize,
    // `--program` and what belongs to it.
    #[command(flatten)]
    pub program: ProgramOptions,
    /// The study that has the circle, for --program
    #[arg(long, value_name = "STUDY")]
    pub study: Option<PathBuf>,
    /// Name of the circle in that study, where it has several
    #[arg(long, value_name = "NAME", requires = "study")]
    pub analysis: Option<String>,
    /// Where angle 0 of the files lies on the circle, from its +y' towards z'
    #[arg(long, value_name = "DEG", default_value_t = 0.0, requires = "study")]
    pub zero_deg: f64,
    /// Angles of the files grow from z' towards y'
    #[arg(long, requires = "study")]
    pub mirrored: bool,
    /// Write the answer, tables, pictures and a report into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// From which centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CentreChoice {
    /// Where the pivot was set up
    Setup,
    /// The least-squares centre of all runs
    LeastSquares,
}
