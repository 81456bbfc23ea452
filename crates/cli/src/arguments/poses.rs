//! What `calibrate` and `pose-accuracy` alike say of a file of measured poses.

use armill_formats::measurement::poses::Mapping;
use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub(crate) struct PosesOptions {
    /// Columns of other names: OURS=THEIRS, such as x_mm=Measured X, with commas between
    #[arg(long, value_name = "MAP", value_delimiter = ',')]
    pub columns: Vec<Mapping>,
    /// Use the measured turns too (rx, ry, rz)
    #[arg(long)]
    pub turns: bool,
    /// Axes that measured turns go about, x first (fixed ones if left out)
    #[arg(long, value_enum, requires = "turns")]
    pub turn_order: Option<TurnArgument>,
    /// A radian counts as much as so many millimetres (with --turns)
    #[arg(long, value_name = "L", default_value_t = 250.0, requires = "turns")]
    pub turn_mm: f64,
    /// About where the measured point sits on the flange
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    pub tool_mm: Option<Vec<f64>>,
}

/// How measured angles follow each other.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TurnArgument {
    /// About axes that stand still
    FixedXyz,
    /// About axes that turn with it
    MovingXyz,
}
