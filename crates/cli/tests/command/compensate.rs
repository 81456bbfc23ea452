//! `armill compensate`: before and after, and a path that armill reads again.

use crate::cell::{Cell, number};

const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
limit_um = 60
plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
[load]
frame = "feed"
cases_n = [[-60, 40, 25]]
"#;
const RING: &str = "G21 G90 G17\nG0 X40 Y0 Z10\nG0 Z0\nG3 X40 Y0 I-40 J0 F600\nG1 X0 Y20\nG0 Z10\nM2\n";

/// A cell with this program in it.
fn cell(program: &str, rest: &str) -> Cell {
    let cell = Cell::new();
    cell.file("ring.ngc", RING);
    cell.file(
        "study.toml",
        format!("{CELL}[[ask]]\nkind = \"path\"\nname = \"ring\"\nprogram = {{ {program} }}\n{rest}"),
    );
    cell
}

#[test]
fn the_commanded_path_read_again_deviates_onto_the_drawn_one() {
    let cell = cell("file = \"ring.ngc\", limits = false", "");
    let said = cell.armill(&["compensate", "study.toml"]).fine();
    assert!(said.out.starts_with("ring: the tool goes "), "{}", said.out);
    let told = cell.armill(&["compensate", "study.toml", "--json"]).fine().json();
    let path = &told["paths"][0];
    let (before, after) = (
        number(&path["before"]["max_um"]),
        number(&path["after"]["max_um"]),
    );
    assert!(before > 100.0 && after < 0.01, "{before} um, then {after} um");
    assert!(number(&path["largest_correction_um"]) > 0.99 * before);
    // Both paths run: each deviates from what it commands, so the difference of the tables is what was taken off.
    cell.armill(&["run", "study.toml", "--no-pictures", "--out", "drawn"])
        .fine();
    let again = std::fs::read_to_string(cell.at("study.toml")).unwrap().replace(
        "ring.ngc\"",
        "compensated/ring.commanded.csv\", spin = \"given\", step_mm = 50",
    );
    cell.file("again.toml", &again);
    cell.armill(&["run", "again.toml", "--no-pictures", "--out", "again"])
        .fine();
    let (drawn, commanded) = (rows(&cell, "drawn"), rows(&cell, "again"));
    // The table holds every point: with long steps its program is sampled at them.
    assert_eq!(drawn.len(), commanded.len());
    for (drawn, commanded) in drawn.iter().zip(&commanded).step_by(7) {
        let full = number_of(commanded, "full_um");
        let apart: f64 = ["x_mm", "y_mm", "z_mm"]
            .iter()
            .map(|axis| (number_of(drawn, axis) - number_of(commanded, axis)).powi(2))
            .sum::<f64>()
            .sqrt();
        // Forces turn with the feed, which a table has by its chords: 1 mm on an arc of 40 mm turns by 0.025 rad.
        assert!(
            (apart * 1e3 - full).abs() < 0.03 * full,
            "{} um and {full} um",
            apart * 1e3
        );
    }
}

type Row = std::collections::BTreeMap<String, String>;

/// The table of the path.
fn rows(cell: &Cell, folder: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(cell.at(&format!("{folder}/ring.csv"))).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| {
            names
                .iter()
                .map(|name| (*name).to_owned())
                .zip(line.split(',').map(str::to_owned))
                .collect()
        })
        .collect()
}

fn number_of(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap()
}

#[test]
fn turns_that_are_searched_for_are_part_of_the_path() {
    let search = "posture = { search = { turns_deg = [10, 40], step_deg = 10 } }\n";
    let cell = cell("file = \"ring.ngc\", limits = false", search);
    cell.armill(&["compensate", "study.toml", "--out", "c"]).fine();
    let table = std::fs::read_to_string(cell.at("c/ring.commanded.csv")).unwrap();
    let spins: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    assert!(spins.iter().all(|spin| (10.0..=40.0).contains(spin)), "{spins:?}");
    assert!(cell.at("c/ring-compensated.svg").exists());
}

#[test]
fn what_cannot_be_compensated_says_why() {
    let cell = cell("file = \"ring.ngc\"", "");
    cell.armill(&["compensate", "study.toml", "--ask", "rim"])
        .refused(&["no path called `rim`"]);
    cell.file("map.toml", CELL.replace("frame = \"feed\"", ""));
    cell.armill(&["compensate", "map.toml"])
        .refused(&["asks for no path"]);
}
