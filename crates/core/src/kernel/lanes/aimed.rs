//! A batch as whole answers use it: one block aimed at poses, solved as they choose, and looked into.

use super::backend::Backend;
use super::batch::{Batch, Scratch};
use super::block::{Aims, BLOCK, Plane, Planes, planes};
use super::positions::Positions;
use super::prepared::Prepared;
use super::solve::Postures;
use crate::frame::Isometry;

impl Batch<f64> {
    /// Places the block's aims at these poses; the rest repeats the last. [`Batch::orient`] must follow.
    pub(super) fn aim_at(&mut self, poses: &[Isometry]) {
        let mut places: Planes<f64, 3> = planes();
        let last = poses.last();
        for (i, pose) in poses
            .iter()
            .chain(last.into_iter().cycle())
            .take(BLOCK)
            .enumerate()
        {
            for (plane, value) in places.iter_mut().zip(pose.translation.vector.iter()) {
                plane[i] = *value;
            }
            // Columns of the transpose are rows of the rotation.
            let rotation = pose.rotation.to_rotation_matrix().matrix().transpose();
            for (plane, value) in self.scratch.rotations.iter_mut().zip(rotation.iter()) {
                plane[i] = *value;
            }
        }
        self.place(places.each_ref());
    }

    /// In-plane envelope and flags of the aimed block in one after the other of the four postures.
    pub(super) fn envelope_in_turn(&mut self, four: usize) -> (&Plane<f64>, &Plane<f64>) {
        self.solve_in_turn(four, false);
        self.envelope(false, None);
        (&self.scratch.in_plane, &self.scratch.postures.flags)
    }

    /// Solves the aimed block with these signs, one pair a point.
    pub(super) fn solve_each(&mut self, signs: &Planes<f64, 2>) {
        self.scratch.postures.signs = *signs;
        self.solve_signed(false);
    }

    /// What other work on the solved block needs.
    pub(super) fn solved(&self) -> Solved<'_> {
        let Scratch {
            aims,
            postures,
            positions,
            ..
        } = &*self.scratch;
        Solved {
            prepared: &self.prepared,
            aims,
            postures,
            positions,
            backend: self.backend,
        }
    }
}

/// A solved block.
pub(super) struct Solved<'a> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<f64>,
    pub postures: &'a Postures<f64>,
    pub positions: &'a Positions<f64>,
    pub backend: Backend,
}
