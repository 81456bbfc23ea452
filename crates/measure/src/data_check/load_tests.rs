//! Data check of load tests: signs and order of forces and displacements, signs, zeros and order of the joints, one
//! gross outlier.
//!
//! The residual is the mean error of the displacements with the compliances of the drives, none below zero, that fit
//! best. Displacements grow with the force: forces and displacements with opposite signs are one slip, not two. A unit
//! changes all compliances alike and is not seen here.

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::unknown::drives;
use armill_core::identify::{LoadTest, Measured, Reading, Unknown};
use armill_core::nalgebra::{DMatrix, DVector};
use armill_core::robot::{Axis, Robot};
use armill_core::spatial::Wrench;

use super::axes::AxisChange;
use super::joints::JointChange;
use super::{BETTER, SlipAnswer, Trial, likely_slip};

/// Tests whose residual is a smaller fraction of their displacements have no slip that is worth a search.
const GOOD: f64 = 0.1;
/// Tests with the largest errors that may be gross outliers.
const SUSPECTS: usize = 5;
/// Fewer tests than these decide nothing.
const FEWEST: usize = 4;

/// The likely slip of `tests` with these names; none of tests that fit the drives of `robot` well.
pub fn slip(robot: &Robot, tests: &[LoadTest], names: &[String]) -> Option<SlipAnswer> {
    let unknowns = drives(robot);
    let as_given = errors(robot, &unknowns, tests);
    let measured: f64 = tests.iter().map(displacement).sum();
    let residual = mean(&as_given);
    if tests.len() < FEWEST || as_given.iter().sum::<f64>() < GOOD * measured {
        return None;
    }
    let trial = |change: String, changed: Vec<LoadTest>| Trial {
        change,
        residual: mean(&errors(robot, &unknowns, &changed)),
    };
    let each = |of: &dyn Fn(&LoadTest) -> LoadTest| -> Vec<LoadTest> { tests.iter().map(of).collect() };
    let mut trials = Vec::new();
    for change in AxisChange::all() {
        let words = change.words();
        let displaced = each(&|test| with_displacements(test, &change));
        if change.is_common_sign() {
            trials.push(trial(
                "forces (or displacements) of the opposite sign".to_owned(),
                displaced,
            ));
            continue;
        }
        trials.push(trial(format!("{words} in the displacements"), displaced));
        let forced = each(&|test| with_forces(test, &change));
        trials.push(trial(format!("{words} in the forces"), forced));
    }
    for change in JointChange::all(robot) {
        let changed = each(&|test| LoadTest {
            joints: change.of(robot, &test.joints),
            ..test.clone()
        });
        trials.push(trial(change.words(robot), changed));
    }
    let mut order: Vec<usize> = (0..tests.len()).collect();
    order.sort_by(|a, b| as_given[*b].total_cmp(&as_given[*a]));
    for place in order.into_iter().take(SUSPECTS) {
        let mut others = tests.to_vec();
        others.remove(place);
        trials.push(trial(format!("test {} left out", names[place]), others));
    }
    likely_slip(residual, BETTER, &trials)
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

/// Length of the measured displacement, m.
fn displacement(test: &LoadTest) -> f64 {
    let squares = test.displacement().into_iter().flatten().map(|d| d * d);
    squares.sum::<f64>().sqrt()
}

/// Mean of lengths, m.
fn mean(lengths: &[f64]) -> f64 {
    lengths.iter().sum::<f64>() / lengths.len().max(1) as f64
}

/// Length of the error of the displacement in each test, m, with the sizes of `unknowns` that fit best.
fn errors(robot: &Robot, unknowns: &[Unknown], tests: &[LoadTest]) -> Vec<f64> {
    let at = State::of_sizes(vec![0.0; unknowns.len()]);
    let (mut rows, mut values, mut places) = (Vec::new(), Vec::new(), Vec::new());
    for (place, test) in tests.iter().enumerate() {
        let jacobian = Effects::of(robot, unknowns, test).jacobian(unknowns, &at);
        for (row, reading) in test.readings.iter().enumerate() {
            if let Measured::Displacement(_) = reading.what {
                rows.push(jacobian.row(row).columns(0, unknowns.len()).into_owned());
                values.push(reading.value);
                places.push(place);
            }
        }
    }
    let mut squares = vec![0.0; tests.len()];
    if rows.is_empty() {
        return squares;
    }
    let effects = DMatrix::from_rows(&rows);
    let values = DVector::from_vec(values);
    let residual = &effects * sizes(&effects, &values) - &values;
    for (place, residual) in places.iter().zip(residual.iter()) {
        squares[*place] += residual * residual;
    }
    squares.iter().map(|square: &f64| square.sqrt()).collect()
}

/// The sizes of least squares, none below zero: those that would be are left out, one after the other.
fn sizes(effects: &DMatrix<f64>, values: &DVector<f64>) -> DVector<f64> {
    let mut kept: Vec<usize> = (0..effects.ncols()).collect();
    let mut sizes = DVector::zeros(effects.ncols());
    while !kept.is_empty() {
        let columns = effects.select_columns(kept.iter());
        let Ok(found) = columns.svd(true, true).solve(values, 1e-12) else {
            return sizes;
        };
        let Some(least) = (0..kept.len())
            .filter(|k| found[*k] < 0.0)
            .min_by(|a, b| found[*a].total_cmp(&found[*b]))
        else {
            for (k, column) in kept.iter().enumerate() {
                sizes[*column] = found[k];
            }
            return sizes;
        };
        kept.remove(least);
    }
    sizes
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

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::Vector3;
    use armill_study::robots;

    use super::*;

    /// Load tests of an MH12 with 2e-6 rad/(N m) in every joint, and their names.
    fn tests(robot: &Robot) -> (Vec<LoadTest>, Vec<String>) {
        let unknowns = drives(robot);
        let state = State::of_sizes(vec![2e-6; 6]);
        let point = Vector3::new(0.0, 0.06, 0.15);
        let test = |k: usize| {
            let at = |j: usize| ((k * 7 + j * 3) % 11) as f64 * 0.15 - 0.7;
            let force = [Vector3::x(), Vector3::y(), -Vector3::z()][k % 3] * 100.0;
            let mut test = LoadTest {
                joints: (0..6).map(at).collect(),
                wrench: Wrench::from_force(force),
                force_point: point,
                measured_point: point,
                readings: Axis::ALL
                    .map(|axis| Reading {
                        what: Measured::Displacement(axis),
                        value: 0.0,
                        standard_uncertainty: 1e-5,
                    })
                    .to_vec(),
            };
            let readings = Effects::of(robot, &unknowns, &test).readings(&unknowns, &state);
            for (reading, value) in test.readings.iter_mut().zip(readings) {
                reading.value = value;
            }
            test
        };
        (
            (0..18).map(test).collect(),
            (1..=18).map(|k| k.to_string()).collect(),
        )
    }

    #[test]
    fn good_tests_have_no_slip_and_every_change_of_the_axes_is_found() {
        let found = robots::find("yaskawa/mh12", ".".as_ref()).unwrap();
        let (tests, names) = tests(&found.robot);
        assert_eq!(slip(&found.robot, &tests, &names), None);
        assert_eq!(against_force(&tests), Some([0, 18]));
        for change in AxisChange::all() {
            let changed: Vec<LoadTest> = tests
                .iter()
                .map(|test| with_displacements(test, &change))
                .collect();
            let slip = slip(&found.robot, &changed, &names).unwrap();
            assert!(slip.residual_um < 1e-3, "{}: {}", change.words(), slip.sentence());
        }
    }

    #[test]
    fn signs_and_order_of_joints_and_one_outlier_are_named() {
        let found = robots::find("yaskawa/mh12", ".".as_ref()).unwrap();
        let (tests, names) = tests(&found.robot);
        let with = |change: &dyn Fn(usize, &mut LoadTest)| {
            let mut changed = tests.clone();
            changed
                .iter_mut()
                .enumerate()
                .for_each(|(k, test)| change(k, test));
            slip(&found.robot, &changed, &names).unwrap().changes
        };
        assert_eq!(with(&|_, test| test.joints[2] *= -1.0), ["joint U negated"]);
        assert_eq!(
            with(&|_, test| test.joints.swap(1, 2)),
            ["joints L and U exchanged"]
        );
        let gross = |k: usize, test: &mut LoadTest| {
            if k == 4 {
                test.readings[2].value += 0.05;
            }
        };
        assert_eq!(with(&gross), ["test 5 left out"]);
    }
}
