//! ABB RAPID.

mod written;

use std::f64::consts::FRAC_1_SQRT_2;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use armill_core::robot::BranchPattern;
use armill_programs::{Frame, Language, Motion, RobotProgram, Speed, Target, write};
use proptest::prelude::*;

use crate::drafts::{Says, Writes, drafts, long, read_back, reads_back};
use crate::rewriting::{keeps_the_rest, near, rewritten};
use crate::same_poses::{kuka, same, sample};
use crate::{problems, program, refused};

/// A pose of mm and a quaternion, without the code under test.
fn abb([x, y, z]: [f64; 3], [w, i, j, k]: [f64; 4]) -> Isometry {
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    Isometry::from_parts(Translation3::new(x * 1e-3, y * 1e-3, z * 1e-3), turn)
}

/// Data in a module of their own, as programs taught on the pendant have them.
const MAIN: &str = "MODULE MainModule\r\n  PERS tooldata tSpindle:=[TRUE,[[10,0,200.5],[0.707106781,0,0.707106781,0]],[5,[0,0,80],[1,0,0,0],0,0,0]];\r\n\
  TASK PERS wobjdata wTable:=[FALSE,TRUE,\"\",[[1000,0,500],[1,0,0,0]],[[0,0,50],[0,0,0,1]]];\r\n\
  CONST robtarget p10:=[[100,200,300],[1,0,0,0],[-1,0,1,4],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]; ! \u{fc}ber dem Tisch\r\n\
  CONST robtarget pGrid{2}:=[[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\r\n\
    [[4,5,6],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];\r\n\
  CONST jointtarget jHome:=[[0,-10,20,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\r\n\
  VAR speeddata vCut:=[33.5,500,5000,1000];\r\n\
  PROC main()\r\n    ConfL\\Off;\r\n    MoveAbsJ jHome\\NoEOffs,v1000,fine,tSpindle;\r\n\
    MoveJ p10,vmax,z50,tSpindle\\WObj:=wTable;\r\n    IF di1=1 THEN\r\n\
    MoveL Offs(p10,0,0,-50),vCut,z1,tSpindle\\WObj:=wTable;\r\n    ENDIF\r\n\
    IF di1=1 MoveL RelTool(p10,10,0,0\\Ry:=90)\\ID:=4,v100\\V:=12,fine,tSpindle\\WObj:=wTable;\r\n\
    TriggL pGrid{2}, v50, trig1, z0, tSpindle\\WObj:=wTable;\r\n\
    MoveC pGrid{1},p10,v20,z10,tool0;\r\n    Zange 5;\r\n  ENDPROC\r\nENDMODULE\r\n";

fn of(lines: &str) -> RobotProgram {
    program(&[("a.mod", &module(lines))]).unwrap()
}

/// A routine of these lines.
fn module(lines: &str) -> String {
    format!("MODULE M\n{lines}\nENDMODULE\n")
}

/// That these lines are refused with one problem.
fn wrong(lines: &str, part: &str) {
    refused(&[("a.mod", &module(lines))], part);
}

/// A robtarget, and what follows one.
const P: &str = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
const REST: &str = "v100,fine,tool0";

#[test]
fn the_sample_has_its_joints_poses_arcs_frames_and_postures() {
    let Some(program) = sample("ABB_RAPID_IRC5.mod") else {
        return;
    };
    assert_eq!(program.name, "Prog1");
    assert!(program.moves.len() >= 12);
    let Target::Joints(joints) = &program.moves[1].target else {
        panic!()
    };
    for (joint, expected) in joints
        .iter()
        .zip([22.50953, 5.58534, 8.15717, 67.51143, -24.42689, -64.06258])
    {
        // Six decimals are printed, and so read.
        assert!((joint.to_degrees() - expected).abs() < 1e-9);
    }
    let first = &program.moves[2];
    let Target::Pose {
        pose, branch, turns, ..
    } = &first.target
    else {
        panic!()
    };
    let quaternion = [0.03023582, -0.26288229, -0.96431880, 0.00824257];
    same(pose, &abb([2065.662, 1074.198, 1358.820], quaternion));
    assert_eq!(
        (branch.to_string().as_str(), turns.as_slice()),
        ("front elbow-up flip", &[0, 0, -1][..])
    );
    assert_eq!((&first.motion, first.speed), (&Motion::Linear, Speed::Tip(0.1)));
    let (Frame::Given(frame), Frame::Given(tool)) = (first.frame, first.tool) else {
        panic!()
    };
    same(&frame, &Isometry::identity());
    same(
        &tool,
        &abb([380.0, 0.0, 200.0], [FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2, 0.0]),
    );
    let arc = &program.moves[3];
    let Motion::Circular { via } = &arc.motion else {
        panic!()
    };
    let across = [0.03133919, 0.0, -0.99950881, 0.0];
    same(via.pose().unwrap(), &abb([2468.239, 1130.615, 1333.550], across));
    let end = [0.32083668, 0.0, -0.94713454, 0.0];
    same(
        arc.target.pose().unwrap(),
        &abb([2457.129, 797.242, 1156.545], end),
    );
    let last = program.moves.last().unwrap();
    same(
        last.target.pose().unwrap(),
        &abb([2147.782, 275.581, 1772.907], across),
    );
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.contains("`ArcLStart` is called"))
    );
    keeps_the_rest(&program, |pose| *pose);
    let by = kuka([0.5, -0.25, 0.125, 1.0, 2.0, 3.0]);
    keeps_the_rest(&program, |pose| by * pose);
}

#[test]
fn names_are_resolved_to_targets_tools_work_objects_and_speeds() {
    let program = program(&[("main.mod", MAIN)]).unwrap();
    assert_eq!(program.name, "main");
    let [home, first, offset, turned, grid, arc] = program.moves.as_slice() else {
        panic!("{:?}", program.moves);
    };
    let Target::Joints(joints) = &home.target else {
        panic!()
    };
    assert_eq!(
        joints
            .iter()
            .map(|joint| joint.to_degrees().round())
            .collect::<Vec<_>>(),
        [0.0, -10.0, 20.0, 0.0, 30.0, 0.0]
    );
    let Target::Pose { branch, turns, .. } = &first.target else {
        panic!()
    };
    assert_eq!(
        (branch.to_string().as_str(), turns.as_slice()),
        ("back elbow-down no-flip", &[-1, 0, 1][..])
    );
    assert_eq!(first.motion, Motion::Joint);
    let none = [1.0, 0.0, 0.0, 0.0];
    let (Frame::Given(frame), Frame::Given(tool)) = (first.frame, first.tool) else {
        panic!()
    };
    // uframe, then oframe: half a turn about z.
    same(&frame, &abb([1000.0, 0.0, 550.0], [0.0, 0.0, 0.0, 1.0]));
    let half = 0.5_f64.sqrt();
    same(&tool, &abb([10.0, 0.0, 200.5], [half, 0.0, half, 0.0]));
    same(offset.target.pose().unwrap(), &abb([100.0, 200.0, 250.0], none));
    assert_eq!((offset.speed, offset.line), (Speed::Tip(0.0335), 14));
    same(
        turned.target.pose().unwrap(),
        &abb([110.0, 200.0, 300.0], [half, 0.0, half, 0.0]),
    );
    assert_eq!(turned.speed, Speed::Tip(0.012));
    same(grid.target.pose().unwrap(), &abb([4.0, 5.0, 6.0], none));
    let Motion::Circular { via } = &arc.motion else {
        panic!()
    };
    same(via.pose().unwrap(), &abb([1.0, 2.0, 3.0], none));
    assert_eq!(arc.tool, Frame::Given(Isometry::identity()));
    for part in ["line 13: `IF`: its body is read once", "`Zange` is called"] {
        assert!(
            program.notes.iter().any(|note| note.contains(part)),
            "{:?}",
            program.notes
        );
    }
}

#[test]
fn targets_with_offsets_are_written_in_full_with_the_posture_of_their_base() {
    let program = program(&[("main.mod", MAIN)]).unwrap();
    let (files, _) = rewritten(&program, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    for part in [
        "p10:=[[100.000,200.000,300.000],[1,0,0,0],[-1,0,1,4],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]; ! \u{fc}ber dem Tisch\r\n",
        "MoveL [[100.000,200.000,250.000],[1.00000000,0.00000000,0.00000000,0.00000000],p10.robconf,p10.extax],vCut,z1,",
        "\\ID:=4,v100\\V:=12,fine",
        "],\r\n[[4.000,5.000,6.000],[1,",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    // The rest is as it was where no place leans on another.
    let plain = of(&format!(
        "CONST robtarget p1:={P};\nPROC a()\nMoveL p1,{REST};\nMoveL [ [1 ,2, -3.12345],[0.6,0,0.8,0] ,[0,1,-2,1],[9E9,9E9,9E9,9E9,9E9,9E9]],{REST};\nENDPROC"
    ));
    let by = kuka([0.1, 0.2, 0.3, 10.0, 20.0, 30.0]);
    keeps_the_rest(&plain, |pose| by * pose);
    let files = keeps_the_rest(&plain, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    let expected = "MoveL [ [1.000 ,2.000, -3.12345],[0.6,0,0.8,0] ,[0,1,-2,1],";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn assigned_parts_are_written_where_they_are_used() {
    let lines = format!(
        "VAR robtarget p1:={P};\nPROC a()\np1.trans.z:=30;\nMoveL p1,{REST};\np1:=[[7,8,9],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         MoveL p1,{REST};\np1:=Offs(p1,1,0,0);\nENDPROC"
    );
    let program = of(&lines);
    let z = |index: usize| program.moves[index].target.pose().unwrap().translation.z;
    // mm become m with one rounding.
    assert!((z(0) - 0.03).abs() < 1e-15 && (z(1) - 0.009).abs() < 1e-15);
    let (files, _) = rewritten(&program, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(text.contains("MoveL [[1.000,2.000,30.000],[1.00000000,0.00000000,0.00000000,0.00000000],p1.robconf,p1.extax],v100"), "{text}");
    assert!(text.contains("\nMoveL p1,v100"), "{text}");
}

#[test]
fn modules_share_names_and_prefer_their_own() {
    let one = "MODULE A\nLOCAL CONST robtarget p1:=[[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC a()\nMoveL p1,v100,fine,tool0;\nMoveL p2,v100,fine,tool0;\nb;\nENDPROC\nENDMODULE\n";
    let two = "MODULE B\nLOCAL CONST robtarget p1:=[[2,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nCONST robtarget p2:=[[3,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC b()\nMoveL p1,v100,fine,tool0;\nENDPROC\nENDMODULE\n";
    let program = program(&[("a.mod", one), ("b.mod", two)]).unwrap();
    let x: Vec<f64> = program
        .moves
        .iter()
        .map(|of| of.target.pose().unwrap().translation.x)
        .collect();
    assert_eq!(x, [0.001, 0.003, 0.002]);
    assert!(
        program.notes[0].contains("`b` is called: its moves are read once"),
        "{:?}",
        program.notes
    );
    let by = kuka([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    keeps_the_rest(&program, |pose| by * pose);
}

#[test]
fn undeclared_tools_and_work_objects_are_unknown() {
    let program = of(&format!(
        "PROC a()\nMoveL {P},v100,fine,tGrip\\WObj:=wFixture;\nENDPROC"
    ));
    assert_eq!(
        (program.moves[0].frame, program.moves[0].tool),
        (Frame::Unknown, Frame::Unknown)
    );
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.contains("`tGrip` is not given as numbers"))
    );
}

#[test]
fn every_problem_is_reported_with_its_position_and_a_hint() {
    let still = "PERS tooldata t:=[FALSE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];";
    let on_flange = "PERS wobjdata w:=[TRUE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];";
    for (data, line, part) in [
        (
            "",
            "MoveL p10,v100,fine,tool0;".to_owned(),
            "4:7: `p10` is not defined: no given module declares it",
        ),
        (
            "",
            "MoveL [[1.2.3,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;".to_owned(),
            "4:9: `1.2.3` is not a number",
        ),
        (
            "",
            "MoveL [[1,2,3],[1,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;".to_owned(),
            "the quaternion has length 1.4142",
        ),
        (
            "",
            "MoveL [[1,2],[1,0,0,0],[0,0,0,0],[9E9]],v100,fine,tool0;".to_owned(),
            "is computed while the program runs, or is not a valid target",
        ),
        (
            "",
            format!("MoveL [[1,2,x],[1,0,0,0]],{REST};"),
            "is computed while the program runs",
        ),
        (
            "",
            format!("MoveL CRobT(),{REST};"),
            "`CRobT()` is computed while the program runs",
        ),
        ("", format!("MoveL *,{REST};"), "`*` is computed while"),
        ("", format!("MoveL [[1,2,3],{REST};"), "`]` is missing here"),
        (
            "",
            format!("MoveL {P}],{REST};"),
            "one closing bracket too many in this MoveL",
        ),
        ("", format!("MoveL {P},v100,fine;"), "3 arguments of `MoveL`"),
        (
            "",
            format!("MoveL {P}\\:=3,{REST};"),
            "the name of an argument is missing after this",
        ),
        ("", format!("MoveL p{{1,{REST};"), "`}` is missing here"),
        ("", format!("MoveC {P},{P},v100,fine;"), "4 arguments of `MoveC`"),
        (
            "",
            format!("MoveAbsJ {P},{REST};"),
            "is computed while the program runs, or is not a valid target",
        ),
        ("", format!("MoveX {P},{REST};"), "`MoveX` is an unsupported move"),
        (
            "",
            "SearchL\\Stop,di1,sp,p10,v100,tool0;".to_owned(),
            "`SearchL` is an unsupported move",
        ),
        (
            "",
            format!("PDispOn {P},tool0;"),
            "`PDISPON` displaces all targets",
        ),
        (
            still,
            format!("MoveL {P},v100,fine,t;"),
            "the tool is stationary here",
        ),
        (
            on_flange,
            format!("MoveL {P},v100,fine,tool0\\WObj:=w;"),
            "the tool is stationary here",
        ),
        ("", "WaitTime 1;".to_owned(), "the program contains no moves"),
    ] {
        wrong(&format!("{data}\nPROC a()\n{line}\nENDPROC"), part);
    }
    let lines = "MoveL p1,v100,fine,tool0;\n".repeat(300);
    assert_eq!(
        problems(&[("a.mod", &module(&format!("PROC a()\n{lines}ENDPROC")))]).len(),
        200
    );
}

/// cf1, cf4, cf6.
fn turns(joints: &[f64]) -> Vec<i32> {
    [0, 3, 5]
        .map(|axis| (joints[axis].to_degrees() / 90.0).floor() as i32)
        .to_vec()
}

const WRITES: Writes = Writes {
    external: 6,
    statement: "SetDO do_1,1;",
};

const SAYS: Says = Says {
    branch: |point| BranchPattern::from(point.branch.unwrap()),
    turns,
    notes: &["external axes"],
};

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_draft_is_read_back(draft in drafts(WRITES)) {
        reads_back(Language::Rapid, &draft, &SAYS);
    }
}

#[test]
fn a_long_program_is_written_in_parts_called_by_a_main_program() {
    let written = write(Language::Rapid, &long(20_001)).unwrap();
    let names: Vec<&str> = written.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        ["PLATE.mod", "PLATE_001.mod", "PLATE_002.mod", "PLATE_003.mod"]
    );
    let program = read_back(&written);
    assert_eq!(program.moves.len(), 20_001);
    near(
        program.moves[20_000].target.pose().unwrap(),
        &kuka([2000.0, 0.0, 0.0, 0.0, 90.0, 0.0]),
    );
}
