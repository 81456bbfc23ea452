//! Offsets, coordinate systems, the axis of the tool, and what is taken for granted of them.

use std::collections::BTreeMap;

use armill_core::nalgebra::Vector3;
use armill_formats::toolpath::gcode::{GcodeReadOptions, Rotaries, Rotary, Warning};

use super::program::{arc_of, ends, path, read};

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
        &GcodeReadOptions {
            parameters,
            ..GcodeReadOptions::default()
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
fn the_tool_axis_is_given_under_tool_centre_control() {
    let rotaries = Some(Rotaries {
        table: vec![Rotary::B],
        head: vec![Rotary::A],
    });
    let expected = GcodeReadOptions {
        rotaries,
        ..GcodeReadOptions::default()
    };
    for (on, off) in [
        ("M128", "M129"),
        ("TRAORI", "TRAFOOF"),
        ("M428", "M429"),
        ("G43.4 H1", "G49"),
    ] {
        let program = format!("G21 F60\nG0 X0 A0 B0\n{on}\nG1 X1 A90 B0\nA0\n{off}\nX3\n");
        let (path, _) = read(&program, &expected).unwrap();
        let axes: Vec<_> = path.moves.iter().map(|next| next.axis).collect();
        assert_eq!(axes.len(), 4);
        assert_eq!((axes[0], axes[3]), (None, None));
        assert!(
            (axes[1].unwrap().into_inner() + Vector3::y()).norm() < 1e-15,
            "a rounding of cos 90 deg"
        );
        assert_eq!(axes[2].unwrap(), Vector3::z_axis());
    }
    let (path, _) = read(
        "G21 F60 G0 X0\nG43.5 H1\nG1 X1 I0 J3 K4\nJ4 K3\n",
        &GcodeReadOptions::default(),
    )
    .unwrap();
    for (next, axis) in path.moves[1..].iter().zip([[0.0, 0.6, 0.8], [0.0, 0.8, 0.6]]) {
        assert!((next.axis.unwrap().into_inner() - Vector3::from(axis)).norm() < 1e-15);
    }
    assert_eq!(path.moves.len(), 3, "a tool that turns on the spot moves");
}

#[test]
fn assumptions_are_noted() {
    let program = "G0 X1\nG28\nM62 P1\nM101\nT1 M6 G43 H1\nG21 G91 F1\n";
    let (_, summary) = read(program, &GcodeReadOptions::default()).unwrap();
    let expected = [
        (Warning::UnitAssumed, 1),
        (Warning::HomeAssumed, 2),
        (Warning::MachineZeroAssumed, 2),
        (Warning::UserCode, 4),
        (Warning::Output, 3),
        (Warning::LengthUnknown, 5),
    ];
    let expected =
        expected.map(|(warning, line)| format!("{} (once, first in line {line})", warning.meaning()));
    assert_eq!(summary.notes, expected);
    let (path, summary) = read("G21 F60\nG2 I5\n", &GcodeReadOptions::default()).unwrap();
    let note = format!("{} (once, first in line 2)", Warning::StartAssumed.meaning());
    assert_eq!(summary.notes, [note]);
    assert_eq!(path.moves.len(), 2, "the arc has a start");
}
