//! The period of the cyclic error of an axis, where it is not given.
//!
//! Periods are tried from that of four samples to the radius, evenly in turns along an axis; for each, the part that
//! its four waves (see [`super::term`]) explain of the residual of the other parts. The best is taken where that is
//! above noise: as `F` of four unknowns, beyond `LEAST_F`.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::super::profile::Profile;
use super::super::run::{CircularTest, Direction};
use super::fit::{PartsOptions, rest_without_cyclic};
use super::term::{Axis, Term, Wave};

/// Noise gives less in all but one of 1e4 searches over some hundred periods.
const LEAST_F: f64 = 12.0;
/// Trials per turn along the diameter: a wave between two is missed only slightly.
const TRIALS_A_TURN: f64 = 4.0;
/// Finer trials round the best one, to each side.
const FINER: i32 = 20;

/// The periods that a test resolves, m: that of four samples where they are densest, and the radius. A shorter one is
/// seen as another, a longer one does not repeat.
pub fn periods(test: &CircularTest) -> [f64; 2] {
    let densest = test
        .runs()
        .iter()
        .map(Profile::of)
        .filter(|profile| profile.arc() > 0.0);
    let densest = densest.map(|profile| profile.samples().count() as f64 / profile.arc());
    let least = 4.0 * test.radius() / densest.fold(f64::MIN_POSITIVE, f64::max);
    [least, test.radius()]
}

/// The period of the strongest cyclic error along either axis, m; `None` where none is significant.
pub fn strongest_period(test: &CircularTest, requested: &PartsOptions) -> Option<f64> {
    let (samples, rows, rest) = rest_without_cyclic(test, requested)?;
    let base = rows.clone().qr().q();
    let [shortest, longest] = periods(test);
    // Turns along a radius: of a period as long as the radius to one of four samples.
    let [least, most] = [longest, shortest].map(|period| test.radius() / period);
    let explained = |turns: f64| explained(&samples.at, &base, &rest, turns);
    let trials = ((most - least).max(0.0) * 2.0 * TRIALS_A_TURN) as usize;
    let coarse = (0..=trials).map(|k| least + k as f64 / (2.0 * TRIALS_A_TURN));
    let best = |turns: Vec<f64>| -> Option<(f64, f64)> {
        let tried = turns.into_iter().map(|turns| (turns, explained(turns)));
        tried.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (coarsely, _) = best(coarse.collect())?;
    let step = 1.0 / (2.0 * TRIALS_A_TURN * f64::from(FINER));
    let finer = (-FINER..=FINER).map(|k| coarsely + f64::from(k) * step);
    let (turns, squares) = best(finer.filter(|turns| *turns > 0.0).collect())?;
    let freedom = rest.len() as f64 - base.ncols() as f64 - 4.0;
    let left = (rest.norm_squared() - squares).max(f64::MIN_POSITIVE);
    let f = squares / 4.0 / (left / freedom);
    (freedom > 0.0 && f > LEAST_F && rest.norm() > 0.0).then(|| test.radius() / turns)
}

/// Squares of the residuals explained by waves of this many turns along a radius.
fn explained(at: &[(f64, Direction)], base: &DMatrix<f64>, rest: &DVector<f64>, turns: f64) -> f64 {
    let terms =
        [Axis::A, Axis::B].map(|axis| [Wave::Cosine, Wave::Sine].map(|wave| Term::Cyclic(axis, wave)));
    let waves = DMatrix::from_fn(at.len(), 4, |row, column| {
        let (angle, direction) = at[row];
        terms[column / 2][column % 2].at(angle, direction, &[], TAU * turns)
    });
    // The projection of a wave on the other terms belongs to those.
    let own = &waves - base * base.tr_mul(&waves);
    let q = own.qr().q();
    q.tr_mul(rest).norm_squared()
}
