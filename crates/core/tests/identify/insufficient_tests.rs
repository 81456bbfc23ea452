//! Outlying tests, tests that leave springs undetermined, and insufficient tests are reported.

use armill_core::identify::effect::State;
use armill_core::identify::unknown::drives;
use armill_core::identify::{
    Identified, Loss, Method, Refusal, Role, Unknown, identify, measured_over_typical,
};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Attachment;
use armill_core::robot::chain::Axis;

use crate::{Random, arms, loads, measure, usual};

#[test]
fn one_outlying_test_is_reported_and_has_little_influence() {
    let (robot, mut random) = (arms::kr120(), Random(3));
    let unknowns = drives(&robot);
    let truth = vec![6e-7, 5e-7, 9e-7, 2e-6, 3e-6, 5e-6];
    let mut tests = loads(&robot, 25, &mut random);
    let mut noise = Random(4);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(truth.clone()),
        &mut tests,
        || 1e-5 * noise.normal(),
    );
    tests[7].readings[1].value += 2e-3;
    let robust = identify(&robot, &unknowns, &tests, usual()).unwrap();
    let named: Vec<usize> = (0..25).filter(|test| robust.tests[*test].outlier).collect();
    assert_eq!(named, [7]);
    let squares = Method {
        loss: Loss::Squares,
        ..usual()
    };
    let squares = identify(&robot, &unknowns, &tests, squares).unwrap();
    let off = |found: &Identified| {
        // The last drive moves these tests by less than the noise.
        let errors = found.estimates[..5]
            .iter()
            .zip(&truth)
            .map(|(e, t)| (e.value / t - 1.0).abs());
        errors.fold(0.0, f64::max)
    };
    assert!(
        off(&robust) < 0.3 * off(&squares),
        "{} against {}",
        off(&robust),
        off(&squares)
    );
}

#[test]
fn springs_with_equal_effect_are_reported_together() {
    let (robot, mut random) = (arms::mh12(), Random(6));
    // The link after B bends about y where B itself turns about y: the two are not distinguishable.
    let twin = Unknown::about(Attachment::Joint(4), Axis::Y, Role::Bending);
    let mut unknowns = drives(&robot);
    unknowns.push(twin);
    let mut tests = loads(&robot, 12, &mut random);
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 3.0e-5, 8.0e-5, 3.0e-5];
    measure(&robot, &unknowns, &State::of_sizes(truth), &mut tests, || 0.0);
    let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
    assert_eq!(found.together, [vec![4, 6]]);
    // Their sum is known.
    let sum = found.estimates[4].value + found.estimates[6].value;
    assert!((sum / 6.0e-5 - 1.0).abs() < 1e-4, "{sum}");
}

#[test]
fn a_joint_that_no_test_loads_is_reported_and_keeps_its_prior() {
    let robot = arms::mh12();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(7));
    for test in &mut tests {
        // On the last axis: the flange turns about its own z.
        test.force_point = Vector3::new(0.0, 0.0, 0.1);
        test.measured_point = test.force_point;
    }
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    measure(&robot, &unknowns, &State::of_sizes(truth), &mut tests, || 0.0);
    let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
    assert!(found.estimates[5].known < 0.01, "{:?}", found.estimates[5]);
    assert!(found.estimates[..5].iter().all(|e| e.known > 0.99));
    let relative = found.estimates[5].standard_uncertainty / found.estimates[5].value;
    assert!((relative - 2.0).abs() < 0.01, "{relative}");
}

#[test]
fn refuses_insufficient_tests() {
    let robot = arms::mh12();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(8));
    let nothing = identify(&robot, &unknowns, &tests, usual()).unwrap_err();
    assert_eq!(nothing, Refusal::NothingMeasured);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(vec![1e-6; 6]),
        &mut tests,
        || 0.0,
    );
    let few = identify(&robot, &unknowns, &tests[..1], usual()).unwrap_err();
    assert_eq!(
        few,
        Refusal::TooFewReadings {
            readings: 3,
            unknowns: 6
        }
    );
    let joints = tests[0].joints.clone();
    for test in &mut tests {
        test.joints.clone_from(&joints);
    }
    let one = identify(&robot, &unknowns, &tests, usual()).unwrap_err();
    assert_eq!(one, Refusal::OnePosture { tests: 10 });
    assert!(matches!(
        identify(&robot, &unknowns, &[], usual()).unwrap_err(),
        Refusal::TooFewReadings { readings: 0, .. }
    ));
}

#[test]
fn wrong_units_show_in_the_size_of_the_readings() {
    let robot = arms::kr120();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(9));
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(vec![1e-6; 6]),
        &mut tests,
        || 0.0,
    );
    let ratio = measured_over_typical(&robot, &tests).unwrap();
    assert!((ratio - 0.5).abs() < 1e-9, "{ratio}");
}
