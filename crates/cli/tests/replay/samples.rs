//! Programs of other software: one list of poses in the languages of six makers.
//!
//! Source: `programs/same-poses-six-languages` of the samples, written by the public postprocessors of RoboDK. That of
//! ABB is another path; that of Staubli has no data, and that of Universal Robots no head.

use std::path::Path;

use crate::event::{Action, Blend, JointTarget, LinearMove};
use crate::expect::{actions, joints, linears, refusal, same_within};
use crate::pose::Pose;
use crate::replay::Language;

/// Places are printed with three decimals, in target and frame.
const MM: f64 = 0.002;
/// Angles are printed with two decimals at least, and those here are whole.
const DEG: f64 = 1e-3;

/// Text of a sample, if there are samples.
fn sample(file: &str) -> Option<String> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let path = Path::new(&samples)
        .join("programs/same-poses-six-languages")
        .join(file);
    Some(String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned())
}

/// The program in KRL.
fn krl() -> Option<Vec<Action>> {
    let text = sample("KUKA_KRC4.src")?;
    Some(actions(Language::Krl, &[("KUKA_KRC4.src", &text)], "Program"))
}

/// The target relative to the base of the robot.
fn from_robot(linear: &LinearMove) -> Pose {
    linear.base.pose.unwrap().then(&linear.to)
}

/// Eight lines to the same poses with the same tool; the calls between them.
#[track_caller]
fn same_lines(found: &[Action], expected: &[Action], tool: bool) {
    let (found, expected) = (linears(found), linears(expected));
    assert_eq!((found.len(), expected.len()), (8, 8));
    for (one, other) in found.iter().zip(expected) {
        same_within(&from_robot(one), &from_robot(other), MM, DEG);
        if tool {
            same_within(&one.tool.pose.unwrap(), &other.tool.pose.unwrap(), MM, DEG);
        }
    }
}

/// Axes of the first joint move that gives them, within what is printed.
#[track_caller]
fn same_axes(found: &[Action], expected: &[Action], deg: f64) {
    let axes = |all: &[Action]| {
        let given = joints(all).into_iter().find_map(|joint| match &joint.to {
            JointTarget::Axes(axes) | JointTarget::Pulses(axes) => Some(axes.clone()),
            _ => None,
        });
        given.unwrap()
    };
    for (one, other) in axes(found).iter().zip(axes(expected)) {
        assert!((one - other).abs() <= deg, "{one} {other}");
    }
}

/// Calls and waiting times: both routines, each with a second after it.
#[track_caller]
fn same_rest(found: &[Action]) {
    let rest: Vec<String> = found
        .iter()
        .filter_map(|action| match action {
            Action::Call { name, .. } => Some(name.clone()),
            Action::Dwell { s } => Some(s.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(rest, ["TCP_On", "1", "TCP_Off", "1"]);
}

#[test]
fn krl_has_the_poses_of_its_text() {
    let Some(krl) = krl() else { return };
    let first = from_robot(linears(&krl)[0]);
    let frame = Pose::kuka([807.767, -963.700, 41.479, 0.0, 0.0, 0.0]);
    same_within(
        &first,
        &frame.then(&Pose::kuka([200.0, 250.0, 348.735, 180.0, 0.0, -150.0])),
        1e-9,
        1e-9,
    );
    assert_eq!(joints(&krl)[0].to, JointTarget::Current);
    assert!(linears(&krl).iter().all(|linear| linear.blend == Blend::Exact));
    same_rest(&krl);
}

#[test]
fn tp_and_krl_agree() {
    let (Some(krl), Some(text)) = (krl(), sample("Fanuc_R30iA.LS")) else {
        return;
    };
    let tp = actions(Language::Tp, &[("Fanuc_R30iA.LS", &text)], "Program");
    same_lines(&tp, &krl, true);
    same_axes(&tp, &krl, 5.1e-4);
    same_rest(&tp);
}

#[test]
fn inform_and_krl_agree() {
    let (Some(krl), Some(text)) = (krl(), sample("Motoman.JBI")) else {
        return;
    };
    let inform = actions(Language::Inform, &[("Motoman.JBI", &text)], "Progra");
    same_lines(&inform, &krl, false);
    // One pulse for a degree, whole ones.
    same_axes(&inform, &krl, 0.5);
    same_rest(&inform);
}

#[test]
fn urscript_and_krl_agree() {
    let (Some(krl), Some(text)) = (krl(), sample("Universal_Robots_SCRIPT.script")) else {
        return;
    };
    let alone = refusal(
        Language::UrScript,
        &[("p.script", &format!("def Program():\n{text}"))],
        "Program",
    );
    assert!(
        alone.starts_with("p.script:7: `accel_radss` is not defined"),
        "{alone}"
    );
    let head = "def Program():\n  accel_radss = 1.4\n  speed_rads = 0.5\n  blend_radius_m = 0.001\n";
    let script = actions(
        Language::UrScript,
        &[("p.script", &format!("{head}{text}"))],
        "Program",
    );
    same_lines(&script, &krl, true);
    same_axes(&script, &krl, 5e-5);
    same_rest(&script);
}

#[test]
fn val3_and_krl_agree_with_points_by_hand() {
    let (Some(krl), Some(text)) = (krl(), sample("Staubli_VAL3_simplified.pgx")) else {
        return;
    };
    // Rz(180) Rx(-150) of KUKA is Rx(150) Rz(180), the order of Staubli.
    let points: Vec<String> = linears(&krl)
        .iter()
        .enumerate()
        .map(|(key, linear)| {
            let [x, y, z] = linear.to.position_mm;
            format!(
                "<Value key=\"{key}\" x=\"{x}\" y=\"{y}\" z=\"{z}\" rx=\"150\" ry=\"0\" rz=\"180\" \
             fatherId=\"fFrame[0]\"/>"
            )
        })
        .collect();
    let array = |name: &str, kind: &str, values: &str| {
        format!("<Data name=\"{name}\" type=\"{kind}\" size=\"8\">{values}</Data>")
    };
    let data = format!(
        "<Database>{}{}{}{}{}{}</Database>",
        array("pPoint", "pointRx", &points.concat()),
        array(
            "fFrame",
            "frame",
            "<Value key=\"0\" x=\"807.767\" y=\"-963.7\" z=\"41.479\" rx=\"0\" ry=\"0\" rz=\"0\" \
             fatherId=\"world[0]\"/>"
        ),
        // Rz(-60) Ry(90) of KUKA is Rx(90) Ry(30) Rz(-90).
        array(
            "tTool",
            "tool",
            "<Value key=\"0\" x=\"62.5\" y=\"-108.253\" z=\"100\" rx=\"90\" ry=\"30\" rz=\"-90\" \
             fatherId=\"flange[0]\"/>"
        ),
        array(
            "jJoint",
            "jointRx",
            "<Value key=\"0\" j1=\"0\" j2=\"0\" j3=\"0\" j4=\"0\" j5=\"0\" j6=\"0\"/>"
        ),
        array(
            "mNomSpeed",
            "mdesc",
            "<Value key=\"0\" vel=\"50\" tmax=\"100\" blend=\"off\" leave=\"0\" reach=\"0\"/>"
        ),
        array("nTraj", "num", ""),
    );
    let program = format!(
        "<Programs><Program name=\"start\"><Code><![CDATA[begin\n{text}\nend]]></Code></Program></Programs>"
    );
    let val3 = actions(
        Language::Val3,
        &[("start.pgx", program.as_str()), ("p.dtx", &data)],
        "start",
    );
    same_lines(&val3, &krl, true);
    assert_eq!(
        val3.iter()
            .filter(|action| matches!(action, Action::Dwell { s } if *s == 1.0))
            .count(),
        2
    );
}

#[test]
fn rapid_runs_with_frames_that_it_sets_itself() {
    let Some(text) = sample("ABB_RAPID_IRC5.mod") else {
        return;
    };
    let all = actions(Language::Rapid, &[("ABB_RAPID_IRC5.mod", &text)], "Prog1");
    assert_eq!((joints(&all).len(), linears(&all).len()), (2, 9));
    let calls = all
        .iter()
        .filter(|action| matches!(action, Action::Call { name, .. } if name.starts_with("ArcL")));
    assert_eq!(calls.count(), 3);
    let arcs: Vec<&LinearMove> = all
        .iter()
        .filter_map(|action| match action {
            Action::Circular { end, .. } => Some(end),
            _ => None,
        })
        .collect();
    assert_eq!(arcs.len(), 1);
    // The line after the arc goes to the end of the arc; the tool is that which the program sets.
    assert_eq!(arcs[0].to.position_mm, [2457.129, 797.242, 1156.545]);
    same_within(
        &arcs[0].tool.pose.unwrap(),
        &Pose::kuka([380.0, 0.0, 200.0, 0.0, 90.0, 0.0]),
        MM,
        DEG,
    );
}

#[test]
fn points_of_a_data_list_that_is_missing_are_refused() {
    for (file, message) in [
        (
            "KUKA_KRC2_DAT.src",
            "KUKA_KRC2_DAT.src:9: `PDEFAULT` is not defined",
        ),
        ("KUKA_KRC4_DAT.src", "`PPDAT1` is not defined"),
    ] {
        let Some(text) = sample(file) else { return };
        let found = refusal(Language::Krl, &[(file, &text)], "Program");
        assert!(found.contains(message), "{found}");
    }
}
