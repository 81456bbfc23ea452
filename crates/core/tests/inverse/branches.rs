//! Names of branches: unique, correct for the positions of the links, and kept by a calibrated arm.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::inverse::{posture_at, postures};

use crate::arms::{self, Stream, other};
use crate::{apart, at, flange_of_rows};

#[test]
fn all_eight_branches_of_a_ur_have_names_and_reach_the_pose_by_its_dh_matrices() {
    let tool = Isometry::identity();
    for (robot, rows) in [(other::ur10(), other::UR10), (other::ur10e(), other::UR10E)] {
        let (mut stream, mut eights) = (Stream(3), 0);
        for _ in 0..2000 {
            let q = stream.joints(&robot);
            let target = flange_of_rows(&rows, &q);
            let made = posture_at(&robot, &q, &tool);
            assert!((made.base_from_tool.to_homogeneous() - target).norm() < 1e-13);
            let found = postures(&robot, &made.base_from_tool, at(&tool)).unwrap();
            let mut names: Vec<_> = found.iter().map(|p| p.name.branch().unwrap()).collect();
            names.dedup();
            assert_eq!(names.len(), found.len());
            eights += usize::from(found.len() == 8);
            for posture in &found {
                let reached = flange_of_rows(&rows, &posture.joints);
                assert!((reached - target).norm() < 1e-9);
                if posture.singularity.is_none() {
                    assert_eq!(posture.name, posture_at(&robot, &posture.joints, &tool).name);
                }
            }
            for (i, a) in found.iter().enumerate() {
                assert!(
                    found[..i]
                        .iter()
                        .all(|b| apart(&robot, &a.joints, &b.joints) > 1e-6)
                );
            }
        }
        // Poses near the end of the reach have four: from one shoulder or with one flip the hand is too far.
        assert!(eights > 1000, "{}: {eights} of 2000", robot.name());
    }
}

#[test]
fn branch_names_of_a_ur_match_the_positions_of_its_links() {
    // The wrist centre is where axes 5 and 6 meet; the elbow is axis 3; axis 4 is the end of the forearm.
    let (robot, tool) = (other::ur10(), Isometry::identity());
    let mut stream = Stream(8);
    for _ in 0..500 {
        let q = stream.joints(&robot);
        let posture = posture_at(&robot, &q, &tool);
        if posture.singularity.is_some() {
            continue;
        }
        let name = posture.name.to_string();
        let point = |count: usize| {
            let frame = flange_of_rows(&other::UR10[..count], &q);
            Vector3::new(frame[(0, 3)], frame[(1, 3)], frame[(2, 3)])
        };
        // In the base turned by joint 1; frame 5 has its origin where axes 5 and 6 meet.
        let x = |p: Vector3<f64>| q[0].cos() * p.x + q[0].sin() * p.y;
        assert_eq!(name.contains("front"), x(point(5)) >= 0.0, "{name}");
        let (shoulder, elbow, hand) = (Vector3::new(0.0, 0.0, 0.1273), point(2), point(3));
        let line = (hand.z - shoulder.z) / (x(hand) - x(shoulder)) * (x(elbow) - x(shoulder)) + shoulder.z;
        assert_eq!(name.contains("elbow-up"), elbow.z >= line, "{name}");
        assert_eq!(name.contains("no-flip"), q[4].sin() >= 0.0, "{name}");
    }
}

#[test]
fn a_calibrated_arm_keeps_the_names_of_its_branches() {
    let (ideal, tool) = (arms::mh12(), arms::bent_tool());
    let robot = other::calibrated(&ideal, 5e-4);
    let mut stream = Stream(5);
    for _ in 0..300 {
        let q = stream.joints(&robot);
        let (made, like) = (posture_at(&robot, &q, &tool), posture_at(&ideal, &q, &tool));
        // Five degrees: within one the two arms may differ in what is singular.
        if q[4].sin().abs() < 0.09 || like.singularity.is_some() {
            continue;
        }
        assert_eq!(made.name, like.name);
        let found = postures(&robot, &made.base_from_tool, at(&tool)).unwrap();
        let same = found.iter().find(|p| p.name == like.name).unwrap();
        assert!(apart(&robot, &same.joints, &q) < 1e-6, "{}", like.name);
    }
}
