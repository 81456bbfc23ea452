//! Arms under load compared with closed forms, potentials and the unloaded arm.

use nalgebra::{Matrix2, Point3, Vector2};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::robot::{
    Amount, Axis, Compensator, Joint, JointCompliance, Mass, Motion, Robot, Spring, Structure,
};
use crate::source::{ArmState, Gravity, StiffnessModel};

const LINK: f64 = 0.5;

/// Two links in a row along x, both joints about z.
fn two_links() -> Robot {
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Constant(LINK)),
        Motion::About(Axis::Z, Amount::Joint(1)),
        Motion::Along(Axis::X, Amount::Constant(LINK)),
    ];
    let joints = ["a", "b"].map(Joint::plain).to_vec();
    let c = JointCompliance {
        value: 1e-4,
        standard_uncertainty: 0.0,
    };
    Robot::new("two links", motions, joints)
        .unwrap()
        .with_compliance(vec![c; 2])
        .unwrap()
}

fn loaded() -> StiffnessModel {
    StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    }
}

fn arm_of<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: tool,
    }
}

/// `d(J^T f) / dx` of the straight links under a force along them, over force and length.
fn toggle() -> Matrix2<f64> {
    Matrix2::new(2.0, 1.0, 1.0, 1.0)
}

fn at_rest<'a>(theta: &'a [f64], torques: &'a [f64]) -> AtRest<'a> {
    AtRest { theta, torques }
}

#[test]
fn links_in_a_row_buckle_under_the_force_of_the_closed_form() {
    // K - F L [[2, 1], [1, 1]] loses its sign at F = k / (L (3 + sqrt 5) / 2).
    let critical = 1e4 / (LINK * (3.0 + 5_f64.sqrt()) / 2.0);
    let (robot, model, tool) = (two_links(), loaded(), Isometry::identity());
    let mut arm_state = ArmState::new(arm_of(&robot, &model, &tool));
    arm_state.set_joints(&[0.0; 2]);
    let mut press = |force: f64| arm_state.elastic(&Wrench::from_force(-Vector3::x() * force));
    assert_eq!(press(0.999 * critical).unwrap(), Twist::ZERO);
    assert_eq!(press(1.001 * critical).unwrap_err(), Unstable::Buckles);
    // Pulled they never buckle.
    assert!(press(-100.0 * critical).is_ok());
}

#[test]
fn the_tangent_of_links_under_compression_is_that_of_the_closed_form() {
    let (robot, model, tool) = (two_links(), loaded(), Isometry::identity());
    let mut arm_state = ArmState::new(arm_of(&robot, &model, &tool));
    arm_state.set_joints(&[0.0; 2]);
    for force in [-5000.0, -100.0, 1000.0, 5000.0] {
        arm_state
            .elastic(&Wrench::from_force(-Vector3::x() * force))
            .unwrap();
        let stiffness = Matrix2::identity() * 1e4 - toggle() * (force * LINK);
        let lever = Vector2::new(2.0 * LINK, LINK);
        let sideways = lever.dot(&(stiffness.try_inverse().unwrap() * lever));
        let found = arm_state.loaded_compliance().unwrap()[(1, 1)];
        assert!(
            (found / sideways - 1.0).abs() < 1e-12,
            "{force} N: {found} {sideways}"
        );
    }
}

#[test]
fn an_arm_far_too_soft_has_no_equilibrium() {
    let (robot, model, tool) = (two_links(), loaded(), Isometry::identity());
    let mut arm_state = ArmState::new(arm_of(&robot, &model, &tool));
    arm_state.set_joints(&[0.0; 2]);
    // 1e-4 rad/(N m) under 1e5 N m: ten radians by the linear law.
    let push = Wrench::from_force(Vector3::y() * 1e5);
    assert_eq!(arm_state.elastic(&push).unwrap_err(), Unstable::NoEquilibrium);
    assert!(arm_state.elastic(&(push * f64::NAN)).is_err());
    // The arm state is unchanged: a smaller load has an equilibrium.
    assert!(arm_state.elastic(&(push * 1e-3)).is_ok());
    assert_eq!(
        Unstable::NoEquilibrium.to_string(),
        "the arm finds no equilibrium under this load"
    );
}

/// A posture of an arm, and a wrench.
fn somewhere(robot: &Robot, stream: &mut Stream) -> (Vec<f64>, Wrench) {
    let q = stream.joints(robot);
    let wrench = Wrench {
        force: stream.vector(400.0),
        moment: stream.vector(100.0),
    };
    (q, wrench)
}

#[test]
fn the_load_stiffness_is_symmetric_but_for_the_moment() {
    let tool = arms::bent_tool();
    let model = loaded();
    let mut stream = Stream(51);
    for robot in arms::all() {
        let arm = arm_of(&robot, &model, &tool);
        let mut equilibrium = Equilibrium::for_arm(&arm);
        for _ in 0..20 {
            let (q, wrench) = somewhere(&robot, &mut stream);
            let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &q)).collect();
            // Rigid drives: the arm stays where it is.
            equilibrium
                .find(&arm, at_rest(&theta, &[0.0; 6]), &wrench, |_, _| (0.0, 0.0))
                .unwrap();
            let axes: Vec<Vector3<f64>> = equilibrium
                .deflected
                .screws
                .iter()
                .map(|screw| screw.angular)
                .collect();
            let k = &equilibrium.k_c;
            for i in 0..6 {
                for j in 0..i {
                    let skew = axes[j].cross(&axes[i]).dot(&wrench.moment);
                    // Entries of some 1000 N m.
                    assert!((k[(i, j)] - k[(j, i)] - skew).abs() < 1e-10, "{i} {j}");
                }
            }
        }
    }
}

fn springs() -> Vec<Spring> {
    let c = |value| JointCompliance {
        value,
        standard_uncertainty: 0.0,
    };
    vec![
        Spring::about(Attachment::Joint(1), Vector3::x(), c(2.4e-7)),
        Spring::about(Attachment::Base, Vector3::y(), c(4e-8)),
        Spring::along(Attachment::Tool, Vector3::x(), c(9e-7)),
    ]
}

/// Springs, masses under gravity and a compensator, all with a potential.
fn with_everything() -> StiffnessModel {
    let mass = |attachment, mass, z| Mass {
        attachment,
        mass,
        centre: Point3::new(0.1, -0.05, z),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    StiffnessModel {
        structure: Structure {
            springs: springs(),
            masses: vec![
                mass(Attachment::Joint(1), 150.0, 0.2),
                mass(Attachment::Joint(3), 80.0, 0.0),
                mass(Attachment::Tool, 20.0, 0.1),
            ],
            compensator: Some(Compensator {
                joint: 1,
                fixed_radius: 0.69,
                arm_radius: 0.185,
                angle: 0.17,
                free_length: 0.458,
                stiffness: 1e5,
            }),
            ..Structure::EMPTY
        },
        gravity: Some(Gravity {
            acceleration: Vector3::new(0.0, 0.0, -9.81),
            reference: vec![0.0; 6],
        }),
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    }
}

#[test]
fn load_stiffness_matches_finite_differences() {
    let (tool, model) = (arms::bent_tool(), with_everything());
    let mut stream = Stream(53);
    for robot in arms::all() {
        let arm = arm_of(&robot, &model, &tool);
        let mut equilibrium = Equilibrium::for_arm(&arm);
        for _ in 0..20 {
            let (q, wrench) = somewhere(&robot, &mut stream);
            let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &q)).collect();
            // Drives and springs that stay at `x`: torques there are those of the load.
            let mut set = |x: &[f64]| {
                let law = |k: usize, _| (x[k], 0.0);
                equilibrium
                    .find(&arm, at_rest(&theta, &[0.0; 9]), &wrench, law)
                    .unwrap();
                (equilibrium.torques.clone(), equilibrium.k_c.clone())
            };
            let x: Vec<f64> = (0..9).map(|k| 1e-3 * (f64::from(k) - 4.0)).collect();
            let (_, k_c) = set(&x);
            let h = 1e-5;
            for j in 0..9 {
                let (mut more, mut less) = (x.clone(), x.clone());
                more[j] += h;
                less[j] -= h;
                let (more, less) = (set(&more).0, set(&less).0);
                for i in 0..9 {
                    let witness = (more[i] - less[i]) / (2.0 * h);
                    // Torques of some 10 kN m: h^2 of their third derivative, rounding over h.
                    let away = (k_c[(i, j)] - witness).abs();
                    assert!(away < 1e-5, "{}: {i} {j}: {away}", robot.name());
                }
            }
        }
    }
}

#[test]
fn the_potential_of_springs_load_weight_and_compensator_is_least_at_equilibrium() {
    let (tool, model) = (arms::bent_tool(), with_everything());
    let structure = &model.structure;
    let mut stream = Stream(52);
    let mut rests = 0;
    for robot in [&arms::ALL[1], &arms::ALL[3]] {
        let arm = arm_of(robot, &model, &tool);
        let c = arm.compliances();
        let mut arm_state = ArmState::new(arm);
        for _ in 0..10 {
            let (q, Wrench { force, .. }) = somewhere(robot, &mut stream);
            let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &q)).collect();
            arm_state.set_joints(&q);
            let before = arm_state.gravity_torques().to_vec();
            let mut equilibrium = Equilibrium::for_arm(&arm);
            let law = |k: usize, torque: f64| (c[k].value * torque, c[k].value);
            let wrench = Wrench::from_force(force);
            if equilibrium
                .find(&arm, at_rest(&theta, &before), &wrench, law)
                .is_err()
            {
                continue;
            }
            rests += 1;
            let potential = |x: &[f64]| -> f64 {
                let mut there = DeflectedArm::for_robot(robot, 3);
                deflect_into(&arm.flexible(), &theta, x, &mut there);
                let own: f64 = x.iter().zip(&c).map(|(x, c)| 0.5 * x * x / c.value).sum();
                // The torque of gravity and compensator at rest is subtracted: spring deflections are relative to rest.
                let taken_off: f64 = x.iter().zip(&before).map(|(x, before)| x * before).sum();
                let weight: f64 = structure
                    .masses
                    .iter()
                    .map(|mass| {
                        9.81 * mass.mass * (there.attachments[mass.attachment.rank(6)] * mass.centre).z
                    })
                    .sum();
                let compensator = structure.compensator.unwrap();
                let spring = arms::spring_energy(&compensator, theta[1] + x[1]);
                own + taken_off + weight + spring - force.dot(&there.base_from_tool().translation.vector)
            };
            let x = equilibrium.turns().to_vec();
            let here = potential(&x);
            for k in 0..x.len() {
                let moved = |by: f64| {
                    let mut moved = x.clone();
                    moved[k] += by;
                    potential(&moved)
                };
                let h = 1e-5;
                let (less, more) = (moved(-h), moved(h));
                assert!(less > here && more > here, "{k}: {less} {here} {more} J");
                // Rounding of some kJ over 1e-5; the third derivative, some kJ, times h^2.
                let slope = (more - less) / (2.0 * h);
                assert!(slope.abs() < 1e-4, "{k}: {slope} N m");
            }
        }
    }
    assert!(rests >= 15, "{rests} of 20");
}

#[test]
fn the_tangent_becomes_the_compliance_of_the_unloaded_arm_as_the_load_vanishes() {
    let tool = arms::bent_tool();
    let model = StiffnessModel {
        structure: Structure {
            springs: springs(),
            ..Structure::EMPTY
        },
        ..loaded()
    };
    let mut stream = Stream(53);
    for robot in arms::all() {
        let mut arm_state = ArmState::new(arm_of(&robot, &model, &tool));
        let (q, wrench) = somewhere(&robot, &mut stream);
        arm_state.set_joints(&q);
        let unloaded = arm_state.compliance().unwrap();
        let mut off = |part: f64| {
            arm_state.elastic(&(wrench * part)).unwrap();
            (arm_state.loaded_compliance().unwrap() - unloaded).norm() / unloaded.norm()
        };
        let (first, second) = (off(2e-3), off(1e-3));
        assert!(second < 1e-4, "{}: {second}", robot.name());
        assert!(
            (first / second - 2.0).abs() < 0.02,
            "{}: {first} {second}",
            robot.name()
        );
        assert!(off(0.0) < 1e-14);
    }
}

#[test]
fn drives_come_before_the_springs_of_their_attachment_in_their_order() {
    let (tool, model) = (Isometry::identity(), with_everything());
    let robot = &arms::ALL[0];
    let equilibrium = Equilibrium::for_arm(&arm_of(robot, &model, &tool));
    // Base spring, drives 1 and 2, spring of joint 2, drives 3 to 6, spring of the tool.
    assert_eq!(equilibrium.place, [1, 2, 4, 5, 6, 7, 3, 0, 8]);
    assert_eq!(equilibrium.rank, [1, 2, 3, 4, 5, 6, 2, 0, 8]);
}
