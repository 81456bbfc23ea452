//! Forward, Jacobian and inverse kinematics against each other and against finite differences.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod arms;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Vector3, Vector6};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::jacobian::jacobian;
use armill_core::robot::{Singularity, Unreachable};
use proptest::prelude::*;

fn six_numbers() -> impl Strategy<Value = [f64; 6]> {
    prop::array::uniform6(0.0..1.0_f64)
}

fn twist_between(from: &Isometry, to: &Isometry) -> Vector6<f64> {
    let linear = to.translation.vector - from.translation.vector;
    let angular = (to.rotation * from.rotation.inverse()).scaled_axis();
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn jacobian_matches_finite_differences(arm in 0..arms::ALL.len(), unit in six_numbers()) {
        let robot = &arms::ALL[arm];
        let q = arms::positions(robot, &unit);
        let tool = arms::bent_tool();
        let posture = posture_at(robot, &q, &tool);
        let analytic = jacobian(robot, &posture.screws);
        // Central differences: error h^2 / 6 of the third derivative (below 10 m) plus eps / h.
        let h = 1e-5;
        for i in 0..6 {
            let moved = |by: f64| {
                let mut q = q.clone();
                q[i] += by;
                posture_at(robot, &q, &tool).base_from_tool
            };
            let numeric = twist_between(&moved(-h), &moved(h)) / (2.0 * h);
            let away = (analytic.column(i) - numeric).norm();
            prop_assert!(away < 1e-9, "{}, joint {i}: {away}", robot.name());
        }
    }

    #[test]
    fn some_posture_gives_back_the_joints_that_made_the_pose(arm in 0..arms::ALL.len(), unit in six_numbers()) {
        let robot = &arms::ALL[arm];
        prop_assert!(robot.ortho_parallel().is_some(), "all test arms have a closed form");
        let q = arms::positions(robot, &unit);
        let tool = arms::bent_tool();
        let made = posture_at(robot, &q, &tool);
        let found = postures(robot, &made.base_from_tool, ToolAt::on(&tool))
            .expect("a pose made by forward kinematics is reachable");
        let same = found.iter().find(|posture| posture.name == made.name).expect("its own branch is found");
        // Near a singularity the joints are worse known than the pose, by about 1 / sine.
        prop_assume!(made.singularity.is_none());
        for (index, (a, b)) in same.joints.iter().zip(&q).enumerate() {
            let turns = (a - b) / std::f64::consts::TAU;
            let away = (turns - turns.round()).abs() * std::f64::consts::TAU;
            prop_assert!(away < 1e-9, "{} {index}: {a} rad against {b} rad", robot.name());
        }
    }

    #[test]
    fn every_posture_reaches_the_requested_tool_pose(arm in 0..arms::ALL.len(), unit in six_numbers()) {
        let robot = &arms::ALL[arm];
        let tool = arms::bent_tool();
        let target = posture_at(robot, &arms::positions(robot, &unit), &tool).base_from_tool;
        let found = postures(robot, &target, ToolAt::on(&tool)).unwrap();
        prop_assert!(found.len() >= 2);
        for posture in &found {
            let reached = posture_at(robot, &posture.joints, &tool);
            prop_assert!(twist_between(&target, &reached.base_from_tool).norm() < 1e-9);
            // The name found from the joints is the name it was solved for.
            if posture.singularity.is_none() {
                prop_assert_eq!(posture.name, reached.name);
            }
        }
    }
}

#[test]
fn mh12_flange_at_zero_is_where_its_urdf_puts_it() {
    let at_zero = posture_at(&arms::mh12(), &[0.0; 6], &Isometry::identity()).base_from_tool;
    assert!((at_zero.translation.vector - Vector3::new(0.895, 0.0, 1.264)).norm() < 1e-15);
    // tool0: z out of the flange along base x (rpy pi, -pi/2, 0).
    assert!((at_zero * Vector3::z() - Vector3::x()).norm() < 1e-15);
    assert!((at_zero * Vector3::y() + Vector3::y()).norm() < 1e-15);
}

#[test]
fn mh12_has_eight_postures_in_the_middle_of_its_space() {
    let robot = arms::mh12();
    let tool = Isometry::identity();
    let target = posture_at(&robot, &[0.3, 0.2, -0.4, 0.5, 0.6, -0.2], &tool).base_from_tool;
    let found = postures(&robot, &target, ToolAt::on(&tool));
    assert_eq!(found.unwrap().len(), 8);
}

#[test]
fn a_pose_beyond_the_stretched_arm_says_by_how_much() {
    let robot = arms::mh12();
    let tool = Isometry::identity();
    // Shoulder at (155, 0, 450) mm; wrist centre 100 mm behind the flange, tool along +x.
    let target = armill_core::workpiece::Plane::tilted([3.0, 0.0, 0.45].into(), 0.0)
        .base_from_tool([0.0, 0.0].into(), 0.0);
    let miss = postures(&robot, &target, ToolAt::on(&tool));
    let reach = 0.614 + 0.640_f64.hypot(0.200);
    let Err(Unreachable::TooFar { by }) = miss else {
        panic!("{miss:?}")
    };
    assert!((by - (2.9 - 0.155 - reach)).abs() < 1e-12, "{by} m");
}

#[test]
fn at_the_wrist_singularity_joint_4_stays_or_shares_the_turn() {
    let robot = arms::mh12();
    let tool = Isometry::identity();
    let q = [0.1, 0.2, -0.3, 0.7, 0.0, 0.5];
    let target = posture_at(&robot, &q, &tool).base_from_tool;
    let kept = postures(
        &robot,
        &target,
        ToolAt {
            flange_from_tool: &tool,
            near: Some(&q),
            home: None,
        },
    )
    .unwrap();
    let shared = postures(&robot, &target, ToolAt::on(&tool)).unwrap();
    let front_up = |found: &[armill_core::robot::Posture]| {
        found
            .iter()
            .find(|p| p.name.to_string() == "front elbow-up no-flip")
            .expect("the branch of q")
            .clone()
    };
    let (kept, shared) = (front_up(&kept), front_up(&shared));
    assert_eq!(kept.singularity, Some(Singularity::Wrist));
    assert!(
        (kept.joints[3] - 0.7).abs() < 1e-9 && (kept.joints[5] - 0.5).abs() < 1e-9,
        "{:?}",
        kept.joints
    );
    assert!(
        (shared.joints[3] - 0.6).abs() < 1e-9 && (shared.joints[5] - 0.6).abs() < 1e-9,
        "{:?}",
        shared.joints
    );
}
