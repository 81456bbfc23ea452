//! How fast the tip goes.

use armill_core::path::Pace;

use super::{near, problems, read_all};

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
    let given = problems(&format!("{text}GOTO/2.,0,0\nGOTO/3.,0,0\n"));
    assert_eq!(
        given.matches("the spindle does not turn here").count(),
        1,
        "{given}"
    );
}

#[test]
fn rapid_applies_to_one_goto_and_a_missing_feed_is_unknown() {
    let (_, _, moves) =
        read_all("UNIT/MM\nRAPID\nGOTO/0,0,0\nGOTO/1.,0,0\nRAPID/\nCUTCOM/OFF\nGOTO/2.,0,0\nFROM/0,0,9.\n");
    let paces: Vec<Pace> = moves.iter().map(|m| m.pace).collect();
    assert_eq!(paces, [Pace::Rapid, Pace::Unknown, Pace::Rapid, Pace::Rapid]);
}
