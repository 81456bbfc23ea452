//! Displacement of the tool from a programmed point by the motion.

use nalgebra::Vector3;

use super::contributor::Contributor;

/// Displacement of the tool at a point, m, base: rounded corners and joints that follow late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionDisplacement {
    /// Of the commanded path from the programmed point.
    pub blending: Vector3<f64>,
    /// Of the followed path from the commanded one.
    pub servo: Vector3<f64>,
    /// Standard uncertainty of `servo`, whose components are fully correlated.
    pub servo_u: Vector3<f64>,
}

impl MotionDisplacement {
    /// What contributes to a deviation in motion, in the order of the shares.
    pub const CONTRIBUTORS: [Contributor; 2] = [Contributor::Blending, Contributor::Servo];

    /// Both together.
    pub fn total(&self) -> Vector3<f64> {
        self.blending + self.servo
    }

    /// Each of [`MotionDisplacement::CONTRIBUTORS`] with its displacement and the standard uncertainty of that.
    pub fn parts(&self) -> [(Contributor, Vector3<f64>, Vector3<f64>); 2] {
        let [blending, servo] = MotionDisplacement::CONTRIBUTORS;
        [
            (blending, self.blending, Vector3::zeros()),
            (servo, self.servo, self.servo_u),
        ]
    }
}
