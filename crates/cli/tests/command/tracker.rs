//! `armill tracker` as a user runs it: a Leica table with joints in another file, three reflectors, and what can be wrong.

use std::path::Path;

use serde_json::Value;

use crate::calibrate::ROBOT;
use crate::cell::armill;

fn cell(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lever.toml"), ROBOT).unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let all = [
        &["tracker"],
        arguments,
        &["--robot", "lever.toml", "--out", "none.csv"],
    ]
    .concat();
    let (code, out, err) = armill(folder, &all);
    assert!(code == 2 && out.is_empty(), "{out}{err}");
    for word in words {
        assert!(err.contains(word), "{word}: {err}");
    }
    assert!(!folder.join("none.csv").exists());
}

const LEICA: &str = "X  [mm],Y  [mm],Z  [mm],Q0 ,Q1 ,Q2 ,Q3 ,Time Stamp,OTG\n500,0,0,1,0,0,0,'11.10.2022 15:06:48.043,\n0,500,0,0.70710678,0,0,0.70710678,'11.10.2022 15:06:55.562,\n";

#[test]
fn a_leica_table_and_joints_become_a_table_of_poses() {
    let folder = cell(&[("leica.csv", LEICA), ("joints.txt", "A B\n0 0\n90 0\n")]);
    let at = folder.path();
    let command = [
        "tracker",
        "leica.csv",
        "--joints",
        "joints.txt",
        "--robot",
        "lever.toml",
        "--out",
        "poses.csv",
        "--json",
    ];
    let (code, out, err) = armill(at, &command);
    assert_eq!(code, 0, "{err}");
    let answer: Value = serde_json::from_str(&out).unwrap();
    assert!(answer["poses"] == 2 && answer["has_orientations"] == true && answer["base"].is_null());
    let poses = std::fs::read_to_string(at.join("poses.csv")).unwrap();
    let rows: Vec<&str> = poses.lines().collect();
    assert_eq!(rows[0], "q1_deg,q2_deg,x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg");
    assert!(
        rows[2].starts_with("90.00000000,0.00000000,0.000000,500.000000,0.000000,"),
        "{poses}"
    );
    let turn: f64 = rows[2].rsplit(',').next().unwrap().parse().unwrap();
    assert!((turn - 90.0).abs() < 1e-5);
    // What is written is not written over if it was changed since.
    std::fs::write(at.join("poses.csv"), "mine").unwrap();
    let (code, _, err) = armill(at, &command);
    assert!(code == 2 && err.contains("--force"), "{err}");
}

#[test]
fn misread_reflectors_are_reported_and_files_that_do_not_belong_together_refused() {
    let row = |x: f64, y: f64| format!("{x} {y} 10\n");
    let rows = |x: f64, y: f64| (0..12).map(|k| row(x + f64::from(k), y)).collect::<String>();
    let still = |x: f64, y: f64| (0..12).map(|_| row(x, y)).collect::<String>();
    let misread = still(0.0, 800.0).replacen(&row(0.0, 800.0), &row(0.0, 1800.0), 1);
    let joints: String = (0..12).map(|k| format!("{} {k}\n", 3 * k)).collect();
    let files: [(&str, &str); 8] = [
        ("a.txt", &rows(0.0, 0.0)),
        ("b.txt", &rows(100.0, 0.0)),
        ("c.txt", &rows(0.0, 90.0)),
        ("d.txt", &still(0.0, 0.0)),
        ("e.txt", &still(900.0, 0.0)),
        ("f.txt", &misread),
        ("joints.txt", &joints),
        ("few.txt", "1 2\n"),
    ];
    let folder = cell(&files);
    let at = folder.path();
    let base = ["a.txt", "b.txt", "c.txt", "--base", "d.txt,e.txt,f.txt"];
    let whole = [
        &["tracker"],
        &base[..],
        &["--joints", "joints.txt", "--robot", "lever.toml"],
    ]
    .concat();
    let (code, out, err) = armill(at, &whole);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("row 1: reflector 3 is read 1000 mm from its place"),
        "{out}"
    );
    assert!(out.contains("base: reflector 3 is misread in rows 1:"), "{out}");

    refused(at, &base, &["a.txt has no joint positions", "--joints FILE"]);
    refused(
        at,
        &[&base[..], &["--joints", "few.txt"]].concat(),
        &["a.txt has 12 rows, few.txt has 1", "row by row"],
    );
    refused(
        at,
        &["a.txt", "b.txt", "--joints", "joints.txt"],
        &["2 files", "three files of one reflector each"],
    );
    refused(
        at,
        &["a.txt", "b.txt", "gone.txt", "--joints", "joints.txt"],
        &["gone.txt"],
    );
    refused(
        at,
        &[
            "a.txt",
            "b.txt",
            "c.txt",
            "--base",
            "d.txt",
            "--joints",
            "joints.txt",
        ],
        &["--base: 1 files", "three files"],
    );
    refused(
        at,
        &["a.txt", "b.txt", "a.txt", "--joints", "joints.txt"],
        &["on one line"],
    );
    refused(
        at,
        &["a.txt", "b.txt", "few.txt", "--joints", "joints.txt"],
        &["few.txt", "first 3 cells"],
    );
    std::fs::write(at.join("leica.csv"), LEICA.replace("500,0,0,1,", "500,0,0,2,")).unwrap();
    refused(
        at,
        &["leica.csv", "--joints", "joints.txt"],
        &["leica.csv:2", "length 2.0000"],
    );
}

#[test]
fn three_reflectors_and_joints_in_one_file_without_titles_are_the_poses_of_three_files() {
    let point = |angle: f64, (x, y): (f64, f64)| {
        let (sin, cos) = angle.to_radians().sin_cos();
        format!("{:.5} {:.5} 10", x * cos - y * sin, x * sin + y * cos)
    };
    let corners = [(500.0, 0.0), (600.0, 0.0), (500.0, 80.0)];
    let mut files = [const { String::new() }; 5];
    for k in 0..12 {
        let angle = 7.0 * f64::from(k);
        let points = corners.map(|corner| point(angle, corner));
        for (file, point) in files.iter_mut().zip(&points) {
            *file += &format!("{point}\n");
        }
        files[3] += &format!("{angle} 0\n");
        files[4] += &format!("{} 0 0 {angle} 0\n", points.join(" "));
    }
    let named: Vec<(&str, &str)> = ["a.txt", "b.txt", "c.txt", "joints.txt", "all.txt"]
        .into_iter()
        .zip(files.iter().map(String::as_str))
        .collect();
    let folder = cell(&named);
    let of = |arguments: &[&str], out: &str| {
        let all = [&["tracker"], arguments, &["--robot", "lever.toml", "--out", out]].concat();
        let (code, _, err) = armill(folder.path(), &all);
        assert_eq!(code, 0, "{err}");
        std::fs::read_to_string(folder.path().join(out)).unwrap()
    };
    let three = of(
        &["a.txt", "b.txt", "c.txt", "--joints", "joints.txt"],
        "three.csv",
    );
    assert_eq!(of(&["all.txt"], "one.csv"), three);
    assert_eq!(three.lines().count(), 13);
    std::fs::write(
        folder.path().join("short.txt"),
        "1 2 3 4 5 6 7 8 9 0 0\n1 2 3 4 5\n",
    )
    .unwrap();
    refused(
        folder.path(),
        &["short.txt"],
        &["short.txt:2", "5 cells instead of at least 9"],
    );
}
