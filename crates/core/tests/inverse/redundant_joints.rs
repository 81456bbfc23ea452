//! Rails and seventh axes: which joint is kept at home, and how far it leaves home.

use armill_core::frame::Isometry;
use armill_core::robot::inverse::{Inverse, ToolAt, posture_at, postures};
use armill_core::robot::joint::Sign;
use armill_core::robot::{Posture, Robot};

use crate::arms::{self, Stream, other};
use crate::{apart, at, flange_of_rows};

#[test]
fn joint_3_of_an_iiwa_is_at_home_and_all_eight_postures_of_the_others_are_found() {
    let (robot, tool) = (other::iiwa14(), Isometry::identity());
    assert!(matches!(robot.inverse(), Inverse::OneFixed(_)));
    assert!(robot.inverse().to_string().contains("joint 3 is fixed"));
    let (mut stream, mut eights, mut at_home, mut count) = (Stream(11), 0, 0, 0_usize);
    for _ in 0..10_000 {
        let q = stream.joints(&robot);
        let target = flange_of_rows(&other::IIWA14, &q);
        let made = posture_at(&robot, &q, &tool);
        if made.singularity.is_some() {
            continue;
        }
        let mut home = q.clone();
        for joint in [0, 1, 3, 4, 5, 6] {
            home[joint] = 0.0;
        }
        let expected = ToolAt {
            home: Some(&home),
            ..at(&tool)
        };
        let found = postures(&robot, &made.base_from_tool, expected).unwrap();
        assert!(found.iter().any(|p| apart(&robot, &p.joints, &q) < 1e-6), "{q:?}");
        for (i, posture) in found.iter().enumerate() {
            assert!((flange_of_rows(&other::IIWA14, &posture.joints) - target).norm() < 2e-9);
            assert_eq!(posture.joints[2], q[2]);
            assert!(
                found[..i]
                    .iter()
                    .all(|other| apart(&robot, &posture.joints, &other.joints) > 1e-5)
            );
        }
        eights += usize::from(found.len() == 8);
        // With joint 3 at zero, although no pose was made with it.
        let found = postures(&robot, &made.base_from_tool, at(&tool)).unwrap();
        at_home += usize::from(found[0].joints[2] == 0.0);
        let position = found[0].joints[2];
        assert!(found.iter().all(|p| p.joints[2] == position), "{found:?}");
        count += 1;
    }
    println!("{count} poses, {eights} with 8, {at_home} at home");
    assert_eq!(eights, count);
    assert!(at_home as f64 > 0.5 * count as f64, "{at_home} of {count}");
}

#[test]
fn joint_3_leaves_home_only_as_far_as_the_limits_require() {
    let (robot, tool) = (other::iiwa14(), Isometry::identity());
    let (mut stream, mut left) = (Stream(12), 0);
    let within = |p: &Posture| {
        robot
            .limit_margin(&p.joints)
            .is_none_or(|(_, margin)| margin >= 0.0)
    };
    for _ in 0..1000 {
        let q = stream.joints(&robot);
        let pose = posture_at(&robot, &q, &tool).base_from_tool;
        let found = postures(&robot, &pose, at(&tool)).unwrap();
        // The joint positions of the pose are within the limits: some posture is within five degrees of them.
        let inside = found.iter().find(|p| within(p));
        let position = found[0].joints[2];
        if position == 0.0 {
            continue;
        }
        assert!(inside.is_some(), "{q:?}");
        left += 1;
        // Nearer to home no posture is within the limits.
        for part in [0.5, 0.9, 0.999] {
            let mut home = [0.0; 7];
            home[2] = part * position;
            let nearer = postures(
                &robot,
                &pose,
                ToolAt {
                    home: Some(&home),
                    ..at(&tool)
                },
            );
            assert!(nearer.unwrap()[0].joints[2] != home[2], "{q:?} {part}");
        }
    }
    assert!(left > 10, "{left}");
}

#[test]
fn calibrated_railed_and_differently_zeroed_iiwas_reach_their_poses_with_joint_3_at_home() {
    let (iiwa, tool) = (other::iiwa14(), Isometry::identity());
    let mut joints = iiwa.joints().to_vec();
    for joint in &mut joints {
        (joint.sign, joint.zero_offset) = (Sign::Negative, 0.3);
    }
    let counted = Robot::new("counted", iiwa.chain().motions().to_vec(), joints).unwrap();
    for (robot, kind, arm_state) in [
        (other::calibrated(&iiwa, 5e-4), "polished", 2),
        (other::on_rail(&iiwa), "closed_form", 3),
        (counted, "closed_form", 2),
    ] {
        assert_eq!(robot.inverse().word(), kind);
        let mut stream = Stream(13);
        for _ in 0..1000 {
            let q = stream.joints(&robot);
            let made = posture_at(&robot, &q, &tool);
            if made.singularity.is_some() {
                continue;
            }
            let home = ToolAt {
                home: Some(&q),
                ..at(&tool)
            };
            let found = postures(&robot, &made.base_from_tool, home).unwrap();
            assert!(found.iter().all(|p| p.joints[arm_state] == q[arm_state]));
            assert!(
                apart(&robot, &found[0].joints, &q) < 1e-6,
                "{}: {q:?}",
                robot.name()
            );
        }
    }
}

#[test]
fn a_rail_is_kept_at_home_and_redundant_joints_are_pulled_to_it() {
    let tool = arms::bent_tool();
    let railed = other::on_rail(&arms::mh12());
    let pose = Isometry::translation(0.0, 2.0, 0.0)
        * posture_at(&arms::mh12(), &[0.2, 0.1, -0.3, 0.4, 0.5, 0.6], &tool).base_from_tool;
    let position = |home: Option<&[f64]>| -> f64 {
        postures(&railed, &pose, ToolAt { home, ..at(&tool) }).unwrap()[0].joints[0]
    };
    assert_eq!(position(None), 2.0);
    assert_eq!(position(Some(&[2.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])), 2.3);

    let iiwa = other::iiwa14();
    let q = [0.3, 0.6, -0.4, -1.2, 0.5, 0.9, -0.2];
    let pose = posture_at(&iiwa, &q, &tool).base_from_tool;
    // Home is a posture of the pose: nothing is nearer to it.
    let found = postures(
        &iiwa,
        &pose,
        ToolAt {
            home: Some(&q),
            ..at(&tool)
        },
    )
    .unwrap();
    assert!(apart(&iiwa, &found[0].joints, &q) < 1e-5, "{:?}", found[0].joints);
    // Without it, the first is the nearest to the middle: a rotation of the elbow either way is farther.
    let length = |p: &Posture| p.joints.iter().map(|q| q * q).sum::<f64>();
    let found = postures(&iiwa, &pose, at(&tool)).unwrap();
    assert!(found.iter().all(|p| length(p) >= length(&found[0])));
    assert!(length(&found[0]) < q.iter().map(|q| q * q).sum());
}
