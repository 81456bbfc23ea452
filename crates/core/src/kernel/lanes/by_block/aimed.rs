//! A batch as whole answers use it: one block aimed at poses, solved as they choose, and looked into.

use nalgebra::{Matrix3, UnitQuaternion};

use super::batch::{Batch, Scratch};
use crate::frame::Isometry;
use crate::kernel::lanes::geometry::{Aims, Prepared};
use crate::kernel::lanes::solve::{Positions, Postures};
use crate::numbers::{BLOCK, Backend, Plane, Planes, planes};

impl Batch<f64> {
    /// Places the block's aims at these poses; the rest repeats the last. [`Batch::orient`] must follow.
    pub(in crate::kernel::lanes) fn aim_at(&mut self, poses: &[Isometry]) {
        let mut places: Planes<f64, 3> = planes();
        let last = poses.last();
        // Maps have one orientation.
        let (mut rotation, mut rows) = (UnitQuaternion::identity(), Matrix3::identity());
        for (i, pose) in poses
            .iter()
            .chain(last.into_iter().cycle())
            .take(BLOCK)
            .enumerate()
        {
            for (plane, value) in places.iter_mut().zip(pose.translation.vector.iter()) {
                plane[i] = *value;
            }
            if pose.rotation.coords != rotation.coords {
                // Columns of the transpose are rows of the rotation.
                rows = pose.rotation.to_rotation_matrix().matrix().transpose();
                rotation = pose.rotation;
            }
            for (plane, value) in self.scratch.rotations.iter_mut().zip(rows.iter()) {
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
    pub(in crate::kernel::lanes) fn solved(&self) -> SolvedBlock<'_> {
        let Scratch {
            aims,
            postures,
            positions,
            ..
        } = &*self.scratch;
        SolvedBlock {
            prepared: &self.prepared,
            aims,
            postures,
            positions,
            backend: self.backend,
        }
    }
}

/// A solved block.
pub(in crate::kernel::lanes) struct SolvedBlock<'a> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<f64>,
    pub postures: &'a Postures<f64>,
    pub positions: &'a Positions<f64>,
    pub backend: Backend,
}
