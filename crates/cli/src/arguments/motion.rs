//! Arguments of `armill motion`.

use std::path::PathBuf;

use armill_formats::measurement::joint_log::{AngleUnit, TimeUnit};
use clap::{Args, ValueEnum};

use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
A log has one row per instant: time, position of each joint (J1 ... or A1 ..., actual_q_0, AIPos.A1, fb_j1), and where known the commanded \
positions (target_q_0, ASPos.A1, planned_j1) and the number of the move. Guide: docs/guide/your-robot.md

Examples:
  armill motion stops.csv --robot arm.toml --tool-mm 0,0,150
  armill motion stops.csv --robot arm.toml --compare corners.csv --zone-mm 10
  armill motion stops.csv --robot arm.toml --time-unit s --angle-unit deg --out arm-with-motion.toml")]
pub(crate) struct MotionArguments {
    /// Joint log to learn from: straight moves with stops (CSV)
    pub log: PathBuf,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// Vector from the flange to the tip; without it the tip that makes the moves straight is fitted
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    pub tool_mm: Option<Vec<f64>>,
    /// Other logs, which are compared with their predictions
    #[arg(long, value_name = "LOG", num_args = 1..)]
    pub compare: Vec<PathBuf>,
    /// Radius of the zone at the corners of the compared logs, one for each or one for all; 0: stops; without it zones are fitted
    #[arg(long, value_name = "R", value_delimiter = ',', requires = "compare")]
    pub zone_mm: Vec<f64>,
    /// Unit of the time, if the header of a log does not give it
    #[arg(long, value_enum)]
    pub time_unit: Option<TimeUnitArgument>,
    /// Unit of the joint positions, if the header of a log does not give it
    #[arg(long, value_enum)]
    pub angle_unit: Option<AngleUnitArgument>,
    /// Write the robot with the learnt values to this file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Unit of time.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TimeUnitArgument {
    /// Seconds
    S,
    /// Milliseconds
    Ms,
    /// Microseconds
    Us,
    /// Nanoseconds
    Ns,
}

/// Unit of joint positions.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum AngleUnitArgument {
    /// Degrees
    Deg,
    /// Radians
    Rad,
}

impl From<TimeUnitArgument> for TimeUnit {
    fn from(unit: TimeUnitArgument) -> TimeUnit {
        match unit {
            TimeUnitArgument::S => TimeUnit::Second,
            TimeUnitArgument::Ms => TimeUnit::Millisecond,
            TimeUnitArgument::Us => TimeUnit::Microsecond,
            TimeUnitArgument::Ns => TimeUnit::Nanosecond,
        }
    }
}

impl From<AngleUnitArgument> for AngleUnit {
    fn from(unit: AngleUnitArgument) -> AngleUnit {
        match unit {
            AngleUnitArgument::Deg => AngleUnit::Degree,
            AngleUnitArgument::Rad => AngleUnit::Radian,
        }
    }
}
