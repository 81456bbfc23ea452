//! `armill journal` as a user runs it: a lever whose lengths, compliances and backlash are found from three measurements, and what can be wrong.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::cell::armill;

const ROBOT: &str = r#"format = 1
name = "lever"

[chain]
source = "drawing"
motions = [
  { about = "z", joint = "A" },
  { along = "x", length_mm = 300 },
  { about = "z", joint = "B" },
  { along = "x", length_mm = 200 },
]

[[joint]]
name = "A"
sign = 1
compliance_rad_per_n_m = 2e-6
compliance_source = "drawing"
source = "drawing"

[[joint]]
name = "B"
sign = -1
compliance_rad_per_n_m = 4e-6
compliance_source = "drawing"
source = "drawing"

[sources.drawing]
what = "lengths, compliances of a similar arm"
where = "here"
licence = "ours"
"#;

const JOURNAL: &str = r#"format = 1
robot = "lever.toml"
tool_mm = [0, 0, 0]

[[measurement]]
date = "2026-11-23"
temperature_c = 21
kind = "part"
file = "part.csv"
u_um = 10

[[measurement]]
date = "2026-11-25"
temperature_c = 29
kind = "load-tests"
file = "loads.csv"
"#;

/// True compliances, rad/(N m), and backlash of the first joint, rad.
const DRIVES: [f64; 2] = [3e-6, 5e-6];
const GAP: f64 = 3.4e-4;

/// Position (mm) of the true lever, whose first link has 300.5 mm; by plane trigonometry. The second joint counts the other way.
fn tip(a_deg: f64, b_deg: f64, [fx, fy]: [f64; 2], direction: f64) -> [f64; 2] {
    let (mut a, mut b) = (a_deg.to_radians(), -b_deg.to_radians());
    let elbow = |a: f64| [0.3005 * a.cos(), 0.3005 * a.sin()];
    let end = |a: f64, b: f64| {
        let [x, y] = elbow(a);
        [x + 0.2 * (a + b).cos(), y + 0.2 * (a + b).sin()]
    };
    let ([x, y], [xe, ye]) = (end(a, b), elbow(a));
    a += DRIVES[0] * (x * fy - y * fx) - 0.5 * GAP * direction;
    b += DRIVES[1] * ((x - xe) * fy - (y - ye) * fx);
    end(a, b).map(|m| m * 1e3)
}

fn posture(k: u32) -> (f64, f64, [f64; 2]) {
    let force = [f64::from(k * 71 % 300) - 150.0, f64::from(k * 29 % 200) - 100.0];
    (
        f64::from(k * 37 % 90) - 45.0,
        f64::from(k * 53 % 100) + 20.0,
        force,
    )
}

/// Features of a part in a frame turned by 30 deg; scatter of some um.
fn part() -> String {
    let mut text = "A_deg,B_deg,fx_n,fy_n,A_direction,x_mm,y_mm,z_mm,remark\n".to_owned();
    let (sin, cos) = 30f64.to_radians().sin_cos();
    for k in 0..14 {
        let (a, b, [fx, fy]) = posture(k);
        let direction = if k % 2 == 0 { -1.0 } else { 1.0 };
        let [x, y] = tip(a, b, [fx, fy], direction);
        let (x, y) = (
            x + f64::from(k * 11 % 7) / 400.0,
            y + f64::from(k * 5 % 9) / 500.0,
        );
        let (u, v) = (cos * x - sin * y, sin * x + cos * y);
        let _ = writeln!(text, "{a},{b},{fx},{fy},{direction},{u:.4},{v:.4},0,good");
    }
    text
}

fn loads() -> String {
    let mut text = "A_deg,B_deg,fx_n,fy_n,dx_mm,dy_mm,d_u_mm\n".to_owned();
    for k in 80..86 {
        let (a, b, [fx, fy]) = posture(k);
        let ([x, y], [x0, y0]) = (tip(a, b, [fx, fy], 0.0), tip(a, b, [0.0, 0.0], 0.0));
        let _ = writeln!(text, "{a},{b},{fx},{fy},{:.4},{:.4},0.004", x - x0, y - y0);
    }
    text
}

pub fn cell() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let work: String = part()
        .lines()
        .map(|line| line.rsplitn(5, ',').last().unwrap().to_owned() + "\n")
        .collect();
    for (name, text) in [
        ("lever.toml", ROBOT.to_owned()),
        ("journal.toml", JOURNAL.to_owned()),
        ("part.csv", part()),
        ("loads.csv", loads()),
        ("work.csv", work),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// A circle of 80 mm forth and back: joint positions of a lever with nominal lengths, distances of the true one from a pivot that is not exactly in
/// the middle, by a bar that is 0.02 mm too short.
fn ball_bar() -> String {
    let mut text = "A_deg,B_deg,A_direction,radius_mm\n".to_owned();
    let joints = |angle_deg: f64| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let (x, y) = (320.0 + 80.0 * cos, 120.0 + 80.0 * sin);
        let inner = ((x * x + y * y - 300.0f64.powi(2) - 200.0f64.powi(2)) / 120_000.0).acos();
        let outer = (200.0 * inner.sin()).atan2(300.0 + 200.0 * inner.cos());
        [(y.atan2(x) - outer).to_degrees(), -inner.to_degrees()]
    };
    for way in [1.0, -1.0] {
        for k in 0..120 {
            let angle = way * f64::from(3 * k);
            let ([a, b], [next, _]) = (joints(angle), joints(angle + 0.01 * way));
            let direction = (next - a).signum();
            let [x, y] = tip(a, b, [0.0, 0.0], direction);
            let radius = (x - 320.3).hypot(y - 119.8) + 0.02 + f64::from(k * 11 % 7 - 3) / 4000.0;
            let _ = writeln!(text, "{a:.7},{b:.7},{direction},{radius:.5}");
        }
    }
    text
}

#[test]
fn a_ball_bar_measures_the_backlash_of_a_joint() {
    let folder = cell();
    let at = folder.path();
    let journal = JOURNAL.split("[[measurement]]").next().unwrap().to_owned()
        + "[[measurement]]\ndate = \"2026-11-27\"\ntemperature_c = 20\nkind = \"ball-bar\"\nfile = \"bar.csv\"\nu_um = 1\n";
    std::fs::write(at.join("bar.toml"), &journal).unwrap();
    std::fs::write(at.join("bar.csv"), ball_bar()).unwrap();
    let (code, out, err) = armill(at, &["journal", "bar.toml", "--json"]);
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    let measured = &answer["measurements"][0];
    assert!(
        measured["kind"] == "ball-bar" && measured["readings"] == 239,
        "{answer}"
    );
    assert!(measured["after"].as_f64().unwrap() < 1.5, "{answer}");
    let backlash = answer["backlash"][0]["value"].as_f64().unwrap();
    assert!((backlash / GAP.to_degrees() - 1.0).abs() < 0.03, "{answer}");

    std::fs::write(at.join("bar.csv"), ball_bar().replace("radius_mm", "radius")).unwrap();
    refused(
        at,
        &["journal", "bar.toml"],
        &["bar.csv: line 2 has no reading", "radius_mm"],
    );
    std::fs::write(
        at.join("bar.csv"),
        ball_bar().replace("A_deg", "b_deg").replace("B_deg", "A_deg"),
    )
    .unwrap();
    refused(
        at,
        &["journal", "bar.toml"],
        &["mm from a reading of the ball-bar", "point_mm"],
    );
    std::fs::write(
        at.join("bar.toml"),
        journal.replace("u_um = 1", "calibrated = true"),
    )
    .unwrap();
    refused(at, &["journal", "bar.toml"], &["bar.toml:8", "add u_um"]);
}

fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let (code, out, err) = armill(folder, arguments);
    assert!(code == 2 && out.is_empty(), "{out}{err}");
    for word in words {
        assert!(err.contains(word), "{word}: {err}");
    }
}

fn value(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap()
}

#[test]
fn lengths_compliances_and_backlash_are_found_and_written() {
    let folder = cell();
    let at = folder.path();
    let command = [
        "journal",
        "journal.toml",
        "--work",
        "work.csv",
        "--next",
        "3",
        "--out",
        "mine.toml",
        "--json",
    ];
    let (code, out, err) = armill(at, &command);
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    let near = |found: &Value, truth: f64| {
        let off = (value(found, "value") - truth) / value(found, "u");
        assert!(
            off.abs() < 3.0 && value(found, "u") < 0.3 * truth,
            "{found} {truth}"
        );
    };
    near(&answer["drives"][0], DRIVES[0]);
    near(&answer["drives"][1], DRIVES[1]);
    near(&answer["backlash"][0], GAP.to_degrees());
    let measured = answer["measurements"].as_array().unwrap();
    // The part predicts the load tests better than the robot file does.
    assert!(
        value(&measured[1], "predicted") < 0.7 * value(&measured[1], "before"),
        "{measured:?}"
    );
    let uncertainty = answer["work"]["uncertainty_um"].as_array().unwrap();
    assert!(
        uncertainty.len() == 3
            && uncertainty
                .windows(2)
                .all(|two| two[1].as_f64() < two[0].as_f64())
    );
    let next = answer["next"].as_array().unwrap();
    assert!(
        next.len() == 3
            && next
                .iter()
                .all(|one| one["kind"] == "load test" || one["kind"] == "position")
    );
    assert!(value(&next[2], "uncertainty_um") <= value(&next[0], "uncertainty_um"));
    assert!(
        answer["unused"].to_string().contains("part.csv: remark"),
        "{answer}"
    );
    assert!(
        answer["notes"].to_string().contains("between 21 and 29 deg C"),
        "{answer}"
    );

    // The written robot predicts what the journal found: force on the tool, 100 N across the stretched lever.
    let pose = [
        "pose",
        "mine.toml",
        "--joints-deg",
        "0,0",
        "--wrench-n",
        "0,100,0",
        "--json",
    ];
    let (code, out, err) = armill(at, &pose);
    assert_eq!(code, 0, "{err}");
    let pose: Value = serde_json::from_str(&out).unwrap();
    let found = [0, 1].map(|k| value(&answer["drives"][k], "value"));
    let gap = value(&answer["backlash"][0], "value").to_radians();
    let reach = 0.5005;
    // The first joint is at the side of its backlash that is worse.
    let by_hand = [
        100.0 * found[0] * reach * reach + 0.5 * gap * reach,
        100.0 * found[1] * 0.04,
    ];
    for (joint, by_hand) in by_hand.into_iter().enumerate() {
        let share = pose["postures"][0]["joint_share_um"][joint][1].as_f64().unwrap();
        assert!(
            (share / (by_hand * 1e6) - 1.0).abs() < 2e-3,
            "{joint}: {share} {by_hand}"
        );
    }

    let (code, out, err) = armill(at, &["journal", "journal.toml", "--work", "work.csv"]);
    assert!(
        code == 0 && out.contains("2 measurements") && out.contains("load tests: loads.csv"),
        "{out}{err}"
    );
}

#[test]
fn bad_journals_are_refused_and_nothing_is_written() {
    let folder = cell();
    let at = folder.path();
    let with = |from: &str, to: &str, words: &[&str]| {
        std::fs::write(at.join("bad.toml"), JOURNAL.replace(from, to)).unwrap();
        refused(at, &["journal", "bad.toml", "--out", "none.toml"], words);
        assert!(!at.join("none.toml").exists());
    };
    with(
        "2026-11-23",
        "yesterday",
        &["bad.toml:6", "`yesterday` is not a day", "2026-11-24"],
    );
    with("part.csv", "gone.csv", &["cannot read gone.csv"]);
    with("lever.toml", "gone.toml", &["gone.toml"]);
    let sum = "0".repeat(64);
    with(
        "u_um = 10",
        &format!("u_um = 10\nsha256 = \"{sum}\""),
        &["part.csv", "checksum", "changed after it was entered"],
    );
    with("u_um = 10", "", &["bad.toml:8", "add u_um = 10"]);
    with(
        "kind = \"part\"",
        "kind = \"loads\"",
        &["bad.toml:8", "load-tests"],
    );
    refused(
        at,
        &["journal", "none.toml"],
        &["none.toml", "docs/guide/journal.md"],
    );
    refused(at, &["journal", "journal.toml", "--next", "3"], &["--work"]);
    refused(
        at,
        &["journal", "journal.toml", "--position-u-um", "0"],
        &["--position-u-um", "above 0"],
    );
    std::fs::write(at.join("part.csv"), part().replace("-1,", "-2,")).unwrap();
    refused(at, &["journal", "journal.toml"], &["part.csv:2:", "1 or -1"]);
    std::fs::write(
        at.join("part.csv"),
        part().lines().take(3).collect::<Vec<_>>().join("\n"),
    )
    .unwrap();
    refused(at, &["journal", "journal.toml"], &["part.csv", "2 poses"]);
}
