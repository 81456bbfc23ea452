//! Robot programs as paths of a study: their placement, their postures, their errors.

use crate::{CELL, LOAD, analysis, reported};

/// A square in the frame of the program, whose controller counts 450 mm above the floor: 500 mm high.
const SQUARE: &str = "&ACCESS RVP\r\nDEF part ( )\r\n$BASE={X 1000,Y 50,Z 50,A 0,B 0,C 0}\r\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\r\n\
    PTP {X -40,Y -40,Z 0,A 0,B 180,C 0,S 2,T 35}\r\n$VEL.CP=0.01\r\nLIN {X 40,Y -40,Z 0,A 0,B 180,C 0}\r\n\
    LIN {X 40,Y 40,Z 0,A 0,B 180,C 0}\r\n$VEL.CP=0.5\r\nLIN {X 40,Y 40,Z 60,A 0,B 180,C 0}\r\nEND\r\n";

/// A plate with the axes of the base, whose centre is the zero of the square.
fn cell() -> String {
    let cell = CELL.replace("tilt_deg = 90", "rotation_deg = [0, 0, 0]");
    cell.replace("posture = { branch = \"front elbow-up no-flip\" }\n", "")
}

fn study(program: &str) -> String {
    format!("{}{LOAD}{}", cell(), analysis(program))
}

#[test]
fn a_program_of_a_robot_has_the_numbers_of_the_same_path_in_gcode_wherever_its_frame_is_reported() {
    let gcode = "G21 G90\nG0 X-40 Y-40 Z0\nG1 X40 F600\nG1 Y40\nG1 Z60 F30000\nM2\n";
    let of = |study: &str, files: &[(&str, &str)]| reported(study, files).unwrap().paths[0].clone();
    // The tip is on axis 6, so that a force there turns nothing about it: the spin has no effect.
    let drawn = of(&study("file = \"a.ngc\""), &[("a.ngc", gcode)]);
    let by_number = SQUARE.replace("{X 1000,Y 50,Z 50,A 0,B 0,C 0}", "BASE_DATA[3]");
    let by_name = SQUARE.replace("LIN {X 40,Y 40,Z 0,A 0,B 180,C 0}", "LIN XP1");
    let data = "DEFDAT a\nDECL E6POS XP1={X 40,Y 40,Z 0,A 0,B 180,C 0,S 2,T 35}\nENDDAT\n";
    for (program, text) in [
        ("file = \"a.src\"", SQUARE),
        (
            "file = \"a.src\"\nframe_mm_deg = [1000, 50, 50, 0, 0, 0]",
            &by_number,
        ),
        (
            "file = \"a.src\"\npart_from_path_mm_deg = [0, 0, 0, 0, 0, 0]",
            &by_number,
        ),
        (
            "file = \"a.src\"\npart_from_path_mm_deg = [0, 0, 0, 0, 0, 0]",
            &SQUARE.replace("X 1000", "X 4000"),
        ),
        ("file = \"a.src\"", &by_name),
        ("file = \"A.DAT\"", &by_name),
    ] {
        let data_file = if program.contains("DAT") {
            ["A.src", "A.DAT"]
        } else {
            ["a.src", "a.dat"]
        };
        let robot = of(&study(program), &[(data_file[0], text), (data_file[1], data)]);
        let found = robot.program.as_ref().unwrap();
        assert_eq!(
            (found.format, found.moves, robot.points),
            ("krl", 4, drawn.points)
        );
        assert!((found.cutting_time_s - 16.12).abs() < 1e-9);
        for (a, b) in [
            (robot.max_in_plane_um, drawn.max_in_plane_um),
            (robot.max_cross_um, drawn.max_cross_um),
            (robot.max_axial_um, drawn.max_axial_um),
        ] {
            // Rounding of angles given in degrees.
            assert!(
                (a.unwrap() / b.unwrap() - 1.0).abs() < 1e-9,
                "{program}: {a:?} {b:?}"
            );
        }
        let notes = robot.notes.join("\n");
        assert!(
            notes.contains("line 5: the posture front elbow-up no-flip"),
            "{notes}"
        );
        assert_eq!(
            notes.contains("the plane of the study does not change it"),
            !program.contains("part_from") && !program.contains("frame_mm")
        );
    }
    // What is faster cuts nothing.
    let slow = of(
        &study("file = \"a.src\"\ncuts_up_to_mm_per_min = 600"),
        &[("a.src", SQUARE)],
    );
    assert!((slow.length_mm - 160.0).abs() < 1e-9);
}

#[test]
fn the_posture_is_that_of_the_program_unless_the_study_gives_it() {
    let rear = SQUARE.replace("S 2,T 35", "S 6,T 35");
    let branch = |posture: &str| {
        let study = format!(
            "{}{posture}{LOAD}{}",
            cell(),
            analysis("file = \"a.src\"\nlimits = false")
        );
        reported(&study, &[("a.src", &rear)]).unwrap().paths[0]
            .branch
            .clone()
    };
    assert_eq!(branch(""), "front elbow-up flip");
    assert_eq!(
        branch("posture = { branch = \"no-flip\" }\n"),
        "front elbow-up no-flip"
    );
}

#[test]
fn errors_of_a_robot_program_are_reported_with_a_hint() {
    let by_number = SQUARE.replace("{X 1000,Y 50,Z 50,A 0,B 0,C 0}", "BASE_DATA[3]");
    let without = SQUARE.replace("$BASE={X 1000,Y 50,Z 50,A 0,B 0,C 0}", "");
    let longer = SQUARE.replace("Z 150", "Z 152");
    let unknown = SQUARE.replace("LIN {X 40,Y 40,Z 0,", "LINX {X 40,Y 40,Z 0,");
    let nameless = SQUARE.replace("LIN {X 40,Y 40,Z 0,A 0,B 180,C 0}", "LIN XP7");
    let joints = "DEF a()\n$BASE=$NULLFRAME\nPTP {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n";
    for (program, text, words) in [
        (
            "",
            by_number.as_str(),
            &[
                "line 7: coordinates are relative to frame 3 of the controller",
                "frame_mm_deg = [x, y, z",
            ][..],
        ),
        ("", &without, &["does not define the frame", "frame_mm_deg"]),
        (
            "frame_mm_deg = [0, 0, 0, 0, 0, 0]",
            SQUARE,
            &[
                "the program already defines its frame",
                "leave `frame_mm_deg` out",
            ],
        ),
        (
            "frame_mm_deg = [0, 0, 0, 0, 0, 0]\npart_from_path_mm_deg = [0, 0, 0, 0, 0, 0]",
            &by_number,
            &["both specify the placement"],
        ),
        (
            "unit = \"inch\"",
            SQUARE,
            &["`unit` is not valid for a robot program (KUKA KRL)"],
        ),
        (
            "",
            &longer,
            &[
                "tool is at 0, 0, 152 mm",
                "2.000 mm from the tip of the study's tool",
                "[0, 0, 152, 0, 0, 0]",
            ],
        ),
        ("", &unknown, &["a.src:8:1", "`LINX` is an unsupported move"]),
        ("", &nameless, &["a.src:8:5", "XP7"]),
        (
            "",
            joints,
            &["no cutting move", "moves of the joints cut nothing"],
        ),
        ("", "DEF a()\nEND\n", &["the program contains no moves"]),
        (
            "cuts_up_to_mm_per_min = 1",
            SQUARE,
            &["no cutting move", "cuts_up_to_mm_per_min"],
        ),
    ] {
        let error = reported(
            &study(&format!("file = \"a.src\"\n{program}")),
            &[("a.src", text)],
        )
        .unwrap_err();
        for word in words {
            assert!(error.contains(word), "no `{word}` in\n{error}");
        }
    }
    let gcode = reported(
        &study("file = \"a.ngc\"\nframe_mm_deg = [0, 0, 0, 0, 0, 0]"),
        &[("a.ngc", "G21 G90\nG0 X0 Y0\nG1 X9 F60\nM2\n")],
    );
    assert!(gcode.unwrap_err().contains("is not a robot program"));
}

#[test]
fn unknown_lines_calls_and_loops_are_noted_with_their_lines() {
    let text = SQUARE.replace("$VEL.CP=0.5", "LOOP\r\nZange(1)\r\nENDLOOP\r\n$VEL.CP=0.5");
    let found = reported(&study("file = \"a.src\"\nlimits = false"), &[("a.src", &text)]).unwrap();
    let notes = found.paths[0].notes.join("\n");
    assert!(
        notes.contains("line 9: `LOOP`") && notes.contains("line 10: `Zange` is called"),
        "{notes}"
    );
}
