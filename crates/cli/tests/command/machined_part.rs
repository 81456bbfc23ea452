//! The part that comes out of a path, as a user meets it: closed forms with one soft joint, a measured part, files, and what is refused.

use serde_json::Value;

use crate::cell::{Cell, number, numbers};

/// An MH12 whose first axis alone is soft, 1e-6 rad/(N m), over a plate that faces up: x of the program is -y of base, y is x of base.
fn study(force_n: &str, compliance: &str, machined: &str, feature: &str) -> String {
    format!(
        r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
compliance = {{ rad_per_n_m = {compliance}, source = "made up for this test" }}
plane = {{ centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }}
tool = {{ flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }}
load = {{ cases_n = [{force_n}] }}
[[analysis]]
kind = "path"
name = "cut"
program = {{ file = "cut.ngc", limits = false, chord_error_mm = 0.00005, feature = [{feature}] }}
machined_part = {{ {machined} }}
"#
    )
}

const SOFT_AXIS_1: &str = "[1e-6, 0, 0, 0, 0, 0]";
const STOCK: &str = "stock = { box_mm = { from = [-40, -60, -10], to = [40, 60, 0] } }";

/// A slot along y, 80 mm long.
const SLOT: &str = "G21 G90 G0 X0 Y-40 Z5\nG1 Z-2 F600\nG1 Y40\nG0 Z5\nM2\n";

/// The answer of the part.
fn part(cell: &Cell, args: &[&str]) -> Value {
    let given = [&["run", "study.toml", "--json", "--no-pictures"], args].concat();
    cell.armill(&given).fine().json()["paths"][0]["machined_part"].clone()
}

/// A cell whose study cuts a slot.
pub fn slot() -> Cell {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}");
    let feature = r#"{ name = "slot", kind = "line", lines = [3, 3] }, { name = "floor", kind = "plane", lines = [3, 3] }"#;
    cell.file(
        "study.toml",
        study("[0, 100, 0]", SOFT_AXIS_1, &machined, feature),
    );
    cell
}

/// Witness: a joint about the z axis of the base turns by `c x F_y` and moves the tool at (x, 0) by `c x^2 F_y` along y, which is across this slot.
#[test]
fn the_walls_of_a_slot_are_off_by_the_turn_of_one_soft_joint() {
    let part = part(&slot(), &[]);
    let at = |x_m: f64| 1e-6 * 100.0 * x_m * x_m * 1e6;
    // The last dexel of the straight wall is within half a cell of its end at x = 1.04 m.
    for (key, sign) in [("most_left_um", 1.0), ("most_gouged_um", -1.0)] {
        let found = sign * number(&part[key]);
        assert!((at(1.0395)..at(1.0405)).contains(&found), "{key}: {found} um");
    }
    let features = part["features"].as_array().unwrap();
    // Mean of x^2 from 0.96 to 1.04 m.
    let mean = 100.0 * (1.04_f64.powi(3) - 0.96_f64.powi(3)) / (3.0 * 0.08);
    // Along +y of the program its +x is on the right, where the tool is pulled away and leaves material.
    for (place, sign) in [(0, -1.0), (1, 1.0)] {
        let found = number(&features[place]["offset_um"]);
        assert!(
            (found - sign * mean).abs() < 0.6,
            "{}: {found} um of {mean}",
            features[place]
        );
        // x^2 over 80 mm: a bow of 100 (0.04)^2 um about its chord of least width.
        let flatness = number(&features[place]["flatness_um"]);
        assert!((flatness - 0.16).abs() < 0.03, "{flatness} um");
    }
    assert_eq!(features[0]["name"], "slot, left");
    assert_eq!(features[1]["name"], "slot, right");
    let floor = &features[2];
    assert!(number(&floor["profile_um"]) < 0.01, "{floor}");
    let worst = &part["worst_places"][0];
    assert!(worst["cause"].as_str().unwrap().contains("100 %"), "{worst}");
}

/// Witness: the displacement at the centre, `c x^2 F_y`, is the shift of the bore; its symmetric gradient, `c x F_y / 2` in shear, makes it oval.
#[test]
fn a_bore_is_beside_its_place_and_oval() {
    let cell = Cell::new();
    let program = "G21 G90 G17 G0 X15 Y0 Z5\nG1 Z-6 F600\nG3 X15 Y0 I-15 J0\nG3 X15 Y0 I-15 J0\nG0 Z5\nM2\n";
    cell.file("cut.ngc", program);
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}");
    let feature = r#"{ name = "bore", kind = "circle", lines = [3, 4] }"#;
    cell.file(
        "study.toml",
        study("[0, 100, 0]", SOFT_AXIS_1, &machined, feature),
    );
    let part = part(&cell, &[]);
    let features = part["features"].as_array().unwrap();
    let bore = features
        .iter()
        .find(|feature| feature["name"].as_str().unwrap().ends_with("internal"))
        .unwrap();
    let position = number(&bore["position_um"]);
    assert!((position - 200.0).abs() < 0.5, "{bore}");
    let shift = numbers(&bore["axis_shift_um"]);
    assert!(
        (shift[0] + 100.0).abs() < 0.3 && shift[1].abs() < 0.3,
        "{shift:?}"
    );
    assert!(
        (number(&bore["nominal_diameter_mm"]) - 40.0).abs() < 0.02,
        "{bore}"
    );
    assert!(number(&bore["diameter_change_um"]).abs() < 0.4, "{bore}");
    // The tool goes on a circle of 15 mm: 15 mm times half the shear of 1e-4 each way, twice.
    let oval = number(&bore["cylindricity_um"]);
    assert!((oval - 1.5).abs() < 0.4, "{oval} um");
}

/// Witness: about the second axis, at x = 0.155 m, a force up by F lifts the tool by `c (x - 0.155)^2 F`, and leans it by `c (x - 0.155) F`: 0.4 um on the radius of this tool.
#[test]
fn a_floor_is_left_where_the_tool_is_pushed_up() {
    let cell = Cell::new();
    let rows: String = (-4..=4)
        .map(|row| {
            let (y, x) = (4 * row, if row % 2 == 0 { 30 } else { -30 });
            format!("G1 Y{y} F900\nG1 X{x}\n")
        })
        .collect();
    cell.file(
        "cut.ngc",
        format!("G21 G90 G0 X-30 Y-20 Z5\nG1 Z-1 F600\n{rows}G0 Z5\nM2\n"),
    );
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}");
    let feature = r#"{ name = "floor", kind = "plane", lines = [3, 40] }"#;
    cell.file(
        "study.toml",
        study("[0, 0, 100]", "[0, 1e-6, 0, 0, 0, 0]", &machined, feature),
    );
    let floor = part(&cell, &[])["features"][0].clone();
    // At the middle of the rows, x = 1 m.
    let lifted = 1e-6 * 100.0 * (1.0_f64 - 0.155).powi(2) * 1e6;
    let mean = number(&floor["mean_um"]);
    assert!((mean - lifted).abs() < 0.7, "{mean} um of {lifted}");
    let tilt = number(&floor["tilt_deg"]);
    // Slope of the lift: 2 c (x - 0.155) F.
    let slope = (2.0 * 1e-6 * 100.0 * 0.845_f64).to_degrees();
    assert!((tilt - slope).abs() < 0.15 * slope, "{tilt} deg of {slope}");
}

#[test]
fn a_measured_part_with_a_known_error_is_compared_and_the_error_found() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    // Floor at -2 mm with a wave of 10 um and 20 mm; walls at x = -5 and 5 as predicted, x^2 of base.
    let mut points = String::from("x_mm,y_mm,z_mm\n");
    let predicted = |y_mm: f64| 0.1 * (1.0 + y_mm / 1e3).powi(2);
    for step in -70..=70 {
        let y = f64::from(step) * 0.5;
        let wave = 0.01 * (std::f64::consts::TAU * y / 20.0).sin();
        for x in [-3.0, -1.5, 0.0, 1.5, 3.0] {
            points += &format!("{x},{y},{}\n", -2.0 + wave);
        }
        for z in [-1.5, -1.0, -0.5] {
            points += &format!(
                "{},{y},{z}\n{},{y},{z}\n",
                5.0 - predicted(y),
                -5.0 - predicted(y)
            );
        }
    }
    cell.file("scan.csv", &points);
    let scan = "scan = { file = \"scan.csv\", align = \"none\" }";
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}, {scan}");
    let feature = r#"{ name = "floor", kind = "plane", lines = [3, 3] }"#;
    cell.file(
        "study.toml",
        study("[0, 100, 0]", SOFT_AXIS_1, &machined, feature),
    );
    let part = part(&cell, &[]);
    let scan = &part["scan"];
    assert_eq!(number(&scan["points"]), 141.0 * 11.0);
    // What is left is the wave on 5 of 11 points.
    let rms = number(&scan["difference"]["rms_um"]);
    let expected = 10.0 / 2.0_f64.sqrt() * (5.0_f64 / 11.0).sqrt();
    assert!((rms - expected).abs() < 0.1, "{rms} um of {expected}");
    let floor = &scan["features"][0];
    assert!(
        (number(&floor["difference"]["rms_um"]) - 10.0 / 2.0_f64.sqrt()).abs() < 0.1,
        "{floor}"
    );
    assert!(number(&scan["agreement"]["explained"]) > 0.99, "{scan}");
}

/// The measured walls of the slot along y, displaced by `c x^2 F_y` with this compliance; x, y, z in mm.
fn walls_of_slot(compliance: f64) -> Vec<[f64; 3]> {
    let displaced = |y_mm: f64| compliance * 1e5 * (1.0 + y_mm / 1e3).powi(2);
    let rows = (-70..=70).map(|step| f64::from(step) * 0.5);
    let row = |y: f64| {
        let points = [-1.5, -1.0, -0.5].map(|z| [5.0, -5.0].map(|x| [x - displaced(y), y, z]));
        points.into_iter().flatten()
    };
    rows.flat_map(row).collect()
}

fn table_of(points: &[[f64; 3]]) -> String {
    let rows = points.iter().map(|[x, y, z]| format!("{x},{y},{z}\n"));
    std::iter::once("x_mm,y_mm,z_mm\n".to_owned())
        .chain(rows)
        .collect()
}

/// Witness: a joint that is 1.2 times as soft as the model has it: the model explains `1 - (0.2/1.2)^2` of the mean square, and the tool was where the walls are.
#[test]
fn contributions_and_tips_of_a_scan_are_those_of_the_soft_joint() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    cell.file("scan.csv", table_of(&walls_of_slot(1.2e-6)));
    let scan = "scan = { file = \"scan.csv\", align = \"none\" }";
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}, {scan}");
    cell.file("study.toml", study("[0, 100, 0]", SOFT_AXIS_1, &machined, ""));
    let part = part(&cell, &["--out", "out"]);
    let contributions = part["scan"]["contributions"].as_array().unwrap();
    let first = &contributions[0];
    assert_eq!(first["name"], "S");
    let explained = 1.0 - (0.2_f64 / 1.2).powi(2);
    for (key, expected) in [("explained_alone", explained), ("explained_without", 0.0)] {
        let found = number(&first[key]);
        assert!((found - expected).abs() < 1e-3, "{key}: {found} of {expected}");
    }
    for other in &contributions[1..] {
        assert!(number(&other["rms_um"]) < 0.1, "{other}");
    }
    let text = std::fs::read_to_string(cell.at("out/cut.scan-points.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let of = |row: &[&str], name: &str| -> f64 {
        let column = names.iter().position(|other| *other == name).unwrap();
        row[column].parse().unwrap()
    };
    let mut rows = 0;
    for line in lines {
        let row: Vec<&str> = line.split(',').collect();
        assert_eq!((of(&row, "fy_n"), of(&row, "ny").abs() < 1e-3), (100.0, true));
        // The wall of the tool at y is at -1.2 times the predicted displacement, along its normal.
        let along = (of(&row, "x_mm") - of(&row, "nominal_x_mm")) * of(&row, "nx");
        let expected = -0.12 * (1.0 + of(&row, "nominal_y_mm") / 1e3).powi(2) * of(&row, "nx");
        assert!((along - expected).abs() < 4e-3, "{line}: {along} of {expected}");
        rows += 1;
    }
    assert!(rows >= 2, "{text}");
}

/// Witness: both walls of a rib are displaced in the same direction, so that its thickness is the programmed one but for `c F_y` times the difference of `x^2` at its faces.
#[test]
fn a_rib_between_two_slots_keeps_its_thickness() {
    let cell = Cell::new();
    cell.file(
        "cut.ngc",
        "G21 G90 G0 X-8 Y-40 Z5\nG1 Z-2 F600\nG1 Y40\nG0 Z5\nG0 X8 Y-40\nG1 Z-2\nG1 Y40\nG0 Z5\nM2\n",
    );
    let feature = r#"{ name = "one", kind = "line", lines = [3, 3] }, { name = "other", kind = "line", lines = [7, 7] }"#;
    let of = |between: &str| {
        let wall = format!("walls = [{{ name = \"rib\", between = [{between}] }}]");
        let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}, {wall}");
        cell.file(
            "study.toml",
            study("[0, 100, 0]", SOFT_AXIS_1, &machined, feature),
        );
    };
    of(r#""one", "other""#);
    let wall = part(&cell, &[])["walls"][0].clone();
    assert!((number(&wall["nominal_mm"]) - 6.0).abs() < 1e-6, "{wall}");
    assert!(number(&wall["change_um"]).abs() < 0.02, "{wall}");
    assert!((number(&wall["least_mm"]) - 6.0).abs() < 1e-4, "{wall}");
    of(r#""one", "third""#);
    cell.armill(&["run", "study.toml"])
        .refused(&["`third` is not a line or plane", "`one`, `other`"]);
    of(r#""one", "one""#);
    cell.armill(&["run", "study.toml"]).refused(&["the same feature"]);
}

/// Datum points hide the motion of the whole part; the walls keep their form.
#[test]
fn a_scan_that_was_moved_is_found_again_by_its_datums() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    let mut points = walls_of_slot(1e-6);
    points.extend((-70..=70).flat_map(|step| [-3.0, 0.0, 3.0].map(|x| [x, f64::from(step) * 0.5, -2.0])));
    // Turned by 1 mrad about z, and displaced.
    let moved = |[x, y, z]: &[f64; 3]| [x - 1e-3 * y + 0.2, y + 1e-3 * x - 0.1, z + 0.05];
    let moved: Vec<[f64; 3]> = points.iter().map(moved).collect();
    let of = |points: &[[f64; 3]], align: &str| {
        cell.file("scan.csv", table_of(points));
        let scan = format!("scan = {{ file = \"scan.csv\", {align} }}");
        let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}, {scan}");
        cell.file("study.toml", study("[0, 100, 0]", SOFT_AXIS_1, &machined, ""));
    };
    let datums = "align = \"datums\", datums = { primary_mm = [[-3, -30, -2], [3, -30, -2], [0, 30, -2]], secondary_mm = [[5, -30, -1], [5, 30, -1]], tertiary_mm = [0, 0, -2], radius_mm = 1.5 }";
    of(&moved, datums);
    // No surface of this slot determines its place along y: a floor as tertiary datum does not either.
    cell.armill(&["run", "study.toml"]).refused(&["scan.csv"]);
    of(&moved, "align = \"best_fit\"");
    let scan = part(&cell, &[])["scan"].clone();
    assert!(number(&scan["difference"]["rms_um"]) < 0.5, "{scan}");
    let turned = numbers(&scan["removed"]["rotation_deg"]);
    let by_prediction = numbers(&scan["removed_from_prediction"]["rotation_deg"]);
    let own = (turned[2] - by_prediction[2]).to_radians();
    assert!((own + 1e-3).abs() < 2e-6, "{own} rad");
    of(&points, "align = \"none\"");
    let scan = part(&cell, &[])["scan"].clone();
    assert!(number(&scan["difference"]["rms_um"]) < 0.5, "{scan}");
}

#[test]
fn files_of_the_part_are_written_and_named_in_the_result() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    let machined = format!("cell_mm = 1, {STOCK}, tool = {{ diameter_mm = 10 }}");
    cell.file("study.toml", study("[0, 100, 0]", SOFT_AXIS_1, &machined, ""));
    cell.armill(&["run", "study.toml", "--out", "out"]).fine();
    let read = |name: &str| std::fs::read(cell.at(&format!("out/{name}"))).unwrap();
    assert!(read("cut.part.ply").starts_with(b"ply\n"));
    assert!(read("cut.part.glb").starts_with(b"glTF"));
    assert!(String::from_utf8_lossy(&read("cut.part.vtp")).contains("deviation_um"));
    assert!(String::from_utf8_lossy(&read("cut-part.svg")).contains("data:image/png;base64,"));
    assert!(String::from_utf8_lossy(&read("report.html")).contains("Machined parts."));
}

#[test]
fn what_cannot_be_cut_or_compared_is_refused_with_its_key() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    let tool = "tool = { diameter_mm = 10 }";
    let cases = [
        (format!("cell_mm = 1, {tool}"), "a machined part needs its stock"),
        (
            format!("cell_mm = 1, {STOCK}"),
            "the shape of the tool is not known",
        ),
        (
            format!("cell_mm = 1, nominal = \"part\", {STOCK}, {tool}"),
            "no [part] with a mesh",
        ),
        (format!("cell_mm = 0.001, {STOCK}, {tool}"), "GiB of memory"),
        (
            format!("cell_mm = 1, {STOCK}, {tool}, scan = {{ file = \"none.xyz\" }}"),
            "none.xyz",
        ),
        (
            format!("cell_mm = 1, {STOCK}, {tool}, scan = {{ file = \"none.xyz\", align = \"datums\" }}"),
            "needs `datums`",
        ),
        (
            format!(
                "cell_mm = 1, {tool}, stock = {{ cylinder_mm = {{ from = [0, 0, 0], to = [5, 0, -10], diameter = 20 }} }}"
            ),
            "axis along z",
        ),
    ];
    for (machined, message) in cases {
        cell.file("study.toml", study("[0, 100, 0]", SOFT_AXIS_1, &machined, ""));
        cell.armill(&["run", "study.toml"]).refused(&[message]);
    }
}

#[test]
fn compensation_of_the_surface_leaves_the_feed_and_is_cut_again() {
    let cell = Cell::new();
    cell.file("cut.ngc", SLOT);
    let machined = format!("cell_mm = 0.5, {STOCK}, tool = {{ diameter_mm = 10 }}");
    cell.file("study.toml", study("[60, 100, 0]", SOFT_AXIS_1, &machined, ""));
    let whole = cell.armill(&["compensate", "study.toml", "--json"]).fine().json();
    let surface = cell
        .armill(&[
            "compensate",
            "study.toml",
            "--json",
            "--surface",
            "--out",
            "other",
        ])
        .fine()
        .json();
    for given in [&whole, &surface] {
        let numbers = &given["paths"][0]["surface"];
        assert!(number(&numbers["before"]["rms_um"]) > 50.0, "{numbers}");
        assert!(number(&numbers["after"]["rms_um"]) < 0.5, "{numbers}");
    }
    let without = study("[60, 100, 0]", SOFT_AXIS_1, &machined, "")
        .replace(&format!("machined_part = {{ {machined} }}\n"), "");
    cell.file("study.toml", without);
    cell.armill(&["compensate", "study.toml", "--surface", "--out", "third"])
        .refused(&["no `machined_part`"]);
}
