//! Data check of load tests: signs and order of forces and displacements, signs and zeros of the joints.
//!
//! The residual is the mean error of the displacements that are predicted from the other tests. Displacements grow with
//! the force: forces and displacements with opposite signs are one slip, not two. A unit changes all compliances alike
//! and is not seen here.

use armill_core::identify::{LoadTest, Measured, Method, Reading, Unknown, displacement_errors, identify};
use armill_core::robot::{Axis, Robot};
use armill_core::spatial::Wrench;

use super::axes::AxisChange;
use super::joints::JointChange;
use super::{BETTER, SlipAnswer, Trial, likely_slip};

/// Left-out tests that are missed by a smaller fraction have no slip worth a search.
const GOOD: f64 = 0.1;

/// The likely slip of `tests`; none of tests that predict each other well. `missed` is the mean error of left-out
/// tests, m, and its fraction of the measured displacements; infinite where nothing was identified.
pub fn slip(
    robot: &Robot,
    unknowns: &[Unknown],
    tests: &[LoadTest],
    method: Method,
    missed: [f64; 2],
) -> Option<SlipAnswer> {
    let [as_given, fraction] = missed;
    if fraction < GOOD {
        return None;
    }
    let residual = |tests: &[LoadTest]| -> f64 {
        let Ok(identified) = identify(robot, unknowns, tests, method) else {
            return f64::INFINITY;
        };
        let left_out = identified.tests.iter().map(|test| &test.left_out);
        displacement_errors(tests, left_out).map_or(f64::INFINITY, |errors| errors.mean)
    };
    let trial = |change: String, of: &dyn Fn(&LoadTest) -> LoadTest| {
        let changed: Vec<LoadTest> = tests.iter().map(of).collect();
        Trial {
            change,
            residual: residual(&changed),
        }
    };
    let mut trials = Vec::new();
    for change in AxisChange::all() {
        let words = change.words();
        // A common sign is the same for both.
        if words == "all signs reversed" {
            let both = "forces (or displacements) of the opposite sign".to_owned();
            trials.push(trial(both, &|test| with_displacements(test, &change)));
            continue;
        }
        trials.push(trial(format!("displacements with {words}"), &|test| {
            with_displacements(test, &change)
        }));
        trials.push(trial(format!("forces with {words}"), &|test| {
            with_forces(test, &change)
        }));
    }
    for change in JointChange::all(robot) {
        trials.push(trial(change.words(robot), &|test| LoadTest {
            joints: change.of(robot, &test.joints),
            ..test.clone()
        }));
    }
    likely_slip(as_given, BETTER, &trials)
}

/// Number of tests whose displacement is against the force, and of all that have both; none of fewer than three.
pub fn against_force(tests: &[LoadTest]) -> Option<[usize; 2]> {
    let works: Vec<f64> = tests
        .iter()
        .filter_map(|test| {
            let moves = test.displacement();
            let work: f64 = (0..3)
                .map(|k| moves[k].unwrap_or(0.0) * test.wrench.force[k])
                .sum();
            (work != 0.0).then_some(work)
        })
        .collect();
    let against = works.iter().filter(|work| **work < 0.0).count();
    (works.len() > 2).then_some([against, works.len()])
}

fn with_displacements(test: &LoadTest, change: &AxisChange) -> LoadTest {
    let reading = |reading: &Reading| match reading.what {
        Measured::Displacement(axis) => {
            let (to, sign) = change.moves(axis.index());
            Reading {
                what: Measured::Displacement(Axis::ALL[to]),
                value: sign * reading.value,
                ..*reading
            }
        }
        Measured::Turn(_) => *reading,
    };
    LoadTest {
        readings: test.readings.iter().map(reading).collect(),
        ..test.clone()
    }
}

fn with_forces(test: &LoadTest, change: &AxisChange) -> LoadTest {
    LoadTest {
        wrench: Wrench {
            force: change.of(&test.wrench.force),
            moment: test.wrench.moment,
        },
        ..test.clone()
    }
}
