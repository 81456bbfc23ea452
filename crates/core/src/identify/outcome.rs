//! Springs with their uncertainties, what each test says of them, and how well they predict a test they have not seen.
//!
//! A test is an **outlier** if its residual, root mean square over its readings, is more than 3.5 times what the scatter
//! of all tests leads one to expect. Outliers stay in the fit, where their pull is limited, and in every error told.
//!
//! **Left out**: every test in turn is predicted from a fit to the others, in which sizes, points, scatter and weights
//! are all found anew.

use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

use super::effect::{Effects, State};
use super::fit::{Fitted, Method, Problem};
use super::load_test::{LoadTest, Measured};
use super::unknown::Unknown;
use crate::robot::Robot;

/// A residual beyond so many sigma names its test an outlier.
pub const OUTLIER: f64 = 3.5;

/// What load tests tell of an arm.
#[derive(Clone, Debug)]
pub struct Identified {
    /// One an unknown.
    pub estimates: Vec<FoundSpring>,
    /// Of the sizes, in the squares and products of their units.
    pub covariance: DMatrix<f64>,
    /// Where the force acted against what the tests say, and its standard uncertainty; m, flange frame.
    pub force_shift: Option<[Vector3<f64>; 2]>,
    /// Where displacement was measured, likewise.
    pub measured_shift: Option<[Vector3<f64>; 2]>,
    /// Standard uncertainty of a reading over the one that it states.
    pub scale: f64,
    /// One a test.
    pub tests: Vec<TestOutcome>,
    /// Sets of unknowns of which the tests tell only a sum; a single one is seen by no test.
    pub together: Vec<Vec<usize>>,
}

/// The size of one unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundSpring {
    /// rad/(N m), m/N, or rad, as its role says; 0 where nothing but rigid fits (without prior only).
    pub value: f64,
    /// Same unit.
    pub standard_uncertainty: f64,
    /// Share known from the tests rather than from the prior, 0 to 1.
    pub known: f64,
}

/// One test beside what the springs say.
#[derive(Clone, Debug, PartialEq)]
pub struct TestOutcome {
    /// Predicted minus measured, one a reading, m or rad.
    pub residuals: Vec<f64>,
    /// The same with a prediction that has not seen this test.
    pub left_out: Vec<f64>,
    /// Root mean square of the residuals over their standard uncertainties, scatter included.
    pub standardised: f64,
    /// Weight of this test, 1 or less.
    pub weight: f64,
    /// Whether `standardised` is beyond [`OUTLIER`].
    pub outlier: bool,
}

/// Why tests cannot tell what is asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// More unknowns than numbers.
    #[error("{readings} readings for {unknowns} unknowns")]
    TooFewReadings {
        /// Numbers measured.
        readings: usize,
        /// Springs and coordinates asked for.
        unknowns: usize,
    },
    /// One posture tells how the tool yields there, not which joint does.
    #[error("all {tests} tests stand in one posture")]
    OnePosture {
        /// How many.
        tests: usize,
    },
    /// No load, or all readings zero.
    #[error("no test has both a load and a reading other than 0")]
    NothingMeasured,
}

/// Joint positions nearer than this (rad, m) are one posture.
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
    let asked = unknowns.len() + method.points.count();
    if readings < asked {
        return Err(Refusal::TooFewReadings {
            readings,
            unknowns: asked,
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
    if asked > 1 && tests.iter().all(same) && !tests.iter().any(turns) {
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
