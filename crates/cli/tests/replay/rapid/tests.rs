//! RAPID programs by hand: data, zones, work objects, procedures of several modules, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, output, refusal, same};
use crate::pose::Pose;
use crate::replay::Language::Rapid;

/// Data and statements of a program.
fn module(data: &str, statements: &str) -> String {
    format!("MODULE m\n{data}\nPROC p()\n{statements}\nENDPROC\nENDMODULE\n")
}

#[track_caller]
fn run(data: &str, statements: &str) -> Vec<Action> {
    actions(Rapid, &[("m.mod", &module(data, statements))], "p")
}

#[track_caller]
fn refused(data: &str, statements: &str, message: &str) {
    let found = refusal(Rapid, &[("m.mod", &module(data, statements))], "p");
    assert!(found.contains(message), "{found}");
}

const NONE: &str = "[9E9,9E+09,9E9,9E9,9E9,9E9]";

/// A target at this x, mm.
fn target(x: f64) -> String {
    format!("[[{x},2,3],[1,0,0,0],[0,-1,1,0],{NONE}]")
}

#[test]
fn axes_and_external_axes_are_those_of_the_target() {
    let all = run(
        "",
        "MoveAbsJ [[1,-2,3,-4,5,-6],[9E9,100,9E9,9E9,9E9,9E9]]\\NoEOffs,v50,fine,tool0;",
    );
    let [joint] = joints(&all)[..] else {
        panic!("{all:?}")
    };
    assert_eq!(joint.to, JointTarget::Axes(vec![1.0, -2.0, 3.0, -4.0, 5.0, -6.0]));
    assert_eq!(joint.external, [None, Some(100.0)]);
    assert_eq!((joint.speed, joint.blend), (Speed::MmPerS(50.0), Blend::Exact));
    assert_eq!(joint.tool.name, "tool0");
}

#[test]
fn speeds_and_zones_are_predefined_declared_or_written_in_place() {
    let data = "LOCAL CONST zonedata near:=[FALSE,0.2,0.2,0.2,0.02,0.2,0.02];\n\
        VAR speeddata feed:=[12.5,500,5000,1000];";
    let at = target(1.0);
    let cases = [
        ("v10,z0", Speed::MmPerS(10.0), Blend::DistanceMm(0.3)),
        ("v200,z15", Speed::MmPerS(200.0), Blend::DistanceMm(15.0)),
        ("feed,near", Speed::MmPerS(12.5), Blend::DistanceMm(0.2)),
        (
            "[7,500,5000,1000],[TRUE,0,0,0,0,0,0]",
            Speed::MmPerS(7.0),
            Blend::Exact,
        ),
        (
            "v10\\V:=33,z1\\Z:=0.15",
            Speed::MmPerS(33.0),
            Blend::DistanceMm(0.15),
        ),
        ("v10\\T:=2,fine", Speed::Seconds(2.0), Blend::Exact),
    ];
    for (how, speed, blend) in cases {
        let all = run(data, &format!("MoveL {at},{how},tool0;"));
        assert_eq!(
            (linears(&all)[0].speed, linears(&all)[0].blend),
            (speed, blend),
            "{how}"
        );
    }
    refused(
        data,
        &format!("MoveL {at},v25,z1,tool0;"),
        "m.mod:5: `v25` is not defined",
    );
    refused(
        data,
        &format!("MoveL {at},v20,z2,tool0;"),
        "m.mod:5: `z2` is not defined",
    );
}

#[test]
fn a_work_object_is_the_user_frame_and_the_object_frame() {
    let data = "PERS wobjdata w:=[FALSE,TRUE,\"\",[[100,0,0],[0.70710678,0,0,0.70710678]],[[10,0,0],[1,0,0,0]]];\n\
        PERS tooldata t:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];";
    let all = run(
        data,
        &format!(
            "MoveL {},v10,fine,t\\WObj:=w;\nw.uframe.trans.x:=200;\nMoveL {},v10,fine,t,\\WObj:=w;",
            target(1.0),
            target(2.0)
        ),
    );
    let [first, second] = linears(&all)[..] else {
        panic!("{all:?}")
    };
    let base = first.base.pose.unwrap();
    assert!(
        base.distance_mm(&Pose::kuka([100.0, 10.0, 0.0, 90.0, 0.0, 0.0])) < 1e-6,
        "{base:?}"
    );
    same(
        &first.tool.pose.unwrap(),
        &Pose::kuka([0.0, 0.0, 150.0, 0.0, 0.0, 0.0]),
    );
    assert_eq!((first.base.name.as_str(), first.tool.name.as_str()), ("w", "t"));
    assert!((second.base.pose.unwrap().position_mm[0] - 200.0).abs() < 1e-6);
    // A work object on a positioner is relative to its table.
    let moved = data.replace("[FALSE,TRUE,\"\"", "[FALSE,FALSE,\"STN1\"");
    let all = run(&moved, &format!("MoveL {},v10,fine,t\\WObj:=w;", target(1.0)));
    let base = &linears(&all)[0].base;
    assert_eq!(base.unit.as_deref(), Some("STN1"));
    same(
        base.pose.as_ref().unwrap(),
        &Pose::kuka([10.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    );
}

#[test]
fn targets_are_declared_indexed_and_moved() {
    let data = format!("CONST robtarget pts{{2}}:=[{},{}];", target(1.0), target(7.0));
    let all = run(
        &data,
        "MoveJ pts{2},v200,z50,tool0;\nMoveL Offs(pts{1},0,10,-5),v10,fine,tool0;\n\
         MoveL RelTool(pts{1},0,0,4),v10,fine,tool0;",
    );
    let JointTarget::Pose { pose, posture } = &joints(&all)[0].to else {
        panic!("{all:?}")
    };
    assert_eq!(
        (pose.position_mm, posture),
        ([7.0, 2.0, 3.0], &Posture::Quadrants([0.0, -1.0, 1.0, 0.0]))
    );
    assert_eq!(linears(&all)[0].to.position_mm, [1.0, 12.0, -2.0]);
    assert_eq!(linears(&all)[1].to.position_mm, [1.0, 2.0, 7.0]);
    refused(
        &data,
        "MoveL pts{3},v10,fine,tool0;",
        "m.mod:4: `pts` has 2 parts, not 3",
    );
    refused(
        "CONST num n{2}:=[1,2,3];",
        "",
        "m.mod:2: N has 3 values, 2 declared",
    );
}

#[test]
fn outputs_waits_stops_and_messages_are_events() {
    let at = target(1.0);
    let all = run(
        "",
        &format!(
            "! comment; with semicolon\nSetDO doSpindle,1;\nMoveL {at},v10,z1,tool0;\nSetDO doAir,high;\n\
             WaitTime 0.5;\nTPWrite \"load tool 2\"; ! by hand\nStop;\nReset doAir;\nPulseAll 1,2;\n\
              UIMsgBox \"start\" \\Buttons:=btnOK;"
        ),
    );
    assert_eq!(
        all[0],
        Action::Comment {
            text: "comment; with semicolon".to_owned()
        }
    );
    assert_eq!(all[1], output("doSpindle", "TRUE", false));
    // The output changes in the corner; the wait makes the corner a stop.
    assert_eq!(linears(&all)[0].blend, Blend::Exact);
    assert_eq!(all[3], output("doAir", "TRUE", true));
    assert_eq!(all[4], Action::Dwell { s: 0.5 });
    assert_eq!(
        all[5],
        Action::Message {
            text: "load tool 2".to_owned()
        }
    );
    assert_eq!(
        all[7],
        Action::Stop {
            message: Some("load tool 2".to_owned())
        }
    );
    assert_eq!(all[8], output("doAir", "FALSE", false));
    assert!(matches!(&all[9], Action::Call { name, .. } if name == "PulseAll"));
    let message = Some("start".to_owned());
    assert_eq!(all[10..], [Action::Stop { message }]);
}

#[test]
fn procedures_of_other_modules_run_with_their_own_data() {
    let main = "MODULE a\nLOCAL CONST num s:=1;\nPROC main()\nWaitTime s;\npart;\nENDPROC\nENDMODULE\n";
    let part = "MODULE b\nLOCAL CONST num s:=2;\nPROC part()\nVAR num t:=3;\nWaitTime s+t;\nRETURN;\n\
     WaitTime 9;\nENDPROC\nENDMODULE\n";
    let all = actions(Rapid, &[("a.mod", main), ("b.mod", part)], "main");
    assert_eq!(all, [Action::Dwell { s: 1.0 }, Action::Dwell { s: 5.0 }]);
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    let at = target(1.0);
    refused("", "IF TRUE THEN\nENDIF", "m.mod:");
    refused(
        "",
        "IF TRUE THEN\nWaitTime 1;\nENDIF",
        "m.mod:4: the instruction `IF` is not interpreted",
    );
    refused(
        "",
        "VelSet 50,800;",
        "m.mod:4: the instruction `VelSet` is not interpreted",
    );
    refused(
        "",
        "MoveExtJ j,v10,fine;",
        "m.mod:4: the instruction `MoveExtJ` is not interpreted",
    );
    refused("", "x:=1;", "m.mod:4: unknown statement `x`");
    refused("CONST num x:=1;", "x:=2;", "m.mod:4: `X` is a constant");
    refused(
        "",
        &format!("MoveL {},v10,fine,tool0;", at.replace("[1,0,0,0]", "[0.9,0,0,0]")),
        "does not have length 1",
    );
    refused(
        "",
        &format!("MoveL {at},v10,fine,tool9;"),
        "`tool9` is not defined",
    );
    refused("", &format!("MoveL {at},v10,fine,tool0"), "does not end with `;`");
    refused(
        "",
        "MoveL [[1,2],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0;",
        "m.mod:4: not a robtarget",
    );
    refused(
        "PERS tooldata t:=[FALSE,[[0,0,1],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];",
        &format!("MoveL {at},v10,fine,t;"),
        "the robot holds either the tool or the work object",
    );
    assert!(refusal(Rapid, &[("m.mod", &module("", ""))], "q").contains("no PROC q"));
}
