//! Displacement of the tool from the points of a path by the motion.

use super::Motion;
use crate::source::MotionDisplacement;

impl Motion {
    /// The displacement at point `index`; `lag_u` is the relative standard uncertainty of the lag of the joints, zero where it is not known.
    pub fn displacement_at(&self, index: usize, lag_u: f64) -> MotionDisplacement {
        MotionDisplacement {
            blending: self.blending[index],
            servo: self.servo[index],
            servo_u: self.servo[index] * lag_u,
        }
    }
}
