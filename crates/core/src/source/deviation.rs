//! The deviation by all sources.

use nalgebra::Matrix3;

use super::motion_displacement::MotionDisplacement;
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

impl Deviation {
    /// Adds the displacement by the motion along a path; its parts are the last shares.
    pub fn add_motion(&mut self, motion: &MotionDisplacement) {
        for (_, part, u) in motion.parts() {
            let part = Twist {
                linear: part,
                ..Twist::ZERO
            };
            self.twist = self.twist + part;
            self.shares.push(part);
            self.covariance += u * u.transpose();
        }
    }
}
