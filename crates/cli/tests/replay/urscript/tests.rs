//! URScript programs by hand: frames by `pose_trans`, defaults, blends, outputs, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, output, refusal, same, same_within};
use crate::pose::Pose;
use crate::replay::Language::UrScript;

#[track_caller]
fn lines(text: &str) -> Vec<Action> {
    actions(
        UrScript,
        &[("p.script", &format!("def p():\n{text}\nend\n"))],
        "p",
    )
}

#[track_caller]
fn refused(text: &str, message: &str) {
    let found = refusal(
        UrScript,
        &[("p.script", &format!("def p():\n{text}\nend\n"))],
        "p",
    );
    assert!(found.contains(message), "{found}");
}

#[test]
fn moves_have_names_positions_and_defaults_of_arguments() {
    let all = lines(
        "  movej([0, -1.570796, 1.570796, 0, 0.5, d2r(90)], a=1.4, v=0.5)\n\
           movel(p[0.5, 0, 0.2, 0, 3.141593, 0], 1.2, 0.03, 0, 0.0002)\n\
         movel(p[0.5, 0, 0.3, 0, 3.141593, 0])\n  movel(p[0.5, 0, 0.3, 0, 3.141593, 0], t=2, r=0)",
    );
    let JointTarget::Axes(axes) = &joints(&all)[0].to else {
        panic!("{all:?}")
    };
    assert!(
        (axes[1] + 90.0).abs() < 1e-4 && (axes[5] - 90.0).abs() < 1e-9,
        "{axes:?}"
    );
    assert_eq!(joints(&all)[0].speed, Speed::DegPerS(0.5f64.to_degrees()));
    let found = linears(&all);
    same_within(
        &found[0].to,
        &Pose::kuka([500.0, 0.0, 200.0, 0.0, 180.0, 0.0]),
        1e-6,
        1e-4,
    );
    assert_eq!(
        (found[0].speed, found[0].blend),
        (Speed::MmPerS(30.0), Blend::DistanceMm(0.2))
    );
    assert_eq!(
        (found[1].speed, found[1].blend),
        (Speed::MmPerS(250.0), Blend::Exact)
    );
    assert_eq!(found[2].speed, Speed::Seconds(2.0));
    assert_eq!(found[2].tool.pose, None);
}

#[test]
fn targets_are_composed_with_frames() {
    let all = lines(
        "  f = p[1.7, 0.2, 0.9, 0, 0, -1.5707963267948966]\n  set_tcp(p[0, 0.09, 0.26, 0, 0, 0])\n\
         movel(pose_trans(f, p[0.01, 0, 0.002, 0, 0, 0]), v=0.01)\n  movel(pose_trans(pose_inv(f), f), v=0.01)\n\
         movel(pose_add(f, p[0, 0, 0.1, 0, 0, 0]), v=0.01)\n\
         movej(get_inverse_kin(pose_trans(f, p[0, 0, 0, 0, 0, 0]), [0.1, 0, 0, 0, 0, 0]), v=0.5)",
    );
    let found = linears(&all);
    same(&found[0].to, &Pose::kuka([1700.0, 190.0, 902.0, -90.0, 0.0, 0.0]));
    same(
        &found[0].tool.pose.unwrap(),
        &Pose::kuka([0.0, 90.0, 260.0, 0.0, 0.0, 0.0]),
    );
    same(&found[1].to, &Pose::IDENTITY);
    same(
        &found[2].to,
        &Pose::kuka([1700.0, 200.0, 1000.0, -90.0, 0.0, 0.0]),
    );
    let JointTarget::Pose {
        pose,
        posture: Posture::Near(near),
    } = &joints(&all)[0].to
    else {
        panic!("{all:?}")
    };
    same(pose, &Pose::kuka([1700.0, 200.0, 900.0, -90.0, 0.0, 0.0]));
    assert!((near[0] - 0.1f64.to_degrees()).abs() < 1e-12);
}

#[test]
fn statements_are_events_in_their_order() {
    let text = "def sub():\n  sleep(1.5)\nend\ndef p():\n  # comment\n  set_payload(2.5, [0, 0, 0.1])\n  sub()\n\
        set_standard_digital_out(3, True)\n  popup(\"info\", \"t\")\n\
           popup(\"load tool 2\", title=\"tool\", blocking=True)\n\
        spindle_on(1)\n  movel(p[0, 0, 0, 0, 0, 0], r=0.001)\n  set_digital_out(0, False)\n  halt\n  sleep(9)\n\
         end\np()\n";
    let all = actions(UrScript, &[("p.script", text)], "p");
    assert_eq!(
        all[0],
        Action::Comment {
            text: "comment".to_owned()
        }
    );
    assert_eq!(all[1], Action::Dwell { s: 1.5 });
    assert_eq!(all[2], output("standard_digital_out[3]", "TRUE", false));
    assert_eq!(
        all[5],
        Action::Stop {
            message: Some("info load tool 2".to_owned())
        }
    );
    assert!(matches!(&all[6], Action::Call { name, .. } if name == "spindle_on"));
    assert_eq!(all[8], output("digital_out[0]", "FALSE", true));
    assert_eq!(all[9], Action::Stop { message: None });
    assert_eq!(all.len(), 10);
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    refused(
        "  sleep(1)\n  while True:",
        "p.script:3: unknown statement `while`",
    );
    refused(
        "  movel(p[0, 0, 0, 0, 0, 0], v=speed)",
        "p.script:2: `speed` is not defined",
    );
    refused(
        "  movel(p[0, 0, 0, 0, 0, 0], w=1)",
        "p.script:2: unknown argument w",
    );
    refused("  movel(p[0, 0, 0, 0, 0])", "p.script:2: a pose has six numbers");
    refused("  movej([0, 0, 0])", "joint positions are six numbers");
    refused(
        "  movep(p[0, 0, 0, 0, 0, 0])",
        "the function `movep` is not interpreted",
    );
    refused("  movel([0, 0, 0, 0, 0, 0])", "needs the model of the arm");
    refused("  sleep(1", "p.script:2: `)` expected");
    refused("  x = pose_dist(1, 2)", "unknown function `pose_dist`");
    assert!(refusal(UrScript, &[("p.script", "def p():\nsleep(1)\n")], "p").contains("def p has no end"));
    assert!(refusal(UrScript, &[("p.script", "def p():\nend\n")], "q").contains("no def q"));
}
