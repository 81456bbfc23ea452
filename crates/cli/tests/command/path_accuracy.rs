//! `armill path-accuracy` as a user runs it: runs with an offset from a line and an arc, and invalid input.

use std::fmt::Write;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

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

/// A line of 500 mm, and three runs with an offset of 10, 20 and 60 um, each sampled differently.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let line = (0..=50).fold("x_mm,y_mm,z_mm\n".to_owned(), |mut text, k| {
        let _ = writeln!(text, "{},100,50", 10 * k);
        text
    });
    write("line.csv", &line);
    let run = |step: f64, um: f64| -> Vec<[f64; 2]> {
        let count = (520.0 / step) as usize;
        (0..=count)
            .map(|k| [-10.0 + k as f64 * step, 100.0 + um * 1e-3])
            .collect()
    };
    let mut both = "time;run;x_mm;y_mm;z_mm\r\n".to_owned();
    for (name, run) in [("a", run(1.3, 10.0)), ("b", run(7.0, 20.0))] {
        for [x, y] in run {
            both.push_str(&format!("0;{name};{x:.6};{y:.6};50\r\n").replace('.', ","));
        }
    }
    write("both.csv", &both);
    let third = run(2.9, 60.0)
        .iter()
        .fold("x_m,y_m,z_m\n".to_owned(), |mut text, [x, y]| {
            let _ = writeln!(text, "{:.9},{:.9},0.05", x * 1e-3, y * 1e-3);
            text
        });
    write("third.csv", &third);
    folder
}

fn number(value: &Value, expected: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value} for {expected}"));
    assert!((found - expected).abs() < 2e-6, "{value} for {expected}");
}

#[test]
fn runs_of_several_files_have_accuracy_and_repeatability() {
    let folder = folder();
    let requested = [
        "path-accuracy",
        "both.csv",
        "third.csv",
        "--commanded",
        "line.csv",
        "--points",
        "points.csv",
        "--drawing",
        "path.svg",
    ];
    let (code, out, err) = armill(folder.path(), &[&requested[..], &["--json"]].concat());
    assert_eq!(code, 0, "{err}");
    let given: Value = serde_json::from_str(&out).unwrap();
    // Offsets 10, 20, 60: mean 30; distances 20, 10, 30: mean 20, S = 10, 20 + 30.
    number(&given["at_mm"], 0.03);
    number(&given["at_mean_mm"], 0.03);
    number(&given["rt_mm"], 0.05);
    assert_eq!(
        (&given["cycles"], &given["points"], &given["not_passed"]),
        (&3.into(), &51.into(), &0.into())
    );
    number(&given["at_worst"]["offset_mm"][1], 0.03);
    assert_eq!(given["unused"][0], "time (both.csv)");
    let notes = given["notes"].to_string();
    assert!(
        notes.contains("requires 10 cycles of a path; this file has 3"),
        "{notes}"
    );
    let table = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows.len(), 52);
    assert!(
        rows[0].contains("offset_y_mm") && rows[1] == "2,0,100,50,0,0.03,0,0.03,0.05",
        "{}",
        rows[1]
    );
    assert!(
        std::fs::read_to_string(folder.path().join("path.svg"))
            .unwrap()
            .contains("Path accuracy")
    );
    let (_, text, _) = armill(folder.path(), &requested);
    assert!(
        text.contains("AT   0.0300 mm") && text.contains("RT   0.0500 mm"),
        "{text}"
    );
    let (_, one, _) = armill(
        folder.path(),
        &["path-accuracy", "third.csv", "--commanded", "line.csv"],
    );
    assert!(
        one.contains("AT   0.0600 mm") && !one.contains("RT ") && one.contains("repeatability is not known"),
        "{one}"
    );
}

#[test]
fn invalid_input_is_reported() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("bad.csv"), "x_mm,y_mm,z_mm\n1,a,3\n1,2\n").unwrap();
    std::fs::write(at.join("away.csv"), "x_mm,y_mm,z_mm\n9000,0,0\n9001,0,0\n").unwrap();
    std::fs::write(at.join("one.csv"), "x_mm,y_mm,z_mm\n1,2,3\n").unwrap();
    for (files, commanded, parts) in [
        ("bad.csv", "line.csv", &["bad.csv:2:3", "bad.csv:3:1"][..]),
        (
            "third.csv",
            "both.csv",
            &["both.csv: 2 runs; a commanded path has one"],
        ),
        (
            "away.csv",
            "line.csv",
            &["no point of the commanded path is passed by all runs"],
        ),
        ("one.csv", "line.csv", &["run number 1 has 1 points"]),
        ("third.csv", "one.csv", &["at least 2 are needed"]),
        ("none.csv", "line.csv", &["cannot read none.csv"]),
    ] {
        let (code, out, err) = armill(
            at,
            &[
                "path-accuracy",
                files,
                "--commanded",
                commanded,
                "--points",
                "p.csv",
            ],
        );
        assert!(code == 2 && out.is_empty(), "{files}: {code} {out}");
        for part in parts {
            assert!(err.contains(part), "{files}: {part}: {err}");
        }
    }
    assert!(!at.join("p.csv").exists());
}

#[test]
fn a_record_of_a_tracker_has_three_passes_in_each_direction() {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return;
    };
    let record = Path::new(&samples).join("datasets/ur-path-tracker/Trajektoriezw1u2_vel50.txt");
    let (code, out, err) = armill(
        Path::new("."),
        &["path-accuracy", record.to_str().unwrap(), "--json"],
    );
    assert_eq!(code, 0, "{err}");
    let found: Value = serde_json::from_str(&out).unwrap();
    for direction in found["directions"].as_array().unwrap() {
        assert_eq!(direction["cycles"], 3, "{found}");
        // Summed from the points by an independent script: 348.6 mm.
        assert!(
            (direction["length_mm"].as_f64().unwrap() - 348.6).abs() < 0.3,
            "{found}"
        );
        let mean = direction["rt_mean_mm"].as_f64().unwrap();
        assert!(mean > 0.005 && mean < 0.03, "{found}");
    }
    // The same script: passes back are 0.035 mm from the first one forth on average.
    assert!(
        (found["apart"]["mean_mm"].as_f64().unwrap() - 0.035).abs() < 0.005,
        "{found}"
    );
}

/// Forth and back along 300 mm twice, the way back 0.04 mm aside, as SpatialAnalyzer exports it.
fn export(apart_mm: f64) -> String {
    let mut text = "// SpatialAnalyzer SA 2024.2 ( x64 )\n// AXES = CARTESIAN: X,  Y,  Z (mm)\n".to_owned();
    let mut count = 0;
    let mut take = |x: f64, y: f64| {
        let _ = writeln!(
            text,
            "Path,  P1,  {count},  {x:.6},  {y:.6},  50.000000,  02/12/25 16:52:45"
        );
        count += 1;
    };
    for turn in 0..4 {
        let forth = turn % 2 == 0;
        (0..200).for_each(|_| take(if forth { 0.0 } else { 300.0 }, 0.0));
        for k in 1..1500 {
            let way = f64::from(k) * 0.2;
            let y = if forth {
                0.01 * f64::from(turn / 2)
            } else {
                apart_mm
            };
            take(if forth { way } else { 300.0 - way }, y);
        }
    }
    (0..200).for_each(|_| take(0.0, 0.0));
    text
}

#[test]
fn passes_without_a_commanded_path_are_compared_with_each_other_and_with_the_other_direction() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("tracker.txt"), export(0.04)).unwrap();
    let (code, out, err) = armill(
        at,
        &["path-accuracy", "tracker.txt", "--json", "--drawing", "rt.svg"],
    );
    assert_eq!(code, 0, "{err}");
    let found: Value = serde_json::from_str(&out).unwrap();
    let [forth, back] = found["directions"].as_array().unwrap().as_slice() else {
        panic!("{found}")
    };
    assert_eq!(
        (&forth["direction"], &forth["cycles"]),
        (&"forth".into(), &2.into())
    );
    assert_eq!((&back["direction"], &back["cycles"]), (&"back".into(), &2.into()));
    // Two passes 0.01 mm apart: 0.005 mm from their mean, without scatter; those back are alike.
    number(&forth["rt_mm"], 0.005);
    number(&back["rt_mm"], 0.0);
    // The mean path forth is at 0.005 mm.
    number(&found["apart"]["largest_mm"], 0.035);
    assert!(
        std::fs::read_to_string(at.join("rt.svg"))
            .unwrap()
            .contains("mean paths forth and back")
    );
    let (_, text, _) = armill(at, &["path-accuracy", "tracker.txt"]);
    assert!(
        text.contains("forth  2 passes") && text.contains("accuracy (AT) is not known"),
        "{text}"
    );
    // Results at commanded points need some.
    let (code, _, err) = armill(at, &["path-accuracy", "tracker.txt", "--points", "p.csv"]);
    assert!(code == 2 && err.contains("--commanded"), "{err}");
    // An export is read as measured runs too.
    std::fs::write(
        at.join("line.csv"),
        "x_mm,y_mm,z_mm\n50,0,50\n100,0,50\n150,0,50\n",
    )
    .unwrap();
    let (code, _, err) = armill(at, &["path-accuracy", "tracker.txt", "--commanded", "line.csv"]);
    assert_eq!(code, 0, "{err}");
    std::fs::write(
        at.join("short.txt"),
        "// AXES = CARTESIAN: X, Y, Z (mm)\na, b, 0, 1, 2, 3\n",
    )
    .unwrap();
    let (code, _, err) = armill(at, &["path-accuracy", "short.txt"]);
    assert!(code == 2 && err.contains("no pass of 1 mm or more"), "{err}");
}
