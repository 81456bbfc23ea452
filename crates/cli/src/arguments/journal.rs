//! Arguments of `armill journal`.

use std::path::PathBuf;

use clap::Args;

use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
JOURNAL names a robot and every measurement of it: parts that were cut and measured, positions of a tracker, load tests, each with its day, \
temperature, file and uncertainty. Geometry, compliances and backlash are found from all of them together; what they do not determine \
stays as the robot file has it.
Guide: docs/guide/journal.md

Examples:
  armill journal mine.toml --out my-arm.toml
  armill journal mine.toml --work part.csv --next 10 --candidates where.csv
  armill journal mine.toml --json"
)]
pub(crate) struct JournalArguments {
    /// Journal of the measurements (TOML)
    pub journal: PathBuf,
    /// Points where the deviation matters: joint positions, loads, directions of the last motions (CSV)
    #[arg(long, value_name = "FILE")]
    pub work: Option<PathBuf>,
    /// Propose this number of further measurements, those first that make the deviation at the work most certain
    #[arg(long, value_name = "N", requires = "work")]
    pub next: Option<usize>,
    /// Candidates for them: rows with a load are load tests, others positions (CSV; the points of the work without it)
    #[arg(long, value_name = "FILE", requires = "next")]
    pub candidates: Option<PathBuf>,
    /// Standard uncertainty of a coordinate of a further position
    #[arg(long, value_name = "UM", default_value_t = 20.0)]
    pub position_u_um: f64,
    /// Standard uncertainty of a displacement in a further load test
    #[arg(long, value_name = "UM", default_value_t = 5.0)]
    pub displacement_u_um: f64,
    /// Write the robot with the values found to this file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
