//! `armill backlash` as a user runs it: the backlash of a robot file is simulated and identified again; informative
//! circles;
//! and invalid input.

use serde_json::Value;

use crate::cell::{Cell, number};
use crate::documents::repository;

const CELL: &str = r#"format = 1
robot = "arm.toml"
tolerance_um = 200
plane = { centre_mm = [850, 250, 450], tilt_deg = 90, half_size_mm = 150, step_mm = 75 }
tool = { flange_from_tool_mm_deg = [30, -20, 150, 0, 0, 0] }
load = { cases_n = [[0, 0, 0]] }
posture.branch = "front elbow-up"
[[analysis]]
kind = "path"
name = "flat"
circle = { radius_mm = 100 }
[[analysis]]
kind = "path"
name = "upright"
plane = { centre_mm = [750, -350, 750], tilt_deg = 0 }
circle = { radius_mm = 100 }
[[analysis]]
kind = "path"
name = "tilted"
plane = { centre_mm = [700, 450, 550], tilt_deg = 40 }
circle = { radius_mm = 100 }
"#;

const MEASURED: &str = r#"
[[ballbar]]
analysis = "flat"
files = ["runs/flat.csv"]
[[ballbar]]
analysis = "upright"
files = ["runs/upright.csv"]
[[ballbar]]
analysis = "tilted"
files = ["runs/tilted.csv"]
"#;

/// Backlash of each joint of the MH12, deg.
const GAPS: [f64; 6] = [0.007, 0.005, 0.009, 0.015, 0.012, 0.02];

fn with_backlash() -> String {
    let text = std::fs::read_to_string(repository().join("robots/yaskawa/mh12.toml")).unwrap();
    let mut parts = text.split("\ncompliance_source = \"paper\"");
    let first = parts.next().unwrap().to_owned();
    let joints = GAPS.iter().zip(parts);
    joints.fold(first, |text, (gap, rest)| {
        format!(
            "{text}\nbacklash_deg = {gap}\nbacklash_source = \"paper\"\ncompliance_source = \"paper\"{rest}"
        )
    })
}

fn cell() -> Cell {
    let cell = Cell::with_study(CELL);
    cell.file("arm.toml", with_backlash());
    cell
}

fn reported(cell: &Cell, arguments: &[&str]) -> Value {
    let all = [&["backlash", "study.toml", "--json"], arguments].concat();
    cell.armill(&all).fine().json()
}

#[test]
fn the_backlash_of_the_robot_file_is_identified_from_simulated_records() {
    let cell = cell();
    let written = reported(&cell, &["--simulate", "runs", "--noise-um", "2", "--seed", "4"]);
    assert_eq!(written.as_array().unwrap().len(), 3);
    cell.file("study.toml", format!("{CELL}{MEASURED}"));
    let found = reported(&cell, &["--out", "out"]);
    for (joint, gap) in found["joints"].as_array().unwrap().iter().zip(GAPS) {
        assert_eq!(joint["state"], "identified", "{joint}");
        let [value, u] = ["backlash_deg", "backlash_u_deg"].map(|key| number(&joint[key]));
        assert!(
            (value - gap).abs() < 3.5 * u && u < 0.1 * gap,
            "{joint} for {gap}"
        );
        assert!((number(&joint["robot_file_deg"]) - gap).abs() < 1e-12);
    }
    assert!((number(&found["rms_after_um"]) - 2.0).abs() < 0.1);
    assert!(number(&found["rms_before_um"]) > 5.0);
    assert!(
        found["warnings"].as_array().unwrap().is_empty(),
        "{}",
        found["warnings"]
    );
    let reversals = found["circles"][0]["reversals"].as_array().unwrap();
    assert!(reversals.len() >= 10);
    assert_eq!(cell.answer("out"), found);
    for file in ["reversals.csv", "flat.svg", "upright.svg", "tilted.svg"] {
        assert!(cell.at(&format!("out/{file}")).is_file(), "{file}");
    }
    // In words.
    let words = cell.armill(&["backlash", "study.toml"]).fine();
    assert!(
        words.out.contains("reverses at deg") && words.out.contains("robot file"),
        "{}",
        words.out
    );
}

#[test]
fn the_same_seed_gives_the_same_file_and_armill_ballbar_reads_it() {
    let cell = cell();
    let noise = [
        "--noise-um",
        "3",
        "--seed",
        "9",
        "--runs",
        "1",
        "--analysis",
        "upright",
    ];
    reported(&cell, &[&["--simulate", "one"][..], &noise].concat());
    reported(&cell, &[&["--simulate", "two"][..], &noise].concat());
    let [one, two] =
        ["one", "two"].map(|folder| std::fs::read(cell.at(&format!("{folder}/upright.csv"))).unwrap());
    assert_eq!(one, two);
    assert!(!cell.at("one/flat.csv").exists());
    let shown = cell
        .armill(&["ballbar", "one/upright.csv", "--no-axes", "--json"])
        .fine()
        .json();
    assert_eq!(shown["runs"].as_array().unwrap().len(), 2);
    assert!(number(&shown["hysteresis_um"]) > 20.0);
}

#[test]
fn files_in_other_angles_give_the_same_backlash() {
    let cell = cell();
    reported(&cell, &["--simulate", "runs", "--analysis", "flat"]);
    let text = std::fs::read_to_string(cell.at("runs/flat.csv")).unwrap();
    // The ball-bar was viewed from above: x is 0 deg, in the opposite direction.
    let turned = text.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(deg) = cells[0].parse::<f64>() {
            cells[0] = (90.0 - deg).to_string();
            cells[2] = if cells[2] == "CW" { "CCW" } else { "CW" }.to_owned();
        }
        cells.join(",") + "\n"
    });
    let turned: String = turned.collect();
    cell.file("runs/turned.csv", turned);
    let of = |table: &str| {
        cell.file(
            "study.toml",
            format!("{CELL}[[ballbar]]\nanalysis = \"flat\"\n{table}\n"),
        );
        reported(&cell, &[])["joints"].clone()
    };
    let plain = of("files = [\"runs/flat.csv\"]");
    let other = of("files = [\"runs/turned.csv\"]\nzero_deg = 90\nmirrored = true");
    for (one, other) in plain.as_array().unwrap().iter().zip(other.as_array().unwrap()) {
        assert_eq!(one["state"], other["state"]);
        if one["state"] == "identified" {
            let [one, other] = [one, other].map(|joint| number(&joint["backlash_deg"]));
            assert!((one - other).abs() < 1e-6, "{one} {other}");
        }
    }
}

#[test]
fn proposes_circles_that_separate_the_joints() {
    let cell = cell();
    let plan = reported(
        &cell,
        &[
            "--circles",
            "2",
            "--analysis",
            "flat",
            "--within-mm",
            "150,150,150",
        ],
    );
    let circles = plan["circles"].as_array().unwrap();
    assert_eq!(circles.len(), 2);
    assert_eq!(number(&plan["candidates"]), 216.0);
    assert!(number(&plan["followed"]) > 10.0);
    assert_eq!(
        circles[1]["known"]["joints"].as_array().unwrap().len(),
        6,
        "{plan}"
    );
    let [one, two] = [&plan, &circles[1]].map(|of| of["known"]["joints"].as_array().unwrap().len());
    assert!(one <= two);
    let words = cell.armill(&["backlash", "study.toml", "--circles", "1"]).fine();
    assert!(
        words.out.contains("216 circles searched") && words.out.contains("rotation_deg"),
        "{}",
        words.out
    );
}

#[test]
fn refuses_invalid_values() {
    let cell = cell();
    let refused = |arguments: &[&str], said: &[&str]| {
        cell.armill(&[&["backlash", "study.toml"], arguments].concat())
            .refused(said);
    };
    refused(&[], &["names no circular test", "[[ballbar]]"]);
    refused(&["--circles", "0"], &["--circles: 0 is outside 1 to 100"]);
    refused(
        &["--circles", "1", "--within-mm", "1,2"],
        &["--within-mm: 3 numbers are required (got 2)"],
    );
    refused(&["--circles", "1", "--radii-mm", "0"], &["--radii-mm"]);
    refused(&["--simulate", "runs", "--noise-um", "nan"], &["--noise-um"]);
    refused(
        &["--simulate", "runs", "--analysis", "nowhere"],
        &["no circle called `nowhere`"],
    );
    assert!(!cell.at("runs").exists());
    // Problems of the table, all at once and at their places.
    cell.file(
        "study.toml",
        format!(
            "{CELL}[[ballbar]]\nanalysis = \"ring\"\nfiles = [\"none.csv\"]\n[[ballbar]]\nfiles = [\"none.csv\"]\n"
        ),
    );
    refused(
        &[],
        &[
            "`ring`",
            "file none.csv not found",
            "the study has 3 circles",
            "study.toml:2",
        ],
    );
    let far = CELL.replace("[850, 250, 450]", "[2500, 250, 450]");
    cell.file("study.toml", far);
    refused(&["--simulate", "runs"], &["flat: at 0 deg of the circle"]);
    assert!(!cell.at("runs").exists());
    cell.file(
        "study.toml",
        format!("{CELL}[[ballbar]]\nanalysis = \"flat\"\nfiles = [\"short.csv\"]\n"),
    );
    let rows: String = (0..360).fold(String::new(), |text, deg| format!("{text}{deg},1,CW,1\n"));
    cell.file(
        "short.csv",
        format!("# radius_mm: 150\nangle_deg,radius_dev_um,direction,run\n{rows}"),
    );
    refused(&[], &["a radius of 150 mm, `flat` has 100 mm"]);
}
