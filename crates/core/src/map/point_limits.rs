//! Limits at a single point of a path: permitted force, and limits of its cut.

use super::varied::CutLimits;

/// Limits at a point of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLimits {
    /// Index of the point.
    pub index: usize,
    /// Force in addition to all other loads.
    pub forces: PermittedForces,
    /// Limits of the cut; `None` where nothing is cut, or no cut is known.
    pub cut: Option<CutLimits>,
}

/// Permitted force (N) at a point: under this force alone, without gravity, the in-plane deviation of the tip equals
/// the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PermittedForces {
    /// Along the feed.
    pub along: f64,
    /// To its left.
    pub across: f64,
    /// Along the tool.
    pub normal: f64,
    /// In the weakest direction.
    pub weakest: f64,
}
