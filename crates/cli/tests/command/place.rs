//! `armill place`: a better placement in text and files, fixtures, a search that continues after a kill, and what is
//! refused.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::cell::{ARMILL, Cell, MH12_URDF, number};

/// A ring on a plate, with room to move along x and to tilt.
const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 0, 800], tilt_deg = 0, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, -5, -5], [3, 5, 5]] }
posture = { branch = "front elbow-up" }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 10
"#;

fn cell(place: &str) -> Cell {
    let cell = Cell::new();
    cell.file("study.toml", format!("{CELL}{place}"));
    cell
}

fn placement(cell: &Cell, out: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(cell.at(&format!("{out}/placement.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn the_placement_is_reported_in_text_files_and_lines_for_the_study() {
    let cell = cell("");
    let args = ["place", "study.toml", "--x-mm", "700,1200", "--tilt-deg", "0,90"];
    let said = cell.armill(&args).fine();
    assert!(
        said.out.starts_with("ring: largest in-plane deviation "),
        "{}",
        said.out
    );
    assert!(said.out.contains("; nominal: 1"), "{}", said.out);
    assert!(said.out.contains("None is better of "), "{}", said.out);
    let placed = placement(&cell, "place");
    let cost = number(&placed["recommended"]["cost_um"]);
    let (gain, least) = (number(&placed["gain_um"]), number(&placed["least_gain_um"]));
    assert!((gain - number(&placed["nominal"]["cost_um"]) + cost).abs() < 1e-9);
    assert!(
        placed["is_improvement"] == true && gain > least && least > 0.0,
        "{placed}"
    );
    assert!((least - 2.0 * number(&placed["gain_u_um"])).abs() < 1e-9);
    assert!(cost < 0.5 * number(&placed["nominal"]["cost_um"]), "{placed}");
    for picture in ["placement-margin.svg", "placement-x-tilt.svg", "report.html"] {
        assert!(cell.at(&format!("place/{picture}")).exists(), "{picture}");
    }
    let report = std::fs::read_to_string(cell.at("place/report.html")).unwrap();
    let first = said.out.lines().next().unwrap();
    assert!(
        report.contains("<h2 id=\"s1\">Placement</h2>") && report.contains(first),
        "{first}"
    );
    // Where nothing is kept that the search needed on its way.
    assert!(!cell.at("place/place.rounds").exists());
    // The reported lines, pasted into the analysis.
    let lines: String = said
        .out
        .lines()
        .filter(|line| line.split_once(" = ").is_some_and(|(key, _)| !key.contains(' ')))
        .map(|line| format!("{line}\n"))
        .collect();
    cell.file("there.toml", format!("{CELL}{lines}"));
    let there = cell
        .armill(&["run", "there.toml", "--no-pictures", "--json"])
        .fine()
        .json();
    let largest = number(&there["paths"][0]["max_in_plane_um"]);
    assert!((largest - cost).abs() < 1e-3, "{largest} {cost}");
    // The margin costs: a front falls nowhere.
    let front: Vec<f64> = placed["by_margin"]
        .as_array()
        .unwrap()
        .iter()
        .map(|at| number(&at["cost_um"]))
        .collect();
    assert!(front.len() > 3 && front.is_sorted(), "{front:?}");
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let cell = cell("[place]\nx_mm = [800, 1100]\nspin_deg = [-90, 90]\n");
    let run = |out: &str, threads: &str| {
        let args = [
            "place",
            "study.toml",
            "--no-pictures",
            "--threads",
            threads,
            "--out",
            out,
        ];
        cell.armill(&args).fine();
        placement(&cell, out)
    };
    assert_eq!(run("one", "1"), run("three", "3"));
}

#[test]
fn the_best_fixture_is_named_and_unreachable_ones_are_skipped() {
    let cell = cell(
        r#"
[place]
branch = "any"
[[place.fixture]]
name = "far corner"
centre_mm = [4000, 0, 800]
[[place.fixture]]
name = "vice"
centre_mm = [800, 100, 1000]
tilt_deg = 90
[[place.fixture]]
name = "table"
centre_mm = [1050, 0, 800]
rotation_deg = [90, 0, -90]
"#,
    );
    let said = cell.armill(&["place", "study.toml", "--no-pictures"]).fine();
    assert!(
        said.out
            .contains("at fixture `vice`, centre (800.0, 100.0, 1000.0) mm"),
        "{}",
        said.out
    );
    let placed = placement(&cell, "place");
    assert_eq!(placed["fixture"], "vice");
    assert_eq!(placed["free"].as_array().unwrap().len(), 0);
}

#[test]
fn a_path_without_a_reachable_placement_is_reported() {
    let cell = cell("");
    let said = cell
        .armill(&["place", "study.toml", "--no-pictures", "--x-mm", "3000,4000"])
        .fine();
    assert!(
        said.out
            .starts_with("ring: no placement was found at which all points can be reached"),
        "{}",
        said.out
    );
    let placed = placement(&cell, "place");
    assert_eq!(placed["recommended"]["unreachable_points"], placed["points"]);
    assert_eq!(placed["by_margin"].as_array().unwrap().len(), 0);
}

#[test]
fn a_killed_search_continues_to_the_same_placement() {
    let free =
        "[place]\nx_mm = [700, 1200]\nz_mm = [500, 1100]\ntilt_deg = [-30, 60]\nroll_deg = [-90, 90]\n";
    let cell = cell(free);
    let args = ["place", "study.toml", "--no-pictures", "--out"];
    cell.armill(&[&args[..], &["whole"]].concat()).fine();
    let mut child = Command::new(ARMILL)
        .args(args)
        .arg("killed")
        .current_dir(cell.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !cell.at("killed/place.rounds").exists() {
        assert!(
            begun.elapsed() < Duration::from_secs(300),
            "no round in five minutes"
        );
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before its first round"
        );
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!cell.at("killed/result.json").exists());
    let said = cell.armill(&[&args[..], &["killed"]].concat()).fine();
    assert!(said.err.contains("completed rounds"), "{}", said.err);
    let (mut whole, mut killed) = (placement(&cell, "whole"), placement(&cell, "killed"));
    assert!(number(&killed["rounds_taken_up"]) >= 1.0);
    for placed in [&mut whole, &mut killed] {
        placed["rounds_taken_up"] = 0.into();
    }
    assert_eq!(whole, killed);
}

#[test]
fn empty_bounds_are_reported_together_at_their_positions() {
    let cell = cell(
        r#"
[place]
x_mm = [1200, 700]
spin_deg = [-300, 300]
branch = "front sideways"
[[place.fixture]]
name = "vice"
centre_mm = [900, 100, 800]
tilt_deg = 30
rotation_deg = [0, 0, 0]
"#,
    );
    cell.armill(&["place", "study.toml"]).refused(&[
        "study.toml:14:",
        "`x_mm` ranges from 1200 to 700: the range is empty",
        "`x_mm` cannot be combined with fixtures",
        "`spin_deg` spans 600 deg",
        "`sideways`",
        "fixture `vice` has both `tilt_deg` and `rotation_deg`",
    ]);
    assert!(!cell.at("place").exists());
}

#[test]
fn refuses_what_cannot_be_placed_with_a_hint() {
    let more = "[[analysis]]\nkind = \"path\"\nname = \"second\"\ncircle.radius_mm = 20\nstep_mm = 10\n";
    let cell = cell(more);
    let refused = |args: &[&str], given: &str| {
        cell.armill(&[&["place", "study.toml"], args].concat())
            .refused(&[given]);
    };
    refused(&[], "the study has several paths: `ring`, `second`");
    refused(&["--analysis", "rim"], "no path called `rim`");
    refused(&["--analysis", "ring", "--x-mm", "900,800"], "the range is empty");
    refused(&["--analysis", "ring", "--x-mm", "900"], "two numbers");
    refused(
        &["--analysis", "ring", "--margin-deg", "91"],
        "--margin-deg: 91 is outside 0 to 90",
    );
    refused(&["--analysis", "ring", "--branch", "sideways"], "`sideways`");
    cell.file("map.toml", &CELL[..CELL.find("[[analysis]]").unwrap()]);
    cell.armill(&["place", "map.toml"])
        .refused(&["no path that could be placed"]);
}

#[test]
fn holes_are_placed_each_with_its_best_spin_and_branch() {
    let holes =
        CELL[..CELL.find("[[analysis]]").unwrap()].replace("posture = { branch = \"front elbow-up\" }\n", "");
    let analysis = r#"
[[analysis]]
kind = "holes"
name = "rim"
holes = { at_mm = [[0, 0, 0], [60, 0, 0], [60, 60, 0]], normals = [[0, 0, 1], [0.3, 0, 1], [0.3, 0, 1]] }
posture.search.step_deg = 45
"#;
    let cell = Cell::new();
    cell.file("study.toml", format!("{holes}{analysis}"));
    let args = [
        "place",
        "study.toml",
        "--no-pictures",
        "--x-mm",
        "800,1100",
        "--tilt-deg",
        "0,60",
    ];
    let said = cell.armill(&args).fine();
    assert!(
        said.out.starts_with("rim: largest in-plane deviation "),
        "{}",
        said.out
    );
    let placed = placement(&cell, "place");
    let cost = number(&placed["recommended"]["cost_um"]);
    assert!(cost < number(&placed["nominal"]["cost_um"]), "{placed}");
    // The run there has the same postures, computed by the code for holes.
    let largest = number(&cell.result("place")["holes"][0]["max_in_plane_um"]);
    assert!((largest - cost).abs() < 1e-3 * cost, "{largest} {cost}");
    cell.armill(&["place", "study.toml", "--spin-deg", "0,90"])
        .refused(&["each hole has its own best spin", "posture.search.turns_deg"]);
    cell.armill(&["advise", "study.toml"])
        .refused(&["advice is for paths", "`armill place`"]);
}

/// An MH12 on a rail along its side: the best place of the rail is the one that brings the arm to where a part that
/// may move
/// along the rail would go.
#[test]
fn a_rail_moves_the_robot_as_far_as_the_part_would_move() {
    let cell = Cell::new();
    let urdf = MH12_URDF.replace(
        "<link name=\"base_link\"/>",
        "<link name=\"floor\"/><link name=\"base_link\"/><joint name=\"rail\" type=\"prismatic\"><parent link=\"floor\"/><child link=\"base_link\"/><origin xyz=\"0 0 0\" rpy=\"0 0 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"2\" effort=\"0\" velocity=\"1\"/></joint>",
    );
    cell.file("railed.urdf", urdf);
    let compliance = "compliance = { rad_per_n_m = [0, 2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5], source = \"the library's MH12\" }\n";
    let study = CELL
        .replace("\"yaskawa/mh12\"", "\"railed.urdf\"")
        .replace("step_mm = 10\n", "step_mm = 60\n")
        .replace("centre_mm = [1000, 0, 800]", "centre_mm = [1000, 700, 800]")
        .replace("[[analysis]]", &format!("{compliance}[[analysis]]"));
    cell.file("study.toml", study);
    let said = cell
        .armill(&["place", "study.toml", "--no-pictures", "--rail-mm", "0,1500"])
        .fine();
    assert!(said.out.contains(", rail at "), "{}", said.out);
    assert!(said.out.contains("posture.home_deg = ["), "{}", said.out);
    let placed = placement(&cell, "place");
    assert_eq!(placed["recommended"]["unreachable_points"], 0);
    // The same arm without a rail, and the part moved in place of it: by lanes, not one pose after the other.
    cell.file("plain.toml", CELL.replace("step_mm = 10\n", "step_mm = 60\n"));
    let moved = [
        "place",
        "plain.toml",
        "--no-pictures",
        "--y-mm",
        "-800,700",
        "--out",
        "moved",
    ];
    cell.armill(&moved).fine();
    let moved = placement(&cell, "moved");
    let rail = number(&placed["place"]["rail_mm"]);
    let y = number(&moved["place"]["centre_mm"][1]);
    assert!((700.0 - rail - y).abs() < 5.0, "{rail} {y}");
    let costs = [&placed, &moved].map(|of| number(&of["recommended"]["cost_um"]));
    assert!((costs[0] - costs[1]).abs() < 1e-3 * costs[1], "{costs:?}");
    let largest = number(&cell.result("place")["paths"][0]["max_in_plane_um"]);
    let cost = number(&placed["recommended"]["cost_um"]);
    assert!((largest - cost).abs() < 1e-3 * cost, "{largest} {cost}");
    cell.armill(&["place", "study.toml", "--rail-mm", "0,2500"])
        .refused(&["`rail_mm` ranges from 0 to 2500 mm, joint rail from -1000 to 2000 mm"]);
    cell.file("fixed.toml", CELL);
    cell.armill(&["place", "fixed.toml", "--rail-mm", "0,500"])
        .refused(&["has no rail"]);
}

/// A ring behind an R-2000iC: axis 1, whose range is 366.7 deg, turns through 180 deg along it.
const BEHIND: &str = r#"format = 1
robot = "fanuc/r2000ic"
tolerance_um = 300
tool = { flange_from_tool_mm_deg = [0, 90, 260, 0, 0, 0] }
plane = { centre_mm = [-1700, 0, 900], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[100, 50, 0]] }
posture = { branch = "front elbow-up" }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
"#;

#[test]
fn the_margin_is_kept_along_the_whole_path() {
    let cell = Cell::new();
    cell.file("study.toml", BEHIND);
    let args = [
        "place",
        "study.toml",
        "--x-mm=-1900,-1500",
        "--y-mm=95,135",
        "--margin-deg",
        "2",
    ];
    cell.armill(&args).fine();
    let placed = placement(&cell, "place");
    assert_eq!(placed["recommended"]["unreachable_points"], 0, "{placed}");
    let table = std::fs::read_to_string(cell.at("place/ring.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|other| *other == name).unwrap();
    let [margin, joint] = ["limit_margin_deg", "joint_J1_deg"].map(column);
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().unwrap_or(f64::NAN))
                .collect()
        })
        .collect();
    let least = rows.iter().map(|row| row[margin]).fold(f64::INFINITY, f64::min);
    assert!((2.0 - 1e-6..3.0).contains(&least), "{least}");
    // Axis 1 turns past 180 deg: point by point, a position of the other side would keep more than 2 deg.
    assert!(rows.iter().any(|row| row[joint] > 180.5));
}

#[test]
fn the_nominal_placement_has_the_number_of_a_run() {
    let cell = Cell::new();
    cell.armill(&["new", "pocket", "--example", "r2000ic-pocket"])
        .fine();
    let run = cell
        .armill(&["run", "pocket", "--no-pictures", "--json"])
        .fine()
        .json();
    let run = &run["paths"][0];
    cell.armill(&["place", "pocket", "--no-pictures", "--out", "placed"])
        .fine();
    let nominal = &placement(&cell, "placed")["nominal"];
    // The forces are those at equilibrium with the deflection, which is 5 um less than under the nominal forces.
    let apart = number(&nominal["cost_um"]) - number(&run["max_in_plane_um"]);
    assert!(apart.abs() < 1e-3, "{nominal}");
    let apart = number(&nominal["cost_u_um"]) - number(&run["worst"]["in_plane_u_um"]);
    assert!(apart.abs() < 0.5, "{nominal}");
    let there = std::fs::read_to_string(cell.at("placed/result.json")).unwrap();
    let there: serde_json::Value = serde_json::from_str(&there).unwrap();
    let recommended = number(&placement(&cell, "placed")["recommended"]["cost_um"]);
    let apart = recommended - number(&there["paths"][0]["max_in_plane_um"]);
    // The placement is rounded to a tenth of a micrometre.
    assert!(apart.abs() < 1e-3, "{recommended}");
}
