//! Arguments of `armill tracker`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::robots::ROBOT_HELP;
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
FILE is a table of a measured body or point as the tracker writes it (x, y, z; quaternion q0 to q3 or matrix m_00 to m_23), or three files of \
reflectors on the tool (x, y, z in mm, without titles), or one file of these (nine columns, without titles, joint positions in the last columns). Rows of all files belong together. The result is a table of poses for \
`armill calibrate`, `learn` and `pose-accuracy`.
Guide: docs/guide/calibrate.md

Examples:
  armill tracker leica.csv --robot staubli/tx90 --joints theta.xlsx --out poses.csv
  armill tracker smr1.txt smr2.txt smr3.txt --base base1.txt,base2.txt,base3.txt --joints joints.txt --robot arm.toml --out poses.csv")]
pub(crate) struct TrackerArguments {
    /// Measured body or point; or three reflectors on the tool
    #[arg(required = true, num_args = 1..=3)]
    pub file: Vec<PathBuf>,
    #[arg(long, value_name = "NAME", help = ROBOT_HELP)]
    pub robot: String,
    /// Three reflectors on the base, measured with every pose: its motion is taken out, misreadings are found
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    pub base: Option<Vec<PathBuf>>,
    /// Joint positions in the last columns (.csv, .txt, .xlsx); without it they are in FILE
    #[arg(long, value_name = "FILE")]
    pub joints: Option<PathBuf>,
    /// Unit of the joint positions in that file; of prismatic joints mm and m
    #[arg(long, value_enum, default_value_t = JointUnitArgument::Deg)]
    pub joint_unit: JointUnitArgument,
    /// Write the table of poses to this file (CSV)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}

/// Unit of joint positions.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum JointUnitArgument {
    /// Degrees
    Deg,
    /// Radians
    Rad,
}
