use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::tool_orientation;
use crate::kernel::tests::{joints, subjects};
use crate::robot::inverse::{Inverse, ToolAt, postures};
use crate::robot::{Branch, PostureName, Robot};
use crate::source::StiffnessModel;
use crate::spatial::Wrench;

const WRIST: f64 = 0.1;

fn arm<'a>(robot: &'a Robot, tool: &'a Isometry, model: &'a StiffnessModel) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        flange_from_tool: tool,
        model,
    }
}

/// Wrenches and two directions across a random one.
fn push(random: &mut Stream) -> (Vec<Wrench>, [Vector3<f64>; 2]) {
    let cases = (0..3).map(|case| Wrench {
        force: random.vector(200.0),
        moment: random.vector(if case == 1 { 5.0 } else { 0.0 }),
    });
    let cases = cases.collect();
    let turn = Rotation3::from_scaled_axis(random.vector(3.0));
    (cases, [turn * Vector3::x(), turn * Vector3::y()])
}

#[test]
fn lanes_agree_with_one_pose_after_the_other() {
    let mut random = Stream(41);
    let tool = Isometry::from_parts(
        nalgebra::Translation3::new(0.03, -0.02, 0.25),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.4, -0.1)),
    );
    let mut counts = [0; 6];
    for (robot, model) in subjects() {
        let arm = arm(&robot, &tool, &model);
        let mut lanes = Columns::new(arm, None, WRIST);
        match model.is_drives_alone() && robot.ortho_parallel().is_some() {
            true => assert!(matches!(lanes.method, ColumnMethod::Lanes(_))),
            false => assert!(matches!(lanes.method, ColumnMethod::Whole(..))),
        }
        let exact = matches!(robot.inverse().of_arm(), Inverse::Closed(_));
        let mut plain = Columns::one_by_one(arm, None, [WRIST, 0.0]);
        let (mut one, mut other) = (Column::default(), Column::default());
        for round in 0..40 {
            let (cases, along) = push(&mut random);
            let joints = joints(&mut random, &robot);
            let dof = joints.len();
            let base = crate::robot::forward::forward(&robot, &joints).base_from_flange;
            let base = Isometry::from_parts(
                base.translation,
                UnitQuaternion::from_rotation_matrix(&base.rotation),
            ) * tool;
            // More turns than a block has.
            let poses: Vec<Isometry> = (0..100)
                .map(|turn| {
                    base * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.0628 * f64::from(turn))
                })
                .collect();
            let push = ColumnLoad { cases: &cases, along };
            lanes.fill(&poses, &push, &mut one);
            plain.fill(&poses, &push, &mut other);
            for slot in 0..poses.len() * SLOTS {
                let statuses = [one.statuses[slot], other.statuses[slot]];
                counts[statuses[0] as usize] += 1;
                // A calibrated arm may lose a posture near a singularity, where it cannot be used.
                let usable = statuses.map(|status| status == PostureStatus::Usable);
                assert_eq!(usable[0], usable[1], "{} {round} slot {slot}", robot.name());
                if exact {
                    assert_eq!(statuses[0], statuses[1], "{} {round} slot {slot}", robot.name());
                }
                if statuses[0] != PostureStatus::Usable {
                    assert!(one.deviations[slot].is_infinite());
                    continue;
                }
                let (a, b) = (one.deviations[slot], other.deviations[slot]);
                assert!((a - b).abs() < 1e-9 * b, "{}: {a} {b}", robot.name());
                for (a, b) in one.joints_of(slot, dof).iter().zip(other.joints_of(slot, dof)) {
                    assert!(
                        (a - b).abs() < 1e-9,
                        "{} {round} slot {slot}: {a} {b}",
                        robot.name()
                    );
                }
            }
        }
    }
    for status in [
        PostureStatus::Usable,
        PostureStatus::OutsideLimits,
        PostureStatus::Singular,
        PostureStatus::OutOfReach,
    ] {
        assert!(counts[status as usize] > 100, "{counts:?}");
    }
}

#[test]
fn a_posture_of_a_column_is_one_of_the_postures_of_its_pose_and_deviates_as_predicted() {
    let robot = arms::mh12();
    let tool = Isometry::translation(0.0, 0.0, 0.2);
    let mut columns = Columns::new(arm(&robot, &tool, StiffnessModel::DRIVES), None, WRIST);
    let mut column = Column::default();
    let mut random = Stream(5);
    let (cases, along) = push(&mut random);
    let pose = Isometry::from_parts(
        nalgebra::Translation3::new(0.9, 0.1, 0.8),
        tool_orientation(Vector3::x_axis(), 0.3),
    );
    columns.fill(&[pose], &ColumnLoad { cases: &cases, along }, &mut column);
    let all = postures(&robot, &pose, ToolAt::on(&tool)).unwrap();
    let mut usable = 0;
    for posture in &all {
        let PostureName::Branch(branch) = posture.name else {
            panic!("named")
        };
        let slot = Branch::ALL.iter().position(|other| *other == branch).unwrap();
        if column.statuses[slot] != PostureStatus::Usable {
            continue;
        }
        usable += 1;
        let deviates = |wrench: &Wrench| {
            let delta = crate::source::elastic::predict(posture, robot.compliance().unwrap(), wrench)
                .twist
                .linear;
            along[0].dot(&delta).hypot(along[1].dot(&delta))
        };
        let most = cases.iter().map(deviates).fold(0.0, f64::max);
        assert!((most - column.deviations[slot]).abs() < 1e-11 * most, "{most}");
    }
    assert!(usable >= 2, "{usable}");
}
