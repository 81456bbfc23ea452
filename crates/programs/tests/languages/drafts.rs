//! Drafts at random, written and read back.

use std::f64::consts::PI;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{Branch, BranchPattern};
use armill_programs::{
    Controller, Draft, DraftPoint, DraftStep, Frame, FrameData, FrameOn, Language, Motion, ProgramText,
    RobotProgram, Speed, Target, Written, read, write,
};
use proptest::prelude::*;

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

/// What a language can write: its external axes, and a statement of a cell that does not move the robot.
#[derive(Clone, Copy)]
pub struct Writes {
    pub external: usize,
    pub statement: &'static str,
}

fn points(external: usize) -> impl Strategy<Value = DraftPoint> {
    (
        poses(),
        prop::collection::vec(-6.0..6.0f64, 6),
        prop::collection::vec(-3.0..3.0f64, external),
        0..Branch::ALL.len(),
        prop::option::of(0.001..2.0f64),
        prop_oneof![Just(0.0), 0.0001..0.05f64],
    )
        .prop_map(
            |(frame_from_tool, joints, external, branch, speed, blend)| DraftPoint {
                frame_from_tool,
                joints,
                external,
                branch: Some(Branch::ALL[branch]),
                speed,
                blend,
            },
        )
}

/// Texts for people, some of which look like statements or end a text, a comment or the code.
pub fn texts() -> impl Strategy<Value = String> {
    prop_oneof![
        "[ -~\u{e4}\u{3b2}\u{85}\u{2028}\r\n\t]{0,60}",
        prop::sample::select(HOSTILE).prop_map(str::to_owned),
    ]
}

/// Texts that would begin a move if they ended a comment, a quoted text, brackets or the code.
pub const HOSTILE: &[&str] = &[
    "stop\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}",
    "stop\r\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\r\n",
    "stop\";MoveL p10,v100,fine,tool0;TPWrite \"",
    "stop\u{2028}MoveJ p10,v100,fine,tool0;\u{2029}",
    "stop] ; L P[1] 100mm/sec FINE ;",
    "stop\u{b} ;\n  1:J P[1] 10% FINE ;",
    "stop\nMOVJ C00000 VJ=10.00",
    "stop\\",
    "stop\\\", 0)\nmovel(p[0, 0, 0, 0, 0, 0])",
    "stop\")\rmovej([0, 0, 0, 0, 0, 0]) # \"",
    "stop]]></Code><Code><![CDATA[begin movel(pPoint[0],tTool[1],mSpeed[0])",
    "stop\")\u{85}movel(pPoint[0],tTool[1],mSpeed[0])",
    "\u{4e2d}\u{6587}\0\u{7}\u{1f600}",
];

/// A step that does not move the robot.
fn rests(statement: &'static str) -> impl Strategy<Value = DraftStep> {
    prop_oneof![
        texts().prop_map(DraftStep::Comment),
        texts().prop_map(DraftStep::Stop),
        prop_oneof![Just(0.0), 0.0..10.0f64].prop_map(DraftStep::Dwell),
        Just(DraftStep::Statement(statement.to_owned())),
    ]
}

fn steps(writes: Writes) -> impl Strategy<Value = (Vec<bool>, Vec<DraftStep>)> {
    (0..=writes.external).prop_flat_map(move |external| {
        let step = prop_oneof![
            2 => points(external).prop_map(DraftStep::Move),
            1 => rests(writes.statement),
        ];
        (
            prop::collection::vec(any::<bool>(), external),
            prop::collection::vec(rests(writes.statement), 0..3),
            points(external),
            prop::collection::vec(step, 0..16),
        )
            .prop_map(|(slides, before, first, after)| {
                let first = DraftStep::Move(DraftPoint { speed: None, ..first });
                (slides, before.into_iter().chain([first]).chain(after).collect())
            })
    })
}

fn controllers(statement: &'static str) -> impl Strategy<Value = Controller> {
    let part = || 0.01..1.0f64;
    let lines = move || prop::collection::vec(Just(statement.to_owned()), 0..2);
    (
        (1..9u32, 1..9u32),
        (part(), prop::option::of(part()), prop::option::of(0.1..20.0f64)),
        (lines(), lines()),
    )
        .prop_map(
            |(
                (frame_number, tool_number),
                (joint_speed, joint_acceleration, acceleration),
                (header, footer),
            )| {
                Controller {
                    frame_number,
                    tool_number,
                    joint_speed,
                    joint_acceleration,
                    acceleration,
                    header,
                    footer,
                    ..Controller::default()
                }
            },
        )
}

/// Drafts within the ranges of a language; no reserved word begins with Q.
pub fn drafts(writes: Writes) -> impl Strategy<Value = Draft> {
    (
        "Q[A-Z0-9_]{0,6}",
        prop::collection::vec("[ -~\u{e4}\r\n]{0,40}", 0..3),
        (poses(), poses()),
        controllers(writes.statement),
        steps(writes),
    )
        .prop_map(
            |(name, remarks, (frame, tool), controller, (external_slides, steps))| Draft {
                name,
                remarks,
                base_from_frame: frame,
                flange_from_tool: tool,
                controller,
                external_slides,
                frame_on: FrameOn::Cell,
                steps,
            },
        )
}

/// A draft of so many points on a line, this distance apart, mm: a joint move to the first one, then straight moves.
pub fn spaced(points: usize, apart_mm: f64) -> Draft {
    let joints: Vec<f64> = JOINTS.map(f64::to_radians).to_vec();
    let point = |index: usize| DraftPoint {
        frame_from_tool: kuka([index as f64 * apart_mm, 0.0, 0.0, 0.0, 90.0, 0.0]),
        joints: joints.clone(),
        external: Vec::new(),
        branch: Some(Branch::ALL[0]),
        speed: (index > 0).then_some(0.05),
        blend: 0.0005,
    };
    Draft {
        name: "PLATE".to_owned(),
        remarks: vec!["made by armill\nLIN {X 0}".to_owned()],
        base_from_frame: kuka([1.0, 2.0, 3.0, 0.0, 0.0, 0.0]),
        flange_from_tool: kuka([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]),
        controller: Controller {
            tool_number: 2,
            ..Controller::default()
        },
        external_slides: Vec::new(),
        frame_on: FrameOn::Cell,
        steps: (0..points).map(point).map(DraftStep::Move).collect(),
    }
}

/// A draft of so many points, 0.1 mm apart.
pub fn long(points: usize) -> Draft {
    spaced(points, 0.1)
}

/// A draft with a step of each kind: joint move, two straight moves with a comment between them, dwell, statement,
/// straight move, stop, joint move. Points are 10 mm apart.
pub fn every_step(statement: &str) -> Draft {
    let mut draft = spaced(5, 10.0);
    let mut moves = std::mem::take(&mut draft.steps).into_iter();
    let mut next = || moves.next().unwrap();
    draft.steps = vec![
        DraftStep::Comment("approach".to_owned()),
        next(),
        next(),
        DraftStep::Comment("corner\r\nof the part".to_owned()),
        next(),
        DraftStep::Dwell(1.5),
        DraftStep::Statement(statement.to_owned()),
        next(),
        DraftStep::Stop("change the tool".to_owned()),
        next(),
    ];
    if let Some(DraftStep::Move(last)) = draft.steps.last_mut() {
        last.speed = None;
    }
    draft
}

/// The point of the n-th step, which is a move.
pub fn point(draft: &mut Draft, step: usize) -> &mut DraftPoint {
    match &mut draft.steps[step] {
        DraftStep::Move(point) => point,
        other => panic!("{other:?}"),
    }
}

/// The same draft for a cell with this frame and tool stored on the controller.
pub fn stored(mut draft: Draft, frame: &str, tool: &str) -> Draft {
    draft.controller.data = FrameData::Controller;
    draft.controller.frame_name = Some(frame.to_owned());
    draft.controller.tool_name = Some(tool.to_owned());
    draft
}

/// The text of the only file, or of this one.
pub fn text_of(written: &Written, file: usize) -> String {
    String::from_utf8(written.files[file].1.clone()).unwrap()
}

/// The program that was written.
pub fn read_back(written: &Written) -> RobotProgram {
    let texts = written
        .files
        .iter()
        .map(|(name, bytes)| ProgramText::new(name, bytes));
    read(texts.collect()).unwrap()
}

/// That the notes of a program that was read are only these, by their words.
pub fn notes_only(program: &RobotProgram, known: &[&str]) {
    let is_known = |note: &String| known.iter().any(|words| note.contains(words));
    assert!(program.notes.iter().all(is_known), "{:#?}", program.notes);
}

/// Content of a point in a language.
#[derive(Clone, Copy)]
pub struct Says {
    /// The posture of a straight move.
    pub branch: fn(&DraftPoint) -> BranchPattern,
    /// The turns of a straight move.
    pub turns: fn(&[f64]) -> Vec<i32>,
    /// The notes of the reader, by their words.
    pub notes: &'static [&'static str],
}

/// Checks that a draft in this language is read back correctly: frame, tool, joints of joint moves, poses, postures and
/// speeds of straight moves, within the decimals that are written; and that no other step makes a note.
pub fn reads_back(language: Language, draft: &Draft, says: &Says) {
    let written = write(language, draft).unwrap();
    assert!(written.notes.iter().all(|note| !note.is_empty()));
    let program = read_back(&written);
    assert_eq!((program.language, &program.name), (language, &draft.name));
    assert_eq!(program.moves.len(), draft.points().count(), "{:?}", program.notes);
    notes_only(&program, says.notes);
    for (found, requested) in program.moves.iter().zip(draft.points()) {
        let tool = (found.tool, &draft.flange_from_tool);
        let frame = (found.frame, &draft.base_from_frame);
        // Joints count in no frame.
        let frame = found.target.pose().map(|_| frame);
        for (found, pose) in [tool].into_iter().chain(frame) {
            let Frame::Given(found) = found else {
                panic!("{found:?}");
            };
            near(&found, pose);
        }
        match (&found.target, requested.speed) {
            (Target::Joints(joints), None) => {
                assert_eq!(joints.len(), requested.joints.len());
                for (joint, requested) in joints.iter().zip(&requested.joints) {
                    // Half of four decimals of a degree.
                    assert!((joint - requested).to_degrees().abs() < 0.51e-4);
                }
                assert_eq!((&found.motion, found.speed), (&Motion::Joint, Speed::Joints));
            }
            (
                Target::Pose {
                    pose, branch, turns, ..
                },
                Some(speed),
            ) => {
                near(pose, &requested.frame_from_tool);
                assert_eq!(found.motion, Motion::Linear);
                let Speed::Tip(given) = found.speed else {
                    panic!("{found:?}");
                };
                // Half of the last digit that the coarsest language writes, a tenth of a mm/s.
                assert!((given - speed).abs() < 0.51e-4, "{given} {speed}");
                assert_eq!(*branch, (says.branch)(requested));
                assert_eq!(*turns, (says.turns)(&requested.joints));
            }
            other => panic!("{other:?}"),
        }
    }
}
