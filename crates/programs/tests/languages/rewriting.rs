//! Programs written again: the same poses change number formats alone, other poses only the bytes that spell them.

use armill_core::frame::Isometry;
use armill_programs::{Motion, Moved, ProgramText, RobotProgram, Spelled, Target, read};

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
            _ => None,
        })
        .collect();
    places.sort_by_key(|place| (place.text, place.bytes.start));
    places.dedup();
    places
}

/// The bytes of every file that spell no target.
pub fn rest(program: &RobotProgram) -> Vec<Vec<u8>> {
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

/// Checks that the program, written with its poses multiplied by `by`, is read back with these poses and otherwise unchanged.
/// Gives the files, and what they read to.
pub fn rewritten(
    program: &RobotProgram,
    by: impl Fn(&Isometry) -> Isometry,
) -> (Vec<(String, Vec<u8>)>, RobotProgram) {
    let moved = all_moved(program, by);
    let files = program.with_poses(&moved).unwrap();
    program.check_rewritten(&moved, &files).unwrap();
    let found = again(&files);
    assert_eq!(program.moves.len(), found.moves.len());
    for requested in &moved {
        let of = &found.moves[requested.index];
        near(of.target.pose().unwrap(), &requested.target);
        if let (Motion::Circular { via }, Some(requested)) = (&of.motion, &requested.via) {
            near(via.pose().unwrap(), requested);
        }
        assert_eq!(said(&program.moves[requested.index].target), said(&of.target));
        assert_eq!(program.moves[requested.index].speed, of.speed);
    }
    (files, found)
}

fn said(target: &Target) -> String {
    match target {
        Target::Pose { branch, turns, .. } => format!("{branch} {turns:?}"),
        other => format!("{other:?}"),
    }
}

/// Within half the third decimal of a mm in each direction, and of a degree, three times.
pub fn near(found: &Isometry, expected: &Isometry) {
    let apart = (found.translation.vector - expected.translation.vector).amax();
    let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
    let turned = (matrix(found) - matrix(expected)).amax();
    assert!(
        apart < 0.51e-6 && turned < 3.0 * 0.51e-3_f64.to_radians(),
        "{apart} {turned}: {found} {expected}"
    );
}

#[test]
fn reports_a_target_that_depends_on_a_moved_one() {
    let krl = "DEF A()\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN {X 5}\nEND\n";
    let step = "DEF A()\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN_REL {X 5}\nEND\n";
    let offset = "MODULE M\nCONST robtarget p:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC a()\n\
        MoveL p,v5,fine,tool0;\nMoveL Offs(p,1,0,0),v5,fine,tool0;\nENDPROC\nENDMODULE\n";
    let frame = "f = p[1,2,3,0,0,0]\nmovel(f)\nmovel(pose_trans(f, p[0,0,0,0,0,0]))\n";
    for (name, text, line) in [
        ("a.src", krl, 3),
        ("a.src", step, 3),
        ("a.mod", offset, 5),
        ("a.script", frame, 3),
    ] {
        let program = crate::program(&[(name, text)]).unwrap();
        let by = crate::same_poses::kuka([0.0, 10.0, 0.0, 0.0, 0.0, 0.0]);
        let mut moved = all_moved(&program, |pose| by * pose);
        let all = program.with_poses(&moved).unwrap();
        // Where both are moved each has a target of its own; but a frame that is a target moves what counts in it.
        assert_eq!(
            program.check_rewritten(&moved, &all).is_ok(),
            name != "a.script",
            "{text}"
        );
        moved.truncate(1);
        let files = program.with_poses(&moved).unwrap();
        let given = program.check_rewritten(&moved, &files).unwrap_err().to_string();
        let expected = format!("line {line}: the move would end 10000.0 um from its position");
        assert!(given.starts_with(&expected), "{given}");
    }
}
