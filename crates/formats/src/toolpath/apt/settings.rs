//! Modal settings of several values: the feed, an arc that has begun, the drilling cycle.

use armill_core::nalgebra::{Point3, Unit, Vector3};

use crate::document::Problem;

/// Unit of the feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Feed {
    /// m/s
    Speed(f64),
    /// m for each turn of the spindle.
    PerTurn(f64),
}

/// What a CIRCLE says, until the GOTO that ends it.
#[derive(Clone, Debug)]
pub(super) struct Circle {
    /// In the frame of the path, m; any point of the axis will do.
    pub centre: Point3<f64>,
    /// The arc turns by the right hand about it; frame of the path.
    pub axis: Unit<Vector3<f64>>,
    /// m, where it is written.
    pub radius: Option<f64>,
    /// Turns of a helix, where they are written.
    pub turns: Option<f64>,
    /// Problem to report if no GOTO follows.
    pub without_end: Problem,
}

/// A cycle that is active until CYCLE/OFF; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cycle {
    /// Below the point, against the tool axis; not negative.
    pub depth: f64,
    /// Above the point: from here on it cuts.
    pub rapid_to: f64,
    /// Above the point: height of the moves between holes; not below `rapid_to`.
    pub retract_to: f64,
    /// `None`: that of FEDRAT.
    pub feed: Option<Feed>,
    /// First peck and those that follow.
    pub pecks: Option<[f64; 2]>,
    /// At the bottom, s.
    pub dwell: f64,
}
