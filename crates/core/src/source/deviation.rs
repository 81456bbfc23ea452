//! What all sources give together.

use nalgebra::Matrix3;

use crate::spatial::Twist;

/// How far the tool is from where it was asked to be, and why.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Displacement (m) and rotation (rad) of the tool.
    pub twist: Twist,
    /// Share of each joint, base to flange, then of base, flange and tool where springs sit; with `geometric` they add up.
    pub shares: Vec<Twist>,
    /// Covariance of the displacement, m^2: of compliances, backlash, model error and repeatability.
    pub covariance: Matrix3<f64>,
}
