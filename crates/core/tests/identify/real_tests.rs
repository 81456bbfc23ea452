//! 43 real load tests of a FANUC R-2000iC, if `ARMILL_SAMPLES` names their folder.

use armill_core::identify::effect::Effects;
use armill_core::identify::unknown::{base, bending, drives, lost_motion};
use armill_core::identify::{
    Identified, LoadTest, Measured, Method, Points, Reading, Role, Unknown, displacement_errors, identify,
};
use armill_core::nalgebra::Vector3;
use armill_core::robot::chain::Axis;
use armill_core::robot::{Attachment, Robot};
use armill_core::spatial::Wrench;

use crate::{AXES, arms, plain, usual};

/// Liu et al. 2026 by modified DH rows; each joint is after its row's two displacements along and about x and its
/// length along z, so that attachments are the origins of the DH frames.
fn r2000ic() -> Robot {
    let described = arms::r2000ic();
    let mut motions = described.chain().motions().to_vec();
    for row in motions.chunks_mut(5) {
        row.swap(3, 4);
    }
    Robot::new("fanuc/r2000ic", motions, described.joints().to_vec()).unwrap()
}

fn fanuc_tests() -> Option<Vec<LoadTest>> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let folder = std::path::Path::new(&samples).join("datasets/fanuc-r2000ic-deflection");
    let rows = |file: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(folder.join(file)).expect(file);
        let lines = text.lines().skip(1);
        lines
            .map(|line| line.split(',').map(|cell| cell.trim().parse().unwrap()).collect())
            .collect()
    };
    let point = Vector3::new(0.0069, 0.2453, 0.3193);
    let tests = rows("joint_angles.csv")
        .into_iter()
        .zip(rows("forces.csv"))
        .zip(rows("deltaX.csv"))
        .map(|((joints, force), displacement)| LoadTest {
            joints,
            wrench: Wrench::from_force(Vector3::from_column_slice(&force)),
            force_point: point,
            measured_point: point,
            readings: AXES
                .map(|axis| Reading {
                    what: Measured::Displacement(axis),
                    value: displacement[axis.index()],
                    standard_uncertainty: 1e-5,
                })
                .to_vec(),
        });
    Some(tests.collect())
}

/// Fit rms, left-out rms (mm), left-out mean over mean measured (%).
fn errors(tests: &[LoadTest], found: &Identified) -> [f64; 3] {
    let fit = displacement_errors(tests, found.tests.iter().map(|t| &t.residuals)).unwrap();
    let left_out = displacement_errors(tests, found.tests.iter().map(|t| &t.left_out)).unwrap();
    [fit.rms * 1e3, left_out.rms * 1e3, left_out.relative * 100.0]
}

#[test]
fn least_squares_on_43_real_tests_give_what_another_program_gave() {
    let Some(tests) = fanuc_tests() else { return };
    let robot = r2000ic();
    let six = drives(&robot);
    let both = |axis| (0..6).map(move |joint| Unknown::about(Attachment::Joint(joint), axis, Role::Bending));
    let eighteen: Vec<Unknown> = six
        .iter()
        .copied()
        .chain(both(Axis::X))
        .chain(both(Axis::Y))
        .collect();
    // Numbers by numpy and scipy (nnls, least_squares), printed to three and one decimals.
    let rows = [
        ("6, points known", &six, Points::Known, [0.372, 0.405, 20.8]),
        ("18, points known", &eighteen, Points::Known, [0.276, 0.305, 16.5]),
        ("6, common point", &six, Points::Common(1.0), [0.298, 0.343, 17.3]),
        (
            "18, common point",
            &eighteen,
            Points::Common(1.0),
            [0.191, 0.228, 11.0],
        ),
        (
            "18, two points",
            &eighteen,
            Points::Separate(1.0),
            [0.180, 0.225, 10.5],
        ),
    ];
    for (name, unknowns, points, expected) in rows {
        let found = identify(&robot, unknowns, &tests, Method { points, ..plain() }).unwrap();
        let errors = errors(&tests, &found);
        println!("{name}: {errors:.4?}");
        for (found, (expected, half_digit)) in errors.iter().zip(expected.iter().zip([6e-4, 6e-4, 0.06])) {
            assert!(
                (found - expected).abs() < half_digit,
                "{name}: {errors:?} against {expected}"
            );
        }
        if name == "6, points known" {
            let stiffness = [
                860_896.0,
                2_719_583.0,
                1_959_760.0,
                270_828.0,
                424_693.0,
                206_020.0,
            ];
            for (estimate, k) in found.estimates.iter().zip(stiffness) {
                assert!(
                    (estimate.value * k - 1.0).abs() < 2e-6,
                    "{} against {k}",
                    1.0 / estimate.value
                );
            }
        }
    }
}

#[test]
fn a_weak_prior_and_robust_weights_predict_real_tests_better() {
    let Some(tests) = fanuc_tests() else { return };
    let robot = r2000ic();
    let springs = [drives(&robot), bending(&robot), base(&robot)].concat();
    let torques: Vec<f64> = (0..6)
        .map(|joint| {
            let torque = |test| Effects::of(&robot, &springs, test).torques()[joint].abs();
            0.05 * tests.iter().map(torque).fold(0.0, f64::max)
        })
        .collect();
    let with_gaps = [springs.clone(), lost_motion(&robot, &torques)].concat();
    // Plain least squares on the same tests, best of all its models: 10.5 %, 0.225 mm.
    let rows = [
        ("known points", &springs, Points::Known, [0.307, 16.5]),
        ("common point", &springs, Points::Common(0.2), [0.208, 9.65]),
        ("two points", &springs, Points::Separate(0.2), [0.205, 8.9]),
        (
            "two points and lost motion",
            &with_gaps,
            Points::Separate(0.2),
            [0.203, 8.55],
        ),
    ];
    for (name, unknowns, points, most) in rows {
        let found = identify(&robot, unknowns, &tests, Method { points, ..usual() }).unwrap();
        let [fit, rms, relative] = errors(&tests, &found);
        println!("{name}: fit {fit:.4} mm, left out {rms:.4} mm, {relative:.2} %");
        assert!(
            rms < most[0] && relative < most[1],
            "{name}: {rms} mm, {relative} %"
        );
        // No spring is rigid, none more compliant than a drive of a small arm.
        let springs = found.estimates.iter().take(springs.len());
        assert!(
            springs.clone().all(|e| e.value > 1e-8 && e.value < 1e-4),
            "{name}"
        );
        if points != Points::Known {
            let outliers: Vec<usize> = (0..43)
                .filter(|t| found.tests[*t].outlier)
                .map(|t| t + 1)
                .collect();
            assert_eq!(outliers, [11], "{name}");
        }
    }
}
