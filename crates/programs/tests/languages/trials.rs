//! Programs whose poses are moved, files that are cut, and the tolerances of what is read back.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_programs::{DraftPoint, Motion, ProgramText, RobotMove, RobotProgram, Speed, Target, read};
use proptest::prelude::*;

use crate::program;
use crate::rewriting::{again, all_moved, rest};

/// Distance and angle between two poses: m and rad.
pub fn apart(one: &Isometry, other: &Isometry) -> [f64; 2] {
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
pub const MICROMETRE: f64 = 0.5e-6 * 1.733;

/// Rounding to this number of decimals of a degree in each of three angles, rad, plus rounding of sines.
pub fn angle_of_decimals(decimals: i32) -> f64 {
    (1.5 * 10_f64.powi(-decimals)).to_radians() + 1e-12
}

/// The program with every pose target multiplied by `by` from the right, read again. Only the targets have changed, and
/// they are at the new poses within `[m, rad]`.
pub fn moved_alone(program: &RobotProgram, by: &Isometry, within: [f64; 2]) -> RobotProgram {
    let files = program.with_poses(&all_moved(program, |pose| pose * by)).unwrap();
    let again = again(&files);
    assert_eq!(rest(program), rest(&again));
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

/// Checks that the move to this point of a draft has the motion of the point and its tip speed within this tolerance, m/s.
pub fn moves_as_drafted(found: &RobotMove, point: &DraftPoint, within: f64) {
    match (point.speed, found.speed) {
        (Some(given), Speed::Tip(speed)) => {
            assert_eq!(found.motion, Motion::Linear);
            assert!((given - speed).abs() <= within, "{given} {speed}");
        }
        (given, speed) => {
            assert_eq!(given, None);
            assert_eq!((speed, &found.motion), (Speed::Joints, &Motion::Joint));
        }
    }
}

/// The messages of all problems in these files.
pub fn problems(files: &[(&str, &str)]) -> Vec<String> {
    let problems = program(files).expect_err("something is wrong");
    problems.as_slice().iter().map(ToString::to_string).collect()
}

/// Cut position in a text, length of the cut, and inserted text.
pub type Cuts = Vec<(prop::sample::Index, usize, String)>;

/// Cuts in files, with characters that are significant in these languages.
pub fn cuts() -> impl Strategy<Value = Cuts> {
    let letters = "[\\[\\]{}()<>=.,:;\"'*/#\\-+0-9A-Zxyz \n\t\u{e4}\u{1f600}]{0,5}";
    prop::collection::vec((any::<prop::sample::Index>(), 0_usize..12, letters), 1..6)
}

/// Checks that no reader panics on cut files. Files that can still be read are read back unchanged.
pub fn survives(files: &[(&str, &str)], cuts: &Cuts) {
    let mut files: Vec<(&str, String)> = files
        .iter()
        .map(|(name, text)| (*name, (*text).to_owned()))
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
