//! Newton's iteration on the chain of a calibrated arm, from the branches of the ideal one.
//!
//! ```text
//! e = (away / l, turned)         J = columns (v_k / l, w_k)         dtheta = J^T (J J^T + lambda I)^-1 e
//! ```
//!
//! `l` a length of the arm (m), `lambda = 1e-2 e^2` and rounding, as in `robot::inverse::descent`. Points where the
//! step does not become small are undecided.

use super::found::state;
use crate::kernel::lanes::whole::{ChainConstants, Displacement, FindFrames, FramePlanes};
use crate::numbers::{BLOCK, Backend, Float, Gram, Plane, Planes, Real, Vector, Work, planes, put, vector};
use crate::robot::Chain;

/// Joints of an arm with named branches.
const JOINTS: usize = 6;
/// Maximum number of steps: from 10 mm and 10 mrad away three are enough, near a singularity more.
const MOST_STEPS: usize = 8;
/// Largest step (rad) after which the rest is rounding.
const LAST_STEP: f64 = 1e-7;
/// Damping relative to the sum of squares: rounding.
const DAMPING: f64 = 1e-15;
/// Damping relative to the square of the error: it vanishes as the error does.
const FAR: f64 = 1e-2;

/// A chain, and memory for a block of points.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    chain: ChainConstants,
    length: f64,
    frames: Vec<FramePlanes<f64>>,
    /// The two parts of `(J J^T + lambda I)^-1 e`.
    solved: Planes<f64, 6>,
    step: Plane<f64>,
}

impl Newton {
    pub fn of(chain: &Chain) -> Newton {
        let chain_constants = ChainConstants::without_conventions(chain);
        Newton {
            frames: vec![FramePlanes::unknown(); chain_constants.joints() + 2],
            chain: chain_constants,
            length: chain.length(),
            solved: planes(),
            step: [0.0; BLOCK],
        }
    }

    /// Moves the chain positions of the reached points until the flange is at the target.
    pub fn reach(
        &mut self,
        backend: Backend,
        targets: &FramePlanes<f64>,
        theta: &mut [Plane<f64>],
        found: &mut Plane<f64>,
    ) {
        for _ in 0..MOST_STEPS {
            backend.run(FindFrames {
                chain: &self.chain,
                flange_from_tool: &Displacement::NONE,
                joints: theta,
                frames: &mut self.frames,
            });
            backend.run(Step {
                chain: &self.chain,
                length: self.length,
                targets,
                frames: &self.frames,
                theta,
                solved: &mut self.solved,
                step: &mut self.step,
            });
            let under_way = |(step, found): (&f64, &f64)| *found == state::REACHED && is_long(*step);
            if !self.step.iter().zip(&*found).any(under_way) {
                return;
            }
        }
        for (step, found) in self.step.iter().zip(found) {
            if *found == state::REACHED && is_long(*step) {
                *found = state::UNDECIDED;
            }
        }
    }
}

/// Whether a step is not the last one; true for one that is no number.
fn is_long(step: f64) -> bool {
    step.is_nan() || step >= LAST_STEP
}

/// One step at every point; fills the size of the largest change of a joint, rad.
struct Step<'a, T> {
    chain: &'a ChainConstants,
    length: f64,
    targets: &'a FramePlanes<T>,
    frames: &'a [FramePlanes<T>],
    theta: &'a mut [Plane<T>],
    solved: &'a mut Planes<T, 6>,
    step: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for Step<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let Step {
            chain,
            length,
            targets,
            frames,
            theta,
            solved,
            step,
        } = self;
        let per_length = R::of(1.0 / length);
        let half = R::of(0.5);
        let flange = &frames[JOINTS + 1];
        let axis = |k: usize| &frames[k + 1].axes[chain.axis(k).0];
        let axes = [axis(0), axis(1), axis(2), axis(3), axis(4), axis(5)];
        for i in 0..BLOCK {
            R::step();
            let at = vector::<R>(&flange.origin, i);
            let mut gram = Gram::new(R::of(0.0));
            gram = gram.with(column(axes[0], &frames[1].origin, at, per_length, i));
            gram = gram.with(column(axes[1], &frames[2].origin, at, per_length, i));
            gram = gram.with(column(axes[2], &frames[3].origin, at, per_length, i));
            gram = gram.with(column(axes[3], &frames[4].origin, at, per_length, i));
            gram = gram.with(column(axes[4], &frames[5].origin, at, per_length, i));
            gram = gram.with(column(axes[5], &frames[6].origin, at, per_length, i));
            let away = (vector::<R>(&targets.origin, i) - at).scaled(per_length);
            // For small angles the sine is the angle.
            let turned = vector::<R>(&flange.axes[0], i).cross(vector::<R>(&targets.axes[0], i))
                + vector::<R>(&flange.axes[1], i).cross(vector::<R>(&targets.axes[1], i))
                + vector::<R>(&flange.axes[2], i).cross(vector::<R>(&targets.axes[2], i));
            let turned = turned.scaled(half);
            let size = away.dot(away) + turned.dot(turned);
            let damping = R::of(DAMPING).mul_add(gram.trace(), R::of(FAR) * size);
            let ([x, y], _) = gram.damped(damping).solve(away, turned);
            put(&mut solved[0..3], i, x);
            put(&mut solved[3..6], i, y);
            step[i] = R::of(0.0).store();
        }
        let mut k = 0;
        while k < JOINTS {
            let (theta, axis, origin) = (&mut theta[k], axes[k], &frames[k + 1].origin);
            for i in 0..BLOCK {
                R::step();
                let at = vector::<R>(&flange.origin, i);
                let [v, w] = column(axis, origin, at, per_length, i);
                let change = v.dot(vector::<R>(&solved[0..3], i)) + w.dot(vector::<R>(&solved[3..6], i));
                theta[i] = (R::load(theta[i]) + change).store();
                // A step that is no number stays the largest.
                let largest = R::load(step[i]);
                let size = change.abs();
                step[i] = R::either(size <= largest, largest, size).store();
            }
            k += 1;
        }
    }
}

/// Column of the scaled Jacobian: linear part (in units of `l`), angular part.
#[inline(always)]
fn column<R: Real>(
    axis: &Planes<R::Float, 3>,
    origin: &Planes<R::Float, 3>,
    flange: Vector<R>,
    per_length: R,
    i: usize,
) -> [Vector<R>; 2] {
    let axis = vector::<R>(axis, i);
    let lever = flange - vector::<R>(origin, i);
    [axis.cross(lever).scaled(per_length), axis]
}
