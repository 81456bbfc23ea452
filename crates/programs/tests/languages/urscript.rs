//! URScript.

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;
use armill_programs::{Draft, Frame, Language, Motion, RobotProgram, Speed, Target, write};
use proptest::prelude::*;

use crate::drafts::{Says, drafts, long, reads_back};
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

const SAYS: Says = Says {
    frames: |_| None,
    branches: false,
    joint_speed: Speed::Joints,
    turns: |_| Vec::new(),
};

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_draft_is_read_back(draft in drafts()) {
        reads_back(Language::UrScript, &draft, &SAYS);
    }
}

#[test]
fn a_program_has_the_expected_text() {
    let written = write(Language::UrScript, &long(4)).unwrap();
    let (name, bytes) = &written.files[0];
    assert_eq!((written.files.len(), name.as_str()), (1, "PLATE.script"));
    // Points are 0.1 mm apart: the blend of 0.5 mm becomes 0.045 mm; the last point is an exact stop.
    let expected = "def PLATE():\n  # made by armill\n  # LIN {X 0}\n  # frame 1 and tool 2 for which this program was made\n  \
        armill_frame = p[0.001000, 0.002000, 0.003000, 0.000000, 0.000000, 0.000000]\n  \
        set_tcp(p[0.000000, 0.000000, 0.100000, 0.000000, 0.000000, 0.000000])\n  \
        movej([-0.806066, -0.118249, -0.358652, 1.245934, 0.865461, -5.280450], a=1.4, v=0.5)\n  \
        movel(pose_trans(armill_frame, p[0.000100, 0.000000, 0.000000, 0.000000, 1.570796, 0.000000]), a=1.2, v=0.050000, r=0.000045)\n  \
        movel(pose_trans(armill_frame, p[0.000200, 0.000000, 0.000000, 0.000000, 1.570796, 0.000000]), a=1.2, v=0.050000, r=0.000045)\n  \
        movel(pose_trans(armill_frame, p[0.000300, 0.000000, 0.000000, 0.000000, 1.570796, 0.000000]), a=1.2, v=0.050000)\n\
        end\nPLATE()\n";
    assert_eq!(std::str::from_utf8(bytes).unwrap(), expected);
}

#[test]
fn refuses_reserved_words_as_names() {
    let draft = Draft {
        name: "While".to_owned(),
        ..long(1)
    };
    let given = write(Language::UrScript, &draft).unwrap_err().to_string();
    assert!(given.contains("not a reserved word"), "{given}");
}
