//! What a search along a path may choose at each point besides spin and branch: lean of the tool, positions of external
//! axes.

use super::steps::Steps;
use crate::path::RoundedEnd;

/// Lean of the tool, within a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeanRange {
    /// Leads that are tried, rad.
    pub leads: Steps,
    /// Tilts that are tried, rad.
    pub tilts: Steps,
    /// Largest change of either along the path, rad/m.
    pub rate: f64,
    /// The end of the tool.
    pub end: RoundedEnd,
    /// Distance of neighbouring passes, m, if it is known: for the height of the scallops between them.
    pub stepover: Option<f64>,
}

/// An external axis that moves along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingAxis {
    /// Index of its joint, one that [`home`](crate::kernel::Question::home) gives the position of.
    pub joint: usize,
    /// Positions that are tried, m (rad).
    pub positions: Steps,
    /// Largest change along the path, m/m (rad/m).
    pub rate: f64,
    /// Whether it stands still within a cut.
    pub still: bool,
}

/// Most external axes that move in one search.
pub const MOST_MOVING: usize = 3;
