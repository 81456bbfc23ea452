use nalgebra::{Matrix6xX, Point3, UnitQuaternion, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::from_xyz_and_fixed_angles;
use crate::kernel::postures_at;
use crate::robot::forward::forward;
use crate::robot::inverse::{ToolAt, postures, tool_on};
use crate::robot::jacobian::wrist_bend;
use crate::robot::positioner::tests::{model, state};
use crate::robot::{Attachment, Backlash, BacklashSide, JointCompliance, Mass};
use crate::source::{ArmState, StiffnessModel};
use crate::spatial::Wrench;
use crate::watch::Watch;

/// The mount of a spindle in front of the arm.
fn base_from_mount() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::new(1.3, -0.2, 0.4), Vector3::new(0.2, -0.4, 2.0))
}

fn motor(joint: usize) -> Motor {
    Motor {
        joint,
        rotor_inertia: 1e-3,
        ratio: 100.0,
    }
}

fn spring(attachment: Attachment, axis: Vector3<f64>) -> Spring {
    let compliance = JointCompliance {
        value: 4e-8,
        standard_uncertainty: 1e-8,
    };
    Spring::about(attachment, axis, compliance)
}

/// The FANUC arm, whose joint 3 is coupled, with every part that an arm can have.
fn arm() -> Robot {
    let mass = |attachment, mass| Mass {
        attachment,
        mass,
        centre: Point3::new(0.05, -0.1, 0.2),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    let gap = |side| {
        Some(Backlash {
            gap: 2e-4,
            standard_uncertainty: 2e-5,
            side,
        })
    };
    let springs = vec![
        spring(Attachment::Base, Vector3::y()),
        spring(Attachment::Joint(1), Vector3::z()),
        spring(Attachment::Joint(4), Vector3::x()),
        spring(Attachment::Flange, Vector3::x()),
    ];
    let correlated = DMatrix::from_fn(10, 10, |i, j| match i == j {
        true => 1e-16 * (i + 1) as f64,
        false => 1e-17,
    });
    let structure = Structure {
        springs,
        masses: vec![
            mass(Attachment::Base, 300.0),
            mass(Attachment::Joint(1), 150.0),
            mass(Attachment::Joint(2), 90.0),
            mass(Attachment::Flange, 130.0),
        ],
        motors: vec![motor(0), motor(4)],
        damping: Some(Damping::Joints(vec![1.0, 2.0, 3.0])),
        compensator: Some(arms::compensator(1)),
        curves: vec![None, None, Some(arms::curves(2))],
        covariance: Some(correlated),
        backlash: vec![gap(BacklashSide::Motion), gap(BacklashSide::Torque)],
        repeatability: 3e-5,
        model_error: 0.05,
        learnt: None,
        geometry: None,
    };
    arms::r2000ic().with_structure(structure).unwrap()
}

fn flange(robot: &Robot, q: &[f64]) -> Isometry {
    tool_on(&forward(robot, q), &Isometry::identity())
}

fn opposite(v: &Vector3<f64>, expected: &Vector3<f64>) -> bool {
    (v + expected).norm() <= 1e-9 * expected.norm() + 1e-15
}

#[test]
fn the_chain_goes_from_the_flange_back_to_the_mount_of_the_tool() {
    for arm in [arms::mh12(), arms::r2000ic(), arms::other::five_joints()] {
        let hand = arm.holding_part(&base_from_mount()).unwrap();
        let mut stream = Stream(3);
        for _ in 0..100 {
            let q = stream.joints(&arm);
            let back = in_opposite_order(&q);
            let expected = flange(&arm, &q).inverse() * base_from_mount();
            let found = flange(&hand, &back);
            assert!((found.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);
            let frames = forward(&hand, &back);
            let ground = hand.chain().ground().in_base(&frames.base_from_joint);
            let expected = flange(&arm, &q).inverse();
            assert!((ground.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);
        }
        assert_eq!(hand.external_axes().count(), 0);
        assert!(!hand.is_external(0));
        for (index, joint) in arm.joints().iter().enumerate() {
            let same = &hand.joints()[hand.joint_of_arm(index)];
            assert_eq!(
                (&same.name, same.limits, same.max_speed),
                (&joint.name, joint.limits, joint.max_speed)
            );
        }
    }
}

#[test]
fn postures_are_those_of_the_arm_with_their_names() {
    let tool = arms::bent_tool();
    for arm in [
        arms::mh12(),
        arms::r2000ic(),
        arms::other::ur10(),
        arms::other::five_joints(),
    ] {
        let hand = arm.holding_part(&base_from_mount()).unwrap();
        assert_eq!(hand.inverse().word(), arm.inverse().word());
        let mut stream = Stream(13);
        for _ in 0..20 {
            let q: Vec<f64> = stream.joints(&arm).iter().map(|q| 0.3 * q + 0.2).collect();
            let back = in_opposite_order(&q);
            let part_from_tool = tool_on(&forward(&hand, &back), &tool);
            let at = ToolAt {
                flange_from_tool: &tool,
                near: None,
                home: Some(&back),
            };
            let found = postures(&hand, &part_from_tool, at).unwrap();
            let alone = ToolAt {
                home: Some(&q),
                ..ToolAt::on(&tool)
            };
            let base_from_tip = flange(&arm, &q) * tool;
            let expected = postures(&arm, &base_from_tip, alone).unwrap();
            assert_eq!(found.len(), expected.len(), "{}", arm.name());
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(found.name, expected.name);
                for (found, expected) in found.joints.iter().rev().zip(&expected.joints) {
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{found} {expected} of {}",
                        arm.name()
                    );
                }
                let reached = found.base_from_tool.to_homogeneous() - part_from_tool.to_homogeneous();
                assert!(reached.norm() < 1e-8);
                assert_eq!(
                    wrist_bend(&hand, &found.joints).is_some(),
                    wrist_bend(&arm, &expected.joints).is_some()
                );
                if let Some(bend) = wrist_bend(&arm, &expected.joints) {
                    assert!((wrist_bend(&hand, &found.joints).unwrap() - bend).abs() < 1e-7);
                }
            }
        }
    }
}

#[test]
fn postures_of_many_poses_are_those_of_the_arm_too() {
    let arm = arms::mh12();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let mut stream = Stream(51);
    let q: Vec<Vec<f64>> = (0..100).map(|_| stream.joints(&arm)).collect();
    let of_mount = |i: usize| flange(&hand, &in_opposite_order(&q[i]));
    let found = postures_at(&hand, q.len(), of_mount, None, Watch::NONE).unwrap();
    let alone = postures_at(&arm, q.len(), |i| flange(&arm, &q[i]), None, Watch::NONE).unwrap();
    assert_eq!(found.names, alone.names);
    assert_eq!(found.within_limits, alone.within_limits);
    for (found, alone) in found.joints.chunks(6).zip(alone.joints.chunks(6)) {
        let apart = found.iter().rev().zip(alone).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
    }
}

/// Twist of a point fixed to the flange per unit of each joint position, base, by differences of forward kinematics.
fn differences(arm: &Robot, q: &[f64], flange_from_tip: &Isometry) -> Matrix6xX<f64> {
    let h = 1e-6;
    let tip = |joint: usize, step: f64| {
        let mut q = q.to_vec();
        q[joint] += step;
        flange(arm, &q) * flange_from_tip
    };
    let mut all = Matrix6xX::zeros(q.len());
    for joint in 0..q.len() {
        let (after, before) = (tip(joint, h), tip(joint, -h));
        let linear = (after.translation.vector - before.translation.vector) / (2.0 * h);
        let angular = (after.rotation * before.rotation.inverse()).scaled_axis() / (2.0 * h);
        all.fixed_view_mut::<3, 1>(0, joint).copy_from(&linear);
        all.fixed_view_mut::<3, 1>(3, joint).copy_from(&angular);
    }
    all
}

#[test]
fn compliance_is_that_of_the_part_at_the_point_of_contact() {
    let (arm, tool) = (arms::mh12(), arms::bent_tool());
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let plain = StiffnessModel::DRIVES.clone();
    let contact = base_from_mount() * tool;
    let mut stream = Stream(17);
    for _ in 0..20 {
        let q = stream.joints(&arm);
        let flange_from_tip = flange(&arm, &q).inverse() * contact;
        let jacobian = differences(&arm, &q, &flange_from_tip);
        let c = DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(
            6,
            arm.compliance().unwrap().iter().map(|c| c.value),
        ));
        // On the part acts the opposite of the load on the tool, and the tool moves relative to the part by the
        // opposite of the part: two signs that cancel.
        let expected = &jacobian * c * jacobian.transpose();
        let turn = flange(&arm, &q).rotation;
        let mut of_hand = state(&hand, &plain, &tool);
        of_hand.set_joints(&in_opposite_order(&q));
        let (force, moment) = (stream.vector(400.0), stream.vector(60.0));
        let on_tool = Wrench {
            force: turn.inverse() * force,
            moment: turn.inverse() * moment,
        };
        let found = of_hand.elastic(&on_tool).unwrap();
        let wrench = nalgebra::Vector6::from_iterator(force.iter().chain(&moment).copied());
        let moved = expected * wrench;
        // Differences over 1e-6 rad of some metres: 1e-10 of the truncation and the rounding, each used twice.
        let linear = turn * found.linear - moved.fixed_rows::<3>(0);
        assert!(linear.norm() < 1e-8 * moved.norm(), "{linear} of {moved}");
        let angular = turn * found.angular - moved.fixed_rows::<3>(3);
        assert!(angular.norm() < 1e-8 * moved.norm());
    }
}

#[test]
fn the_part_deflects_sags_grows_and_moves_in_its_backlash_as_a_tool_at_its_place_does() {
    let (arm, tool) = (arm(), arms::bent_tool());
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let contact = base_from_mount() * tool;
    let mut stream = Stream(23);
    let reference = stream.joints(&arm);
    let (alone, turned) = (
        model(&arm, &reference),
        model(&hand, &in_opposite_order(&reference)),
    );
    for _ in 0..30 {
        let q = stream.joints(&arm);
        let base_from_flange = flange(&arm, &q);
        let flange_from_tip = base_from_flange.inverse() * contact;
        let turn: UnitQuaternion<f64> = base_from_flange.rotation;
        let (force, moment) = (stream.vector(400.0), stream.vector(60.0));
        let [mut of_arm, mut of_hand] = [
            state(&arm, &alone, &flange_from_tip),
            state(&hand, &turned, &tool),
        ];
        of_arm.set_joints(&q);
        of_hand.set_joints(&in_opposite_order(&q));
        let on_part = Wrench {
            force: -force,
            moment: -moment,
        };
        let on_tool = Wrench {
            force: turn.inverse() * force,
            moment: turn.inverse() * moment,
        };
        let expected = of_arm.elastic(&on_part).unwrap();
        let found = of_hand.elastic(&on_tool).unwrap();
        assert!(opposite(&(turn * found.linear), &expected.linear), "{found:?}");
        assert!(opposite(&(turn * found.angular), &expected.angular));
        for (index, torque) in of_arm.gravity_torques().iter().enumerate().take(6) {
            let found = of_hand.gravity_torques()[5 - index];
            // The positive direction in the chain is the opposite. Of some kN m.
            assert!(
                (found + torque).abs() < 1e-8,
                "joint {index}: {found} {torque} N m"
            );
        }
        let sag = |state: &ArmState<'_>| -> Twist {
            let all = state.sagging().unwrap();
            all.into_iter().map(|(twist, _)| twist).sum()
        };
        let (expected, found) = (sag(&of_arm), sag(&of_hand));
        assert!(opposite(&(turn * found.linear), &expected.linear));
        assert!(opposite(&(turn * found.angular), &expected.angular));
        let (expected, found) = (of_arm.thermal(), of_hand.thermal());
        assert!(opposite(&(turn * found.linear), &expected.linear));
        let kept: Vec<f64> = (0..6).map(|_| stream.between(-1e-4, 1e-4)).collect();
        let kept_back: Vec<f64> = kept.iter().rev().map(|kept| -kept).collect();
        let expected = of_arm.backlash(&kept, &on_part);
        let found = of_hand.backlash(&kept_back, &on_tool);
        assert!(opposite(&(turn * found.linear), &expected.linear));
        assert!(expected.linear.norm() > 1e-6);
    }
}

#[test]
fn gravity_is_relative_to_tool_setting_in_the_axes_of_the_ground() {
    let (arm, tool) = (arm(), arms::bent_tool());
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let mut stream = Stream(29);
    let (reference, q) = (stream.joints(&arm), stream.joints(&arm));
    let model = model(&hand, &in_opposite_order(&reference));
    let mut state = state(&hand, &model, &tool);
    let mut in_ground = |q: &[f64]| {
        state.set_joints(&in_opposite_order(q));
        let all = state.sagging().unwrap();
        let sag: Twist = all.into_iter().map(|(twist, _)| twist).sum();
        (
            flange(&arm, q).rotation * sag.linear,
            state.gravity().unwrap().unwrap(),
        )
    };
    let (at_setting, nothing) = in_ground(&reference);
    assert!(nothing.linear.norm() < 1e-15);
    let (here, found) = in_ground(&q);
    let expected = flange(&arm, &q).rotation.inverse() * (here - at_setting);
    assert!((found.linear - expected).norm() < 1e-12 * expected.norm());
}

#[test]
fn the_mount_deflects_under_the_weight_of_the_tool_and_the_load_on_it() {
    let rigid = JointCompliance {
        value: 0.0,
        standard_uncertainty: 0.0,
    };
    let arm = arms::mh12().with_compliance(vec![rigid; 6]).unwrap();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let mut model = model(&hand, &[0.0; 6]);
    let soft = JointCompliance { value: 2e-8, ..rigid };
    model.structure.springs = vec![Spring::along(Attachment::Flange, Vector3::z(), soft)];
    model.structure.masses = vec![Mass {
        attachment: Attachment::Tool,
        mass: 60.0,
        centre: Point3::new(0.1, 0.0, 0.2),
        inertia: None,
        relative_uncertainty: 0.0,
    }];
    let tool = Isometry::identity();
    let q = [0.3, -0.2, 0.4, 0.5, -0.6, 0.7];
    let mut state = state(&hand, &model, &tool);
    state.set_joints(&in_opposite_order(&q));
    let (z, turn) = (
        base_from_mount().rotation * Vector3::z(),
        flange(&arm, &q).rotation,
    );
    let force = Vector3::new(100.0, -200.0, 300.0);
    let found = state
        .elastic(&Wrench::from_force(turn.inverse() * force))
        .unwrap();
    assert!((turn * found.linear - z * (2e-8 * z.dot(&force))).norm() < 1e-15);
    let g = model.gravity.as_ref().unwrap().acceleration;
    let (sag, _) = state.sagging().unwrap()[6];
    assert!((turn * sag.linear - z * (2e-8 * 60.0 * z.dot(&g))).norm() < 1e-15);
    // Of the drives, none carries it.
    assert!(state.gravity_torques()[..6].iter().all(|torque| *torque == 0.0));
}

#[test]
fn uncertainty_and_the_other_parts_keep_their_values() {
    let arm = arm();
    let hand = arm.holding_part(&base_from_mount()).unwrap();
    let (own, back) = (arm.structure(), hand.structure());
    let (own_u, back_u) = (
        own.covariance.as_ref().unwrap(),
        back.covariance.as_ref().unwrap(),
    );
    assert_eq!(own_u[(0, 0)], back_u[(5, 5)]);
    assert_eq!(own_u[(2, 7)], back_u[(3, 7)]);
    assert_eq!(own_u[(9, 9)], back_u[(9, 9)]);
    assert_eq!(
        (own.repeatability, own.model_error),
        (back.repeatability, back.model_error)
    );
    assert_eq!(back.backlash[5], own.backlash[0]);
    assert_eq!(back.curve(3).unwrap().reversed(), own.curves[2].clone().unwrap());
}

#[test]
fn arms_on_external_axes_and_chains_of_a_part_are_refused() {
    let hand = arms::mh12().holding_part(&base_from_mount()).unwrap();
    let error = hand.holding_part(&base_from_mount()).unwrap_err();
    assert!(matches!(error, RobotError::NotAnArm { .. }));
    let error = arms::other::on_rail(&arms::mh12())
        .holding_part(&base_from_mount())
        .unwrap_err();
    assert_eq!(error, RobotError::ExternalAxesOfHand { external: 1 });
}
