//! The public benchmark for restricted spaces (Su et al. 2026, doi 10.1016/j.ijmachtools.2026.104364): a line of 1.3 m on the
//! floor of a space with walls, steps and a ceiling. Spin alone does not lead along it; lean does, also on a rail.

use std::path::Path;

use serde_json::Value;

use crate::cell::{Cell, number};

/// A line on the floor of the space, every 50 mm (the benchmark has a point every 2 mm), a fillet end mill of 25 mm
/// with a corner radius of 5 mm as in the benchmark, and a spindle of 120 mm.
const STUDY: &str = r#"format = 1
robot = "ROBOT"
tolerance_um = 500
least_clearance_mm = 5
COMPLIANCE
plane = { centre_mm = [2200, 0, 325], tilt_deg = 90, half_size_mm = 10, step_mm = 50 }
load = { frame = "feed", cases_n = [[-40, 20, 10]] }
posture = { branch = "best", search = { step_deg = 10FREEDOMS } }

[tool]
flange_from_tool_mm_deg = [0, 0, 400, 0, 0, 0]
[[tool.body]]
name = "spindle"
cylinder_mm = { from = [0, 0, 0], to = [0, 0, 300], diameter = 120 }
[[tool.body]]
name = "holder"
cylinder_mm = { from = [0, 0, 300], to = [0, 0, 350], diameter = 60 }
[[tool.body]]
name = "cutter"
cuts = true
cylinder_mm = { from = [0, 0, 350], to = [0, 0, 400], diameter = 25 }

[part]
mesh = "space.stl"
mesh_unit = "m"
part_from_body_mm_deg = [-650, 0, -25, 90, 0, 0]

[[analysis]]
kind = "path"
name = "floor"
polyline_mm = [[-650, 0], [650, 0]]
"#;

const OF_A_CLASS: &str = "compliance = { class = \"heavy\" }";
/// With a rail in front; made up.
const OF_SEVEN: &str = "compliance = { rad_per_n_m = [1e-9, 2e-7, 2e-7, 3e-7, 1e-6, 1e-6, 2e-6], source = \"made up\", assumed = true }";
const LEAN: &str = ", lean = { lead_deg = [-30, 30], tilt_deg = [-30, 30], step_deg = 10, deg_per_mm = 0.2, \
                    cutter = { diameter_mm = 25, corner_radius_mm = 5 } }";
const RAIL: &str = ", axes = [{ joint = \"rail\", step_mm = 250 }]";

/// A cell with the space of the samples; `None` without samples.
fn in_space(study: &str) -> Option<Cell> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let space = Path::new(&samples).join("collision/restricted-space/SDG1V7sim350_400E1.STL");
    let cell = Cell::with_study(study);
    std::fs::copy(&space, cell.at("space.stl"))
        .unwrap_or_else(|error| panic!("{}: {error}", space.display()));
    cell.file("railed.toml", on_rail());
    Some(cell)
}

fn study(robot: &str, freedoms: &str) -> String {
    let compliance = if robot == "railed.toml" {
        OF_SEVEN
    } else {
        OF_A_CLASS
    };
    STUDY
        .replace("ROBOT", robot)
        .replace("COMPLIANCE", compliance)
        .replace("FREEDOMS", freedoms)
}

/// The path of the result in the space; `None` without samples.
fn followed(robot: &str, freedoms: &str) -> Option<Value> {
    let cell = in_space(&study(robot, freedoms))?;
    cell.armill(&["run", "study.toml", "--no-pictures", "--out", "out"])
        .fine();
    Some(cell.result("out")["paths"][0].clone())
}

/// The M-710iC/45M of the library on a rail of 3 m along y, across which the part lies.
fn on_rail() -> String {
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fanuc/m710ic-45m.toml");
    let robot = std::fs::read_to_string(library).unwrap();
    let rail = "[[joint]]\nname = \"rail\"\nsign = 1\nlimits_mm = [-1500, 1500]\nmax_speed_mm_per_s = 1000\n\
                source = \"made up\"\n\n[[joint]]";
    robot
        .replacen(
            "motions = [",
            "motions = [\n    { along = \"y\", joint = \"rail\" },",
            1,
        )
        .replacen("[[joint]]", rail, 1)
        + "\n[sources.\"made up\"]\nwhat = \"A rail for tests\"\nwhere = \"none\"\nlicence = \"none\"\n"
}

/// Whether a path is followed from end to end, and keeps the demanded clearance.
fn is_feasible(path: &Value) -> bool {
    let none = |key: &str| number(&path[key]) == 0.0;
    none("unreachable")
        && none("in_collision")
        && none("outside_joint_limits")
        && path["obstacles"].as_array().is_some_and(Vec::is_empty)
        && path["search"]["breaks"].as_array().is_some_and(Vec::is_empty)
}

#[test]
fn spin_alone_does_not_lead_along_the_floor_and_lean_does() {
    let Some(spins) = followed("fanuc/m710ic-45m", "") else {
        return;
    };
    assert!(!is_feasible(&spins), "{spins}");
    let reasons = spins["search"]["unreachable_stretches"].to_string();
    assert!(reasons.contains("in_collision"), "{reasons}");
    let leaning = followed("fanuc/m710ic-45m", LEAN).unwrap();
    assert!(is_feasible(&leaning), "{leaning}");
    assert!(number(&leaning["least_clearance_mm"]) >= 5.0);
    let [from, to] = [0, 1].map(|end| number(&leaning["search"]["tilt_range_deg"][end]));
    assert!((-30.0..=30.0).contains(&from) && (-30.0..=30.0).contains(&to) && to - from > 10.0);
}

#[test]
fn on_a_rail_lean_leads_along_the_floor_too() {
    let Some(railed) = followed("railed.toml", &format!("{LEAN}{RAIL}")) else {
        return;
    };
    assert!(is_feasible(&railed), "{railed}");
    assert!(number(&railed["least_clearance_mm"]) >= 5.0);
}

/// Of a placement out of reach.
const PLACED: &str = "[place]\nx_mm = [1900, 2500]\ny_mm = [-300, 300]\nz_mm = [200, 500]\n\n[[analysis]]";

#[test]
fn place_with_lean_finds_where_all_points_are_reached_with_the_demanded_clearance() {
    let study = study("fanuc/m710ic-45m", LEAN)
        .replace("[2200, 0, 325]", "[2900, 500, 325]")
        .replace("[[analysis]]", PLACED);
    let Some(cell) = in_space(&study) else { return };
    let said = cell
        .armill(&["place", "study.toml", "--no-pictures", "--out", "placed"])
        .fine();
    assert!(said.out.contains("plane.centre_mm"), "{}", said.out);
    let text = std::fs::read_to_string(cell.at("placed/placement.json")).unwrap();
    let placement: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(number(&placement["nominal"]["unreachable_points"]), 27.0);
    assert_eq!(number(&placement["recommended"]["unreachable_points"]), 0.0);
    assert_eq!(number(&placement["searched_along"]), 4.0);
    // The study there, evaluated by itself.
    let path = &cell.result("placed")["paths"][0];
    assert!(is_feasible(path), "{path}");
    assert!(number(&path["least_clearance_mm"]) >= 5.0);
}

#[test]
fn what_a_search_with_lean_cannot_place_is_refused() {
    let refused = |robot: &str, freedoms: &str, place: &str, words: &str| {
        let study =
            study(robot, freedoms).replace("[[analysis]]", &format!("[place]\n{place}\n\n[[analysis]]"));
        let Some(cell) = in_space(&study) else { return };
        let said = cell.armill(&["place", "study.toml", "--no-pictures", "--out", "placed"]);
        assert!(said.err.contains(words), "{}", said.err);
        assert!(!cell.at("placed/placement.json").exists());
    };
    refused(
        "fanuc/m710ic-45m",
        LEAN,
        "spin_deg = [-10, 10]",
        "each point has its own best spin",
    );
    refused(
        "railed.toml",
        &format!("{LEAN}{RAIL}"),
        "rail_mm = [-500, 500]",
        "moves it along the path",
    );
    refused(
        "fanuc/m710ic-45m",
        LEAN,
        "rank_by = \"plus-two-sigma\"",
        "ranked by nominal values alone",
    );
}
