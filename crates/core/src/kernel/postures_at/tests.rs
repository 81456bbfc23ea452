//! The postures of many poses are those of each pose alone.

use super::super::tests::poses;
use super::*;
use crate::arms;
use crate::robot::inverse::{ToolAt, postures};

#[test]
fn postures_of_many_poses_are_those_of_each_pose_alone() {
    let flange = Isometry::identity();
    for (robot, count) in [
        (arms::mh12(), 3 * AT_ONCE + 5),
        (arms::r2000ic(), AT_ONCE + 5),
        (arms::other::ur10(), AT_ONCE + 5),
        (arms::other::calibrated(&arms::kr120(), 1e-3), AT_ONCE + 5),
        // An arm without a closed form takes longer.
        (arms::other::iiwa14(), 3),
    ] {
        let mut requested = poses(&robot, count, 5);
        requested[1].translation.vector.x += 90.0;
        let found = postures_at(&robot, count, |i| requested[i], None, Watch::NONE).unwrap();
        let dof = robot.joints().len();
        assert_eq!(found.joints.len(), found.names.len() * dof);
        assert_eq!(found.within_limits.len(), found.names.len());
        let mut first = 0;
        for (pose, given) in requested.iter().zip(&found.poses) {
            let witness = postures(&robot, pose, ToolAt::on(&flange));
            assert_eq!(*given, witness.as_ref().map(Vec::len).map_err(|why| *why));
            for (posture, index) in witness.unwrap_or_default().iter().zip(first..) {
                for (a, b) in found.joints[index * dof..][..dof].iter().zip(&posture.joints) {
                    // Near a singularity a posture is accurate to the square root of rounding.
                    let accuracy = if posture.singularity.is_some() {
                        1e-6
                    } else {
                        1e-10
                    };
                    assert!((a - b).abs() < accuracy, "{}: {a} {b}", robot.name());
                }
                assert_eq!(found.names[index], posture.name);
                let margin = robot.limit_margin(&posture.joints).unwrap().1;
                assert_eq!(found.within_limits[index], margin >= -AT_LIMIT);
            }
            first += given.unwrap_or(0);
        }
        assert!(found.poses[1].is_err(), "a pose 90 m away is out of reach");
        assert_eq!(first, found.names.len());
    }
}
