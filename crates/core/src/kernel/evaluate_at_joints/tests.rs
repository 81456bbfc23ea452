//! Many points give the same as one point after the other.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use super::super::tests::{cases, springy};
use super::*;
use crate::arms::{self, Stream};
use crate::predict::deviation_of;
use crate::robot::Robot;
use crate::robot::inverse::posture_at;
use crate::source::{Links, StiffnessModel};
use crate::spatial::Wrench;

fn joints(robot: &Robot, count: usize) -> Vec<f64> {
    let mut stream = Stream(47);
    (0..count).flat_map(|_| stream.joints(robot)).collect()
}

#[test]
fn every_chain_agrees_with_predict_at_each_point() {
    let tool = arms::bent_tool();
    for robot in [
        arms::hung(),
        arms::other::iiwa14(),
        arms::other::on_rail(&arms::kr120()),
    ] {
        let (q, dof) = (joints(&robot, 300), robot.joints().len());
        for model in [StiffnessModel::DRIVES.clone(), springy()] {
            let arm = Arm {
                robot: &robot,
                compliance: robot.compliance().unwrap(),
                model: &model,
                flange_from_tool: &tool,
            };
            let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
                for (wrench, out) in cases().iter().zip(out.chunks_mut(3)) {
                    out.copy_from_slice(
                        deviation_of(arm_state, wrench, &mut Links::Neglected)?
                            .linear
                            .as_slice(),
                    );
                }
                Ok(())
            };
            let mut given = vec![0.0; 300 * 9];
            evaluate_at_joints(&arm, &q, &mut given, write, Watch::NONE).unwrap();
            for (q, given) in q.chunks(dof).zip(given.chunks(9)).step_by(7) {
                for (wrench, given) in cases().iter().zip(given.chunks(3)) {
                    let predicted = arms::predicted(&arm, q, wrench).unwrap().twist.linear;
                    let away = Vector3::from_column_slice(given) - predicted;
                    let name = robot.name();
                    assert!(away.norm() < 1e-13 * predicted.norm().max(1e-6), "{name}");
                }
            }
        }
    }
}

#[test]
#[should_panic(expected = "joint positions for a whole number of points")]
fn an_incomplete_point_is_refused() {
    evaluated(&[0.0; 9], 6);
}

#[test]
#[should_panic(expected = "one compliance per joint")]
fn a_joint_without_compliance_is_refused() {
    evaluated(&[0.0; 6], 5);
}

/// An arm with this number of known compliances.
fn evaluated(joints: &[f64], known: usize) {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = Arm {
        robot,
        compliance: &robot.compliance().unwrap()[..known],
        model: StiffnessModel::DRIVES,
        flange_from_tool: &tool,
    };
    evaluate_at_joints(&arm, joints, &mut [0.0], |_, _| Ok(()), Watch::NONE).unwrap();
}

#[test]
fn the_tool_pose_agrees_with_forward_kinematics_in_one_block_and_in_many() {
    let tool = arms::bent_tool();
    for robot in [arms::hung(), arms::other::iiwa14()] {
        let (model, compliance) = (springy(), robot.compliance().unwrap());
        let arm = Arm {
            robot: &robot,
            compliance,
            model: &model,
            flange_from_tool: &tool,
        };
        let dof = robot.joints().len();
        let q = joints(&robot, 2 * AT_ONCE + 9);
        let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
            out.copy_from_slice(arm_state.base_from_tool().translation.vector.as_slice());
            Ok(())
        };
        let mut many = vec![0.0; q.len() / dof * 3];
        evaluate_at_joints(&arm, &q, &mut many, write, Watch::NONE).unwrap();
        let mut few = vec![0.0; 15];
        evaluate_at_joints(&arm, &q[..5 * dof], &mut few, write, Watch::NONE).unwrap();
        assert_eq!(few, many[..15]);
        for (q, tip) in q.chunks(dof).zip(many.chunks(3)).step_by(11) {
            let posture = posture_at(&robot, q, &tool);
            let away = posture.base_from_tool.translation.vector - Vector3::from_column_slice(tip);
            // The turn of the flange goes through a quaternion there: some roundings of a tool of a metre at most.
            assert!(away.norm() < 1e-14, "{away}");
        }
    }
}

#[test]
fn the_first_point_without_equilibrium_is_reported_in_every_block() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let model = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: &model,
        flange_from_tool: &tool,
    };
    let q = joints(robot, 3 * AT_ONCE);
    let wrench = Wrench::from_force(Vector3::new(7e5, -4e5, 6e5));
    let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
        out[0] = arm_state.elastic(&wrench)?.linear.norm();
        Ok(())
    };
    let witness = q.chunks(6).position(|q| {
        let mut arm_state = ArmState::new(arm);
        arm_state.set_joints(q);
        arm_state.elastic(&wrench).is_err()
    });
    let mut out = vec![0.0; 3 * AT_ONCE];
    let given = evaluate_at_joints(&arm, &q, &mut out, write, Watch::NONE).unwrap_err();
    match given {
        EvaluateError::Unstable { point, .. } => assert_eq!(Some(point), witness),
        EvaluateError::Cancelled(_) => panic!("not cancelled"),
    }
}

#[test]
fn a_cancelled_watch_stops_and_zero_points_need_no_work() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: StiffnessModel::DRIVES,
        flange_from_tool: &tool,
    };
    let cancel = AtomicBool::new(false);
    let watch = Watch {
        finished: &|_| cancel.store(true, Ordering::Relaxed),
        cancel: &cancel,
    };
    let write = |_: &mut ArmState<'_>, out: &mut [f64]| {
        out[0] = 1.0;
        Ok(())
    };
    let q = joints(robot, 64 * AT_ONCE);
    let mut out = vec![0.0; 64 * AT_ONCE];
    let stopped = evaluate_at_joints(&arm, &q, &mut out, write, watch);
    assert_eq!(stopped, Err(EvaluateError::Cancelled(Cancelled)));
    assert!(out.contains(&0.0));
    assert_eq!(evaluate_at_joints(&arm, &[], &mut [], write, watch), Ok(()));
}
