//! What `compensate` and `ballbar` alike say of a program of the robot.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct ProgramOptions {
    /// Write the path as a program of the robot too; its name is that of the program
    #[arg(long, value_name = "FILE")]
    pub program: Option<PathBuf>,
    /// Number of the user frame on the controller
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub frame: u32,
    /// Number of the tool on the controller
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub tool: u32,
    /// How far straight moves of the program may leave the path
    #[arg(long, value_name = "UM", default_value_t = 5.0)]
    pub within_um: f64,
    /// How far above the part each cut begins and ends
    #[arg(long, value_name = "MM", default_value_t = 50.0)]
    pub retract_mm: f64,
    /// How near the tip comes to a point before it goes on
    #[arg(long, value_name = "MM", default_value_t = 0.2)]
    pub blend_mm: f64,
}
