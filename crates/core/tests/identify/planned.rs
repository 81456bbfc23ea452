//! A plan of load tests gives less uncertainty than random tests.

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::unknown::{bending, drives};
use armill_core::identify::{Floor, LoadTest, PlanQuestion, plan};
use armill_core::nalgebra::{DMatrix, Vector3};
use armill_core::spatial::Wrench;

use crate::{Random, arms, loads};

#[test]
fn a_plan_has_less_uncertainty_than_random_tests_and_stays_within_the_limits() {
    let robot = arms::mh12();
    let unknowns = [drives(&robot), bending(&robot)].concat();
    let requested = PlanQuestion {
        tests: 12,
        pulls: [[0.0, 0.0, -150.0], [150.0, 0.0, 0.0], [0.0, 150.0, 0.0]]
            .map(Vector3::from)
            .to_vec(),
        tool_point: Vector3::new(0.0, 0.05, 0.2),
        gauge: 1e-5,
        floor: Some(Floor::under_base()),
    };
    let planned = plan(&robot, &unknowns, &requested);
    assert_eq!(planned.tests.len(), 12);
    for test in &planned.tests {
        let (_, margin) = robot.limit_margin(&test.joints).unwrap();
        assert!(margin > 0.0, "{:?}", test.joints);
        let frames = armill_core::robot::forward::forward(&robot, &test.joints);
        assert!(frames.base_from_flange.translation.vector.z > 0.2);
    }
    assert_eq!(plan(&robot, &unknowns, &requested).tests, planned.tests);
    for (place, test) in planned.tests.iter().enumerate() {
        assert!(!planned.tests[..place].contains(test), "{test:?} twice");
    }
    let volume = |tests: &[LoadTest]| {
        let mut information = DMatrix::<f64>::identity(unknowns.len(), unknowns.len());
        let state = State::typical(&unknowns);
        for test in tests {
            let mut rows = Effects::of(&robot, &unknowns, test)
                .jacobian(&unknowns, &state)
                .columns(0, unknowns.len())
                .into_owned();
            for (k, size) in state.sizes.iter().enumerate() {
                rows.column_mut(k).scale_mut(size / 1e-5);
            }
            information += rows.tr_mul(&rows);
        }
        information
            .symmetric_eigenvalues()
            .iter()
            .map(|v| v.ln())
            .sum::<f64>()
    };
    let as_test = |joints: &[f64], force| LoadTest {
        joints: joints.to_vec(),
        wrench: Wrench::from_force(force),
        force_point: requested.tool_point,
        measured_point: requested.tool_point,
        readings: loads(&robot, 1, &mut Random(1))[0].readings.clone(),
    };
    let best: Vec<LoadTest> = planned
        .tests
        .iter()
        .map(|t| as_test(&t.joints, t.force))
        .collect();
    let mut random = Random(77);
    for _ in 0..20 {
        let chance: Vec<LoadTest> = loads(&robot, 12, &mut random)
            .into_iter()
            .enumerate()
            .map(|(i, t)| as_test(&t.joints, requested.pulls[i % 3]))
            .collect();
        assert!(volume(&chance) < volume(&best));
    }
}
