//! Our own listings and problems of wrong ones.

mod written;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_formats::convention::Convention;
use armill_programs::tp::read;
use armill_programs::{Frame, Motion, ProgramText, RobotProgram, Speed, Target};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::trials::{MICROMETRE, angle_of_decimals, cuts, moved_alone, problems, survives};

const LISTING: &str = "/PROG  DEBURR\tMacro\r
/ATTR\r
OWNER\t\t= MNEDITOR;\r
COMMENT\t\t= \"gr\u{fc}n\";\r
LINE_COUNT\t= 24;\r
/APPL\r
\r
/MN\r
   1:  !L P[99] 1x ; really ;\r
   2:  UFRAME_NUM=2 ;\r
   3:  UTOOL_NUM=1 ;\r
   4:J PR[1:Home] 100% FINE    ;\r
   5:J P[1:start] 20% CNT50    ;\r
   6:L P[2] 250mm/sec CNT100 ACC80    ;\r
   7:C P[3]    \r
    :  P[4] 600cm/min FINE    ;\r
   8:  PR[9,1]=100 ;\r
   9:  PR[9,2:side]=(-20.5) ;\r
  10:  PR[9,3]=0 ;\r
  11:  PR[9,4]=0 ;\r
  12:  PR[9,5]=0 ;\r
  13:  PR[9,6]=90 ;\r
  14:  UFRAME[2]=PR[9] ;\r
  15:L P[2] 100 inch/min FINE Offset,PR[5:side]    ;\r
  16:  UTOOL_NUM=3 ;\r
  17:A P[5] 50mm/sec CNT100    ;\r
  18:A P[6] 50mm/sec CNT100    ;\r
  19:A P[5] R[25:posuw L]mm/sec FINE    ;\r
  20:S P[6] WELD_SPEED FINE COORD    ;\r
  21:  UTOOL[3]=PR[8] ;\r
  22:L P[5] 2.0sec FINE    ;\r
  23:L P[R[3]] max_speed FINE TB    .10sec,P-SPS    ;\r
  24:  CALL OPEN_GRIPPER(1) ;\r
  25:  IF R[1]=1,JMP LBL[3] ;\r
       ------ ;\r
/POS\r
P[1:\"start\"]{\r
   GP1:\r
\tUF : 2, UT : 1,\t\r
\tJ1=     -.500 deg,\tJ2=   -30.000 deg,\tJ3=    30.000 deg,\r
\tJ4=     0.000 deg,\tJ5=    90.000 deg,\tJ6=     0.000 deg\r
   GP2:\r
\tUF : 2, UT : 1,\t\r
\tJ1=  -100.000  mm\r
};\r
P[2]{\r
   GP1:\r
\tUF : 2, UT : 1,\t\tCONFIG : 'F D B, 1, 0, -1',\r
\tX =  -11.218  mm,\tY =     1.367  mm,\tZ =      .041  mm,\r
\tW =      .000 deg,\tP =     -.131 deg,\tR =    -3.001 deg,\r
\tE1=   500.000  mm\r
};\r
P[3]{ GP1: UF : F, UT : F, CONFIG : 'N U T, 0, 0, 0',\r
\tX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg };\r
P[4]{\r
   GP1:\r
\tUF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\r
\tX =     5.000  mm,\tY =     6.000  mm,\tZ =     7.000  mm,\r
\tW =     0.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\r
};\r
P[5]{\r
   GP1:\r
\tUF : 0, UT : 3,\t\tCONFIG : 'N U T, 0, 0, 0',\r
\tX =     5.000  mm,\tY =     6.000  mm,\tZ =     7.000  mm,\r
\tW =   179.737 deg,\tP =    87.946 deg,\tR =    38.673 deg\r
};\r
P[6]{\r
   GP1:\r
\tUF : 0, UT : 3,\t\tCONFIG : 'N U T, 0, 0, 0',\r
\tX =     6.000  mm,\tY =     6.000  mm,\tZ =     7.000  mm,\r
\tW =   179.737 deg,\tP =    87.946 deg,\tR =    38.673 deg\r
};\r
P[9]{\r
   GP1:\r
\tUF : 0, UT : 3,\t\tCONFIG : 'N U T, 0, 0, 0',\r
\tX =  ********  mm,\tY =  ********  mm,\tZ =  ********  mm,\r
\tW =  ******** deg,\tP =  ******** deg,\tR =  ******** deg\r
};\r
/END\r
";

fn program(text: &str) -> RobotProgram {
    // Latin-1 bytes, as old controllers write them.
    let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
    read(vec![ProgramText::new("deburr.ls", &bytes)]).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn every_move_of_a_listing_is_read_with_its_frame_and_tool() {
    let program = program(LISTING);
    assert_eq!(program.name, "DEBURR");
    let said: Vec<(&str, Frame, Frame, Speed, u32)> = program
        .moves
        .iter()
        .map(|one| {
            let motion = match &one.motion {
                Motion::Joint => "joint",
                Motion::Linear => "straight",
                Motion::Circular { .. } => "arc",
            };
            (motion, one.frame, one.tool, one.speed, one.line)
        })
        .collect();
    let given = Frame::Given(
        Convention::Fanuc
            .pose(&[100.0, -20.5, 0.0, 0.0, 0.0, 90.0])
            .unwrap(),
    );
    let base = Frame::Given(Isometry::identity());
    let [one, two, three] = [1, 2, 3].map(Frame::Numbered);
    assert_eq!(
        said,
        [
            ("joint", two, one, Speed::Joints, 12),
            ("joint", two, one, Speed::Joints, 13),
            ("straight", two, one, Speed::Tip(0.25), 14),
            ("arc", two, one, Speed::Tip(0.1), 15),
            ("straight", given, one, Speed::Tip(2.54 / 60.0), 24),
            ("straight", base, three, Speed::Tip(0.05), 26),
            ("arc", base, three, Speed::Unknown, 28),
            ("straight", base, three, Speed::Unknown, 29),
            ("straight", base, three, Speed::Joints, 31),
            ("straight", given, three, Speed::Unknown, 32),
        ]
    );
    assert_eq!(
        [0, 9].map(|index| program.moves[index].target.clone()),
        ["PR[1:Home]", "P[R[3]]"].map(|name| Target::Elsewhere {
            name: name.to_owned()
        })
    );
    let joints: Vec<f64> = [-0.5, -30.0, 30.0, 0.0, 90.0, 0.0].map(f64::to_radians).to_vec();
    assert_eq!(program.moves[1].target, Target::Joints(joints));
    let Target::Pose { branch, turns, .. } = &program.moves[2].target else {
        panic!()
    };
    // Lower behind axis 1 is up in base z.
    assert_eq!(
        (branch.to_string().as_str(), turns.as_slice()),
        ("back elbow-up flip", [1, 0, -1].as_slice())
    );
    let Motion::Circular { via } = &program.moves[3].motion else {
        panic!()
    };
    assert_eq!(
        via.pose().unwrap().translation.vector,
        Vector3::new(1e-3, 2e-3, 3e-3)
    );
}

#[test]
fn ignored_statements_that_matter_are_noted_with_their_lines() {
    let notes = program(LISTING).notes;
    for words in [
        "deburr.ls, line 24: OFFSET of moves is ignored",
        "deburr.ls, line 26: positions of user frame 0 are used",
        "deburr.ls, line 29: S is read as straight",
        "deburr.ls, line 28: a speed from a register",
        "deburr.ls, line 29: a speed that the program does not give",
        "deburr.ls, line 29: COORD of moves is ignored",
        "deburr.ls, line 33: OPEN_GRIPPER is called, but not given",
        "deburr.ls, line 34: IF is ignored",
        "deburr.ls, line 42: further motion groups",
        "deburr.ls, line 51: extended axes",
    ] {
        assert!(
            notes.iter().any(|note| note.starts_with(words)),
            "{words}: {notes:#?}"
        );
    }
    assert_eq!(notes.len(), 10, "{notes:#?}");
}

#[test]
fn other_poses_change_only_the_numbers_of_positions() {
    let program = program(LISTING);
    let within = [MICROMETRE, angle_of_decimals(3)];
    let again = moved_alone(&program, &Isometry::identity(), within);
    let text = again.texts[0].text();
    assert!(text.contains("\tX =  -11.218  mm,\tY =     1.367  mm,\tZ =     0.041  mm,\r\n"));
    assert!(text.contains("\tX = 1.000 mm, Y = 2.000 mm, Z = 3.000 mm, W = 0 deg, P = 0 deg, R = 0 deg };"));
    let by = Isometry::new(Vector3::new(1e-4, -2e-5, 3.3e-5), Vector3::new(0.01, 0.02, -0.03));
    moved_alone(&program, &by, within);
    let bytes: Vec<u8> = LISTING.chars().map(|c| c as u8).collect();
    assert_eq!(
        program.with_poses(&[]).unwrap(),
        [("deburr.ls".to_owned(), bytes)]
    );
}

#[test]
fn a_called_program_is_read_at_its_first_call_with_the_current_frames() {
    let main = "/PROG MAIN\n/MN\n1:  PR[1]=P[1] ;\n2:  UTOOL[4]=PR[1] ;\n3:  CALL SUB ;\n4:  CALL SUB ;\n/POS\nP[1]{\nUF : 0, UT : 0,\nX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg\n};\n/END\n";
    let sub = "/PROG SUB\n/MN\n1:L P[1] 1mm/sec FINE ;\n/POS\nP[1]{\nUF : 0, UT : 4,\nX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg\n};\n/END\n";
    let texts = [("a.ls", main), ("b.ls", sub)];
    let program = read(
        texts
            .map(|(name, text)| ProgramText::new(name, text.as_bytes()))
            .to_vec(),
    )
    .unwrap();
    let tool = Convention::Fanuc.pose(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.0]).unwrap();
    assert_eq!(
        (program.moves.len(), program.moves[0].tool),
        (1, Frame::Given(tool))
    );
    assert_eq!(
        program.notes,
        ["a.ls, line 6: SUB is called again: it is read once"]
    );
}

#[test]
fn every_mistake_has_its_message() {
    let pose = |values: &str| format!("P[3]{{\n   GP1:\n\tUF : 0, UT : 1,\n{values}\n}};\n");
    let good = "\tX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg";
    let listing = |position: &str, moves: &str| {
        let one = pose(good).replace("P[3]", "P[1]");
        let other = pose(good).replace("P[3]", "P[2]").replace("UT : 1", "UT : 2");
        format!("/PROG A\n/MN\n   1:{moves} ;\n/POS\n{one}{other}{position}/END\n")
    };
    for (position, moves, sentence) in [
        (
            pose(&good.replace("Y = 2", "Y = x")),
            "L P[3] 1mm/sec FINE",
            "a.ls:18:16: `x` is not a number of Y in P[3]",
        ),
        (
            pose(&good.replace("Y = 2", "Y = ****")),
            "L P[3] 1mm/sec FINE",
            "a.ls:3:8: P[3] has no usable position: its Y was never taught",
        ),
        (
            pose("\tX = 1 mm"),
            "L P[3] 1mm/sec FINE",
            "P[3] has no usable position: it has no Y, Z, W, P, R",
        ),
        (
            pose("\tJ1 = 1 deg, J3 = 2 deg"),
            "J P[3] 1% FINE",
            "some of its joints are not given",
        ),
        (
            pose(&good.replace("Y = 2", "X = 2")),
            "L P[1] 1mm/sec FINE",
            "X is given twice in P[3]",
        ),
        (
            pose(&good.replace("Y = 2", "Y = 2e12")),
            "L P[1] 1mm/sec FINE",
            "the position P[3] is not a valid pose: 2e12 is beyond",
        ),
        (
            pose(good).replace("P[3]", "P[1]"),
            "L P[1] 1mm/sec FINE",
            "the position P[1] is given twice",
        ),
        (
            pose(good).replace("P[3]", "P[x]"),
            "L P[1] 1mm/sec FINE",
            "`x` is not a number of a position",
        ),
        (
            "P[3]{\n".to_owned(),
            "L P[1] 1mm/sec FINE",
            "the position P[3] has no end",
        ),
        (
            String::new(),
            "L P[7:a b] 1mm/sec FINE",
            "a.ls:3:8: the position P[7] is not in this listing",
        ),
        (
            String::new(),
            "L P[1] 1x0mm/sec FINE",
            "`1x0` is not a valid speed",
        ),
        (String::new(), "L P[1] -5mm/sec FINE", "`-5` is not a valid speed"),
        (
            String::new(),
            "Q P[1] 5mm/sec FINE",
            "the move `Q` is not followed",
        ),
        (
            String::new(),
            "C P[1] 5mm/sec FINE",
            "`5mm/sec` is not a position",
        ),
        (
            String::new(),
            "C P[1] P[2] 5mm/sec FINE",
            "the positions of this arc are relative to different frames",
        ),
        (String::new(), "L P[1] 5mm/sec FINE INC", "is incremental (INC)"),
        (
            String::new(),
            "L P[1] 5mm/sec FINE RTCP",
            "has a stationary tool (RTCP)",
        ),
        (
            String::new(),
            "A P[1] 5mm/sec FINE",
            "this row of A has fewer than three positions",
        ),
        (
            String::new(),
            "A P[1] 5mm/sec FINE ;\n2:A P[1] 5mm/sec FINE ;\n3:A P[1] 5mm/sec FINE ;\n4:A P[1] 5mm/sec FINE",
            "a.ls:6:3: a fourth A in a row",
        ),
    ] {
        let found = problems(&[("a.ls", &listing(&position, moves))]);
        assert!(
            found.len() == 1 && found[0].contains(sentence),
            "{sentence}: {found:?}"
        );
    }
    assert!(problems(&[("a.ls", "hello")])[0].contains("this is not a listing of a FANUC program"));
}

#[test]
fn a_german_listing_is_read_too() {
    let text = "/PROG A\n/MN\n   1:  WKZ_NUM=3 ;\n   2:  BENUTZER_NUM=2 ;\n   3:L P[1] 250mm/sek CNT0 ZEIT VOR   0.00sek,P-SPS    ;\n   4:  AUFRUF B    ;\n/POS\nP[1]{\n   GP1:\n\tUF : F, UT : F,\n\tX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg\n};\n/END\n";
    let program = read(vec![ProgramText::new("a.ls", text.as_bytes())]).unwrap();
    let one = &program.moves[0];
    assert_eq!(
        (one.frame, one.tool, one.speed),
        (Frame::Numbered(2), Frame::Numbered(3), Speed::Tip(0.25))
    );
    assert_eq!(
        program.notes,
        ["a.ls, line 6: B is called, but not given: it is ignored"]
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn what_was_cut_into_is_refused_or_read_again_as_it_was(cuts in cuts()) {
        survives(&[("deburr.ls", LISTING)], &cuts);
    }
}
