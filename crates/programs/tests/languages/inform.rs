//! Our own jobs, problems of wrong ones, and drafts that are read back.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::{BranchPattern, Elbow, Shoulder, Wrist};
use armill_programs::inform::{read, write};
use armill_programs::{Draft, DraftStep, Frame, Motion, ProgramText, RobotProgram, Speed, Target};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::drafts::{
    Writes, drafts, every_step, long, notes_only, point, read_back, spaced, stored, text_of,
};
use crate::trials::{
    MICROMETRE, angle_of_decimals, apart, cuts, moved_alone, moves_as_drafted, problems, survives,
};

const JOB: &str = "/JOB\r
//NAME PART-1\r
//POS\r
///NPOS 7,0,1,1,0,0\r
///USER 2\r
///TOOL 3\r
///POSTYPE PULSE\r
///PULSE\r
C00000=100,-200,300,0,0,0\r
///POSTYPE USER\r
///RECTAN\r
///RCONF 1,0,0,0,1,0,0,0\r
C00001=100.000,0.000,50.000,180.0000,0.0000,0.0000\r
C00002= 110.000,10.000,50.000,180.0000, 0.0000,0.0000\r
C00003=120.000,0.000,50.000,180.00,0.00,0.00,12.5\r
///RCONF 0,1,1,0,0,0\r
C00004=130.000,-10.000,50.000,180.0000,0.0000,0.0000\r
C00005=140.000,0.000,50.000,180.0000,0.0000,0.0000\r
///POSTYPE BASE\r
///TOOL 4\r
C00006=900.5,0.,-1.25,-90,0,90\r
P00001=1.000,2.000,3.000,0.0000,0.0000,0.0000\r
///POSTYPE PULSE\r
EC00001=1000\r
//INST\r
///DATE 2026/11/20 23:37\r
///ATTR SC,RW,RJ\r
////FRAME USER 2\r
///GROUP1 RB1\r
NOP\r
'caf\u{e9} MOVX C99999\r
*AGAIN\r
MOVJ C00000 VJ=50.00\r
MOVL C00001 V=138.0 PL=0 //to the part\r
MOVC C00001 V=10.5\r
MOVC C00002 V=10.5\r
MOVC C00003 V=10.5 FPT\r
MOVC C00004 V=10.5\r
MOVC C00005 V=20.0\r
MOVS C00006 V=I001 +MOVJ EC00001\r
MOVL P001 VR=10.0\r
MOVL P[I000] V=5.0\r
CALL JOB:TOOLCHANGE\r
JUMP *AGAIN IF IN#(1)=ON\r
DOUT OT#(1) ON\r
END\r
";

fn program(text: &str) -> RobotProgram {
    // Latin-1 bytes, as old controllers write them.
    let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
    read(vec![ProgramText::new("part-1.jbi", &bytes)]).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn every_move_of_a_job_is_read_with_its_definitions() {
    let program = program(JOB);
    assert_eq!(program.name, "PART-1");
    let said: Vec<(Motion, Frame, Frame, Speed, u32)> = program
        .moves
        .iter()
        .map(|one| {
            let motion = match &one.motion {
                Motion::Circular { .. } => Motion::Joint,
                other => other.clone(),
            };
            (motion, one.frame, one.tool, one.speed, one.line)
        })
        .collect();
    let (user, base) = (Frame::Numbered(2), Frame::Given(Isometry::identity()));
    let (tool, other) = (Frame::Numbered(3), Frame::Numbered(4));
    let straight = Motion::Linear;
    let arc = Motion::Joint;
    assert_eq!(
        said,
        [
            (Motion::Joint, Frame::Unknown, tool, Speed::Joints, 33),
            (straight.clone(), user, tool, Speed::Tip(0.138), 34),
            (straight.clone(), user, tool, Speed::Tip(0.0105), 35),
            (arc.clone(), user, tool, Speed::Tip(0.0105), 37),
            (arc, user, tool, Speed::Tip(0.02), 39),
            (straight.clone(), base, other, Speed::Unknown, 40),
            (straight.clone(), base, other, Speed::Joints, 41),
            (straight, Frame::Unknown, Frame::Unknown, Speed::Tip(0.005), 42),
        ]
    );
    let place = |index: usize| program.moves[index].target.pose().unwrap().translation.vector;
    // Decimal numbers, and one product each.
    assert!((place(5) - Vector3::new(0.9005, 0.0, -0.00125)).norm() < 1e-15);
    let vias: Vec<f64> = program
        .moves
        .iter()
        .filter_map(|one| match &one.motion {
            Motion::Circular { via } => Some(via.pose().unwrap().translation.x),
            _ => None,
        })
        .collect();
    assert_eq!(vias, [0.11, 0.13]);
    assert_eq!(
        [0, 7].map(|index| program.moves[index].target.clone()),
        ["C00000", "P[I000]"].map(|name| Target::Elsewhere {
            name: name.to_owned()
        })
    );
}

#[test]
fn rconf_is_read_in_the_order_of_the_manual_and_of_the_robodk_post() {
    let said = |program: &RobotProgram, index: usize| match &program.moves[index].target {
        Target::Pose { branch, turns, .. } => (*branch, turns.clone()),
        other => panic!("{other:?}"),
    };
    let front = BranchPattern {
        shoulder: Some(Shoulder::Front),
        elbow: Some(Elbow::Up),
        wrist: Some(Wrist::NoFlip),
    };
    let behind = BranchPattern {
        shoulder: Some(Shoulder::Back),
        // Lower behind axis 1 is up in base z.
        elbow: Some(Elbow::Up),
        wrist: Some(Wrist::Flip),
    };
    let manual = program(JOB);
    assert_eq!(said(&manual, 1), (front, vec![0, 1, 0]));
    assert_eq!(said(&manual, 4), (behind, vec![0, 0, 0]));
    let post = program(&JOB.replace("///DATE", "///COMM Generated using RoboDK\r\n///DATE"));
    let (branch, _) = said(&post, 1);
    assert_eq!(
        (branch.shoulder, branch.wrist),
        (Some(Shoulder::Back), Some(Wrist::NoFlip))
    );
    assert!(post.notes.iter().any(|note| note.contains("rear, lower, flip")));
}

#[test]
fn ignored_instructions_that_matter_are_noted_with_their_lines() {
    let notes = program(JOB).notes;
    for words in [
        "part-1.jbi, line 15: a seventh number of a position",
        "part-1.jbi, line 32: labels and jumps are ignored",
        "part-1.jbi, line 34: speeds V= are read as mm/s",
        "part-1.jbi, line 40: a speed from a variable",
        "part-1.jbi, line 40: motion of a second robot or a station",
        "part-1.jbi, line 40: MOVS is read as straight",
        "part-1.jbi, line 43: the job TOOLCHANGE is called, but not given",
        "part-1.jbi, line 44: JUMP is ignored",
    ] {
        assert!(
            notes.iter().any(|note| note.starts_with(words)),
            "{words}: {notes:#?}"
        );
    }
    assert_eq!(notes.len(), 8);
}

#[test]
fn other_poses_change_only_the_numbers_of_positions() {
    let program = program(JOB);
    let within = [MICROMETRE, angle_of_decimals(4)];
    // An unchanged orientation is not rewritten.
    let again = moved_alone(&program, &Isometry::identity(), within);
    assert!(
        again.texts[0]
            .text()
            .contains("C00003=120.000,0.000,50.000,180.00,0.00,0.00,12.5\r\n")
    );
    let by = Isometry::new(Vector3::new(1e-4, -2e-5, 3.3e-5), Vector3::new(0.01, 0.02, -0.03));
    moved_alone(&program, &by, within);
    let files = program.with_poses(&[]).unwrap();
    let bytes: Vec<u8> = JOB.chars().map(|c| c as u8).collect();
    assert_eq!(files, [("part-1.jbi".to_owned(), bytes)]);
}

#[test]
fn a_called_job_is_read_at_its_first_call() {
    let called = "/JOB\n//NAME SUB\n//POS\n///POSTYPE BASE\nC0=1,2,3,0,0,0\n//INST\nMOVL C0 V=1.0\nCALL JOB:MAIN\nEND\n";
    let main = called
        .replace("SUB", "MAIN")
        .replace("CALL JOB:MAIN", "CALL JOB:SUB ARGF1\nCALL JOB:SUB\nMOVL C0");
    let texts = [("MAIN.JBI", main.as_str()), ("x.jbi", called)];
    let program = read(
        texts
            .map(|(name, text)| ProgramText::new(name, text.as_bytes()))
            .to_vec(),
    )
    .unwrap();
    let lines: Vec<u32> = program.moves.iter().map(|one| one.line).collect();
    assert_eq!(lines, [7, 7, 10]);
    assert_eq!(program.notes.len(), 3, "{:?}", program.notes);
}

#[test]
fn angles_are_joints() {
    let job = "/JOB\n//POS\n///TOOL 2\n///POSTYPE ANGLE\n///ANGLE\nC0=-46.1842,-6.7752,90.0,0,0,-302.5475\n//INST\nMOVJ C0 VJ=1.0\nEND\n";
    let program = program(job);
    let joints = [-46.1842, -6.7752, 90.0, 0.0, 0.0, -302.5475]
        .map(f64::to_radians)
        .to_vec();
    assert_eq!(program.moves[0].target, Target::Joints(joints));
    assert_eq!(program.moves[0].tool, Frame::Numbered(2));
}

#[test]
fn every_mistake_has_its_message() {
    let head = "/JOB\n//POS\n///POSTYPE BASE\nC1=1,2,3,0,0,0\nC2=1,2,3,0,0,0\n";
    let with =
        |position: &str, move_: &str| format!("{head}{position}\n//INST\nNOP\nMOVL C1\n{move_}\nEND\n");
    for (position, move_, sentence) in [
        (
            "C3=1,2,x,0,0,0",
            "",
            "a.jbi:6:8: `x` is not a number in the position C3",
        ),
        (
            "C3=1,2,3",
            "",
            "a.jbi:6:1: the position C3 is not a valid pose: 3 numbers of the pose, where yaskawa has 6",
        ),
        (
            "C3=1e12,2,3,0,0,0",
            "",
            "the position C3 is not a valid pose: 1e12 is beyond",
        ),
        ("C1=1,2,3,0,0,0", "", "a.jbi:6:1: the position C1 is given twice"),
        ("Q1=1", "", "`Q1` names no position"),
        (
            "///POSTYPE TOOL\nC3=1,2,3,0,0,0",
            "",
            "a.jbi:7:1: positions of the type TOOL are not followed",
        ),
        ("///USER x", "", "`x` is not a number of a user"),
        ("///RCONF 1,y", "", "`y` is not a valid RCONF value"),
        (
            "",
            "MOVL C00009 V=1.0",
            "a.jbi:10:6: the position C00009 is not in the list of this job",
        ),
        ("", "MOVL V=1.0", "`MOVL` names no position"),
        ("", "MOVL C1 V=-1", "a.jbi:10:9: `-1` is not a valid speed"),
        ("", "IMOV P001 V=1.0", "the move `IMOV` is not followed"),
        ("", "SMOVL C1 V=1.0", "the move `SMOVL` is not followed"),
        (
            "",
            "MOVC C1\nMOVC C2\nMOVL C1",
            "a.jbi:10:1: this row of MOVC has fewer than three points",
        ),
        (
            "",
            "MOVC C1\nMOVC C2",
            "this row of MOVC has fewer than three points",
        ),
        (
            "",
            "MOVC C1\nMOVC C2\nMOVC C1\nMOVC C2",
            "a.jbi:13:1: a fourth MOVC in a row",
        ),
        (
            "///TOOL 1\nC3=1,2,3,0,0,0",
            "MOVC C1\nMOVC C2\nMOVC C3",
            "the points of this arc are relative to different frames",
        ),
    ] {
        let found = problems(&[("a.jbi", &with(position, move_))]);
        assert!(
            found.len() == 1 && found[0].contains(sentence),
            "{sentence}: {found:?}"
        );
    }
    let without_type = problems(&[("a.jbi", "/JOB\n//POS\nC1=1,2,3,0,0,0\n//INST\nEND\n")]);
    assert!(without_type[0].contains("the coordinate system of position C1 is not given"));
    assert!(problems(&[("a.jbi", "hello")])[0].contains("this is not a job"));
    let pulses = "/JOB\n//POS\n///POSTYPE PULSE\nC1=1,2,3,0,0,0\n//INST\nMOVJ C1 VJ=1.0\nEND\n";
    assert!(
        problems(&[("a.jbi", pulses)])[0].contains("line 6: no target of this job is given in coordinates")
    );
}

#[test]
fn a_long_program_is_split_and_read_as_one() {
    let written = write(&long(4500)).unwrap();
    let names: Vec<&str> = written.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        ["PLATE.JBI", "PLATE001.JBI", "PLATE002.JBI", "PLATE003.JBI"]
    );
    let program = read_back(&written);
    assert_eq!((program.name.as_str(), program.moves.len()), ("PLATE", 4500));
    let straight = program
        .moves
        .iter()
        .filter(|one| one.motion == Motion::Linear)
        .count();
    assert_eq!(straight, 4499);
}

#[test]
fn refuses_values_outside_the_ranges_of_controllers() {
    let broken = |change: fn(&mut Draft)| {
        let mut draft = long(2);
        change(&mut draft);
        write(&draft).unwrap_err().to_string()
    };
    assert!(broken(|draft| draft.name = "x".repeat(33)).contains("at most 32 characters"));
    assert!(broken(|draft| draft.controller.frame_number = 0).contains("frame 0 is outside 1 to 63"));
    assert!(broken(|draft| point(draft, 0).joints.push(0.0)).contains("7 joints"));
    assert!(broken(|draft| point(draft, 1).speed = Some(1e-5)).contains("the speed is 0.00001"));
}

#[test]
fn moves_blend_as_specified_and_the_last_one_stops() {
    let text = text_of(&write(&spaced(3, 10.0)).unwrap(), 0);
    assert_eq!(text.matches(" PL=1\r\n").count(), 2, "{text}");
    assert_eq!(text.matches(" PL=0\r\n").count(), 1, "{text}");
}

#[test]
fn every_kind_of_step_has_its_instruction() {
    let mut draft = every_step("DOUT OT#(1) ON");
    draft.controller.joint_speed = 0.256;
    draft.controller.header = vec!["SETTOOL TL#(2) P010".to_owned()];
    draft.controller.footer = vec!["DOUT OT#(1) OFF".to_owned()];
    let text = text_of(&write(&draft).unwrap(), 0);
    let expected = "\r\nSETTOOL TL#(2) P010\r\n'approach\r\nMOVJ C00000 VJ=26.00 PL=1\r\nMOVL C00001 V=50.0 PL=1\r\n\
        'corner of the part\r\nMOVL C00002 V=50.0 PL=0\r\nTIMER T=1.50\r\nDOUT OT#(1) ON\r\nMOVL C00003 V=50.0 PL=0\r\n\
        'change the tool\r\nMSG \"change the tool\"\r\nPAUSE\r\nMOVJ C00004 VJ=26.00 PL=0\r\nDOUT OT#(1) OFF\r\nEND\r\n";
    assert!(text.ends_with(expected), "{text}");
    assert!(text.contains("///NPOS 5,0,0,0,0,0\r\n"), "{text}");
}

#[test]
fn only_the_beginning_of_a_long_message_is_shown() {
    let mut draft = every_step("");
    let long = "replace the cutter by the \"finishing\" cutter of 6 mm";
    draft.steps[8] = DraftStep::Stop(long.to_owned());
    let text = text_of(&write(&draft).unwrap(), 0);
    let expected = "'replace the cutter by the\r\n'\"finishing\" cutter of 6 mm\r\nMSG \"replace the cutter by the\"\r\nPAUSE\r\n";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn frames_and_tools_are_stored_whatever_the_cell_says() {
    let draft = long(2);
    let written = write(&draft).unwrap();
    assert_eq!(written, write(&stored(draft, "Table", "Spindle")).unwrap());
    assert!(
        written.notes[0].starts_with(
            "user frame 1 on the controller must be, relative to the robot base: X 1.000 Y 2.000"
        ),
        "{}",
        written.notes[0]
    );
}

const WRITES: Writes = Writes {
    external: 0,
    statement: "DOUT OT#(1) ON",
};

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn what_was_cut_into_is_refused_or_read_again_as_it_was(cuts in cuts()) {
        survives(&[("part-1.jbi", JOB)], &cuts);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_as_it_was(draft in drafts(WRITES)) {
        let written = write(&draft).unwrap();
        let (_, bytes) = &written.files[0];
        let lone_line_ends = bytes.windows(2).filter(|pair| pair[1] == b'\n' && pair[0] != b'\r').count();
        prop_assert_eq!(lone_line_ends, 0);
        let program = read_back(&written);
        prop_assert_eq!(&program.name, &draft.name);
        prop_assert_eq!(program.moves.len(), draft.points().count());
        notes_only(&program, &["speeds V= are read as mm/s"]);
        for (one, point) in program.moves.iter().zip(draft.points()) {
            let Target::Pose { pose, branch, turns, .. } = &one.target else { panic!() };
            let [far, turned] = apart(pose, &point.frame_from_tool);
            prop_assert!(far <= MICROMETRE && turned <= angle_of_decimals(4), "{} m, {} rad", far, turned);
            prop_assert_eq!(*branch, BranchPattern::from(point.branch.unwrap()));
            let beyond: Vec<i32> = [3, 5, 0].map(|joint: usize| i32::from(point.joints[joint].abs() > std::f64::consts::PI)).to_vec();
            prop_assert_eq!(turns, &beyond);
            prop_assert_eq!((one.frame, one.tool), (Frame::Numbered(draft.controller.frame_number), Frame::Numbered(draft.controller.tool_number)));
            // One decimal of mm/s.
            moves_as_drafted(one, point, 0.05001e-3);
        }
    }
}
