//! `armill motion` as a user runs it: logs of an arm with two joints, calculated here by plain sums over small steps, and invalid input.

use std::fmt::Write;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// Lengths of the links, mm.
const LINKS: [f64; 2] = [500.0, 400.0];
/// Step of the sums, s, and of the log, in steps.
const STEP: f64 = 1e-4;
const LOGGED: usize = 40;

fn armill(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(assert_cmd::cargo::cargo_bin!("armill"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (
        output.status.code().unwrap(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// Joint positions at a point of the plane, rad.
fn joints([x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b] = LINKS;
    let second = ((x * x + y * y - a * a - b * b) / (2.0 * a * b)).acos();
    [
        y.atan2(x) - (b * second.sin()).atan2(a + b * second.cos()),
        second,
    ]
}

/// The way after a time, from rest to rest, with a trapezoid of the speed.
fn trapezoid(time: f64, length: f64, speed: f64, acceleration: f64) -> f64 {
    let ramp = speed / acceleration;
    let end = length / speed + ramp;
    match time {
        time if time < ramp => 0.5 * acceleration * time * time,
        time if time < end - ramp => speed * (time - 0.5 * ramp),
        time if time < end => length - 0.5 * acceleration * (end - time).powi(2),
        _ => length,
    }
}

/// A log of two lines with a stop between, mm and s: averaged over a window, and joints with a lag.
fn log(speed: f64, acceleration: f64, window: f64, lag: f64) -> String {
    let corners: [[f64; 2]; 3] = [[700.0, -200.0], [700.0, 200.0], [450.0, 300.0]];
    let mut command = vec![corners[0]; 4000];
    for pair in corners.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length: f64 = (to[0] - from[0]).hypot(to[1] - from[1]);
        let time = length / speed + speed / acceleration + window;
        let steps = (time / STEP) as usize + 1;
        let way: Vec<f64> = (0..steps)
            .map(|k| trapezoid(k as f64 * STEP, length, speed, acceleration))
            .collect();
        let over = ((window / STEP).round() as usize).max(1);
        for k in 0..steps {
            // The mean of the last ones, at rest before.
            let mean = way[k.saturating_sub(over - 1)..=k].iter().sum::<f64>() / over as f64;
            let part = mean / length;
            command.push([
                from[0] + part * (to[0] - from[0]),
                from[1] + part * (to[1] - from[1]),
            ]);
        }
    }
    command.extend([corners[2]; 4000]);
    let mut text = "time_ms;J1_deg;J2_deg;load\n".to_owned();
    let mut here = joints(command[0]);
    for (k, at) in command.iter().enumerate() {
        let there = joints(*at);
        for (own, there) in here.iter_mut().zip(there) {
            *own += (there - *own) * (STEP / lag);
        }
        if k % LOGGED == 0 {
            let _ = writeln!(
                text,
                "{:.1};{:.5};{:.5};0",
                k as f64 * STEP * 1e3,
                here[0].to_degrees(),
                here[1].to_degrees()
            );
        }
    }
    text
}

const ARM: &str = "format = 1\nname = \"Arm\"\n\n[chain]\nsource = \"own\"\nmotions = [\n  { about = \"z\", joint = \"J1\" },\n  { along = \"x\", length_mm = 500 },\n  \
    { about = \"z\", joint = \"J2\" },\n  { along = \"x\", length_mm = 400 },\n]\n\n[[joint]]\nname = \"J1\"\nsign = 1\nsource = \"own\"\n\n[[joint]]\nname = \"J2\"\nsign = 1\nsource = \"own\"\n\n\
    [sources.own]\nwhat = \"lengths\"\nwhere = \"here\"\nlicence = \"fact\"\n";

pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("arm.toml", ARM);
    write("stops.csv", &log(200.0, 2000.0, 0.04, 0.02));
    write("slow.csv", &log(100.0, 2000.0, 0.04, 0.02));
    folder
}

fn near(value: &Value, expected: f64, within: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value} for {expected}"));
    assert!(
        (found - expected).abs() < within,
        "{value} for {expected} within {within}"
    );
}

#[test]
fn the_motion_of_a_log_is_learnt_and_predicts_another_feed() {
    let folder = folder();
    let requested = [
        "motion",
        "stops.csv",
        "--robot",
        "arm.toml",
        "--tool-mm",
        "0,0,0",
        "--compare",
        "slow.csv",
        "--zone-mm",
        "0",
        "--out",
        "learnt.toml",
    ];
    let (code, out, err) = armill(folder.path(), &[&requested[..], &["--json"]].concat());
    assert_eq!(code, 0, "{err}");
    let given: Value = serde_json::from_str(&out).unwrap();
    near(&given["path_acceleration_mm_per_s2"]["value"], 2000.0, 40.0);
    near(&given["smoothing_ms"]["value"], 40.0, 2.0);
    near(&given["lag_ms"]["value"], 20.0, 1.0);
    let shapes: Vec<&str> = given["moves"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["shape"].as_str().unwrap())
        .collect();
    assert_eq!(shapes, ["line", "line"]);
    near(&given["moves"][0]["length_mm"], 400.0, 0.5);
    let slow = &given["compared"][1]["stretches"][0];
    near(&slow["feed_mm_per_s"], 100.0, 0.2);
    near(&slow["cycle_time_error_percent"], 0.0, 0.3);
    near(&slow["feed_rms_percent"], 0.0, 1.0);
    near(&slow["corners"][0]["distance_error_mm"], 0.0, 0.05);
    assert_eq!(given["unused"][0], "load (stops.csv)");
    // The robot file has them, and reads.
    let written = std::fs::read_to_string(folder.path().join("learnt.toml")).unwrap();
    for key in [
        "[motion]",
        "path_acceleration_mm_per_s2 = ",
        "smoothing_ms = ",
        "lag_ms = [",
        "lag_u_ms = [",
        "joint_acceleration_reached_deg_per_s2 = [",
        "source = \"motion_log\"",
    ] {
        assert!(written.contains(key), "{key}: {written}");
    }
    assert!(
        !written.contains("joint_acceleration_deg_per_s2"),
        "reached is no limit: {written}"
    );
    let (_, text, err) = armill(folder.path(), &[&requested[..], &["--force"]].concat());
    assert!(
        text.contains("slow.csv") && text.contains("time at 100.0 mm/s"),
        "{text}{err}"
    );
    assert!(text.contains("lower bounds, no limits"), "{text}");
    let (code, _, err) = armill(
        folder.path(),
        &[
            "motion",
            "stops.csv",
            "--robot",
            "learnt.toml",
            "--tool-mm",
            "0,0,0",
        ],
    );
    assert_eq!(code, 0, "{err}");
}

#[test]
fn a_tip_that_is_not_given_is_fitted() {
    let folder = folder();
    // The tip is 400 mm behind the flange of a longer arm.
    let longer = ARM.replace("length_mm = 400", "length_mm = 800");
    std::fs::write(folder.path().join("longer.toml"), longer).unwrap();
    let (code, out, err) = armill(
        folder.path(),
        &["motion", "stops.csv", "--robot", "longer.toml", "--json"],
    );
    assert_eq!(code, 0, "{err}");
    let given: Value = serde_json::from_str(&out).unwrap();
    near(&given["tool"]["tip_mm"][0], -400.0, 1.0);
    near(&given["tool"]["tip_mm"][1], 0.0, 1.0);
    near(&given["smoothing_ms"]["value"], 40.0, 2.0);
}

#[test]
fn invalid_input_is_reported_and_nothing_is_written() {
    let folder = folder();
    let at = folder.path();
    let write = |name: &str, text: &str| std::fs::write(at.join(name), text).unwrap();
    write("bad.csv", "time_s,J1_deg,J2_deg\n0,1,x\n0.1,1\n");
    write("six.csv", "time_s,J1_deg,J2_deg,J3_deg\n0,1,2,3\n0.1,1,2,3\n");
    write("unit.csv", "time_s,J1,J2\n0,1,2\n0.1,1,2\n");
    let rest = (0..100).fold("time_s,J1_deg,J2_deg\n".to_owned(), |mut text, k| {
        let _ = writeln!(text, "{},10,20", f64::from(k) * 0.004);
        text
    });
    write("rest.csv", &rest);
    for (log, more, parts) in [
        (
            "bad.csv",
            &[][..],
            &["bad.csv:2:5: `x` is not a finite number", "bad.csv:3:1"][..],
        ),
        ("six.csv", &[], &["joints 1, 2, 3, but the robot has 2 joints"]),
        ("unit.csv", &[], &["2 may be degrees or rad", "--angle-unit"]),
        ("none.csv", &[], &["cannot read none.csv"]),
        (
            "rest.csv",
            &[],
            &["the tip of the tool cannot be fitted", "--tool-mm"],
        ),
        (
            "rest.csv",
            &["--tool-mm", "0,0,0"],
            &["no straight moves from a rest to a rest"],
        ),
        ("stops.csv", &["--tool-mm", "0,0"], &["--tool-mm: 2 numbers"]),
        (
            "stops.csv",
            &[
                "--tool-mm",
                "0,0,0",
                "--compare",
                "slow.csv",
                "--zone-mm",
                "1,2,3",
            ],
            &["--zone-mm: 3 radii for 1 compared logs"],
        ),
        (
            "stops.csv",
            &["--tool-mm", "0,0,0", "--compare", "slow.csv", "--zone-mm=-1"],
            &["--zone-mm: -1 is outside 0 to 1000"],
        ),
        ("stops.csv", &["--zone-mm", "1"], &["--compare"]),
    ] {
        let arguments = [&["motion", log, "--robot", "arm.toml", "--out", "new.toml"], more].concat();
        let (code, _, err) = armill(at, &arguments);
        assert_eq!(code, 2, "{log}: {err}");
        for part in parts {
            assert!(err.contains(part), "{part}: {err}");
        }
        assert!(!at.join("new.toml").exists(), "{log} {more:?}");
    }
}
