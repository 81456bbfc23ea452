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

/// A robot of one joint about a vertical axis.
const LEVER: &str = "format = 1\nname = \"lever\"\n\n[chain]\nsource = \"drawing\"\nmotions = [{ about = \"z\", joint = \"A\" }, { along = \"x\", length_mm = 500 }]\n\n\
    [[joint]]\nname = \"A\"\nsign = 1\nsource = \"drawing\"\n\n[sources.drawing]\nwhat = \"lengths\"\nwhere = \"here\"\nlicence = \"ours\"\n";

#[test]
fn what_was_found_is_written_into_a_robot_file() {
    let folder = folder(&log());
    let at = folder.path();
    std::fs::write(at.join("lever.toml"), LEVER).unwrap();
    let command = [
        "drives",
        "log.csv",
        "--gear",
        "250",
        "--robot",
        "lever.toml",
        "--out",
        "found.toml",
    ];
    let (code, _, err) = armill(at, &command);
    assert_eq!(code, 0, "{err}");
    let written = std::fs::read_to_string(at.join("found.toml")).unwrap();
    let number = |key: &str| -> f64 {
        let line = written
            .lines()
            .find_map(|line| line.strip_prefix(&format!("{key} = ")));
        line.unwrap().parse().unwrap()
    };
    // 1e-3 deg/(N m) over the ratio, and 0.004 deg; next to a reversal the direction is uncertain for a sample.
    let compliance = 1e-3_f64.to_radians() / 250.0;
    assert!(
        (number("compliance_rad_per_n_m") / compliance - 1.0).abs() < 0.01,
        "{written}"
    );
    assert!(number("compliance_u_rad_per_n_m") > 0.0);
    assert!(
        (number("backlash_deg") / 0.004 - 1.0).abs() < 0.03 && number("backlash_u_deg") > 0.0,
        "{written}"
    );
    assert!(err.contains("robot with these values in found.toml"), "{err}");
    let (code, _, err) = armill(at, &command);
    assert_eq!(code, 0, "the same file is done: {err}");
    std::fs::write(at.join("found.toml"), "# changed\n").unwrap();
    let (code, _, err) = armill(at, &command);
    assert_eq!(code, 2, "an existing file is kept: {err}");
    assert_eq!(
        std::fs::read_to_string(at.join("found.toml")).unwrap(),
        "# changed\n"
    );
}

/// A log without link encoders: 1.5 N m, 4 N m s/rad, 0.8 kg m^2, 12 N m at a horizontal arm; positions have 6 decimals.
#[test]
fn friction_and_load_are_found_without_link_encoders() {
    let mut text = "time_s,motor_j1_deg,torque_j1_nm\n".to_owned();
    for k in 0..5000 {
        let t = f64::from(k) * 0.004;
        let [q, v, a] = [
            1.5 * (0.9 * t).sin() + 0.4 * (3.1 * t).sin(),
            1.35 * (0.9 * t).cos() + 1.24 * (3.1 * t).cos(),
            -1.215 * (0.9 * t).sin() - 3.844 * (3.1 * t).sin(),
        ];
        let torque = 1.5 * v.signum() + 4.0 * v + 0.8 * a + 12.0 * q.cos();
        let _ = writeln!(text, "{t:.3},{:.6},{torque:.4}", q.to_degrees());
    }
    let folder = folder(&text);
    let (code, out, err) = armill(
        folder.path(),
        &["drives", "log.csv", "--json", "--compare", "log.csv"],
    );
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answer["joints"].as_array().unwrap().len(), 0);
    let motor = &answer["motors"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    for (value, given) in [
        (&motor["coulomb_nm"], 1.5),
        (&motor["viscous_nm_s_per_rad"], 4.0),
        (&motor["inertia_kg_m2"], 0.8),
        (&motor["loads"][0]["coefficient"], 12.0),
    ] {
        assert!(
            (number(&value["value"]) / given - 1.0).abs() < 0.01,
            "{value} for {given}"
        );
    }
    assert_eq!(motor["loads"][0]["unit"], "nm");
    assert!(number(&motor["compared_rms_nm"][1]) < 0.1, "{out}");
    let (_, out, _) = armill(folder.path(), &["drives", "log.csv"]);
    assert!(
        out.contains("Coulomb friction") && !out.contains("stiffness at the joint"),
        "{out}"
    );
}

#[test]
fn wrong_options_and_logs_are_refused() {
    let folder = folder(&log());
    let at = folder.path();
    std::fs::write(at.join("plain.csv"), log().replace("link_j1_deg", "other")).unwrap();
    std::fs::write(at.join("bare.csv"), log().replace("torque_j1_nm", "other")).unwrap();
    std::fs::write(at.join("lever.toml"), LEVER).unwrap();
    std::fs::write(at.join("cut.mat"), b"\x89HDF\r\n\x1a\n").unwrap();
    let arrays = include_bytes!("../../../formats/tests/seeds/arrays_7_3.mat");
    std::fs::write(at.join("new.mat"), arrays).unwrap();
    let cases: [(&[&str], &str); 14] = [
        (&["log.csv", "--gear", "0"], "--gear"),
        (
            &["log.csv", "--gear", "250,250"],
            "2 ratios, but the log has 1 joints",
        ),
        (&["log.csv", "--names", "a,b"], "--names: 2 names"),
        (&["bare.csv"], "torque of a motor"),
        (
            &["log.csv", "--rotor-inertia", "0.01"],
            "--rotor-inertia needs the gear ratios",
        ),
        (
            &["log.csv", "--gear", "250", "--rotor-inertia", "99"],
            "--rotor-inertia: 99 is outside 0 to 10",
        ),
        (
            &["log.csv", "--robot", "yaskawa/mh12"],
            "has 6 joints, but the log has 1",
        ),
        (&["log.csv", "--out", "found.toml"], "--robot"),
        (
            &["plain.csv", "--robot", "lever.toml", "--out", "found.toml"],
            "neither a stiffness nor lost motion was found",
        ),
        (&["cut.mat"], "-v7"),
        (&["new.mat"], "its arrays: rec.a, rec.count,"),
        (
            &["new.mat", "--names", "rec.a,rec.text,rec.none"],
            "`rec.text` is of class char, not a numeric array",
        ),
        (
            &["new.mat", "--names", "rec.a,rec.text,rec.none"],
            "there is no array `rec.none`",
        ),
        (&["log.csv", "--drawing", "t.pdf"], ".svg or .png"),
    ];
    for (arguments, words) in cases {
        let (code, _, err) = armill(at, &[&["drives"], arguments].concat());
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(err.contains(words), "{words}: {err}");
    }
    assert!(!at.join("t.pdf").exists() && !at.join("found.toml").exists());
}
