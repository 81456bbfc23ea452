//! TP programs by hand: frames by registers, groups, offsets, terminations, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, output, refusal, same};
use crate::pose::Pose;
use crate::replay::Language::Tp;

/// A program with these statements, numbered, and positions.
fn program(statements: &[&str], positions: &str) -> String {
    let lines: Vec<String> = statements
        .iter()
        .enumerate()
        .map(|(index, text)| format!("{:4}:{text} ;", index + 1))
        .collect();
    format!(
        "/PROG  P\n/ATTR\nOWNER\t= MNEDITOR;\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n{}\n/POS\n{positions}/END\n",
        lines.join("\n")
    )
}

const POINT: &str = "P[1:\"above\"]{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 1, -1',\n\
    \tX =   100.000  mm,\tY =    -0.500  mm,\tZ =    20.000  mm,\n\
    \tW =   180.000 deg,\tP =     0.000 deg,\tR =   -90.000 deg\n};\n";

#[test]
fn frames_come_from_position_registers() {
    let set = [
        "  PR[9,1]=1700.000",
        "  PR[9,2]=(-200.000)",
        "  PR[9,3]=900+R[1]",
        "  PR[9,4]=0",
        "  PR[9,5]=0",
        "  PR[9,6]=(-90)",
    ];
    let mut all = vec!["  R[1]=5"];
    all.extend(set);
    all.extend([
        "  UFRAME[1]=PR[9]",
        "  UFRAME_NUM=1",
        "  UTOOL_NUM=2",
        "L P[1] 30mm/sec CNT100",
        "L P[1] 60cm/min FINE",
    ]);
    let found = actions(Tp, &[("p.ls", &program(&all, POINT))], "p");
    let [line, other] = linears(&found)[..] else {
        panic!("{found:?}")
    };
    same(
        &line.base.pose.unwrap(),
        &Pose::kuka([1700.0, -200.0, 905.0, -90.0, 0.0, 0.0]),
    );
    assert_eq!(
        (line.base.name.as_str(), line.tool.name.as_str(), line.tool.pose),
        ("1", "2", None)
    );
    same(&line.to, &Pose::kuka([100.0, -0.5, 20.0, -90.0, 0.0, 180.0]));
    assert_eq!(
        (line.speed, line.blend),
        (Speed::MmPerS(30.0), Blend::Percent(100.0))
    );
    assert_eq!((other.speed, other.blend), (Speed::MmPerS(10.0), Blend::Exact));
}

#[test]
fn positions_have_configurations_axes_and_groups() {
    let axes = "P[2]{\n   GP1:\n\tUF : 1, UT : 2,\t\n\tJ1=     1.000 deg,\tJ2=    -2.000 deg,\tJ3=     3.000 deg,\n\
        \tJ4=     0.000 deg,\tJ5=     5.000 deg,\tJ6=     6.000 deg,\n\tE1=   250.000  mm\n   GP2:\n\tUF : 1, UT : 2,\n\
        \tJ1=    45.000 deg,\tJ2=   -30.000 deg\n};\n";
    let positions = format!("{POINT}{axes}");
    let text = program(&["J P[2] 20% FINE", "J P[1] 2sec CNT50 ACC80"], &positions);
    let found = actions(Tp, &[("p.ls", &text)], "p");
    let [one, two] = joints(&found)[..] else {
        panic!("{found:?}")
    };
    assert_eq!(one.to, JointTarget::Axes(vec![1.0, -2.0, 3.0, 0.0, 5.0, 6.0]));
    assert_eq!(one.external, [Some(250.0), Some(45.0), Some(-30.0)]);
    assert_eq!(
        (one.speed, two.speed),
        (Speed::Percent(20.0), Speed::Seconds(2.0))
    );
    let JointTarget::Pose { posture, .. } = &two.to else {
        panic!("{two:?}")
    };
    let letters = "NUT".to_owned();
    assert_eq!(
        *posture,
        Posture::Config {
            letters,
            turns: [0, 1, -1]
        }
    );
}

#[test]
fn offsets_are_along_the_frame_or_the_tool() {
    let mut all = vec![
        "PR[3,1]=1",
        "PR[3,2]=2",
        "PR[3,3]=3",
        "PR[3,4]=0",
        "PR[3,5]=0",
        "PR[3,6]=0",
    ];
    all.extend([
        "L P[1] 5mm/sec FINE Offset,PR[3]",
        "L P[1] 5mm/sec FINE Tool_Offset,PR[3]",
    ]);
    let found = actions(Tp, &[("p.ls", &program(&all, POINT))], "p");
    let [by_frame, by_tool] = linears(&found)[..] else {
        panic!("{found:?}")
    };
    same(&by_frame.to, &Pose::kuka([101.0, 1.5, 23.0, -90.0, 0.0, 180.0]));
    // The axes of the tool: x along -y of the frame, y along -x, z down.
    same(&by_tool.to, &Pose::kuka([98.0, -1.5, 17.0, -90.0, 0.0, 180.0]));
}

#[test]
fn instructions_are_events_in_their_order() {
    let text = program(
        &[
            "  !load tool",
            "  DO[5:spindle 1 on]=ON",
            "L P[1] 5mm/sec CNT100",
            "  DO[6]=OFF",
            "  WAIT   1.50(sec)",
            "  MESSAGE[load tool 2]",
            "  PAUSE",
            "  CALL SUB",
            "  CALL OTHER(1,2)",
            "  WAIT DI[1]=ON",
            "",
            "  END",
            "  PAUSE",
        ],
        POINT,
    );
    let sub = program(&["  WAIT .50(sec)"], "").replace("/PROG  P", "/PROG  SUB");
    let all = actions(Tp, &[("p.ls", text.as_str()), ("sub.ls", &sub)], "p");
    assert_eq!(
        all[0],
        Action::Comment {
            text: "load tool".to_owned()
        }
    );
    assert_eq!(all[1], output("DO[5]", "TRUE", false));
    assert_eq!(all[3], output("DO[6]", "FALSE", true));
    // The wait lets the robot come to rest in the target.
    assert_eq!(linears(&all)[0].blend, Blend::Exact);
    assert_eq!(all[4], Action::Dwell { s: 1.5 });
    assert_eq!(
        all[6],
        Action::Stop {
            message: Some("load tool 2".to_owned())
        }
    );
    assert_eq!(all[7], Action::Dwell { s: 0.5 });
    assert!(
        matches!(&all[8], Action::Call { name, arguments } if name == "OTHER" && arguments[..] == ["1,2"])
    );
    assert!(matches!(&all[9], Action::Wait { condition } if condition == "DI[1]=ON"));
    assert_eq!(all.len(), 10);
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    let refused = |statements: &[&str], message: &str| {
        let found = refusal(Tp, &[("p.ls", &program(statements, POINT))], "p");
        assert!(found.contains(message), "{found}");
    };
    refused(&["PAUSE", "JMP LBL[1]"], "p.ls:7: unknown instruction `JMP`");
    refused(&["L P[7] 5mm/sec FINE"], "p.ls:6: P[7] is not in /POS");
    refused(
        &["UFRAME_NUM=3", "L P[1] 5mm/sec FINE"],
        "p.ls:7: P[1] has UF : 1, but 3 is active",
    );
    refused(
        &["L P[1] 5mm/sec CNT101"],
        "`CNT101` is not FINE or CNT0 to CNT100",
    );
    refused(&["L P[1] 5mm/hour FINE"], "`mm` is not the unit of a speed");
    refused(&["UFRAME[1]=PR[4]"], "PR[4,1] is read but not set");
    refused(
        &["L P[1] 5mm/sec FINE Skip,LBL[1]"],
        "the motion option `Skip` is not interpreted",
    );
    let broken = POINT.replace("X =   100.000  mm", "X =   100.000 deg");
    let found = refusal(Tp, &[("p.ls", &program(&["L P[1] 5mm/sec FINE"], &broken))], "p");
    assert!(found.contains("p.ls:8: `deg` is not the unit of X"), "{found}");
    let open = program(&[], POINT).replace("/END\n", "");
    assert!(refusal(Tp, &[("p.ls", &open)], "p").contains("the program has no /END"));
}
