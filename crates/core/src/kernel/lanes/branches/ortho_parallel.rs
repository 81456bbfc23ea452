//! Branches of ortho-parallel arms, by the [`Batch`] of the lanes: exact, or as starting values of a calibrated arm.

use std::f64::consts::PI;

use super::found::{BranchPlanes, state};
use crate::frame::Isometry;
use crate::kernel::lanes::by_block::{Batch, signs};
use crate::kernel::lanes::geometry::{Aims, Arm, Prepared, Second, aim};
use crate::kernel::lanes::solve::flag;
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Float, Plane, Real, Work};
use crate::robot::inverse::OrthoParallel;
use crate::robot::{Branch, Wrist};

/// A batch, aimed at a block of poses.
#[derive(Clone, Debug)]
pub(super) struct OrthoParallelBlock {
    batch: Batch<f64>,
    /// Signs of shoulder and elbow that it is solved for.
    solved: Option<[f64; 2]>,
    /// How far (m) beyond its reach the calibrated arm may still be.
    slack: f64,
    /// Sense of each axis, and the angle at chain zero.
    sense: [f64; 6],
    at_zero: [f64; 6],
}

impl OrthoParallelBlock {
    pub fn new(question: &Question<'_>, arm: &OrthoParallel, backend: Backend) -> OrthoParallelBlock {
        OrthoParallelBlock {
            batch: Batch::new(question, arm, backend),
            solved: None,
            slack: arm.links.slack,
            sense: arm.sense,
            at_zero: Arm::angles_at_zero(arm),
        }
    }

    pub fn aim_at(&mut self, poses: &[Isometry]) {
        self.batch.aim_at(poses);
        self.batch.orient(Second::AtZero);
        self.solved = None;
    }

    /// Solves the branch and its flip.
    pub fn solve(&mut self, branch: Branch) {
        let signs = signs(branch);
        if self.solved != Some(signs) {
            let same_shoulder = self.solved.is_some_and(|before| before[0] == signs[0]);
            self.batch.solve_after(same_shoulder, signs, false);
            self.batch.position(same_shoulder);
            self.solved = Some(signs);
        }
    }

    /// Copies the solved branch of an exact arm whose joints begin at `first`.
    pub fn copy_to(&self, branch: Branch, first: usize, found: &mut BranchPlanes) {
        let solved = self.batch.solved();
        let flip = usize::from(branch.wrist == Wrist::Flip);
        let joints = found.joints.iter_mut().skip(first);
        for (joint, from) in joints.zip(&solved.positions.joints[flip]) {
            joint.clone_from(from);
        }
        found.margin.clone_from(&solved.positions.room[flip]);
        found.nearest.clone_from(&solved.positions.nearest[flip]);
        for i in 0..BLOCK {
            let flags = solved.postures.flags[i] as u32;
            found.state[i] = if flags & flag::UNREACHABLE != 0 {
                state::UNREACHED
            } else if flags & flag::WRIST_UNDECIDED != 0 {
                state::UNDECIDED
            } else {
                state::REACHED
            };
            found.singularity[i] = if flags & flag::NEAR_WRIST != 0 {
                1.0
            } else if flags & flag::NEAR_ELBOW != 0 {
                2.0
            } else if flags & flag::NEAR_SHOULDER != 0 {
                3.0
            } else {
                0.0
            };
        }
    }

    /// Chain positions of the solved branch.
    pub fn start(&self, branch: Branch, theta: &mut [Plane<f64>], found: &mut Plane<f64>) {
        let solved = self.batch.solved();
        let flips = branch.wrist == Wrist::Flip;
        for (k, (theta, phi)) in theta.iter_mut().zip(&solved.positions.phi).enumerate() {
            // With the wrist flipped joints 4 and 6 differ by half a turn, and joint 5 bends the other way.
            let (gain, more) = match k {
                3 | 5 if flips => (1.0, PI),
                4 if flips => (-1.0, 0.0),
                _ => (1.0, 0.0),
            };
            let (gain, more) = (self.sense[k] * gain, self.sense[k] * (more - self.at_zero[k]));
            for i in 0..BLOCK {
                theta[i] = gain * phi[i] + more;
            }
        }
        for i in 0..BLOCK {
            let flags = solved.postures.flags[i] as u32;
            found[i] = if flags & flag::UNREACHABLE != 0 {
                state::UNREACHED
            } else if flags & flag::WRIST_UNDECIDED != 0 {
                state::UNDECIDED
            } else {
                state::REACHED
            };
        }
        solved.backend.run(FindNearlyReached {
            prepared: solved.prepared,
            aims: solved.aims,
            shoulder: signs(branch)[0],
            slack: self.slack,
            state: found,
        });
    }
}

/// Makes points undecided that the ideal arm misses by less than `slack` (m): the calibrated arm may reach them.
struct FindNearlyReached<'a, T> {
    prepared: &'a Prepared,
    aims: &'a Aims<T>,
    shoulder: f64,
    slack: f64,
    state: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindNearlyReached<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let arm = &self.prepared.arm;
        let (zero, slack, shoulder) = (R::of(0.0), R::of(self.slack), R::of(self.shoulder));
        let (a1, b) = (R::of(arm.a1), R::of(arm.b.abs()));
        let (reach, fold) = (R::of(arm.l2 + arm.l3), R::of((arm.l2 - arm.l3).abs()));
        let (unreached, undecided) = (R::of(state::UNREACHED), R::of(state::UNDECIDED));
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, false>(self.aims, i);
            let p = aim.tcp - aim.lever;
            let h2 = p.x.mul_add(p.x, p.y * p.y);
            let inside = b - h2.sqrt();
            let r = shoulder * (h2 - b * b).max(zero).sqrt();
            let u = r - a1;
            let d = u.mul_add(u, p.z * p.z).sqrt();
            let miss = inside.max(d - reach).max(fold - d);
            let before = R::load(self.state[i]);
            let nearly = (before == unreached) & (miss < slack);
            self.state[i] = R::either(nearly, undecided, before).store();
        }
    }
}
