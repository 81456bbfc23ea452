use std::sync::Arc;

use nalgebra::{DMatrix, Point3, Unit, Vector3};

use super::sum::OneWrench;
use super::{WholeAnswers, WholeModel};
use crate::arms;
use crate::frame::{Isometry, both_across};
use crate::kernel::answer::AnswerDetail;
use crate::kernel::general::General;
use crate::kernel::{BranchChoice, OnPath, Question, evaluate, evaluate_posture};
use crate::load::InputUncertainty;
use crate::numbers::{BLOCK, Backend, planes};
use crate::predict::deviation_of;
use crate::robot::forward::forward;
use crate::robot::inverse::tool_on;
use crate::robot::{
    Amount, Attachment, Backlash, BacklashSide, JointCompliance, JointCurve, Mass, Motion, Robot, Spring,
    Unreachable,
};
use crate::source::stiffness_model::Gravity;
use crate::source::thermal::ThermalGrowth;
use crate::source::{Arm, ArmState, Links, StiffnessModel};
use crate::spatial::Wrench;
use crate::watch::Watch;

/// Every input that may be uncertain.
const UNCERTAIN: InputUncertainty = InputUncertainty {
    relative: 0.12,
    forces: [
        Vector3::new(3.0, 0.0, 0.0),
        Vector3::new(0.0, 2.0, 1.0),
        Vector3::new(0.0, 0.0, 4.0),
    ],
    tool_length: 2e-4,
};

/// Springs everywhere, masses, gravity and thermal growth.
fn model(joints: usize) -> StiffnessModel {
    let c = JointCompliance {
        value: 3e-7,
        standard_uncertainty: 1e-8,
    };
    let mut model = StiffnessModel::DRIVES.clone();
    for joint in 0..joints {
        for axis in [Vector3::x(), Vector3::y()] {
            model
                .structure
                .springs
                .push(Spring::about(Attachment::Joint(joint), axis, c));
        }
    }
    model
        .structure
        .springs
        .push(Spring::about(Attachment::Base, Vector3::y(), c));
    model
        .structure
        .springs
        .push(Spring::along(Attachment::Tool, Vector3::x(), c));
    model.structure.masses = [Attachment::Joint(1), Attachment::Joint(2), Attachment::Flange]
        .map(|attachment| Mass {
            attachment,
            mass: 30.0,
            centre: Point3::new(0.1, 0.02, 0.2),
            inertia: None,
            relative_uncertainty: 0.0,
        })
        .to_vec();
    model.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.2; joints],
    });
    model.thermal = Some(ThermalGrowth::new(12e-6, 8.0, 2.0));
    model
}

/// The side of each joint's backlash: decided by friction, by torques, and by both.
const SIDES: [fn(usize) -> BacklashSide; 3] = [
    |_| BacklashSide::Motion,
    |_| BacklashSide::Torque,
    |joint| [BacklashSide::Torque, BacklashSide::Motion][joint % 2],
];

/// Backlash in all joints but the third.
fn worn(joints: usize, side: fn(usize) -> BacklashSide) -> Vec<Option<Backlash>> {
    let gap = |joint| Backlash {
        gap: 1e-4 + 3e-5 * joint as f64,
        standard_uncertainty: 2e-5,
        side: side(joint),
    };
    (0..joints)
        .map(|joint| (joint != 2).then(|| gap(joint)))
        .collect()
}

/// Changes a model of a robot.
type Bend = fn(&mut StiffnessModel, &Robot);

/// What makes the stiffness of joints depend on load and posture: nothing; curves on all joints; a compensator; curves
/// next to it. Prismatic joints have neither.
const BENDS: [Bend; 4] = [
    |_, _| (),
    |model, robot| model.structure.curves = on_all(robot),
    |model, robot| model.structure.compensator = Some(arms::compensator(1 + usize::from(robot.slides(0)))),
    |model, robot| {
        let carrier = 1 + usize::from(robot.slides(0));
        model.structure.curves = on_all(robot);
        model.structure.curves[carrier] = None;
        model.structure.compensator = Some(arms::compensator(carrier));
    },
];

/// Curves on all revolute joints.
fn on_all(robot: &Robot) -> Vec<Option<JointCurve>> {
    let joints = 0..robot.joints().len();
    joints
        .map(|joint| (!robot.slides(joint)).then(|| arms::curves(joint)))
        .collect()
}

/// Of the first compliances, correlated.
fn covariance(size: usize) -> DMatrix<f64> {
    let root = DMatrix::from_fn(size, size, |i, j| ((3 * i + 5 * j + i * j) % 7) as f64 - 2.5);
    &root * root.transpose() * 1e-17
}

/// Witness: the plain row of `predict.rs`.
#[test]
fn the_whole_model_in_lanes_is_that_of_the_plain_row() {
    let tool = arms::bent_tool();
    let wrench = Wrench {
        force: Vector3::new(60.0, -35.0, 20.0),
        moment: Vector3::new(1.0, 2.0, -3.0),
    };
    for robot in arms::ALL.iter() {
        let model = model(robot.joints().len());
        let compliance = vec![
            JointCompliance {
                value: 2e-6,
                standard_uncertainty: 2e-7
            };
            robot.joints().len()
        ];
        let arm = Arm {
            robot,
            compliance: &compliance,
            model: &model,
            flange_from_tool: &tool,
        };
        let mut stream = arms::Stream(17);
        let q: Vec<Vec<f64>> = (0..BLOCK).map(|_| stream.joints(robot)).collect();
        let joints: Vec<[f64; BLOCK]> = (0..robot.joints().len())
            .map(|joint| std::array::from_fn(|i| q[i][joint]))
            .collect();
        let mut plain = ArmState::new(arm);
        let mut positions = vec![0.0; robot.joints().len()];
        let expected: Vec<Vector3<f64>> = q
            .iter()
            .map(|q| {
                plain.set_joints(q);
                let mut links = Links::Farthest([Vector3::x(), Vector3::y()], &mut positions);
                deviation_of(&mut plain, &wrench, &mut links).unwrap().linear
            })
            .collect();
        for backend in Backend::available() {
            let mut lanes = WholeModel::of(&arm, backend).unwrap();
            lanes.set_joints(&joints);
            let mut found = planes();
            lanes.respond::<true, false>();
            backend.run(OneWrench::<f64, true> {
                response: &lanes.response,
                rest: &lanes.still.sum,
                wrench: &wrench,
                deviation: &mut found,
            });
            for (i, expected) in expected.iter().enumerate() {
                let found = Vector3::new(found[0][i], found[1][i], found[2][i]);
                let away = (found - expected).norm() / expected.norm();
                assert!(away < 1e-12, "{} {backend} {i}: {away:e}", robot.name());
            }
        }
    }
}

/// The arm with its lengths a little longer.
fn longer(robot: &Robot) -> Robot {
    let mut motions = robot.chain().motions().to_vec();
    for motion in &mut motions {
        if let Motion::Along(_, Amount::Constant(length)) = motion {
            *length *= 1.0005;
        }
    }
    Robot::new("longer", motions, robot.joints().to_vec()).unwrap()
}

/// Witness: the plain row over the same cases, at the same joints.
#[test]
fn worst_case_shares_and_uncertainty_are_those_of_the_plain_row() {
    let tool = arms::bent_tool();
    let wrench = |x, y, z| Wrench {
        force: Vector3::new(x, y, z),
        moment: Vector3::new(0.1 * z, 0.2 * x, -0.3 * y),
    };
    // Without a load and without gravity no torque decides.
    let cases = [
        wrench(60.0, -35.0, 20.0),
        wrench(-20.0, 50.0, 30.0),
        wrench(0.0, 0.0, -80.0),
        Wrench::ZERO,
    ];
    let normal = Unit::new_normalize(Vector3::new(0.2, -0.9, 0.3));
    let [first, second] = both_across(&normal);
    let railed = arms::other::on_rail(&arms::ALL[0]);
    let each = arms::ALL.iter().chain([&railed]).flat_map(|robot| {
        SIDES.map(|side| BENDS.map(|bend| [(robot, side, bend, true), (robot, side, bend, false)]))
    });
    for (robot, side, bend, weighs) in each.flatten().flatten() {
        let dof = robot.joints().len();
        // Geometry is the difference of two positions, which are some metres on a rail.
        let within = if robot.slides(0) { 1e-11 } else { 1e-12 };
        let mut model = model(dof);
        model.structure.backlash = worn(dof, side);
        model.structure.masses.push(Mass {
            attachment: Attachment::Tool,
            mass: 4.0,
            centre: Point3::new(0.0, 0.03, -0.02),
            inertia: None,
            relative_uncertainty: 0.0,
        });
        bend(&mut model, robot);
        if !weighs {
            model.gravity = None;
        }
        model.structure.repeatability = 4e-5;
        model.structure.model_error = 0.09;
        if weighs {
            model.structure.covariance = Some(covariance(dof + 3));
        }
        model.actual = Some(Arc::new(longer(robot)));
        let compliance = vec![
            JointCompliance {
                value: 2e-6,
                standard_uncertainty: 2e-7
            };
            dof
        ];
        let arm = Arm {
            robot,
            compliance: &compliance,
            model: &model,
            flange_from_tool: &tool,
        };
        let question = Question {
            homes: None,
            arm,
            home: None,
            cases: &cases,
            uncertainty: UNCERTAIN,
            normal,
            choice: BranchChoice::Best,
            clearance: None,
        };
        let mut stream = arms::Stream(5);
        let q: Vec<Vec<f64>> = (0..BLOCK).map(|_| stream.joints(robot)).collect();
        let joints: Vec<[f64; BLOCK]> = (0..dof)
            .map(|joint| std::array::from_fn(|i| q[i][joint]))
            .collect();
        for backend in Backend::available() {
            let mut lanes = WholeModel::of(&arm, backend).unwrap();
            let mut found = WholeAnswers::with(cases.len(), lanes.contributors());
            lanes.set_joints(&joints);
            let plane = [first, second, normal.into_inner()];
            lanes.answer(&cases, &plane, &UNCERTAIN, &mut found);
            for (i, q) in q.iter().enumerate() {
                let expected = evaluate_posture(&question, q, OnPath::default());
                let evaluation = expected.points[0].unwrap();
                let close = |a: f64, b: f64, what: &str| {
                    let away = (a - b).abs() / evaluation.full;
                    assert!(
                        away < within,
                        "{} {backend} {i} {what}: {a:e} {b:e}",
                        robot.name()
                    );
                };
                close(found.worst.in_plane[i], evaluation.in_plane, "in plane");
                close(found.worst.normal[i], evaluation.normal, "normal");
                close(found.worst.full[i], evaluation.full, "full");
                if let Some(u) = evaluation.in_plane_uncertainty {
                    close(found.uncertainty[i], u, "u");
                }
                assert_eq!(found.worst.case[i] as usize, evaluation.worst_case);
                assert_eq!(found.shares.len(), expected.shares_at(0).len());
                for (plane, share) in found.shares.iter().zip(expected.shares_at(0)) {
                    close(plane[i], *share, "share");
                }
                for (planes, deviation) in found.deviations.iter().zip(expected.deviations_at(0)) {
                    for axis in 0..3 {
                        close(planes[axis][i], deviation[axis], "deviation");
                    }
                }
            }
        }
    }
}

/// Witness: the general solver, one point after the other. Its joint positions differ by the rounding of another
/// closed form, which grows near singularities: hence 1e-9 here, and 1e-12 at the same joint positions above.
#[test]
fn a_question_about_a_whole_model_has_the_answers_of_the_general_solver() {
    let tool = arms::bent_tool();
    let force = |x, y, z| Wrench::from_force(Vector3::new(x, y, z));
    let cases = [force(60.0, -35.0, 20.0), force(-20.0, 50.0, 30.0)];
    let (mut compared, mut in_all, mut unstable) = (0, 0, 0);
    // Stiffer than its joint in some postures: there is no equilibrium, and no answer.
    let stiff: Bend = |model, _| {
        let mut compensator = arms::compensator(1);
        compensator.stiffness = 1.2e7;
        model.structure.compensator = Some(compensator);
    };
    let named = arms::ALL.iter().filter(|robot| robot.ortho_parallel().is_some());
    for (robot, bend) in
        named.flat_map(|robot| BENDS.into_iter().chain([stiff]).map(move |bend| (robot, bend)))
    {
        let dof = robot.joints().len();
        let mut model = model(dof);
        model.structure.repeatability = 4e-5;
        model.structure.backlash = worn(dof, SIDES[2]);
        model.actual = Some(Arc::new(longer(robot)));
        bend(&mut model, robot);
        let compliance = vec![
            JointCompliance {
                value: 2e-6,
                standard_uncertainty: 2e-7
            };
            dof
        ];
        let arm = Arm {
            robot,
            compliance: &compliance,
            model: &model,
            flange_from_tool: &tool,
        };
        let mut stream = arms::Stream(23);
        let poses: Vec<Isometry> = (0..3 * BLOCK + 7)
            .map(|_| tool_on(&forward(robot, &stream.joints(robot)), &tool))
            .collect();
        for choice in [BranchChoice::Best, BranchChoice::Of(robot.nominal_branch())] {
            let question = Question {
                homes: None,
                arm,
                home: None,
                cases: &cases,
                uncertainty: UNCERTAIN,
                normal: -Vector3::x_axis(),
                choice,
                clearance: None,
            };
            let found = evaluate(&question, poses.len(), |i| poses[i], Watch::NONE).unwrap();
            let mut general = General::new(&question, AnswerDetail::Shares);
            let (mut joints, mut deviations) = (vec![0.0; dof], vec![Vector3::zeros(); 2]);
            let mut shares = vec![0.0; found.share_count];
            for (i, pose) in poses.iter().enumerate() {
                general.forget();
                let expected = general.answer(&question, pose, None);
                in_all += 1;
                let (evaluation, expected) = match (&found.points[i], &expected) {
                    (Ok(found), Ok(expected)) => (found, expected),
                    (Err(found), Err(expected)) => {
                        assert_eq!(found, expected);
                        unstable += usize::from(matches!(found, Unreachable::Unstable { .. }));
                        continue;
                    }
                    (found, expected) => panic!("{} {i}: {found:?} {expected:?}", robot.name()),
                };
                compared += 1;
                general.write(&mut joints, &mut deviations, &mut shares);
                let close = |a: f64, b: f64, what: &str| {
                    let away = (a - b).abs() / expected.full;
                    assert!(away < 1e-9, "{} {choice:?} {i} {what}: {a:e} {b:e}", robot.name());
                };
                close(evaluation.in_plane, expected.in_plane, "in plane");
                let u = [evaluation, expected].map(|point| point.in_plane_uncertainty);
                assert_eq!(u[0].is_some(), u[1].is_some());
                if let [Some(a), Some(b)] = u {
                    close(a, b, "u");
                }
                assert_eq!(evaluation.name, expected.name, "{} {i}", robot.name());
                assert_eq!(evaluation.limit_joint, expected.limit_joint);
                assert!((evaluation.limit_margin - expected.limit_margin).abs() < 1e-9);
                for (a, b) in found.shares_at(i).iter().zip(&shares) {
                    close(*a, *b, "share");
                }
                for (a, b) in found.joints_at(i).iter().zip(&joints) {
                    assert!((a - b).abs() < 1e-9, "{} {i}: {a} {b}", robot.name());
                }
            }
        }
    }
    assert!(
        compared * 2 > in_all && unstable > 50,
        "{compared} of {in_all}, {unstable}"
    );
}
