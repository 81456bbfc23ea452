//! KUKA KRL.

mod refusals;
mod written;

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;
use armill_programs::{Frame, Language, Motion, RobotProgram, Speed, Target, write};
use proptest::prelude::*;

use crate::drafts::{Says, Writes, drafts, long, read_back, reads_back};
use crate::rewriting::{keeps_the_rest, near, rewritten};
use crate::same_poses::{eight_moves, kuka, path, same, same_joints, sample};
use crate::{problems, program, refused};

/// A program with its data, as the inline forms of a pendant write it.
const MODULE: &str = "&ACCESS RVO\r\n&REL 12\r\nDEF Teil ( )\r\n;FOLD INI;%{PE}\r\n  BAS (#INITMOV,0 )\r\n;ENDFOLD (INI)\r\n\
;FOLD PTP HOME Vel= 100 % DEFAULT;%{PE}\r\n$BWDSTART = FALSE\r\nPDAT_ACT=PDEFAULT\r\nFDAT_ACT=FHOME\r\n\
BAS (#PTP_PARAMS,100 )\r\n$H_POS=XHOME\r\nPTP  XHOME\r\n;ENDFOLD\r\n\
FDAT_ACT=FP1\r\nBAS(#PTP_PARAMS,100)\r\nPTP XP1 C_PTP\r\n\
LDAT_ACT=LCPDAT2\r\nFDAT_ACT=FP2\r\nBAS(#CP_PARAMS,0.25)\r\nLIN XP2 C_DIS C_DIS\r\n\
CIRC XP3, XP4\r\nLOOP\r\n  Zange ( 5 )\r\nENDLOOP\r\nEND\r\n";
const DATA: &str = "&ACCESS RVO\r\nDEFDAT  TEIL\r\nEXT  BAS (BAS_COMMAND  :IN,REAL  :IN )\r\n\
DECL E6POS XP1={X 900.5,Y -12.25,Z 700.0,A -180.0,B 45.5,C 179.0,S 2,T 35,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}\r\n\
DECL FDAT FP1={TOOL_NO 3,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \",TQ_STATE FALSE}\r\n\
DECL PDAT PPDAT1={VEL 100.0,ACC 100.0,APO_DIST 100.0}\r\n\
DECL E6POS XP2={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0,S 'B110',T 'H23',E1 1500.0} ; \u{fc}ber dem Tisch\r\n\
FDAT FP2={TOOL_NO 3,BASE_NO 7,IPO_FRAME #BASE}\r\nDECL LDAT LCPDAT2={VEL 2.0,ACC 100.0}\r\n\
DECL GLOBAL E6POS XP3={X 10.0,Y 20.0,Z 30.0,A 0.0,B 0.0,C 0.0}\r\nDECL POS XP4={X 20.0,Y 0.0,Z 30.0,A 0.0,B 90.0,C 0.0}\r\n\
ENDDAT\r\n";

fn module() -> RobotProgram {
    program(&[("teil.src", MODULE), ("teil.dat", DATA)]).unwrap()
}

/// A program of these lines.
pub fn src(lines: &str) -> String {
    format!("DEF A()\n{lines}\nEND\n")
}

fn of(lines: &str) -> RobotProgram {
    program(&[("a.src", &src(lines))]).unwrap()
}

/// That these lines are refused with one problem.
pub fn wrong(lines: &str, part: &str) {
    refused(&[("a.src", &src(lines))], part);
}

const POSE: &str = "{X 1,Y 2,Z 3,A 0,B 0,C 0}";

#[test]
fn the_sample_has_the_joints_and_the_eight_poses() {
    let Some(program) = sample("KUKA_KRC4.src") else {
        return;
    };
    assert_eq!(program.name, "Program");
    // Five decimals are printed.
    same_joints(&program.moves[0], 1e-9);
    eight_moves(&program.moves[1..]);
    assert!(program.moves[1..].iter().all(|of| of.speed == Speed::Tip(0.2)));
    for word in ["$AXIS_ACT", "TCP_On", "TCP_Off"] {
        assert!(program.notes.iter().any(|note| note.contains(word)), "{word}");
    }
    keeps_the_rest(&program, |pose| *pose);
}

#[test]
fn samples_without_their_data_file_name_every_point_that_is_missing() {
    for file in ["KUKA_KRC2_DAT.src", "KUKA_KRC4_DAT.src"] {
        let Some(path) = path(file) else { return };
        let text = std::fs::read_to_string(path).unwrap();
        let all = problems(&[(file, &text)]);
        assert_eq!(all.len(), 9);
        for (index, problem) in all.iter().enumerate() {
            assert!(
                problem.contains(&format!("`XP{}` is not defined", index + 1)),
                "{problem}"
            );
        }
    }
}

#[test]
fn a_module_has_its_points_in_the_data_file() {
    let program = module();
    assert_eq!(program.name, "Teil");
    let [first, second, arc] = program.moves.as_slice() else {
        panic!("{:?}", program.moves);
    };
    let Target::Pose {
        pose, branch, turns, ..
    } = &first.target
    else {
        panic!("{first:?}");
    };
    same(pose, &kuka([900.5, -12.25, 700.0, -180.0, 45.5, 179.0]));
    assert_eq!(branch.to_string(), "front elbow-up no-flip");
    assert_eq!(*turns, [1, 1, 0, 0, 0, 1]);
    assert_eq!(
        (first.motion.clone(), first.speed),
        (Motion::Joint, Speed::Joints)
    );
    let base = Isometry::identity();
    assert_eq!(
        (first.frame, first.tool),
        (Frame::Given(base), Frame::Numbered(3))
    );
    let Target::Pose { branch, turns, .. } = &second.target else {
        panic!("{second:?}");
    };
    assert_eq!(
        (branch.to_string().as_str(), turns.as_slice()),
        ("front elbow-up flip", &[1, 1, 0, 0, 0, 1][..])
    );
    assert_eq!(
        (second.frame, second.speed),
        (Frame::Numbered(7), Speed::Tip(0.25))
    );
    let Motion::Circular { via } = &arc.motion else {
        panic!("{arc:?}");
    };
    same(via.pose().unwrap(), &kuka([10.0, 20.0, 30.0, 0.0, 0.0, 0.0]));
    same(
        arc.target.pose().unwrap(),
        &kuka([20.0, 0.0, 30.0, 0.0, 90.0, 0.0]),
    );
    assert_eq!(arc.line, 22);
    for part in [
        "`XHOME` is left out",
        "`FHOME` is not defined",
        "external axes",
        "teil.src, line 23: `LOOP`: its body is read once",
        "`Zange` is called",
    ] {
        assert!(
            program.notes.iter().any(|note| note.contains(part)),
            "{part}: {:?}",
            program.notes
        );
    }
}

#[test]
fn rewriting_changes_only_the_bytes_of_targets() {
    let program = module();
    let by = kuka([0.1234, -5.0, 1000.0, 10.0, 20.0, -30.0]);
    keeps_the_rest(&program, |pose| *pose);
    let files = keeps_the_rest(&program, |pose| by * pose);
    // The move file contains no target.
    assert_eq!(files[0].1, MODULE.as_bytes());
    let data = String::from_utf8(files[1].1.clone()).unwrap();
    for kept in [
        "S 2,T 35,E1 0.0,E2",
        "S 'B110',T 'H23',E1 1500.0} ; \u{fc}ber dem Tisch\r\n",
    ] {
        assert!(data.contains(kept), "{data}");
    }
}

#[test]
fn decimals_are_three_and_four_or_as_written() {
    let program = of("LIN {Z 3.123456, C 0,X 1 ,Y 2.5,B -0.00001,A 0,E1 7}");
    // Rotated by half a degree, and unchanged where it is not rotated.
    let turned = |pose: &Isometry| {
        let turn = kuka([0.0, 0.0, 0.0, 0.5, 0.0, 0.0]).rotation;
        Isometry::from_parts(pose.translation, turn * pose.rotation)
    };
    for (files, expected) in [
        (
            keeps_the_rest(&program, turned),
            "LIN {Z 3.123456, C 0.0000,X 1.000 ,Y 2.500,B -0.00001,A 0.5000,E1 7}",
        ),
        (
            keeps_the_rest(&program, |pose| *pose),
            "LIN {Z 3.123456, C 0,X 1.000 ,Y 2.500,B -0.00001,A 0,E1 7}",
        ),
    ] {
        let text = String::from_utf8(files[0].1.clone()).unwrap();
        assert!(text.contains(expected), "{text}");
    }
}

#[test]
fn latin_1_bytes_are_kept() {
    let bytes = b"DEF A()\r\n; \xfcber\r\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0} ; \xe4\r\nEND\r\n";
    let text = armill_programs::ProgramText::new("a.src", bytes);
    let program = armill_programs::read(vec![text]).unwrap();
    let files = keeps_the_rest(&program, |pose| *pose);
    let expected = b"DEF A()\r\n; \xfcber\r\nLIN {X 1.000,Y 2.000,Z 3.000,A 0,B 0,C 0} ; \xe4\r\nEND\r\n";
    assert_eq!(files[0].1, expected);
}

#[test]
fn missing_components_come_from_the_previous_move_and_are_written_when_they_change() {
    let program = of("PTP {X 1,Y 2,Z 3,A 10,B 0,C 0,S 2,T 0}\nLIN {X 20}\nlin {z -5,b 90} C_DIS");
    same(
        program.moves[1].target.pose().unwrap(),
        &kuka([20.0, 2.0, 3.0, 10.0, 0.0, 0.0]),
    );
    same(
        program.moves[2].target.pose().unwrap(),
        &kuka([20.0, 2.0, -5.0, 10.0, 90.0, 0.0]),
    );
    let by = kuka([0.0, 0.0, 1.0, 0.0, 10.0, 0.0]);
    let files = keeps_the_rest(&program, |pose| pose * by);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(text.contains("S 2,T 0}\nLIN {X 20.0"), "{text}");
}

#[test]
fn a_missing_component_after_axes_or_in_another_frame_is_a_problem() {
    let axes = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}";
    wrong(
        &format!("{axes}\nLIN {{X 20}}"),
        "3:5: Y, Z, A, B, C of this target is given neither",
    );
    wrong(
        &format!("LIN {POSE}\n$BASE={POSE}\nLIN {{X 20}}"),
        "Y, Z, A, B, C of this target",
    );
    wrong("PTP {A1 0}", "A2, A3, A4, A5, A6 of this target");
    let program = of(&format!("{axes}\nPTP {{A6 30}}"));
    let Target::Joints(joints) = &program.moves[1].target else {
        panic!()
    };
    assert_eq!(
        joints
            .iter()
            .map(|joint| joint.to_degrees().round())
            .collect::<Vec<_>>(),
        [0.0, -90.0, 90.0, 0.0, 0.0, 30.0]
    );
}

#[test]
fn relative_moves_start_at_the_end_of_the_previous_move() {
    let lines = "PTP {A1 1,A2 -90,A3 90,A4 0,A5 0,A6 0}\nPTP_REL {A1 10}\nLIN {X 1,Y 2,Z 3,A 0,B 90,C 0}\n\
                 LIN_REL {X 10}\nSLIN_REL {Z 10} #TOOL C_DIS\nPTP_REL {Y -2}";
    let program = of(lines);
    let Target::Joints(joints) = &program.moves[1].target else {
        panic!()
    };
    assert!((joints[0].to_degrees() - 11.0).abs() < 1e-12);
    let pose = |index: usize| program.moves[index].target.pose().unwrap();
    same(pose(3), &kuka([11.0, 2.0, 3.0, 0.0, 90.0, 0.0]));
    // z of the tool is x of the frame.
    same(pose(4), &kuka([21.0, 2.0, 3.0, 0.0, 90.0, 0.0]));
    same(pose(5), &kuka([21.0, 0.0, 3.0, 0.0, 90.0, 0.0]));
    let (files, _) = rewritten(&program, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(
        text.contains("\nSLIN {X 21.000,Y 2.000,Z 3.000,A 0.0000,B 90.0000,C 0.0000} C_DIS\nPTP {"),
        "{text}"
    );
    wrong("LIN_REL {X 10}", "the target of `LIN_REL` is not known");
    wrong(
        &format!("LIN {POSE}\nLIN_REL {{A 10}}"),
        "the target of `LIN_REL` is not known",
    );
    wrong("CIRC_REL {X 10},{X 20}", "`CIRC_REL` is an unsupported move");
}

#[test]
fn points_are_composed_with_frames_and_written_whole() {
    let program = of(&format!(
        "P1={POSE}\nLIN P1:{{X 0,Y 0,Z -50,A 0,B 0,C 0}} C_DIS\nLIN P1"
    ));
    same(
        program.moves[0].target.pose().unwrap(),
        &kuka([1.0, 2.0, -47.0, 0.0, 0.0, 0.0]),
    );
    let files = keeps_the_rest(&program, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(
        text.contains(
            "P1={X 1.000,Y 2.000,Z 3.000,A 0,B 0,C 0}\nLIN {X 1.000,Y 2.000,Z -47.000,A 0.0000,B 0.0000,C 0.0000}"
        ),
        "{text}"
    );
}

#[test]
fn frames_and_tools_are_given_or_numbered() {
    let frame = |lines: &str| of(&format!("{lines}\nLIN {POSE}")).moves[0].frame;
    let tool = |lines: &str| of(&format!("{lines}\nLIN {POSE}")).moves[0].tool;
    let given = |found: Frame, numbers: [f64; 6]| match found {
        Frame::Given(found) => same(&found, &kuka(numbers)),
        other => panic!("{other:?}"),
    };
    assert_eq!(frame(""), Frame::Unknown);
    assert_eq!(frame("BAS(#BASE,4)"), Frame::Numbered(4));
    assert_eq!(tool("$TOOL=TOOL_DATA[16]"), Frame::Numbered(16));
    assert_eq!(
        frame("FDAT_ACT={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE}"),
        Frame::Numbered(2)
    );
    given(frame("BAS(#BASE,0)"), [0.0; 6]);
    given(frame("$BASE=$NULLFRAME"), [0.0; 6]);
    given(
        frame("$BASE={X 1,Y 2,Z 3,A 4,B 5,C 6}\n$BASE={Z 7}"),
        [1.0, 2.0, 7.0, 4.0, 5.0, 6.0],
    );
    given(
        frame("BASE_DATA[2]={FRAME: X 1,Y 0,Z 0,A 90,B 0,C 0}\n$BASE=BASE_DATA[2]:{X 5,Y 0,Z 0,A 0,B 0,C 0}"),
        [1.0, 5.0, 0.0, 90.0, 0.0, 0.0],
    );
    given(
        tool("TOOL_DATA[3]={X 1,Y 0,Z 0,A 0,B 0,C 0}\nBAS(#TOOL,3)"),
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    );
    let computed = of(&format!("$BASE=EK(MACHINE_DEF[2].ROOT, #EASYS, X)\nLIN {POSE}"));
    assert_eq!(computed.moves[0].frame, Frame::Unknown);
    assert!(computed.notes[0].contains("`EK(MACHINE_DEF[2].ROOT, #EASYS, X)` is computed on the controller"));
    wrong(
        "$BASE={X 1}\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}",
        "Y, Z, A, B, C of this target is given neither",
    );
}

#[test]
fn spline_moves_have_their_own_frames_and_speeds() {
    let lines = format!(
        "DECL FDAT FP1={{TOOL_NO 2,BASE_NO 5,IPO_FRAME #BASE}}\n$VEL.CP=0.1\n\
         SLIN {POSE} WITH $VEL=SVEL_CP(0.4, , LCPDAT1), $TOOL=STOOL2(FP1), $BASE=SBASE(FP1.BASE_NO), \
         $IPO_MODE=SIPO_MODE(FP1.IPO_FRAME), $APO=SAPO(LCPDAT1)\n\
         SLIN {POSE} WITH $VEL.CP=0.3\nSPLINE WITH $VEL.CP=0.7\nSPL {POSE}\nENDSPLINE\nSLIN {POSE}"
    );
    let program = of(&lines);
    let speeds: Vec<Speed> = program.moves.iter().map(|of| of.speed).collect();
    assert_eq!(speeds, [0.4, 0.3, 0.7, 0.1].map(Speed::Tip));
    assert_eq!(
        (program.moves[0].frame, program.moves[0].tool),
        (Frame::Numbered(5), Frame::Numbered(2))
    );
    assert_eq!(program.moves[1].frame, Frame::Unknown);
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.contains("not the curve between them"))
    );
}

#[test]
fn speeds_are_in_metres_per_second() {
    for (line, speed) in [
        ("$VEL.CP=0.2", Speed::Tip(0.2)),
        ("$VEL={CP 1.5,ORI1 200,ORI2 200}", Speed::Tip(1.5)),
        ("BAS(#VEL_CP,.5)", Speed::Tip(0.5)),
        ("LDAT_ACT={VEL 0.75,ACC 100}\nBAS(#CP_DAT)", Speed::Tip(0.75)),
        ("$VEL.CP=V_WORK", Speed::Unknown),
        ("", Speed::Unknown),
    ] {
        assert_eq!(of(&format!("{line}\nLIN {POSE}")).moves[0].speed, speed, "{line}");
    }
}

#[test]
fn points_of_two_modules_may_have_the_same_name() {
    let data = |x: f64| format!("DEFDAT D\nDECL E6POS XP1={{X {x},Y 0,Z 0,A 0,B 0,C 0}}\nENDDAT\n");
    let (one, two) = (data(1.0), data(2.0));
    let files = [
        ("one.src", "DEF ONE()\nLIN XP1\nTWO()\nEND\n"),
        ("one.dat", &one),
        ("two.dat", &two),
        ("two.src", "DEF TWO()\nLIN XP1\nEND\n"),
    ];
    let program = program(&files).unwrap();
    let x: Vec<f64> = program
        .moves
        .iter()
        .map(|of| of.target.pose().unwrap().translation.x)
        .collect();
    assert_eq!(x, [0.001, 0.002]);
    assert!(program.notes[0].contains("`TWO` is called: its moves are read once, where it is defined"));
}

const WRITES: Writes = Writes {
    external: 6,
    statement: "$OUT[3]=TRUE",
};

const SAYS: Says = Says {
    // A straight move keeps the posture of the move before it.
    branch: |_| BranchPattern::default(),
    turns: |_| Vec::new(),
    notes: &["external axes"],
};

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_draft_is_read_back(draft in drafts(WRITES)) {
        reads_back(Language::Krl, &draft, &SAYS);
    }
}

#[test]
fn a_long_program_is_written_in_parts_called_by_a_main_program() {
    let written = write(Language::Krl, &long(10_001)).unwrap();
    let names: Vec<&str> = written.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        ["PLATE.src", "PLATE_001.src", "PLATE_002.src", "PLATE_003.src"]
    );
    let program = read_back(&written);
    assert_eq!(program.moves.len(), 10_001);
    near(
        program.moves[10_000].target.pose().unwrap(),
        &kuka([1000.0, 0.0, 0.0, 0.0, 90.0, 0.0]),
    );
    assert!(program.moves[1..].iter().all(|of| of.speed == Speed::Tip(0.05)));
}
