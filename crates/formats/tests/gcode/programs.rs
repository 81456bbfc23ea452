//! Our own programs: what each word does to the path, and every refusal once.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use armill_core::nalgebra::{Point3, Rotation3, Vector3};
use armill_core::path::{Arc, Course, Move, Operation, Pace, Step};
use armill_formats::document::{Problem, Problems};
use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{
    self, Options, Rotaries, Rotary, Summary, Tool, ToolTable, Warning, interpret,
};

/// The steps of a program, kept.
#[derive(Debug, Default)]
struct Program {
    operations: Vec<Operation>,
    moves: Vec<Move>,
    /// Of each operation the index of its first move.
    starts: Vec<usize>,
}

fn read(program: &str, options: &Options<'_>) -> Result<(Program, Summary), Problems> {
    let mut path = Program::default();
    let summary = gcode::read(
        "p.ngc",
        &mut program.as_bytes(),
        options,
        &mut |step| match step {
            Step::Operation(operation) => {
                path.operations.push(operation);
                path.starts.push(path.moves.len());
            }
            Step::Move(next) => path.moves.push(next),
        },
    )?;
    Ok((path, summary))
}

fn path(program: &str) -> Program {
    read(program, &Options::default())
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

fn first_problem(program: &str, options: &Options<'_>) -> String {
    match read(program, options) {
        Err(problems) => problems.as_slice()[0].to_string(),
        Ok(_) => panic!("accepted: {program}"),
    }
}

fn calls(program: &str) -> Vec<String> {
    let mut calls = Vec::new();
    let told = interpret(&mut program.as_bytes(), &Options::default(), &mut |call, _| {
        calls.push(call.to_string());
        Ok(())
    });
    assert!(told.faults.is_empty(), "{:?}", told.faults);
    calls
}

fn moves_of(program: &str) -> Vec<String> {
    let mut calls = calls(program);
    calls.retain(|call| call.starts_with("STRAIGHT") || call.starts_with("ARC"));
    calls
}

fn arc_of(next: &Move) -> Arc {
    match next.course {
        Course::Arc(arc) => arc,
        Course::Line => panic!("line {} is no arc", next.line),
    }
}

/// Ends of moves, mm, rounded to 1 nm: sums and turns of numbers below 1 m are exact to 1e-16 m.
fn ends(path: &Program) -> Vec<[f64; 3]> {
    let nearest = |value: f64| (value * 1e9).round() / 1e6 + 0.0;
    path.moves
        .iter()
        .map(|next| [nearest(next.end.x), nearest(next.end.y), nearest(next.end.z)])
        .collect()
}

#[test]
fn lengths_speeds_and_angles_are_si() {
    let program = path("G20 T3 M6 S60 M4\nG0 X1 Y2 Z3\nG1 X2 F60\nG21 X25.4 F120\n");
    assert_eq!(
        ends(&program),
        [[25.4, 50.8, 76.2], [50.8, 50.8, 76.2], [25.4, 50.8, 76.2]]
    );
    // 60 inches a minute are 25.4 mm/s; roundings of a quotient.
    let Pace::Feed(feed) = program.moves[1].pace else {
        panic!("no feed")
    };
    assert!((feed - 25.4e-3).abs() < 1e-15);
    assert_eq!(program.moves[2].pace, Pace::Feed(2e-3));
    assert_eq!(program.operations[0].tool, Some(3));
    assert_eq!(program.operations[0].name.as_deref(), Some("T3"));
    let spindle = program.operations[0].spindle.unwrap();
    assert!(
        (spindle + TAU).abs() < 2e-15,
        "60 turns a minute, counterclockwise: two roundings"
    );
    assert_eq!(program.moves[2].line, 4);
}

#[test]
fn an_operation_begins_with_its_tool_and_speed() {
    let tools = BTreeMap::from([(
        2,
        Tool {
            diameter: 10.0,
            ..Tool::default()
        },
    )]);
    let options = Options {
        tools: Some(ToolTable {
            unit: LengthUnit::Millimetre,
            tools,
        }),
        ..Options::default()
    };
    let program = "G21 T2 M6\nG0 X0\nS600 M3\nG1 X1 F60\nG0 Z9\nM5\nG0 X0\nS1200 M3\nG1 X5\nX6\nM2\n";
    let (path, summary) = read(program, &options).unwrap();
    let speeds: Vec<_> = path
        .operations
        .iter()
        .map(|operation| operation.spindle)
        .collect();
    assert_eq!(
        speeds,
        [None, Some(10.0 * TAU), Some(20.0 * TAU)],
        "rapids with the spindle off are no operation"
    );
    assert_eq!(path.starts, [0, 1, 4]);
    assert_eq!(path.operations[0].diameter, Some(10e-3));
    assert_eq!(summary.operations, 3);
}

#[test]
fn arcs_by_radius_and_by_centre_are_the_same() {
    let centre = path("G21 F60\nG0 X10 Y0\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 I0 J-10\nG90.1 G3 X0 Y10 I0 J0\n");
    let radius = path("G21 F60\nG0 X10 Y0\nG3 X0 Y10 R10\nG2 X10 Y0 R10\nG3 X0 Y10 R10\n");
    for (one, other) in centre.moves.iter().zip(&radius.moves).skip(1) {
        let (one, other) = (arc_of(one), arc_of(other));
        // Centres by root: a few roundings of 10 mm.
        assert!((one.centre - other.centre).norm() < 1e-16 * 10.0);
        assert!((one.sweep - PI / 2.0).abs() < 1e-15 && (other.sweep - PI / 2.0).abs() < 1e-14);
        assert_eq!(one.axis, other.axis);
    }
}

#[test]
fn arcs_turn_by_the_right_hand_about_the_axis_of_their_plane() {
    for (plane, axis, program) in [
        ("G17", Vector3::z(), "G0 X10 Y0\nG3 X0 Y10 I-10"),
        ("G18", Vector3::y(), "G0 Z10 X0\nG3 Z0 X10 K-10"),
        ("G19", Vector3::x(), "G0 Y10 Z0\nG3 Y0 Z10 J-10"),
    ] {
        let path = path(&format!("G21 F60 {plane}\n{program}\n"));
        let [.., from, next] = path.moves.as_slice() else {
            panic!("two moves")
        };
        let arc = arc_of(next);
        assert_eq!(arc.axis.into_inner(), axis, "{plane}");
        let turned = Rotation3::from_axis_angle(&arc.axis, arc.sweep) * (from.end - arc.centre);
        assert!(
            (arc.centre + turned - next.end).norm() < 1e-16,
            "{plane}: a rounding of 10 mm"
        );
    }
}

#[test]
fn turns_and_rise_make_a_helix() {
    let path = path("G21 F60 G0 X10 Y0 Z0\nG2 I-10 Z-6 P3\n");
    let arc = arc_of(&path.moves[1]);
    assert_eq!(arc.sweep, 3.0 * TAU);
    assert_eq!(arc.axis.into_inner(), -Vector3::z());
    assert_eq!(path.moves[1].end, Point3::new(10e-3, 0.0, -6e-3));
}

#[test]
fn inverse_time_is_length_by_time() {
    let path = path("G21 G93 G0 X0 Y0\nG1 X30 Y40 F2\nG3 X30 Y40 I10 F0.5\n");
    // 50 mm in half a minute, a circle of 20 pi mm in two: quotients round.
    for (next, speed) in path.moves[1..].iter().zip([0.05 / 30.0, 0.02 * PI / 120.0]) {
        let Pace::Feed(feed) = next.pace else {
            panic!("no feed")
        };
        assert!((feed / speed - 1.0).abs() < 1e-15);
    }
}

#[test]
fn feed_per_revolution_needs_a_spindle_that_turns() {
    let (path, summary) = read("G21 G95 F0.5\nG1 X1\nX2\nS600 M3\nX4\n", &Options::default()).unwrap();
    assert_eq!(path.moves[1].pace, Pace::Untold);
    assert_eq!(path.moves[2].pace, Pace::Feed(5e-3));
    assert_eq!(summary.warnings.of(Warning::SpindleStands), 2);
    assert_eq!(
        summary.feeds_untold, 1,
        "the first move says where the tip stands"
    );
}

#[test]
fn offsets_do_not_move_the_part() {
    let plain = "G21 F60\nG0 X0 Y0\nG1 X10\nY5\nG2 X20 Y5 I5\n";
    let shifted = "G21 F60\nG0 X0 Y0\nG1 X10\nG92 X0 Y0\nY5\nG92.1\nG52 X3\nG2 X17 Y5 I5\n";
    assert_eq!(ends(&path(shifted)), ends(&path(plain)));
    let systems =
        "G21 F60\nG10 L2 P1 X100 Y50\nG10 L2 P2 X110 Y50 R90\nG0 X0 Y0\nG1 X10\nG55 X5 Y0\nG2 X5 Y-10 J-5\n";
    let path_of_systems = path(systems);
    assert_eq!(ends(&path_of_systems), ends(&path(plain)));
    let (one, other) = (arc_of(&path(plain).moves[3]), arc_of(&path_of_systems.moves[3]));
    // Turned by 90 deg and back: a few roundings of 0.1 m.
    assert!((one.centre - other.centre).norm() < 1e-16 && (one.sweep - other.sweep).abs() < 1e-12);
}

#[test]
fn work_offsets_may_be_given_as_parameters() {
    let program = "G21 F60\nG54 G0 X0 Y0\nG1 X1\nG55 X0\nG53 G0 Z0\n";
    let parameters = BTreeMap::from([(5221, 10.0), (5223, -7.0), (5241, 30.0), (5243, -7.0)]);
    let (path, _) = read(
        program,
        &Options {
            parameters,
            ..Options::default()
        },
    )
    .unwrap();
    assert_eq!(
        ends(&path),
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [20.0, 0.0, 0.0],
            [20.0, 0.0, 7.0]
        ]
    );
}

#[test]
fn holes_expand_into_moves() {
    let program =
        "G21 G90 G98 F60\nG0 X0 Y0 Z10\nG83 X1 Y1 Z-5 R2 Q3\nG80\nG99 G82 X2 Y2 Z-1 R2 P0.5\nX3\nG80\n";
    assert_eq!(
        moves_of(program),
        [
            "STRAIGHT_TRAVERSE(0.0000, 0.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(1.0000, 1.0000, -1.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, -0.7460, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(1.0000, 1.0000, -4.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, -3.7460, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(1.0000, 1.0000, -5.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(1.0000, 1.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(2.0000, 2.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(2.0000, 2.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(2.0000, 2.0000, -1.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(2.0000, 2.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(3.0000, 2.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(3.0000, 2.0000, -1.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(3.0000, 2.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
        ]
    );
}

/// The messages of a program.
fn say(program: &str) -> Vec<String> {
    let mut said = calls(program);
    said.retain(|call| call.starts_with("MESSAGE"));
    said
}

#[test]
fn flow_goes_where_it_is_told() {
    let number = |value: &str| format!("MESSAGE(\"{value}.000000\")");
    for (program, expected) in [
        (
            "#1=0\no1 while [#1 lt 5]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 elseif [#1 eq 4]\no1 break\no2 else\n(debug,#1)\no2 endif\no1 endwhile\n",
            &["1", "3"][..],
        ),
        (
            "#1=9\no1 do\n(debug,#1)\n#1=[#1-1]\no1 while [#1 gt 7]\n",
            &["9", "8"],
        ),
        (
            "#<n>=0\no1 repeat [3]\no2 repeat [2]\n#<n>=[#<n>+1]\no2 endrepeat\no1 endrepeat\n(debug,#<n>)\n",
            &["6"],
        ),
        (
            "o<twice> sub\no<twice> endsub [#1*2]\no<twice> call [21]\n(debug,#<_value>)\n",
            &["42"],
        ),
        (
            "o1 sub\no2 if [#1 gt 1]\no1 return [1]\no2 endif\n(debug,#1)\no1 endsub\no1 call [1]\no1 call [2]\n",
            &["1"],
        ),
        ("M98 P7 L2\nM2\nO7\n(debug,7)\nM99\n", &[]),
    ] {
        let expected: Vec<String> = expected.iter().map(|value| number(value)).collect();
        let said = say(program);
        if program.starts_with("M98") {
            assert_eq!(said, ["MESSAGE(\"7\")", "MESSAGE(\"7\")"]);
        } else {
            assert_eq!(said, expected, "{program}");
        }
    }
}

#[test]
fn numbered_subroutines_behind_the_end_come_in_any_order_and_the_next_of_two_counts() {
    let behind = "O9\n(debug,1)\nM99\nO8\n(debug,2)\nM99\nO9\n(debug,3)\nM99\n";
    assert_eq!(
        say(&format!("M98 P8\nM98 P9\nG4 P0\nM98 P8\nM2\n{behind}")),
        ["2", "1", "2"].map(|value| format!("MESSAGE(\"{value}\")"))
    );
    // Without M99 a subroutine goes on to the end of the file.
    assert_eq!(
        say("M98 P8\nM2\nO8\n(debug,1)\nO9\n(debug,2)\n"),
        ["1", "2"].map(|value| format!("MESSAGE(\"{value}\")"))
    );
}

#[test]
fn subroutines_come_from_other_files() {
    let lookup =
        |name: &str| (name == "far").then(|| "o<far> sub\nG0 X#1\nG1 Y1\no<far> endsub\n".to_owned());
    let options = Options {
        subroutines: Some(&lookup),
        ..Options::default()
    };
    let (path, _) = read("G21 F60\no<far> call [3]\n", &options).unwrap();
    assert_eq!(ends(&path), [[3.0, 0.0, 0.0], [3.0, 1.0, 0.0]]);
    assert_eq!(
        first_problem("G21\no<far> call [3]\n", &options),
        "far:3:1: G1 with a feed of zero",
        "problems are told of the file they stand in"
    );
}

#[test]
fn blocks_with_a_slash_are_left_out_where_wanted() {
    let program = "G21 F60 G0 X0\n/G1 X1\nG1 X2\n";
    assert_eq!(path(program).moves.len(), 3);
    let options = Options {
        block_delete: true,
        ..Options::default()
    };
    assert_eq!(read(program, &options).unwrap().0.moves.len(), 2);
}

#[test]
fn blanks_capitals_comments_and_numbers_mean_nothing() {
    let plain = path("G21 F60\nG0 X1.5 Y-2\nG1 X3\n");
    let odd = path("%\n( A ) n10 g 2 1 (B) f6 0 ; C\r\n N20 g0x 1 . 5y -2\nG01X+3.\n%\nG1 X9\n");
    assert_eq!(ends(&odd), ends(&plain));
}

#[test]
fn the_tool_axis_is_told_under_tool_centre_control() {
    let rotaries = Some(Rotaries {
        table: vec![Rotary::B],
        head: vec![Rotary::A],
    });
    let options = Options {
        rotaries,
        ..Options::default()
    };
    for (on, off) in [
        ("M128", "M129"),
        ("TRAORI", "TRAFOOF"),
        ("M428", "M429"),
        ("G43.4 H1", "G49"),
    ] {
        let program = format!("G21 F60\nG0 X0 A0 B0\n{on}\nG1 X1 A90 B0\nA0\n{off}\nX3\n");
        let (path, summary) = read(&program, &options).unwrap();
        let axes: Vec<_> = path.moves.iter().map(|next| next.axis).collect();
        assert_eq!(axes.len(), 4);
        assert_eq!((axes[0], axes[3]), (None, None));
        assert!(
            (axes[1].unwrap().into_inner() + Vector3::y()).norm() < 1e-15,
            "a rounding of cos 90 deg"
        );
        assert_eq!(axes[2].unwrap(), Vector3::z_axis());
        assert!(summary.tool_axis_told);
    }
    let (path, _) = read("G21 F60 G0 X0\nG43.5 H1\nG1 X1 I0 J3 K4\n", &Options::default()).unwrap();
    assert!((path.moves[1].axis.unwrap().into_inner() - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
}

#[test]
fn what_is_taken_for_granted_is_warned_of() {
    let program = "G0 X1\nG28\nM62 P1\nM101\nT1 M6 G43 H1\nG21 G91 F1\n";
    let (_, summary) = read(program, &Options::default()).unwrap();
    let warned: Vec<Warning> = summary.warnings.iter().map(|(warning, ..)| warning).collect();
    assert_eq!(
        warned,
        [
            Warning::UnitAssumed,
            Warning::HomeAssumed,
            Warning::MachineZeroAssumed,
            Warning::UserCode,
            Warning::Output,
            Warning::LengthUnknown
        ]
    );
    assert!(warned.iter().all(|warning| !warning.meaning().is_empty()));
    let (path, summary) = read("G21 F60\nG2 I5\n", &Options::default()).unwrap();
    assert_eq!(summary.warnings.of(Warning::StartAssumed), 1);
    assert_eq!(path.moves.len(), 2, "the arc has a start");
}

#[test]
fn bounds_hold_the_bulge_of_arcs() {
    let (_, summary) = read(
        "G21 F60\nG0 X10 Y0\nG3 X0 Y10 I-10 Z4\nG3 X0 Y-10 J-10\n",
        &Options::default(),
    )
    .unwrap();
    let [least, greatest] = summary.bounds.unwrap();
    // Turns of 10 mm round.
    assert!((least - Point3::new(-10e-3, -10e-3, 0.0)).norm() < 1e-16 * 20.0);
    assert!((greatest - Point3::new(10e-3, 10e-3, 4e-3)).norm() < 1e-16 * 20.0);
}

/// A contour that the cutter follows on its left; offsets worked out by hand.
#[test]
fn the_cutter_runs_beside_its_contour() {
    let square = "G21 F60\nG0 X-10 Y0\nG41.1 D4\nG1 X0\nX10\nY10\nX0\nY0\nG40\nG0 X-10\n";
    assert_eq!(
        moves_of(square),
        [
            "STRAIGHT_TRAVERSE(-10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(0.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(8.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(8.0000, 8.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(2.0000, 8.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_FEED(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "STRAIGHT_TRAVERSE(-10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
        ]
    );
    let outside = moves_of(&square.replace("G41.1", "G42.1"));
    assert_eq!(
        outside[2..4],
        [
            "STRAIGHT_FEED(10.0000, -2.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
            "ARC_FEED(12.0000, 0.0000, 10.0000, 0.0000, 1, 0.0000, 0.0000, 0.0000, 0.0000)",
        ]
    );
}

/// Programs, and what is said of them first.
const REFUSED: &[(&str, &str)] = &[
    ("G21 G1 X1", "1:5: G1 with a feed of zero"),
    ("G93 G1 X1", "1:5: G1 without its own F word in inverse time, G93"),
    (
        "G0 G1 X1",
        "1:4: G0 and G1 in one block, where only one of their group may stand",
    ),
    (
        "M3 M4",
        "1:4: M3 and M4 in one block, where only one of their group may stand",
    ),
    ("G0 X1 Y2 X3", "1:10: word X twice in a block"),
    ("G0 X1 R2", "1:7: word R is used by no code of this block"),
    (
        "G64 M19 R2 S1",
        "1:9: word R could belong to two codes of this block",
    ),
    ("G123.4", "1:1: unknown code G123.4"),
    ("M1000", "1:1: unknown code M1000"),
    ("G5 X1", "1:1: G5 is not read: splines and NURBS are not expanded"),
    (
        "G68.2 X1",
        "1:1: G68.2 is not read: tilted planes need the machine's kinematics",
    ),
    (
        "G38.2 X1 F1",
        "1:1: G38.2 is not read: where a probe stops is not in the program",
    ),
    ("G38.2 F1", "1:1: G38.2 without any axis word"),
    ("M70", "1:1: M70 is not read: saved modal states are not kept"),
    (
        "G0 @5 ^3",
        "1:4: @ is not read: polar words and spindle numbers are not understood",
    ),
    ("G0 X!", "1:4: expected a number, found `!`"),
    ("G0 !", "1:4: `!` begins no word"),
    ("G0 X1.2.3", "1:4: expected a number, found `1.2.3`"),
    ("G0 (open", "1:4: comment without `)` at its end"),
    ("G0 X[1+2", "1:4: expected `]`"),
    ("#5=", "1:1: expected a number, found ``"),
    ("#5 6", "1:1: expected `=`"),
    ("G0 X#<none>", "1:4: parameter #<none> was never set"),
    ("G0 X#<none", "1:4: name of a parameter without `>` at its end"),
    (
        "G0 X#9999",
        "1:4: parameter #9999 does not exist: they run from 1 to 5602",
    ),
    ("#5420=1", "1:1: parameter #5420 cannot be set"),
    ("#<_x>=1", "1:1: parameter #<_x> cannot be set"),
    ("G0 X[1/0]", "1:4: an operation has no real value here"),
    ("G0 Xfoo[1]", "1:4: `foo` is no function or operator"),
    ("G0 X1e10", "1:6: word E is used by no code of this block"),
    ("G0 X[10**12]", "1:4: word X is 1000000000000: must be within 1e9"),
    ("X1", "1:1: axis words without a code that moves"),
    ("G53 G2 X1 I1 F1", "1:5: G53 needs G0 or G1"),
    (
        "G92 G1 X1 F1",
        "1:5: G92 and G1 both want the axis words of this block",
    ),
    ("G92", "1:1: G92 without any axis word"),
    ("G4", "1:1: G4 without P word"),
    ("G10 P1 X0", "1:1: G10 without L word"),
    ("G10 L3 P1 X0", "1:5: word L is 3: must be 1, 2, 10, 11 or 20"),
    ("G10 L2 P12 X0", "1:8: word P is 12: must be 0 to 9"),
    ("T1.5", "1:1: word T is 1.5: must be a whole number"),
    ("F-1", "1:1: word F is -1: must be at least 0"),
    ("M61", "1:1: M61 without Q word"),
    ("G2 X1 F1", "1:1: arc without I, J, K or R"),
    ("G2 X1 I1 R1 F1", "1:1: arc with both R and a centre"),
    ("G2 X10 R2 F1", "1:1: arc of radius 2 whose ends are 10 apart"),
    (
        "G2 R2 F1",
        "1:1: arc with R that ends where it starts: it could be any circle",
    ),
    ("G2 X1 I0 F1", "1:1: arc of no radius"),
    (
        "G2 X3 I1 F1",
        "1:1: arc of radius 1 at its start and 2 at its end: they may differ by 0.028284271247461905",
    ),
    (
        "G2 I1 P0.5 F1",
        "1:7: word P is 0.5: must be a whole number of turns, 1 to 10000",
    ),
    ("F1 G81 X1 Z-1", "1:4: G81 without R word"),
    ("F1 G81 X1 R1", "1:4: G81 without Z word"),
    ("F1 G83 X1 Z-1 R1", "1:4: G83 without Q word"),
    ("F1 G83 X1 Z-1 R1 Q0", "1:18: word Q is 0: must be above 0"),
    ("F1 G82 X1 Z-1 R1", "1:4: G82 without P word"),
    (
        "F1 G81 X1 Z1 R0",
        "1:14: canned cycle whose R at 0 is below its bottom at 1",
    ),
    ("F1 G81 X1 Z0 R1 A5", "1:17: A in a canned cycle"),
    ("F1 G81", "1:4: G81 without any axis word"),
    (
        "F1 G81 X1 Z0 R1 L1.5",
        "1:17: word L is 1.5: must be a whole number of holes, at most 100000",
    ),
    (
        "F1 G83 X1 Z-1000 R0 Q0.001",
        "1:4: more than 100000 steps in one hole",
    ),
    ("G41 D1", "1:5: diameter of tool 1 is not told"),
    ("G19 G41.1 D1", "1:5: cutter compensation in the YZ plane"),
    ("G41.1 D1\nG42.1 D1", "2:1: cutter compensation is on already"),
    ("G41.1 D1\nT1 M6", "2:4: M6 while cutter compensation is on"),
    ("G41.1 D1\nG92 X0", "2:1: G92 while cutter compensation is on"),
    ("G41.1 D1\nG18", "2:1: G18 while cutter compensation is on"),
    (
        "F1 G41.1 D2\nG1 X1\nG40\nG2 X2 I0.5",
        "4:1: move after cutter compensation that is no straight line",
    ),
    (
        "F1 G41.1 D2\nG1 X9\nX10\nY0.5\nX0\nY-9",
        "5:1: corner that a cutter of radius 1 cannot reach without gouging",
    ),
    (
        "F1 G41.1 D2\nG3 X1 Y0.5 I0.5 J0.25",
        "2:1: arc of radius 0.5590169943749475 that a cutter of radius 1 cannot follow inside",
    ),
    (
        "o1 sub\no2 sub\no2 endsub\no1 endsub",
        "2:1: subroutine inside a subroutine",
    ),
    ("o1 endif", "1:1: o-word `1` that nothing begins"),
    ("o1 if [1]\nG0 X1", "1:1: o-word `1` that nothing ends"),
    (
        "o1 repeat [2]\no2 endwhile\no1 endrepeat",
        "2:1: o-word `2` that nothing begins",
    ),
    ("o1 iff [1]", "1:1: `iff` is no o-word"),
    ("o1 sub\no1 endsub\no1 call 5", "3:9: words behind an o-word"),
    ("o9 call", "1:1: subroutine 9 is not known"),
    ("M98 P9", "1:1: subroutine 9 is not known"),
    ("M98", "1:1: M98 without P word"),
    (
        "M98 P9 L-1",
        "1:8: word L is -1: must be a whole number, at most 9999",
    ),
    (
        "o1 sub\no1 call\no1 endsub\no1 call",
        "2:1: subroutines called more than 100 deep",
    ),
    (
        "G21 F1 A30 G0\nG1 X1",
        "2:1: cut with A at 30 deg and no tool-centre control",
    ),
    (
        "M128\nG0 C30",
        "2:4: C turns under tool-centre control, and how the machine's rotary axes stand is not told",
    ),
    ("G43.5 H0 G0 I0", "1:10: tool axis I, J, K of no length"),
    (
        "F1 G1 X1\nX2\nG55 X3",
        "3:1: cut in G55 after cuts in G54, and where one lies to the other is not told",
    ),
    (
        "F1 G53 G1 X1",
        "1:8: cut in machine coordinates, and where the workpiece lies in them is not told",
    ),
];

#[test]
fn what_is_wrong_is_told_with_its_place() {
    let mut wrong = Vec::new();
    for (program, expected) in REFUSED {
        let said = match read(program, &Options::default()) {
            Ok(_) => "accepted".to_owned(),
            Err(problems) => problems.as_slice()[0].to_string(),
        };
        if said != format!("p.ngc:{expected}") {
            wrong.push(format!("{program:?}: {said}, expected {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_machine_without_the_axis_refuses_it() {
    let options = Options {
        rotaries: Some(Rotaries::table_ac()),
        ..Options::default()
    };
    assert_eq!(
        first_problem("M128\nG0 B30\n", &options),
        "p.ngc:2:4: B turns, and the machine described has no such axis"
    );
}

#[test]
fn a_tool_table_knows_its_tools() {
    let tools = BTreeMap::from([(
        2,
        Tool {
            orientation: 3,
            ..Tool::default()
        },
    )]);
    let options = Options {
        tools: Some(ToolTable {
            unit: LengthUnit::Millimetre,
            tools,
        }),
        ..Options::default()
    };
    assert_eq!(
        first_problem("T7 M6\n", &options),
        "p.ngc:1:1: tool 7 is not in the tool table"
    );
    assert_eq!(
        first_problem("G41 D2\n", &options),
        "p.ngc:1:5: tool 2 is a turning tool, with orientation 3"
    );
}

#[test]
fn all_problems_of_a_program_are_told_at_once_up_to_a_limit() {
    let problems = read("G21\nG1 X1\nG0 X2\nG777\nF60 G1 X3 Q4\n", &Options::default()).unwrap_err();
    let lines: Vec<usize> = problems.as_slice().iter().map(Problem::line).collect();
    assert_eq!(lines, [2, 4, 5]);
    let many = "G777\n".repeat(1000);
    assert_eq!(
        read(&many, &Options::default()).unwrap_err().as_slice().len(),
        100
    );
    let again = "o1 repeat [50]\nG777\no1 endrepeat\n";
    assert_eq!(
        read(again, &Options::default()).unwrap_err().as_slice().len(),
        1,
        "a line is told once"
    );
}

#[test]
fn what_is_no_text_or_too_long_is_refused_not_held() {
    let long = format!("G21\nG0 X{}\n", "1".repeat(100_000));
    assert_eq!(
        first_problem(&long, &Options::default()),
        "p.ngc:2:1: line of more than 4096 bytes"
    );
    let bytes = b"\xef\xbb\xbfG21 (\xff\xfe) F60\nG1 X\xff1\n".to_vec();
    let outcome = gcode::read("p.ngc", &mut bytes.as_slice(), &Options::default(), &mut |_| {});
    let problems = outcome.unwrap_err();
    assert_eq!(problems.as_slice()[0].line(), 2);
    assert_eq!(problems.as_slice()[0].column(), 4);
}

#[test]
fn programs_that_never_end_are_stopped() {
    let program = "o1 while [1]\n(round)\no1 endwhile\n";
    assert_eq!(
        first_problem(program, &Options::default()).split(": ").nth(1),
        Some("more than 20000000 lines of loops and subroutines to be done")
    );
}

#[test]
fn an_endless_loop_ends_and_sooner_after_a_line_that_was_refused() {
    let told = |program: &str, most_repeated_lines| {
        let options = Options {
            most_repeated_lines,
            ..Options::default()
        };
        read(program, &options).unwrap_err().to_string()
    };
    let endless = told("o1 while [1]\nG1 X1 F100\no1 endwhile\nM2\n", Some(1000));
    assert!(endless.contains("1000"), "{endless}");
    // Its end was refused: nothing counts down.
    let broken = told(
        "#<n>=3\no1 while [#<n> GT 0]\n#<n>=[<->1]\no1 endwhile\nM2\n",
        None,
    );
    assert!(
        broken.contains("3:") && broken.matches("error:").count() == 2,
        "{broken}"
    );
}
