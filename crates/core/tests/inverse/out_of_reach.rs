//! Poses without a posture, and singular ones with infinitely many.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Robot, Singularity, Unreachable};

use crate::arms;
use crate::arms::other::{self, DhRow};
use crate::{apart, at};

#[test]
fn a_pose_out_of_reach_has_a_reason_with_an_amount() {
    let far = Isometry::translation(9.0, 0.0, 0.5);
    let tool = Isometry::identity();
    let miss = |robot: &Robot| postures(robot, &far, at(&tool)).unwrap_err();
    for robot in [
        other::ur10(),
        other::calibrated(&arms::mh12(), 5e-4),
        other::on_rail(&arms::mh12()),
    ] {
        let miss = miss(&robot);
        assert!(
            matches!(miss, Unreachable::TooFar { by } if by > 6.0 && by < 9.0),
            "{miss:?}"
        );
    }
    for robot in [other::oblique(), other::iiwa14()] {
        let miss = miss(&robot);
        let Unreachable::NotFound { by, turned } = miss else {
            panic!("{miss:?}")
        };
        assert!(by > 6.0 && by < 9.0 && turned.is_finite(), "{miss:?}");
        assert!(miss.to_string().contains("does not prove"));
    }
    // Axis 4 of a UR has an offset of 163.941 mm from the plane of the arm: no wrist centre comes nearer to axis 1.
    let near_axis = flange_at_wrist_centre(&other::UR10, [0.05, 0.0, 0.6]);
    let miss = postures(&other::ur10(), &near_axis, at(&tool)).unwrap_err();
    assert!(
        matches!(miss, Unreachable::InsideLateralOffset { by } if (by - 0.113_941).abs() < 1e-9),
        "{miss:?}"
    );
}

/// A flange pose, its z down, whose wrist centre is at `at`.
fn flange_at_wrist_centre(rows: &[DhRow; 6], at: [f64; 3]) -> Isometry {
    let down = armill_core::frame::tool_orientation(-Vector3::z_axis(), 0.3);
    let flange = Vector3::from(at) - Vector3::z() * rows[5][0];
    Isometry::from_parts(flange.into(), down)
}

#[test]
fn singular_poses_have_finite_postures_with_a_flag() {
    let tool = arms::bent_tool();
    let tenth = |n: usize| (0..n).map(|i| 0.1 * (i as f64 + 1.0)).collect::<Vec<_>>();
    let mut straight_ur = tenth(6);
    straight_ur[4] = 0.0;
    let mut stretched = tenth(7);
    stretched[3] = 0.0;
    let mut calibrated = tenth(6);
    calibrated[4] = 0.0;
    let singular = [
        (other::ur10(), straight_ur, Singularity::Wrist),
        (other::iiwa14(), vec![0.0; 7], Singularity::Dependent),
        (other::iiwa14(), stretched, Singularity::Dependent),
        (
            other::calibrated(&arms::mh12(), 5e-4),
            calibrated,
            Singularity::Wrist,
        ),
    ];
    for (robot, q, singularity) in singular {
        let made = posture_at(&robot, &q, &tool);
        assert_eq!(made.singularity, Some(singularity), "{}", robot.name());
        let found = postures(&robot, &made.base_from_tool, at(&tool)).unwrap();
        let flagged = found.iter().filter(|p| p.singularity == Some(singularity));
        assert!(flagged.count() > 0, "{}", robot.name());
        for posture in &found {
            assert!(posture.joints.iter().all(|q| q.is_finite()));
            let reached = posture_at(&robot, &posture.joints, &tool).base_from_tool;
            let away = reached.translation.vector - made.base_from_tool.translation.vector;
            assert!(away.norm() < 1e-9);
        }
    }
}

#[test]
fn where_a_ur_leaves_joint_6_free_it_is_not_moved() {
    let (robot, tool) = (other::ur10(), Isometry::identity());
    let q = [0.3, -1.2, 1.4, 0.2, 0.0, 0.7];
    let pose = posture_at(&robot, &q, &tool).base_from_tool;
    let found = postures(
        &robot,
        &pose,
        ToolAt {
            near: Some(&q),
            ..at(&tool)
        },
    )
    .unwrap();
    // The bend is zero to rounding: two flips, one posture.
    assert!(
        found.iter().any(|p| apart(&robot, &p.joints, &q) < 1e-7),
        "{found:?}"
    );
}
