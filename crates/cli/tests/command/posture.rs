//! `armill posture`: before and after in words, files as `armill run` writes them.

use crate::cell::{Cell, number};

const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [850, 50, 300], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [120, 0, 150, 0, 90, 0] }
load = { cases_n = [[30, -50, 50], [30, 50, 50]] }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 10
"#;

fn text(cell: &Cell, name: &str) -> String {
    std::fs::read_to_string(cell.at(name)).unwrap()
}

#[test]
fn before_and_after_are_in_one_sentence_and_the_table_has_the_spins() {
    let cell = Cell::new();
    cell.file("study.toml", CELL);
    let said = cell
        .armill(&["posture", "study.toml", "--step-deg", "15", "--no-pictures"])
        .fine();
    assert!(
        said.out.starts_with("ring in ") && said.out.contains("µm in the largest deviation (u = "),
        "{}",
        said.out
    );
    let table = text(&cell, "posture/ring.csv");
    assert!(table.contains("turn_deg"), "{}", &table[..400]);
    let json = cell
        .armill(&[
            "posture",
            "study.toml",
            "--step-deg",
            "15",
            "--no-pictures",
            "--json",
            "--objective",
            "mean",
        ])
        .fine()
        .json();
    let search = &json["paths"][0]["search"];
    assert_eq!(
        (search["objective"].as_str(), number(&search["turns"])),
        (Some("mean"), 24.0)
    );
    assert!(number(&search["with"]["mean_in_plane_um"]) <= number(&search["without"]["mean_in_plane_um"]));
}

#[test]
fn joints_turn_back_less_often_where_that_has_a_price() {
    let cell = Cell::new();
    cell.file("study.toml", CELL);
    let with = |price: &str| {
        let said = cell.armill(&[
            "posture",
            "study.toml",
            "--step-deg",
            "15",
            "--objective",
            "mean",
            "--reversal-um-mm",
            price,
            "--no-pictures",
            "--json",
        ]);
        let json = said.fine().json();
        let with = &json["paths"][0]["search"]["with"];
        let backs = with["reversals"]
            .as_array()
            .unwrap()
            .iter()
            .map(number)
            .sum::<f64>();
        (backs, number(&with["mean_in_plane_um"]))
    };
    let (backs, mean) = with("0");
    let (fewer, dearer) = with("1e6");
    assert!(
        fewer < backs && dearer > mean,
        "{fewer} of {backs}, {dearer} after {mean} um"
    );
}

#[test]
fn pictures_have_the_lattice() {
    let cell = Cell::new();
    cell.file("study.toml", CELL);
    cell.armill(&["posture", "study.toml", "--step-deg", "30", "--out", "found"])
        .fine();
    assert!(text(&cell, "found/ring-turns.svg").contains("spin of the tool (deg)"));
    assert!(text(&cell, "found/report.html").contains("for each spin of the tool"));
}

#[test]
fn refuses_invalid_values_with_the_option() {
    let cell = Cell::new();
    cell.file("study.toml", CELL);
    cell.armill(&["posture", "study.toml", "--step-deg", "0"])
        .refused(&["--step-deg: 0 is outside 0.1 to 180"]);
    cell.armill(&["posture", "study.toml", "--reversal-um-mm", "1e10"])
        .refused(&["--reversal-um-mm: 10000000000 is outside 0 to 1000000000"]);
    cell.armill(&["posture", "study.toml", "--turns-deg", "90,-90"])
        .refused(&["turns range from 90 to -90 deg"]);
    let map = CELL
        .split("[[analysis]]")
        .next()
        .map(str::to_owned)
        .unwrap_or_default();
    cell.file("map.toml", &map);
    cell.armill(&["posture", "map.toml"])
        .refused(&["the study has no path along which"]);
}
