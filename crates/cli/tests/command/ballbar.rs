//! `armill ballbar` as a user runs it: numbers, tables, pictures, two-step teaching; and everything that can be wrong.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::cell::armill;

/// Offset by half a degree: 12 um amplitude, an ellipse of 30 um, 20 um of backlash in X, an offset of 40 um along X.
fn deviation_um(degrees: f64, sign: f64) -> f64 {
    let a = degrees.to_radians();
    12.0 + 40.0 * a.cos() + 30.0 * (2.0 * a).cos() + sign * 10.0 * a.sin().signum() * a.cos()
}

/// Rows of a run.
fn rows(way: &str, run: usize, change: impl Fn(f64) -> f64) -> String {
    let sign = if way == "CW" { -1.0 } else { 1.0 };
    (0..360).fold(String::new(), |mut text, k| {
        let degrees = 180.0 + sign * (f64::from(k) + 0.5);
        let deviation = deviation_um(degrees, sign) + change(degrees);
        let _ = writeln!(text, "{degrees},{deviation:.4},{way},{run}");
        text
    })
}

const NAMES: &str = "angle_deg,radius_dev_um,direction,run\n";
const HEAD: &str = "# radius_mm: 100\n# plane: XY\n# feed_mm_per_min: 1000\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let four = |change: &dyn Fn(f64) -> f64| {
        [("CW", 1), ("CCW", 1), ("CW", 2), ("CCW", 2)]
            .map(|(way, run)| rows(way, run, |a| change(a) + 0.5 * run as f64))
            .concat()
    };
    write("test.csv", &format!("{HEAD}{NAMES}{}", four(&|_| 0.0)));
    let taught = |a: f64| -12.0 - 30.0 * (2.0 * a.to_radians()).cos();
    write("second.csv", &format!("{HEAD}{NAMES}{}", four(&taught)));
    write("cw.csv", &format!("{NAMES}{}", rows("CW", 1, |_| 0.0)));
    write("ccw.csv", &format!("{NAMES}{}", rows("CCW", 1, |_| 0.0)));
    let dirt = |a: f64| if (a - 100.5).abs() < 0.1 { 80.0 } else { 0.0 };
    write("dirt.csv", &format!("{HEAD}{NAMES}{}", rows("CW", 1, dirt)));
    folder
}

fn reported(folder: &Path, arguments: &[&str]) -> Value {
    let (code, out, err) = armill(folder, &[&["ballbar"], arguments, &["--json"]].concat());
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

fn number(value: &Value, expected: f64, slack: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value} for {expected}"));
    assert!((found - expected).abs() <= slack, "{value} for {expected}");
}

fn part<'a>(reported: &'a Value, what: &str) -> &'a Value {
    let parts = reported["parts"]["radial"].as_array().unwrap();
    parts
        .iter()
        .find(|part| part["what"] == what)
        .unwrap_or(&Value::Null)
}

#[test]
fn a_test_is_reported_as_quantities_differences_and_contributions() {
    let folder = folder();
    let reported = reported(folder.path(), &["test.csv"]);
    assert_eq!(reported["axes"], serde_json::json!(["X", "Y"]));
    number(&reported["centring"]["offset_um"][0], 40.0, 0.02);
    number(&reported["mean_bidirectional_um"], 12.75, 0.02);
    // At the ends of X the directions are 20 um apart.
    number(&reported["hysteresis_um"], 20.0, 0.01);
    number(&reported["repeatability"][0]["max_um"], -0.5, 1e-3);
    number(&reported["repeatability"][0]["rms_um"], 0.5, 1e-3);
    number(&part(&reported, "step X+")["value_um"], 20.0, 0.02);
    number(&part(&reported, "step Y-")["value_um"], 0.0, 0.02);
    number(&reported["parts"]["scale_um_per_m"][0], (12.75 + 30.0) / 0.1, 0.2);
    number(&reported["parts"]["squareness_urad"], 0.0, 0.2);
    number(&reported["lobes"][1]["amplitude_um"], 30.0, 0.02);
    assert!(
        reported["warnings"].as_array().unwrap().is_empty(),
        "{}",
        reported["warnings"]
    );
    // About the pivot the offset is in F, and in nothing else.
    let setup = self::reported(folder.path(), &["test.csv", "--centre", "setup"]);
    number(
        &setup["runs"][0]["radial_max_um"],
        12.5 + 40.0 + 30.0 + 10.0,
        0.05,
    );
    assert_eq!(setup["centring"]["centre"], "setup");
    let [one, other] =
        [&reported, &setup].map(|reported| reported["circular_bidirectional_um"].as_f64().unwrap());
    assert!((one - other).abs() < 1e-6);
}

#[test]
fn files_of_one_circle_are_one_test_and_options_give_missing_data() {
    let folder = folder();
    let both = reported(
        folder.path(),
        &["cw.csv", "ccw.csv", "--radius-mm", "100", "--plane", "ZX"],
    );
    assert_eq!(both["axes"], serde_json::json!(["Z", "X"]));
    assert_eq!(both["runs"][1]["name"], "CCW1");
    number(&both["hysteresis_um"], 20.0, 0.01);
    assert!(both["warnings"].to_string().contains("only one CW run"));
    let one = reported(folder.path(), &["cw.csv", "--radius-mm", "100"]);
    assert!(one["circular_bidirectional_um"].is_null() && one["hysteresis_um"].is_null());
    let warned = one["warnings"].to_string();
    assert!(
        warned.contains("no CCW run") && warned.contains("not separable: squareness, servo mismatch"),
        "{warned}"
    );
    // The sum of two errors has only its radial amplitude, not an angle or a scale.
    number(&part(&one, "squareness")["value_um"], 0.0, 0.02);
    let parts = &one["parts"];
    for of in [
        "squareness_urad",
        "squareness_u_urad",
        "scale_um_per_m",
        "servo_mismatch_s",
    ] {
        assert!(parts[of].is_null(), "{of}: {parts}");
    }
    let (_, text, _) = armill(folder.path(), &["ballbar", "cw.csv", "--radius-mm", "100"]);
    assert!(!text.contains("than 90 deg"), "{text}");
}

#[test]
fn writes_tables_pictures_and_report() {
    let folder = folder();
    let (code, out, err) = armill(folder.path(), &["ballbar", "test.csv", "--out", "o"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("G(b)") && out.contains("step X+") && out.contains("CW1 - CW2"),
        "{out}"
    );
    for file in [
        "result.json",
        "report.html",
        "runs.csv",
        "differences.csv",
        "parts.csv",
        "ballbar.svg",
        "ballbar.png",
        "repeat-CW.png",
        "repeat-CCW.svg",
        "directions.png",
    ] {
        assert!(folder.path().join("o").join(file).is_file(), "{file}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join("o").join(name)).unwrap();
    let runs = read("runs.csv");
    assert!(
        runs.starts_with("angle_deg,CW1_um,CCW1_um,CW2_um,CCW2_um") && runs.lines().count() == 721,
        "{}",
        &runs[..60]
    );
    assert!(read("ballbar.svg").contains("division 20 µm"));
    // The folder is written again in place of what was there.
    let (code, ..) = armill(
        folder.path(),
        &["ballbar", "cw.csv", "--radius-mm", "100", "--out", "o"],
    );
    assert!(code == 0 && !folder.path().join("o/directions.png").exists());
}

#[test]
fn a_corrected_circle_is_written_and_a_second_test_compared_with_the_first() {
    let folder = folder();
    let first = reported(folder.path(), &["test.csv", "--teach", "p.csv", "--points", "36"]);
    let table = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    assert_eq!(table.lines().count(), 37);
    let row: Vec<f64> = table
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    assert!(
        (row[1] - (100.0 - 0.042_75)).abs() < 1e-4 && (row[2] + 42.75).abs() < 0.1,
        "{row:?}"
    );
    number(&first["taught"]["stays_um"], 10.0, 0.01);
    assert!(first["taught"]["circular_expected_um"].as_f64().unwrap() < 22.0);
    let second = reported(folder.path(), &["second.csv", "--before", "test.csv"]);
    let compared = second["before"]["compared"].as_array().unwrap();
    let of = |what: &str| compared.iter().find(|of| of["what"] == what).unwrap();
    number(&of("D")["after_um"], 0.75, 0.02);
    assert!(of("G(b)")["left_percent"].as_f64().unwrap() < 40.0);
}

#[test]
fn few_samples_resolve_few_lobes() {
    let folder = folder();
    // 36 samples of ten lobes, 5 um high.
    let rows = (0..36).fold(String::new(), |text, k| {
        let deviation = 5.0 * f64::from(100 * k).to_radians().cos();
        text + &format!("{},{deviation},CCW,1\n", 10 * k)
    });
    std::fs::write(folder.path().join("few.csv"), format!("{HEAD}{NAMES}{rows}")).unwrap();
    let found = reported(folder.path(), &["few.csv", "--lobes", "100"]);
    let lobes = found["lobes"].as_array().unwrap();
    assert_eq!(lobes.len(), 17);
    number(&lobes[9]["amplitude_um"], 5.0, 1e-3);
    assert!(
        found["warnings"]
            .to_string()
            .contains("17 lobes are reported, not 100"),
        "{}",
        found["warnings"]
    );
    let teach = ["few.csv", "--teach", "p.csv", "--teach-lobes", "30"];
    let found = reported(folder.path(), &teach);
    assert_eq!(found["taught"]["most_lobes"], 17);
    assert!(
        found["warnings"]
            .to_string()
            .contains("compensates 17 lobes, not 30"),
        "{}",
        found["warnings"]
    );
}

#[test]
fn unused_columns_are_reported() {
    let folder = folder();
    let text = format!(
        "{HEAD}{}{}",
        NAMES.replace("run", "run_no"),
        rows("CW", 1, |_| 0.0)
    );
    std::fs::write(folder.path().join("odd.csv"), text).unwrap();
    let (code, _, err) = armill(folder.path(), &["ballbar", "odd.csv"]);
    assert!(
        code == 0 && err.contains("unused column: odd.csv: run_no"),
        "{err}"
    );
}

#[test]
fn points_are_written_where_all_else_is_too() {
    let folder = folder();
    let all = ["ballbar", "test.csv", "--teach", "p.csv", "--out", "test.csv"];
    let (code, ..) = armill(folder.path(), &all);
    assert!(code == 2 && !folder.path().join("p.csv").exists());
}

#[test]
fn dirt_is_reported_and_excluded_on_request() {
    let folder = folder();
    let kept = reported(folder.path(), &["dirt.csv"]);
    assert_eq!(kept["outliers"].as_array().unwrap().len(), 1);
    number(&kept["outliers"][0]["angle_deg"], 100.5, 1e-6);
    assert!(kept["warnings"].to_string().contains("--leave-out-outliers"));
    let clean = reported(folder.path(), &["dirt.csv", "--leave-out-outliers"]);
    let g = |reported: &Value| reported["directions"][0]["circular_um"].as_f64().unwrap();
    // 80 um on top of a slope of the ellipse.
    assert!(g(&kept) > g(&clean) + 5.0, "{kept} {clean}");
    // The corrected circle is that of the remaining samples: at 100 degrees, next to the dirt.
    let correction = |more: &[&str]| -> f64 {
        let teach = ["dirt.csv", "--teach", "p.csv", "--teach-lobes", "30"];
        let _ = reported(folder.path(), &[&teach, more].concat());
        let table = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
        let row = table.lines().find(|line| line.starts_with("100")).unwrap();
        row.split(',').nth(2).unwrap().parse().unwrap()
    };
    let a = 100_f64.to_radians();
    let smooth = -(12.0 + 30.0 * (2.0 * a).cos() - 10.0 * a.cos());
    // 30 lobes take up a sixth of 80 um.
    let [with, without] = [correction(&[]), correction(&["--leave-out-outliers"])];
    assert!(
        (without - smooth).abs() < 2.0 && with < smooth - 10.0,
        "{with} {without} for {smooth}"
    );
}

#[test]
fn reports_an_arc() {
    let folder = folder();
    let arc: String = (0..=220).fold(String::new(), |text, deg| {
        text + &format!("{deg},{},CCW,1\n", deviation_um(f64::from(deg) + 0.25, 1.0))
    });
    std::fs::write(folder.path().join("arc.csv"), format!("{HEAD}{NAMES}{arc}")).unwrap();
    let reported = reported(folder.path(), &["arc.csv"]);
    // Seen from the least-squares centre.
    number(&reported["runs"][0]["arc_deg"], 220.0, 0.1);
    let warned = reported["warnings"].to_string();
    assert!(warned.contains("CCW1 has no samples from"), "{warned}");
    assert!(warned.contains("step Y- is not known"), "{warned}");
    // There is a sample at 0 degrees, and none before it.
    assert!(warned.contains("step X+ is not known"), "{warned}");
    assert!(part(&reported, "step X+").is_null() && !part(&reported, "step X-").is_null());
    // An arc determines one scale better than the other.
    let both_ways = format!("{HEAD}{NAMES}{arc}{}", arc.replace("CCW", "CW"));
    std::fs::write(folder.path().join("arcs.csv"), both_ways).unwrap();
    let u = &self::reported(folder.path(), &["arcs.csv"])["parts"]["scale_u_um_per_m"];
    assert!(u[1].as_f64().unwrap() > 2.0 * u[0].as_f64().unwrap(), "{u}");
    assert!(reported["lobes"].as_array().unwrap().is_empty());
    let (code, _, err) = armill(folder.path(), &["ballbar", "arc.csv", "--teach", "p.csv"]);
    assert!(
        code == 2 && err.contains("measure full turns") && !folder.path().join("p.csv").exists(),
        "{err}"
    );
}

#[test]
fn an_error_that_repeats_is_found_with_its_period() {
    let folder = folder();
    let wave = |a: f64| 2.0 * (TAU * 100.0 * a.to_radians().cos() / 20.0).sin() * a.to_radians().cos();
    let text = format!("{HEAD}{NAMES}{}{}", rows("CW", 1, wave), rows("CCW", 1, wave));
    std::fs::write(folder.path().join("wave.csv"), text).unwrap();
    let found = reported(folder.path(), &["wave.csv", "--cyclic", "search"]);
    number(&found["parts"]["cyclic_period_mm"], 20.0, 0.1);
    let given = reported(folder.path(), &["wave.csv", "--cyclic", "20"]);
    number(&part(&given, "cyclic along X, sine")["value_um"], 2.0, 0.05);
}

#[test]
fn results_of_the_ballbar_software_are_compared_with_those_of_armill() {
    let folder = folder();
    let results = "<BALLBAR><MACHINE_TESTED NAME='MH12'/><FEATURE NAME='AF_CIRCULARITY' DT='UT_LENGTH_UM'>70.5</FEATURE>\
        <FEATURE NAME='AF_BACKLASH_A_POS' DT='UT_LENGTH_UM'>19.5</FEATURE></BALLBAR>";
    std::fs::write(folder.path().join("a.b5r"), results).unwrap();
    let reported = reported(folder.path(), &["test.csv", "a.b5r"]);
    number(&reported["results"][0]["features"][1]["ours"], 20.0, 0.02);
    let (code, _, err) = armill(folder.path(), &["ballbar", "a.b5r"]);
    assert!(code == 2 && err.contains("results only, no radii"), "{err}");
}

#[test]
fn errors_are_reported_with_position_and_hint() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("unit.csv", "angle,radius_dev\n0,1\n");
    write("cells.csv", &format!("{NAMES}0,1,CW,1\n1,x,left,1\n2,3\n"));
    write(
        "mixed.csv",
        &format!(
            "# radius_mm: 100\n{NAMES}{}0.5,90000000,CW,1\n",
            rows("CW", 1, |_| 0.0)
        ),
    );
    write(
        "far.csv",
        &format!("{NAMES}{}0.5,90000000,CW,1\n", rows("CW", 1, |_| 0.0)),
    );
    let with = |head: &str| format!("{head}{NAMES}{}", rows("CW", 1, |_| 0.0));
    write(
        "fast.csv",
        &with("# radius_mm: 100\n# plane: XY\n# feed_mm_per_min: 2000\n"),
    );
    write("yz.csv", &with("# radius_mm: 100\n# plane: YZ\n"));
    let each = (0..101).fold(String::new(), |text, k| text + &format!("{k},1,CW,{k}\n"));
    write("each.csv", &format!("{NAMES}{each}"));
    write(
        "small.csv",
        &format!("# radius_mm: 150\n{NAMES}{}", rows("CW", 1, |_| 0.0)),
    );
    for (arguments, words) in [
        (&["none.csv"][..], &["cannot read none.csv", "help:"][..]),
        (
            &["unit.csv"],
            &["unit.csv:1:1", "write `angle_deg`", "write `radius_dev_um`"],
        ),
        (
            &["cells.csv"],
            &[
                "cells.csv:3:3: `x` is not a number",
                "cells.csv:3:5: `left` is not a direction",
                "cells.csv:4:1",
            ],
        ),
        (&["unit.csv", "cells.csv"], &["unit.csv:1", "cells.csv:3"]),
        (&["cw.csv"], &["the nominal radius is not given", "radius_mm"]),
        (
            &["mixed.csv"],
            &["mixed.csv:363:5: the radius is off by 90000 mm, more than half the nominal 100 mm"],
        ),
        // The radius is from another file: the run is reported by its file and its name.
        (
            &["test.csv", "far.csv"],
            &["far.csv: CW3 (run `1`), sample 361: the radius is off by"],
        ),
        (&["each.csv"], &["each.csv:102:1: more than 100 runs"]),
        (
            &["test.csv", "--before", "small.csv"],
            &["--before: the nominal radius was 150 mm, but is 100 mm now"],
        ),
        (
            &["test.csv", "--before", "fast.csv"],
            &["--before: the feed was 2000 mm/min, but is 1000 mm/min now"],
        ),
        (
            &["test.csv", "--before", "yz.csv"],
            &["--before: the plane was YZ, but is XY now"],
        ),
        (
            &["test.csv", "--cyclic", "1e-306"],
            &["a cyclic error with a period of", "is outside 6.981 to 100 mm"],
        ),
        (
            &["test.csv", "--cyclic", "200"],
            &["a period of 200 mm is outside"],
        ),
        (
            &[
                "test.csv",
                "--teach",
                "p.csv",
                "--points",
                "60",
                "--teach-lobes",
                "30",
            ],
            &["--points: 60 points are too few for the 30 lobes of --teach-lobes"],
        ),
        (
            &["test.csv", "small.csv"],
            &["small.csv has another nominal radius than test.csv"],
        ),
        (
            &["test.csv", "--radius-mm", "150"],
            &["another nominal radius was given before"],
        ),
        (&["test.csv", "--plane", "YZ"], &["another plane than the option"]),
        (
            &["cw.csv", "--radius-mm", "-1"],
            &["--radius-mm: -1 is not above 0"],
        ),
        (&["cw.csv", "--radius-mm", "1e6"], &["a nominal radius of"]),
        (
            &["cw.csv", "--direction", "up"],
            &["--direction: `up` is not a direction"],
        ),
        (
            &["test.csv", "--cyclic", "no"],
            &["--cyclic: `no` is not a period"],
        ),
        (&["test.csv", "--cyclic", "0"], &["--cyclic: 0 is not above 0"]),
        (
            &["test.csv", "--lobes", "999"],
            &["--lobes: 999 is outside 0 to 360"],
        ),
        (
            &["test.csv", "--points", "2"],
            &["--points: 2 is outside 3 to 360"],
        ),
        (
            &["test.csv", "--reversal-deg", "nan"],
            &["--reversal-deg: NaN is not a finite number"],
        ),
        (&["test.csv", "--before", "none.csv"], &["cannot read none.csv"]),
        (&["test.csv", "--out", "test.csv"], &["test.csv"]),
    ] {
        let (code, out, err) = armill(folder.path(), &[&["ballbar"], arguments].concat());
        assert_eq!(code, 2, "{arguments:?}: {out}{err}");
        for word in words {
            assert!(err.contains(word), "{arguments:?}: no `{word}` in\n{err}");
        }
    }
}

const CIRCLE: &str = r#"
format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[1, 0, 0]] }

[[analysis]]
kind = "path"
name = "ring"
circle = { radius_mm = 100 }
"#;

#[test]
fn the_corrected_circle_is_written_as_a_program_through_every_point() {
    use armill_programs::{Motion, ProgramText, Speed, Target, read};
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("study.toml"), CIRCLE).unwrap();
    // Angle 0 of the ball-bar is at 90 degrees of the circle, and its angles have the opposite direction.
    for (zero_deg, way, keys) in [
        (0.0, 1.0, &[][..]),
        (90.0, -1.0, &["--zero-deg", "90", "--mirrored"][..]),
    ] {
        for ending in ["src", "mod", "ls", "script"] {
            let file = format!("prog/ring.{ending}");
            let requested = [
                "test.csv",
                "--teach",
                "p.csv",
                "--points",
                "48",
                "--program",
                &file,
                "--study",
                "study.toml",
            ];
            let (code, _, err) = armill(at, &[&["ballbar"], &requested[..], keys].concat());
            assert_eq!(code, 0, "{err}");
            // Straight moves between 48 points leave the circle by R (1 - cos(pi / 48)) = 214 um.
            assert!(
                err.contains("deviate by 214.1 um from the circle; 324 points are within 5 um"),
                "{err}"
            );
            let table = std::fs::read_to_string(at.join("p.csv")).unwrap();
            let rows: Vec<Vec<f64>> = table
                .lines()
                .filter(|line| !line.starts_with('#'))
                .skip(1)
                .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
                .collect();
            let name = std::fs::read_dir(at.join("prog"))
                .unwrap()
                .map(|entry| entry.unwrap().path())
                .find(|path| {
                    path.extension()
                        .is_some_and(|own| own.eq_ignore_ascii_case(ending))
                })
                .unwrap();
            let text = ProgramText::new(&name.display().to_string(), &std::fs::read(&name).unwrap());
            let program = read(vec![text]).unwrap();
            let moves: Vec<_> = program
                .moves
                .iter()
                .filter(|next| next.motion == Motion::Linear)
                .collect();
            // 48 points, the first again to close, and up.
            assert_eq!(moves.len(), 48 + 2, "{ending}");
            assert!(
                moves[..48 + 1]
                    .iter()
                    .all(|next| matches!(next.speed, Speed::Tip(v) if (v - 1.0 / 60.0).abs() < 2e-4)),
                "{ending}"
            );
            let tip = |target: &Target| target.pose().unwrap().translation.vector * 1e3;
            // The circle is on the plane about the origin of its frame, -x is y' and y is z'.
            let expected: Vec<[f64; 2]> = rows
                .iter()
                .map(|row| {
                    let a = (zero_deg + way * row[0]).to_radians();
                    [-row[1] * a.cos(), row[1] * a.sin()]
                })
                .collect();
            for next in &moves[..49] {
                let tip = tip(&next.target);
                let off = |[x, y]: &[f64; 2]| (tip.x - x).hypot(tip.y - y);
                let nearest = expected.iter().map(off).fold(f64::MAX, f64::min);
                // FANUC and KUKA write micrometres, two of them on a diagonal.
                assert!(
                    nearest < 2e-3 && tip.z.abs() < 1e-3,
                    "{ending} {keys:?}: {nearest} {tip}"
                );
            }
            // Every point once, in one direction.
            let close = (tip(&moves[0].target) - tip(&moves[48].target)).norm();
            assert!(close < 1e-9, "{ending}: {close}");
            let angles: Vec<f64> = moves[..48]
                .iter()
                .map(|next| tip(&next.target))
                .map(|t| t.y.atan2(-t.x))
                .collect();
            assert!(
                angles
                    .windows(2)
                    .all(|pair| (pair[1] - pair[0]).rem_euclid(TAU) < 0.14),
                "{ending}"
            );
        }
    }
    // Without a count as many points as the straight moves need.
    let requested = [
        "ballbar",
        "test.csv",
        "--teach",
        "p.csv",
        "--program",
        "prog/many.src",
        "--study",
        "study.toml",
    ];
    let (code, _, err) = armill(at, &requested);
    assert!(code == 0 && !err.contains("um from the circle"), "{err}");
    assert_eq!(
        std::fs::read_to_string(at.join("p.csv")).unwrap().lines().count(),
        325
    );
}

#[test]
fn refuses_a_program_of_another_circle_or_without_a_circle() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("study.toml"), CIRCLE).unwrap();
    std::fs::write(
        at.join("small.toml"),
        CIRCLE.replace("radius_mm = 100", "radius_mm = 60"),
    )
    .unwrap();
    let two =
        format!("{CIRCLE}[[analysis]]\nkind = \"path\"\nname = \"other\"\ncircle = {{ radius_mm = 50 }}\n");
    std::fs::write(at.join("two.toml"), two).unwrap();
    std::fs::write(
        at.join("line.toml"),
        CIRCLE.replace(
            "circle = { radius_mm = 100 }",
            "line = { from_mm = [0, 0], to_mm = [50, 0] }",
        ),
    )
    .unwrap();
    for (arguments, said) in [
        (&["--program", "a.src"][..], "--study STUDY"),
        (
            &["--program", "a.txt", "--study", "study.toml"],
            "is not that of a robot language",
        ),
        (
            &["--program", "a.src", "--study", "small.toml"],
            "the circle of the study has 60 mm, that of the ball-bar 100 mm",
        ),
        (
            &["--program", "a.src", "--study", "two.toml"],
            "2 circles: ring, other",
        ),
        (
            &["--program", "a.src", "--study", "two.toml", "--analysis", "third"],
            "no circle called `third`",
        ),
        (&["--program", "a.src", "--study", "line.toml"], "has no circle"),
        (
            &["--program", "a.src", "--study", "study.toml", "--zero-deg", "nan"],
            "not a finite number",
        ),
        (
            &["--program", "a.src", "--study", "study.toml", "--points", "4000"],
            "--points: 4000 is outside 3 to 3600",
        ),
    ] {
        let (code, _, err) = armill(at, &[&["ballbar", "test.csv"], arguments].concat());
        assert!(code == 2 && err.contains(said), "{arguments:?} {code}: {err}");
    }
    assert!(!at.join("a.src").exists());
    // A name among several will do.
    let (code, _, err) = armill(
        at,
        &[
            "ballbar",
            "test.csv",
            "--program",
            "a.src",
            "--study",
            "two.toml",
            "--analysis",
            "ring",
        ],
    );
    assert!(code == 0 && at.join("a.src").exists(), "{err}");
}
