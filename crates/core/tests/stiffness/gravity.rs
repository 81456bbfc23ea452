//! Torques of gravity against potential energy, and the sag of the arm.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Isometry3, Point3, Vector3};
use armill_core::robot::deflected_arm::{DeflectedArm, deflect_into};
use armill_core::robot::inverse::posture_at;
use armill_core::robot::{Attachment, Mass, Structure};
use armill_core::source::ArmState;
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::spatial::Wrench;
use proptest::prelude::*;

use crate::{DOWN, FANUC, FANUC_D, arm, arms, fanuc_masses, full_arm, springs, weighing};

/// Potential energy of the FANUC's masses in gravity, J, from its modified DH rows alone.
fn fanuc_energy(m: &[f64]) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    let rows = [
        (0.0, 0.0, 0.0),
        (-quarter, 0.312, -quarter),
        (0.0, 1.075, 0.0),
        (-quarter, 0.225, 0.0),
        (quarter, 0.0, 0.0),
        (-quarter, 0.0, 0.0),
    ];
    let mut frame = Isometry3::identity();
    let mut energy = 0.0;
    for (i, (alpha, a, zero)) in rows.into_iter().enumerate() {
        frame *= Isometry3::rotation(Vector3::x() * alpha)
            * Isometry3::translation(a, 0.0, 0.0)
            * Isometry3::rotation(Vector3::z() * (zero + m[i]))
            * Isometry3::translation(0.0, 0.0, FANUC_D[i]);
        let (mass, centre) = FANUC[i];
        energy += mass * FREE_FALL * (frame * Point3::from(centre)).z;
    }
    energy
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn gravity_torques_are_the_falling_potential_energy(unit in prop::array::uniform6(0.0..1.0_f64)) {
        let robot = arms::r2000ic();
        let (q, tool) = (arms::positions(&robot, &unit), Isometry::identity());
        let model = weighing(Structure { masses: fanuc_masses(), ..Structure::EMPTY });
        let mut arm_state = ArmState::new(full_arm(&robot, &model, &tool));
        arm_state.set_joints(&q);
        let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &q)).collect();
        let h = 1e-5;
        for i in 0..6 {
            let at = |by: f64| { let mut t = theta.clone(); t[i] += by; fanuc_energy(&t) };
            let witness = -(at(h) - at(-h)) / (2.0 * h);
            // 10 kJ: h^2 of the third derivative, and rounding over h.
            prop_assert!((arm_state.gravity_torques()[i] - witness).abs() < 2e-6, "joint {i}: {witness} N m");
        }
    }

    #[test]
    fn gravity_torques_on_springs_are_work_against_displacements(
        ((which, unit), seed) in (arm(), -1.0..1.0_f64),
    ) {
        // Move each spring by a small amount, compute the energy again: -dE/dx, E from the attachments of the deflected
        // arm.
        let robot = &arms::ALL[which];
        let (q, tool) = (arms::positions(robot, &unit), arms::bent_tool());
        let mut masses = fanuc_masses();
        masses.push(Mass { attachment: Attachment::Flange, mass: 60.0, centre: Point3::new(0.1, seed, 0.2), inertia: None, relative_uncertainty: 0.0, });
        masses.push(Mass { attachment: Attachment::Tool, mass: 5.0, centre: Point3::new(0.0, 0.0, -0.1), inertia: None, relative_uncertainty: 0.0, });
        let model = weighing(Structure { springs: springs(), masses: masses.clone(), ..Structure::EMPTY });
        let arm = full_arm(robot, &model, &tool);
        let mut arm_state = ArmState::new(arm);
        arm_state.set_joints(&q);
        let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &q)).collect();
        let energy = |x: &[f64]| {
            let mut out = DeflectedArm::for_robot(robot, 6);
            deflect_into(&arm.flexible(), &theta, x, &mut out);
            let of = |m: &Mass| -DOWN.dot(&(out.attachments[m.attachment.rank(6)] * m.centre).coords) * m.mass;
            masses.iter().map(of).sum::<f64>()
        };
        let h = 1e-5;
        for k in 0..12 {
            let (mut more, mut less) = ([0.0; 12], [0.0; 12]);
            (more[k], less[k]) = (h, -h);
            let witness = -(energy(&more) - energy(&less)) / (2.0 * h);
            prop_assert!((arm_state.gravity_torques()[k] - witness).abs() < 1e-5, "{k}: {witness}");
        }
    }
}

#[test]
fn gravity_is_not_included_where_the_tool_was_set_and_differs_elsewhere() {
    let (robot, tool) = (arms::r2000ic(), Isometry::translation(0.1, 0.0, 0.3));
    let mut model = weighing(Structure {
        masses: fanuc_masses(),
        ..Structure::EMPTY
    });
    let reference = vec![0.1, 0.2, -0.3, 0.4, 0.5, -0.6];
    model.gravity.as_mut().unwrap().reference.clone_from(&reference);
    let none = Wrench::ZERO;
    let arm = full_arm(&robot, &model, &tool);
    let there = arms::predicted(&arm, &reference, &none).unwrap();
    assert_eq!(there.twist.linear, Vector3::zeros());
    assert_eq!(there.covariance.amax(), 0.0);
    // Elsewhere: compliances times torques times screws, less the same at the reference.
    let q = [0.1, 0.5, -0.5, 0.4, 0.5, -0.6];
    let elsewhere = arms::predicted(&arm, &q, &none).unwrap().twist.linear;
    let sag = |q: &[f64]| -> Vector3<f64> {
        let posture = posture_at(&robot, q, &tool);
        let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, q)).collect();
        let h = 1e-5;
        let parts = posture.screws.iter().enumerate().map(|(i, screw)| {
            let at = |by: f64| {
                let mut t = theta.clone();
                t[i] += by;
                fanuc_energy(&t)
            };
            screw.linear * (-(at(h) - at(-h)) / (2.0 * h) * robot.compliance().unwrap()[i].value)
        });
        parts.sum()
    };
    let witness = sag(&q) - sag(&reference);
    assert!(witness.norm() > 1e-4, "{witness}");
    assert!((elsewhere - witness).norm() < 1e-10);
    // The same arm hung from the ceiling sags the other way.
    model.gravity.as_mut().unwrap().acceleration = -DOWN;
    let hung = arms::predicted(&full_arm(&robot, &model, &tool), &q, &none)
        .unwrap()
        .twist
        .linear;
    assert!((hung + elsewhere).norm() < 1e-18);
}
