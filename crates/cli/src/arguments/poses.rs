//! Options of `calibrate` and `pose-accuracy` for a file of measured poses.

use armill_formats::measurement::poses::Mapping;
use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub(crate) struct PosesOptions {
    /// Columns with other names: expected=actual, such as "x_mm=Measured X", separated by commas
    #[arg(long, value_name = "MAP", value_delimiter = ',')]
    pub columns: Vec<Mapping>,
    /// Also use the measured orientations (rx, ry, rz)
    #[arg(long)]
    pub turns: bool,
    /// Axes of the measured rotations, x first [default: fixed-xyz]
    #[arg(long, value_enum, requires = "turns")]
    pub turn_order: Option<TurnArgument>,
    /// Weight of orientations: an error of 1 rad weighs as much as this length (with --turns)
    #[arg(long, value_name = "L", default_value_t = 250.0, requires = "turns")]
    pub turn_mm: f64,
    /// Approximate position of the measured point relative to the flange
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    pub tool_mm: Option<Vec<f64>>,
}

/// Order of the measured rotations.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TurnArgument {
    /// About fixed axes
    FixedXyz,
    /// About axes that rotate with the measured body
    MovingXyz,
}
