//! The samples of Yaskawa, FANUC and Staubli: the one list of poses.

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;
use armill_programs::{Frame, Language, Motion, ProgramText, RobotProgram, Speed, Target, read};

use crate::same_poses::{FRAME, JOINTS, PLACES, TOOL, TURN, eight_moves, kuka, path, same, same_joints};

fn sample(name: &str) -> Option<(RobotProgram, Vec<u8>)> {
    let bytes = std::fs::read(path(name)?).unwrap();
    let program = read(vec![ProgramText::new(name, &bytes)]).unwrap_or_else(|problems| panic!("{problems}"));
    Some((program, bytes))
}

/// The poses of the moves behind the first.
fn poses(program: &RobotProgram) -> Vec<Isometry> {
    let straight = program.moves.iter().skip(1);
    straight
        .map(|one| {
            assert_eq!(one.motion, Motion::Linear);
            *one.target.pose().unwrap()
        })
        .collect()
}

fn in_frame(at: usize) -> Isometry {
    let [[x, y, z], [a, b, c]] = [PLACES[at], TURN];
    kuka([x, y, z, a, b, c])
}

#[test]
fn the_yaskawa_job_has_the_poses_of_the_others_in_the_base() {
    let Some((program, bytes)) = sample("Motoman.JBI") else {
        return;
    };
    assert_eq!(
        (program.language, program.name.as_str()),
        (Language::Inform, "Progra")
    );
    let first = Target::Elsewhere {
        name: "C00000".to_owned(),
    };
    assert_eq!(
        (&program.moves[0].target, &program.moves[0].motion),
        (&first, &Motion::Joint)
    );
    for (at, pose) in poses(&program).iter().enumerate() {
        same(pose, &(kuka(FRAME) * in_frame(at)));
    }
    for one in &program.moves[1..] {
        assert_eq!(one.frame, Frame::Given(Isometry::identity()));
        assert_eq!((one.tool, one.speed), (Frame::Numbered(9), Speed::Tip(0.1)));
        let Target::Pose { branch, turns, .. } = &one.target else {
            panic!("{one:?}")
        };
        assert_eq!(branch.to_string(), "front elbow-up no-flip");
        assert_eq!(turns, &[0, -1, 0]);
    }
    assert_eq!(
        program.moves.iter().map(|one| one.line).collect::<Vec<_>>(),
        [33, 34, 35, 39, 40, 41, 45, 46, 47]
    );
    assert_eq!(program.with_poses(&[]).unwrap()[0].1, bytes);
}

#[test]
fn the_fanuc_listing_has_the_poses_of_the_others_in_the_frame() {
    let Some((program, bytes)) = sample("Fanuc_R30iA.LS") else {
        return;
    };
    assert_eq!(
        (program.language, program.name.as_str()),
        (Language::Tp, "Program")
    );
    // Three decimals here, five there.
    same_joints(&program.moves[0], 0.000_51);
    eight_moves(&program.moves[1..]);
    for (at, pose) in poses(&program).iter().enumerate() {
        same(pose, &in_frame(at));
    }
    for one in &program.moves {
        let (Frame::Given(frame), Frame::Given(tool)) = (one.frame, one.tool) else {
            panic!("{one:?}")
        };
        same(&frame, &kuka(FRAME));
        // W 0, P 90, R -60 here, A -60, B 90, C 0 there: the same turns.
        same(&tool, &kuka(TOOL));
    }
    for one in &program.moves[1..] {
        assert_eq!(one.speed, Speed::Tip(0.5));
        let Target::Pose { branch, turns, .. } = &one.target else {
            panic!("{one:?}")
        };
        assert_eq!(branch.to_string(), "front elbow-up no-flip");
        // Of the joints of the first move: axes 1 and 4 within half a turn, axis 6 at -302.5 deg.
        assert_eq!(turns, &[0, 0, -1]);
    }
    assert_eq!(program.with_poses(&[]).unwrap()[0].1, bytes);
}

#[test]
fn the_staubli_program_without_its_data_names_what_is_missing() {
    let name = "Staubli_VAL3_simplified.pgx";
    let Some(file) = path(name) else {
        return;
    };
    let bytes = std::fs::read(file).unwrap();
    let problems = read(vec![ProgramText::new(name, &bytes)]).unwrap_err();
    let said: Vec<(usize, &str)> = problems
        .as_slice()
        .iter()
        .map(|one| (one.line(), one.message()))
        .collect();
    let missing = |line, what: &str| {
        (
            line,
            format!("`{what}` is not defined: there are no data (.dtx) among these files"),
        )
    };
    let points = [4, 5, 9, 10, 11, 15, 16, 17];
    let mut expected = vec![missing(3, "jJoint[0]")];
    expected.extend(
        points
            .iter()
            .enumerate()
            .map(|(at, line)| missing(*line, &format!("pPoint[{at}]"))),
    );
    let expected: Vec<(usize, &str)> = expected
        .iter()
        .map(|(line, what)| (*line, what.as_str()))
        .collect();
    assert_eq!(said, expected);
    assert!(
        problems.as_slice()[0]
            .hint()
            .unwrap()
            .contains("the whole folder of the project")
    );
}

/// The sample's moves with data of our own: the eight poses, as Staubli writes them.
#[test]
fn the_staubli_program_with_data_has_the_poses_of_the_others() {
    let Some(file) = path("Staubli_VAL3_simplified.pgx") else {
        return;
    };
    let bytes = std::fs::read(file).unwrap();
    let value = |key: usize, pose: &Isometry, father: &str| {
        let numbers = Convention::Staubli.numbers_of(pose);
        let [x, y, z, rx, ry, rz] = numbers.try_into().unwrap();
        format!(
            "<Value key=\"{key}\" x=\"{x:.3}\" y=\"{y:.3}\" z=\"{z:.3}\" rx=\"{rx:.3}\" ry=\"{ry:.3}\" rz=\"{rz:.3}\" fatherId=\"{father}\" />\n"
        )
    };
    let points: String = (0..8).map(|at| value(at, &in_frame(at), "fFrame[0]")).collect();
    let joints: String = JOINTS
        .iter()
        .zip(1..)
        .map(|(deg, axis)| format!("j{axis}=\"{deg}\" "))
        .collect();
    let data = [
        ("fFrame", "frame", value(0, &kuka(FRAME), "world[0]")),
        ("tTool", "tool", value(0, &kuka(TOOL), "flange[0]")),
        ("jJoint", "jointRx", format!("<Value key=\"0\" {joints}/>")),
        (
            "mNomSpeed",
            "mdesc",
            "<Value key=\"0\" tmax=\"100\" />".to_owned(),
        ),
        ("pPoint", "pointRx", points),
    ]
    .map(|(name, kind, values)| format!("<Data name=\"{name}\" type=\"{kind}\">\n{values}\n</Data>\n"))
    .concat();
    let data = format!("<Database><Datas>{data}</Datas></Database>");
    let texts = vec![
        ProgramText::new("a.pgx", &bytes),
        ProgramText::new("a.dtx", data.as_bytes()),
    ];
    let program = read(texts).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(program.language, Language::Val3);
    assert_eq!(
        program.moves[0].target,
        Target::Joints(JOINTS.map(f64::to_radians).to_vec())
    );
    for (at, pose) in poses(&program).iter().enumerate() {
        same(pose, &in_frame(at));
        assert_eq!(program.moves[at + 1].speed, Speed::Tip(0.1));
    }
}
