//! Programs as moves of a path: the same poses from every language, frames and tools that are given or missing,
//! arcs, positions that only the controller knows.

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};
use armill_core::path::{Course, GivenSpin, Pace};
use armill_core::robot::{Branch, BranchPattern, Robot};
use armill_formats::robot::opw;
use armill_programs::{Cell, FollowError, Followed, FollowedMove, RobotProgram, follow};

use crate::same_poses::{self, FRAME, PLACES, TOOL, TURN, kuka};

/// ABB IRB 6700-155/2.85: lengths of its data sheet as remembered. The sample's own numbers confirm them: see the test.
const IRB_6700: &str = "\
opw_kinematics_geometric_parameters:
  a1: 0.320
  a2: -0.200
  b: 0.0
  c1: 0.780
  c2: 1.125
  c3: 1.3925
  c4: 0.200
opw_kinematics_joint_offsets: [0.0, 0.0, deg(-90.0), 0.0, 0.0, 0.0]
opw_kinematics_joint_sign_corrections: [1, 1, 1, 1, 1, 1]
";

/// An arm for tests without joint positions.
fn arm() -> Robot {
    opw::read("arm.yaml", "arm", IRB_6700).unwrap().robot
}

fn cell(flange_from_tool: Isometry) -> Cell {
    Cell {
        flange_from_tool,
        base_from_controller: Isometry::identity(),
        controller_from_frame: None,
        base_from_path: None,
    }
}

/// Base to tool at the end of a move.
fn base_from_tool(followed: &Followed, at: &FollowedMove) -> Isometry {
    let Some(GivenSpin::Orientation(turned)) = at.next.spin else {
        panic!("{at:?}");
    };
    assert_eq!(at.next.axis, Some(-(turned * Vector3::z_axis())));
    followed.base_from_path * Isometry::from_parts(at.next.end.coords.into(), turned)
}

fn krl(lines: &str) -> RobotProgram {
    crate::program(&[("a.src", &format!("DEF A()\n{lines}\nEND\n"))]).unwrap()
}

/// Why these lines of KRL cannot be followed.
fn lacks(lines: &str, cell: &Cell) -> Vec<FollowError> {
    follow(&krl(lines), &arm(), cell).expect_err(lines)
}

#[test]
fn one_list_of_poses_is_one_path_from_every_language() {
    let cell = cell(kuka(TOOL));
    for file in [
        "KUKA_KRC4.src",
        "Fanuc_R30iA.LS",
        "Motoman.JBI",
        "Universal_Robots_SCRIPT.script",
    ] {
        let Some(program) = same_poses::sample(file) else {
            return;
        };
        let followed = follow(&program, &arm(), &cell).unwrap();
        let cuts: Vec<&FollowedMove> = followed.moves.iter().rev().take(8).rev().collect();
        for (found, [x, y, z]) in cuts.iter().zip(PLACES) {
            let [a, b, c] = TURN;
            let expected = kuka(FRAME) * kuka([x, y, z, a, b, c]);
            same_poses::same(&base_from_tool(&followed, found), &expected);
            assert_eq!(found.next.course, Course::Line);
        }
        // Yaskawa's joints are pulses, which only the controller knows: the first move then comes from nowhere.
        let is_pulses = file == "Motoman.JBI";
        assert_eq!(followed.moves.len(), if is_pulses { 8 } else { 9 }, "{file}");
        assert_eq!(cuts[0].next.pace == Pace::Rapid, is_pulses);
        assert!(cuts[1..].iter().all(|cut| cut.next.pace.cuts()));
        assert_eq!(
            followed
                .notes
                .iter()
                .any(|note| note.contains("is a position that the program does not give")),
            is_pulses
        );
    }
}

#[test]
fn joints_and_poses_of_a_program_give_the_same_positions() {
    let Some(program) = same_poses::sample("ABB_RAPID_IRC5.mod") else {
        return;
    };
    let tool = from_xyz_and_fixed_angles(
        Vector3::new(0.38, 0.0, 0.2),
        Vector3::new(0.0, 90_f64.to_radians(), 0.0),
    );
    let followed = follow(&program, &arm(), &cell(tool)).unwrap();
    let pose = |index: usize| base_from_tool(&followed, &followed.moves[index]);
    // MoveAbsJ, then MoveL to a position with the same x and z; the orientation is that of a later MoveL.
    // Joints have six decimals of a degree, positions three of a millimetre: 3 m of arm give 5e-8 m for the
    // joints.
    let (joints, first, later) = (pose(1), pose(2), pose(5));
    for axis in [0, 2] {
        let apart = joints.translation.vector[axis] - first.translation.vector[axis];
        assert!(apart.abs() < 0.6e-6, "{apart}");
    }
    let turned = joints.rotation.to_rotation_matrix().matrix() - later.rotation.to_rotation_matrix().matrix();
    // Found 1.3e-7, some times what eight decimals of a quaternion and six of a degree leave.
    assert!(turned.amax() < 5e-7, "{turned}");
    // MoveAbsJ at 2000 mm/s moves the joints; the arc ends at its programmed point.
    assert_eq!(followed.moves[1].next.pace, Pace::Rapid);
    assert_eq!(followed.moves[2].next.pace, Pace::Feed(0.1));
    let Course::Arc(arc) = followed.moves[3].next.course else {
        panic!("{:?}", followed.moves[3]);
    };
    let on = |point: Point3<f64>| (point - arc.centre).norm();
    let ends = [
        followed.moves[2].next.end,
        followed.moves[3].via.unwrap(),
        followed.moves[3].next.end,
    ];
    assert!(ends.iter().all(|end| (on(*end) - on(ends[0])).abs() < 1e-9));
    // The preceding joints give the posture: axis 5 below zero.
    assert_eq!(followed.posture, Some((BranchPattern::from(Branch::ALL[1]), 31)));
}

#[test]
fn a_given_frame_is_used_and_a_numbered_one_is_that_of_the_cell() {
    let plain = cell(Isometry::identity());
    let moves = "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN {X 5,Y 2,Z 3,A 0,B 0,C 0}";
    let frame = kuka([100.0, 20.0, 3.0, 30.0, 0.0, 0.0]);
    let reported = krl(&format!("$BASE={{X 100,Y 20,Z 3,A 30,B 0,C 0}}\n{moves}"));
    let raised = Cell {
        base_from_controller: Isometry::translation(0.0, 0.0, 0.45),
        ..plain
    };
    let found = follow(&reported, &arm(), &raised).unwrap();
    same_poses::same(&found.base_from_path, &(raised.base_from_controller * frame));
    assert!(
        found
            .notes
            .iter()
            .any(|note| note.contains("(100, 20, 3, 0, 0, 30 mm")),
        "{:?}",
        found.notes
    );
    // The places themselves are those of the program.
    assert_eq!(found.moves[1].next.end, Point3::new(0.005, 0.002, 0.003));
    let numbered = format!("$BASE=BASE_DATA[3]\n{moves}");
    assert_eq!(
        lacks(&numbered, &plain),
        [FollowError::Numbered { line: 3, number: 3 }]
    );
    assert_eq!(lacks(moves, &plain), [FollowError::UnknownFrame { line: 2 }]);
    let given = Cell {
        controller_from_frame: Some(frame),
        ..raised
    };
    let found = follow(&krl(&numbered), &arm(), &given).unwrap();
    same_poses::same(&found.base_from_path, &(raised.base_from_controller * frame));
    // One frame is given: neither a second one nor none at all.
    let two = format!("{numbered}\n$BASE=BASE_DATA[4]\nLIN {{X 5,Y 2,Z 3,A 0,B 0,C 0}}");
    assert_eq!(lacks(&two, &given), [FollowError::Several { lines: [3, 6] }]);
    let of_program = format!("$BASE={{X 100,Y 20,Z 3,A 30,B 0,C 0}}\n{moves}");
    assert_eq!(
        lacks(&of_program, &given),
        [FollowError::FrameGivenTwice { line: 3 }]
    );
    assert_eq!(
        lacks(&two, &plain),
        [
            FollowError::Numbered { line: 3, number: 3 },
            FollowError::Numbered { line: 6, number: 4 }
        ]
    );
}

#[test]
fn replacing_a_frame_also_moves_the_frames_relative_to_it() {
    let instead = kuka([900.0, 0.0, 300.0, 45.0, 10.0, 0.0]);
    let replaced = Cell {
        base_from_path: Some(instead),
        ..cell(Isometry::identity())
    };
    let two = "$BASE={X 100,Y 20,Z 3,A 30,B 0,C 0}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\n$BASE={X 110,Y 20,Z 3,A 30,B 0,C 0}\n\
        LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
    let found = follow(&krl(two), &arm(), &replaced).unwrap();
    assert_eq!(found.base_from_path, instead);
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -30_f64.to_radians());
    let offset = found.moves[1].next.end - found.moves[0].next.end;
    assert!((offset - turn * Vector3::new(0.01, 0.0, 0.0)).norm() < 1e-15);
    // Home in the robot's own base, cuts in a frame by number: what is cut is what is placed.
    let home = "$BASE=$NULLFRAME\nPTP {X 1000,Y 0,Z 1000,A 0,B 90,C 0}\n$BASE=BASE_DATA[2]\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
    let found = follow(&krl(home), &arm(), &replaced).unwrap();
    assert_eq!(found.base_from_path, instead);
    let at_home = found.base_from_path * found.moves[0].next.end;
    assert!((at_home - Point3::new(1.0, 0.0, 1.0)).norm() < 1e-14);
    let apart = "$BASE=BASE_DATA[2]\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\n$BASE=BASE_DATA[5]\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
    assert_eq!(lacks(apart, &replaced), [FollowError::Several { lines: [3, 5] }]);
}

#[test]
fn a_tool_with_the_same_tip_may_have_other_axes_and_another_tip_is_reported() {
    let cell = cell(kuka([0.0, 0.0, 150.0, 0.0, 0.0, 0.0]));
    // KUKA's tools often have x along the cutter.
    let lines = |x: &str| {
        format!(
            "$BASE=$NULLFRAME\n$TOOL={{X {x},Y 0,Z 150,A 0,B -90,C 0}}\nLIN {{X 800,Y 0,Z 500,A 0,B 90,C 0}}\nLIN {{X 900,Y 0,Z 500,A 0,B 90,C 0}}"
        )
    };
    let found = follow(&krl(&lines("0.004")), &arm(), &cell).unwrap();
    let at = base_from_tool(&found, &found.moves[1]);
    // Its x points down, and so does z of the cell's tool.
    assert!((at * Vector3::z() + Vector3::z()).norm() < 1e-14, "{at}");
    assert!((at.translation.vector - Vector3::new(0.9, 0.0, 0.5)).norm() < 5e-6);
    assert!(
        found
            .notes
            .iter()
            .any(|note| note.contains("rotated by 90.00 deg")),
        "{:?}",
        found.notes
    );
    let [
        FollowError::Tip {
            line,
            tip_mm,
            apart_mm,
            tool_mm_deg,
        },
    ] = &lacks(&lines("0.5"), &cell)[..]
    else {
        panic!("one error");
    };
    assert_eq!(
        (*line, tip_mm.as_str(), tool_mm_deg.as_str()),
        (4, "0.5, 0, 150", "[0.5, 0, 150, 0, -90, 0]")
    );
    assert!((apart_mm - 0.5).abs() < 1e-9);
    // If only the end matters, the flange is at its programmed pose with any tool.
    let rapid = format!(
        "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\nPTP {{X 800,Y 0,Z 500,A 0,B 90,C 0}}\n{}",
        lines("0")
    );
    let found = follow(&krl(&rapid), &arm(), &cell).unwrap();
    let flange = kuka([800.0, 0.0, 500.0, 0.0, 90.0, 0.0]);
    same_poses::same(
        &base_from_tool(&found, &found.moves[0]),
        &(flange * kuka([0.0, 0.0, 150.0, 0.0, 0.0, 0.0])),
    );
    let numbered = follow(
        &krl(&lines("0").replace("{X 0,Y 0,Z 150,A 0,B -90,C 0}", "TOOL_DATA[4]")),
        &arm(),
        &cell,
    )
    .unwrap();
    assert!(
        numbered
            .notes
            .iter()
            .any(|note| note.contains("tool 4 of the controller")),
        "{:?}",
        numbered.notes
    );
}

#[test]
fn arcs_pass_their_via_points_and_flat_ones_are_straight() {
    let pose = |place: &str| format!("{{{place},A 0,B 180,C 0}}");
    let lines = format!(
        "$BASE=$NULLFRAME\nPTP {}\nCIRC {},{}\nCIRC {},{}",
        pose("X 900,Y 0,Z 500"),
        "{X 1000,Y 100,Z 500,A 0,B 178,C 0}",
        pose("X 1100,Y 0,Z 500"),
        pose("X 1150,Y 0,Z 500"),
        pose("X 1200,Y 0,Z 500"),
    );
    let found = follow(&krl(&lines), &arm(), &cell(Isometry::identity())).unwrap();
    let Course::Arc(arc) = found.moves[1].next.course else {
        panic!("{:?}", found.moves[1]);
    };
    assert!((arc.centre - Point3::new(1.0, 0.0, 0.5)).norm() < 1e-14);
    assert!((arc.axis.into_inner() + Vector3::z()).norm() < 1e-14);
    assert!((arc.sweep - std::f64::consts::PI).abs() < 1e-14);
    assert_eq!(found.moves[2].next.course, Course::Line);
    let reported = found.notes.join("\n");
    assert!(
        reported.contains("line 4: an arc gives an orientation at its via point"),
        "{reported}"
    );
    assert!(
        reported.contains("line 5: an arc has its three points on one line"),
        "{reported}"
    );
}

#[test]
fn moves_to_or_from_an_unknown_position_are_left_out_and_reported() {
    let listing = "/PROG A\n/MN\n1:L P[1] 100mm/sec FINE ;\n2:L P[2] 50mm/sec FINE ;\n3:L PR[1] 50mm/sec FINE ;\n4:L P[1] 50mm/sec FINE ;\n\
        5:L P[2] 50mm/sec FINE ;\n/POS\n";
    let position = |number: usize, x: usize| {
        format!(
            "P[{number}]{{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = {x} mm, Y = 0 mm, Z = 500 mm,\n W = 180 deg, P = 0 deg, R = 0 deg\n}};\n"
        )
    };
    let text = format!("{listing}{}{}/END\n", position(1, 900), position(2, 950));
    let found = follow(
        &crate::program(&[("a.ls", &text)]).unwrap(),
        &arm(),
        &cell(Isometry::identity()),
    )
    .unwrap();
    let cuts: Vec<(usize, bool)> = found
        .moves
        .iter()
        .map(|at| (at.index, at.next.pace.cuts()))
        .collect();
    // The first begins nowhere; the third goes to a register, and the fourth comes from there.
    assert_eq!(cuts, [(0, false), (1, true), (3, false), (4, true)]);
    let reported = found.notes.join("\n");
    assert!(
        reported.contains("line 3: the first move begins at a position that the program does not give")
            && reported.contains("(2 times, first here)"),
        "{reported}"
    );
    assert!(
        reported.contains("line 5: `PR[1]` is a position that the program does not give"),
        "{reported}"
    );
}

#[test]
fn reports_joints_of_another_arm() {
    let lines = "$BASE=$NULLFRAME\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}";
    let mut program = krl(lines);
    program.moves[0].target = armill_programs::Target::Joints(vec![0.0; 7]);
    let reported = follow(&program, &arm(), &cell(Isometry::identity())).unwrap_err();
    assert_eq!(
        reported[0].to_string(),
        "line 3: 7 joint positions, but robot `arm` has 6 joints"
    );
}
