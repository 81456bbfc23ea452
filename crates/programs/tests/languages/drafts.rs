//! Drafts at random, written and read back.

use std::f64::consts::PI;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{Branch, BranchPattern};
use armill_programs::{
    Draft, DraftPoint, Frame, Language, Motion, ProgramText, RobotProgram, Speed, Target, Written, read,
    write,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::rewriting::near;
use crate::same_poses::{JOINTS, kuka};

fn poses() -> impl Strategy<Value = Isometry> {
    // The middle angle is sometimes a right angle, where the others are degenerate.
    let angle = prop_oneof![
        -PI..PI,
        Just(0.0),
        Just(PI / 2.0),
        Just(-PI / 2.0),
        Just(PI),
        (-1e-7..1e-7f64).prop_map(|by| by + PI / 2.0)
    ];
    let place = prop::array::uniform3(-3.0..3.0f64);
    (place, prop::array::uniform3(angle))
        .prop_map(|(place, angles)| from_xyz_and_fixed_angles(Vector3::from(place), Vector3::from(angles)))
}

fn points() -> impl Strategy<Value = DraftPoint> {
    (
        poses(),
        prop::collection::vec(-6.0..6.0f64, 6),
        0..Branch::ALL.len(),
        prop::option::of(0.001..2.0f64),
        prop_oneof![Just(0.0), 0.0001..0.05f64],
    )
        .prop_map(|(frame_from_tool, joints, branch, speed, blend)| DraftPoint {
            frame_from_tool,
            joints,
            branch: Some(Branch::ALL[branch]),
            speed,
            blend,
        })
}

/// Drafts within the ranges of all languages; no reserved word begins with Q.
pub fn drafts() -> impl Strategy<Value = Draft> {
    (
        "Q[A-Z0-9_]{0,6}",
        prop::collection::vec("[ -~\u{e4}\r\n]{0,40}", 0..3),
        (poses(), 1..9u32),
        (poses(), 1..9u32),
        prop::collection::vec(points(), 1..12),
    )
        .prop_map(|(name, remarks, frame, tool, points)| Draft {
            name,
            remarks,
            base_from_frame: frame.0,
            frame_number: frame.1,
            flange_from_tool: tool.0,
            tool_number: tool.1,
            points,
        })
}

/// A draft of so many points on a line.
pub fn long(points: usize) -> Draft {
    let joints: Vec<f64> = JOINTS.map(f64::to_radians).to_vec();
    let point = |index: usize| DraftPoint {
        frame_from_tool: kuka([index as f64 * 0.1, 0.0, 0.0, 0.0, 90.0, 0.0]),
        joints: joints.clone(),
        branch: Some(Branch::ALL[0]),
        speed: Some(0.05),
        blend: 0.0005,
    };
    Draft {
        name: "PLATE".to_owned(),
        remarks: vec!["made by armill\nLIN {X 0}".to_owned()],
        base_from_frame: kuka([1.0, 2.0, 3.0, 0.0, 0.0, 0.0]),
        frame_number: 1,
        flange_from_tool: kuka([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]),
        tool_number: 2,
        points: (0..points).map(point).collect(),
    }
}

/// A draft called `part` with one point, to which the tip moves at 0.1 m/s.
pub fn one_draft() -> Draft {
    let mut draft = drafts()
        .new_tree(&mut TestRunner::deterministic())
        .unwrap()
        .current();
    draft.name = "part".to_owned();
    draft.points.truncate(1);
    draft.points[0].speed = Some(0.1);
    draft
}

/// The program that was written.
pub fn read_back(written: &Written) -> RobotProgram {
    let texts = written
        .files
        .iter()
        .map(|(name, bytes)| ProgramText::new(name, bytes));
    read(texts.collect()).unwrap()
}

/// Content of a point in a language.
#[derive(Clone, Copy)]
pub struct Says {
    /// Whether frame and tool are only numbers: in some languages they cannot be set.
    pub frames: fn(u32) -> Option<Frame>,
    /// The postures of joint moves to poses.
    pub branches: bool,
    /// The tip speed of joint moves, if it is given.
    pub joint_speed: Speed,
    /// The turns of these joints, rad.
    pub turns: fn(&[f64]) -> Vec<i32>,
}

/// Checks that a draft in this language is read back correctly: frame, tool, joints of the first point, poses, postures
/// of joint moves, speeds, within the decimals that are written.
pub fn reads_back(language: Language, draft: &Draft, says: &Says) {
    let written = write(language, draft).unwrap();
    assert!(written.notes.iter().all(|note| !note.is_empty()));
    let program = read_back(&written);
    assert_eq!((program.language, &program.name), (language, &draft.name));
    assert_eq!(program.moves.len(), draft.points.len(), "{:?}", program.notes);
    for (index, (found, requested)) in program.moves.iter().zip(&draft.points).enumerate() {
        let tool = (found.tool, &draft.flange_from_tool, draft.tool_number);
        let frame = (found.frame, &draft.base_from_frame, draft.frame_number);
        // Joints count in no frame.
        let frame = found.target.pose().map(|_| frame);
        for (found, pose, number) in [tool].into_iter().chain(frame) {
            match (found, (says.frames)(number)) {
                (found, Some(expected)) => assert_eq!(found, expected),
                (Frame::Given(found), None) => near(&found, pose),
                (found, None) => panic!("{found:?}"),
            }
        }
        match (&found.target, requested.speed) {
            (Target::Joints(joints), _) if index == 0 => {
                for (joint, requested) in joints.iter().zip(&requested.joints) {
                    // Half of four decimals of a degree.
                    assert!((joint - requested).to_degrees().abs() < 0.51e-4);
                }
                assert_eq!(found.motion, Motion::Joint);
            }
            (Target::Pose { pose, .. }, Some(speed)) if index > 0 => {
                near(pose, &requested.frame_from_tool);
                assert_eq!(found.motion, Motion::Linear);
                let Speed::Tip(given) = found.speed else {
                    panic!("{found:?}");
                };
                // Half of the last digit that the coarsest language writes, a tenth of a mm/s.
                assert!((given - speed).abs() < 0.51e-4, "{given} {speed}");
            }
            (
                Target::Pose {
                    pose, branch, turns, ..
                },
                None,
            ) if index > 0 => {
                near(pose, &requested.frame_from_tool);
                assert_eq!(found.motion, Motion::Joint);
                assert_eq!(found.speed, says.joint_speed);
                if says.branches {
                    assert_eq!(*branch, requested.branch.map(BranchPattern::from).unwrap());
                }
                assert_eq!(*turns, (says.turns)(&requested.joints));
            }
            other => panic!("{other:?}"),
        }
    }
}
