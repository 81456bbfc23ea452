//! Holes as a user meets them: files of `armill run`, the same numbers as `armill pose`, cells side by side.

use serde_json::Value;

use crate::cell::{Cell, number, numbers};

const PANEL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 150
plane = { centre_mm = [850, 50, 300], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [100, 0, 150, 0, 90, 0] }
load = { cases_n = [[5, -10, 60]] }
[[analysis]]
kind = "holes"
name = "panel"
posture.search = { step_deg = 15 }
holes = { at_mm = [[0, 0, 0], [60, 20, 0], [-50, 60, 0]] }
"#;

/// Witness: `armill pose` at the joints that were found, in its own way.
#[test]
fn each_hole_deviates_as_its_posture_does() {
    let cell = Cell::new();
    cell.file("study.toml", PANEL);
    let json = cell
        .armill(&["run", "study.toml", "--json", "--no-pictures"])
        .fine()
        .json();
    let each = json["holes"][0]["each"].as_array().unwrap();
    assert_eq!(each.len(), 3);
    for hole in each {
        let joints: Vec<String> = numbers(&hole["joints_deg"]).iter().map(f64::to_string).collect();
        let pose = cell
            .armill(&[
                "pose",
                "yaskawa/mh12",
                "--joints-deg",
                &joints.join(","),
                "--tool-mm",
                "100,0,150,0,90,0",
                "--wrench-n",
                "5,-10,60",
                "--json",
            ])
            .fine()
            .json();
        let posture = &pose["postures"][0];
        let [x, y, z] = numbers(&posture["deviation_um"])[..] else {
            panic!("three components");
        };
        // On a plate that faces up x of the part goes along -y of base, its y along x, its normal upwards.
        let given = ["x_um", "y_um", "depth_um"].map(|key| number(&hole[key]));
        for (given, expected) in given.into_iter().zip([-y, x, z]) {
            // Lanes and the plain way differ by rounding.
            assert!((given - expected).abs() < 1e-6, "{given} um and {expected} um");
        }
        let at = numbers(&posture["tool"]["xyz_mm"]);
        let placed = numbers(&hole["xyz_mm"]);
        assert!(
            at.iter().zip(&placed).all(|(a, b)| (a - b).abs() < 1e-6),
            "{at:?} {placed:?}"
        );
    }
}

#[test]
fn a_hole_with_only_a_singular_posture_is_reported_with_a_warning_and_unreachable_for_a_search() {
    let cell = Cell::new();
    // A level tool on the height of a level forearm: however it is turned, the wrist is straight.
    let level = PANEL
        .replace("[850, 50, 300], tilt_deg = 90", "[1045, 0, 1264], tilt_deg = 0")
        .replace("[100, 0, 150, 0, 90, 0]", "[0, 0, 150, 0, 0, 0]")
        .replace("[[0, 0, 0], [60, 20, 0], [-50, 60, 0]]", "[[0, 0, 0]]")
        .replace(
            "posture.search",
            "posture.branch = \"front elbow-up\"\nposture.search",
        );
    cell.file("study.toml", &level);
    let json = cell
        .armill(&["run", "study.toml", "--json", "--no-pictures"])
        .fine()
        .json();
    let hole = &json["holes"][0]["each"][0];
    assert_eq!(
        (&hole["blocked_by"], &hole["state"]),
        (&"singular".into(), &"singular".into())
    );
    assert_eq!(json["holes"][0]["refused"], 1);
    assert_eq!(json["holes"][0]["fraction_within"], 0.0);
    let counts = json["holes"][0]["counts"].as_object().unwrap();
    assert!(counts.values().all(|count| *count == 0), "{counts:?}");
    let warned = json["warnings"].to_string();
    assert!(
        warned.contains("panel: for 1 of 1 holes every turn and branch is rejected, hole 1 first (singular)"),
        "{warned}"
    );
}

#[test]
fn a_run_leaves_table_pictures_and_report() {
    let cell = Cell::new();
    cell.file("study.toml", PANEL);
    let said = cell.armill(&["run", "study.toml"]).fine();
    assert!(
        said.out.starts_with("panel: ") && said.out.contains("of 3 holes are within 150 µm"),
        "{}",
        said.out
    );
    for name in [
        "panel.csv",
        "panel.parquet",
        "panel.vtp",
        "panel-holes.svg",
        "panel-holes.png",
        "panel-shares.svg",
    ] {
        assert!(cell.at("out").join(name).is_file(), "{name}");
    }
    let text = |name: &str| std::fs::read_to_string(cell.at("out").join(name)).unwrap();
    let table = text("panel.csv");
    assert!(table.contains("hole_x_um,hole_y_um,depth_um"), "{table}");
    assert_eq!(table.lines().filter(|line| !line.starts_with('#')).count(), 4);
    assert!(text("panel-holes.svg").contains("deviations drawn ×"));
    assert!(text("report.html").contains("hole by hole, worst first"));
    assert!(text("panel.vtp").contains("NumberOfVerts=\"3\""));
    let strict = cell.armill(&["run", "study.toml", "--strict", "--no-pictures"]);
    assert_eq!(strict.code, i32::from(!said.out.contains("3 of 3 holes")));
}

#[test]
fn cells_are_compared_by_their_holes() {
    let cell = Cell::new();
    cell.file("study.toml", PANEL);
    let said = cell
        .armill(&[
            "compare",
            "study.toml",
            "--robot",
            "fanuc/r2000ic",
            "--no-pictures",
        ])
        .fine();
    assert!(
        said.out.starts_with("panel, each robot at its best placement: "),
        "{}",
        said.out
    );
    assert!(said.out.contains("\npanel: fanuc/r2000ic"), "{}", said.out);
    assert!(
        said.out.contains("the holes") || said.out.contains("all holes"),
        "{}",
        said.out
    );
    assert!(said.out.contains("3/3"), "{}", said.out);
}

/// The example of 18 holes, in the folder `rivets`, and the answer of its run; its tables are in `out`.
fn rivets() -> (Cell, Value) {
    let cell = Cell::new();
    cell.armill(&["new", "rivets", "--example", "kr210-rivets"])
        .fine();
    let run = cell.armill(&["run", "rivets", "--json", "--no-pictures", "--out", "out"]);
    let answer = run.fine().json();
    (cell, answer)
}

#[test]
fn the_worst_hole_is_one_that_can_be_drilled() {
    let (_cell, answer) = rivets();
    let holes = &answer["holes"][0];
    let each = holes["each"].as_array().unwrap();
    let largest = |drilled: bool| {
        each.iter()
            .filter(|hole| hole["blocked_by"].is_null() == drilled)
            .map(|hole| number(&hole["in_plane_um"]))
            .fold(0.0, f64::max)
    };
    // Holes 17 and 18 are reached in postures near a singularity only, and deviate more than all others.
    assert!(largest(false) > largest(true));
    let worst = &holes["worst_holes"][0];
    assert!((number(&worst["point"]["in_plane_um"]) - largest(true)).abs() < 1e-9);
    assert!((number(&holes["max_in_plane_um"]) - largest(true)).abs() < 1e-9);
    let headline = format!("hole {} deviates by", worst["hole"]);
    let said = answer["answer"].to_string();
    assert!(said.contains(&headline), "{said}");
}

#[test]
fn a_hole_that_cannot_be_drilled_does_not_decide_a_comparison() {
    let (cell, answer) = rivets();
    cell.armill(&["new", "others", "--example", "kr210-rivets"])
        .fine();
    let holes = &answer["holes"][0];
    let compared = cell
        .armill(&[
            "compare",
            "rivets",
            "others",
            "--json",
            "--no-pictures",
            "--out",
            "cells",
        ])
        .fine();
    let numbers = &compared.json()["analyses"][0]["cells"][0];
    for key in ["mean_in_plane_um", "max_in_plane_um", "fraction_within"] {
        assert!(
            (number(&numbers[key]) - number(&holes[key])).abs() < 1e-9,
            "{key}"
        );
    }
    let point = &holes["worst_holes"][0]["point"];
    assert_eq!(numbers["max_in_plane_u_um"], point["in_plane_u_um"]);
    assert_eq!(numbers["counts"], holes["counts"]);
}

#[test]
fn the_table_gives_each_hole_the_state_of_the_answer() {
    let (cell, answer) = rivets();
    let text = std::fs::read_to_string(cell.at("out").join("rivets.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').collect())
        .collect();
    let column = |name: &str| rows[0].iter().position(|head| *head == name).unwrap();
    let (hole, state) = (column("hole"), column("state"));
    let holes = &answer["holes"][0];
    let each = holes["each"].as_array().unwrap();
    assert_eq!(rows.len() - 1, each.len());
    for row in &rows[1..] {
        let number: u64 = row[hole].parse().unwrap();
        let of = |hole: &&Value| hole["hole"] == number;
        assert_eq!(
            each.iter().find(of).unwrap()["state"],
            row[state],
            "hole {number}"
        );
    }
    // Holes 17 and 18 are reached near a singularity only.
    let within = rows[1..].iter().filter(|row| row[state] == "within").count();
    assert_eq!(holes["counts"]["within"], within);
    assert_eq!([rows[17][state], rows[18][state]], ["singular"; 2]);
}
