//! `armill drives` as a user runs it: a joint whose link encoder is late, its picture, and what can be wrong.

use std::fmt::Write;

use serde_json::Value;

use crate::cell::armill;

/// A log of one joint: 3 ms, 1e-3 deg/(N m), lost motion of 0.004 deg; cells are rounded to 1e-4 deg.
fn log() -> String {
    let mut text = "time_s,motor_j1_deg,link_j1_deg,torque_j1_nm\n".to_owned();
    let motor = |t: f64| 20.0 * (1.3 * t).sin() + 6.0 * (4.1 * t).sin();
    let torque = |t: f64| 8.0 * (2.1 * t).cos() + 5.0 * (0.7 * t).sin();
    for k in 0..2500 {
        let t = f64::from(k) * 0.004;
        let d = t - 0.003;
        let direction = (26.0 * (1.3 * d).cos() + 24.6 * (4.1 * d).cos()).signum();
        let link = motor(d) - 1e-3 * torque(d) - 0.002 * direction;
        let _ = writeln!(text, "{t:.3},{:.4},{link:.4},{:.3}", motor(t), torque(t));
    }
    text
}

fn folder(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), text).unwrap();
    folder
}

#[test]
fn delay_compliance_and_lost_motion_of_a_log_are_found_and_drawn() {
    let folder = folder(&log());
    let command = [
        "drives",
        "log.csv",
        "--gear",
        "250",
        "--compare",
        "log.csv",
        "--drawing",
        "t.svg",
        "--json",
    ];
    let (code, out, err) = armill(folder.path(), &command);
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    let joint = &answer["joints"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!((number(&joint["delay_ms"]["value"]) - 3.0).abs() < 0.01, "{out}");
    // 1e-3 deg/(N m) and 0.004 deg in urad.
    let apart = |value: &Value, given: f64| (number(value) / given - 1.0).abs();
    assert!(
        apart(&joint["compliance_urad_per_nm"]["value"], 17.4533) < 0.01,
        "{out}"
    );
    assert!(apart(&joint["lost_motion_urad"], 69.813) < 0.03, "{out}");
    assert!(
        apart(&joint["stiffness_nm_per_rad"]["value"], 250.0 / 17.4533e-6) < 0.01,
        "{out}"
    );
    assert!(number(&joint["compared_rms_urad"][1]) < 5.0, "{out}");
    let drawn = std::fs::read_to_string(folder.path().join("t.svg")).unwrap();
    assert!(drawn.contains("joint 1: torsion"));
}

#[test]
fn wrong_options_and_logs_are_refused() {
    let folder = folder(&log());
    let at = folder.path();
    std::fs::write(at.join("plain.csv"), log().replace("link_j1_deg", "other")).unwrap();
    std::fs::write(at.join("new.mat"), b"\x89HDF\r\n\x1a\n").unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["log.csv", "--gear", "0"], "--gear"),
        (
            &["log.csv", "--gear", "250,250"],
            "2 ratios, but the log has 1 joints",
        ),
        (&["log.csv", "--names", "a,b"], "--names: 2 names"),
        (&["plain.csv"], "link encoder"),
        (&["new.mat"], "-v7"),
        (&["log.csv", "--drawing", "t.pdf"], ".svg or .png"),
    ];
    for (arguments, words) in cases {
        let (code, _, err) = armill(at, &[&["drives"], arguments].concat());
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(err.contains(words), "{words}: {err}");
    }
    assert!(!at.join("t.pdf").exists());
}
