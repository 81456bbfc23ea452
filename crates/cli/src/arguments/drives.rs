//! Arguments of `armill drives`.

use std::path::PathBuf;

use clap::Args;

use super::motion::{AngleUnitArgument, TimeUnitArgument};
use super::writing::WritingOptions;

#[derive(Debug, Args)]
#[command(after_help = "\
A log has one row per instant: time_s, and of each joint motor_j1_deg (motor encoder, reduced to the joint), torque_j1_nm (of the motor), and \
link_j1_deg (link encoder), if there is one: without it friction and load are determined, but no torsion. Of a MATLAB file (-v7, -v7.3), \
--names gives the arrays, with one row or one column for each joint. Guide: docs/guide/measure-stiffness.md

Examples:
  armill drives log.csv --gear 257,267,252 --drawing torsion.svg
  armill drives torques.csv --robot kuka/kr210r2700extra
  armill drives log.csv --gear 257,267,252,221,240,154 --rotor-inertia 0.0092,0.0118,0.0118,0,0,0 --robot arm.toml --out found.toml
  armill drives run_A.mat --names rec.time,rec.motor_deg,rec.link_deg,rec.torque --compare run_B.mat
  armill drives log.csv --json")]
pub(crate) struct DrivesArguments {
    /// Log with motor encoders, torques and, if there are any, link encoders (CSV, MATLAB)
    pub log: PathBuf,
    /// Arrays of a MATLAB file, LINK only if there is one: time in s, positions in deg (rad, if the name ends in _rad), torque in N m
    #[arg(long, value_name = "TIME,MOTOR,LINK,TORQUE", value_delimiter = ',')]
    pub names: Option<Vec<String>>,
    /// Gear ratio of each joint, motor to joint; for the stiffness at the joint
    #[arg(long, value_name = "U1,U2,...", value_delimiter = ',')]
    // unit: 1
    pub gear: Vec<f64>,
    /// Inertia of the rotor of each motor, 0 where it is not known: its torque does not pass the gear and is removed for the torsion; needs --gear
    #[arg(long, value_name = "J1,J2,... kg m2", value_delimiter = ',')]
    // unit: kg m^2
    pub rotor_inertia: Vec<f64>,
    /// Robot (name or file) whose axes, and masses if there are any, describe the load; without it the position of each joint does
    #[arg(long, value_name = "NAME")]
    pub robot: Option<String>,
    /// Write the robot with the stiffness and the lost motion that were found to this file; needs --gear
    #[arg(long, value_name = "FILE", requires = "robot")]
    pub out: Option<PathBuf>,
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
