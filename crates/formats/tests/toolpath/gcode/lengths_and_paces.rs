//! Lengths, speeds, operations; how a program is written.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use armill_core::path::{Command, Pace};
use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{GcodeReadOptions, Tool, ToolTable, Warning};

use super::program::{calls, ends, path, read};

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
fn a_cycle_that_stops_the_spindle_starts_it_again_as_it_turned() {
    for (start, called) in [
        ("M3", "START_SPINDLE_CLOCKWISE(0)"),
        ("M4", "START_SPINDLE_COUNTERCLOCKWISE(0)"),
    ] {
        for cycle in ["G86", "G88"] {
            let program = format!("G21 S60 {start}\nG0 X0 Y0 Z5\n{cycle} X1 Z-1 R1 P0 F60\n");
            let calls = calls(&program);
            let starts = calls.iter().filter(|call| call.starts_with("START_SPINDLE"));
            assert!(
                starts.clone().count() == 2 && starts.clone().all(|call| call == called),
                "{calls:?}"
            );
        }
    }
}

#[test]
fn the_feed_of_a_block_uses_the_unit_of_that_block() {
    for program in [
        "G21 F60\nG0 X0\nG20 F60 G1 X1\n",
        "G21 F60\nG0 X0\nF60 G1 G20 X1\n",
    ] {
        // 60 inches a minute are 25.4 mm/s; roundings of a quotient.
        let Pace::Feed(feed) = path(program).moves[1].pace else {
            panic!("no feed")
        };
        assert!((feed - 25.4e-3).abs() < 1e-15, "{program}");
    }
    // A line of the same number in another file is another line.
    let lookup = |name: &str| (name == "far").then(|| "(far)\nG20\nG1 X1\n".to_owned());
    let expected = GcodeReadOptions {
        subroutines: Some(&lookup),
        ..GcodeReadOptions::default()
    };
    let (far, _) = read("G21 G0 X0\nF60\no<far> call\n", &expected).unwrap();
    assert_eq!(
        far.moves[1].pace,
        Pace::Feed(1e-3),
        "a feed given before keeps its speed"
    );
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
    let expected = GcodeReadOptions {
        tools: Some(ToolTable {
            unit: LengthUnit::Millimetre,
            tools,
        }),
        ..GcodeReadOptions::default()
    };
    let program = "G21 T2 M6\nG0 X0\nS600 M3\nG1 X1 F60\nG0 Z9\nM5\nG0 X0\nS1200 M3\nG1 X5\nX6\nM2\n";
    let (path, summary) = read(program, &expected).unwrap();
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
    let (path, summary) = read(
        "G21 G95 F0.5\nG1 X1\nX2\nS600 M3\nX4\n",
        &GcodeReadOptions::default(),
    )
    .unwrap();
    assert_eq!(path.moves[1].pace, Pace::Unknown);
    assert_eq!(path.moves[2].pace, Pace::Feed(5e-3));
    let note = format!("{} (twice, first in line 2)", Warning::SpindleStopped.meaning());
    assert_eq!(summary.notes, [note]);
    assert_eq!(
        (summary.moves, summary.cuts),
        (3, 2),
        "the first gives the position of the tip"
    );
}

#[test]
fn blanks_capitals_comments_and_numbers_mean_nothing() {
    let plain = path("G21 F60\nG0 X1.5 Y-2\nG1 X3\n");
    let odd = path("%\n( A ) n10 g 2 1 (B) f6 0 ; C\r\n N20 g0x 1 . 5y -2\nG01X+3.\n%\nG1 X9\n");
    assert_eq!(ends(&odd), ends(&plain));
}

#[test]
fn every_line_end_ends_a_block() {
    let plain = "G21 F60\nG0 X1\nG1 X2\n; done\n";
    for end in ["\r", "\r\n"] {
        let other = path(&plain.replace('\n', end));
        assert_eq!(other.moves, path(plain).moves, "{end:?}");
    }
}

#[test]
fn blocks_with_a_slash_are_left_out_on_request() {
    let program = "G21 F60 G0 X0\n/G1 X1\nG1 X2\n";
    assert_eq!(path(program).moves.len(), 3);
    let expected = GcodeReadOptions {
        block_delete: true,
        ..GcodeReadOptions::default()
    };
    assert_eq!(read(program, &expected).unwrap().0.moves.len(), 2);
}

#[test]
fn coolant_dwells_and_stops_are_commands_between_moves() {
    let found = path("G21 G90 F100\nM8\nG0 X0 Y0 Z5\nG1 Z0\nG4 P0.3\nM7 M8\nG4 P0\nG1 X5\nM9\nM0\nM2\n");
    assert_eq!(
        found.commands,
        [
            (0, Command::Coolant(true)),
            (2, Command::Dwell(0.3)),
            (2, Command::Coolant(true)),
            (3, Command::Coolant(false)),
            (3, Command::Stop),
        ]
    );
}
