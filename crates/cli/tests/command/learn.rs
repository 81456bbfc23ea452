//! `armill learn` as a user runs it: a lever with an error of its gear, what it may write, and what can be wrong.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::calibrate::ROBOT;
use crate::cell::armill;

/// Poses of the lever, whose second gear has an error of 0.4 mrad once a turn, times `gear`; scatter of some 10 um. The tracker is turned by `turn_deg`.
fn poses(count: u32, gear: f64, turn_deg: f64) -> String {
    let mut text = "A_deg,B_deg,x_mm,y_mm,z_mm\n".to_owned();
    for k in 0..count {
        let (a, b) = (f64::from(k * 37 % 180) - 90.0, f64::from(k * 53 % 240) - 120.0);
        let second = b.to_radians();
        let both = a.to_radians() + second + 4e-4 * gear * (second + 0.6).sin();
        let scatter = |factor: u32, size: u32| f64::from(k * factor % size) / 400.0 - f64::from(size) / 800.0;
        let x = 300.5 * a.to_radians().cos() + 200.0 * both.cos() + scatter(11, 7);
        let y = 300.5 * a.to_radians().sin() + 200.0 * both.sin() + scatter(5, 9);
        let (sin, cos) = turn_deg.to_radians().sin_cos();
        let _ = writeln!(
            text,
            "{a},{b},{:.4},{:.4},{:.4}",
            cos * x - sin * y,
            sin * x + cos * y,
            20.0 + scatter(7, 5)
        );
    }
    text
}

pub fn cell(gear: f64) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lever.toml"), ROBOT).unwrap();
    std::fs::write(folder.path().join("poses.csv"), poses(150, gear, 0.0)).unwrap();
    folder
}

fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let (code, _, err) = armill(folder, arguments);
    assert_eq!(code, 2, "{err}");
    for word in words {
        assert!(err.contains(word), "{word}: {err}");
    }
}

#[test]
fn a_gear_error_is_learnt_written_and_part_of_the_deviation() {
    let folder = cell(1.0);
    let at = folder.path();
    std::fs::write(at.join("other.csv"), poses(40, 1.0, 70.0)).unwrap();
    let command = [
        "learn",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--other",
        "other.csv",
    ];
    let (code, out, err) = armill(
        at,
        &[
            &command[..],
            &["--out", "mine.toml", "--drawing", "errors.svg", "--json"],
        ]
        .concat(),
    );
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answer["is_significant"], true);
    for set in ["/held_out", "/other/errors"] {
        let errors = answer.pointer(set).unwrap();
        let rms = |model: &str| errors[model]["rms_mm"].as_f64().unwrap();
        assert!(rms("learnt") < 0.5 * rms("calibrated"), "{errors}");
        assert!(rms("calibrated") < 0.5 * rms("nominal"), "{errors}");
        let coverage = errors["coverage_percent"].as_f64().unwrap();
        assert!((88.0..=100.0).contains(&coverage), "{errors}");
    }
    assert!(
        err.contains("mine.toml") && err.contains("mine-residuals.csv"),
        "{err}"
    );
    assert!(
        std::fs::read_to_string(at.join("errors.svg"))
            .unwrap()
            .contains("held out, learnt")
    );

    // The deviation of the lever with the nominal controller: chain and residual together are the gear error and the long link.
    let (code, out, err) = armill(at, &["robots", "mine.toml", "--json"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("residual learnt by armill from 150 measured poses"),
        "{out}"
    );

    // The residuals are part of the robot.
    let residuals = std::fs::read_to_string(at.join("mine-residuals.csv")).unwrap();
    std::fs::write(at.join("mine-residuals.csv"), residuals + "1,2,0,0,0\n").unwrap();
    refused(
        at,
        &["robots", "mine.toml"],
        &["mine.toml:", "checksum", "mine-residuals.csv"],
    );
    // Neither file is replaced by mistake.
    refused(at, &[&command[..], &["--out", "mine.toml"]].concat(), &["mine"]);
}

#[test]
fn without_anything_to_learn_nothing_is_written() {
    let folder = cell(0.0);
    let at = folder.path();
    let command = ["learn", "poses.csv", "--robot", "lever.toml"];
    let (code, out, err) = armill(at, &command);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("does not reduce the error of poses held out"),
        "{out}"
    );
    refused(
        at,
        &[&command[..], &["--out", "mine.toml"]].concat(),
        &["--out", "beyond its uncertainty", "armill calibrate"],
    );
    assert!(!at.join("mine.toml").exists() && !at.join("mine-residuals.csv").exists());
}

#[test]
fn wrong_options_and_poses_are_refused() {
    let folder = cell(1.0);
    let at = folder.path();
    let command = ["learn", "poses.csv", "--robot", "lever.toml"];
    let with = |more: &[&'static str]| [&command[..], more].concat();
    refused(
        at,
        &with(&["--stretches", "1"]),
        &["--stretches", "150 poses", "two poses a stretch"],
    );
    refused(
        at,
        &with(&["--stretches", "100"]),
        &["--stretches", "100 stretches"],
    );
    refused(at, &with(&["--prior-mm", "0"]), &["--prior-mm"]);
    refused(at, &with(&["--other", "none.csv"]), &["none.csv"]);
    std::fs::write(at.join("few.csv"), poses(7, 1.0, 0.0)).unwrap();
    refused(
        at,
        &["learn", "few.csv", "--robot", "lever.toml", "--stretches", "2"],
        &["few.csv"],
    );
}
