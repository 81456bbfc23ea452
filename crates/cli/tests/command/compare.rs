//! `armill compare`: cells compared in text, JSON and files; errors for what cannot be compared.

use crate::cell::{Cell, number};

/// A path and a plane that both arms reach.
const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [850, 50, 300], tilt_deg = 90, half_size_mm = 100, step_mm = 100 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
load = { cases_n = [[3, -5, 5], [3, 5, 5]] }
[[analysis]]
kind = "map"
name = "plate"
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 10
"#;

/// [`CELL`] with other words in place of these.
fn but(of: &str, instead: &str) -> String {
    assert!(CELL.contains(of));
    CELL.replace(of, instead)
}

#[test]
fn two_studies_are_ranked_with_their_differences() {
    let cell = Cell::new();
    cell.file("short/study.toml", CELL);
    cell.file(
        "long/study.toml",
        but("[0, 0, 150, 0, 0, 0]", "[0, 0, 400, 0, 0, 0]"),
    );
    let said = cell.armill(&["compare", "long", "short", "--no-pictures"]).fine();
    // The longer tool has more compliance: short is first although it was named last.
    assert!(said.out.starts_with("ring: "), "{}", said.out);
    let row = |name: &str| said.out.find(&format!("\n  {name}  ")).unwrap();
    assert!(row("short") < row("long"), "{}", said.out);
    assert!(
        said.out.contains("Differs: tool. short: TCP at (0, 0, 150) mm"),
        "{}",
        said.out
    );
    assert!(!said.out.contains("Differs: load"), "{}", said.out);
    assert!(cell.at("long/compare/result.json").is_file());
}

#[test]
fn numbers_are_those_of_a_run() {
    let cell = Cell::new();
    cell.file("a/study.toml", CELL);
    cell.file("b/study.toml", but("tolerance_um = 60", "tolerance_um = 30"));
    let compared = cell
        .armill(&["compare", "a", "b", "--json", "--out", "side", "--no-pictures"])
        .fine()
        .json();
    let run = cell
        .armill(&["run", "a", "--json", "--no-pictures", "--out", "alone"])
        .fine()
        .json();
    let ring = &compared["analyses"][0];
    assert_eq!(
        (ring["name"].as_str(), ring["kind"].as_str()),
        (Some("ring"), Some("path"))
    );
    let rows = ring["cells"].as_array().unwrap();
    let of_a = rows.iter().find(|row| row["cell"] == "a").unwrap();
    let path = &run["paths"][0];
    for key in ["max_in_plane_um", "fraction_within"] {
        assert_eq!(number(&of_a[key]), number(&path[key]), "{key}");
    }
    assert_eq!(number(&of_a["points"]), number(&path["points"]));
    assert_eq!(
        number(&of_a["max_in_plane_u_um"]),
        number(&path["worst"]["in_plane_u_um"])
    );
    let mean = number(&of_a["mean_in_plane_um"]);
    let [least, p95, most] = [
        &path["min_in_plane_um"],
        &of_a["p95_in_plane_um"],
        &of_a["max_in_plane_um"],
    ];
    assert!(number(least) <= mean && mean <= number(p95) && number(p95) <= number(most));
    // Same arm, same path: the two differ in the tolerance alone.
    let traits = ring["traits"].as_array().unwrap();
    let differing: Vec<_> = traits.iter().filter(|one| one["differs"] == true).collect();
    assert_eq!(differing.len(), 1, "{differing:?}");
    assert_eq!(differing[0]["what"], "tolerance");
}

#[test]
fn another_robot_has_its_own_compliance_which_is_reported_as_assumed() {
    let cell = Cell::new();
    cell.file("study.toml", CELL);
    let args = [
        "compare",
        "study.toml",
        "--robot",
        "kuka/kr120r2500pro",
        "--robot",
        "fanuc/r2000ic",
    ];
    let said = cell.armill(&args).fine();
    for given in ["kuka/kr120r2500pro", "fanuc/r2000ic", "yaskawa/mh12", "assumed"] {
        assert!(said.out.contains(given), "{given}: {}", said.out);
    }
    assert!(
        said.out
            .contains("The joint compliances of kuka/kr120r2500pro are assumed, not measured."),
        "{}",
        said.out
    );
    let json = cell.armill(&[&args[..], &["--json"]].concat()).fine().json();
    let cells = json["cells"].as_array().unwrap();
    let assumed: Vec<_> = cells
        .iter()
        .map(|cell| cell["compliance_assumed"] == true)
        .collect();
    // The FANUC is measured (2023), the KUKA is not.
    assert_eq!(assumed, [false, true, false]);
    for name in [
        "report.html",
        "cells.csv",
        "ring-cells.svg",
        "ring-along.svg",
        "plate-cells.svg",
    ] {
        assert!(cell.at("compare").join(name).is_file(), "{name}");
    }
    let report = std::fs::read_to_string(cell.at("compare/report.html")).unwrap();
    assert!(report.contains("properties of the cells") && report.contains("the same"));
    let table = std::fs::read_to_string(cell.at("compare/cells.csv")).unwrap();
    // A heading, and three cells of each of two analyses, and of the path at the best placement of each robot.
    assert_eq!(table.lines().count(), 10);
    assert_eq!(
        json["analyses"][0]["name"],
        "ring, each robot at its best placement"
    );
    assert_eq!(json["analyses"][1]["name"], "ring");
    // The KUKA has the smallest deviation where the part is given, but not within its joint limits on the whole path.
    let first = &json["analyses"][1];
    assert_eq!(first["cells"][0]["cell"], "fanuc/r2000ic", "{first}");
    assert_eq!(first["is_ranked"], true);
    let answer = first["answer"].as_str().unwrap();
    assert!(
        answer.starts_with("ring: fanuc/r2000ic is within 60 µm on the whole path")
            && answer.contains("kuka/kr120r2500pro is outside joint limits at 11 of 38 points"),
        "{answer}"
    );
    let given = cell.armill(&[&args[..], &["--given-placement", "--json"]].concat());
    assert_eq!(given.fine().json()["analyses"][0]["name"], "ring");
}

#[test]
fn compliances_and_statements_of_the_study_apply_to_its_own_robot_only() {
    let cell = Cell::new();
    let study = format!(
        "{CELL}\n[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 5\nof = [\"ring\"]\n[compliance]\nrad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]\nsource = \"test\"\n"
    );
    cell.file("own.toml", &study);
    cell.file("plain.toml", CELL);
    let largest = |study: &str, robot: &str| {
        let args = [
            "compare",
            study,
            "--robot",
            "fanuc/r2000ic",
            "--json",
            "--no-pictures",
        ];
        let json = cell.armill(&args).fine().json();
        let rows = json["analyses"][0]["cells"].as_array().unwrap().clone();
        let row = rows.iter().find(|row| row["cell"] == robot).unwrap().clone();
        number(&row["max_in_plane_um"])
    };
    assert_eq!(
        largest("own.toml", "fanuc/r2000ic"),
        largest("plain.toml", "fanuc/r2000ic")
    );
    assert!(largest("own.toml", "yaskawa/mh12") < 0.5 * largest("plain.toml", "yaskawa/mh12"));
}

#[test]
fn out_of_reach_is_a_result_with_its_counts() {
    let cell = Cell::new();
    cell.file("study.toml", but("[850, 50, 300]", "[1700, 0, 900]"));
    let said = cell
        .armill(&[
            "compare",
            "study.toml",
            "--robot",
            "fanuc/r2000ic",
            "--no-pictures",
        ])
        .fine();
    assert!(said.out.contains("yaskawa/mh12 reaches no point"), "{}", said.out);
    assert!(said.out.contains("0/38"), "{}", said.out);
}

#[test]
fn analyses_of_one_cell_only_and_different_paths_are_reported() {
    let cell = Cell::new();
    cell.file("a.toml", CELL);
    let other = but("circle.radius_mm = 60", "circle.radius_mm = 70").replace("\"plate\"", "\"sheet\"");
    cell.file("b.toml", &other);
    let said = cell
        .armill(&["compare", "a.toml", "b.toml", "--no-pictures"])
        .fine();
    for given in [
        "map `plate` is left out: only a has it.",
        "map `sheet` is left out: only b has it.",
        "The paths `ring` of a and b are not the same: 38 points over 377.0 mm against 44 points over 439.8 mm.",
    ] {
        assert!(said.out.contains(given), "{given}: {}", said.out);
    }
}

#[test]
fn refuses_what_cannot_be_compared_with_a_hint() {
    let cell = Cell::new();
    cell.file("a.toml", CELL);
    let gravity = "\n[gravity]\nreference_joints_deg = [0, 0, 0, 0, -90, 0]\n[[tool.mass]]\nat = \"tool\"\nmass_kg = 5\ncentre_mm = [0, 0, 0]\nsource = \"test\"\n";
    let first = CELL.find("[[analysis]]").unwrap();
    let (head, analyses) = CELL.split_at(first);
    let head = head
        .replace("tool = { flange_from_tool_mm_deg", "tool.flange_from_tool_mm_deg")
        .replace("0, 0, 0] }", "0, 0, 0]");
    cell.file("heavy.toml", format!("{head}{gravity}{analyses}"));
    cell.file(
        "apart.toml",
        but("\"ring\"", "\"rim\"").replace("\"plate\"", "\"sheet\""),
    );
    cell.file("wrong.toml", but("tolerance_um = 60", "tolerance_um = \"x\""));
    let refused = |args: &[&str], given: &[&str]| {
        cell.armill(&[&["compare"], args].concat()).refused(given);
    };
    refused(&["a.toml"], &["nothing to compare it with", "--robot"]);
    refused(
        &["a.toml", "--robot", "yaskawa/mh12"],
        &["nothing to compare it with"],
    );
    refused(&["a.toml", "./a.toml"], &["is given twice"]);
    refused(
        &["a.toml", "--robot", "kuka/kr120", "--robot", "lathe"],
        &[
            "`kuka/kr120` is neither",
            "did you mean `kuka/kr120r2500pro`",
            "`lathe` is neither",
        ],
    );
    refused(
        &["a.toml", "--robot", "fanuc/r2000ic", "--robot", "fanuc/r2000ic"],
        &["`fanuc/r2000ic` is given twice"],
    );
    refused(
        &["a.toml", "--robot", "universal-robots/ur10e"],
        &["nor a payload"],
    );
    refused(
        &["a.toml", "--robot", "kuka/lbr-iiwa-14-r820"],
        &["six revolute joints", "a separate study"],
    );
    refused(
        &["heavy.toml", "--robot", "fanuc/r2000ic"],
        &[
            "heavy.toml (with fanuc/r2000ic): gravity",
            "joints of yaskawa/mh12, not of fanuc/r2000ic",
        ],
    );
    refused(
        &["a.toml", "apart.toml"],
        &[
            "no analysis in common",
            "map `plate`",
            "path `rim`",
            "same `name`",
        ],
    );
    refused(&["a.toml", "wrong.toml"], &["wrong.toml:3:"]);
    refused(&["a.toml", "nowhere"], &["no study at nowhere"]);
    assert!(!cell.at("compare").exists());
}
