//! Runs of a circular test as a file gives them, and what must be given in addition to it.

use armill_core::measure::ballbar::{Direction, Run};

/// Values that the file does not give, or that are given as options.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallbarReadOptions {
    /// Nominal radius, m.
    pub radius: Option<f64>,
    /// Direction of all runs.
    pub direction: Option<Direction>,
    /// Start angle of runs without angles, rad.
    pub start: Option<f64>,
}

/// The runs of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct BallbarRuns {
    /// Nominal radius, m; `None` if the file has only deviations.
    pub radius: Option<f64>,
    /// Speed along the circle, m/s.
    pub feed: Option<f64>,
    /// Name of the plane in the file: `XY`.
    pub plane: Option<String>,
    /// In the order of the file.
    pub runs: Vec<Run>,
    /// Name of each run in the file; empty if it has none.
    pub names: Vec<String>,
    /// Ignored columns.
    pub unused: Vec<String>,
    /// Warnings, one sentence each.
    pub notes: Vec<String>,
}

/// The direction that a word in a file names; `None` for other words.
pub fn direction_of(word: &str) -> Option<Direction> {
    match word.trim().to_lowercase().as_str() {
        "cw" | "clockwise" | "g2" | "g02" => Some(Direction::Clockwise),
        "ccw" | "acw" | "counterclockwise" | "counter-clockwise" | "anticlockwise" | "anti-clockwise"
        | "g3" | "g03" => Some(Direction::Anticlockwise),
        _ => None,
    }
}
