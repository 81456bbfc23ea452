//! Any chain at joint positions that are known.

use super::super::tests::{cancelled_after, cases, springy};
use super::*;
use crate::arms::{self, Stream};
use crate::robot::Robot;
use crate::robot::inverse::posture_at;
use crate::source::StiffnessModel;

fn arm<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: tool,
    }
}

fn joints(robot: &Robot, count: usize) -> Vec<f64> {
    let mut stream = Stream(31);
    (0..count).flat_map(|_| stream.joints(robot)).collect()
}

#[test]
fn every_chain_is_answered_as_predicted_at_each_point() {
    let tool = arms::bent_tool();
    for robot in [
        arms::hung(),
        arms::other::iiwa14(),
        arms::other::on_rail(&arms::kr120()),
    ] {
        let (q, dof) = (joints(&robot, 300), robot.joints().len());
        for model in [StiffnessModel::DRIVES.clone(), springy()] {
            let arm = arm(&robot, &model, &tool);
            let found = at_joints(&arm, &cases(), &q, Watch::NONE).unwrap();
            assert!(found.rests.iter().all(|rests| *rests));
            let yields = dof + model.structure.springs.len();
            for (i, q) in q.chunks(dof).enumerate().step_by(7) {
                let posture = posture_at(&robot, q, &tool);
                assert_eq!(found.base_from_tool[i], posture.base_from_tool);
                assert_eq!(found.screws[i * yields..][..dof], posture.screws);
                for (case, wrench) in cases().iter().enumerate() {
                    let predicted = arms::predicted(&arm, q, wrench).unwrap().twist.linear;
                    let away = found.deviations[3 * i + case] - predicted;
                    assert!(
                        away.norm() < 1e-13 * predicted.norm().max(1e-6),
                        "{}",
                        robot.name()
                    );
                }
            }
        }
    }
}

#[test]
fn where_one_case_finds_no_rest_no_deviation_is_told() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let model = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    let mut loads = cases();
    loads[1] = Wrench::from_force(Vector3::new(7e5, -4e5, 6e5));
    let found = at_joints(
        &arm(robot, &model, &tool),
        &loads,
        &joints(robot, 20),
        Watch::NONE,
    )
    .unwrap();
    assert!(found.rests.contains(&false));
    for (rests, deviations) in found.rests.iter().zip(found.deviations.chunks(3)) {
        assert_eq!(
            *rests,
            deviations.iter().any(|deviation| *deviation != Vector3::zeros())
        );
    }
}

#[test]
fn known_joints_are_cancelled_between_blocks() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = arm(robot, StiffnessModel::DRIVES, &tool);
    let q = joints(robot, 3 * AT_ONCE);
    let (stopped, done) = cancelled_after(0, |watch| at_joints(&arm, &cases(), &q, watch));
    assert_eq!((stopped.unwrap_err(), done), (Cancelled, 0));
    let (whole, done) = cancelled_after(usize::MAX, |watch| at_joints(&arm, &cases(), &q, watch));
    assert!(whole.is_ok() && done == 3 * AT_ONCE);
}

#[test]
#[should_panic(expected = "joint positions for a whole number of points")]
fn half_a_point_is_refused() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    at_joints(
        &arm(robot, StiffnessModel::DRIVES, &tool),
        &cases(),
        &[0.0; 9],
        Watch::NONE,
    )
    .unwrap();
}

#[test]
#[should_panic(expected = "one compliance a joint")]
fn a_joint_without_compliance_is_refused() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = Arm {
        compliance: &robot.compliance().unwrap()[..5],
        ..arm(robot, StiffnessModel::DRIVES, &tool)
    };
    at_joints(&arm, &cases(), &[0.0; 6], Watch::NONE).unwrap();
}
