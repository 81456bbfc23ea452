//! Our own projects, problems of wrong ones, and drafts that are read back.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::BranchPattern;
use armill_formats::convention::Convention;
use armill_programs::val3::{read, write};
use armill_programs::{Frame, Motion, ProgramText, RobotProgram, Speed, Target};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::drafts::{Writes, drafts, every_step, long, notes_only, read_back, spaced, text_of};
use crate::trials::{
    MICROMETRE, angle_of_decimals, apart, cuts, moved_alone, moves_as_drafted, problems, survives,
};

const PROJECT: &str = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\r
<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">\r
  <Parameters version=\"s7.3.1\" stackSize=\"5000\" millimeterUnit=\"true\" />\r
</Project>\r
";

const DATA: &str = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\r
<Database xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\r
  <!-- <Value key=\"7\" x=\"none\" /> f\u{fc}r -->\r
  <Datas>\r
    <Data name=\"fPart\" access=\"public\" xsi:type=\"array\" type=\"frame\" size=\"2\">\r
      <Value key=\"0\" x=\"600.000\" rz=\"90.000\" fatherId=\"world[0]\" />\r
      <Value key=\"1\" x=\"10.000\" fatherId=\"fPart[0]\" />\r
    </Data>\r
    <Data name=\"jPark\" access=\"public\" xsi:type=\"array\" type=\"jointRx\" size=\"1\">\r
      <Value key=\"0\" j3=\"90\" j5=\"90\" />\r
    </Data>\r
    <Data name=\"mSlow\" access=\"public\" xsi:type=\"array\" type=\"mdesc\" size=\"2\">\r
      <Value key=\"0\" tmax=\"50\" rmax=\"100\" blend=\"cartesian\" leave=\"0.1\" reach=\"0.1\" />\r
      <Value key=\"1\" vel=\"20\" tmax=\"99999\" />\r
    </Data>\r
    <Data name=\"nTraj\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"1\"/>\r
    <Data name=\"pPoint\" access=\"public\" xsi:type=\"array\" type=\"pointRx\" size=\"5\">\r
      <Value key=\"0\" x=\"-36.802\" y=\"-6.159\" z=\"500.000\" rx=\"135.407\" ry=\"80.416\" rz=\"46.453\" shoulder=\"righty\" elbow=\"enegative\" wrist=\"wnegative\" fatherId=\"fPart[1]\" />\r
      <Value key=\"1\" x=\"1\" shoulder=\"lefty\" elbow=\"epositive\" wrist=\"wfree\" fatherId=\"fPart[1]\" />\r
      <Value key=\"2\" rz='-.5' fatherId=\"fPart[1]\" />\r
      <Value key=\"3\" />\r
    </Data>\r
    <Data name=\"pNamed\" access=\"public\" xsi:type=\"collection\" type=\"pointRx\">\r
      <Value key=\"safe\" z=\"900\" />\r
    </Data>\r
    <Data name=\"tTool\" access=\"public\" xsi:type=\"array\" type=\"tool\" size=\"1\">\r
      <Value key=\"0\" z=\"120.5\" fatherId=\"flange[0]\" ioLink=\"valve1\" />\r
    </Data>\r
  </Datas>\r
</Database>\r
";

const START: &str = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\r
<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\r
  <Program name=\"start\" access=\"public\">\r
    <Locals>\r
      <Local name=\"l_pUp\" type=\"pointRx\" xsi:type=\"array\" size=\"1\" />\r
    </Locals>\r
    <Code><![CDATA[begin\r
  // movel(pGone[0],tTool,mSlow)\r
  putln(\"movel(pGone[0],\")\r
  nTraj=movej(jPark,tTool[0],mSlow)\r
  movel(pPoint[0], tTool[0], mSlow[0])\r
  movec(pPoint[1],pPoint[2],\r
        flange,mSlow[1])\r
  movel(appro(pPoint[0],{0,0,-50,0,0,0}),tTool,mSlow)\r
  for i=0 to 3\r
    movel(pPoint[i],tOther,mOther)\r
  endFor\r
  movej(l_pUp,tTool,mSlow)\r
  pPoint[3].trsf.x=20\r
  movel(pPoint[3],tTool,mSlow)\r
  movej(pNamed[\"safe\"],tTool,mSlow)\r
  call cut(1)\r
  call prog:valve()\r
end]]></Code>\r
  </Program>\r
</Programs>\r
";

const CUT: &str = "<Programs><Program name=\"cut\"><Code><![CDATA[begin\n  movel(pPoint[1],tTool,mSlow)\nend]]></Code></Program></Programs>";

fn texts(files: &[(&str, &str)]) -> Vec<ProgramText> {
    files
        .iter()
        .map(|(name, text)| ProgramText::new(name, text.as_bytes()))
        .collect()
}

fn program() -> RobotProgram {
    let files = [
        ("part/part.pjx", PROJECT),
        ("part/part.dtx", DATA),
        ("part/cut.pgx", CUT),
        ("part/start.pgx", START),
    ];
    read(texts(&files)).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn every_move_of_a_project_is_read_with_its_data() {
    let program = program();
    assert_eq!(program.name, "part");
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
    let staubli = |numbers: [f64; 6]| Frame::Given(Convention::Staubli.pose(&numbers).unwrap());
    let base = Frame::Given(Isometry::identity());
    let part = Frame::Given(
        Convention::Staubli
            .pose(&[600.0, 0.0, 0.0, 0.0, 0.0, 90.0])
            .unwrap()
            * Convention::Staubli
                .pose(&[10.0, 0.0, 0.0, 0.0, 0.0, 0.0])
                .unwrap(),
    );
    let tool = staubli([0.0, 0.0, 120.5, 0.0, 0.0, 0.0]);
    assert_eq!(
        said,
        [
            ("joint", Frame::Unknown, tool, Speed::Joints, 10),
            ("straight", part, tool, Speed::Tip(0.05), 11),
            ("arc", part, base, Speed::Joints, 12),
            ("straight", Frame::Unknown, tool, Speed::Tip(0.05), 14),
            ("straight", Frame::Unknown, Frame::Unknown, Speed::Unknown, 16),
            ("joint", Frame::Unknown, tool, Speed::Joints, 18),
            ("straight", base, tool, Speed::Tip(0.05), 20),
            ("joint", base, tool, Speed::Joints, 21),
            ("straight", part, tool, Speed::Tip(0.05), 2),
        ]
    );
    let names: Vec<&str> = program
        .moves
        .iter()
        .filter_map(|one| match &one.target {
            Target::Elsewhere { name } => Some(name.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(names, ["appro(pPoint[0],{0,0,-50,0,0,0})", "pPoint[i]", "l_pUp"]);
    let joints = [0.0, 0.0, 90_f64.to_radians(), 0.0, 90_f64.to_radians(), 0.0];
    assert_eq!(program.moves[0].target, Target::Joints(joints.to_vec()));
    let branches: Vec<String> = program
        .moves
        .iter()
        .filter_map(|one| match &one.target {
            Target::Pose { branch, .. } => Some(branch.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(
        branches,
        ["back elbow-up flip", "any", "any", "any", "front elbow-up"]
    );
}

#[test]
fn ignored_statements_that_matter_are_noted_with_their_lines() {
    let notes = program().notes;
    for words in [
        "part/start.pgx, line 15: for is ignored",
        "part/start.pgx, line 16: the tool `tOther` is not in the data",
        "part/start.pgx, line 16: the move description `mOther` is not in the data",
        "part/start.pgx, line 19: the assignment to pPoint is ignored",
        "part/start.pgx, line 23: prog:valve is called, but not given",
    ] {
        assert!(
            notes.iter().any(|note| note.starts_with(words)),
            "{words}: {notes:#?}"
        );
    }
    assert_eq!(notes.len(), 5, "{notes:#?}");
}

#[test]
fn other_poses_change_only_the_numbers_of_points() {
    let program = program();
    let within = [MICROMETRE, angle_of_decimals(4)];
    let again = moved_alone(&program, &Isometry::identity(), within);
    let text = again.texts[1].text();
    // Zeros that were left out are not written, unchanged orientations are not rewritten.
    for line in [
        "<Value key=\"0\" x=\"-36.802\" y=\"-6.159\" z=\"500.000\" rx=\"135.407\" ry=\"80.416\" rz=\"46.453\" shoulder=\"righty\" \
         elbow=\"enegative\" wrist=\"wnegative\" fatherId=\"fPart[1]\" />\r\n",
        "<Value key=\"1\" x=\"1.000\" shoulder=\"lefty\" elbow=\"epositive\" wrist=\"wfree\" fatherId=\"fPart[1]\" />\r\n",
        "<Value key=\"2\" rz='-.5' fatherId=\"fPart[1]\" />\r\n",
        "<Value key=\"3\" />\r\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let by = Isometry::new(Vector3::new(1e-4, -2e-5, 3.3e-5), Vector3::new(0.01, 0.02, -0.03));
    let again = moved_alone(&program, &by, within);
    assert!(
        again.texts[1]
            .text()
            .contains("shoulder=\"lefty\" elbow=\"epositive\" wrist=\"wfree\" fatherId=\"fPart[1]\" />")
    );
    let files = program.with_poses(&[]).unwrap();
    let written = [PROJECT, DATA, CUT, START].map(|text| text.as_bytes().to_vec());
    assert_eq!(
        files.into_iter().map(|(_, bytes)| bytes).collect::<Vec<_>>(),
        written
    );
}

#[test]
fn every_mistake_has_its_message() {
    let project = |data: &str, code: &str| {
        let data = format!(
            "<Database><Datas>\n<Data name=\"p\" type=\"pointRx\">\n<Value key=\"0\" />\n{data}\n</Data>\n</Datas></Database>"
        );
        problems(&[("a.dtx", &data), ("start.pgx", code)])
    };
    for (data, code, sentence) in [
        (
            "<Value key=\"1\" x=\"1,5\" />",
            "",
            "a.dtx:4:19: `1,5` is not a number: x of p[1]",
        ),
        (
            "<Value key=\"1\" x=\"1e12\" />",
            "",
            "p[1] is not a valid pose: 1e12 is beyond",
        ),
        ("<Value key=\"0\" />", "", "p[0] is given twice"),
        ("<Value key=\"1", "", "a.dtx:4:1: this tag does not end"),
        (
            "<valuePoint index=\"0\">",
            "",
            "the data of an older project (s6) cannot be read",
        ),
        (
            "",
            "movel(p[1],flange,m)",
            "start.pgx:1:7: `p[1]` has no value in the data (.dtx)",
        ),
        ("", "movel(q,flange,m)", "`q` is not in the data (.dtx)"),
        (
            "</Data><Data name=\"f\" type=\"frame\"><Value key=\"0\" />",
            "movel(f,flange,m)",
            "`f` is neither a point nor joints",
        ),
        (
            "</Data><Data name=\"f\" type=\"frame\"><Value key=\"0\" /></Data><Data name=\"g\" type=\"pointRx\"><Value x=\"1\" fatherId=\"f\" /></Data><Data name=\"g2\" type=\"frame\"><Value key=\"0\" x=\"1\"/></Data><Data name=\"h\" type=\"pointRx\"><Value fatherId=\"g2\" />",
            "movec(g,h,flange,m)",
            "the points of this arc are relative to different frames",
        ),
        ("", "movel(p)", "`movel` with 1 arguments"),
        ("", "movel(p,flange,m", "the bracket of `movel` is not closed"),
        (
            "",
            "x=$Xmovej(p,n,flange,m)",
            "the move `$Xmovej` is not followed",
        ),
    ] {
        let found = project(data, code);
        assert!(
            found.len() == 1 && found[0].contains(sentence),
            "{sentence}: {found:?}"
        );
    }
    let inches = PROJECT.replace("\"true\"", "\"false\"");
    assert!(problems(&[("a.pjx", &inches), ("start.pgx", "")])[0].contains("this project uses inches"));
    assert!(problems(&[("a.pjx", PROJECT)])[0].contains("no program (.pgx) is among these files"));
    let circle = "<Database><Data name=\"f\" type=\"frame\"><Value fatherId=\"f\" /></Data><Data name=\"p\" type=\"pointRx\"><Value fatherId=\"f\" /></Data></Database>";
    let program = read(texts(&[("a.dtx", circle), ("start.pgx", "x=movel(p,flange,m)")])).unwrap();
    assert_eq!(program.moves[0].frame, Frame::Unknown);
}

#[test]
fn a_long_program_is_split_and_read_as_one() {
    let written = write(&long(4001)).unwrap();
    let names: Vec<&str> = written.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "PLATE.pjx",
            "PLATE.dtx",
            "start.pgx",
            "part001.pgx",
            "part002.pgx",
            "part003.pgx",
            "stop.pgx"
        ]
    );
    let program = read_back(&written);
    assert_eq!(program.moves.len(), 4001);
    notes_only(&program, &[]);
}

#[test]
fn moves_blend_as_specified_and_the_last_one_stops() {
    let mut draft = spaced(4, 10.0);
    draft.controller.joint_acceleration = Some(0.5);
    let written = write(&draft).unwrap();
    let [data, start] = [1, 2].map(|file| text_of(&written, file));
    for described in [
        "<Value key=\"0\" accel=\"50\" vel=\"10\" decel=\"50\" tmax=\"99999\" rmax=\"99999\" blend=\"cartesian\" leave=\"0.500\" reach=\"0.500\" />",
        "<Value key=\"1\" accel=\"100\" vel=\"100\" decel=\"100\" tmax=\"50.000\" rmax=\"99999\" blend=\"cartesian\" leave=\"0.500\" reach=\"0.500\" />",
        "<Value key=\"2\" accel=\"100\" vel=\"100\" decel=\"100\" tmax=\"50.000\" rmax=\"99999\" blend=\"off\" leave=\"0.000\" reach=\"0.000\" />",
    ] {
        assert!(data.contains(described), "{data}");
    }
    assert!(start.contains("mSpeed[1])\r\n  nTraj=movel(pPoint[1]"), "{start}");
    assert!(start.contains("mSpeed[2])\r\n  waitEndMove()"), "{start}");
}

#[test]
fn every_kind_of_step_has_its_statement() {
    let mut draft = every_step("doValve=true");
    draft.controller.header = vec!["doSpindle=true".to_owned()];
    draft.controller.footer = vec!["doSpindle=false".to_owned()];
    let written = write(&draft).unwrap();
    let [data, start] = [1, 2].map(|file| text_of(&written, file));
    let to =
        |of: &str, target: usize, pace: usize| format!("  nTraj={of}[{target}],tTool[2],mSpeed[{pace}])\r\n");
    let [first, last] = [to("movej(jJoint", 0, 0), to("movej(jJoint", 1, 3)];
    let [one, two, three] = [(0, 1), (1, 2), (2, 2)].map(|(target, pace)| to("movel(pPoint", target, pace));
    let expected = format!(
        "  doSpindle=true\r\n  // approach\r\n{first}{one}  // corner\r\n  // of the part\r\n{two}  waitEndMove()\r\n  \
         delay(1.500)\r\n  doValve=true\r\n{three}  waitEndMove()\r\n  userPage()\r\n  cls()\r\n  \
         putln(\"change the tool\")\r\n  nTraj=get()\r\n{last}  waitEndMove()\r\n  doSpindle=false\r\nend]]></Code>"
    );
    assert!(start.contains(&expected), "{start}\n{expected}");
    let joints = "<Value key=\"1\" j1=\"-46.18419\" j2=\"-6.77518\" j3=\"-20.54925\" j4=\"71.38674\" j5=\"49.58727\" j6=\"-302.54752\" />";
    assert!(data.contains(joints), "{data}");
    assert!(
        data.contains("name=\"jJoint\" access=\"private\" xsi:type=\"array\" type=\"jointRx\" size=\"2\""),
        "{data}"
    );
}

const WRITES: Writes = Writes {
    external: 0,
    statement: "doValve=true",
};

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn what_was_cut_into_is_refused_or_read_again_as_it_was(cuts in cuts()) {
        survives(&[("a.pjx", PROJECT), ("a.dtx", DATA), ("cut.pgx", CUT), ("start.pgx", START)], &cuts);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_as_it_was(draft in drafts(WRITES)) {
        let written = write(&draft).unwrap();
        let program = read_back(&written);
        prop_assert_eq!(&program.name, &draft.name);
        prop_assert_eq!(program.moves.len(), draft.points().count());
        notes_only(&program, &[]);
        let near = |one: &Isometry, other: &Isometry| {
            let [far, turned] = apart(one, other);
            far <= MICROMETRE && turned <= angle_of_decimals(4)
        };
        for (one, point) in program.moves.iter().zip(draft.points()) {
            let Frame::Given(tool) = one.tool else { panic!() };
            prop_assert!(near(&tool, &draft.flange_from_tool));
            match &one.target {
                Target::Joints(joints) => {
                    prop_assert!(point.speed.is_none());
                    for (joint, given) in joints.iter().zip(&point.joints) {
                        // Five decimals of a degree.
                        prop_assert!((joint - given).abs() <= 0.000_005_01_f64.to_radians());
                    }
                }
                Target::Pose { pose, branch, .. } => {
                    let Frame::Given(frame) = one.frame else { panic!() };
                    prop_assert!(point.speed.is_some() && near(pose, &point.frame_from_tool) && near(&frame, &draft.base_from_frame));
                    prop_assert_eq!(*branch, BranchPattern::from(point.branch.unwrap()));
                }
                Target::Elsewhere { .. } => panic!(),
            }
            // Three decimals of mm/s.
            moves_as_drafted(one, point, 0.501e-6);
        }
    }
}
