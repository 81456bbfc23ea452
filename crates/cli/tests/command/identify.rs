//! `armill identify` as a user runs it: plan, fill in, identify, use; and everything that can be wrong.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::cell::{MH12_URDF, armill, numbers};

/// A plan for the drives of an MH12 of which no compliance is known, whose readings are those of a typical arm, 2e-6
/// rad/(N m) at every joint.
fn filled_in(folder: &Path) {
    std::fs::write(folder.join("mh12.urdf"), MH12_URDF).unwrap();
    let (code, _, stderr) = armill(
        folder,
        &[
            "identify",
            "--plan",
            "14",
            "--robot",
            "mh12.urdf",
            "--tool-mm",
            "0,60,150",
            "--unknowns",
            "drives",
            "--out",
            "plan.csv",
        ],
    );
    assert_eq!(code, 0, "{stderr}");
    let plan = std::fs::read_to_string(folder.join("plan.csv")).unwrap();
    let filled: Vec<String> = plan
        .lines()
        .enumerate()
        .map(|(line, text)| {
            let mut cells: Vec<String> = text.split(',').map(str::to_owned).collect();
            if line > 0 {
                for axis in 0..3 {
                    cells[10 + axis] = cells[13 + axis].clone();
                }
            }
            cells.join(",")
        })
        .collect();
    std::fs::write(folder.join("tests.csv"), filled.join("\n")).unwrap();
}

/// A folder with a completed plan.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    folder
}

#[test]
fn a_completed_plan_gives_the_springs_and_a_robot_for_predictions() {
    let folder = folder();
    let arguments = [
        "identify",
        "tests.csv",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--unknowns",
        "drives",
        "--out",
        "mine.toml",
        "--json",
    ];
    let (code, stdout, stderr) = armill(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    let answer: Value = serde_json::from_str(&stdout).unwrap();
    for spring in answer["springs"].as_array().unwrap() {
        let value = spring["compliance_rad_per_n_m"].as_f64().unwrap();
        let u = spring["compliance_u_rad_per_n_m"].as_f64().unwrap();
        // The table gives displacements to 1 um.
        assert!((value - 2e-6).abs() < 4.0 * u && u < 5e-7, "{spring}");
    }
    assert!(
        answer["left_out"]["max_um"].as_f64().unwrap() < 3.0,
        "{}",
        answer["left_out"]
    );
    let written = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(
        written.contains("14 load tests with 42 readings") && written.contains("tests.csv"),
        "{written}"
    );
    assert!(!written.contains("[sources.paper]"), "{written}");
    assert!(written.contains("[covariance]"), "{written}");
    let pose = [
        "pose",
        "mine.toml",
        "--joints-deg",
        "0,11.6,-27.8,0,39.4,0",
        "--wrench-n",
        "3,5,5",
    ];
    let (code, stdout, stderr) = armill(folder.path(), &pose);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("deviation"), "{stdout}");
}

#[test]
fn a_plan_expects_displacements_by_the_compliances_of_the_robot_file() {
    let folder = tempfile::tempdir().unwrap();
    let plan = [
        "identify",
        "--plan",
        "3",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
        "--json",
    ];
    let (code, stdout, stderr) = armill(folder.path(), &plan);
    assert_eq!(code, 0, "{stderr}");
    let answer: Value = serde_json::from_str(&stdout).unwrap();
    for test in answer["tests"].as_array().unwrap() {
        let list = |key: &str| {
            let all = numbers(&test[key]);
            all.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
        };
        let (joints, force) = (list("joints_deg"), list("force_n"));
        let pose = [
            "pose",
            "yaskawa/mh12",
            "--joints-deg",
            &joints,
            "--wrench-n",
            &force,
            "--tool-mm",
            "0,60,150",
            "--json",
        ];
        let (code, stdout, stderr) = armill(folder.path(), &pose);
        assert_eq!(code, 0, "{stderr}");
        let posture: Value = serde_json::from_str(&stdout).unwrap();
        let (expected, given) = (
            numbers(&test["expected_mm"]),
            numbers(&posture["postures"][0]["deviation_um"]),
        );
        for (mm, um) in expected.iter().zip(&given) {
            // Degrees are turned into radians and back, and written in full.
            assert!(
                (mm - um / 1e3).abs() < 1e-9 * (1.0 + mm.abs()),
                "{test} {given:?}"
            );
        }
    }
}

#[test]
fn the_table_on_the_screen_names_every_spring_and_the_error_to_expect() {
    let folder = folder();
    let arguments = [
        "identify",
        "tests.csv",
        "--robot",
        "yaskawa/mh12",
        "--tool-mm",
        "0,60,150",
    ];
    let (code, stdout, stderr) = armill(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    for part in [
        "S drive",
        "T drive",
        "L about z",
        "base about x",
        "left out",
        "outliers",
        "N m/rad",
        "not separable",
    ] {
        assert!(stdout.contains(part), "{part} in\n{stdout}");
    }
}

#[test]
fn readings_a_thousand_times_too_large_are_refused_with_the_unit_as_reason() {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    let table = std::fs::read_to_string(folder.path().join("tests.csv")).unwrap();
    for (unit, word) in [("_m,", "larger"), ("_um,", "smaller")] {
        let wrong = table.replace("dx_mm,dy_mm,dz_mm,e", &format!("dx{unit}dy{unit}dz{unit}e"));
        std::fs::write(folder.path().join("wrong.csv"), wrong).unwrap();
        let arguments = [
            "identify",
            "wrong.csv",
            "--robot",
            "yaskawa/mh12",
            "--tool-mm",
            "0,60,150",
        ];
        let (code, stdout, stderr) = armill(folder.path(), &arguments);
        assert_eq!((code, stdout.as_str()), (2, ""), "{stderr}");
        assert!(stderr.contains("1000 times") && stderr.contains(word), "{stderr}");
        let trusted = [&arguments[..], &["--trust-units"]].concat();
        assert_eq!(armill(folder.path(), &trusted).0, 0);
    }
}

#[test]
fn refuses_too_few_tests_and_tests_in_one_posture_with_a_hint() {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    let table = std::fs::read_to_string(folder.path().join("tests.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    std::fs::write(folder.path().join("few.csv"), lines[..3].join("\n")).unwrap();
    let (code, _, stderr) = armill(folder.path(), &["identify", "few.csv", "--robot", "yaskawa/mh12"]);
    assert_eq!(code, 2);
    assert!(
        stderr.contains("6 readings are not sufficient for ") && stderr.contains("--unknowns drives"),
        "{stderr}"
    );
    let same: Vec<&str> = std::iter::once(lines[0]).chain([lines[1]; 12]).collect();
    std::fs::write(folder.path().join("same.csv"), same.join("\n")).unwrap();
    let (code, _, stderr) = armill(
        folder.path(),
        &["identify", "same.csv", "--robot", "yaskawa/mh12"],
    );
    assert_eq!(code, 2);
    assert!(stderr.contains("all 12 tests are in one posture"), "{stderr}");
}

#[test]
fn problems_of_the_table_are_reported_together_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let table = "S_deg,L_deg,U_deg,R_deg,B_deg,fz_n,dz\n0,10,x,0,40,-98,0.1\n0,999,0,0,40,-98,0.1\n";
    std::fs::write(folder.path().join("tests.csv"), table).unwrap();
    let (code, stdout, stderr) = armill(
        folder.path(),
        &[
            "identify",
            "tests.csv",
            "--robot",
            "yaskawa/mh12",
            "--out",
            "mine.toml",
            "--json",
        ],
    );
    assert_eq!(code, 2);
    for part in [
        "tests.csv:1:1: missing joint positions: `T_deg`",
        "tests.csv:1:36: unknown column `dz`",
        "tests.csv:2:6: `x` is not a number",
        "joint L at 999.0 deg is outside its limits -90.0 to 155.0 deg",
    ] {
        assert!(stderr.contains(part), "{part} in\n{stderr}");
    }
    let problems: Value = serde_json::from_str(&stdout).unwrap();
    assert!(problems["problems"].as_array().unwrap().len() >= 4);
    assert!(!folder.path().join("mine.toml").exists());
}

#[test]
fn options_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    let cases: [(&[&str], &str); 6] = [
        (&["identify", "--robot", "yaskawa/mh12"], "required"),
        (
            &["identify", "nowhere.csv", "--robot", "yaskawa/mh12"],
            "cannot read nowhere.csv",
        ),
        (
            &[
                "identify",
                "tests.csv",
                "--robot",
                "yaskawa/mh12",
                "--unknowns",
                "springs",
            ],
            "`springs` is not a group",
        ),
        (
            &[
                "identify",
                "tests.csv",
                "--robot",
                "yaskawa/mh12",
                "--unknowns",
                "bending",
            ],
            "drives are missing",
        ),
        (
            &["identify", "--plan", "0", "--robot", "yaskawa/mh12"],
            "--plan 0 is not from 1 to 500",
        ),
        (
            &[
                "identify",
                "--plan",
                "5",
                "--robot",
                "yaskawa/mh12",
                "--pull-n",
                "nan",
            ],
            "--pull-n",
        ),
    ];
    for (arguments, part) in cases {
        let (code, _, stderr) = armill(folder.path(), arguments);
        assert_eq!(code, 2, "{arguments:?}: {stderr}");
        assert!(stderr.contains(part), "{arguments:?}: {stderr}");
    }
}

#[test]
fn uncertainties_of_points_give_numbers_up_to_their_limits_and_are_refused_beyond() {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    let with = |points: &str, u: &str| {
        let words = "identify tests.csv --robot yaskawa/mh12 --tool-mm 0,60,150 --unknowns drives --points";
        let arguments: Vec<&str> = words.split(' ').chain([points, "--point-u-mm", u]).collect();
        armill(folder.path(), &arguments)
    };
    for points in ["common", "separate"] {
        for u in ["1e-160", "0.0009", "2e6"] {
            let (code, _, stderr) = with(points, u);
            assert_eq!(code, 2, "{stderr}");
            assert!(
                stderr.contains("--point-u-mm") && stderr.contains("is not from 0.001 to 1000000 mm"),
                "{stderr}"
            );
        }
        for u in ["0.001", "1e6"] {
            let (code, stdout, stderr) = with(points, u);
            assert_eq!(code, 0, "{stderr}");
            assert!(!format!("{stdout}{stderr}").contains("NaN"), "{stdout}{stderr}");
        }
    }
    for (flag, value) in [("--pull-n", "1e-200"), ("--gauge-um", "1e-200")] {
        let arguments = ["identify", "--plan", "5", "--robot", "yaskawa/mh12", flag, value];
        let (code, stdout, stderr) = armill(folder.path(), &arguments);
        assert_eq!(code, 2, "{stdout}{stderr}");
        assert!(
            stderr.contains(flag) && stderr.contains("is not from 0.001 to 1000000"),
            "{stderr}"
        );
    }
}

/// The 43 published tests as a table in the format of this program.
fn fanuc_table() -> Option<String> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let folder = PathBuf::from(samples).join("datasets/fanuc-r2000ic-deflection");
    let lines = |file: &str| -> Vec<String> {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        text.lines().skip(1).map(|line| line.trim().to_owned()).collect()
    };
    let mut table = "q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad,fx_n,fy_n,fz_n,dx_m,dy_m,dz_m\n".to_owned();
    for ((joints, forces), displacements) in lines("joint_angles.csv")
        .iter()
        .zip(lines("forces.csv"))
        .zip(lines("deltaX.csv"))
    {
        writeln!(table, "{joints},{forces},{displacements}").unwrap();
    }
    Some(table)
}

#[test]
fn real_tests_left_out_are_predicted_better_than_by_least_squares() {
    let Some(table) = fanuc_table() else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("fanuc.csv"), table).unwrap();
    let robot =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/fanuc-identification/r2000ic.toml");
    let identify = |more: &[&str]| -> Value {
        let start = [
            "identify",
            "fanuc.csv",
            "--robot",
            robot.to_str().unwrap(),
            "--json",
            "--tool-mm",
            "6.9,245.3,319.3",
        ];
        let (code, stdout, stderr) = armill(folder.path(), &[&start[..], more].concat());
        assert_eq!(code, 0, "{stderr}");
        serde_json::from_str(&stdout).unwrap()
    };
    let left_out = |answer: &Value| answer["left_out"]["fraction_of_measured"].as_f64().unwrap();
    // Least squares on six drives, by another program: 20.8 % (figures of docs/theory/identification.md).
    let plain = identify(&["--unknowns", "drives", "--prior", "none"]);
    assert!((left_out(&plain) - 0.2083).abs() < 5e-4, "{}", plain["left_out"]);
    let best = identify(&["--points", "separate"]);
    assert!(left_out(&best) < 0.089, "{}", best["left_out"]);
    assert_eq!(best["outliers"], serde_json::json!(["line 12"]));
    assert_eq!(best["not_identifiable"].as_array().unwrap().len(), 1);
}

#[test]
fn a_robot_from_a_urdf_gets_a_robot_file_with_its_springs() {
    let folder = tempfile::tempdir().unwrap();
    filled_in(folder.path());
    std::fs::write(folder.path().join("arm.urdf"), MH12_URDF).unwrap();
    let arguments = [
        "identify",
        "tests.csv",
        "--robot",
        "arm.urdf",
        "--tool-mm",
        "0,60,150",
        "--unknowns",
        "drives+bending",
        "--out",
        "mine.toml",
    ];
    let (code, _, stderr) = armill(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    let pose = |robot: &str| {
        let flags = ["--joints-deg", "0,11.6,-27.8,0,39.4,0", "--json"];
        let arguments = [&["pose", robot], &flags[..]].concat();
        let (code, stdout, stderr) = armill(folder.path(), &arguments);
        assert_eq!(code, 0, "{stderr}");
        serde_json::from_str::<Value>(&stdout).unwrap()["postures"][0].clone()
    };
    let (theirs, ours) = (pose("arm.urdf"), pose("mine.toml"));
    assert_eq!(theirs["tool"]["xyz_mm"], ours["tool"]["xyz_mm"]);
    let written = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    for part in ["[[spring]]", "[covariance]", "[sources.identified]"] {
        assert!(written.contains(part), "{part} in\n{written}");
    }
}
