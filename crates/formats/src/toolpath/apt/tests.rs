//! Programs of our own in both dialects, and every way in which they can be wrong.

use std::f64::consts::{PI, TAU};

use armill_core::nalgebra::{Point3, Rotation3, Vector3};
use armill_core::path::{Arc, Course, Move, Operation, Pace, Step};

use super::*;

fn steps(text: &str, wanted: &Wanted) -> Result<(Summary, Vec<Step>), Problems> {
    let mut steps = Vec::new();
    let summary = read("part.apt", text.as_bytes(), wanted, &mut |step| steps.push(step))?;
    Ok((summary, steps))
}

fn read_all(text: &str) -> (Summary, Vec<Operation>, Vec<Move>) {
    let (summary, steps) = steps(text, &Wanted::default()).unwrap_or_else(|problems| panic!("{problems}"));
    let (mut operations, mut moves) = (Vec::new(), Vec::new());
    for step in steps {
        match step {
            Step::Operation(operation) => operations.push(operation),
            Step::Move(next) => moves.push(next),
        }
    }
    (summary, operations, moves)
}

fn problems(text: &str) -> String {
    steps(text, &Wanted::default()).unwrap_err().to_string()
}

fn near(a: Point3<f64>, mm: [f64; 3]) {
    let b = Point3::new(mm[0], mm[1], mm[2]) * 1e-3;
    // Rounding of lengths of less than a metre.
    assert!((a - b).norm() < 1e-12, "{a} is not {b}");
}

fn arc(next: &Move) -> Arc {
    match next.course {
        Course::Arc(arc) => arc,
        Course::Line => panic!("{next:?} is no arc"),
    }
}

const SOLIDWORKS: &str = "PARTNO/bracket 7\r\nUNIT/MM\r\nINSERT/8MM $ END MILL\r\nCUTTER/8.,1.5,4.,0,0,0,60.\r\nLOAD/TOOL,3\r\n\
    COOLNT/FLOOD\r\nSPINDL/6000,RPM,CLW\r\nINSERT/Stock\r\nTRNTYP/WORLD,0,0,0\r\nCSYS/0,0,1.,10.,0,1.,0,0,-1.,0,0,0\r\n\
    RAPID/\r\nGOTO/10.,.5,25.,1.,0,0\r\nFEDRAT/600.,MMPM\r\nGOTO/10.,.5,-1.,1.,0,0\r\nGOTO/12.,.5,-1.\r\nFINI";

#[test]
fn a_solidworks_program_has_its_tool_frame_and_pace() {
    let (summary, operations, moves) = read_all(SOLIDWORKS);
    assert_eq!(summary.dialect, Some(Dialect::SolidWorks));
    assert_eq!(summary.part.as_deref(), Some("bracket 7"));
    assert_eq!((summary.points, summary.moves, summary.operations), (3, 3, 1));
    assert_eq!(
        summary.ignored["INSERT"],
        Noted {
            first_line: 3,
            count: 2
        }
    );
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    let operation = &operations[0];
    assert_eq!(operation.name.as_deref(), Some("8MM $ END MILL"));
    assert_eq!((operation.tool, operation.line), (Some(3), 4));
    assert_eq!(
        (operation.diameter, operation.corner_radius),
        (Some(8e-3), Some(1.5e-3))
    );
    assert!((operation.spindle.unwrap() - 200.0 * PI).abs() < 1e-9);
    assert_eq!(moves.iter().map(|m| m.line).collect::<Vec<_>>(), [12, 14, 15]);
    assert_eq!(moves[0].pace, Pace::Rapid);
    assert_eq!(moves[1].pace, Pace::Feed(0.6 / 60.0));
    near(moves[1].end, [10.0, 0.5, -1.0]);
    assert_eq!(moves[1].axis, Some(Vector3::x_axis()));
    assert_eq!(moves[2].axis, Some(Vector3::z_axis()), "left out means 0,0,1");
}

const NX: &str = "TOOL PATH/CONTOUR,TOOL,EM10\nTLDATA/MILL,10.0,1.0,75.0,0.0,0.0\n\
    MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0\n$$ centerline data\nUNITS/MM\nPAINT/PATH\nSPINDL/RPM,3000,CLW\nRAPID\n\
    GOTO/0.0,0.0,50.0,0.0,0.0,1.0\nFEDRAT/MMPM,250.0\nGOTO/0.0,0.0,0.0\n\
    CIRCLE/5.0,0.0,0.0,0.0,0.0,-1.0,5.0,0.06,0.5,10.0,1.0\nGOTO/10.0,0.0,0.0\n\
    GOTO/10.0,$\n 20.0, $ more\n 0.0,0.0,0.6,0.8\nGOTO/10.0,20.0,5.0\nEND-OF-PATH\n";

#[test]
fn an_nx_program_keeps_the_axis_and_writes_the_feed_the_other_way_round() {
    let (summary, operations, moves) = read_all(NX);
    assert_eq!(summary.dialect, Some(Dialect::Nx));
    assert_eq!(operations[0].name.as_deref(), Some("CONTOUR"));
    assert_eq!(operations[0].diameter, Some(0.01));
    assert_eq!(moves[1].pace, Pace::Feed(0.25 / 60.0));
    assert_eq!(moves[1].axis, Some(Vector3::z_axis()));
    let tilted = moves[3].axis.unwrap();
    assert!((tilted.into_inner() - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert_eq!(moves[4].axis, Some(tilted), "the axis before");
    assert_eq!(moves[3].line, 14, "a statement stands where it begins");
    // From (0,0) over (5,5) to (10,0): clockwise seen from above, so half a turn about -z.
    assert!((arc(&moves[2]).sweep - PI).abs() < 1e-12);
    assert_eq!(arc(&moves[2]).axis, -Vector3::z_axis());
}

#[test]
fn a_second_msys_is_told_in_the_first() {
    let second = "MSYS/0.0,0.0,30.0,0.0,1.0,0.0,-1.0,0.0,0.0\nGOTO/1.0,2.0,3.0,1.0,0.0,0.0\n";
    let first =
        "TOOL PATH/A\nUNITS/MM\nMSYS/0.0,0.0,10.0,1.0,0.0,0.0,0.0,1.0,0.0\nGOTO/1.0,2.0,3.0,0.0,0.0,1.0\n";
    let (summary, _, moves) = read_all(&format!("{first}{second}"));
    near(moves[0].end, [1.0, 2.0, 3.0]);
    // A quarter turn about z takes (1,2) to (-2,1); its origin is 20 mm higher.
    near(moves[1].end, [-2.0, 1.0, 23.0]);
    assert!((moves[1].axis.unwrap().into_inner() - Vector3::y()).norm() < 1e-15);
    assert!((summary.msys.unwrap().translation.z - 0.01).abs() < 1e-15);
}

#[test]
fn full_turns_small_arcs_and_large_arcs_follow_the_right_hand() {
    let at = |degrees: f64| {
        let angle = degrees.to_radians();
        format!("GOTO/{:.6},{:.6},0", 10.0 * angle.cos(), 10.0 * angle.sin())
    };
    for (k, from, to, expected) in [
        (1.0, 0.0, 0.0, 360.0),
        (1.0, 0.0, 30.0, 30.0),
        (-1.0, 0.0, 30.0, 330.0),
        (1.0, 200.0, 100.0, 260.0),
        (-1.0, 200.0, 200.0, 360.0),
    ] {
        let text = format!("UNIT/MM\n{}\nCIRCLE/0,0,0,0,0,{k}\n{}\n", at(from), at(to));
        let (_, _, moves) = read_all(&text);
        // Six decimals on a radius of 10 mm.
        assert!(
            (arc(&moves[1]).sweep.to_degrees() - expected).abs() < 1e-5,
            "{text}"
        );
    }
}

#[test]
fn an_arc_whose_ends_differ_in_radius_alone_is_a_full_turn() {
    // Found by fuzzing: the angle between the ends was 0.
    let text = "UNIT/MM\nGOTO/109.75,59.5,-7.\nCIRCLE/59.5,59.5,-7.,0,0,1.\nGOTO/109.76,59.5,-7.\n";
    let (summary, _, moves) = read_all(text);
    assert_eq!((arc(&moves[1]).sweep, summary.full_turns), (TAU, 1));
}

#[test]
fn the_sweep_turns_the_start_into_the_end_about_any_axis() {
    for seed in 0..50 {
        let part = |k: f64| (f64::from(seed) * k).sin();
        let turn = Rotation3::from_euler_angles(3.0 * part(1.1), 3.0 * part(2.3), 3.0 * part(3.7));
        let centre = Vector3::new(50.0 * part(0.7), 50.0 * part(0.9), 50.0 * part(1.3));
        let (radius, sweep) = (20.0 + 10.0 * part(5.1), PI + 3.0 * part(4.1));
        let on = |angle: f64| centre + turn * Vector3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
        let (a, b, n) = (on(0.3), on(0.3 + sweep), turn * Vector3::z());
        let three = |v: Vector3<f64>| format!("{:.9},{:.9},{:.9}", v.x, v.y, v.z);
        let text = format!(
            "UNIT/MM\nGOTO/{}\nCIRCLE/{},{}\nGOTO/{}\n",
            three(a),
            three(centre),
            three(n),
            three(b)
        );
        let (_, _, moves) = read_all(&text);
        // Nine decimals of millimetres on at least 10 mm.
        assert!((arc(&moves[1]).sweep - sweep).abs() < 1e-8, "{text}");
    }
}

#[test]
fn a_helix_has_the_turns_that_are_written() {
    let helix = |times: &str, end: &str| {
        format!(
            "UNITS/MM\nGOTO/5.0,0.0,0.0\nCIRCLE/0.0,0.0,0.0,0.0,0.0,1.0,5.0,0.01,0.01,4.0,0.0,TIMES,{times}\nGOTO/{end}\n"
        )
    };
    let (summary, _, moves) = read_all(&helix("3", "5.0,0.0,-3.0"));
    assert!((arc(&moves[1]).sweep - 3.0 * TAU).abs() < 1e-12);
    assert_eq!(summary.full_turns, 1);
    let (_, _, moves) = read_all(&helix("2.25", "0.0,5.0,-3.0"));
    assert!((arc(&moves[1]).sweep - 2.25 * TAU).abs() < 1e-12);
    let told = problems(&helix("2", "0.0,5.0,-3.0"));
    assert!(
        told.contains("a helix of 2 turns that ends 90.000 deg from"),
        "{told}"
    );
    assert!(problems(&helix("1e9", "5.0,0.0,-3.0")).contains("is not between 0 and 10000"));
}

#[test]
fn inches_are_read_in_lengths_and_feeds() {
    let (_, operations, moves) =
        read_all("UNITS/INCH\nCUTTER/.5\nFEDRAT/IPM,10.\nGOTO/1.,0,-2.\nFEDRAT/120.,MMPM\nGOTO/0,0,0\n");
    near(moves[0].end, [25.4, 0.0, -50.8]);
    assert_eq!(moves[0].pace, Pace::Feed(10.0 * 0.0254 / 60.0));
    assert_eq!(moves[1].pace, Pace::Feed(0.12 / 60.0));
    assert_eq!(operations[0].diameter, Some(0.0127));
}

#[test]
fn feed_for_each_turn_follows_the_spindle() {
    let text = "UNIT/MM\nFEDRAT/.2,MMPR\nSPINDL/3000,RPM,CCLW\nGOTO/0,0,0\nSPINDL/600,RPM,CLW\nGOTO/1.,0,0\nSPINDL/OFF\n";
    let (_, operations, moves) = read_all(text);
    for (next, rpm) in moves.iter().zip([3000.0, 600.0]) {
        let Pace::Feed(speed) = next.pace else {
            panic!("{next:?}")
        };
        assert!((speed - 0.2e-3 * rpm / 60.0).abs() < 1e-15);
    }
    assert!(operations[0].spindle.unwrap() < 0.0 && operations[1].spindle.unwrap() > 0.0);
    let told = problems(&format!("{text}GOTO/2.,0,0\nGOTO/3.,0,0\n"));
    assert_eq!(
        told.matches("the spindle does not turn here").count(),
        1,
        "{told}"
    );
}

#[test]
fn rapid_holds_for_one_goto_and_no_feed_is_told_as_such() {
    let (_, _, moves) =
        read_all("UNIT/MM\nRAPID\nGOTO/0,0,0\nGOTO/1.,0,0\nRAPID/\nCUTCOM/OFF\nGOTO/2.,0,0\nFROM/0,0,9.\n");
    let paces: Vec<Pace> = moves.iter().map(|m| m.pace).collect();
    assert_eq!(paces, [Pace::Rapid, Pace::Untold, Pace::Rapid, Pace::Rapid]);
}

#[test]
fn a_drilled_hole_goes_down_at_its_feed_and_back_in_rapid() {
    let text = "UNIT/MM\nTRNTYP/WORLD\nFEDRAT/99.,MMPM\nRAPID/\nGOTO/0,0,25.\nCYCLE/INIT\n\
                CYCLE/DRILL,FEDTO,5.,MMPM,120.,RAPTO,3.,RTRCTO,25.,DWELL,0\nGOTO/10.,0,0\nGOTO/20.,0,0,0,1.,0\nCYCLE/OFF\nGOTO/0,0,1.\n";
    let (summary, _, moves) = read_all(text);
    assert_eq!((summary.holes, summary.points, moves.len()), (2, 4, 10));
    let heights: Vec<f64> = moves[1..5].iter().map(|m| (m.end.z * 1e3).round()).collect();
    assert_eq!(heights, [25.0, 3.0, -5.0, 25.0]);
    let cutting: Vec<bool> = moves[1..5].iter().map(|m| m.pace.cuts()).collect();
    assert_eq!(cutting, [false, false, true, false]);
    assert_eq!(moves[3].pace, Pace::Feed(0.12 / 60.0));
    near(moves[7].end, [20.0, -5.0, 0.0]);
    assert_eq!(
        moves[9].pace,
        Pace::Feed(0.099 / 60.0),
        "the feed of FEDRAT is back"
    );
}

#[test]
fn pecks_cut_what_one_stroke_cuts() {
    for (cycle, strokes) in [
        ("CYCLE/DRILL,FEDTO,20.,RAPTO,2.,RTRCTO,5.", vec![(2.0, -20.0)]),
        (
            "CYCLE/DEEP,FEDTO,20.,INCR,10.,RAPTO,2.",
            vec![(2.0, -8.0), (-8.0, -18.0), (-18.0, -20.0)],
        ),
        (
            "CYCLE/DEEP2,FEDTO,6.,1STPECK,4.,SUBPECK,2.,RAPTO,2.",
            vec![(2.0, -2.0), (-2.0, -4.0), (-4.0, -6.0)],
        ),
    ] {
        let (_, _, moves) = read_all(&format!(
            "UNIT/MM\nTRNTYP/WORLD\nFEDRAT/60.,MMPM\n{cycle}\nGOTO/0,0,0\nCYCLE/OFF\n"
        ));
        let mut found = Vec::new();
        for pair in moves.windows(2) {
            if pair[1].pace.cuts() {
                found.push(((pair[0].end.z * 1e3).round(), (pair[1].end.z * 1e3).round()));
            }
        }
        assert_eq!(found, strokes, "{cycle}");
    }
}

#[test]
fn nx_writes_depths_with_the_sign_of_the_axis() {
    let text = |fed_to: &str| {
        format!(
            "TOOL PATH/D\nUNITS/MM\nCYCLE/DRILL,RAPTO,3.0,FEDTO,{fed_to},MMPM,250.0\nGOTO/0.0,0.0,0.0,0.0,0.0,1.0\nCYCLE/OFF\n"
        )
    };
    let (_, _, moves) = read_all(&text("-10.0"));
    near(moves[2].end, [0.0, 0.0, -10.0]);
    assert!(problems(&text("10.0")).contains("cuts nothing below its points"));
}

#[test]
fn cycles_that_are_not_understood_are_refused() {
    let head = "UNIT/MM\nTRNTYP/WORLD\n";
    for (text, part) in [
        (
            "CYCLE/MILL,FEDTO,5.,RAPTO,3.",
            "3:7: the cycle `MILL` is not understood",
        ),
        ("CYCLE/DRILL,RAPTO,3.", "the cycle DRILL has no FEDTO"),
        ("CYCLE/DRILL,FEDTO,5.", "has no RAPTO"),
        (
            "CYCLE/DRILL,FEDTO,5.,RAPTO,3.,RTRCTO,AUTO",
            "`AUTO` is not a number",
        ),
        ("CYCLE/DRILL,FEDTO,5.,RAPTO,3.,RTRCTO,2.", "goes back lower"),
        (
            "CYCLE/DRILL,FEDTO,5.,RAPTO,3.,STEP,2.",
            "3:31: `STEP` is not understood in the cycle DRILL",
        ),
        ("CYCLE/DRILL,FEDTO,5.,RAPTO", "`RAPTO` has no number"),
        ("CYCLE/DEEP,FEDTO,5.,RAPTO,3.", "has no INCR"),
        (
            "CYCLE/DEEP,FEDTO,5.,RAPTO,3.,INCR,0.001",
            "needs more than 1000 pecks",
        ),
        (
            "CYCLE/DEEP,FEDTO,5.,RAPTO,3.,INCR,-1.",
            "needs more than 1000 pecks",
        ),
        (
            "CYCLE/DRILL,FEDTO,5.,RAPTO,3.\nRAPID\nGOTO/0,0,0",
            "5:1: RAPID or CIRCLE within a drilling cycle",
        ),
    ] {
        let told = problems(&format!("{head}{text}\nGOTO/0,0,0\n"));
        assert!(told.contains(part), "{text}: {told}");
    }
    let told = problems("UNIT/MM\nCYCLE/DRILL,FEDTO,5.,RAPTO,3.\nGOTO/0,0,0\n");
    assert!(told.contains("nothing tells the tool axis"), "{told}");
}

#[test]
fn a_unit_nobody_told_is_asked_for_once_and_may_be_given() {
    let text = "TOOL PATH/A\nGOTO/1.0,0.0,0.0\nGOTO/2.0,0.0,0.0\n";
    let told = problems(text);
    assert_eq!(told.matches("tells the unit of this file").count(), 1, "{told}");
    assert!(
        told.contains("part.apt:2:6: ") && told.contains("`UNITS/MM`"),
        "{told}"
    );
    let inch = Wanted {
        unit: Some(LengthUnit::Inch),
        ..Wanted::default()
    };
    let (summary, steps) = steps(text, &inch).unwrap();
    assert_eq!(summary.unit, Some(LengthUnit::Inch));
    let Some(Step::Move(last)) = steps.last() else {
        panic!("{steps:?}")
    };
    near(last.end, [50.8, 0.0, 0.0]);
}

#[test]
fn an_axis_left_out_is_asked_for_where_no_dialect_shows() {
    let text = "UNITS/MM\nGOTO/0,0,0,1.,0,0\nGOTO/1.,0,0\n";
    let told = problems(text);
    assert!(told.contains("3:6: no tool axis here, but one before"), "{told}");
    for (dialect, axis) in [
        (Dialect::Nx, Vector3::x_axis()),
        (Dialect::SolidWorks, Vector3::z_axis()),
    ] {
        let wanted = Wanted {
            dialect: Some(dialect),
            ..Wanted::default()
        };
        let (_, steps) = steps(text, &wanted).unwrap();
        let Some(Step::Move(last)) = steps.last() else {
            panic!("{steps:?}")
        };
        assert_eq!(last.axis, Some(axis));
    }
    let (_, _, moves) = read_all("UNITS/MM\nGOTO/0,0,0\nGOTO/1.,0,0\n");
    assert_eq!(moves[1].axis, None, "nothing told is nothing known");
}

#[test]
fn what_is_wrong_is_told_with_line_column_and_hint() {
    for (text, part) in [
        ("GOTO/1.,2.,x3", "2:12: `x3` is not a number"),
        ("GOTO/1.,,3.", "2:9: a number is missing here"),
        ("GOTO/1.,2.", "2:6: 2 numbers of a GOTO"),
        ("GOTO/1.,2.,1e300", "is not a number from -1e9 to 1e9"),
        ("GOTO/1.,2.,nan", "`nan` is not a number from"),
        ("GOTO/1.,2.,3.,0,0,0", "has a length of 0.0000, not 1"),
        ("CIRCLE/0,0,0,0,0,1.\nGOTO/1.,0,0", "an arc from nowhere"),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nGOTO/0,1.2,0",
            "begins 1.0000 mm from its centre and ends 1.2000 mm",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.",
            "3:1: no GOTO ends this CIRCLE",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nCIRCLE/0,0,0,0,0,1.\nGOTO/1.,0,0",
            "3:1: no GOTO ends this CIRCLE",
        ),
        ("CIRCLE/0,0,0,0,0", "5 parameters of a CIRCLE"),
        ("CIRCLE/0,0,0,0,0,2.", "has a length of 2.0000"),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.,3.\nGOTO/0,1.,0",
            "and 3.0000 mm is written",
        ),
        ("FEDRAT/100.", "a FEDRAT without unit"),
        ("FEDRAT/MMPM", "a FEDRAT without number"),
        ("FEDRAT/100.,SFM", "`SFM` is no mode of feed"),
        ("FEDRAT/0,MMPM", "a feed of 0 MMPM is not above 0"),
        ("SPINDL/-5,RPM", "-5 RPM is not between 0 and"),
        ("LOAD/TOOL,x", "`x` is no number of a tool"),
        ("CUTTER/", "the diameter of the tool is missing"),
        ("CUTTER/2.,8.", "a tool of diameter 2 with a corner radius of 8"),
        ("UNIT/FT", "`FT` is no unit of length"),
        ("TRNTYP/LOCAL", "TRNTYP/LOCAL: in which system"),
        ("TRNTYP/WORLD\nCSYS/1,2,3", "3 numbers of a CSYS"),
        (
            "TRNTYP/WORLD\nCSYS/2.,0,0,0,0,1.,0,0,0,0,1.,0",
            "not perpendicular and of length 1",
        ),
        (
            "CSYS/1.,0,0,5.,0,1.,0,0,0,0,1.,0",
            "points are in it or in the world",
        ),
        ("MSYS/0,0,0,1.,0,0,1.,0,0", "not perpendicular"),
        ("MSYS/0,0", "without origin"),
        ("MSYS/0,0,0,1.", "4 numbers of an MSYS"),
        ("GOTO/0,0,0\nMSYS/0,0,0,1.,0,0,0,1.,0", "points came before it"),
        (
            "TRNTYP/WORLD\nTOOL PATH/A",
            "a word of Nx, but those before are of SolidWorks",
        ),
        (
            "NURBS/3",
            "2:1: `NURBS` moves the tool or its points, and is not understood",
        ),
        ("P1 = POINT/0,0,0", "the source of an APT program"),
        ("GOTO/0,0,0\nFINI\nGOTO/1.,0,0", "4:1: `GOTO` behind FINI"),
        (
            "GOTO/0,0,0\nGOTO/1.,$",
            "3:1: this statement is continued by `$`, but the file ends",
        ),
    ] {
        let told = problems(&format!("UNIT/MM\n{text}\n"));
        assert!(told.contains(part), "{text}: {told}");
        assert!(told.contains("help: "), "{text}: {told}");
    }
    assert!(problems("").contains("no GOTO in this file"));
    let endless = format!("UNIT/MM\nGOTO/{}", "0,$\n".repeat(1000));
    assert!(problems(&endless).contains("goes over more than 200 lines"));
}

#[test]
fn a_problem_of_a_continued_statement_stands_on_its_own_line() {
    let told = problems("UNIT/MM\nGOTO/1.,$\n  2.,$ y\n  no\n");
    assert!(told.contains("part.apt:4:3: `no` is not a number"), "{told}");
}

#[test]
fn all_problems_are_told_at_once_but_no_more_than_the_limit() {
    let told = steps(
        &format!("UNIT/MM\n{}", "GOTO/x,0,0\n".repeat(1000)),
        &Wanted::default(),
    )
    .unwrap_err();
    assert_eq!(told.as_slice().len(), MOST_PROBLEMS);
}

#[test]
fn unknown_words_are_counted_with_their_first_line() {
    let (summary, _, _) = read_all("UNIT/MM\nFOO/1\nGOTO/0,0,0\nfoo\nCOOLNT/ON\nSPINDL/100,CLW,LOW\n");
    assert_eq!(
        summary.warnings["the word `FOO` is not known"],
        Noted {
            first_line: 2,
            count: 2
        }
    );
    assert_eq!(summary.ignored["COOLNT"].count, 1);
    assert!(
        summary
            .warnings
            .contains_key("the word `LOW` of SPINDL is not known")
    );
    let many: String = (0..5000).map(|k| format!("W{k}/\n")).collect();
    let (summary, _, _) = read_all(&format!("UNIT/MM\nGOTO/0,0,0\n{many}"));
    assert_eq!(summary.warnings.len(), 1001);
    assert_eq!(summary.warnings["other words"].count, 4000);
}

#[test]
fn no_text_makes_it_panic() {
    for text in [SOLIDWORKS, NX] {
        for cut in 0..text.len() {
            let _ = steps(&text[..cut], &Wanted::default());
            for with in ["$", "/", ",", "\u{e4}", "-", "\n"] {
                let _ = steps(
                    &format!("{}{with}{}", &text[..cut], &text[cut + 1..]),
                    &Wanted::default(),
                );
            }
        }
    }
    for text in [
        "/",
        "//",
        ",",
        "$",
        "$$",
        "=",
        "GOTO",
        "GOTO/,",
        "CIRCLE/TIMES",
        "PARTNO",
        "  INSERT",
        "\u{1a}",
    ] {
        let _ = steps(text, &Wanted::default());
    }
}

#[test]
fn words_that_are_passed_over_or_refused_stand_in_the_guide() {
    let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/tool-path-words.md");
    let page = std::fs::read_to_string(page).unwrap();
    for word in words::IGNORED.iter().chain(words::REFUSED) {
        let told = [" ", "/", "`"]
            .iter()
            .any(|end| page.contains(&format!("`{word}{end}")));
        assert!(told, "{word}");
    }
}
