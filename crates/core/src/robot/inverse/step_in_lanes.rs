//! A step of a few descents at once, a lane each: the rules of `descent` without branches.
//!
//! In the order of a step: where it leads, the frames there, their error, whether that is less, whether the posture
//! ahead is known, and the Jacobian of the lanes that took it. The first step of a descent leads nowhere and finds the
//! error of its start.

use std::f64::consts::TAU;

use nalgebra::Matrix3;

use super::super::chain::Chain;
use super::super::frame_in_lanes::{FrameInLanes, advance, base, displace, translate};
use super::descent::{
    DONE, FIRST_DAMPING, LEAST_DAMPING, LESS, LONGEST_STEP, MORE, MOST_STEPS, PATIENCE, ROUNDING, SMALL_GAIN,
    STUCK,
};
use super::kind::ENOUGH;
use super::verify::Requested;
use crate::frame::turn_between;
use crate::numbers::{Eight, Gram, Lanes, Real, Vector, Work, atan2, put_in_lane, vector_in_lane};

/// Lanes at once: a vector of the widest instruction set. Twice as many take the same time a pose.
pub(super) const WIDTH: usize = 8;
/// A step (rad, m) and the error at its end (l, rad) below these may lead to a known posture; it does if less than this
/// share of its length is left.
const SHORT: f64 = 0.3;
const NEAR: f64 = 0.1;
const CONTRACTED: f64 = 0.1;
/// Size of the error of a lane whose error is not known yet: any other is less.
const UNKNOWN: f64 = 1e300;

/// A number of each descent.
type Each = Lanes<WIDTH>;

/// What each lane knows.
#[derive(Clone, Debug, Default)]
pub(super) struct UnderWay {
    pub theta: [Each; ENOUGH],
    /// Linear part in units of `length`, then angular part.
    pub error: [[Each; 3]; 2],
    /// Square of the error.
    size: Each,
    /// Columns of the Jacobian: as those of the error.
    columns: [[[Each; 3]; 2]; ENOUGH],
    damping: Each,
    /// Least damping relative to the trace, more where that was not positive definite.
    least: Each,
    idle: Each,
    steps: Each,
    /// Largest change of a joint (rad, m) by the last step.
    step: Each,
    /// 1 where the last step leads to a known posture, otherwise 0.
    pub known: Each,
    /// 1 where the descent has ended, otherwise 0.
    pub ended: Each,
    trial: Trial,
}

/// Where the step of each lane leads.
#[derive(Clone, Debug, Default)]
struct Trial {
    theta: [Each; ENOUGH],
    /// 1 where the step was found, otherwise 0.
    solved: Each,
    /// Axes of the joints and points on them (m), in base.
    axes: [[[Each; 3]; 2]; ENOUGH],
    flange: FrameInLanes<WIDTH>,
    error: [[Each; 3]; 2],
    /// 1 where the flange is half a turn away, the axis of which is not in its sines; otherwise 0.
    half_turn: Each,
    /// 1 where the step is taken, otherwise 0.
    better: Each,
}

/// One step of every lane.
pub(super) struct Step<'a> {
    pub chain: &'a Chain,
    /// Origin of the flange, with the axes of the last joint.
    pub goal: &'a Requested,
    /// Chain positions of known postures, eight each.
    pub known: &'a [[Eight; ENOUGH]],
    pub length: f64,
    pub lanes: &'a mut UnderWay,
}

impl Work<f64> for Step<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let Step {
            chain,
            goal,
            known,
            length,
            lanes,
        } = self;
        let per_length = 1.0 / length;
        lanes.try_step::<R>();
        lanes.trial.find_frames::<R>(chain);
        lanes.trial.find_error::<R>(goal, per_length);
        lanes.decide::<R>();
        lanes.find_known::<R>(chain, known);
        lanes.linearise::<R>(chain, per_length);
    }
}

#[inline(always)]
fn twist<R: Real<Float = f64>>([linear, angular]: &[[Each; 3]; 2], lane: usize) -> [Vector<R>; 2] {
    [vector_in_lane(linear, lane), vector_in_lane(angular, lane)]
}

impl UnderWay {
    /// Begins a descent at the chain positions `theta`.
    pub fn begin(&mut self, lane: usize, theta: &[f64]) {
        for (all, theta) in self.theta.iter_mut().zip(theta) {
            all.0[lane] = *theta;
        }
        // Without an error the first step leads nowhere: the error there is that of the start.
        for all in self.error.iter_mut().flatten() {
            all.0[lane] = 0.0;
        }
        self.size.0[lane] = UNKNOWN;
        self.damping.0[lane] = FIRST_DAMPING / LESS;
        self.least.0[lane] = ROUNDING;
        self.idle.0[lane] = 0.0;
        self.steps.0[lane] = -1.0;
    }

    /// Fills the chain positions of the trial.
    #[inline(always)]
    fn try_step<R: Real<Float = f64>>(&mut self) {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let [c1, c2, c3, c4, c5, c6] = &self.columns;
        for i in 0..WIDTH {
            R::step();
            let columns = [
                twist::<R>(c1, i),
                twist(c2, i),
                twist(c3, i),
                twist(c4, i),
                twist(c5, i),
                twist(c6, i),
            ];
            let [c1, c2, c3, c4, c5, c6] = columns;
            let gram = Gram::new(zero)
                .with(c1)
                .with(c2)
                .with(c3)
                .with(c4)
                .with(c5)
                .with(c6);
            let least = self.least.at::<R>(i) * gram.trace();
            let lambda = (self.damping.at::<R>(i) * self.size.at(i)).max(least);
            let [linear, angular] = twist(&self.error, i);
            let ([x, y], pivot) = gram.damped(lambda).solve(linear, angular);
            let steps = [
                along(c1, x, y),
                along(c2, x, y),
                along(c3, x, y),
                along(c4, x, y),
                along(c5, x, y),
                along(c6, x, y),
            ];
            let largest = (steps[0].abs().max(steps[1].abs()).max(steps[2].abs()))
                .max(steps[3].abs().max(steps[4].abs()).max(steps[5].abs()));
            let shorter = (R::of(LONGEST_STEP) / largest).min(one);
            let mut joint = 0;
            while joint < ENOUGH {
                let theta = shorter.mul_add(steps[joint], self.theta[joint].at(i));
                self.trial.theta[joint].set(i, theta);
                joint += 1;
            }
            self.step.set(i, largest);
            self.trial.solved.set(i, R::either(pivot > zero, one, zero));
        }
    }

    /// Takes the steps that lessen the error, and finds which descents have ended.
    #[inline(always)]
    fn decide<R: Real<Float = f64>>(&mut self) {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let trial = &mut self.trial;
        for i in 0..WIDTH {
            R::step();
            let [away, turned] = twist::<R>(&trial.error, i);
            let [away_before, turned_before] = twist::<R>(&self.error, i);
            let (size_before, damping, idle) = (
                self.size.at::<R>(i),
                self.damping.at::<R>(i),
                self.idle.at::<R>(i),
            );
            let (least, steps) = (self.least.at::<R>(i), self.steps.at::<R>(i));
            let size = away.dot(away) + turned.dot(turned);
            let solved = trial.solved.at::<R>(i) > zero;
            let better = (size < size_before) & solved;
            let small_gain = size > R::of(SMALL_GAIN) * size_before;
            let idle = R::either(better, R::either(small_gain, idle + one, zero), idle);
            let more = damping.max(R::of(LEAST_DAMPING)) * R::of(MORE);
            let damping = R::either(better, damping * R::of(LESS), R::either(solved, more, damping));
            // A matrix that even much damping does not make positive definite is no matrix of numbers.
            let steps = R::either(solved | (least > one), steps + one, steps);
            let size = R::either(better, size, size_before);
            let ended = (size < R::of(DONE * DONE))
                | (damping > R::of(STUCK))
                | (idle > R::of(PATIENCE as f64))
                | (steps >= R::of(MOST_STEPS as f64));
            put_in_lane(&mut self.error[0], i, choose(better, away, away_before));
            put_in_lane(&mut self.error[1], i, choose(better, turned, turned_before));
            self.size.set(i, size);
            self.damping.set(i, damping);
            self.idle.set(i, idle);
            self.least
                .set(i, R::either(solved, R::of(ROUNDING), least * R::of(10.0)));
            self.steps.set(i, steps);
            self.ended.set(i, R::either(ended, one, zero));
            // Those that may; `find_known` asks them.
            let near = better & (self.step.at::<R>(i) < R::of(SHORT)) & (size < R::of(NEAR * NEAR));
            self.known.set(i, R::either(near, one, zero));
            trial.better.set(i, R::either(better, one, zero));
        }
        for (theta, trial_theta) in self.theta.iter_mut().zip(&trial.theta) {
            for i in 0..WIDTH {
                R::step();
                let better = trial.better.at::<R>(i) > zero;
                theta.set(i, R::either(better, trial_theta.at(i), theta.at(i)));
            }
        }
    }

    /// Finds where the last step went to a known posture, and missed it by far less than its length: those that follow
    /// would miss it by still less.
    #[inline(always)]
    fn find_known<R: Real<Float = f64>>(&mut self, chain: &Chain, known: &[[Eight; ENOUGH]]) {
        let mut turns = [R::of(TAU); ENOUGH];
        for (joint, turn) in turns.iter_mut().enumerate().take(chain.links().len()) {
            *turn = R::of(if chain.slides(joint) { 0.0 } else { TAU });
        }
        for lane in 0..WIDTH {
            if self.known.0[lane] == 0.0 {
                continue;
            }
            let within = R::of(CONTRACTED) * self.step.at(lane);
            let [t1, t2, t3, t4, t5, t6] = &self.theta;
            let theta: [R; ENOUGH] = [
                t1.at(lane),
                t2.at(lane),
                t3.at(lane),
                t4.at(lane),
                t5.at(lane),
                t6.at(lane),
            ];
            let mut is_any = false;
            for eight in known {
                let mut is = Eight::default();
                for i in 0..8 {
                    R::step();
                    let mut all = true;
                    let mut joint = 0;
                    while joint < ENOUGH {
                        let away = theta[joint] - eight[joint].at(i);
                        let whole = (away * R::of(1.0 / TAU)).round();
                        let away = (-whole).mul_add(turns[joint], away);
                        all &= away.abs() < within;
                        joint += 1;
                    }
                    is.set(i, R::either(all, R::of(1.0), R::of(0.0)));
                }
                is_any |= is.0.contains(&1.0);
            }
            self.known.set(lane, R::of(f64::from(u8::from(is_any))));
        }
    }

    /// Fills the columns of the Jacobian of the lanes that took their step.
    #[inline(always)]
    fn linearise<R: Real<Float = f64>>(&mut self, chain: &Chain, per_length: f64) {
        let per_length = R::of(per_length);
        // Copies, and columns apart from what they replace: see `forward_of_eight`.
        let (flange, better) = (self.trial.flange[3], self.trial.better);
        let joints = self.columns.iter_mut().zip(&self.trial.axes);
        for (joint, (column, axis)) in joints.enumerate().take(chain.links().len()) {
            let ([direction, origin], [v_before, w_before]) = (*axis, *column);
            let (mut linear, mut angular) = (v_before, w_before);
            if chain.slides(joint) {
                for i in 0..WIDTH {
                    R::step();
                    let better = better.at::<R>(i) > R::of(0.0);
                    let v = vector_in_lane(&direction, i).scaled(per_length);
                    put_in_lane(&mut linear, i, choose(better, v, vector_in_lane(&v_before, i)));
                }
            } else {
                for i in 0..WIDTH {
                    R::step();
                    let better = better.at::<R>(i) > R::of(0.0);
                    let w = vector_in_lane::<R, _>(&direction, i);
                    let lever = vector_in_lane(&flange, i) - vector_in_lane(&origin, i);
                    let v = w.cross(lever).scaled(per_length);
                    put_in_lane(&mut linear, i, choose(better, v, vector_in_lane(&v_before, i)));
                    put_in_lane(&mut angular, i, choose(better, w, vector_in_lane(&w_before, i)));
                }
            }
            *column = [linear, angular];
        }
    }
}

impl Trial {
    /// Fills the axes of the joints and the flange, which has the axes of the last joint.
    #[inline(always)]
    fn find_frames<R: Real<Float = f64>>(&mut self, chain: &Chain) {
        // Apart from what is stored: see `forward_of_eight`.
        let mut frame = base();
        for ((link, theta), found) in chain.links().iter().zip(&self.theta).zip(&mut self.axes) {
            advance::<R, _>(&link.before, &mut frame);
            let axis = displace::<R, _>(&link.motion, theta, &mut frame);
            *found = [frame[axis.index()], frame[3]];
        }
        translate::<R, _>(&chain.last_joint_from_flange().parts().0, &mut frame);
        self.flange = frame;
    }

    /// Fills the error.
    #[inline(always)]
    fn find_error<R: Real<Float = f64>>(&mut self, goal: &Requested, per_length: f64) {
        let (zero, one, half) = (R::of(0.0), R::of(1.0), R::of(0.5));
        let per_length = R::of(per_length);
        let [to_x, to_y, to_z, to] = goal.in_lanes::<R>();
        let [x, y, z, origin] = &self.flange;
        let [linear, angular] = &mut self.error;
        for i in 0..WIDTH {
            R::step();
            let (x, y, z) = (
                vector_in_lane::<R, _>(x, i),
                vector_in_lane::<R, _>(y, i),
                vector_in_lane::<R, _>(z, i),
            );
            let away = (to - vector_in_lane(origin, i)).scaled(per_length);
            // As `turn_between`.
            let sine = (x.cross(to_x) + y.cross(to_y) + z.cross(to_z)).scaled(half);
            let cosine = half * (x.dot(to_x) + y.dot(to_y) + z.dot(to_z) - one);
            let length = sine.dot(sine).sqrt();
            let small = length < R::of(1e-9);
            let factor = R::either(small, one, atan2(length, cosine) / R::either(small, one, length));
            let undecided = (length < R::of(1e-6)) & (cosine < zero);
            put_in_lane(linear, i, away);
            put_in_lane(angular, i, sine.scaled(factor));
            self.half_turn.set(i, R::either(undecided, one, zero));
        }
        if self.half_turn.0.contains(&1.0) {
            self.find_half_turns(goal);
        }
    }

    /// Fills the angular error of the lanes that are half a turn away.
    #[cold]
    fn find_half_turns(&mut self, goal: &Requested) {
        let [x, y, z, _] = &self.flange;
        for lane in (0..WIDTH).filter(|lane| self.half_turn.0[*lane] == 1.0) {
            let row = |axis: &[Each; 3], row: usize| axis[row].0[lane];
            let axes = Matrix3::from_fn(|r, c| row([x, y, z][c], r));
            let turned = turn_between(&axes, &goal.axes);
            for (row, turned) in self.error[1].iter_mut().zip(turned.iter()) {
                row.0[lane] = *turned;
            }
        }
    }
}

/// The step of a joint: its column times the solution.
#[inline(always)]
fn along<R: Real>([v, w]: [Vector<R>; 2], x: Vector<R>, y: Vector<R>) -> R {
    v.dot(x) + w.dot(y)
}

#[inline(always)]
fn choose<R: Real>(condition: bool, yes: Vector<R>, no: Vector<R>) -> Vector<R> {
    Vector::new(
        R::either(condition, yes.x, no.x),
        R::either(condition, yes.y, no.y),
        R::either(condition, yes.z, no.z),
    )
}
