//! Compliances with their uncertainties, residuals of each test, and leave-one-out predictions.
//!
//! A test is an **outlier** if its residual, root mean square over its readings, is more than 3.5 times the expected
//! one, given the scatter of all tests. Outliers stay in the fit, with limited influence, and in every reported error.
//!
//! **Left out**: every test in turn is predicted from a fit to the others, in which sizes, points, scatter and weights
//! are all estimated again.

use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

use super::effect::{Effects, State};
use super::fit::{Fitted, Method, Problem};
use super::load_test::{LoadTest, Measured};
use super::unknown::Unknown;
use crate::robot::Robot;

/// Beyond this multiple of sigma a residual makes its test an outlier.
pub const OUTLIER: f64 = 3.5;

/// Result of an identification.
#[derive(Clone, Debug)]
pub struct Identified {
    /// One per unknown.
    pub estimates: Vec<FoundSpring>,
    /// Of the sizes, in the squares and products of their units.
    pub covariance: DMatrix<f64>,
    /// Shift of the force point from its stated position, and its standard uncertainty; m, flange frame.
    pub force_shift: Option<[Vector3<f64>; 2]>,
    /// The same for the measured point.
    pub measured_shift: Option<[Vector3<f64>; 2]>,
    /// Ratio of the standard uncertainty of a reading to the stated one.
    pub scale: f64,
    /// One per test.
    pub tests: Vec<TestOutcome>,
    /// Sets of unknowns of which only a sum is identifiable; a single one has no effect on any test.
    pub together: Vec<Vec<usize>>,
}

/// The size of one unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundSpring {
    /// rad/(N m), m/N, or rad, by its role; 0 where only a rigid part fits (without prior only).
    pub value: f64,
    /// Same unit.
    pub standard_uncertainty: f64,
    /// Share of the information from the tests instead of the prior, 0 to 1.
    pub known: f64,
}

/// One test compared with its prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct TestOutcome {
    /// Predicted minus measured, one per reading, m or rad.
    pub residuals: Vec<f64>,
    /// The same with a prediction that was fitted without this test.
    pub left_out: Vec<f64>,
    /// Root mean square of the residuals over their standard uncertainties, scatter included.
    pub standardised: f64,
    /// Weight of this test, 1 or less.
    pub weight: f64,
    /// Whether `standardised` is beyond [`OUTLIER`].
    pub outlier: bool,
}

/// Why the tests are not sufficient.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// More unknowns than readings.
    #[error("{readings} readings are not sufficient for {unknowns} unknowns")]
    TooFewReadings {
        /// Numbers measured.
        readings: usize,
        /// Springs and coordinates to be identified.
        unknowns: usize,
    },
    /// One posture shows the compliance of the tool there, but not that of each joint.
    #[error("all {tests} tests are in one posture")]
    OnePosture {
        /// Number of tests.
        tests: usize,
    },
    /// No load, or all readings zero.
    #[error("no test has both a load and a reading other than 0")]
    NothingMeasured,
}

/// Joint positions closer than this (rad, m) are one posture.
const SAME_POSTURE: f64 = 1e-3;

/// The sizes of `unknowns` from `tests`.
///
/// Not checked: that joint positions are as many as joints, that numbers are finite and uncertainties above 0.
///
/// # Errors
/// Fewer readings than unknowns, one posture only, nothing measured.
pub fn identify(
    robot: &Robot,
    unknowns: &[Unknown],
    tests: &[LoadTest],
    method: Method,
) -> Result<Identified, Refusal> {
    refuse(unknowns, tests, method)?;
    let effects = tests
        .iter()
        .map(|test| Effects::of(robot, unknowns, test))
        .collect();
    let problem = Problem::new(unknowns, tests, effects, method);
    let all: Vec<usize> = (0..tests.len()).collect();
    let fitted = problem.at_rest(&all, &problem.start());
    let state = problem.state(&fitted.x);
    let outcomes = all.par_iter().map(|test| {
        let others: Vec<usize> = all.iter().copied().filter(|other| other != test).collect();
        let without = problem.state(&problem.at_rest(&others, &fitted).x);
        test_outcome(&problem, *test, &fitted, [&state, &without])
    });
    let tests = outcomes.collect();
    let slopes = problem.slopes(&fitted.x);
    let covariance = &slopes * &fitted.spread.covariance * &slopes;
    let shifts = shifts(&state, method, &covariance);
    let of_sizes = covariance
        .view((0, 0), (unknowns.len(), unknowns.len()))
        .into_owned();
    let estimates = state.sizes.iter().enumerate().map(|(k, value)| FoundSpring {
        value: *value,
        standard_uncertainty: of_sizes[(k, k)].max(0.0).sqrt(),
        known: fitted.spread.known[k],
    });
    let only_sizes = |set: &&Vec<usize>| set.iter().all(|k| *k < unknowns.len());
    Ok(Identified {
        estimates: estimates.collect(),
        covariance: of_sizes,
        force_shift: shifts.map(|shifts| shifts[0]),
        measured_shift: shifts.map(|shifts| shifts[1]),
        scale: fitted.scale,
        tests,
        together: fitted
            .spread
            .together
            .iter()
            .filter(only_sizes)
            .cloned()
            .collect(),
    })
}

fn refuse(unknowns: &[Unknown], tests: &[LoadTest], method: Method) -> Result<(), Refusal> {
    let readings: usize = tests.iter().map(|test| test.readings.len()).sum();
    let requested = unknowns.len() + method.points.count();
    if readings < requested {
        return Err(Refusal::TooFewReadings {
            readings,
            unknowns: requested,
        });
    }
    let speaks = |test: &LoadTest| {
        test.wrench.to_vector().amax() > 0.0 && test.readings.iter().any(|reading| reading.value != 0.0)
    };
    if !tests.iter().any(speaks) {
        return Err(Refusal::NothingMeasured);
    }
    let same = |test: &LoadTest| {
        let pairs = test.joints.iter().zip(&tests[0].joints);
        pairs.fold(0.0, |far, (a, b)| f64::max(far, (a - b).abs())) < SAME_POSTURE
    };
    let turns = |test: &LoadTest| test.readings.iter().any(|r| matches!(r.what, Measured::Turn(_)));
    if requested > 1 && tests.iter().all(same) && !tests.iter().any(turns) {
        return Err(Refusal::OnePosture { tests: tests.len() });
    }
    Ok(())
}

fn test_outcome(
    problem: &Problem<'_>,
    test: usize,
    fitted: &Fitted,
    [all, without]: [&State; 2],
) -> TestOutcome {
    let readings = &problem.tests[test].readings;
    let residuals = |state: &State| -> Vec<f64> {
        let predicted = problem.effects[test].readings(problem.unknowns, state);
        predicted
            .iter()
            .zip(readings)
            .map(|(p, reading)| p - reading.value)
            .collect()
    };
    let own = residuals(all);
    let squares = own.iter().zip(readings).map(|(r, reading)| {
        let sigma = reading.standard_uncertainty * fitted.scale;
        (r / sigma).powi(2)
    });
    let length = squares.sum::<f64>().sqrt();
    let standardised = length / (readings.len().max(1) as f64).sqrt();
    TestOutcome {
        residuals: own,
        left_out: residuals(without),
        standardised,
        weight: problem.weight(length),
        outlier: standardised > OUTLIER,
    }
}

/// Shifts of force point and measured point with their standard uncertainties.
fn shifts(state: &State, method: Method, covariance: &DMatrix<f64>) -> Option<[[Vector3<f64>; 2]; 2]> {
    let unknown = method.points.count();
    let first = covariance.nrows() - unknown;
    let root = |variance: f64| variance.max(0.0).sqrt();
    let of_force =
        (unknown > 0).then(|| Vector3::from_fn(|j, _| root(covariance[(first + j, first + j)])))?;
    // The measured point is shifted by the sum of both.
    let of_measured = Vector3::from_fn(|j, _| {
        let (a, b) = (first + j, first + j + 3);
        if unknown == 6 {
            root(covariance[(a, a)] + covariance[(b, b)] + 2.0 * covariance[(a, b)])
        } else {
            root(covariance[(a, a)])
        }
    });
    Some([[state.force_shift, of_force], [state.measured_shift, of_measured]])
}

#[cfg(test)]
mod tests {
    use super::super::fit::{Loss, Points, Scatter};
    use super::super::prior::Prior;
    use super::super::small_arm::{arm, tests};
    use super::super::unknown::{bending, drives};
    use super::*;

    fn plain() -> Method {
        Method {
            prior: Prior::None,
            points: Points::Known,
            loss: Loss::Squares,
            scatter: Scatter::Found,
        }
    }

    fn usual() -> Method {
        Method {
            prior: Prior::Typical,
            loss: Loss::Huber,
            ..plain()
        }
    }

    /// Rows of all tests by the sizes of the drives.
    fn rows(tests: &[LoadTest]) -> DMatrix<f64> {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let mut rows = DMatrix::zeros(3 * tests.len(), unknowns.len());
        for (t, test) in tests.iter().enumerate() {
            let effect = Effects::of(&robot, &unknowns, test).jacobian(&unknowns, &State::typical(&unknowns));
            rows.rows_mut(3 * t, 3)
                .copy_from(&effect.columns(0, unknowns.len()));
        }
        rows
    }

    #[test]
    fn left_out_residuals_of_a_linear_fit_are_those_of_its_leverage() {
        // Of least squares: left out = (I - H_tt)^-1 residual, H = A (A^T A)^-1 A^T; no refit is needed.
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let tests = tests(&unknowns, &State::of_sizes(vec![2e-6, 3e-6, 5e-6]), 8, 5e-5);
        let found = identify(&robot, &unknowns, &tests, plain()).unwrap();
        let a = rows(&tests);
        let hat = &a * a.tr_mul(&a).try_inverse().unwrap() * a.transpose();
        for (t, outcome) in found.tests.iter().enumerate() {
            let own = nalgebra::Matrix3::from_fn(|i, j| hat[(3 * t + i, 3 * t + j)]);
            let residual = Vector3::from_column_slice(&outcome.residuals);
            let expected = (nalgebra::Matrix3::identity() - own).try_inverse().unwrap() * residual;
            let left_out = Vector3::from_column_slice(&outcome.left_out);
            assert!(
                (left_out - expected).norm() < 1e-9 * expected.norm(),
                "{t}: {left_out} {expected}"
            );
            assert!(
                left_out.norm() > residual.norm(),
                "a test pulls the fit to itself"
            );
        }
    }

    #[test]
    fn sizes_scatter_and_covariance_of_a_linear_fit_are_those_of_the_textbook() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let tests = tests(&unknowns, &State::of_sizes(vec![2e-6, 3e-6, 5e-6]), 8, 5e-5);
        let found = identify(&robot, &unknowns, &tests, plain()).unwrap();
        let a = rows(&tests);
        let values = tests
            .iter()
            .flat_map(|test| &test.readings)
            .map(|reading| reading.value);
        let b = nalgebra::DVector::from_iterator(a.nrows(), values);
        let inverse = a.tr_mul(&a).try_inverse().unwrap();
        let sizes = &inverse * a.tr_mul(&b);
        let left = (&a * &sizes - &b).norm_squared();
        let variance = left / (a.nrows() - a.ncols()) as f64;
        // Readings state 1e-5 m. The scale is found to 1e-4 of itself.
        assert!(
            (found.scale / (variance.sqrt() / 1e-5) - 1.0).abs() < 2e-4,
            "{}",
            found.scale
        );
        for (k, spring) in found.estimates.iter().enumerate() {
            assert!((spring.value / sizes[k] - 1.0).abs() < 1e-9, "{spring:?}");
            let u = (variance * inverse[(k, k)]).sqrt();
            assert!(
                (spring.standard_uncertainty / u - 1.0).abs() < 2e-4,
                "{spring:?} {u}"
            );
            assert!((spring.known - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_order_of_tests_and_of_unknowns_has_no_effect() {
        let robot = arm(1.0);
        let unknowns = [drives(&robot), bending(&robot)].concat();
        let tests = tests(&unknowns, &State::typical(&unknowns), 12, 5e-5);
        let turned: Vec<LoadTest> = tests.iter().rev().cloned().collect();
        let backward: Vec<Unknown> = unknowns.iter().rev().copied().collect();
        let here = identify(&robot, &unknowns, &tests, usual()).unwrap();
        let there = identify(&robot, &backward, &turned, usual()).unwrap();
        for (one, other) in here.estimates.iter().zip(there.estimates.iter().rev()) {
            // The scale converges to 1e-4, which changes the sizes by a part of their uncertainty.
            assert!(
                (one.value - other.value).abs() < 1e-3 * one.standard_uncertainty,
                "{one:?} {other:?}"
            );
        }
        for (one, other) in here.tests.iter().zip(there.tests.iter().rev()) {
            assert_eq!(one.outlier, other.outlier);
            assert!((one.standardised - other.standardised).abs() < 1e-3);
        }
    }

    #[test]
    fn twice_the_displacement_is_twice_the_spring_and_twice_the_load_half_of_it() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let tests = tests(&unknowns, &State::of_sizes(vec![2e-6, 3e-6, 5e-6]), 8, 5e-5);
        let values = |tests: &[LoadTest]| -> Vec<f64> {
            let found = identify(&robot, &unknowns, tests, plain()).unwrap();
            found.estimates.iter().map(|spring| spring.value).collect()
        };
        let here = values(&tests);
        let mut farther = tests.clone();
        for reading in farther.iter_mut().flat_map(|test| &mut test.readings) {
            reading.value *= 2.0;
        }
        let mut harder = tests.clone();
        for test in &mut harder {
            test.wrench.force *= 2.0;
        }
        for ((here, twice), half) in here.iter().zip(values(&farther)).zip(values(&harder)) {
            assert!((twice / here - 2.0).abs() < 1e-9 && (half / here - 0.5).abs() < 1e-9);
        }
    }

    #[test]
    fn the_uncertainty_of_the_measured_point_is_that_of_the_sum_of_both_shifts() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let tests = tests(&unknowns, &State::typical(&unknowns), 14, 1e-5);
        let with = |points| identify(&robot, &unknowns, &tests, Method { points, ..usual() }).unwrap();
        let known = with(Points::Known);
        assert!(known.force_shift.is_none() && known.measured_shift.is_none());
        let common = with(Points::Common(0.1));
        assert_eq!(common.force_shift, common.measured_shift);
        let apart = with(Points::Separate(0.1));
        let (force, measured) = (apart.force_shift.unwrap(), apart.measured_shift.unwrap());
        // Both are at their stated positions, within four standard uncertainties.
        for [shift, u] in [force, measured] {
            assert!(
                (0..3).all(|k| u[k] > 0.0 && shift[k].abs() < 4.0 * u[k]),
                "{shift} {u}"
            );
        }
        assert_ne!(force, measured);
    }

    #[test]
    fn every_error_states_its_reason() {
        let given = [
            (
                Refusal::TooFewReadings {
                    readings: 3,
                    unknowns: 6,
                },
                "3 readings are not sufficient for 6 unknowns",
            ),
            (Refusal::OnePosture { tests: 4 }, "all 4 tests are in one posture"),
            (
                Refusal::NothingMeasured,
                "no test has both a load and a reading other than 0",
            ),
        ];
        for (refusal, text) in given {
            assert_eq!(refusal.to_string(), text);
        }
    }
}
