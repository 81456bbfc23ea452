//! A question prepared for many poses.

use nalgebra::{Matrix3, Vector3};

use super::aims::{self, Orientations, Places};
use super::arrays::{Arrays, Envelopes, Poses, length};
use super::backend::{Backend, Precision};
use super::block::{Aims, BLOCK, Plane, Planes, planes};
use super::branches::Pair;
use super::compliance::Compliances;
use super::envelope::{Largest, LimitsByAngles, Rows};
use super::forward::{Forward, POSE, SCREWS};
use super::prepared::Prepared;
use crate::frame::Isometry;
use crate::kernel::Question;
use crate::robot::posture::{Branch, Elbow, Shoulder};

/// A question prepared for many poses; `T` is `f64` or `f32`.
///
/// All answers are for ortho-parallel arms with spherical wrist. Scratch is reused from call to call and takes
/// less than 64 KiB: one batch a thread. What the question chooses as branch is not looked at.
///
/// Compliances and joint positions are finite everywhere; the flags (bits of [`super::flag`], stored as a number)
/// tell where they mean something.
#[derive(Clone, Debug)]
pub struct Batch<T> {
    prepared: Prepared,
    backend: Backend,
    scratch: Box<Scratch<T>>,
}

#[derive(Clone, Debug)]
struct Scratch<T> {
    aims: Aims<T>,
    rotations: Planes<T, 9>,
    rows: Planes<T, 12>,
    in_plane: Plane<T>,
    case: Plane<T>,
    flags: Plane<T>,
    state: Plane<T>,
    joints: Planes<T, 6>,
    out: Planes<T, { POSE + SCREWS }>,
    flags_of_pair: Planes<T, 2>,
}

/// Scratch that leaves room in the second cache, and fits the first of many machines with what is worked on.
const _: () = assert!(size_of::<Scratch<f64>>() <= 64 * 1024);

/// Which axis 5 an aim holds.
#[derive(Clone, Copy)]
pub(super) enum Second {
    /// With joint 6 at zero: positions want it.
    AtZero,
    /// With joint 6 in the middle of its range: limits told by cosines want it.
    InTheMiddle,
}

/// Signs of shoulder and elbow.
fn signs(branch: Branch) -> [f64; 2] {
    [
        if branch.shoulder == Shoulder::Front {
            1.0
        } else {
            -1.0
        },
        if branch.elbow == Elbow::Up { 1.0 } else { -1.0 },
    ]
}

/// Shoulder and elbow signs of the four postures that differ in more than the wrist's flip, in the order of
/// [`Branch::ALL`].
pub(super) const FOUR: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];

impl<T: Precision> Batch<T> {
    /// `question` prepared for `backend`.
    pub fn new(question: &Question<'_>, backend: Backend) -> Batch<T> {
        Batch {
            prepared: Prepared::new(question),
            backend,
            scratch: Box::new(Scratch {
                aims: planes(),
                rotations: planes(),
                rows: planes(),
                in_plane: [T::default(); BLOCK],
                case: [T::default(); BLOCK],
                flags: [T::default(); BLOCK],
                state: [T::default(); BLOCK],
                joints: planes(),
                out: planes(),
                flags_of_pair: planes(),
            }),
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
            let used = self.aim(poses, first, Second::InTheMiddle);
            self.envelope(signs(branch), is_still(poses));
            out.take(&self.scratch.in_plane, &self.scratch.state, (first, used));
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
            let used = self.aim(poses, first, Second::InTheMiddle);
            for (signs, one) in FOUR.into_iter().zip(out.iter_mut()) {
                self.envelope(signs, is_still(poses));
                one.take(&self.scratch.in_plane, &self.scratch.state, (first, used));
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
            self.compliance(signs(branch), is_still(poses));
            out.take(0, &self.scratch.out[..21], (first, used));
            out.take(21, std::slice::from_ref(&self.scratch.flags), (first, used));
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
            for (four, signs) in FOUR.into_iter().enumerate() {
                self.pair(signs, is_still(poses));
                out.take(12 * four, &self.scratch.out[..12], (first, used));
                out.take(48 + 2 * four, &self.scratch.flags_of_pair, (first, used));
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
        for first in (0..count).step_by(BLOCK) {
            let used = BLOCK.min(count - first);
            let Scratch {
                joints: planes,
                out: to,
                ..
            } = &mut *self.scratch;
            for (plane, from) in planes.iter_mut().zip(joints) {
                fill(plane, &from[first..first + used]);
            }
            let prepared = &self.prepared;
            if prepared.arm.coupled {
                self.backend.run(Forward::<T, true> {
                    prepared,
                    joints: planes,
                    out: to,
                });
            } else {
                self.backend.run(Forward::<T, false> {
                    prepared,
                    joints: planes,
                    out: to,
                });
            }
            out.take(0, to, (first, used));
        }
    }

    /// Fills the block's aims with the poses from `first` on and gives how many there are; the rest repeats the
    /// last.
    fn aim(&mut self, poses: &Poses<'_, T>, first: usize, second: Second) -> usize {
        let (Poses::Still { at, .. } | Poses::Free { at, .. }) = poses;
        let used = BLOCK.min(at[0].len() - first);
        for (plane, from) in self.scratch.aims.iter_mut().zip(at) {
            fill(plane, &from[first..first + used]);
        }
        match poses {
            Poses::Still { base_from_tool, .. } if first == 0 => {
                let second = self.second(second);
                aims::still(
                    &self.prepared,
                    base_from_tool.matrix(),
                    &second,
                    &mut self.scratch.aims,
                );
            }
            Poses::Still { .. } => {}
            Poses::Free { rotations, .. } => {
                for (plane, from) in self.scratch.rotations.iter_mut().zip(rotations) {
                    fill(plane, &from[first..first + used]);
                }
                self.orient(second);
            }
        }
        self.place();
        used
    }

    fn second(&self, second: Second) -> Vector3<f64> {
        match (second, &self.prepared.cosines) {
            (Second::InTheMiddle, Some(cosines)) => cosines.tool_middle,
            _ => self.prepared.arm.tool_from_axis_5,
        }
    }

    /// Turns the block's rotations into its aims.
    pub(super) fn orient(&mut self, second: Second) {
        let second = &self.second(second);
        let Scratch { aims, rotations, .. } = &mut *self.scratch;
        let prepared = &self.prepared;
        self.backend.run(Orientations {
            prepared,
            rotations,
            second,
            aims,
        });
    }

    fn place(&mut self) {
        let (prepared, aims) = (&self.prepared, &mut self.scratch.aims);
        self.backend.run(Places { prepared, aims });
    }

    /// Envelope of the aimed block: deviation and state.
    fn envelope(&mut self, signs: [f64; 2], still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch {
            aims,
            rows,
            in_plane,
            case,
            flags,
            state,
            ..
        } = &mut *self.scratch;
        match (still, prepared.moments) {
            (true, false) => backend.run(Rows::<T, true, false> {
                prepared,
                aims,
                signs,
                rows,
                flags,
            }),
            (true, true) => backend.run(Rows::<T, true, true> {
                prepared,
                aims,
                signs,
                rows,
                flags,
            }),
            (false, false) => backend.run(Rows::<T, false, false> {
                prepared,
                aims,
                signs,
                rows,
                flags,
            }),
            (false, true) => backend.run(Rows::<T, false, true> {
                prepared,
                aims,
                signs,
                rows,
                flags,
            }),
        }
        if prepared.cosines.is_none() {
            backend.run(LimitsByAngles {
                prepared,
                aims,
                signs,
                flags,
            });
        }
        if prepared.moments {
            backend.run(Largest::<T, true> {
                prepared,
                rows,
                flags,
                in_plane,
                case,
                state,
            });
        } else {
            backend.run(Largest::<T, false> {
                prepared,
                rows,
                flags,
                in_plane,
                case,
                state,
            });
        }
    }

    fn compliance(&mut self, signs: [f64; 2], still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch { aims, out, flags, .. } = &mut *self.scratch;
        let Some(out) = out.first_chunk_mut() else { return };
        let turned = prepared.arm.arm_from_base_rotation() != Matrix3::identity();
        match (still, turned) {
            (true, false) => backend.run(Compliances::<T, true, false> {
                prepared,
                aims,
                signs,
                out,
                flags,
            }),
            (true, true) => backend.run(Compliances::<T, true, true> {
                prepared,
                aims,
                signs,
                out,
                flags,
            }),
            (false, false) => backend.run(Compliances::<T, false, false> {
                prepared,
                aims,
                signs,
                out,
                flags,
            }),
            (false, true) => backend.run(Compliances::<T, false, true> {
                prepared,
                aims,
                signs,
                out,
                flags,
            }),
        }
    }

    fn pair(&mut self, signs: [f64; 2], still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch {
            aims,
            out,
            flags_of_pair: flags,
            ..
        } = &mut *self.scratch;
        let Some(joints) = out.first_chunk_mut() else {
            return;
        };
        match (still, prepared.arm.coupled) {
            (true, false) => backend.run(Pair::<T, true, false> {
                prepared,
                aims,
                signs,
                joints,
                flags,
            }),
            (true, true) => backend.run(Pair::<T, true, true> {
                prepared,
                aims,
                signs,
                joints,
                flags,
            }),
            (false, false) => backend.run(Pair::<T, false, false> {
                prepared,
                aims,
                signs,
                joints,
                flags,
            }),
            (false, true) => backend.run(Pair::<T, false, true> {
                prepared,
                aims,
                signs,
                joints,
                flags,
            }),
        }
    }
}

impl Batch<f64> {
    /// Places the block's aims at these poses; the rest repeats the last. [`Batch::orient`] must follow.
    pub(super) fn aim_at(&mut self, poses: &[Isometry]) {
        let Scratch { aims, rotations, .. } = &mut *self.scratch;
        let last = poses.last();
        for (i, pose) in poses
            .iter()
            .chain(last.into_iter().cycle())
            .take(BLOCK)
            .enumerate()
        {
            for (plane, value) in aims.iter_mut().zip(pose.translation.vector.iter()) {
                plane[i] = *value;
            }
            // Columns of the transpose are rows of the rotation.
            let rotation = pose.rotation.to_rotation_matrix().matrix().transpose();
            for (plane, value) in rotations.iter_mut().zip(rotation.iter()) {
                plane[i] = *value;
            }
        }
        self.place();
    }

    /// In-plane envelope and flags of the aimed block.
    pub(super) fn envelope_of_aimed(&mut self, signs: [f64; 2]) -> (&Plane<f64>, &Plane<f64>) {
        self.envelope(signs, false);
        (&self.scratch.in_plane, &self.scratch.flags)
    }

    /// What other work on the aimed block needs.
    pub(super) fn aimed(&self) -> (&Prepared, &Aims<f64>, Backend) {
        (&self.prepared, &self.scratch.aims, self.backend)
    }
}

fn is_still<T>(poses: &Poses<'_, T>) -> bool {
    matches!(poses, Poses::Still { .. })
}

/// Copies values into a plane; the rest repeats the last.
fn fill<T: Copy>(plane: &mut Plane<T>, from: &[T]) {
    plane[..from.len()].copy_from_slice(from);
    if let Some(last) = from.last() {
        plane[from.len()..].fill(*last);
    }
}
