//! From a start to a posture of the pose: damped least squares, and the pull of redundant joints.
//!
//! ```text
//! e = [(p* - p)/l; angle axis of R* R^T]        J: screws at the flange, linear rows over l
//! dtheta = J^T (J J^T + lambda I)^-1 e          lambda = damping |e|^2, more where a step does not help
//! ```
//!
//! Damping by the squared error leaves Newton's steps near the solution: the number of right digits doubles. With more
//! than six joints the pull `z = (home - theta)/2` goes through the null space: `dtheta = z + J^+ (e - J z)`.
//!
//! `theta` chain positions (rad, m), `l` a length of the arm (m) that makes both rows comparable. Source: Levenberg
//! 1944, Marquardt 1963; damping by the error after Sugihara 2011; pull after Liegeois 1977.

use std::f64::consts::TAU;

use nalgebra::{Matrix6, Vector6};

use super::super::chain::{Chain, Motion};
use super::super::forward::{Frames, chain_forward_into};
use super::super::jacobian::chain_screws_into;
use super::super::unreachable::Unreachable;
use super::verify::Requested;
use crate::frame::turn_between;
use crate::spatial::Twist;

/// Error (l, rad) below which a pose is reached: a hundred times below the tolerance of the check that follows.
pub(super) const DONE: f64 = 1e-12;
/// Maximum number of steps of one descent: a Newton iteration that halves its error ends long before.
pub(super) const MOST_STEPS: usize = 60;
/// Longest step of a joint, rad (l): beyond it the linear model is not valid.
pub(super) const LONGEST_STEP: f64 = 0.7;
/// Steps in a row after each of which more than this share of the squared error is left, before a descent is given up.
pub(super) const PATIENCE: usize = 5;
pub(super) const SMALL_GAIN: f64 = 0.9;
/// Damping of the first step; after a step that helps times `LESS`, after one that does not times `MORE` and at least
/// `MORE` times the least.
pub(super) const FIRST_DAMPING: f64 = 1e-2;
pub(super) const LESS: f64 = 0.2;
pub(super) const MORE: f64 = 10.0;
pub(super) const LEAST_DAMPING: f64 = 1e-3;
/// Least damping relative to the trace: what the factors of a singular matrix need, or ten times that, and so on.
pub(super) const ROUNDING: f64 = 1e-15;
/// Damping beyond which no step helps.
pub(super) const STUCK: f64 = 1e9;
/// Maximum number of pulls of a redundant chain, and the step (rad, l) below which it has converged.
const MOST_PULLS: usize = 60;
const SETTLED: f64 = 1e-6;
/// Frobenius condition number of the Jacobian above which joints are nearly dependent.
pub(super) const DEPENDENT: f64 = 300.0;

/// Working memory for descents of one chain.
#[derive(Clone, Debug)]
pub(super) struct Descent {
    length: f64,
    /// Index of a fixed joint.
    still: Option<usize>,
    frames: Frames,
    screws: Vec<Twist>,
    columns: Vec<Vector6<f64>>,
    trial: Vec<f64>,
}

impl Descent {
    pub fn new(chain: &Chain) -> Descent {
        let count = chain.links().len();
        Descent {
            length: chain.length(),
            still: None,
            frames: Frames::for_joints(count),
            screws: vec![Twist::ZERO; count],
            columns: vec![Vector6::zeros(); count],
            trial: vec![0.0; count],
        }
    }

    /// Moves `theta` until the flange is at `goal`.
    ///
    /// # Errors
    /// [`Unreachable::NotFound`] with the remaining error; `theta` then is the best that was found.
    pub fn reach(&mut self, chain: &Chain, goal: &Requested, theta: &mut [f64]) -> Result<(), Unreachable> {
        let mut error = self.error(chain, goal, theta);
        let mut size = error.norm_squared();
        if size < DONE * DONE {
            return Ok(());
        }
        let (mut damping, mut idle) = (FIRST_DAMPING, 0);
        self.linearise(chain);
        for _ in 0..MOST_STEPS {
            if size < DONE * DONE || damping > STUCK || idle > PATIENCE {
                break;
            }
            let step = self.least_squares(&error, damping * size);
            self.try_step(theta, |column| column.dot(&step));
            let trial_error = self.error_of_trial(chain, goal);
            let trial_size = trial_error.norm_squared();
            if trial_size < size {
                idle = if trial_size > SMALL_GAIN * size {
                    idle + 1
                } else {
                    0
                };
                theta.copy_from_slice(&self.trial);
                (error, size) = (trial_error, trial_size);
                damping *= LESS;
                self.linearise(chain);
            } else {
                damping = damping.max(LEAST_DAMPING) * MORE;
            }
        }
        outcome(&error, self.length)
    }

    /// [`Descent::reach`] with joint `still` fixed.
    ///
    /// # Errors
    /// Those of [`Descent::reach`].
    pub fn reach_with_fixed(
        &mut self,
        chain: &Chain,
        goal: &Requested,
        still: usize,
        theta: &mut [f64],
    ) -> Result<(), Unreachable> {
        self.still = Some(still);
        let reached = self.reach(chain, goal, theta);
        self.still = None;
        reached
    }

    /// [`Descent::reach`], then as near to `home` (chain positions) as the redundant joints allow.
    ///
    /// # Errors
    /// Those of [`Descent::reach`].
    pub fn reach_near(
        &mut self,
        chain: &Chain,
        goal: &Requested,
        home: &[f64],
        theta: &mut [f64],
    ) -> Result<(), Unreachable> {
        self.reach(chain, goal, theta)?;
        for ((theta, home), link) in theta.iter_mut().zip(home).zip(chain.links()) {
            if matches!(link.motion, Motion::About(..)) {
                *theta -= TAU * ((*theta - home) / TAU).round();
            }
        }
        for _ in 0..MOST_PULLS {
            let error = self.error(chain, goal, theta);
            self.linearise(chain);
            let pull = |i: usize| 0.5 * (home[i] - theta[i]);
            let pulled: Vector6<f64> = self.columns.iter().enumerate().map(|(i, c)| c * pull(i)).sum();
            let step = self.least_squares(&(error - pulled), error.norm_squared());
            let mut largest: f64 = 0.0;
            for (i, (trial, column)) in self.trial.iter_mut().zip(&self.columns).enumerate() {
                *trial = pull(i) + column.dot(&step);
                largest = largest.max(trial.abs());
            }
            let shorter = (0.3 / largest).min(1.0);
            for (theta, step) in theta.iter_mut().zip(&self.trial) {
                *theta += shorter * step;
            }
            if largest < SETTLED {
                break;
            }
        }
        self.reach(chain, goal, theta)
    }

    /// Whether some joints are nearly dependent at `theta`: the Jacobian is ill conditioned. False for fewer than six
    /// joints, which never span all directions.
    pub fn dependent(&mut self, chain: &Chain, theta: &[f64]) -> bool {
        if theta.len() < 6 {
            return false;
        }
        chain_forward_into(chain, |i| theta[i], &mut self.frames);
        self.linearise(chain);
        let gram = self.gram();
        let inverse = gram.cholesky().map(|factor| factor.inverse());
        inverse.is_none_or(|inverse| inverse.trace() * gram.trace() > DEPENDENT * DEPENDENT)
    }

    fn error(&mut self, chain: &Chain, goal: &Requested, theta: &[f64]) -> Vector6<f64> {
        chain_forward_into(chain, |i| theta[i], &mut self.frames);
        self.difference(goal)
    }

    fn error_of_trial(&mut self, chain: &Chain, goal: &Requested) -> Vector6<f64> {
        chain_forward_into(chain, |i| self.trial[i], &mut self.frames);
        self.difference(goal)
    }

    /// Error of the flange relative to the goal, in units of `length` and rad.
    fn difference(&self, goal: &Requested) -> Vector6<f64> {
        let flange = &self.frames.base_from_flange;
        let away = (goal.origin - flange.translation.vector) / self.length;
        let turned = turn_between(flange.rotation.matrix(), &goal.axes);
        Vector6::new(away.x, away.y, away.z, turned.x, turned.y, turned.z)
    }

    /// Fills the columns of the scaled Jacobian at the current frames.
    fn linearise(&mut self, chain: &Chain) {
        let flange = self.frames.base_from_flange.translation.vector.into();
        chain_screws_into(chain, &self.frames, &flange, &mut self.screws);
        for (column, screw) in self.columns.iter_mut().zip(&self.screws) {
            let (v, w) = (screw.linear / self.length, screw.angular);
            *column = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
        }
        if let Some(still) = self.still {
            self.columns[still] = Vector6::zeros();
        }
    }

    fn gram(&self) -> Matrix6<f64> {
        let mut gram = Matrix6::zeros();
        for c in &self.columns {
            gram.ger(1.0, c, c, 1.0);
        }
        gram
    }

    /// `(J J^T + lambda I)^-1 e`.
    fn least_squares(&self, error: &Vector6<f64>, lambda: f64) -> Vector6<f64> {
        let gram = self.gram();
        // A singular Jacobian gets the least damping that the factors need.
        let least = ROUNDING * gram.trace();
        (0..16)
            .map(|power| lambda.max(least * 10f64.powi(power)))
            .find_map(|lambda| (gram + Matrix6::from_diagonal_element(lambda)).cholesky())
            .map_or_else(Vector6::zeros, |factor| factor.solve(error))
    }

    /// Fills the trial with `theta` and the step of each column, each limited to the range of the linear model.
    fn try_step(&mut self, theta: &[f64], step: impl Fn(&Vector6<f64>) -> f64) {
        let mut largest: f64 = 0.0;
        for (trial, column) in self.trial.iter_mut().zip(&self.columns) {
            *trial = step(column);
            largest = largest.max(trial.abs());
        }
        let shorter = (LONGEST_STEP / largest).min(1.0);
        for (trial, theta) in self.trial.iter_mut().zip(theta) {
            *trial = theta + shorter * *trial;
        }
    }
}

/// Whether a descent has reached its goal, or the error (in units of `length`, rad) that remains.
pub(super) fn outcome(error: &Vector6<f64>, length: f64) -> Result<(), Unreachable> {
    let (by, turned) = (error.xyz().norm() * length, error.fixed_rows::<3>(3).norm());
    // Rounding of a long chain may stop short of DONE; the check that follows decides.
    if by < 1e-9 && turned < 1e-9 {
        Ok(())
    } else {
        Err(Unreachable::NotFound { by, turned })
    }
}

#[cfg(test)]
mod tests;
