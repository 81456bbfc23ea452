//! `armill forces` as a user runs it: numbers, tables, pictures; and everything that can be wrong.

use std::fmt::Write;

use serde_json::Value;

use crate::cell::armill;

/// 3 s at 1 kHz: (30, -40, 0) N from 1 s to 2 s with a hum of 2 N, 5 N of drift along x.
fn record(separator: char, names: &str) -> String {
    let mut text = names.to_owned();
    for k in 0..3000 {
        let cut = f64::from((1000..2000).contains(&k));
        let hum = if k % 20 < 10 { 2.0 } else { -2.0 };
        let (x, y) = (5.0 + cut * (30.0 + hum), -40.0 * cut);
        let _ = writeln!(
            text,
            "{:.3}{separator}{x:.3}{separator}{y:.3}{separator}{:.3}",
            f64::from(k) * 1e-3,
            0.0
        );
    }
    text
}

const CSV: &str = "time_s,fx_n,fy_n,fz_n\n";
const EXPORT: &str = "Dyno file:\tone\nTime\tFx\tFy\tFz\ns\tN\tN\tN\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("r.csv"), record(',', CSV)).unwrap();
    std::fs::write(folder.path().join("r.txt"), record('\t', EXPORT)).unwrap();
    folder
}

#[test]
fn a_record_is_reported_before_and_after_processing_in_any_format() {
    let folder = folder();
    for (file, format) in [("r.csv", "CSV"), ("r.txt", "DynoWare")] {
        let (code, out, err) = armill(
            folder.path(),
            &[
                "forces",
                file,
                "--air-s",
                "0,0.9",
                "--air-s",
                "2.1,3",
                "--spindle-rpm",
                "3000",
                "--json",
            ],
        );
        assert_eq!(code, 0, "{err}");
        let given: Value = serde_json::from_str(&out).unwrap();
        assert_eq!(
            (&given["format"], &given["samples"]),
            (&format.into(), &3000.into())
        );
        let number = |value: &Value, expected: f64, slack: f64| {
            let found = value.as_f64().unwrap();
            assert!((found - expected).abs() <= slack, "{value} for {expected}");
        };
        number(&given["rate_hz"], 1000.0, 1e-6);
        number(&given["drift"]["offset_n"][0], 5.0, 1e-9);
        number(&given["before"]["fx_n"]["greatest"], 37.0, 0.0);
        number(&given["after"]["fx_n"]["greatest"], 32.0, 1e-9);
        number(&given["after"]["fy_n"]["mean"], -40.0 / 3.0, 1e-9);
        number(&given["after"]["size_n"]["greatest"], 32_f64.hypot(40.0), 1e-9);
        // A hum of whole turns has no mean but for the trapezia at its edges, a tenth of it.
        number(&given["revolutions"]["largest_mean_n"], 50.0, 0.2);
        assert_eq!(given["drift"]["air_found"], false);
    }
}

#[test]
fn quiet_intervals_are_detected_and_reported() {
    let folder = folder();
    let (code, out, err) = armill(folder.path(), &["forces", "r.csv"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("detected as the quietest") && out.contains("(5.000, 0.000, 0.000) N"),
        "{out}"
    );
    let (_, out, _) = armill(folder.path(), &["forces", "r.csv", "--no-drift"]);
    assert!(out.contains("not removed") && out.contains("37.00"), "{out}");
}

#[test]
fn writes_tables_and_pictures_that_can_be_read_again() {
    let folder = folder();
    let (code, _, err) = armill(
        folder.path(),
        &[
            "forces",
            "r.txt",
            "--low-pass-hz",
            "20",
            "--spindle-rpm",
            "3000",
            "--out",
            "o",
        ],
    );
    assert_eq!(code, 0, "{err}");
    for file in ["forces.csv", "revolutions.csv", "forces.svg", "forces.png"] {
        assert!(folder.path().join("o").join(file).is_file(), "{file}");
    }
    let turns = std::fs::read_to_string(folder.path().join("o/revolutions.csv")).unwrap();
    assert_eq!(turns.lines().count(), 149 + 1);
    let (code, out, err) = armill(folder.path(), &["forces", "o/forces.csv", "--no-drift", "--json"]);
    assert_eq!(code, 0, "{err}");
    let given: Value = serde_json::from_str(&out).unwrap();
    assert!(given["unused"].to_string().contains("fx_before_n"));
    assert!(given["after"]["fx_n"]["greatest"].as_f64().unwrap() < 33.0);
}

#[test]
fn errors_are_reported_with_position_and_hint() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "trap.txt",
        "Time,Fx,Fy,Fz\ns,N,N,N\n0,0,1,5,2,25,3,5\n0,1,1,2,25,3,5\n",
    );
    write("volts.txt", &record('\t', EXPORT).replace("\tN\t", "\tV\t"));
    write("no-unit.csv", &record(',', CSV).replace("fy_n", "fy"));
    write("two.txt", &record('\t', EXPORT).repeat(2));
    for (arguments, words) in [
        (&["none.csv"][..], &["cannot read none.csv", "help:"][..]),
        (&["trap.txt"], &["trap.txt:4:1", "they cannot be distinguished"]),
        (&["volts.txt"], &["volts.txt:3", "`V` is not a unit"]),
        (&["no-unit.csv"], &["no-unit.csv:1", "missing columns: `Fy`"]),
        (
            &["two.txt", "--no-drift"],
            &["--cycle", "has 2 cycles", "from 1 to 2"],
        ),
        (&["r.txt", "--cycle", "0"], &["but no cycle 0"]),
        (&["r.csv", "--air-s", "0"], &["--air-s", "`0` is not an interval"]),
        (&["r.csv", "--air-s", "0,1,2"], &["is not an interval"]),
        (
            &["r.csv", "--air-s", "8,9"],
            &["--air-s", "0 samples", "to 2.999 s"],
        ),
        (&["r.csv", "--air-s", "1,0"], &["no length"]),
        (&["r.csv", "--low-pass-hz", "500"], &["--low-pass-hz", "500 Hz"]),
        (&["r.csv", "--low-pass-hz", "nan"], &["--low-pass-hz", "NaN Hz"]),
        (&["r.csv", "--spindle-rpm", "0"], &["--spindle-rpm"]),
        (&["r.txt", "--channels", "Fx,Fy"], &["2 names of channels"]),
        (&["r.csv", "--rate-hz", "10"], &["leave out the rate"]),
        (&["r.csv", "--out", "r.txt"], &["r.txt"]),
    ] {
        let (code, out, err) = armill(folder.path(), &[&["forces"], arguments].concat());
        assert_eq!(code, 2, "{arguments:?}: {out}{err}");
        for word in words {
            assert!(err.contains(word), "{arguments:?}: no `{word}` in\n{err}");
        }
    }
    let (code, out, _) = armill(folder.path(), &["forces", "trap.txt", "--json"]);
    let given: Value = serde_json::from_str(&out).unwrap();
    assert!(code == 2 && given["problems"][0]["line"] == 4, "{out}");
    let (code, out, _) = armill(folder.path(), &["forces", "two.txt", "--cycle", "2"]);
    assert!(code == 0 && out.contains("cycle 2 of 2"), "{out}");
}
