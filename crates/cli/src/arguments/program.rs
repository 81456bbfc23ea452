//! Options of `compensate` and `ballbar` for a robot program.

use std::path::PathBuf;

use armill_study::program_out::ProgramSettings;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct ProgramOptions {
    /// Also write the path as a robot program; the file name is the program name
    #[arg(long, value_name = "FILE")]
    pub program: Option<PathBuf>,
    /// Number of the user frame on the controller; default: that of [controller], or 1
    #[arg(long, value_name = "N")]
    pub frame: Option<u32>,
    /// Number of the tool on the controller; default: that of [controller], or 1
    #[arg(long, value_name = "N")]
    pub tool: Option<u32>,
    /// Maximum distance between the linear moves of the program, or its rounded corners, and the path
    #[arg(long, value_name = "UM", default_value_t = ProgramSettings::USUAL_WITHIN_UM)]
    pub within_um: f64,
    /// Height above the part to which the tool retracts where the path has no rapids
    #[arg(long, value_name = "MM", default_value_t = ProgramSettings::USUAL_RETRACT_MM)]
    pub retract_mm: f64,
    /// Maximum distance from a point at which approximate positioning begins; --within-um limits it further at corners
    #[arg(long, value_name = "MM", default_value_t = ProgramSettings::USUAL_BLEND_MM)]
    pub blend_mm: f64,
}
