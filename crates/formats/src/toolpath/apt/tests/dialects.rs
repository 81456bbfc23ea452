//! Two programs as their CAM systems write them: axes, systems, units.

use std::f64::consts::PI;

use armill_core::nalgebra::Vector3;
use armill_core::path::{Pace, Step};

use super::{arc, near, problems, read_all, steps};
use crate::toolpath::LengthUnit;
use crate::toolpath::apt::{AptReadOptions, Dialect};

pub(super) const SOLIDWORKS: &str = "PARTNO/bracket 7\r\nUNIT/MM\r\nINSERT/8MM $ END \
    MILL\r\nCUTTER/8.,1.5,4.,0,0,0,60.\r\nLOAD/TOOL,3\r\n\
    COOLNT/FLOOD\r\nSPINDL/6000,RPM,CLW\r\nINSERT/Stock\r\nTRNTYP/WORLD,0,0,0\r\nCSYS/0,0,1.,10.,0,1.,0,0,-1.,0,0,0\r\n\
    RAPID/\r\nGOTO/10.,.5,25.,1.,0,0\r\nFEDRAT/600.,MMPM\r\nGOTO/10.,.5,-1.,1.,0,0\r\nGOTO/12.,.5,-1.\r\nFINI";

#[test]
fn a_solidworks_program_has_its_tool_frame_and_pace() {
    let (summary, operations, moves) = read_all(SOLIDWORKS);
    assert_eq!((summary.moves, summary.cuts, summary.operations), (3, 2, 1));
    assert_eq!(summary.notes, ["INSERT was ignored twice, first in line 3"]);
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

pub(super) const NX: &str = "TOOL PATH/CONTOUR,TOOL,EM10\nTLDATA/MILL,10.0,1.0,75.0,0.0,0.0\n\
    MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0\n$$ centerline data\nUNITS/MM\nPAINT/PATH\nSPINDL/RPM,3000,CLW\nRAPID\n\
    GOTO/0.0,0.0,50.0,0.0,0.0,1.0\nFEDRAT/MMPM,250.0\nGOTO/0.0,0.0,0.0\n\
    CIRCLE/5.0,0.0,0.0,0.0,0.0,-1.0,5.0,0.06,0.5,10.0,1.0\nGOTO/10.0,0.0,0.0\n\
    GOTO/10.0,$\n 20.0, $ more\n 0.0,0.0,0.6,0.8\nGOTO/10.0,20.0,5.0\nEND-OF-PATH\n";

#[test]
fn an_nx_program_keeps_the_axis_and_writes_the_feed_the_other_way_round() {
    let (_, operations, moves) = read_all(NX);
    assert_eq!(operations[0].name.as_deref(), Some("CONTOUR"));
    assert_eq!(operations[0].diameter, Some(0.01));
    assert_eq!(moves[1].pace, Pace::Feed(0.25 / 60.0));
    assert_eq!(moves[1].axis, Some(Vector3::z_axis()));
    let tilted = moves[3].axis.unwrap();
    assert!((tilted.into_inner() - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert_eq!(moves[4].axis, Some(tilted), "the axis before");
    assert_eq!(moves[3].line, 14, "the line where the statement begins");
    // From (0,0) over (5,5) to (10,0): clockwise seen from above, so half a turn about -z.
    assert!((arc(&moves[2]).sweep - PI).abs() < 1e-12);
    assert_eq!(arc(&moves[2]).axis, -Vector3::z_axis());
}

#[test]
fn a_second_msys_is_relative_to_the_first() {
    let second = "MSYS/0.0,0.0,30.0,0.0,1.0,0.0,-1.0,0.0,0.0\nGOTO/1.0,2.0,3.0,1.0,0.0,0.0\n";
    let first =
        "TOOL PATH/A\nUNITS/MM\nMSYS/0.0,0.0,10.0,1.0,0.0,0.0,0.0,1.0,0.0\nGOTO/1.0,2.0,3.0,0.0,0.0,1.0\n";
    let (_, _, moves) = read_all(&format!("{first}{second}"));
    near(moves[0].end, [1.0, 2.0, 3.0]);
    // A quarter turn about z takes (1,2) to (-2,1); its origin is 20 mm higher.
    near(moves[1].end, [-2.0, 1.0, 23.0]);
    assert!((moves[1].axis.unwrap().into_inner() - Vector3::y()).norm() < 1e-15);
}

#[test]
fn a_missing_unit_is_reported_once_and_can_be_given() {
    let text = "TOOL PATH/A\nGOTO/1.0,0.0,0.0\nGOTO/2.0,0.0,0.0\n";
    let given = problems(text);
    assert_eq!(
        given.matches("the unit of this file has not been given").count(),
        1,
        "{given}"
    );
    assert!(
        given.contains("part.apt:2:6: ") && given.contains("`UNITS/MM`"),
        "{given}"
    );
    let inch = AptReadOptions {
        unit: Some(LengthUnit::Inch),
        ..AptReadOptions::default()
    };
    let (_, steps) = steps(text, &inch).unwrap();
    let Some(Step::Move(last)) = steps.last() else {
        panic!("{steps:?}")
    };
    near(last.end, [50.8, 0.0, 0.0]);
}

#[test]
fn a_missing_axis_is_reported_if_the_dialect_is_not_known() {
    let text = "UNITS/MM\nGOTO/0,0,0,1.,0,0\nGOTO/1.,0,0\n";
    let given = problems(text);
    assert!(
        given.contains("3:6: no tool axis here, but one before"),
        "{given}"
    );
    for (dialect, axis) in [
        (Dialect::Nx, Vector3::x_axis()),
        (Dialect::SolidWorks, Vector3::z_axis()),
    ] {
        let expected = AptReadOptions {
            dialect: Some(dialect),
            ..AptReadOptions::default()
        };
        let (_, steps) = steps(text, &expected).unwrap();
        let Some(Step::Move(last)) = steps.last() else {
            panic!("{steps:?}")
        };
        assert_eq!(last.axis, Some(axis));
    }
    let (_, _, moves) = read_all("UNITS/MM\nGOTO/0,0,0\nGOTO/1.,0,0\n");
    assert_eq!(moves[1].axis, None, "no axis is given or assumed");
}

#[test]
fn a_tool_path_of_nx_begins_without_feed_and_axis() {
    let (_, _, moves) = read_all(&format!(
        "{NX}TOOL PATH/B\nGOTO/1.0,0.0,0.0,0.0,0.0,1.0\nGOTO/2.0,0.0,0.0\n"
    ));
    let paces: Vec<Pace> = moves.iter().rev().take(3).map(|m| m.pace).collect();
    assert_eq!(paces, [Pace::Unknown, Pace::Unknown, Pace::Feed(0.25 / 60.0)]);
}
