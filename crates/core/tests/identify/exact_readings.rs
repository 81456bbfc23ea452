//! Springs are recovered exactly from readings without noise.

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::unknown::{base, bending, drives, tool};
use armill_core::identify::{Measured, Method, Points, Reading, displacement_errors, identify};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Attachment;

use crate::{Random, arms, loads, measure, plain, some_sizes, usual};

#[test]
fn drives_are_recovered_exactly_from_readings_without_noise() {
    let (robot, mut random) = (arms::mh12(), Random(1));
    let unknowns = drives(&robot);
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    let mut tests = loads(&robot, 10, &mut random);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(truth.clone()),
        &mut tests,
        || 0.0,
    );
    for method in [plain(), usual()] {
        let found = identify(&robot, &unknowns, &tests, method).unwrap();
        for (estimate, truth) in found.estimates.iter().zip(&truth) {
            // Residuals of 1e-9 of the largest reading are rounding.
            assert!(
                (estimate.value / truth - 1.0).abs() < 1e-6,
                "{estimate:?} against {truth}"
            );
        }
    }
}

#[test]
fn every_spring_and_both_points_are_recovered_exactly_from_readings_without_noise() {
    let (robot, mut random) = (arms::kr120(), Random(2));
    let unknowns = [drives(&robot), bending(&robot), base(&robot), tool()].concat();
    let truth = State {
        sizes: some_sizes(&unknowns, &mut random),
        force_shift: Vector3::new(0.02, -0.05, 0.04),
        measured_shift: Vector3::new(-0.03, 0.01, 0.06),
    };
    let mut tests = loads(&robot, 60, &mut random);
    measure(&robot, &unknowns, &truth, &mut tests, || 0.0);
    let method = Method {
        points: Points::Separate(0.2),
        ..usual()
    };
    let found = identify(&robot, &unknowns, &tests, method).unwrap();
    // Three springs of one size about axes through the wrist centre have equal effect in every posture: drives and
    // bendings of the wrist are not distinguishable, and no prediction depends on it.
    let open = |k: &usize| found.together.iter().any(|set| set.contains(k));
    let in_wrist = |k: usize| matches!(unknowns[k].attachment, Attachment::Joint(3..=5));
    assert!(
        (0..unknowns.len()).filter(open).all(in_wrist),
        "{:?}",
        found.together
    );
    assert!(!found.together.is_empty());
    for (k, (estimate, truth)) in found.estimates.iter().zip(&truth.sizes).enumerate() {
        let near = (estimate.value / truth - 1.0).abs() < 1e-4;
        assert!(near || open(&k), "{estimate:?} against {truth}");
    }
    // Displacements are some mm; residuals below 1e-9 of the largest are rounding.
    let errors = displacement_errors(&tests, found.tests.iter().map(|t| &t.left_out)).unwrap();
    assert!(errors.largest < 1e-8, "{errors:?}");
    let (force, measured) = (found.force_shift.unwrap(), found.measured_shift.unwrap());
    assert!((force[0] - truth.force_shift).norm() < 1e-6, "{}", force[0]);
    assert!(
        (measured[0] - truth.measured_shift).norm() < 1e-6,
        "{}",
        measured[0]
    );
}

#[test]
fn the_method_of_the_paper_gives_each_joint_separately() {
    // One link loaded, its rotation relative to the one before read: c = rotation / torque, whatever the others do.
    let (robot, mut random) = (arms::mh12(), Random(5));
    let unknowns = drives(&robot);
    let truth = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    let mut tests = Vec::new();
    for (joint, truth) in truth.into_iter().enumerate() {
        for mut test in loads(&robot, 2, &mut random) {
            let torque = Effects::of(&robot, &unknowns, &test).torques()[joint];
            test.readings = vec![Reading {
                what: Measured::Turn(joint),
                value: truth * torque,
                standard_uncertainty: 1e-5,
            }];
            tests.push(test);
        }
    }
    let found = identify(&robot, &unknowns, &tests, plain()).unwrap();
    for (estimate, truth) in found.estimates.iter().zip(truth) {
        assert!(
            (estimate.value / truth - 1.0).abs() < 1e-9,
            "{estimate:?} against {truth}"
        );
    }
}
