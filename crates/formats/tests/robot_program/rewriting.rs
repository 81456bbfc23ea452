//! Programs written again: the same poses change number formats alone, other poses only the bytes that spell them.

use armill_core::frame::Isometry;
use armill_formats::robot_program::{Motion, Moved, ProgramText, RobotProgram, Spelled, Target, read};

/// Every pose of the program, moved by this.
pub fn all_moved(program: &RobotProgram, by: impl Fn(&Isometry) -> Isometry) -> Vec<Moved> {
    let all = program.moves.iter().enumerate();
    all.filter_map(|(index, of)| {
        let via = match &of.motion {
            Motion::Circular { via } => via.pose().map(&by),
            Motion::Joint | Motion::Linear => None,
        };
        Some(Moved {
            index,
            target: by(of.target.pose()?),
            via,
        })
    })
    .collect()
}

/// The program of these files as they come from a rewriting.
pub fn again(files: &[(String, Vec<u8>)]) -> RobotProgram {
    let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
    read(texts.collect()).unwrap()
}

/// Every place where a target is spelled.
fn places(program: &RobotProgram) -> Vec<Spelled> {
    let targets = program.moves.iter().flat_map(|of| {
        let via = match &of.motion {
            Motion::Circular { via } => Some(via),
            Motion::Joint | Motion::Linear => None,
        };
        via.into_iter().chain([&of.target])
    });
    let mut places: Vec<Spelled> = targets
        .filter_map(|target| match target {
            Target::Pose { spelled, .. } => Some(spelled.clone()),
            Target::Joints(_) => None,
        })
        .collect();
    places.sort_by_key(|place| (place.text, place.bytes.start));
    places.dedup();
    places
}

/// The bytes of every file that spell no target.
fn rest(program: &RobotProgram) -> Vec<Vec<u8>> {
    let places = places(program);
    let all = program.texts.iter().enumerate();
    all.map(|(index, file)| {
        let (mut rest, mut done) = (String::new(), 0);
        for place in places.iter().filter(|place| place.text == index) {
            rest.push_str(&file.text()[done..place.bytes.start]);
            rest.push('@');
            done = place.bytes.end;
        }
        rest.push_str(&file.text()[done..]);
        file.encoded(&rest)
    })
    .collect()
}

/// As [`rewritten`], and that all that spells no target is as it was, byte for byte. Gives the files.
pub fn keeps_the_rest(program: &RobotProgram, by: impl Fn(&Isometry) -> Isometry) -> Vec<(String, Vec<u8>)> {
    let (files, found) = rewritten(program, by);
    assert_eq!(rest(program), rest(&found));
    files
}

/// That the program, written with its poses moved by `by`, reads to those poses, with all that it said beside them.
/// Gives the files, and what they read to.
pub fn rewritten(
    program: &RobotProgram,
    by: impl Fn(&Isometry) -> Isometry,
) -> (Vec<(String, Vec<u8>)>, RobotProgram) {
    let moved = all_moved(program, by);
    let files = program.with_poses(&moved).unwrap();
    let found = again(&files);
    assert_eq!(program.moves.len(), found.moves.len());
    for asked in &moved {
        let of = &found.moves[asked.index];
        near(of.target.pose().unwrap(), &asked.target);
        if let (Motion::Circular { via }, Some(asked)) = (&of.motion, &asked.via) {
            near(via.pose().unwrap(), asked);
        }
        assert_eq!(said(&program.moves[asked.index].target), said(&of.target));
        assert_eq!(program.moves[asked.index].speed, of.speed);
    }
    (files, found)
}

fn said(target: &Target) -> String {
    match target {
        Target::Pose { branch, turns, .. } => format!("{branch} {turns:?}"),
        Target::Joints(joints) => format!("{joints:?}"),
    }
}

/// Within half the third decimal of a mm in each direction, and of a degree, three times.
pub fn near(found: &Isometry, wanted: &Isometry) {
    let apart = (found.translation.vector - wanted.translation.vector).amax();
    let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
    let turned = (matrix(found) - matrix(wanted)).amax();
    assert!(
        apart < 0.51e-6 && turned < 3.0 * 0.51e-3_f64.to_radians(),
        "{apart} {turned}: {found} {wanted}"
    );
}
