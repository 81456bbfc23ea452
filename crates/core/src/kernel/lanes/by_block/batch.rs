//! A question prepared for many poses.

use super::arrays::{Arrays, Envelopes, Poses, is_still, length};
use super::posture_signs::{FOUR, signs};
use crate::kernel::Question;
use crate::kernel::lanes::geometry::{Aims, Prepared, Second};
use crate::kernel::lanes::solve::{Forward, POSE, Positions, Postures, SCREWS};
use crate::numbers::{BLOCK, Backend, Plane, Planes, Precision, fill, planes};
use crate::robot::Branch;
use crate::robot::inverse::OrthoParallel;

/// A question prepared for many poses; `T` is `f64` or `f32`.
///
/// Only for ortho-parallel arms with spherical wrist. Scratch is reused from call to call and takes less than 64 KiB:
/// one batch per thread. The branch choice of the question is not used.
///
/// Compliances and joint positions are finite everywhere; the flags (bits of [`flag`](crate::kernel::lanes::flag), stored as a number)
/// report where they are valid.
#[derive(Clone, Debug)]
pub struct Batch<T> {
    pub(in crate::kernel::lanes) prepared: Prepared,
    pub(in crate::kernel::lanes) backend: Backend,
    pub(in crate::kernel::lanes) scratch: Box<Scratch<T>>,
    /// Joint positions in; poses and screws out. Allocated at first use.
    forward: Option<Box<(Planes<T, 6>, Planes<T, { POSE + SCREWS }>)>>,
}

#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Scratch<T> {
    pub aims: Aims<T>,
    pub postures: Postures<T>,
    pub rotations: Planes<T, 9>,
    pub positions: Positions<T>,
    pub in_plane: Plane<T>,
    pub case: Plane<T>,
    pub state: Plane<T>,
    /// In-plane rows or upper triangles of compliances.
    pub out: Planes<T, 21>,
}

/// Size of the scratch: it fits the second-level cache, and on many machines the first, together with the data in use.
const _: () = assert!(size_of::<Scratch<f64>>() <= 64 * 1024);

impl<T: Precision> Batch<T> {
    /// `question` prepared for `backend`; `arm` is the geometry of its robot, as [`Robot::ortho_parallel`] gives it.
    ///
    /// [`Robot::ortho_parallel`]: crate::robot::Robot::ortho_parallel
    pub fn new(question: &Question<'_>, arm: &OrthoParallel, backend: Backend) -> Batch<T> {
        Batch {
            prepared: Prepared::new(question, arm),
            backend,
            scratch: Box::new(Scratch {
                aims: planes(),
                postures: Postures::new(),
                rotations: planes(),
                positions: Positions::new(),
                in_plane: [T::default(); BLOCK],
                case: [T::default(); BLOCK],
                state: [T::default(); BLOCK],
                out: planes(),
            }),
            forward: None,
        }
    }

    /// Largest in-plane deviation of each pose in one branch. Its flip changes the joint limits only: both are
    /// flagged.
    ///
    /// # Panics
    /// If the arrays of `poses` differ in length.
    pub fn envelopes(&mut self, poses: &Poses<'_, T>, branch: Branch, out: &mut Envelopes<T>) {
        out.resize(poses.len());
        for first in (0..poses.len()).step_by(BLOCK) {
            self.aim(poses, first, Second::InTheMiddle);
            self.solve(signs(branch), is_still(poses));
            self.envelope(is_still(poses), out.block(first));
        }
    }

    /// [`Batch::envelopes`] of the four postures: front elbow-up, front elbow-down, back elbow-up, back
    /// elbow-down.
    ///
    /// # Panics
    /// If the arrays of `poses` differ in length.
    pub fn envelopes_of_all(&mut self, poses: &Poses<'_, T>, out: &mut [Envelopes<T>; 4]) {
        for one in out.iter_mut() {
            one.resize(poses.len());
        }
        for first in (0..poses.len()).step_by(BLOCK) {
            self.aim(poses, first, Second::InTheMiddle);
            for (four, one) in out.iter_mut().enumerate() {
                self.solve_in_turn(four, is_still(poses));
                self.envelope(is_still(poses), one.block(first));
            }
        }
    }

    /// Full compliance at the TCP of each pose in one branch, base basis: 21 arrays, the upper triangle row by
    /// row; and one of flags, without those of the joint limits.
    ///
    /// # Panics
    /// If the arrays of `poses` differ in length.
    pub fn compliances(&mut self, poses: &Poses<'_, T>, branch: Branch, out: &mut Arrays<T>) {
        out.resize(22, poses.len());
        for first in (0..poses.len()).step_by(BLOCK) {
            let used = self.aim(poses, first, Second::AtZero);
            self.solve(signs(branch), is_still(poses));
            self.compliance();
            out.take(0, &self.scratch.out, first..first + used);
            let flags = std::slice::from_ref(&self.scratch.postures.flags);
            out.take(21, flags, first..first + used);
        }
    }

    /// Joint positions (rad) of each pose in all branches, in the order of [`Branch::ALL`]: 8 x 6 arrays; and 8 of
    /// flags.
    ///
    /// # Panics
    /// If the arrays of `poses` differ in length.
    pub fn joints(&mut self, poses: &Poses<'_, T>, out: &mut Arrays<T>) {
        out.resize(56, poses.len());
        for first in (0..poses.len()).step_by(BLOCK) {
            let used = self.aim(poses, first, Second::AtZero);
            for four in 0..FOUR.len() {
                let same_shoulder = self.solve_in_turn(four, is_still(poses));
                self.position(same_shoulder);
                let Positions { joints, flags, .. } = &self.scratch.positions;
                out.take(12 * four, joints.as_flattened(), first..first + used);
                out.take(48 + 2 * four, flags, first..first + used);
            }
        }
    }

    /// Tool pose and screws at joint positions (rad): 9 arrays of rotation row by row, 3 of place (m), then of each
    /// joint 3 of the linear and 3 of the angular part of its screw at the TCP, base basis, per unit of chain position.
    ///
    /// # Panics
    /// If the arrays of `joints` differ in length.
    pub fn forward(&mut self, joints: &[&[T]; 6], out: &mut Arrays<T>) {
        let count = length(joints);
        out.resize(POSE + SCREWS, count);
        let room = self.forward.get_or_insert_with(|| Box::new((planes(), planes())));
        let (planes, to) = &mut **room;
        for first in (0..count).step_by(BLOCK) {
            for (plane, from) in planes.iter_mut().zip(joints) {
                fill(plane, &from[first..]);
            }
            self.backend.run(Forward {
                prepared: &self.prepared,
                joints: planes,
                out: to,
            });
            out.take(0, to, first..count.min(first + BLOCK));
        }
    }
}
