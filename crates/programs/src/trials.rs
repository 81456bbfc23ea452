//! Shared by the tests of all languages: random drafts, and properties of rewritten programs.

use std::f64::consts::PI;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Branch;
use proptest::prelude::*;

use super::*;

/// A pose within a few metres with any orientation. The middle angle is sometimes a right angle, where the others are
/// degenerate.
pub(super) fn poses() -> impl Strategy<Value = Isometry> {
    let angle = prop_oneof![
        -PI..PI,
        Just(0.0),
        Just(PI / 2.0),
        Just(-PI / 2.0),
        Just(PI),
        (-1e-7..1e-7).prop_map(|by| by + PI / 2.0)
    ];
    let place = prop::array::uniform3(-3.0..3.0);
    (place, prop::array::uniform3(angle))
        .prop_map(|(place, angles)| from_xyz_and_fixed_angles(Vector3::from(place), Vector3::from(angles)))
}

fn points() -> impl Strategy<Value = DraftPoint> {
    let joints = prop::collection::vec(-6.2..6.2, 6);
    let speed = prop::option::weighted(0.8, 0.001..1.0);
    let blend = prop_oneof![Just(0.0), 0.001..0.02];
    (poses(), joints, 0_usize..8, speed, blend).prop_map(|(pose, joints, branch, speed, blend)| DraftPoint {
        frame_from_tool: pose,
        joints,
        branch: Some(Branch::ALL[branch]),
        speed,
        blend,
    })
}

/// Drafts that every language can write.
pub(super) fn drafts() -> impl Strategy<Value = Draft> {
    let points = prop::collection::vec(points(), 1..8);
    let remarks = prop::collection::vec("[ -~]{0,60}", 0..3);
    (
        "[a-z][a-z0-9_]{0,7}",
        remarks,
        poses(),
        poses(),
        1_u32..=9,
        1_u32..=9,
        points,
    )
        .prop_map(
            |(name, remarks, base_from_frame, flange_from_tool, frame_number, tool_number, points)| Draft {
                name,
                remarks,
                base_from_frame,
                frame_number,
                flange_from_tool,
                tool_number,
                points,
            },
        )
}

/// Distance and angle between two poses: m and rad.
pub(super) fn apart(one: &Isometry, other: &Isometry) -> [f64; 2] {
    let turn = one.rotation.to_rotation_matrix().inverse() * other.rotation.to_rotation_matrix();
    let sine = Vector3::new(
        turn[(2, 1)] - turn[(1, 2)],
        turn[(0, 2)] - turn[(2, 0)],
        turn[(1, 0)] - turn[(0, 1)],
    )
    .norm()
        / 2.0;
    let cosine = (turn[(0, 0)] + turn[(1, 1)] + turn[(2, 2)] - 1.0) / 2.0;
    [
        (one.translation.vector - other.translation.vector).norm(),
        sine.atan2(cosine),
    ]
}

/// Rounding to 0.001 mm along each axis, m.
pub(super) const MICROMETRE: f64 = 0.5e-6 * 1.733;

/// Rounding to this number of decimals of a degree in each of three angles, rad, plus rounding of sines.
pub(super) fn angle_of_decimals(decimals: i32) -> f64 {
    (1.5 * 10_f64.powi(-decimals)).to_radians() + 1e-12
}

/// The text around the targets.
fn around(program: &RobotProgram) -> Vec<String> {
    let mut spelled: Vec<&Spelled> = program
        .moves
        .iter()
        .flat_map(|one| {
            let via = match &one.motion {
                Motion::Circular { via } => Some(via),
                _ => None,
            };
            via.into_iter().chain([&one.target])
        })
        .filter_map(|target| match target {
            Target::Pose { spelled, .. } => Some(spelled),
            _ => None,
        })
        .collect();
    spelled.sort_by_key(|spelled| (spelled.text, spelled.bytes.start));
    spelled.dedup();
    let texts = program.texts.iter().enumerate();
    texts
        .map(|(index, file)| {
            let mut rest = String::new();
            let mut done = 0;
            for place in spelled.iter().filter(|spelled| spelled.text == index) {
                rest.push_str(&file.text()[done..place.bytes.start]);
                rest.push('|');
                done = place.bytes.end;
            }
            rest.push_str(&file.text()[done..]);
            rest
        })
        .collect()
}

/// The program with every pose target multiplied by `by` from the right, read again. Only the targets have changed, and
/// they are at the new poses within `[m, rad]`.
pub(super) fn moved_alone(program: &RobotProgram, by: &Isometry, within: [f64; 2]) -> RobotProgram {
    let moved: Vec<Moved> = program
        .moves
        .iter()
        .enumerate()
        .filter_map(|(index, one)| {
            let via = match &one.motion {
                Motion::Circular { via } => via.pose().map(|pose| pose * by),
                _ => None,
            };
            Some(Moved {
                index,
                target: one.target.pose()? * by,
                via,
            })
        })
        .collect();
    let files = program.with_poses(&moved).unwrap();
    let texts = files
        .iter()
        .map(|(name, bytes)| ProgramText::new(name, bytes))
        .collect();
    let again = read(texts).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(around(program), around(&again));
    assert_eq!(program.moves.len(), again.moves.len());
    for (one, other) in program.moves.iter().zip(&again.moves) {
        let same = |one: &Target, other: &Target| match (one.pose(), other.pose()) {
            (Some(pose), Some(other)) => {
                let [far, turned] = apart(&(pose * by), other);
                assert!(
                    far <= within[0] && turned <= within[1],
                    "{far:e} m, {turned:e} rad apart"
                );
            }
            _ => assert_eq!(one, other),
        };
        same(&one.target, &other.target);
        if let (Motion::Circular { via }, Motion::Circular { via: other }) = (&one.motion, &other.motion) {
            same(via, other);
        }
        assert_eq!(
            (one.frame, one.tool, one.speed),
            (other.frame, other.tool, other.speed)
        );
        assert_eq!(one.line, other.line);
    }
    again
}

/// The messages of all problems in these files.
pub(super) fn problems(files: &[(&str, &str)]) -> Vec<String> {
    let texts = files
        .iter()
        .map(|(name, text)| ProgramText::new(name, text.as_bytes()))
        .collect();
    let problems = read(texts).expect_err("something is wrong");
    problems.as_slice().iter().map(ToString::to_string).collect()
}

/// Cut position in a text, length of the cut, and inserted text.
pub(super) type Cuts = Vec<(prop::sample::Index, usize, String)>;

/// Cuts in files, with characters that are significant in these languages.
pub(super) fn cuts() -> impl Strategy<Value = Cuts> {
    let letters = "[\\[\\]{}()<>=.,:;\"'*/#\\-+0-9A-Zxyz \n\t\u{e4}\u{1f600}]{0,5}";
    prop::collection::vec((any::<prop::sample::Index>(), 0_usize..12, letters), 1..6)
}

/// Checks that no reader panics on cut files. Files that can still be read are read back unchanged.
pub(super) fn survives(files: &[(&str, &str)], cuts: &Cuts) {
    let mut files: Vec<(String, String)> = files
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
        .collect();
    for (place, length, letters) in cuts {
        let whole: usize = files.iter().map(|(_, text)| text.len() + 1).sum();
        let mut at = place.index(whole);
        for (_, text) in &mut files {
            if at <= text.len() {
                let start = text.floor_char_boundary(at);
                let end = text.ceil_char_boundary((start + length).min(text.len()));
                text.replace_range(start..end, letters);
                break;
            }
            at -= text.len() + 1;
        }
    }
    let texts = files
        .iter()
        .map(|(name, text)| ProgramText::new(name, text.as_bytes()))
        .collect();
    if let Ok(program) = read(texts) {
        // Numbers of any size may occur: up to 1e9 mm, where a double resolves 1e-4 mm, and as many degrees.
        moved_alone(&program, &Isometry::identity(), [1e-5, 1e-5]);
    }
}
