//! URScript.

mod written;

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;
use armill_formats::convention::Convention;
use armill_programs::{Frame, Language, Motion, RobotProgram, Speed, Target};
use proptest::prelude::*;

use crate::drafts::{Says, Writes, drafts, reads_back};
use crate::rewriting::keeps_the_rest;
use crate::same_poses::{eight_moves, same, same_joints, sample};
use crate::{problems, program, refused};

fn of(lines: &str) -> RobotProgram {
    program(&[("a.script", lines)]).unwrap()
}

/// That these lines are refused with one problem.
fn wrong(lines: &str, part: &str) {
    refused(&[("a.script", lines)], part);
}

/// A pose of m and rad.
fn ur(numbers: [f64; 6]) -> Isometry {
    let [x, y, z, a, b, c] = numbers;
    Convention::Ur
        .pose(&[x * 1e3, y * 1e3, z * 1e3, a, b, c])
        .unwrap()
}

/// As the pendant's own program saves it.
const EXPORTED: &str = "def Groove():\r\n  set_tcp(p[0.0,0.0,0.1,0.0,0.0,0.0])\r\n  set_payload(1.5, [0.0, 0.0, 0.05])\r\n\
  global Plane_1=p[0.4,-0.2,0.05,0.0,0.0,1.5707963267948966]\r\n\
  global Waypoint_1_p=p[.14, -0.43, .5, 0, 3.11, 0.04]\r\n  global Waypoint_1_q=[1.5, -1.8, 2.1, -1.8, -1.5, 0.02]\r\n\
  while (True):\r\n    $ 1 \"Robot Program\"\r\n    $ 2 \"MoveJ\"\r\n\
    movej(get_inverse_kin(Waypoint_1_p, qnear=Waypoint_1_q), a=1.39, v=1.04)\r\n\
    movel(pose_trans(Plane_1,\r\n          p[0.01,0,0,0,0,0]), a=1.2, v=0.25, r=0.002)\r\n\
    movec(p[0.1,0.2,0.3,0,3.1,0], p[0.2, 0.3,0.3 ,0,3.1,0], a=1.2, v=0.1) # \u{fc}ber\r\n\
    movep(Waypoint_1_p, 1.2, 0.05)\r\n    Greifer_zu()\r\n  end\r\nend\r\n";

#[test]
fn the_sample_has_the_joints_and_the_eight_poses() {
    let Some(program) = sample("Universal_Robots_SCRIPT.script") else {
        return;
    };
    // Half of six decimals of a radian.
    same_joints(&program.moves[0], 0.5e-6_f64.to_degrees());
    eight_moves(&program.moves[1..]);
    assert!(program.moves[1..].iter().all(|of| of.speed == Speed::Tip(0.1)));
    assert!(
        program
            .notes
            .iter()
            .any(|note| note.contains("`TCP_On` is called"))
    );
    keeps_the_rest(&program, |pose| *pose);
}

#[test]
fn an_exported_program_has_its_waypoints_planes_and_speeds() {
    let program = of(EXPORTED);
    assert_eq!(program.name, "Groove");
    let [joint, linear, arc, process] = program.moves.as_slice() else {
        panic!("{:?}", program.moves);
    };
    let waypoint = ur([0.14, -0.43, 0.5, 0.0, 3.11, 0.04]);
    same(joint.target.pose().unwrap(), &waypoint);
    assert_eq!((&joint.motion, joint.speed), (&Motion::Joint, Speed::Joints));
    assert_eq!(
        (&linear.motion, linear.speed),
        (&Motion::Linear, Speed::Tip(0.25))
    );
    let Frame::Given(plane) = linear.frame else {
        panic!()
    };
    same(
        &plane,
        &ur([0.4, -0.2, 0.05, 0.0, 0.0, std::f64::consts::FRAC_PI_2]),
    );
    same(
        linear.target.pose().unwrap(),
        &ur([0.01, 0.0, 0.0, 0.0, 0.0, 0.0]),
    );
    assert_eq!(
        (linear.tool, linear.line),
        (Frame::Given(ur([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])), 11)
    );
    let Motion::Circular { via } = &arc.motion else {
        panic!()
    };
    same(via.pose().unwrap(), &ur([0.1, 0.2, 0.3, 0.0, 3.1, 0.0]));
    same(process.target.pose().unwrap(), &waypoint);
    assert_eq!(process.speed, Speed::Tip(0.05));
    for part in ["line 7: `while`: its body is read once", "`Greifer_zu` is called"] {
        assert!(
            program.notes.iter().any(|note| note.contains(part)),
            "{:?}",
            program.notes
        );
    }
}

#[test]
fn rewriting_changes_only_the_bytes_of_targets() {
    let program = of(EXPORTED);
    let by = ur([0.0123, -0.5, 0.001, 0.1, 0.2, 0.3]);
    let files = keeps_the_rest(&program, |pose| by * pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(
        text.contains("Waypoint_1_q=[1.5, -1.8, 2.1, -1.8, -1.5, 0.02]\r\n"),
        "{text}"
    );
    let files = keeps_the_rest(&program, |pose| *pose);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    let expected = "p[0.200000, 0.300000,0.300000 ,0,3.1,0], a=1.2, v=0.1) # \u{fc}ber\r\n";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn numbers_may_be_computed_from_numbers() {
    let program =
        of("z = 2*(0.1+0.05)/3\nq=[0,d2r(-90),pi/2,-(1),2-1.5,0]\nmovej(q)\nmovel(p[0,-z,z,0,0,0])");
    let Target::Joints(joints) = &program.moves[0].target else {
        panic!()
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(*joints, [0.0, -quarter, quarter, -1.0, 0.5, 0.0]);
    same(
        program.moves[1].target.pose().unwrap(),
        &ur([0.0, -0.1, 0.1, 0.0, 0.0, 0.0]),
    );
    // What was computed is written as numbers.
    let files = keeps_the_rest(&program, |pose| *pose);
    let expected = "movel(p[0.000000, -0.100000, 0.100000, 0.000000, 0.000000, 0.000000])";
    assert!(String::from_utf8(files[0].1.clone()).unwrap().contains(expected));
}

#[test]
fn a_duration_or_unknown_speed_gives_no_tip_speed() {
    let speed = |arguments: &str| of(&format!("movel(p[0,0,0,0,0,0]{arguments})")).moves[0].speed;
    assert_eq!(speed(", 1.2, 0.3"), Speed::Tip(0.3));
    assert_eq!(speed(", v=0.3"), Speed::Tip(0.3));
    assert_eq!(speed(", 1.2, 0.3, 5"), Speed::Joints);
    assert_eq!(speed(", v=0.3, t=2"), Speed::Joints);
    assert_eq!(speed(", 1.2, v_cut"), Speed::Unknown);
    assert_eq!(speed(""), Speed::Unknown);
}

#[test]
fn only_further_calls_of_the_main_routine_are_noted() {
    let main = "def main():\n  movel(p[0,0,0,0,0,0], v=0.1)\nend\n";
    assert!(of(&format!("{main}main()\n")).notes.is_empty());
    let again = of(&format!("{main}main()\nmain()\n"));
    assert_eq!(again.moves.len(), 1);
    assert_eq!(
        again.notes,
        ["a.script, line 5: `main` is called: its moves are read once, where it is defined"]
    );
}

#[test]
fn a_name_without_a_value_is_a_feature_of_the_installation() {
    let program = of(
        "movel(pose_trans(Table, p[0.1,0,0,0,0,0]), v=0.1)\nmovel(pose_trans(Table, p[0.2,0,0,0,0,0]), v=0.1)",
    );
    let x: Vec<f64> = program
        .moves
        .iter()
        .map(|of| of.target.pose().unwrap().translation.x)
        .collect();
    assert_eq!(x, [0.1, 0.2]);
    assert!(program.moves.iter().all(|of| of.frame == Frame::Unknown));
    assert_eq!(
        program.notes,
        [
            "a.script, line 1: the frame `Table` is a feature of the installation: it is not known (2 times, first here)"
        ]
    );
    keeps_the_rest(&program, |pose| *pose);
    wrong(
        "movec(pose_trans(Table, p[0,0,0,0,0,0]), pose_trans(Vise, p[0,0,0,0,0,0]))",
        "the two positions of this circle are relative to different frames",
    );
    for lines in [
        "Table = get_forward_kin()\nmovel(pose_trans(Table, p[0,0,0,0,0,0]))",
        "movel(pose_trans(Table, pose_trans(Vise, p[0,0,0,0,0,0])))",
        "movel(pose_inv(pose_trans(Table, p[0,0,0,0,0,0])))",
    ] {
        wrong(lines, "is computed while the program runs");
    }
    let tool = of("set_tcp(pose_trans(Table, p[0,0,0,0,0,0]))\nmovel(p[0,0,0,0,0,0], v=0.1)");
    assert_eq!(tool.moves[0].tool, Frame::Unknown);
}

#[test]
fn every_problem_is_reported_with_its_position_and_a_hint() {
    for (lines, part) in [
        ("movel(p[1.2.3,0,0,0,0,0])", "1:9: `1.2.3` is not a number"),
        ("movel(p[0,0,0])", "1:7: 3 numbers in a pose, but 6 are required"),
        ("movel(p[2e9,0,0,0,0,0])", "is beyond 1e9"),
        (
            "movel(p_1, a=1)",
            "1:7: `p_1` is not defined: no line before gives it a value",
        ),
        (
            "p_1 = get_actual_tcp_pose()\nmovel(p_1)",
            "`p_1` is computed while the program runs",
        ),
        (
            "movel(pose_add(a, p[0,0,0,0,0,0]))",
            "`pose_add(a, p[0,0,0,0,0,0])` is computed while",
        ),
        (
            "def cut(p_c):\nmovel(p_c)\nend",
            "`p_c` is computed while the program runs",
        ),
        ("movej([0,0,0])", "3 joints in a target, but 6 are required"),
        ("movej(5)", "`5` is a number, but a target is required"),
        ("movej()", "`movej` has no target"),
        ("movec(p[0,0,0,0,0,0])", "`movec` has no target"),
        (
            "movec(p[0,0,0,0,0,0], pose_trans(p[1,0,0,0,0,0], p[0,0,0,0,0,0]))",
            "the two positions of this circle are relative to different frames",
        ),
        ("servoj([0,0,0,0,0,0])", "`servoj` is an unsupported move"),
        ("movex(p[0,0,0,0,0,0])", "`movex` is an unsupported move"),
        ("movel(p[0,0,0,0,0,0)", "1:20: `]` is missing here"),
        ("movel(p[0,0,0,0,0,0]", "1:21: `)` is missing here"),
        ("sleep(1)", "the program contains no moves"),
    ] {
        wrong(lines, part);
    }
    let all = problems(&[("a.script", &"movel(p_1)\n".repeat(300))]);
    assert_eq!(all.len(), 200);
}

const WRITES: Writes = Writes {
    external: 0,
    statement: "set_standard_digital_out(1, True)",
};

const SAYS: Says = Says {
    branch: |_| BranchPattern::default(),
    turns: |_| Vec::new(),
    notes: &[],
};

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_draft_is_read_back(draft in drafts(WRITES)) {
        reads_back(Language::UrScript, &draft, &SAYS);
    }
}
