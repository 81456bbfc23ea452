//! Arguments of `armill drives`.

use std::path::PathBuf;

use clap::Args;

use super::motion::{AngleUnitArgument, TimeUnitArgument};
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
A log has one row per instant: time_s, and of each joint motor_j1_deg (motor encoder, reduced to the joint), link_j1_deg (link encoder),
torque_j1_nm (of the motor). Of a MATLAB file (-v7), --names gives the arrays, with one row or one column for each joint. Guide:
docs/guide/measure-stiffness.md

Examples:
  armill drives log.csv --gear 257,267,252 --drawing torsion.svg
  armill drives run_A.mat --names rec.time,rec.motor_deg,rec.link_deg,rec.torque --compare run_B.mat
  armill drives log.csv --json")]
pub(crate) struct DrivesArguments {
    /// Log with motor encoders, link encoders and torques (CSV, MATLAB)
    pub log: PathBuf,
    /// Arrays of a MATLAB file: time in s, positions in deg (rad, if the name ends in _rad), torque in N m
    #[arg(long, value_name = "TIME,MOTOR,LINK,TORQUE", value_delimiter = ',')]
    pub names: Option<Vec<String>>,
    /// Gear ratio of each joint, motor to joint; for the stiffness at the joint
    #[arg(long, value_name = "U1,U2,...", value_delimiter = ',')]
    // unit: 1
    pub gear: Vec<f64>,
    /// Another log, which is compared with its prediction
    #[arg(long, value_name = "LOG")]
    pub compare: Option<PathBuf>,
    /// Unit of the time, if the header of a log does not give it, or of a MATLAB file
    #[arg(long, value_enum)]
    pub time_unit: Option<TimeUnitArgument>,
    /// Unit of the joint positions, if the header of a log does not give it, or of a MATLAB file
    #[arg(long, value_enum)]
    pub angle_unit: Option<AngleUnitArgument>,
    /// Draw torsion against torque into this file, SVG or PNG
    #[arg(long, value_name = "FILE")]
    pub drawing: Option<PathBuf>,
    #[command(flatten)]
    pub writing: WritingOptions,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
