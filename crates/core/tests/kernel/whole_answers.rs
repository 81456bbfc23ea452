//! Answers of the kernel against the plain version, lanes or not.

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::lanes::{Backend, Envelopes, flag};
use armill_core::kernel::{BranchChoice, evaluate, evaluate_at_joints};
use armill_core::nalgebra::Vector3;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::{Amount, Axis, Branch, Joint, JointCompliance, Motion, Robot};
use armill_core::source::elastic::predict;
use armill_core::source::{Arm, ArmState, StiffnessModel};
use armill_core::watch::Watch;
use armill_core::workpiece::Split;

use crate::arms::{self, Stream};
use crate::{Soa, analysis, batch, cases, some};

#[test]
fn whole_answers_agree_with_predict_and_add_up() {
    for robot in arms::all() {
        let found = some(&robot, 2_000);
        analysis(
            &robot,
            &cases(5),
            BranchChoice::Of("front elbow-up".parse().unwrap()),
            |question| {
                let pose = |i: usize| found[i].base_from_tool;
                let answers = evaluate(question, found.len(), pose, Watch::NONE).unwrap();
                let mut checked = 0;
                for (i, evaluation) in answers
                    .evaluations()
                    .filter(|(_, evaluation)| evaluation.singularity.is_none())
                {
                    let posture = posture_at(&robot, answers.joints_at(i), question.arm.flange_from_tool);
                    assert_eq!(posture.name, evaluation.name);
                    let moved = posture.base_from_tool.translation.vector
                        - found[i].base_from_tool.translation.vector;
                    assert!(moved.norm() < 1e-12, "{moved:?}");
                    let (mut normal, mut full): (f64, f64) = (0.0, 0.0);
                    for (case, wrench) in question.cases.iter().enumerate() {
                        let witness = predict(&posture, question.arm.compliance, wrench);
                        let away = answers.deviations_at(i)[case] - witness.twist.linear;
                        assert!(away.norm() < 1e-12 * witness.twist.linear.norm());
                        let split = Split::of(&witness.twist.linear, question.normal);
                        assert!(split.in_plane <= evaluation.in_plane * (1.0 + 1e-12));
                        full = full.max(split.full);
                        if split.normal.abs() > normal.abs() {
                            normal = split.normal;
                        }
                        if case == evaluation.worst_case {
                            assert!((split.in_plane - evaluation.in_plane).abs() < 1e-12 * evaluation.full);
                            let along = witness.twist.linear - question.normal.into_inner() * split.normal;
                            let along = along.normalize();
                            let variance = (along.transpose() * witness.covariance * along).x;
                            assert!(
                                (variance.sqrt() - evaluation.in_plane_uncertainty.unwrap()).abs()
                                    < 1e-10 * evaluation.full
                            );
                        }
                    }
                    assert!((full - evaluation.full).abs() < 1e-12 * full);
                    assert!((normal - evaluation.normal).abs() < 1e-12 * full);
                    let sum: f64 = answers.shares_at(i).iter().sum();
                    assert!((sum - evaluation.in_plane).abs() < 1e-12 * evaluation.full);
                    let (joint, margin) = robot.limit_margin(&posture.joints).unwrap();
                    assert!(
                        (margin - evaluation.limit_margin).abs() < 1e-12 && joint == evaluation.limit_joint
                    );
                    checked += 1;
                }
                assert!(checked > 300, "{}: {checked}", robot.name());
            },
        );
    }
}

#[test]
fn a_pose_that_lanes_cannot_decide_is_finite_and_flagged() {
    let robot = arms::mh12();
    // Forearm and axis 6 in line; far beyond reach; wrist centre on axis 1, 100 mm behind the flange.
    let straight = posture_at(&robot, &[0.3, 0.2, 0.1, 0.0, 0.0, 0.0], &arms::bent_tool()).base_from_tool;
    let far = from_xyz_and_fixed_angles(Vector3::new(9.0, 0.0, 0.5), Vector3::zeros());
    let on_axis_1 = Isometry::translation(0.0, 0.0, 1.3) * arms::bent_tool();
    let soa = Soa::<f64>::of([straight, far, on_axis_1].iter());
    analysis(
        &robot,
        &cases(2),
        BranchChoice::Of("front elbow-up".parse().unwrap()),
        |question| {
            let mut out = Envelopes::default();
            batch::<f64>(question, Backend::fastest()).envelopes(&soa.poses(), Branch::ALL[0], &mut out);
            assert!(out.in_plane().iter().all(|x| x.is_finite()), "{out:?}");
            assert_ne!(out.flags(0) & flag::WRIST_UNDECIDED, 0);
            assert_ne!(out.flags(1) & flag::TOO_FAR, 0);
            let of_shoulder = out.flags(2) & (flag::NEAR_SHOULDER | flag::UNREACHABLE);
            assert_eq!(of_shoulder, flag::NEAR_SHOULDER);
            let pose = |i: usize| [straight, far, on_axis_1][i];
            let answers = evaluate(question, 3, pose, Watch::NONE).unwrap();
            assert!(answers.points[0].is_ok_and(|evaluation| evaluation.in_plane > 0.0));
            assert!(answers.points[1].is_err());
            assert!(answers.points[2].is_ok_and(|evaluation| evaluation.in_plane > 0.0));
        },
    );
}

#[test]
fn any_chain_at_known_joint_positions_agrees_with_predict() {
    // Seven axes, one of them a rail: no closed form.
    let motions = vec![
        Motion::Along(Axis::Y, Amount::Joint(0)),
        Motion::Along(Axis::Z, Amount::Constant(0.4)),
        Motion::About(Axis::Z, Amount::Joint(1)),
        Motion::About(Axis::Y, Amount::Joint(2)),
        Motion::Along(Axis::Z, Amount::Constant(0.5)),
        Motion::About(Axis::X, Amount::Joint(3)),
        Motion::About(Axis::Y, Amount::Joint(4)),
        Motion::Along(Axis::X, Amount::Constant(0.6)),
        Motion::About(Axis::X, Amount::Joint(5)),
        Motion::About(Axis::Z, Amount::Joint(6)),
    ];
    let joints = ["rail", "a", "b", "c", "d", "e", "f"].map(Joint::plain).to_vec();
    let robot = Robot::new("made-up/seven", motions, joints).unwrap();
    let compliance = vec![
        JointCompliance {
            value: 2e-6,
            standard_uncertainty: 0.0,
        };
        7
    ];
    let (tool, cases) = (arms::bent_tool(), cases(5));
    let arm = Arm {
        robot: &robot,
        compliance: &compliance,
        model: StiffnessModel::DRIVES,
        flange_from_tool: &tool,
    };
    let mut stream = Stream(3);
    let q: Vec<f64> = (0..7 * 1000).map(|_| 4.0 * stream.next() - 2.0).collect();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let given = || {
        let mut out = vec![0.0; 1000 * 15];
        let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
            for (wrench, out) in cases.iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice(arm_state.elastic(wrench)?.linear.as_slice());
            }
            Ok(())
        };
        evaluate_at_joints(&arm, &q, &mut out, write, Watch::NONE).unwrap();
        out
    };
    let out = one_thread.install(given);
    for (i, q) in q.chunks(7).enumerate() {
        let posture = posture_at(&robot, q, &tool);
        for (wrench, given) in cases.iter().zip(out[15 * i..].chunks(3)) {
            let witness = predict(&posture, &compliance, wrench).twist.linear;
            let away = Vector3::from_column_slice(given) - witness;
            // Seven shares are added in another order: some ten roundings.
            assert!(away.norm() < 1e-14 * witness.norm());
        }
    }
    assert_eq!(given(), out);
}
