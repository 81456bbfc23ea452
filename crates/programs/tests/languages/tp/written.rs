//! Drafts written as listings and read back, and the text of listings.

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;
use armill_programs::tp::write;
use armill_programs::{Frame, Target};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::drafts::{
    Writes, drafts, every_step, long, notes_only, point, read_back, spaced, stored, text_of,
};
use crate::trials::{MICROMETRE, angle_of_decimals, apart, moves_as_drafted};

#[test]
fn a_long_program_is_split_and_read_as_one() {
    let written = write(&long(10_001)).unwrap();
    let names: Vec<&str> = written.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["PLATE.LS", "PLATE001.LS", "PLATE002.LS", "PLATE003.LS"]);
    let program = read_back(&written);
    assert_eq!(program.moves.len(), 10_001);
    assert!(
        program
            .moves
            .iter()
            .all(|one| matches!(one.frame, Frame::Given(_)))
    );
    let joints = program
        .moves
        .iter()
        .filter(|one| matches!(one.target, Target::Joints(_)))
        .count();
    assert_eq!(joints, 1);
    notes_only(&program, &[]);
}

#[test]
fn a_listing_gives_its_number_of_lines() {
    let text = text_of(&write(&every_step("DO[1]=ON")).unwrap(), 0);
    let body = text
        .split("/MN\r\n")
        .nth(1)
        .unwrap()
        .split("/POS")
        .next()
        .unwrap();
    let lines = body.lines().count();
    assert!(text.contains(&format!("LINE_COUNT\t= {lines};")));
    for (number, line) in (1..).zip(body.lines()) {
        assert!(line.starts_with(&format!("{number:>4}:")), "{line}");
    }
}

#[test]
fn moves_blend_as_specified_and_the_last_one_stops() {
    let ends = |apart_mm: f64| {
        let text = text_of(&write(&spaced(4, apart_mm)).unwrap(), 0);
        ["CNT100", "CNT0", "FINE"].map(|end| text.matches(&format!(" {end} ;\r\n")).count())
    };
    // Blends of 0.5 mm: between points that are near the neighbours limit them, not the tolerance of the path. The
    // approach does not round its corner.
    assert_eq!(ends(0.1), [2, 1, 1]);
    assert_eq!(ends(10.0), [0, 3, 1]);
}

#[test]
fn every_kind_of_step_has_its_statement() {
    let mut draft = every_step("DO[1]=ON ;");
    draft.controller.joint_speed = 0.256;
    draft.controller.joint_acceleration = Some(0.5);
    draft.controller.header = vec!["PAYLOAD[1]".to_owned()];
    draft.controller.footer = vec!["DO[1]=OFF".to_owned()];
    let text = text_of(&write(&draft).unwrap(), 0);
    let expected = [
        "UFRAME_NUM=1",
        "UTOOL_NUM=2",
        "PAYLOAD[1]",
        "!approach",
        "J P[1] 26% CNT0 ACC50",
        "L P[2] 50mm/sec CNT0",
        "!corner of the part",
        "L P[3] 50mm/sec FINE",
        "WAIT 1.50(sec)",
        "DO[1]=ON",
        "L P[4] 50mm/sec FINE",
        "MESSAGE[change the tool]",
        "PAUSE",
        "J P[5] 26% FINE ACC50",
        "DO[1]=OFF",
    ];
    let body = text.split("/POS").next().unwrap();
    let statements: Vec<&str> = body
        .lines()
        .filter_map(|line| line.split_once(':')?.1.trim().strip_suffix(" ;"))
        .collect();
    assert!(statements.ends_with(&expected), "{statements:#?}");
    // Joint moves in joints, straight moves as poses.
    let joints = "P[1]{\r\n   GP1:\r\n\tUF : 1, UT : 2,\t\r\n\tJ1=   -46.184 deg,\tJ2=    -6.775 deg,\tJ3=   -20.549 deg,\r\n\
                  \tJ4=    71.387 deg,\tJ5=    49.587 deg,\tJ6=  -302.548 deg\r\n};\r\n";
    let pose = "P[2]{\r\n   GP1:\r\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, -1',\r\n\
                \tX =    10.000  mm,\tY =     0.000  mm,\tZ =     0.000  mm,\r\n";
    assert!(text.contains(&format!("{joints}{pose}")), "{text}");
}

#[test]
fn extended_axes_follow_the_position_of_the_arm() {
    let mut draft = long(2);
    draft.external_slides = vec![true, false];
    for step in 0..2 {
        point(&mut draft, step).external = vec![1.25, std::f64::consts::FRAC_PI_2];
    }
    let text = text_of(&write(&draft).unwrap(), 0);
    let external = ",\r\n\tE1=  1250.000  mm,\tE2=    90.000 deg\r\n};\r\n";
    assert_eq!(text.matches(external).count(), 2, "{text}");
    draft.external_slides = vec![true; 4];
    for step in 0..2 {
        point(&mut draft, step).external = vec![0.0; 4];
    }
    assert_eq!(
        write(&draft).unwrap_err().to_string(),
        "4 external axes, but FANUC TP programs are written with at most 3"
    );
}

#[test]
fn stored_frames_and_tools_are_only_selected() {
    let written = write(&stored(long(2), "Table", "Spindle")).unwrap();
    let text = text_of(&written, 0);
    assert!(!text.contains("PR[") && !text.contains("UFRAME["), "{text}");
    assert!(
        text.contains(":  UFRAME_NUM=1 ;\r\n") && text.contains(":  UTOOL_NUM=2 ;\r\n"),
        "{text}"
    );
    assert!(
        written.notes[0].starts_with("UFRAME[1] must be (1.000, 2.000, 3.000,")
            && written.notes[0].contains("UTOOL[2] (0.000, 0.000, 100.000,"),
        "{}",
        written.notes[0]
    );
    let program = read_back(&written);
    let numbers = (Frame::Numbered(1), Frame::Numbered(2));
    assert!(program.moves.iter().all(|of| (of.frame, of.tool) == numbers));
}

const WRITES: Writes = Writes {
    external: 3,
    statement: "DO[1]=ON",
};

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_as_it_was(draft in drafts(WRITES)) {
        let written = write(&draft).unwrap();
        let program = read_back(&written);
        prop_assert_eq!(&program.name, &draft.name);
        prop_assert_eq!(program.moves.len(), draft.points().count());
        notes_only(&program, &["extended axes"]);
        let near = |one: &Isometry, other: &Isometry| {
            let [far, turned] = apart(one, other);
            far <= MICROMETRE && turned <= angle_of_decimals(3)
        };
        for (one, point) in program.moves.iter().zip(draft.points()) {
            let (Frame::Given(frame), Frame::Given(tool)) = (one.frame, one.tool) else { panic!() };
            prop_assert!(near(&frame, &draft.base_from_frame) && near(&tool, &draft.flange_from_tool));
            match &one.target {
                Target::Joints(joints) => {
                    prop_assert!(point.speed.is_none());
                    for (joint, given) in joints.iter().zip(&point.joints) {
                        // Three decimals of a degree.
                        prop_assert!((joint - given).abs() <= 0.000_501_f64.to_radians());
                    }
                }
                Target::Pose { pose, branch, turns, .. } => {
                    prop_assert!(point.speed.is_some() && near(pose, &point.frame_from_tool));
                    prop_assert_eq!(*branch, BranchPattern::from(point.branch.unwrap()));
                    let turned = |joint: usize| {
                        let beyond = i32::from(point.joints[joint].abs() >= std::f64::consts::PI);
                        if point.joints[joint] < 0.0 { -beyond } else { beyond }
                    };
                    prop_assert_eq!(turns, &vec![turned(0), turned(3), turned(5)]);
                }
                Target::Elsewhere { .. } => panic!(),
            }
            // Whole cm/min: half of one is 0.0833 mm/s.
            moves_as_drafted(one, point, 0.084e-3);
        }
    }
}
