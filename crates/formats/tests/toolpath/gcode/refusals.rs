//! Every refusal once, with its position.

use std::collections::BTreeMap;

use armill_formats::document::Problem;
use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{self, GcodeReadOptions, Rotaries, Tool, ToolTable};

use super::program::{first_problem, read};

/// Programs, and their first problem.
const REFUSED: &[(&str, &str)] = &[
    ("G21 G1 X1", "1:5: G1 with a feed of zero"),
    ("G93 G1 X1", "1:5: G1 without its own F word in inverse time, G93"),
    (
        "G0 G1 X1",
        "1:4: G0 and G1 in one block, but only one code of their group is allowed",
    ),
    (
        "M3 M4",
        "1:4: M3 and M4 in one block, but only one code of their group is allowed",
    ),
    ("G0 X1 Y2 X3", "1:10: word X twice in a block"),
    ("G0 X1 R2", "1:7: word R is used by no code of this block"),
    (
        "G64 M19 R2 S1",
        "1:9: word R could belong to two codes of this block",
    ),
    ("G123.4", "1:1: unknown code G123.4"),
    ("M1000", "1:1: unknown code M1000"),
    (
        "G5 X1",
        "1:1: G5 is not supported: splines and NURBS are not expanded",
    ),
    (
        "G68.2 X1",
        "1:1: G68.2 is not supported: tilted planes need the machine's kinematics",
    ),
    (
        "G38.2 X1 F1",
        "1:1: G38.2 is not supported: where a probe stops is not in the program",
    ),
    ("G38.2 F1", "1:1: G38.2 without any axis word"),
    (
        "M70",
        "1:1: M70 is not supported: saved modal states are not kept",
    ),
    (
        "G0 @5 ^3",
        "1:4: @ is not supported: polar words and spindle numbers are not understood",
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
    ("G0 Xfoo[1]", "1:4: `foo` is not a function or operator"),
    ("G0 X1e10", "1:6: word E is used by no code of this block"),
    ("G0 X[10**12]", "1:4: word X is 1000000000000: must be within 1e9"),
    (
        "G93 F1\nG1 X1000 F[10**306]",
        "2:10: word F is 1000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000: must be within 1e9",
    ),
    ("S[10**10] M3", "1:1: word S is 10000000000: must be within 1e9"),
    (
        "G10 L2 P1 X[0-10**10]",
        "1:11: word X is -10000000000: must be within 1e9",
    ),
    (
        "#5241=[10**10]\nG55",
        "2:1: offset in parameter #5241 is 10000000000: must be within 1e9",
    ),
    (
        "G43.5 H0\nG1 X1 F1 K[10**[0-200]]",
        "2:1: tool axis I, J, K of length 0: must be from 1e-6 to 1e6",
    ),
    ("X1", "1:1: axis words without a code that moves"),
    ("G53 G2 X1 I1 F1", "1:5: G53 needs G0 or G1"),
    (
        "G92 G1 X1 F1",
        "1:5: G92 and G1 both need the axis words of this block",
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
    ("G2 X1 I0 F1", "1:1: arc with radius 0"),
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
    ("G41 D1", "1:5: diameter of tool 1 is not given"),
    ("G19 G41.1 D1", "1:5: cutter compensation in the YZ plane"),
    ("G41.1 D1\nG42.1 D1", "2:1: cutter compensation is on already"),
    ("G41.1 D1\nT1 M6", "2:4: M6 while cutter compensation is on"),
    ("G41.1 D1\nG92 X0", "2:1: G92 while cutter compensation is on"),
    ("G41.1 D1\nG18", "2:1: G18 while cutter compensation is on"),
    (
        "F1 G41.1 D2\nG1 X1\nG40\nG2 X2 I0.5",
        "4:1: move after cutter compensation that is not a straight line",
    ),
    (
        "F1 G41.1 D2\nG1 X9\nX10\nY0.5\nX0\nY-9",
        "4:1: corner that a cutter of radius 1 cannot reach without gouging",
    ),
    // The crossing is before the start of a line, or after its end: the cutter would go backwards into the floor.
    (
        "G21 G90 G0 X-60 Y0\nG41.1 D10\nG1 X-40 Y0 F100\nX0\nY2\nX40\nG40 Y50",
        "5:1: corner that a cutter of radius 5 cannot reach without gouging",
    ),
    // The same for an arc, which would go nearly once around.
    (
        "G21 G90 G0 X-60 Y0\nG41.1 D10\nG1 X-40 Y0 F100\nX0\nG3 X1.7431 Y0.0761 I0 J20\nG1 X0.8716 Y10.0381",
        "6:1: corner that a cutter of radius 5 cannot reach without gouging",
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
    ("o1 iff [1]", "1:1: `iff` is not an o-word"),
    ("o1 sub\no1 endsub\no1 call 5", "3:9: words after an o-word"),
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
        "2:4: C rotates under tool-centre control, but the arrangement of the machine's rotary axes is not given",
    ),
    (
        "G43.5 H0 G0 I0",
        "1:10: tool axis I, J, K of length 0: must be from 1e-6 to 1e6",
    ),
    (
        "F1 G1 X1\nX2\nG55 X3",
        "3:1: cut in G55 after cuts in G54, but their relative position is not given",
    ),
    (
        "F1 G53 G1 X1",
        "1:8: cut in machine coordinates, but the position of the workpiece in them is not given",
    ),
];

#[test]
fn problems_are_reported_with_their_positions() {
    let mut wrong = Vec::new();
    for (program, expected) in REFUSED {
        let said = match read(program, &GcodeReadOptions::default()) {
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
    let expected = GcodeReadOptions {
        rotaries: Some(Rotaries::table_ac()),
        ..GcodeReadOptions::default()
    };
    assert_eq!(
        first_problem("M128\nG0 B30\n", &expected),
        "p.ngc:2:4: B rotates, but the specified machine has no such axis"
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
    let expected = GcodeReadOptions {
        tools: Some(ToolTable {
            unit: LengthUnit::Millimetre,
            tools,
        }),
        ..GcodeReadOptions::default()
    };
    assert_eq!(
        first_problem("T7 M6\n", &expected),
        "p.ngc:1:1: tool 7 is not in the tool table"
    );
    assert_eq!(
        first_problem("G41 D2\n", &expected),
        "p.ngc:1:5: tool 2 is a turning tool, with orientation 3"
    );
}

/// Exceeded maxima: named parameters, calls that wait for the next move, arguments.
#[test]
fn refuses_exceeded_maxima() {
    let names: String = (0..10_001).map(|k| format!("#<_n{k}>=1\n")).collect();
    let waits = format!("F1 G41.1 D2\nG1 X1\n{}G1 X2\n", "S1\n".repeat(10_001));
    let arguments = format!("o1 sub\no1 endsub\no1 call {}\n", "[1] ".repeat(31));
    for (program, expected) in [
        (names, "p.ngc:10001:1: more than 10000 named parameters"),
        (
            waits,
            "p.ngc:10003:1: more than 10000 calls between two moves of cutter compensation",
        ),
        (arguments, "p.ngc:3:9: call with more than 30 arguments"),
    ] {
        assert_eq!(first_problem(&program, &GcodeReadOptions::default()), expected);
    }
}

#[test]
fn reports_a_failing_reader() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("no disk"))
        }
    }
    let begun = std::io::Read::chain(&b"G21\nG0 X1\n"[..], std::io::BufReader::new(Broken));
    let problems = gcode::read("p.ngc", begun, &GcodeReadOptions::default(), &mut |_| {}).unwrap_err();
    assert!(
        problems
            .to_string()
            .contains("p.ngc:2:1: cannot be read further: no disk"),
        "{problems}"
    );
}

#[test]
fn hints_name_what_can_be_done() {
    let hint = |program: &str| {
        let problems = read(program, &GcodeReadOptions::default()).unwrap_err();
        problems.as_slice()[0].hint().unwrap_or_default().to_owned()
    };
    assert!(hint("F1 G83 X1 Z-1000 R0 Q0.001").contains("the step Q"));
    assert!(hint("F1 G53 G1 X1").contains("G10 L2"));
    assert!(hint("F1 G1 X1\nX2\nG55 X3").contains("G10 L2"));
}

#[test]
fn all_problems_of_a_program_are_reported_together_up_to_a_maximum() {
    let problems = read(
        "G21\nG1 X1\nG0 X2\nG777\nF60 G1 X3 Q4\n",
        &GcodeReadOptions::default(),
    )
    .unwrap_err();
    let lines: Vec<usize> = problems.as_slice().iter().map(Problem::line).collect();
    assert_eq!(lines, [2, 4, 5]);
    let many = "G777\n".repeat(1000);
    assert_eq!(
        read(&many, &GcodeReadOptions::default())
            .unwrap_err()
            .as_slice()
            .len(),
        100
    );
    let again = "o1 repeat [50]\nG777\no1 endrepeat\n";
    assert_eq!(
        read(again, &GcodeReadOptions::default())
            .unwrap_err()
            .as_slice()
            .len(),
        1,
        "a line is reported once"
    );
}

#[test]
fn refuses_binary_text_and_long_lines_without_storing_them() {
    let long = format!("G21\nG0 X{}\n", "1".repeat(100_000));
    assert_eq!(
        first_problem(&long, &GcodeReadOptions::default()),
        "p.ngc:2:1: line of more than 4096 bytes"
    );
    let bytes = b"\xef\xbb\xbfG21 (\xff\xfe) F60\nG1 X\xff1\n".to_vec();
    let outcome = gcode::read(
        "p.ngc",
        &mut bytes.as_slice(),
        &GcodeReadOptions::default(),
        &mut |_| {},
    );
    let problems = outcome.unwrap_err();
    assert_eq!(problems.as_slice()[0].line(), 2);
    assert_eq!(problems.as_slice()[0].column(), 4);
}
