//! A straight step of a cut, as the stock sees it.

use nalgebra::{Point3, Unit, Vector3};

/// A straight step of a cut: a rapid would also remove material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Position of the tip before, m, frame of the path; `to` itself where a cut begins.
    pub from: Point3<f64>,
    /// Position of the tip after, m.
    pub to: Point3<f64>,
    /// Feed direction at the end.
    pub direction: Unit<Vector3<f64>>,
    /// The tool, from the tip towards the spindle.
    pub axis: Unit<Vector3<f64>>,
}
