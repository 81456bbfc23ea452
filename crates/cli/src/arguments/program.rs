//! Options of `compensate` and `ballbar` for a robot program.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct ProgramOptions {
    /// Also write the path as a robot program; the file name is the program name
    #[arg(long, value_name = "FILE")]
    pub program: Option<PathBuf>,
    /// Number of the user frame on the controller
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub frame: u32,
    /// Number of the tool on the controller
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub tool: u32,
    /// Maximum distance between the linear moves of the program and the path
    #[arg(long, value_name = "UM", default_value_t = 5.0)]
    pub within_um: f64,
    /// Height above the part from which the tool approaches each cut and to which it retracts
    #[arg(long, value_name = "MM", default_value_t = 50.0)]
    pub retract_mm: f64,
    /// Distance from a programmed point at which blending begins
    #[arg(long, value_name = "MM", default_value_t = 0.2)]
    pub blend_mm: f64,
}
