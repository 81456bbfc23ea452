//! VAL3 projects by hand: data, fathers of frames, blending, outputs that do not wait, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, refusal, same};
use crate::pose::Pose;
use crate::replay::Language::Val3;

const DATA: &str = r#"<?xml version="1.0" encoding="utf-8" ?>
<Database xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns="http://www.staubli.com/robotics/VAL3/Data/2">
  <Datas>
    <Data name="fFrame" xsi:type="array" type="frame" size="3">
      <Value key="1" x="100" y="0" z="0" rx="0" ry="0" rz="90" fatherId="world[0]" />
      <Value key="2" x="10" y="0" z="0" rx="0" ry="0" rz="0" fatherId="fFrame[1]" />
    </Data>
    <Data name="tTool" xsi:type="array" type="tool" size="1">
      <Value key="0" x="0" y="0" z="150" rx="0" ry="0" rz="0" fatherId="flange[0]" />
    </Data>
    <Data name="jHome" xsi:type="array" type="jointRx" size="1">
      <Value key="0" j1="1" j2="-2" j3="3" j4="0" j5="5" j6="6" />
    </Data>
    <Data name="pPoint" xsi:type="array" type="pointRx" size="3">
      <Value key="0" x="1" y="2" z="3" rx="180" ry="0" rz="90" shoulder="lefty" fatherId="fFrame[2]" />
      <Value key="1" x="4" y="5" z="6" rx="10" ry="20" rz="30" fatherId="world[0]" />
    </Data>
    <Data name="mSpeed" xsi:type="array" type="mdesc" size="3">
      <Value key="0" vel="10" tmax="99999" rmax="99999" blend="off" leave="0" reach="0" />
      <Value key="1" vel="100" tmax="30" rmax="99999" blend="cartesian" leave="0.2" reach="0.3" />
      <Value key="2" vel="100" tmax="30" rmax="99999" blend="wide" leave="0.2" reach="0.3" />
    </Data>
    <Data name="doSpindle" xsi:type="array" type="dio" size="1" />
    <Data name="nTraj" xsi:type="array" type="num" size="1" />
  </Datas>
</Database>
"#;

fn program(name: &str, statements: &str) -> String {
    format!(
        "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n\
         <Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n\
         <Program name=\"{name}\" access=\"public\">\n\
         <Code><![CDATA[begin\n{statements}\nend]]></Code>\n</Program>\n</Programs>\n"
    )
}

#[track_caller]
fn run(statements: &str) -> Vec<Action> {
    actions(
        Val3,
        &[("p.dtx", DATA), ("start.pgx", &program("start", statements))],
        "start",
    )
}

#[track_caller]
fn refused(statements: &str, message: &str) {
    let found = refusal(
        Val3,
        &[("p.dtx", DATA), ("start.pgx", &program("start", statements))],
        "start",
    );
    assert!(found.contains(message), "{found}");
}

#[test]
fn frames_and_tools_are_relative_to_their_fathers() {
    let all = run(
        "  nTraj=movej(jHome,tTool,mSpeed)\n  movel(pPoint[0],tTool[0],mSpeed[1])\n\
           movej(pPoint[1],tTool[0],mSpeed[0])",
    );
    let [home, point] = joints(&all)[..] else {
        panic!("{all:?}")
    };
    assert_eq!(home.to, JointTarget::Axes(vec![1.0, -2.0, 3.0, 0.0, 5.0, 6.0]));
    assert_eq!((home.speed, home.blend), (Speed::Percent(10.0), Blend::Exact));
    let line = linears(&all)[0];
    assert_eq!(line.base.name, "fFrame[2]");
    same(
        &line.base.pose.unwrap(),
        &Pose::kuka([100.0, 10.0, 0.0, 90.0, 0.0, 0.0]),
    );
    same(&line.to, &Pose::fixed_xyz([1.0, 2.0, 3.0, 180.0, 0.0, -90.0]));
    same(
        &line.tool.pose.unwrap(),
        &Pose::kuka([0.0, 0.0, 150.0, 0.0, 0.0, 0.0]),
    );
    assert_eq!(
        (line.speed, line.blend),
        (Speed::MmPerS(30.0), Blend::DistanceMm(0.2))
    );
    let JointTarget::Pose {
        posture: Posture::Named(words),
        ..
    } = &point.to
    else {
        panic!("{point:?}")
    };
    assert_eq!(words[0], "ssame");
}

#[test]
fn an_output_waits_for_the_end_of_the_move_only_after_wait_end_move() {
    for (between, moving) in [("", true), ("  waitEndMove()\n", false)] {
        let all = run(&format!(
            "  movel(pPoint[0],tTool[0],mSpeed[1])\n{between}  doSpindle=true"
        ));
        let Action::Output {
            name,
            value,
            moving: found,
        } = &all[1]
        else {
            panic!("{all:?}")
        };
        assert_eq!(
            (name.as_str(), value.as_str(), *found),
            ("doSpindle[0]", "TRUE", moving)
        );
        // The end is waited for: the move is not blended.
        assert_eq!(linears(&all)[0].blend == Blend::Exact, !moving);
    }
}

#[test]
fn programs_in_the_files_run_and_others_are_calls() {
    let files = [
        (
            "p.pjx",
            "<Project><Programs><Program file=\"start.pgx\" /><Program file=\"sub.pgx\" /></Programs></Project>",
        ),
        (
            "start.pgx",
            &program(
                "start",
                "  // comment\n  call sub()\n  call lib:tool(3)\n  popUpMsg(\"load tool 2\")\n  wait(diStart)\n\
                   movel(appro(pPoint[1],{0,0,-10,0,0,0}),tTool,mSpeed)",
            ),
        ),
        ("sub.pgx", &program("sub", "  delay(1.5)\n  return\n  delay(9)")),
        ("p.dtx", DATA),
    ];
    // The name of the project starts its program `start`.
    let all = actions(Val3, &files, "p");
    assert_eq!(
        all[0],
        Action::Comment {
            text: "comment".to_owned()
        }
    );
    assert_eq!(all[1], Action::Dwell { s: 1.5 });
    assert!(matches!(&all[2], Action::Call { name, .. } if name == "lib:tool"));
    assert_eq!(
        all[3],
        Action::Message {
            text: "load tool 2".to_owned()
        }
    );
    assert!(matches!(&all[4], Action::Wait { condition } if condition == "diStart"));
    let point = Pose::staubli([4.0, 5.0, 6.0, 10.0, 20.0, 30.0]);
    same(
        &linears(&all)[0].to,
        &point.then(&Pose::kuka([0.0, 0.0, -10.0, 0.0, 0.0, 0.0])),
    );
    let missing = refusal(Val3, &[files[0], files[1]], "p");
    assert!(missing.contains("the project lists sub.pgx"), "{missing}");
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    refused("  delay(1)\n  if true", "start.pgx:6: ");
    refused(
        "  movel(pPoint[9],tTool[0],mSpeed[0])",
        "start.pgx:5: pPoint[9], but the size is 3",
    );
    refused(
        "  movel(pPoint[2],tTool[0],mSpeed[0])",
        "pPoint[2] has no value in the data",
    );
    refused("  movel(jHome,tTool[0],mSpeed[0])", "movel needs a point");
    refused("  movel(pPoint[0],mSpeed[0],mSpeed[0])", "a tool expected");
    refused(
        "  movel(pPoint[0],tTool[0],mSpeed[2])",
        "is not off, joint or cartesian (p.dtx:21)",
    );
    refused(
        "  movel(pOther[0],tTool[0],mSpeed[0])",
        "`pOther` is not in the data",
    );
    refused("  stopMove()", "unknown instruction `stopMove`");
    refused("  jHome=3", "setting a variable of type jointRx");
    let broken = refusal(Val3, &[("p.dtx", &DATA.replace("</Datas>", ""))], "start");
    assert!(broken.starts_with("p.dtx:0: "), "{broken}");
    let open = program("start", "").replace("\nend]]>", "]]>");
    let found = refusal(Val3, &[("start.pgx", &open)], "start");
    assert!(
        found.contains("start.pgx:4: the code is not between begin and end"),
        "{found}"
    );
}
