//! The convention inspector names what was done to a library arm, from poses of the arm as it was.

// A panic is how a test says that its claim is false.
#![allow(clippy::unwrap_used, clippy::panic)]

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::convention::PoseDifference;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::{Joint, Robot};
use armill_core::watch::Watch;
use armill_formats::robot::RobotDescription;
use armill_study::library;
use armill_study::pendant::{PendantAnswer, PendantQuestion, check};

/// Poses with every joint away from zero and from quarter turns, deg.
const POSES_DEG: [[f64; 6]; 3] = [
    [10.0, -35.0, 25.0, 40.0, -55.0, 65.0],
    [-20.0, -60.0, 50.0, -30.0, 35.0, -115.0],
    [35.0, -15.0, -40.0, 70.0, 50.0, 20.0],
];

fn arm(name: &str) -> RobotDescription {
    library::robot(name).unwrap().unwrap()
}

/// This arm with other joints, as a slip in its file would leave it.
fn with_joints(arm: &RobotDescription, change: impl Fn(&mut Vec<Joint>)) -> RobotDescription {
    let mut joints = arm.robot.joints().to_vec();
    change(&mut joints);
    let robot = Robot::new(arm.robot.name(), arm.robot.chain().motions().to_vec(), joints).unwrap();
    RobotDescription {
        robot: robot.with_frames(arm.robot.frames().to_vec()),
        ..arm.clone()
    }
}

fn flip(joint: &mut Joint) {
    joint.sign = match joint.sign {
        Sign::Positive => Sign::Negative,
        Sign::Negative => Sign::Positive,
    };
}

/// Poses of `real` as its pendant shows them, counted from a base this high, tool 0.
fn read(real: &Robot, poses_deg: &[[f64; 6]], base_height: f64) -> Vec<(Vec<f64>, Isometry)> {
    let base_from_reference = Isometry::translation(0.0, 0.0, base_height);
    let one = |deg: &[f64; 6]| {
        let q = deg.map(f64::to_radians);
        let pose = posture_at(real, &q, &Isometry::identity()).base_from_tool;
        // A pendant rounds to 0.01 mm.
        let mut shown = base_from_reference.inverse() * pose;
        shown.translation.vector.apply(|m| *m = (*m * 1e5).round() / 1e5);
        (deg.to_vec(), shown)
    };
    poses_deg.iter().map(one).collect()
}

fn requested(file: &RobotDescription, readings: Vec<(Vec<f64>, Isometry)>) -> PendantAnswer {
    let question = PendantQuestion {
        readings,
        flange_from_tool: Isometry::identity(),
        base: "base_link".to_owned(),
        within: PoseDifference {
            metres: 1e-3,
            radians: 0.1_f64.to_radians(),
        },
    };
    check(file, &question, Watch::NONE).unwrap()
}

fn assert_explained(answer: &PendantAnswer, changes: &[&str]) {
    assert_eq!(answer.verdict, "explained", "{answer:?}");
    assert_eq!(answer.explanations[0].changes, changes);
    assert!(answer.unseen.is_empty(), "{:?}", answer.unseen);
}

#[test]
fn a_correct_file_agrees_and_no_change_is_undetected() {
    for name in [
        "yaskawa/mh12",
        "kuka/kr120r2500pro",
        "staubli/tx2-90",
        "abb/irb6640-185-280",
    ] {
        let arm = arm(name);
        let answer = requested(&arm, read(&arm.robot, &POSES_DEG, 0.0));
        assert_eq!(answer.verdict, "agrees", "{name}");
        assert!(answer.unseen.is_empty(), "{name}: {:?}", answer.unseen);
        assert!(answer.readings.iter().all(|reading| reading.apart_mm < 0.02));
    }
}

#[test]
fn the_joint_with_an_inverted_sign_is_named() {
    let real = arm("kuka/kr16-2");
    for joint in 0..6 {
        let file = with_joints(&real, |joints| flip(&mut joints[joint]));
        let sign = real.robot.joints()[joint].sign.factor();
        let answer = requested(&file, read(&real.robot, &POSES_DEG, 0.0));
        let expected = format!(
            "joint A{} has the opposite sign: sign = {sign} in place of {}",
            joint + 1,
            -sign
        );
        assert_explained(&answer, &[&expected]);
    }
}

#[test]
fn a_zero_off_by_a_quarter_turn_is_named_with_the_value_of_the_file() {
    let real = arm("kuka/kr120r2500pro");
    let file = with_joints(&real, |joints| joints[1].zero_offset += 90_f64.to_radians());
    let answer = requested(&file, read(&real.robot, &POSES_DEG, 0.0));
    assert_explained(
        &answer,
        &["joint A2 has another zero: zero_offset_deg = 0 in place of 90"],
    );
}

#[test]
fn a_zero_off_by_any_angle_is_found() {
    let real = arm("yaskawa/gp25");
    let file = with_joints(&real, |joints| joints[2].zero_offset -= 12.34_f64.to_radians());
    let answer = requested(&file, read(&real.robot, &POSES_DEG, 0.0));
    assert_eq!(answer.verdict, "explained", "{answer:?}");
    let words = &answer.explanations[0].changes[0];
    assert!(
        words.starts_with("joint U has another zero: zero_offset_deg = ")
            && words.ends_with("in place of -12.34"),
        "{words}"
    );
}

#[test]
fn the_coupling_of_a_fanuc_pendant_is_named_either_way() {
    let coupled = |joints: &mut Vec<Joint>| {
        joints[2].coupling = vec![Coupling {
            joint: 1,
            factor: 1.0,
        }];
    };
    let file = arm("fanuc/m20ia");
    let pendant = with_joints(&file, coupled);
    let answer = requested(&file, read(&pendant.robot, &POSES_DEG, 0.0));
    assert_explained(
        &answer,
        &["joint J3 is coupled to J2: coupling = [{ joint = \"J2\", factor = 1 }]"],
    );
    let answer = requested(&pendant, read(&file.robot, &POSES_DEG, 0.0));
    assert_explained(&answer, &["joint J3 is not coupled to J2: remove its coupling"]);
}

#[test]
fn a_pendant_that_counts_from_its_controller_frame_is_named() {
    let arm = arm("yaskawa/mh12");
    let answer = requested(&arm, read(&arm.robot, &POSES_DEG, 0.45));
    assert_explained(
        &answer,
        &["the base of the pendant is 450.00 mm above base_link, its frame `controller`"],
    );
}

#[test]
fn a_sign_a_coupling_and_a_base_together_are_reported_apart() {
    let real = arm("fanuc/m710ic-50");
    let file = with_joints(&real, |joints| {
        flip(&mut joints[3]);
        joints[2].coupling = vec![Coupling {
            joint: 1,
            factor: 1.0,
        }];
    });
    let answer = requested(&file, read(&real.robot, &POSES_DEG, 0.565));
    assert_explained(
        &answer,
        &[
            "joint J4 has the opposite sign: sign = -1 in place of 1",
            "joint J3 is not coupled to J2: remove its coupling",
            "the base of the pendant is 565.00 mm above base_link, its frame `controller`",
        ],
    );
}

#[test]
fn a_flange_frame_left_parallel_to_the_last_link_is_named() {
    let real = arm("abb/irb2400");
    let flange_from_other =
        from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(0.0, -90_f64.to_radians(), 0.0));
    let readings = read(&real.robot, &POSES_DEG, 0.0)
        .into_iter()
        .map(|(joints, pose)| (joints, pose * flange_from_other))
        .collect();
    let answer = requested(&real, readings);
    assert_explained(
        &answer,
        &[
            "the flange frame of the pendant is rotated relative to that of the file: end the chain with about z 0, about y -90, about x 0 deg",
        ],
    );
}

#[test]
fn positions_in_inches_are_named() {
    let arm = arm("staubli/rx160");
    let readings = read(&arm.robot, &POSES_DEG, 0.0)
        .into_iter()
        .map(|(joints, mut pose)| {
            pose.translation.vector /= 25.4;
            (joints, pose)
        })
        .collect();
    assert_explained(
        &requested(&arm, readings),
        &["positions were read in inches, not in mm"],
    );
}

#[test]
fn joints_at_zero_determine_no_sign() {
    let arm = arm("yaskawa/mh12");
    let answer = requested(&arm, read(&arm.robot, &[[0.0; 6]], 0.0));
    assert_eq!(answer.verdict, "agrees");
    for joint in ["S", "L", "U", "R", "B", "T"] {
        let sign = format!("joint {joint} has the opposite sign");
        assert!(
            answer.unseen.iter().any(|words| words.starts_with(&sign)),
            "{:?}",
            answer.unseen
        );
    }
    assert!(answer.unseen.iter().any(|words| words.contains("coupled to L")));
}

#[test]
fn readings_that_two_changes_explain_are_undecided() {
    // With J2 at 90 deg throughout, counting it into J3 looks like a zero of J3 off by 90 deg.
    let file = arm("fanuc/m20ib-25");
    let pendant = with_joints(&file, |joints| {
        joints[2].coupling = vec![Coupling {
            joint: 1,
            factor: 1.0,
        }];
    });
    let poses = [
        [10.0, 90.0, 25.0, 40.0, -55.0, 65.0],
        [-20.0, 90.0, 50.0, -30.0, 35.0, -115.0],
    ];
    let answer = requested(&file, read(&pendant.robot, &poses, 0.0));
    assert_eq!(answer.verdict, "undecided", "{answer:?}");
    let all: Vec<&String> = answer.explanations.iter().flat_map(|e| &e.changes).collect();
    assert!(all.iter().any(|words| words.contains("coupling")), "{all:?}");
    assert!(
        all.iter()
            .any(|words| words.contains("joint J3 has another zero")),
        "{all:?}"
    );
}

#[test]
fn a_wrong_link_length_is_not_explained() {
    let real = arm("kuka/kr150-2");
    let answer = requested(&arm("kuka/kr150r3100-2"), read(&real.robot, &POSES_DEG, 0.0));
    assert_eq!(answer.verdict, "unexplained", "{answer:?}");
}

#[test]
fn a_reading_of_other_joints_and_an_unknown_frame_are_refused() {
    let arm = arm("yaskawa/mh12");
    let question = |joints: usize, base: &str| PendantQuestion {
        readings: vec![(vec![0.0; joints], Isometry::identity())],
        flange_from_tool: Isometry::identity(),
        base: base.to_owned(),
        within: PoseDifference {
            metres: 1e-3,
            radians: 1e-3,
        },
    };
    let error = check(&arm, &question(7, "base_link"), Watch::NONE)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("reading 1: 7 joint positions for the 6 joints"),
        "{error}"
    );
    let error = check(&arm, &question(6, "table"), Watch::NONE)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("`table`") && error.contains("controller"),
        "{error}"
    );
}
