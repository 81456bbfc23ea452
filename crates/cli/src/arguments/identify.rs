//! Arguments of `armill identify`.
//!
//! A table of tests and `--plan` exclude each other. `--points`, `--prior` and their variants are types here,
//! so that clap lists them in the help; `command::identify` converts them to those of `armill_study`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
TESTS.csv has one row per test; column names end in units: joint positions (A1_deg or q1_deg ...), force on the tool in \
base axes (fx_n, fy_n, fz_n), displacement in base axes (dx_mm, dy_mm, dz_mm; empty where not measured).
Groups of --unknowns: drives; bending (about the two axes perpendicular to each drive); base (the foundation); tool \
(holder and tool, along the flange axes); lost-motion (backlash in drives). Guide: docs/guide/measure-stiffness.md

Examples:
  armill identify --plan 20 --robot yaskawa/mh12 --tool-mm 0,60,150 --out tests.csv
  armill identify tests.csv --robot yaskawa/mh12 --tool-mm 0,60,150 --out my-mh12.toml
  armill identify tests.csv --robot arm.toml --unknowns drives --json"
)]
pub(crate) struct IdentifyArguments {
    /// Table of load tests (CSV)
    #[arg(required_unless_present = "plan")]
    pub tests: Option<PathBuf>,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// Springs to identify: groups joined by +
    #[arg(long, value_name = "GROUPS", default_value = "drives+bending+base")]
    pub unknowns: String,
    /// Where the force acts and the displacement is measured
    #[arg(long, value_enum, default_value_t = PointsArgument::Known)]
    pub points: PointsArgument,
    /// Standard uncertainty of the positions of these points (with --points common or separate)
    #[arg(long, value_name = "U", default_value_t = 200.0)]
    pub point_u_mm: f64,
    /// Prior knowledge of the springs
    #[arg(long, value_enum, default_value_t = PriorArgument::Typical)]
    pub prior: PriorArgument,
    /// Vector from the flange to the point where the force acts and the displacement is measured
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    pub tool_mm: Option<Vec<f64>>,
    /// Write the robot with its identified compliances (with --plan: the table) to this file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Propose N tests to carry out, instead of evaluating a table
    #[arg(long, value_name = "N", conflicts_with = "tests")]
    pub plan: Option<usize>,
    /// Force that you can apply, up to the weight of the payload (with --plan) [default: 150, or that weight if it is less]
    #[arg(long, value_name = "F")]
    pub pull_n: Option<f64>,
    /// Standard uncertainty of the displacement sensor (with --plan)
    #[arg(long, value_name = "U", default_value_t = 10.0)]
    pub gauge_um: f64,
    /// Accept values that are implausible for a robot, after you have checked their units
    #[arg(long)]
    pub trust_units: bool,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Points where the force acts and the displacement is measured.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PointsArgument {
    /// At the points given in the tests
    Known,
    /// Both offset by the same vector, which is identified
    Common,
    /// Each with its own offset, which is identified
    Separate,
}

/// Prior knowledge of the springs.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PriorArgument {
    /// Compliances are typical of robots within a few powers of ten; tests that fit badly have less weight
    Typical,
    /// None: plain least squares, no negative compliance
    None,
}
