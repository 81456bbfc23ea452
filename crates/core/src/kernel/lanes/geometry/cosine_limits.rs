//! Joint limits as cosines of the arm's angles: computed once per question.

use nalgebra::Vector3;

use super::arm::Arm;

/// Limits as cosines of the arm's angles.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct CosineLimits {
    pub rows: [[f64; 3]; 6],
    /// Joint 3 is measured from the vertical (its coupling to joint 2 removes the turn of joint 2).
    pub third_from_vertical: bool,
    /// Across axis 4 in the upright forearm: where axis 6 points with joint 4 in the middle of its range.
    pub forearm_middle: Vector3<f64>,
    /// Across axis 6 in the tool's axes: direction of axis 5 with joint 6 in the middle of its range.
    pub tool_middle: Vector3<f64>,
    /// Whether joint 4 or 6 has less than a turn.
    pub swivels: bool,
    /// Whether the range of joint 5 is not the same to both sides of the straight wrist.
    pub askew: bool,
}

impl CosineLimits {
    /// `None` where joints are coupled in a way that cosines do not see.
    pub fn new(arm: &Arm) -> Option<CosineLimits> {
        let mut alone = arm.coupling;
        let third = std::mem::take(&mut alone[2][1]);
        // q3 = g3 (chi - psi) - k g2 psi: psi cancels where k g2 = -g3.
        let third_from_vertical = third * arm.joints[1].gain == -arm.joints[2].gain;
        if alone.iter().flatten().any(|k| *k != 0.0) || (third != 0.0 && !third_from_vertical) {
            return None;
        }
        let mut counting = arm.clone();
        counting.joints[2].start -= third * arm.joints[1].start;
        let row = |i: usize| counting.cosine_limit(i).unwrap_or([0.0, 0.0, -1.0]);
        let [_, a5, a3] = arm.forearm;
        let (fourth, sixth) = (row(3), row(5));
        let (out, second) = (arm.tool_from_axis_6, arm.tool_from_axis_5);
        Some(CosineLimits {
            rows: [row(0), row(1), row(2), fourth, row(4), sixth],
            third_from_vertical,
            swivels: counting.cosine_limit(3).is_some() || counting.cosine_limit(5).is_some(),
            // A middle that a file rounds to 1e-12 rad from zero is at zero.
            askew: row(4)[1].abs() > 1e-12,
            forearm_middle: a5 * fourth[1] - a3 * fourth[0],
            tool_middle: second * sixth[0] + second.cross(&out) * sixth[1],
        })
    }
}
