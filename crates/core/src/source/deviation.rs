//! The deviation by all sources.

use nalgebra::Matrix3;

use crate::spatial::Twist;

/// Deviation of the tool from its commanded pose, with the parts of its sources.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Displacement (m) and rotation (rad) of the tool.
    pub twist: Twist,
    /// Share of each joint, base to flange, then of base, flange and tool where they have springs; with `geometric`
    /// they add up.
    pub shares: Vec<Twist>,
    /// Covariance of the displacement, m^2: of compliances, backlash, model error and repeatability.
    pub covariance: Matrix3<f64>,
}
