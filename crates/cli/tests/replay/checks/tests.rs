//! Each check accepts a good program and reports what is wrong with a bad one, with its line.

use super::{Cut, CutPoint, blends_apart, clear, feeds, follows, no_stop_in_cut, spindle_on, within_limits};
use crate::event::{Action, Event};
use crate::replay::{Language, run};

/// A groove of 40 mm with a middle point, cut from z = 2 mm; tool down, frame of the part as base.
const GOOD: &str = "DEF groove()\n\
    $BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\n\
    $TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n\
    PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\n\
    $OUT[5]=TRUE\n\
    PTP {X 0,Y 0,Z 50,A 0,B 0,C 180}\n\
    $VEL.CP=0.01\n\
    $APO.CDIS=0.1\n\
    LIN {X 0,Y 0,Z 2,A 0,B 0,C 180}\n\
    LIN {X 0,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n\
    LIN {X 20,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n\
    LIN {X 40,Y 0,Z 0,A 0,B 0,C 180}\n\
    LIN {X 40,Y 0,Z 50,A 0,B 0,C 180}\n\
    END\n";

fn cut() -> Cut {
    let point = |x: f64, z: f64, rapid: bool| CutPoint {
        position_mm: [x, 0.0, z],
        axis: [0.0, 0.0, 1.0],
        feed_mm_per_s: Some(10.0),
        rapid,
    };
    Cut {
        points: vec![
            point(0.0, 2.0, true),
            point(0.0, 0.0, false),
            point(10.0, 0.0, false),
            point(20.0, 0.0, false),
            point(40.0, 0.0, false),
        ],
        frame: None,
        clearance_mm: 30.0,
        chord_mm: 0.005,
    }
}

fn events(text: &str) -> Vec<Event> {
    run(Language::Krl, &[("groove.src", text)], "groove").unwrap_or_else(|error| panic!("{error}"))
}

/// All checks; the first complaint.
fn complaint(text: &str) -> Option<String> {
    let events = events(text);
    let cut = cut();
    let checked = follows(&events, &cut).and_then(|matches| {
        clear(&events, &cut, &matches)?;
        within_limits(&events, &[(-185.0, 185.0); 6])?;
        spindle_on(&events, &matches, |action| {
            matches!(action, Action::Output { name, value, moving: false } if name == "$OUT[5]" && value == "TRUE")
        })?;
        no_stop_in_cut(&events, &cut, &matches)?;
        feeds(&events, &cut, &matches, 1e-6)
    });
    checked.err().map(|error| error.to_string())
}

#[track_caller]
fn complains(of: &str, by: &str, message: &str) {
    let text = GOOD.replace(of, by);
    assert_ne!(text, GOOD);
    let found = complaint(&text);
    assert!(
        found.as_deref().is_some_and(|found| found.contains(message)),
        "{message}: {found:?}"
    );
}

#[test]
fn a_good_program_passes_every_check() {
    assert_eq!(complaint(GOOD), None);
}

#[test]
fn the_frame_of_the_part_may_differ_from_the_base() {
    let text = GOOD
        .replace("$BASE={X 0,", "$BASE={X 500,")
        .replace("X 20,", "X -480,");
    let text = text
        .replace("X 40,", "X -460,")
        .replace("LIN {X 0,", "LIN {X -500,");
    let moved = events(&text);
    let world = Cut {
        frame: Some(crate::pose::Pose::IDENTITY),
        ..cut()
    };
    let matches = follows(&moved, &world).unwrap();
    assert_eq!(
        matches.iter().flatten().copied().collect::<Vec<_>>(),
        [0, 1, 3, 4]
    );
    assert!(follows(&moved, &cut()).is_err());
}

#[test]
fn a_point_off_the_path_or_a_tilted_tool_is_reported() {
    complains(
        "LIN {X 20,Y 0,",
        "LIN {X 20,Y 0.003,",
        "groove.src:11: a line to [20.000, 0.003, 0.000] mm, 3.0 um",
    );
    complains(
        "LIN {X 20,Y 0,Z 0,A 0,B 0,",
        "LIN {X 20,Y 0,Z 0,A 0,B 0.002,",
        "0.0020 deg off the commanded axis",
    );
}

#[test]
fn points_that_are_left_out_are_reported() {
    // The line from 0 to 40 mm is the same path: a point on it may be left out.
    let line = "LIN {X 20,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n";
    assert_eq!(complaint(&GOOD.replace(line, "")), None);
    complains(
        "LIN {X 40,Y 0,Z 0,A 0,B 0,C 180}\n",
        "",
        "no line goes to commanded point 4",
    );
}

#[test]
fn moves_below_the_clearance_are_reported() {
    complains(
        "LIN {X 40,Y 0,Z 50",
        "LIN {X 45,Y 0,Z 50",
        "groove.src:13: a line from",
    );
    complains(
        "PTP {X 0,Y 0,Z 50",
        "PTP {X 0,Y 0,Z 20",
        "groove.src:6: a joint move begins or ends below",
    );
    complains(
        "LIN {X 40,Y 0,Z 50,A 0,B 0,C 180}",
        "PTP {X 40,Y 0,Z 50,A 0,B 0,C 180}",
        "groove.src:13: a joint move",
    );
}

#[test]
fn retracts_in_steps_and_a_small_shift_above_the_cut_are_no_faults() {
    let up = "LIN {X 40,Y 0,Z 50,A 0,B 0,C 180}\n";
    let way = |shift: &str| {
        format!("LIN {{X 40,Y 0,Z 20,A 0,B 0,C 180}}\nLIN {{X {shift},Y 0,Z 20,A 0,B 0,C 180}}\n")
    };
    let after = |shift: &str, end: &str| GOOD.replace(up, &(way(shift) + end));
    let end = |x: &str| format!("LIN {{X {x},Y 0,Z 50,A 0,B 0,C 180}}\n");
    assert_eq!(
        complaint(&GOOD.replace(up, &format!("LIN {{X 40,Y 0,Z 20,A 0,B 0,C 180}}\n{up}"))),
        None
    );
    // Across by more than corrections differ, and away from the tool axis.
    let far = complaint(&after("40.7", &end("40.7"))).unwrap();
    assert!(far.starts_with("groove.src:14: a line to [40.700"), "{far}");
    let slanting = complaint(&after("40.5", &end("41"))).unwrap();
    assert!(slanting.contains("below the clearance"), "{slanting}");
    // After the shift the tool goes down to a cut, not up.
    let nowhere = complaint(&after("40.5", &end("40.5"))).unwrap();
    assert!(
        nowhere.starts_with("groove.src:15: a line from [40.500"),
        "{nowhere}"
    );
}

#[test]
fn axes_beyond_their_limits_are_reported() {
    complains(
        "A1 0,",
        "A1 190,",
        "groove.src:4: axis 1 at 190 deg exceeds its limits of -185 to 185 deg",
    );
}

#[test]
fn a_spindle_that_is_late_or_off_is_reported() {
    complains(
        "$OUT[5]=TRUE",
        "$OUT[5]=FALSE",
        "the cut begins, and the spindle is not on",
    );
    complains("$OUT[5]=TRUE\n", "", "groove.src:8: the cut begins");
}

#[test]
fn rest_inside_of_a_cut_is_reported() {
    complains(
        "LIN {X 20,Y 0,Z 0,A 0,B 0,C 180} C_DIS",
        "LIN {X 20,Y 0,Z 0,A 0,B 0,C 180}",
        "groove.src:11: an exact stop",
    );
    // The wait ends the approximation of the move before it.
    complains(
        "LIN {X 20,Y 0,Z 0,A 0,B 0,C 180} C_DIS\n",
        "LIN {X 20,Y 0,Z 0,A 0,B 0,C 180} C_DIS\nWAIT SEC 1\n",
        "groove.src:11: an exact stop",
    );
}

#[test]
fn another_feed_is_reported() {
    complains("$VEL.CP=0.01", "$VEL.CP=0.011", "11 mm/s, commanded are 10 mm/s");
}

#[test]
fn blends_that_overlap_are_reported() {
    assert_eq!(blends_apart(&events(GOOD)), Ok(()));
    let wide = GOOD.replace("$APO.CDIS=0.1", "$APO.CDIS=10.5");
    let found = blends_apart(&events(&wide)).unwrap_err().to_string();
    assert!(found.starts_with("groove.src:10: the blends"), "{found}");
}
