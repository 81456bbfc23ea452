//! Every posture of a block of poses under one load: a batch for searches along a path.

use nalgebra::Vector3;

use super::batch::{Batch, Scratch};
use super::posture_signs::FOUR;
use crate::frame::Isometry;
use crate::kernel::lanes::geometry::Second;
use crate::numbers::{Plane, Planes};
use crate::spatial::Wrench;

/// Two postures of a block that differ in the wrist's flip: first the plain one, then the flipped one.
pub(in crate::kernel) struct EachPosture<'a> {
    /// Bits of [`flag`](crate::kernel::lanes::flag), each posture with those of its own limits.
    pub flags: &'a [Plane<f64>; 2],
    /// Joint positions, rad.
    pub joints: &'a [Planes<f64, 6>; 2],
    /// Squared sine of the wrist's bend.
    pub bend2: &'a Plane<f64>,
    /// Selected component of the deviation, m; the same for both.
    pub deviation: &'a Plane<f64>,
}

impl Batch<f64> {
    /// Sets the load and the directions of the deviation, base.
    pub(in crate::kernel) fn push(&mut self, cases: &[Wrench], along: &[Vector3<f64>; 2]) {
        let prepared = &mut self.prepared;
        let turn = prepared.arm.arm_from_base_rotation();
        prepared.cases.clear();
        prepared.cases.extend(
            cases
                .iter()
                .map(|wrench| [turn * wrench.force, turn * wrench.moment]),
        );
        prepared.moments = cases.iter().any(|wrench| wrench.moment != Vector3::zeros());
        // The component across both directions is not used, so it is not computed.
        prepared.plane = [turn * along[0], turn * along[1], Vector3::zeros()];
    }

    /// Gives `visit` the postures of these poses, at most a block: front elbow-up, front elbow-down, back elbow-up,
    /// back elbow-down, each with its flip.
    pub(in crate::kernel) fn each_posture(
        &mut self,
        poses: &[Isometry],
        mut visit: impl FnMut(usize, EachPosture<'_>),
    ) {
        self.aim_at(poses);
        self.orient(Second::AtZero);
        for four in 0..FOUR.len() {
            let same_shoulder = self.solve_in_turn(four, false);
            self.position(same_shoulder);
            self.largest(false, None);
            let Scratch {
                postures,
                positions,
                in_plane,
                ..
            } = &*self.scratch;
            visit(
                four,
                EachPosture {
                    flags: &positions.flags,
                    joints: &positions.joints,
                    bend2: postures.bend2(),
                    deviation: in_plane,
                },
            );
        }
    }
}
