//! `armill advise`: recommended placement, spin, compensation and forces as sentences, and the run of the resulting
//! study.

use crate::cell::{Cell, number};
use crate::without_masses::without_masses;

const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
plane = { centre_mm = [1000, 0, 800], tilt_deg = 0, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 20
"#;

fn cell(tolerance_um: &str, place: &str) -> Cell {
    let cell = Cell::new();
    cell.file(
        "study.toml",
        format!("tolerance_um = {tolerance_um}\n{CELL}{place}"),
    );
    cell
}

fn advice(cell: &Cell) -> serde_json::Value {
    let text = std::fs::read_to_string(cell.at("advice/advice.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_path_out_of_tolerance_is_improved_and_the_result_is_reported() {
    let cell = cell("40", "");
    let said = cell
        .armill(&[
            "advise",
            "study.toml",
            "--no-pictures",
            "--x-mm",
            "800,1100",
            "--tilt-deg",
            "0,90",
        ])
        .fine();
    for words in [
        "ring: place the part at centre (",
        "of the path is then within 40 µm, largest deviation ",
        "(nominal: ",
        "Compensated (`armill compensate`), the predicted largest deviation from the path is ",
        "µm from robot and force); it costs a new program.",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
    assert!(said.out.contains("Placement: "), "{}", said.out);
    assert!(
        said.out.contains("it costs a new set-up of the part"),
        "{}",
        said.out
    );
    let advice = advice(&cell);
    let largest = |of: &str| number(&advice[of]["max_in_plane_um"]);
    assert_eq!(advice["moves"], true);
    // What was advised can be run, and has the advised numbers.
    let again = cell
        .armill(&["run", "advised", "--no-pictures", "--json"])
        .fine()
        .json();
    let there = number(&again["paths"][0]["max_in_plane_um"]);
    assert!((there - largest("recommended")).abs() < 1e-3, "{there} {advice}");
    let steps = std::fs::read_to_string(cell.at("advised/steps.csv")).unwrap();
    let names: Vec<&str> = steps.lines().filter_map(|line| line.split(',').next()).collect();
    assert_eq!(names, ["step", "nominal", "placement", "spin", "compensation"]);
    assert!(cell.at("advised/ring.commanded.csv").is_file());
    assert!(largest("recommended") < largest("nominal"), "{advice}");
    // The compensated path is nearer to the nominal one than the uncompensated.
    assert!(number(&advice["compensated"]["max_um"]) < 0.5 * largest("recommended"));
    // The recommended study is the one that was run.
    let run = &cell.result("advice")["paths"][0];
    assert_eq!(run["worst"]["in_plane_u_um"], advice["compensated_u_um"]);
    assert!(number(&advice["compensated_u_um"]) > number(&advice["compensated"]["max_um"]));
    assert!((number(&run["max_in_plane_um"]) - largest("recommended")).abs() < 1e-9);
    // Forces are reported relative to the remaining tolerance.
    let factor = number(&advice["force_factor"]);
    assert!((factor * largest("recommended") - 40.0).abs() < 1e-6);
}

#[test]
fn stretches_out_of_tolerance_are_reported_with_place_and_reason() {
    let cell = cell("1", "");
    let said = cell
        .armill(&["advise", "study.toml", "--no-pictures", "--x-mm", "990,1010"])
        .fine();
    assert!(
        said.out.contains("The tolerance is not met from 0 to "),
        "{}",
        said.out
    );
    assert!(said.out.contains("largest contribution: joint "), "{}", said.out);
    assert!(said.out.contains(" times these forces"), "{}", said.out);
    let advice = advice(&cell);
    let stretch = &advice["out_of_tolerance"][0];
    assert_eq!(stretch["points"], advice["placement"]["points"]);
    assert!(number(&advice["force_factor"]) < 1.0);
}

#[test]
fn part_and_tool_are_kept_if_nothing_is_better() {
    // One place, one turn: nothing is free.
    let cell = cell(
        "500",
        "[place]\nx_mm = [1000, 1000]\n[posture]\nbranch = \"front elbow-up no-flip\"\n[posture.search]\nturns_deg = [0, 0]\n",
    );
    let said = cell.armill(&["advise", "study.toml", "--no-pictures"]).fine();
    assert!(said.out.contains("keep part and tool"), "{}", said.out);
    assert!(
        said.out.contains("The path is within the tolerance with up to "),
        "{}",
        said.out
    );
    assert_eq!(advice(&cell)["moves"], false);
}

#[test]
fn a_study_without_a_path_is_refused() {
    let cell = Cell::new();
    let map = CELL[..CELL.find("[[analysis]]").unwrap()].to_owned();
    cell.file("study.toml", format!("tolerance_um = 40\n{map}"));
    cell.armill(&["advise", "study.toml"])
        .refused(&["no path that could be placed"]);
}

#[test]
fn the_advised_study_finds_its_files_and_its_program_is_written() {
    let cell = Cell::new();
    cell.file(
        "cell/part.ngc",
        "G21 G90\nF600\nG0 X0 Y0 Z5\nG1 Z0\nG1 X50\nG1 Y40\nM2\n",
    );
    let study = CELL
        .replace("circle.radius_mm = 60\n", "program = { file = \"part.ngc\" }\n")
        .replace("name = \"ring\"", "name = \"part\"");
    cell.file(
        "cell/study.toml",
        format!("# My cell.\ntolerance_um = 40\n{study}"),
    );
    let args = [
        "advise",
        "cell",
        "--no-pictures",
        "--x-mm",
        "800,1100",
        "--program",
        "out.jbi",
    ];
    let said = cell.armill(&args).fine();
    assert!(said.err.contains("as advised in cell/advised"), "{}", said.err);
    let written = std::fs::read_to_string(cell.at("cell/advised/study.toml")).unwrap();
    assert!(written.starts_with("# My cell."), "{written}");
    assert!(written.contains("\"../part.ngc\""), "{written}");
    cell.armill(&["check", "cell/advised"]).fine();
    // The ending is that of the controller.
    assert!(cell.at("out.JBI").is_file());
    // Another language is not one.
    let refused = [&args[..5], &["--program", "out.exe"]].concat();
    cell.armill(&refused)
        .refused(&["is not that of a robot language"]);
}

/// An arm whose first joint alone deflects, with all its mass at the tip: one mode at 28 Hz at this place; the teeth pass at three quarters of
/// it, and the cut is deeper than its limit there.
const CHATTERING: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 100000
plane = { centre_mm = [900, 0, 500], tilt_deg = 90, half_size_mm = 50, step_mm = 50 }
posture = { branch = "front elbow-up no-flip" }
compliance = { rad_per_n_m = [1e-6, 0, 0, 0, 0, 0], source = "own" }
place = { x_mm = [900, 900] }
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[tool.mass]]
at = "tool"
mass_kg = 40
centre_mm = [0, 0, 0]
source = "own"
[cut]
material = "aluminium-7075-t6"
u_percent = 1
axial_depth_mm = 2
side = "slot"
spindle_rpm = 630
feed_mm_per_min = 63
cutter = { diameter_mm = 10, flutes = 2 }
[vibration]
damping_ratio = 0.03
[[analysis]]
kind = "path"
name = "slot"
line = { from_mm = [-10, 0], to_mm = [10, 0] }
step_mm = 10
"#;

#[test]
fn a_speed_that_is_advised_makes_the_cut_stable() {
    let cell = Cell::new();
    // The only mass is that of the tool.
    let chattering = without_masses(CHATTERING);
    cell.file("study.toml", &chattering);
    let said = cell.armill(&["advise", "study.toml", "--no-pictures"]).fine();
    for words in [
        "The cut is unstable",
        "Spindle speed: ",
        "raises the least stable depth",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
    let advice = advice(&cell);
    let speed = &advice["stability"]["speed"];
    let times = number(&speed["times"]);
    let [after, before] = [0, 1].map(|index| number(&speed["stable_depth_mm"][index]));
    assert!(before < 2.0 && after > 2.0, "{speed}");
    let faster = chattering
        .replace("spindle_rpm = 630", &format!("spindle_rpm = {}", 630.0 * times))
        .replace(
            "feed_mm_per_min = 63",
            &format!("feed_mm_per_min = {}", 63.0 * times),
        );
    cell.file("faster.toml", faster);
    let of = |study: &str| {
        let found = cell
            .armill(&[
                "run",
                study,
                "--no-pictures",
                "--json",
                "--out",
                &format!("{study}-out"),
            ])
            .fine()
            .json();
        let cut = found["paths"][0]["vibration"]["cut"].clone();
        (number(&cut["stable_depth_mm"]), cut["unstable_points"].clone())
    };
    std::fs::rename(cell.at("study.toml"), cell.at("slow.toml")).unwrap();
    let (depth, unstable) = of("faster.toml");
    assert!(
        (depth / after - 1.0).abs() < 1e-6 && unstable == 0,
        "{depth} {after}"
    );
    let (depth, unstable) = of("slow.toml");
    assert!(
        (depth / before - 1.0).abs() < 1e-6 && unstable != 0,
        "{depth} {before}"
    );
}
