//! Holes as moves.

use armill_core::path::Pace;

use armill_core::path::{Command, Step};

use super::{near, problems, read_all, steps};
use crate::toolpath::apt::AptReadOptions;

#[test]
fn a_drilled_hole_goes_down_at_its_feed_and_back_in_rapid() {
    let text = "UNIT/MM\nTRNTYP/WORLD\nFEDRAT/99.,MMPM\nRAPID/\nGOTO/0,0,25.\nCYCLE/INIT\n\
                CYCLE/DRILL,FEDTO,5.,MMPM,120.,RAPTO,3.,RTRCTO,25.,DWELL,0\nGOTO/10.,0,0\nGOTO/20.,0,0,0,1.,0\nCYCLE/OFF\nGOTO/0,0,1.\n";
    let (summary, _, moves) = read_all(text);
    assert_eq!((summary.moves, summary.cuts, moves.len()), (10, 3, 10));
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
fn coolant_dwells_and_stops_are_commands_between_moves() {
    let text = "UNIT/MM\nTRNTYP/WORLD\nSPINDL/600,RPM,CLW\nCOOLNT/FLOOD\nFEDRAT/99.,MMPM\nRAPID\nGOTO/0,0,25.,0,0,1.\n\
                CYCLE/DRILL,FEDTO,5.,MMPM,120.,RAPTO,3.,RTRCTO,25.,DWELL,0.5\nGOTO/10.,0,0\nCYCLE/OFF\nDELAY/5,REV\n\
                DELAY/0.2\nCOOLNT/OFF\nSTOP\nDELAY/REV\n";
    let (summary, steps) = steps(text, &AptReadOptions::default()).unwrap();
    let mut commands = Vec::new();
    let mut moves = 0;
    for step in &steps {
        match step {
            Step::Command(command) => commands.push((moves, *command)),
            Step::Move(_) => moves += 1,
            Step::Operation(_) => {}
        }
    }
    let expected = [
        (0, Command::Coolant(true)),
        (4, Command::Dwell(0.5)),
        (5, Command::Dwell(0.5)),
        (5, Command::Dwell(0.2)),
        (5, Command::Coolant(false)),
        (5, Command::Stop),
    ];
    for ((at, found), (expected_at, expected)) in commands.iter().zip(&expected) {
        assert_eq!(at, expected_at, "{commands:?}");
        match (found, expected) {
            (Command::Dwell(found), Command::Dwell(expected)) => assert!((found - expected).abs() < 1e-12),
            _ => assert_eq!(found, expected),
        }
    }
    assert_eq!(commands.len(), expected.len());
    let unknown = "DELAY without a known time is not followed (once, first in line 15)";
    assert!(
        summary.notes.iter().any(|note| note == unknown),
        "{:?}",
        summary.notes
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
fn refuses_unsupported_cycles() {
    let head = "UNIT/MM\nTRNTYP/WORLD\n";
    for (text, part) in [
        (
            "CYCLE/MILL,FEDTO,5.,RAPTO,3.",
            "3:7: the cycle `MILL` is not supported",
        ),
        ("CYCLE/DRILL,RAPTO,3.", "the cycle DRILL has no FEDTO"),
        ("CYCLE/DRILL,FEDTO,5.", "has no RAPTO"),
        (
            "CYCLE/DRILL,FEDTO,5.,RAPTO,3.,RTRCTO,AUTO",
            "`AUTO` is not a number",
        ),
        ("CYCLE/DRILL,FEDTO,5.,RAPTO,3.,RTRCTO,2.", "retracts lower"),
        (
            "CYCLE/DRILL,FEDTO,5.,RAPTO,3.,STEP,2.",
            "3:31: `STEP` is not supported in the cycle DRILL",
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
        let given = problems(&format!("{head}{text}\nGOTO/0,0,0\n"));
        assert!(given.contains(part), "{text}: {given}");
    }
    let given = problems("UNIT/MM\nCYCLE/DRILL,FEDTO,5.,RAPTO,3.\nGOTO/0,0,0\n");
    assert!(given.contains("the tool axis is not given"), "{given}");
}
