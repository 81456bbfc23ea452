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
