//! Every kind of inverse against forward kinematics, on the arms of the field.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod arms;

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::{Answers, BranchChoice, Question, evaluate, evaluate_in_order};
use armill_core::load::Doubt;
use armill_core::nalgebra::{Matrix4, Unit, UnitQuaternion, Vector3};
use armill_core::predict::predict;
use armill_core::robot::inverse::{Finder, Inverse, SphericalWrist, ToolAt, Wanted, posture_at, postures};
use armill_core::robot::joint::Sign;
use armill_core::robot::{Posture, Robot, Singularity, Unreachable};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use arms::Stream;
use arms::other::{self, DhRow};

fn at(tool: &Isometry) -> ToolAt<'_> {
    ToolAt::on(tool)
}

/// Largest difference of two joint positions, whole turns aside, rad (m).
fn apart(robot: &Robot, a: &[f64], b: &[f64]) -> f64 {
    let of = |i: usize| {
        let away = a[i] - b[i];
        if robot.slides(i) {
            away.abs()
        } else {
            (away - TAU * (away / TAU).round()).abs()
        }
    };
    (0..a.len()).map(of).fold(0.0, f64::max)
}

/// The flange of the standard Denavit-Hartenberg rows, by matrices of its own.
fn flange_of_rows(rows: &[DhRow], q: &[f64]) -> Matrix4<f64> {
    rows.iter()
        .zip(q)
        .fold(Matrix4::identity(), |before, ([d, a, alpha], q)| {
            let ((s, c), (sa, ca)) = (q.sin_cos(), alpha.sin_cos());
            before
                * Matrix4::new(
                    c,
                    -s * ca,
                    s * sa,
                    a * c, //
                    s,
                    c * ca,
                    -c * sa,
                    a * s, //
                    0.0,
                    sa,
                    ca,
                    *d, //
                    0.0,
                    0.0,
                    0.0,
                    1.0,
                )
        })
}

/// What came of the poses of random joint positions.
#[derive(Debug, Default)]
struct Trips {
    /// Poses, without those near a singularity.
    poses: usize,
    /// Of them, those with any posture.
    held: usize,
    /// Of them, those with the joint positions that made them among their postures.
    returned: usize,
    /// Postures in all.
    postures: usize,
}

/// Random poses there and back, each posture checked by the product of elementary motions. A rail, or a joint to spare,
/// stands where it did.
// What a reader of the output wants to know.
#[allow(clippy::print_stdout)]
fn round_trips(robot: &Robot, count: usize) -> Trips {
    let tool = arms::bent_tool();
    let mut stream = Stream(20);
    let mut trips = Trips::default();
    for _ in 0..count {
        let q = stream.joints(robot);
        let made = posture_at(robot, &q, &tool);
        if made.singularity.is_some() {
            continue;
        }
        let home = (robot.joints().len() > 6).then_some(&q[..]);
        let found = postures(robot, &made.base_from_tool, ToolAt { home, ..at(&tool) }).unwrap_or_default();
        trips.poses += 1;
        trips.held += usize::from(!found.is_empty());
        trips.postures += found.len();
        // A pose is known to 1e-12; near the end of a branch joints are known to the root of it.
        trips.returned += usize::from(found.iter().any(|p| apart(robot, &p.joints, &q) < 1e-6));
        for posture in &found {
            let theta: Vec<f64> = (0..q.len()).map(|i| robot.theta(i, &posture.joints)).collect();
            let reached = robot.chain().base_from_flange(&theta) * tool;
            let away = reached.translation.vector - made.base_from_tool.translation.vector;
            // The angle between two quaternions is known to the root of rounding.
            let turned = reached.rotation.angle_to(&made.base_from_tool.rotation);
            assert!(away.norm() < 1e-9 && turned < 3e-8, "{}", robot.name());
        }
    }
    println!("{}: {trips:?}", robot.name());
    trips
}

#[test]
fn closed_forms_give_back_the_joints_that_made_the_pose() {
    for robot in [
        arms::mh12(),
        arms::kr120(),
        other::kr210_l150(),
        other::ur10(),
        other::ur10e(),
        other::on_rail(&arms::mh12()),
        other::on_rail(&other::ur10e()),
    ] {
        assert_eq!(robot.inverse().word(), "closed_form", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert_eq!(trips.returned, trips.poses, "{}", robot.name());
    }
}

#[test]
fn calibrated_arms_give_back_the_joints_that_made_the_pose() {
    for ideal in [arms::mh12(), other::ur10e()] {
        let robot = other::calibrated(&ideal, 5e-4);
        assert!(matches!(robot.inverse(), Inverse::Polished(_)));
        let trips = round_trips(&robot, 10_000);
        assert_eq!(trips.held, trips.poses);
        // Beside the singularities of the ideal arm two branches may end in one posture.
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
fn searched_arms_hold_every_pose() {
    // A search of 16 postures takes milliseconds: fewer poses here, 100 000 in the ignored test.
    let robot = other::oblique();
    assert!(matches!(robot.inverse(), Inverse::Searched));
    let trips = round_trips(&robot, 1000);
    assert!(trips.held as f64 > 0.999 * trips.poses as f64, "{trips:?}");
}

/// Arms whose last or first three axes meet, and no closed form with names holds.
fn with_spherical_wrist() -> [(Robot, [DhRow; 6]); 4] {
    [
        ("made-up/puma-like", other::PUMA_LIKE),
        ("made-up/skewed", other::SKEWED),
        ("made-up/tilted-wrist", other::TILTED_WRIST),
        ("made-up/spherical-shoulder", other::SPHERICAL_SHOULDER),
    ]
    .map(|(name, rows)| (other::free(name, &rows), rows))
}

#[test]
fn spherical_wrists_give_back_the_joints_that_made_the_pose() {
    for (robot, _) in with_spherical_wrist() {
        assert_eq!(robot.inverse().word(), "closed_form", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert!(trips.returned as f64 > 0.9999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
fn postures_of_spherical_wrists_are_distinct_and_hold_the_pose_by_its_dh_matrices() {
    let tool = Isometry::identity();
    for (robot, rows) in with_spherical_wrist() {
        let (mut stream, mut most) = (Stream(4), 0);
        for _ in 0..2000 {
            let target = flange_of_rows(&rows, &stream.joints(&robot));
            let pose = isometry(&target);
            let found = postures(&robot, &pose, at(&tool)).unwrap();
            for (i, posture) in found.iter().enumerate() {
                // The pose is read off the matrix to rounding, and held to 1e-9.
                assert!((flange_of_rows(&rows, &posture.joints) - target).norm() < 2e-9);
                assert!(
                    found[..i]
                        .iter()
                        .all(|other| apart(&robot, &posture.joints, &other.joints) > 1e-5)
                );
            }
            most = most.max(found.len());
        }
        assert_eq!(most, 8, "{}", robot.name());
    }
}

/// A matrix as rotation and point.
fn isometry(matrix: &Matrix4<f64>) -> Isometry {
    let axes = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let rotation = UnitQuaternion::from_matrix(&axes);
    Isometry::from_parts(
        Vector3::new(matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)]).into(),
        rotation,
    )
}

#[test]
fn the_spherical_wrist_of_an_ortho_parallel_arm_gives_the_postures_of_its_own_closed_form() {
    for robot in [arms::mh12(), arms::kr120(), other::kr210_l150()] {
        let wrist = SphericalWrist::recognise(robot.chain()).unwrap();
        let tool = Isometry::identity();
        let (mut stream, mut compared) = (Stream(6), 0);
        for _ in 0..10_000 {
            let pose = posture_at(&robot, &stream.joints(&robot), &tool).base_from_tool;
            let named = postures(&robot, &pose, at(&tool)).unwrap();
            // Beside a singularity two postures may be nearer than what tells them apart.
            if named.iter().any(|posture| posture.singularity.is_some()) {
                continue;
            }
            let general = wrist.chain_positions(&pose, None);
            assert_eq!(general.len(), named.len(), "{}", robot.name());
            for posture in &named {
                let theta: Vec<f64> = (0..6).map(|i| robot.theta(i, &posture.joints)).collect();
                // A degree from a singularity 1e-10 of the pose is 1e-8 of a joint at most.
                let nearest = general.iter().map(|other| apart(&robot, other, &theta));
                assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-8, "{}", robot.name());
            }
            compared += 1;
        }
        assert!(compared > 8000, "{}: {compared}", robot.name());
    }
}

#[test]
fn joint_3_of_an_iiwa_stands_at_home_and_all_eight_postures_of_the_others_are_found() {
    let (robot, tool) = (other::iiwa14(), Isometry::identity());
    assert!(matches!(robot.inverse(), Inverse::OneStands(_)));
    assert!(robot.inverse().to_string().contains("joint 3 stands still"));
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
        let wanted = ToolAt {
            home: Some(&home),
            ..at(&tool)
        };
        let found = postures(&robot, &made.base_from_tool, wanted).unwrap();
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
        // With joint 3 at zero, where no joint made the pose.
        let found = postures(&robot, &made.base_from_tool, at(&tool)).unwrap();
        at_home += usize::from(found[0].joints[2] == 0.0);
        let stands = found[0].joints[2];
        assert!(found.iter().all(|p| p.joints[2] == stands), "{found:?}");
        count += 1;
    }
    println!("{count} poses, {eights} with 8, {at_home} at home");
    assert_eq!(eights, count);
    assert!(at_home as f64 > 0.5 * count as f64, "{at_home} of {count}");
}

#[test]
fn joint_3_leaves_home_only_as_far_as_the_limits_ask_for() {
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
        // The joints that made the pose are inside: five degrees and less from them some posture is.
        let inside = found.iter().find(|p| within(p));
        let stands = found[0].joints[2];
        if stands == 0.0 {
            continue;
        }
        assert!(inside.is_some(), "{q:?}");
        left += 1;
        // Nearer to home it would not stay either.
        for part in [0.5, 0.9, 0.999] {
            let mut home = [0.0; 7];
            home[2] = part * stands;
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
fn calibrated_railed_and_otherwise_counted_iiwas_hold_their_poses_with_joint_3_at_home() {
    let (iiwa, tool) = (other::iiwa14(), Isometry::identity());
    let mut joints = iiwa.joints().to_vec();
    for joint in &mut joints {
        (joint.sign, joint.zero_offset) = (Sign::Negative, 0.3);
    }
    let counted = Robot::new("counted", iiwa.chain().motions().to_vec(), joints).unwrap();
    for (robot, kind, standing) in [
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
            assert!(found.iter().all(|p| p.joints[standing] == q[standing]));
            assert!(
                apart(&robot, &found[0].joints, &q) < 1e-6,
                "{}: {q:?}",
                robot.name()
            );
        }
    }
}

#[test]
fn a_map_of_an_iiwa_is_continuous() {
    for choice in choices() {
        along(&other::iiwa14(), choice, |question, poses| {
            let answers = evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap();
            assert_eq!(answers.held().count(), poses.len());
            assert!((0..poses.len()).all(|i| answers.joints_at(i)[2] == 0.0));
            let held: Vec<_> = answers.held().collect();
            for ((_, a), (i, b)) in held.iter().zip(&held[1..]) {
                // Half a millimetre to one apart, of a reach of 0.8 m: some parts in a thousand. The best posture of
                // all may come to a limit: the deviation then steps up.
                let step = (a.in_plane - b.in_plane).abs() / a.in_plane;
                assert!(step < 0.01 || choice == BranchChoice::Best, "{i}: {step}");
            }
        });
    }
}

#[test]
fn a_search_that_follows_keeps_the_postures_that_continue() {
    let (robot, tool) = (other::oblique(), Isometry::identity());
    let q = [0.3, 0.5, -0.4, 0.7, 1.1, 0.4];
    let start = posture_at(&robot, &q, &tool).base_from_tool;
    let (mut finder, mut fewer) = (Finder::new(&robot), 0);
    let mut before = usize::MAX;
    for k in 0..200 {
        let wanted = Wanted {
            base_from_flange: Isometry::translation(0.0, 0.002 * f64::from(k), 0.0) * start,
            near: None,
            home: None,
        };
        let followed: Vec<Vec<f64>> = finder
            .all(&wanted)
            .unwrap()
            .iter()
            .map(|p| p.joints.clone())
            .collect();
        assert!(
            followed.len() <= before || before == 0,
            "nothing new turns up on the way"
        );
        fewer += usize::from(followed.len() < before);
        before = followed.len();
        let mut anew = Finder::new(&robot);
        let anew = anew.all(&wanted).unwrap();
        for joints in &followed {
            assert!(
                anew.iter()
                    .any(|found| apart(&robot, &found.joints, joints) < 1e-6),
                "at {k}"
            );
        }
    }
    assert!(fewer >= 2, "a pair of postures ends on the way");
}

#[test]
fn calibrated_spherical_wrists_give_back_the_joints_that_made_the_pose() {
    for (ideal, _) in with_spherical_wrist() {
        let robot = other::calibrated(&ideal, 5e-4);
        assert_eq!(robot.inverse().word(), "polished", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
#[ignore = "some minutes: 100 000 poses an arm"]
fn a_hundred_thousand_poses_of_every_arm() {
    for robot in [
        arms::mh12(),
        arms::kr120(),
        other::kr210_l150(),
        other::ur10(),
        other::ur10e(),
        other::on_rail(&arms::mh12()),
        other::calibrated(&arms::mh12(), 5e-4),
        other::calibrated(&other::ur10e(), 5e-4),
        other::free("made-up/puma-like", &other::PUMA_LIKE),
        other::free("made-up/skewed", &other::SKEWED),
        other::free("made-up/tilted-wrist", &other::TILTED_WRIST),
        other::free("made-up/spherical-shoulder", &other::SPHERICAL_SHOULDER),
        other::iiwa14(),
        other::oblique(),
    ] {
        let trips = round_trips(&robot, 100_000);
        assert!(trips.held as f64 > 0.999 * trips.poses as f64, "{trips:?}");
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
fn all_eight_branches_of_a_ur_have_names_and_hold_the_pose_by_its_dh_matrices() {
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
        // Poses near the end of the reach have four: seen from one shoulder or with one flip the hand is too far.
        assert!(eights > 1000, "{}: {eights} of 2000", robot.name());
    }
}

#[test]
fn words_of_a_ur_say_where_its_parts_are() {
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

#[test]
fn beyond_every_reach_there_is_a_reason_with_an_amount() {
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
    // Axis 4 of a UR stands 163.941 mm beside the plane of the arm: no wrist centre comes nearer to axis 1.
    let beside = flange_at_wrist_centre(&other::UR10, [0.05, 0.0, 0.6]);
    let miss = postures(&other::ur10(), &beside, at(&tool)).unwrap_err();
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
fn where_a_ur_leaves_joint_6_free_it_stays_as_it_was() {
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

#[test]
fn a_rail_stands_at_home_and_joints_to_spare_are_drawn_to_it() {
    let tool = arms::bent_tool();
    let railed = other::on_rail(&arms::mh12());
    let pose = Isometry::translation(0.0, 2.0, 0.0)
        * posture_at(&arms::mh12(), &[0.2, 0.1, -0.3, 0.4, 0.5, 0.6], &tool).base_from_tool;
    let stands = |home: Option<&[f64]>| -> f64 {
        postures(&railed, &pose, ToolAt { home, ..at(&tool) }).unwrap()[0].joints[0]
    };
    assert_eq!(stands(None), 2.0);
    assert_eq!(stands(Some(&[2.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])), 2.3);

    let iiwa = other::iiwa14();
    let q = [0.3, 0.6, -0.4, -1.2, 0.5, 0.9, -0.2];
    let pose = posture_at(&iiwa, &q, &tool).base_from_tool;
    // Home is a posture that holds the pose: nothing is nearer to it.
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
    // Without, the first is the nearest to the middle: a turn of the elbow either way is farther.
    let length = |p: &Posture| p.joints.iter().map(|q| q * q).sum::<f64>();
    let found = postures(&iiwa, &pose, at(&tool)).unwrap();
    assert!(found.iter().all(|p| length(p) >= length(&found[0])));
    assert!(length(&found[0]) < q.iter().map(|q| q * q).sum());
}

/// Asks `robot` along a wave of tool poses, half a millimetre to one apart.
fn along<T>(robot: &Robot, choice: BranchChoice, then: impl FnOnce(&Question<'_>, &[Isometry]) -> T) -> T {
    let tool = arms::bent_tool();
    // In the middle of the reach of each, away from singularities; 2 m is the middle of the rail.
    let q: &[f64] = match robot.name() {
        name if name.contains("rail") => &[2.0, 0.2, 0.3, -0.4, 0.5, 0.7, 0.3],
        name if name.contains("mh12") => &[0.2, 0.3, -0.4, 0.5, 0.7, 0.3],
        name if name.contains("ur10") => &[0.3, -1.2, 1.6, -0.5, 1.1, 0.4],
        name if name.contains("iiwa") => &[0.3, 0.6, -0.4, -1.2, 0.5, 0.9, -0.2],
        _ => &[0.3, 0.5, -0.4, 0.7, 1.1, 0.4],
    };
    let start = posture_at(robot, q, &tool).base_from_tool;
    let poses: Vec<Isometry> = (0..400)
        .map(|k| {
            Isometry::translation(0.0, 5e-4 * f64::from(k) - 0.1, 0.05 * (0.02 * f64::from(k)).sin()) * start
        })
        .collect();
    let cases = [
        Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
        Wrench::from_force(Vector3::new(-20.0, 4.0, 1.0)),
    ];
    let question = Question {
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        home: None,
        doubt: Doubt::NONE,
        cases: &cases,
        normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
        choice,
    };
    then(&question, &poses)
}

fn kinds() -> [Robot; 5] {
    [
        other::ur10(),
        other::calibrated(&arms::mh12(), 5e-4),
        other::on_rail(&arms::mh12()),
        other::oblique(),
        other::iiwa14(),
    ]
}

const NOMINAL: &str = "front elbow-up";

fn choices() -> [BranchChoice; 2] {
    [BranchChoice::Of(NOMINAL.parse().unwrap()), BranchChoice::Best]
}

#[test]
fn the_kernel_agrees_with_predict_for_every_kind_and_any_number_of_threads() {
    for robot in kinds() {
        for choice in choices() {
            along(&robot, choice, |question, poses| {
                let on = |threads: usize| -> Answers {
                    let pool = rayon::ThreadPoolBuilder::new()
                        .num_threads(threads)
                        .build()
                        .unwrap();
                    pool.install(|| evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap())
                };
                let (answers, again) = (on(1), on(3));
                assert_eq!(answers.points, again.points, "{}", robot.name());
                assert_eq!(answers.joints, again.joints);
                assert_eq!(answers.deviations, again.deviations);
                let mut checked = 0;
                for (i, held) in answers.held() {
                    let posture = posture_at(&robot, answers.joints_at(i), question.arm.flange_from_tool);
                    let away = posture.base_from_tool.translation.vector - poses[i].translation.vector;
                    assert!(away.norm() < 1e-9, "{}", robot.name());
                    if held.singularity.is_none() {
                        assert_eq!(posture.name, held.name);
                    }
                    for (case, wrench) in question.cases.iter().enumerate() {
                        let witness = predict(&posture, question.arm.compliance, wrench).twist.linear;
                        let away = answers.deviations_at(i)[case] - witness;
                        // The pose is held to 1e-9 m and rad: so are the screws, relative to a metre.
                        assert!(away.norm() < 1e-8 * witness.norm());
                    }
                    checked += 1;
                }
                assert!(checked > 300, "{}: {checked}", robot.name());
            });
        }
    }
}

#[test]
fn best_is_nowhere_worse_than_nominal() {
    for robot in kinds() {
        let [nominal, best] = choices().map(|choice| {
            along(&robot, choice, |question, poses| {
                evaluate(question, poses.len(), |i| poses[i], Watch::NONE).unwrap()
            })
        });
        let mut compared = 0;
        for (nominal, best) in nominal.points.iter().zip(&best.points) {
            let (Ok(nominal), Ok(best)) = (nominal, best) else {
                continue;
            };
            if nominal.within_limits() {
                assert!(
                    best.in_plane <= nominal.in_plane * (1.0 + 1e-6),
                    "{}",
                    robot.name()
                );
                compared += 1;
            }
        }
        assert!(compared > 100, "{}: {compared}", robot.name());
    }
}

#[test]
fn along_a_path_no_joint_jumps() {
    for robot in kinds() {
        along(&robot, choices()[0], |question, poses| {
            let answers = evaluate_in_order(question, poses.len(), |i| poses[i], Watch::NONE).unwrap();
            assert!(answers.held().count() == poses.len(), "{}", robot.name());
            for i in 1..poses.len() {
                let (a, b) = (answers.joints_at(i - 1), answers.joints_at(i));
                let step = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // 1.1 mm a step at most; away from singularities a joint turns by some 10 rad/m.
                assert!(step < 0.05, "{} at {i}: {step} rad\n{a:?}\n{b:?}", robot.name());
            }
        });
    }
}
