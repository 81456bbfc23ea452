//! `armill place` in a cell, and what other commands report of points in collision.

use crate::cell::{Cell, number};

/// A ring in front of the robot, with a spindle.
const STUDY: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 500
plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 100 }
load = { cases_n = [[3, 5, 5]] }
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[place]
x_mm = [700, 1100]
y_mm = [-300, 300]
z_mm = [400, 1000]
"#;
const CELL: &str = r#"
[[tool.body]]
name = "spindle"
cylinder_mm = { from = [0, 0, 0], to = [0, 0, 120], diameter = 60 }
[part]
box_mm = { from = [-100, -100, -50], to = [100, 100, 0] }
[[obstacle]]
name = "wall"
box_mm = { from = [600, -150, 0], to = [900, 150, 800] }
"#;
const RING: &str = "[[analysis]]\nkind = \"path\"\nname = \"ring\"\ncircle.radius_mm = 60\nstep_mm = 50\n";

/// A study with these analyses in the cell, in which postures keep 20 mm.
fn in_cell(analyses: &str) -> Cell {
    Cell::with_study(&format!("least_clearance_mm = 20\n{STUDY}{CELL}{analyses}"))
}

#[test]
fn a_wall_moves_the_placement_to_where_the_run_keeps_the_clearance() {
    let free = Cell::with_study(&format!("{STUDY}{RING}"));
    let cell = in_cell(RING);
    let place = |cell: &Cell, threads: &str| {
        let args = [
            "place",
            "study.toml",
            "--no-pictures",
            "--threads",
            threads,
            "--out",
            threads,
        ];
        let said = cell.armill(&args).fine();
        let read = |file: &str| -> serde_json::Value {
            let text = std::fs::read_to_string(cell.at(&format!("{threads}/{file}"))).unwrap();
            serde_json::from_str(&text).unwrap()
        };
        (said.out, read("placement.json"), read("result.json"))
    };
    let (said, placed, run) = place(&cell, "2");
    let path = &run["paths"][0];
    assert_eq!(
        (&path["in_collision"], &path["unreachable"]),
        (&0.into(), &0.into()),
        "{said}"
    );
    assert!(number(&path["least_clearance_mm"]) >= 20.0, "{path}");
    // Other threads, the same placement.
    assert_eq!(placed, place(&cell, "1").1);
    // The best placement without a cell is in the wall.
    let (_, without, _) = place(&free, "2");
    assert_ne!(placed["place"], without["place"]);
    let costs = [&without, &placed].map(|placed| number(&placed["recommended"]["cost_um"]));
    assert!(costs[0] < costs[1], "{costs:?}");
    let centre = &without["place"]["centre_mm"];
    let branch = &without["recommended"]["branch"];
    cell.file(
        "there.toml",
        format!("least_clearance_mm = 20\n{STUDY}{CELL}{RING}")
            .replace("[1000, 0, 500]", &centre.to_string())
            + &format!("posture = {{ branch = {branch} }}\n"),
    );
    let there = cell
        .armill(&["run", "there.toml", "--no-pictures", "--json"])
        .fine()
        .json();
    assert!(number(&there["paths"][0]["in_collision"]) > 0.0, "{there}");
}

#[test]
fn where_all_points_are_in_collision_the_sentences_name_the_bodies() {
    let volume = "kind = \"volume\"\nname = \"box\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n";
    let holes = "kind = \"holes\"\nname = \"rim\"\nholes = { at_mm = [[0, 0, 0], [50, 0, 0]] }\n";
    let plate = "kind = \"map\"\nname = \"plate\"\n";
    let of = |keys: &str| format!("[[analysis]]\n{keys}");
    for (analysis, words) in [
        (RING.to_owned(), "no point of the path (ring"),
        (of(plate), "no point of the plane (plate"),
        (of(volume), "no point of the box (box"),
        (of(holes), "no hole (rim"),
    ] {
        let cell = in_cell(&analysis);
        let said = cell.armill(&["run", "study.toml", "--no-pictures"]).fine();
        let start = format!("The robot can work at {words}");
        assert!(said.out.starts_with(&start), "{}", said.out);
        let line = said.out.lines().next().unwrap();
        assert!(
            line.contains("no posture keeps the demanded clearance at all "),
            "{line}"
        );
        assert!(
            line.contains("; at the worst ") && line.ends_with(" touch."),
            "{line}"
        );
        assert!(!said.err.contains("check that its coordinates"), "{}", said.err);
        let names_bodies = !words.starts_with("no hole") || said.err.contains(" are missing (link ");
        assert!(names_bodies, "{}", said.err);
    }
}

#[test]
fn compensation_and_comparison_report_points_in_collision() {
    let cell = in_cell(RING);
    let said = cell.armill(&["compensate", "study.toml"]).fine();
    let all = "points remain unchanged, since no posture keeps the demanded clearance; at the worst ";
    assert!(
        said.out.contains(all) && said.out.contains(" and wall touch"),
        "{}",
        said.out
    );
    assert!(!said.out.contains("out of reach"), "{}", said.out);
    cell.file("free.toml", format!("{STUDY}{RING}"));
    let said = cell
        .armill(&["compare", "study.toml", "free.toml", "--no-pictures"])
        .fine();
    assert!(
        said.out.contains("does not keep the demanded clearance at "),
        "{}",
        said.out
    );
    assert!(!said.out.contains("reaches no point"), "{}", said.out);
}
