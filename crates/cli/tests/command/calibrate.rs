//! `armill calibrate` and `armill pose-accuracy` as a user runs them: a lever with known errors, a UR10 that was
//! measured,
//! and what can be wrong.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::cell::armill;

/// A lever of two arms.
pub const ROBOT: &str = r#"format = 1
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
source = "drawing"

[[joint]]
name = "B"
sign = 1
source = "drawing"

[sources.drawing]
what = "a lever of two arms"
where = "this test"
licence = "ours"
"#;

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let (code, out, err) = armill(folder, &[arguments, &["--json"]].concat());
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The point of a lever whose first arm is 300.5 mm long and whose second joint counts from 0.1 deg, mm.
fn point(a_deg: f64, b_deg: f64) -> [f64; 2] {
    let a = a_deg.to_radians();
    let both = a + (b_deg + 0.1).to_radians();
    [
        1000.0 + 300.5 * a.cos() + 200.0 * both.cos(),
        -500.0 + 300.5 * a.sin() + 200.0 * both.sin(),
    ]
}

pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (mut english, mut german) = (
        "A_deg,B_deg,x_mm,y_mm,z_mm\n".to_owned(),
        "Zeit;pose;direction;A_deg;B_deg;X ist;Y ist;Z ist\r\n".to_owned(),
    );
    for k in 0..40_u32 {
        let (a, b) = (f64::from(k * 37 % 180) - 90.0, f64::from(k * 53 % 240) - 120.0);
        let [x, y] = point(a, b);
        let _ = writeln!(english, "{a},{b},{x:.9},{y:.9},20");
        for (cycle, off) in [(1, 0.01), (2, -0.01)] {
            let row = format!(
                "2,02E+13;P{k};{};{a};{b};{:.9};{y:.9};20\r\n",
                if cycle == 1 { "left" } else { "right" },
                x + off
            );
            german.push_str(&row.replace('.', ","));
        }
    }
    for (name, text) in [
        ("lever.toml", ROBOT),
        ("poses.csv", &english),
        ("cycles.csv", &german),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn a_wrong_length_and_a_wrong_zero_are_identified_and_written_to_the_robot_file() {
    let folder = folder();
    let requested = [
        "calibrate",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--validation",
        "0.25",
    ];
    let answer = json(
        folder.path(),
        &[&requested[..], &["--out", "mine.toml", "--residuals", "left.csv"]].concat(),
    );
    let value = |name: &str| {
        let all = answer["parameters"].as_array().unwrap();
        let found = all.iter().find(|one| one["name"] == name).unwrap();
        number(if found["value_mm"].is_null() {
            &found["value_deg"]
        } else {
            &found["value_mm"]
        })
    };
    assert!((value("A along x") - 0.5).abs() < 1e-5, "{answer}");
    assert_eq!(answer["training"]["poses"], 30);
    assert_eq!(answer["validation"]["poses"], 10);
    assert!(
        number(&answer["validation"]["before"]["max_mm"]) > 0.1,
        "{answer}"
    );
    assert!(
        number(&answer["validation"]["after"]["max_mm"]) < 1e-5,
        "{answer}"
    );
    let names: Vec<&str> = answer["not_identifiable"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert!(names.contains(&"A about z"), "{names:?}");
    let residuals = std::fs::read_to_string(folder.path().join("left.csv")).unwrap();
    assert_eq!(residuals.lines().count(), 41);
    let again = json(folder.path(), &["calibrate", "poses.csv", "--robot", "mine.toml"]);
    assert!(number(&again["training"]["before"]["max_mm"]) < 1e-5, "{again}");
    assert!(again["validation"].is_null());
    let (code, out, err) = armill(
        folder.path(),
        &["calibrate", "poses.csv", "--robot", "lever.toml"],
    );
    assert_eq!(code, 0, "{err}");
    for part in [
        "before",
        "not separable   A about z: same effect as base about z",
        "no validation poses",
    ] {
        assert!(out.contains(part), "{part}\n{out}");
    }
}

#[test]
fn cycles_from_two_sides_have_accuracy_repeatability_and_variation() {
    let folder = folder();
    let columns = "x_mm=X ist,y_mm=Y ist,z_mm=Z ist";
    let answer = json(
        folder.path(),
        &[
            "pose-accuracy",
            "cycles.csv",
            "--robot",
            "lever.toml",
            "--columns",
            columns,
        ],
    );
    assert_eq!((&answer["visits"], &answer["poses"]), (&80.into(), &40.into()));
    let all = &answer["repeated"];
    // Both cycles are 10 um from their mean: no scatter of the distances.
    assert!((number(&all["rp_mean_mm"]) - 0.01).abs() < 1e-6, "{all}");
    assert!((number(&all["vap_max_mm"]) - 0.02).abs() < 1e-6, "{all}");
    assert!(number(&all["ap_max_mm"]) > 0.1, "{all}");
    assert_eq!(answer["unused"], serde_json::json!(["Zeit"]));
    let (code, out, _) = armill(
        folder.path(),
        &["pose-accuracy", "poses.csv", "--robot", "lever.toml"],
    );
    assert_eq!(code, 0);
    assert!(out.contains("no pose was reached twice"), "{out}");
}

#[test]
fn refuses_invalid_input_with_all_problems_at_once() {
    let folder = folder();
    std::fs::write(
        folder.path().join("bad.csv"),
        "A_deg,B_deg,x_mm,y_mm,z_mm\n1,2,3,4\na,2,3,4,5\n1,2,nan,4,5\n",
    )
    .unwrap();
    std::fs::write(
        folder.path().join("few.csv"),
        "A_deg,B_deg,x_mm,y_mm,z_mm\n1,2,3,4,5\n",
    )
    .unwrap();
    for (arguments, parts) in [
        (
            &["calibrate", "bad.csv"][..],
            &["bad.csv:2:1", "bad.csv:3:1", "bad.csv:4:5"][..],
        ),
        (&["calibrate", "none.csv"], &["cannot read none.csv"]),
        (&["calibrate", "few.csv"], &["few.csv: 1 poses"]),
        (
            &["calibrate", "poses.csv", "--validation", "2"],
            &["--validation: 2 is not between 0 and 1"],
        ),
        (
            &["calibrate", "poses.csv", "--validation", "0.01"],
            &["leaves 40 for training and 0 for validation"],
        ),
        (
            &["calibrate", "poses.csv", "--validation", "none.csv"],
            &["cannot read none.csv"],
        ),
        (
            &["calibrate", "poses.csv", "--turns"],
            &["--turns: poses.csv has no orientations"],
        ),
        (
            &["calibrate", "poses.csv", "--turns", "--turn-mm", "0"],
            &["--turn-mm: 0 is not above 0"],
        ),
        (&["calibrate", "poses.csv", "--turn-mm", "100"], &["--turns"]),
        (
            &["calibrate", "poses.csv", "--turn-order", "fixed-xyz"],
            &["--turns"],
        ),
        (
            &["calibrate", "poses.csv", "--validation", "0.2", "--same-set-up"],
            &["--same-set-up: the fraction 0.2 is of the same file"],
        ),
        (
            &["calibrate", "poses.csv", "--tool-mm", "1,2"],
            &["--tool-mm: 2 numbers"],
        ),
        (
            &["calibrate", "poses.csv", "--columns", "x_mm=a"],
            &["no column is called `a`"],
        ),
        (&["pose-accuracy", "bad.csv"], &["bad.csv:2:1", "bad.csv:4:5"]),
        (
            &["pose-accuracy", "poses.csv", "--columns", "x_mm"],
            &["OURS=THEIRS"],
        ),
    ] {
        let requested = [arguments, &["--robot", "lever.toml", "--json"]].concat();
        let (code, out, err) = armill(folder.path(), &requested);
        assert_eq!(code, 2, "{arguments:?} {err}");
        for part in parts {
            assert!(
                format!("{out}{err}").contains(part),
                "{arguments:?}: {part}\n{out}{err}"
            );
        }
    }
    assert!(!folder.path().join("mine.toml").exists());
}

/// A file of Landgraf et al. 2021; nothing where the samples are not at hand.
fn ur10(name: &str) -> Option<PathBuf> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    Some(Path::new(&samples).join("datasets/ur10-lasertracker").join(name))
}

#[test]
fn errors_of_a_measured_ur10_equal_independent_results() {
    let Some(cubes) = ur10("Series_D/measurements_iso_cubes.csv") else {
        return;
    };
    let answer = json(
        Path::new("."),
        &[
            "pose-accuracy",
            cubes.to_str().unwrap(),
            "--robot",
            "universal-robots/ur10",
        ],
    );
    assert_eq!(answer["visits"], 632);
    let absolute = &answer["absolute"];
    // Half of the last digit printed.
    for (key, printed) in [("mean_mm", 0.72), ("rms_mm", 0.77), ("max_mm", 1.94)] {
        assert!((number(&absolute[key]) - printed).abs() < 0.0051, "{absolute}");
    }
}

#[test]
fn a_ur10_calibrated_by_random_poses_is_validated_by_others_and_by_cubes_elsewhere() {
    let (Some(random), Some(cubes)) = (
        ur10("Series_C/measurements_random_poses.csv"),
        ur10("Series_D/measurements_iso_cubes.csv"),
    ) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [random, cubes] = [random.to_str().unwrap(), cubes.to_str().unwrap()];
    let requested = [
        "calibrate",
        random,
        "--robot",
        "universal-robots/ur10",
        "--validation",
    ];
    let rms = |answer: &Value, set: &str, when: &str| number(&answer[set][when]["rms_mm"]);
    // In the measured region half of the error is removed, also for validation poses.
    let inside = json(folder.path(), &[&requested[..], &["0.2"]].concat());
    assert!(
        rms(&inside, "validation", "after") < 0.51 * rms(&inside, "validation", "before"),
        "{inside}"
    );
    // All cubes are elsewhere: the improvement is small, and a note says so.
    let answer = json(
        folder.path(),
        &[&requested[..], &[cubes, "--out", "ur10.toml"]].concat(),
    );
    assert_eq!(answer["parameters"].as_array().unwrap().len(), 16);
    assert!((rms(&answer, "validation", "before") - 0.77).abs() < 0.0051);
    assert!(
        rms(&answer, "validation", "after") < rms(&answer, "validation", "before"),
        "{answer}"
    );
    assert!(
        number(&answer["validation"]["beyond_found_range"]) > 600.0,
        "{answer}"
    );
    // The robot that was written is the one that was validated.
    let again = json(folder.path(), &["pose-accuracy", cubes, "--robot", "ur10.toml"]);
    assert!((number(&again["absolute"]["rms_mm"]) - rms(&answer, "validation", "after")).abs() < 1e-5);
}

#[test]
fn a_prior_keeps_undetermined_parameters_near_nominal_and_the_drawing_shows_both_sets() {
    let folder = folder();
    let requested = [
        "calibrate",
        "poses.csv",
        "--robot",
        "lever.toml",
        "--validation",
        "0.25",
    ];

    let answer = json(
        folder.path(),
        &[
            &requested[..],
            &[
                "--prior-mm",
                "100",
                "--prior-deg",
                "10",
                "--drawing",
                "errors.svg",
            ],
        ]
        .concat(),
    );
    let along = answer["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["name"] == "A along x")
        .unwrap();
    assert!((number(&along["value_mm"]) - 0.5).abs() < 1e-4, "{answer}");
    assert!((number(&answer["prior"]["length_mm"]) - 100.0).abs() < 1e-9);
    assert!(number(&answer["effective_parameters"]) > 2.0);
    let drawing = std::fs::read_to_string(folder.path().join("errors.svg")).unwrap();
    for part in [
        "training, before",
        "validation, after",
        "lever: errors of position",
    ] {
        assert!(drawing.contains(part), "{part}");
    }
    for (arguments, said) in [
        (&["--prior-mm", "1"][..], "--prior-deg"),
        (
            &["--prior-mm", "0", "--prior-deg", "1"],
            "--prior-mm: 0 is not above 0",
        ),
        (&["--drawing", "errors.jpg"], "does not end in .svg or .png"),
    ] {
        let (code, _, err) = armill(folder.path(), &[&requested[..], arguments].concat());
        assert!(code == 2 && err.contains(said), "{arguments:?}: {err}");
    }
}

#[test]
fn a_prior_improves_a_calibration_with_twenty_poses() {
    let Some(random) = ur10("Series_C/measurements_random_poses.csv") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    // About every tenth row of the file: twenty poses, and the file itself for validation.
    let text = std::fs::read_to_string(&random).unwrap();
    let count = text.lines().count() - 1;
    let some = text
        .lines()
        .enumerate()
        .filter(|(k, _)| *k == 0 || (k - 1) % (count / 20) == 0);
    let some: Vec<&str> = some.map(|(_, line)| line).take(21).collect();
    std::fs::write(folder.path().join("few.csv"), some.join("\n")).unwrap();
    let random = random.to_str().unwrap();
    let requested = [
        "calibrate",
        "few.csv",
        "--robot",
        "universal-robots/ur10",
        "--validation",
        random,
        "--same-set-up",
    ];
    let rms = |prior: &[&str]| {
        let answer = json(folder.path(), &[&requested[..], prior].concat());
        assert_eq!(answer["training"]["poses"], 20);
        ["before", "after"].map(|when| number(&answer["validation"][when]["rms_mm"]))
    };
    let [before, free] = rms(&[]);
    let [same, with_prior] = rms(&["--prior-mm", "0.5", "--prior-deg", "0.05"]);
    println!("before {before}, free {free}, with prior {with_prior}");
    assert!((before - same).abs() < 1e-9);
    assert!(
        with_prior < free && with_prior < before,
        "before {before}, free {free}, with prior {with_prior}"
    );
}

#[test]
fn a_named_branch_of_a_calibrated_robot_is_the_posture_that_the_drawing_has() {
    let Some(random) = ur10("Series_C/measurements_random_poses.csv") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let requested = [
        "calibrate",
        random.to_str().unwrap(),
        "--robot",
        "universal-robots/ur10",
        "--out",
        "mine.toml",
    ];
    let (code, _, err) = armill(folder.path(), &requested);
    assert_eq!(code, 0, "{err}");
    let postures = |robot: &str| {
        let answer = json(
            folder.path(),
            &[
                "pose",
                robot,
                "--at-mm",
                "700,-300,400",
                "--axis",
                "0.1,0.2,-1",
                "--compliance-class",
                "light",
            ],
        );
        answer["postures"].as_array().unwrap().clone()
    };
    let (nominal, mine) = (postures("universal-robots/ur10"), postures("mine.toml"));
    assert!(
        nominal.len() >= 4 && nominal.len() == mine.len(),
        "{} {}",
        nominal.len(),
        mine.len()
    );
    for posture in &nominal {
        let branch = &posture["branch"];
        let own = mine.iter().find(|own| own["branch"] == *branch);
        let own = own.unwrap_or_else(|| panic!("{branch} of {mine:?}"));
        let joints =
            |of: &Value| -> Vec<f64> { of["joints_deg"].as_array().unwrap().iter().map(number).collect() };
        for (a, b) in joints(posture).iter().zip(joints(own)) {
            // Lengths of a metre are off by a millimetre, angles by some hundredths: half a degree at the worst.
            let apart = (a - b + 180.0).rem_euclid(360.0) - 180.0;
            assert!(apart.abs() < 0.5, "{branch}: {a} {b}");
        }
    }
}
