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
fn a_program_of_the_robot_goes_along_the_commanded_path_and_up_between_cuts() {
    use armill_formats::robot_program::{Motion, ProgramText, Speed, Target, read};
    let cell = cell("file = \"ring.ngc\", limits = false", "");
    // Two cuts with a rapid between them.
    cell.file(
        "ring.ngc",
        format!(
            "{}G0 Z10\nG0 X-40 Y0\nG0 Z0\nG1 X-10 F300\nG0 Z10\nM2\n",
            RING.trim_end_matches("G0 Z10\nM2\n")
        ),
    );
    for ending in ["src", "mod", "jbi", "ls", "script"] {
        let file = format!("prog/ring.{ending}");
        cell.armill(&["compensate", "study.toml", "--program", &file, "--within-um", "5"])
            .fine();
        let name = std::fs::read_dir(cell.at("prog"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .find(|path| {
                path.extension()
                    .is_some_and(|other| other.eq_ignore_ascii_case(ending))
            })
            .unwrap();
        let text = ProgramText::new(&name.display().to_string(), &std::fs::read(&name).unwrap());
        let program = read(vec![text]).unwrap();
        let linear: Vec<_> = program
            .moves
            .iter()
            .filter(|next| next.motion == Motion::Linear)
            .collect();
        assert_eq!(
            program.moves.len() - linear.len(),
            2,
            "{ending}: each cut is come to by joints"
        );
        // Up at the end of each cut: 50 mm along the tool.
        let at = |target: &Target| target.pose().unwrap().translation.vector;
        let last = [linear[linear.len() - 2], linear[linear.len() - 1]].map(|next| at(&next.target));
        assert!(((last[1] - last[0]).norm() - 0.05).abs() < 1e-5, "{ending}");
        // 600 and 300 mm/min: 10 and 5 mm/s.
        let speeds: Vec<f64> = linear
            .iter()
            .filter_map(|next| match next.speed {
                Speed::Tip(speed) => Some((speed * 1e4).round() / 1e4),
                _ => None,
            })
            .collect();
        assert!(
            speeds.contains(&0.01) && speeds.contains(&0.005) && speeds.len() == linear.len(),
            "{ending} {speeds:?}"
        );
        // A circle of 40 mm in chords of 5 um sagitta, and few points more.
        assert!(
            linear.len() > 60 && linear.len() < 400,
            "{ending}: {}",
            linear.len()
        );
    }
    cell.armill(&["compensate", "study.toml", "--program", "ring.txt"])
        .refused(&["that of no language"]);
    cell.armill(&["compensate", "study.toml", "--program", "1ring.src"])
        .refused(&["`1ring` is no name in KUKA KRL"]);
    cell.armill(&[
        "compensate",
        "study.toml",
        "--program",
        "ring.src",
        "--retract-mm",
        "5000",
    ])
    .refused(&["the arm cannot go 5000 mm up from here"]);
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
