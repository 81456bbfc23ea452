//! The method of Levenberg and Marquardt: steps of linear least squares, damped until the sum of squares decreases.
//!
//! Source: Marquardt, An algorithm for least-squares estimation of nonlinear parameters, SIAM J. Appl. Math. 11, 1963.

use super::triangle::{Triangle, solve};

/// Maximum number of steps; some five are usual.
const MOST_STEPS: usize = 60;
/// A step that lowers the sum of squares by less than this part of it is the last.
const SETTLED: f64 = 1e-13;
/// After the last permitted step this is sufficient: along a flat valley the residuals do not change any more.
const FLAT: f64 = 1e-6;
/// Initial damping, and the damping at which the search is given up.
const DAMPING: [f64; 2] = [1e-3, 1e9];

/// Residuals that depend on a state.
pub(crate) trait Problem {
    /// The unknown.
    type State: Clone;

    /// Derivatives of the prediction with respect to the steps of the state, and the residuals (measured less predicted) last.
    fn triangle(&self, state: &Self::State) -> Triangle;

    /// Sum of the squared residuals.
    fn cost(&self, state: &Self::State) -> f64;

    /// `state` after these steps.
    fn changed(&self, state: &Self::State, by: &[f64]) -> Self::State;
}

/// The state with the least sum of squares near `start`; none if the search does not converge.
pub(crate) fn descend<P: Problem>(problem: &P, start: P::State) -> Option<P::State> {
    let mut state = start;
    let mut least = problem.cost(&state);
    let mut damping = DAMPING[0];
    let mut settled = false;
    let mut gained = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let (r, z) = problem.triangle(&state).whole();
        settled = true;
        while damping < DAMPING[1] {
            let (step, _) = solve(&r, &z, damping)?;
            let next = problem.changed(&state, step.as_slice());
            let there = problem.cost(&next);
            if there <= least {
                gained = least - there;
                settled = gained <= SETTLED * least;
                (state, least) = (next, there);
                damping *= 0.1;
                break;
            }
            damping *= 10.0;
        }
        if settled {
            break;
        }
    }
    let is_found = settled || gained <= FLAT * least;
    (is_found && least.is_finite()).then_some(state)
}
