//! Joint positions and margins from chain positions, by the conventions of the joints.

use super::found::BranchPlanes;
use crate::kernel::lanes::geometry::{JointRow, UNLIMITED};
use crate::kernel::lanes::solve::Counting;
use crate::numbers::{Plane, Real, Work};
use crate::robot::Robot;

/// Sign, zero, range and coupling of every joint.
#[derive(Clone, Debug)]
pub(super) struct JointRows {
    rows: Vec<JointRow>,
    /// Factors of the earlier joints, one per joint.
    coupling: Vec<Vec<f64>>,
}

impl JointRows {
    pub fn of(robot: &Robot) -> JointRows {
        let joints = robot.joints();
        let rows = joints.iter().map(|joint| {
            let sign = joint.sign.factor();
            JointRow {
                gain: sign,
                start: -sign * joint.zero_offset,
                middle: joint.limits.map_or(0.0, |limits| limits.middle()),
                half: joint
                    .limits
                    .map_or(UNLIMITED, |limits| 0.5 * (limits.upper - limits.lower)),
            }
        });
        let coupling = joints.iter().enumerate().map(|(i, joint)| {
            let mut factors = vec![0.0; i];
            for coupling in &joint.coupling {
                factors[coupling.joint] += coupling.factor;
            }
            factors
        });
        JointRows {
            rows: rows.collect(),
            coupling: coupling.collect(),
        }
    }
}

/// Fills joint positions, margins and their joints; each position as near as possible to the middle of its range.
pub(super) struct TakePositions<'a> {
    pub rows: &'a JointRows,
    pub theta: &'a [Plane<f64>],
    /// Index of the first joint that has a row.
    pub first: usize,
    pub found: &'a mut BranchPlanes,
}

impl Work<f64> for TakePositions<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let BranchPlanes {
            joints,
            margin,
            nearest,
            ..
        } = self.found;
        let joints = &mut joints[self.first..];
        let mut joint = 0;
        while joint < joints.len() {
            let counting = Counting::<R>::of(self.rows.rows[joint], &self.rows.coupling[joint], joint);
            counting.set(&self.theta[joint], &mut joints[..=joint], [margin, nearest]);
            joint += 1;
        }
    }
}
