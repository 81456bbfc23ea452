//! `armill budget` as a user runs it: an experiment whose causes are known is taken apart; and everything that can be
//! wrong with its files.
//!
//! The part is made of what the study itself predicts under load, read from its own table without rounding, of a path
//! without load, of its reversals, and of noise.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::cell::armill;

const STUDY: &str = r#"
format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[6, 10, 10]] }

[[analysis]]
kind = "path"
name = "groove"
circle = { radius_mm = 100 }

[measured]
"#;

/// Path without load: an ellipse and three lobes.
fn path_um(a: f64) -> f64 {
    45.0 * (2.0 * a - 0.7).cos() + 18.0 * (3.0 * a + 0.4).cos()
}

/// What reverses, of a circle walked the way its angle grows.
fn reversal_um(a: f64) -> f64 {
    30.0 * (a - 0.3).sin().signum()
}

/// Noise of standard deviation 1 without pattern: twelve even numbers less six.
fn noise(seed: u64, k: usize) -> f64 {
    let draw = |n: u64| {
        let mut x = (seed << 40) ^ ((k as u64) << 8) ^ n;
        for _ in 0..3 {
            x = (x ^ (x >> 30))
                .wrapping_mul(0xbf58_476d_1ce4_e5b9)
                .wrapping_add(0x9e37_79b9_7f4a_7c15);
            x ^= x >> 27;
        }
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..12).map(draw).sum::<f64>() - 6.0
}

/// Files of the ball-bar; `turn` and `sign` bring angles of the circle to those of the files.
fn ballbar(folder: &Path, noise_um: f64, (turn, sign): (f64, f64)) {
    for run in 1..=2_u64 {
        let mut text = "# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n".to_owned();
        for (way, grows) in [("CCW", 1.0), ("CW", -1.0)] {
            for k in 0..720_usize {
                let f = TAU * k as f64 / 720.0;
                let a = turn + sign * f;
                let um = path_um(a)
                    + sign * grows * reversal_um(a)
                    + noise_um * noise(run * 2 + (grows > 0.0) as u64, k);
                let _ = writeln!(text, "{:.6},{um:.5},{way},{run}", f.to_degrees());
            }
        }
        std::fs::write(folder.join(format!("run{run}.csv")), text).unwrap();
    }
}

/// Outward deviation under load as the study predicts it at every degree, um: its table has base axes, y is cos, z sin.
fn load_um(folder: &Path) -> Vec<f64> {
    let (code, _, err) = armill(folder, &["run", ".", "--out", "bare"]);
    assert_eq!(code, 0, "{err}");
    let table = std::fs::read_to_string(folder.join("bare/groove.csv")).unwrap();
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| {
        names
            .iter()
            .position(|own| *own == name)
            .unwrap_or_else(|| panic!("{name} of {names:?}"))
    };
    let [y, z] = [column("deviation_y_case_1_um"), column("deviation_z_case_1_um")];
    let um = |(k, line): (usize, &str)| {
        let cells: Vec<&str> = line.split(',').collect();
        let [dy, dz] = [y, z].map(|at| cells[at].parse::<f64>().unwrap());
        let a = (k as f64).to_radians();
        a.cos() * dy + a.sin() * dz
    };
    lines.enumerate().map(um).collect()
}

/// A study with its experiment: `keys` in addition to the files, noise of both measurements in um.
fn experiment(noise_um: [f64; 2], keys: &str, (turn, sign): (f64, f64)) -> (tempfile::TempDir, Vec<f64>) {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let bare = STUDY.replace("[measured]\n", "");
    std::fs::write(at.join("study.toml"), bare).unwrap();
    let load = load_um(at);
    assert_eq!(load.len(), 360);
    ballbar(at, noise_um[0], (turn, sign));
    let mut part = "x_mm,y_mm\n".to_owned();
    for (k, load) in load.iter().enumerate() {
        let a = (k as f64).to_radians();
        let um = load + path_um(a) + reversal_um(a) + noise_um[1] * noise(9, k);
        let (r, f) = (100.0 + um * 1e-3, sign * (a - turn));
        // The part has any position on the table of the measuring machine.
        let _ = writeln!(part, "{:.7},{:.7}", 312.5 + r * f.cos(), -40.25 + r * f.sin());
    }
    std::fs::write(at.join("cmm.csv"), part).unwrap();
    let study = format!("{STUDY}part = \"cmm.csv\"\nballbar = [\"run1.csv\", \"run2.csv\"]\n{keys}");
    std::fs::write(at.join("study.toml"), study).unwrap();
    (folder, load)
}

fn reported(folder: &Path) -> Value {
    let (code, out, err) = armill(folder, &["budget", ".", "--json"]);
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

fn number(value: &Value, path: &str) -> f64 {
    value
        .pointer(path)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{path} of {value}"))
}

#[test]
fn an_experiment_without_noise_is_explained_completely_for_all_orientations_of_its_files() {
    let quarter = TAU / 4.0;
    for (keys, seen) in [
        ("", (0.0, 1.0)),
        ("zero_deg = 90\n", (quarter, 1.0)),
        ("zero_deg = 90\nmirrored = true\n", (quarter, -1.0)),
    ] {
        let (folder, load) = experiment([0.0, 0.0], keys, seen);
        let reported = reported(folder.path());
        // The load moves the centre by a third of a millimetre, and angles about it by 0.2 degrees: near a reversal a
        // sample or two differ.
        assert!(
            number(&reported, "/part/explained_percent") > 99.5,
            "{keys}: {reported}"
        );
        assert!(number(&reported, "/part/turns_as_good_percent") < 0.5, "{keys}");
        let waves = reported["part"]["waves"].as_array().unwrap();
        assert!(number(&waves[1], "/phase_difference_deg").abs() < 0.5);
        // The centre and the radius that came off are those of the load: the path without load has neither.
        let mean = load.iter().sum::<f64>() / 360.0;
        assert!((number(&reported, "/contributions/0/radius_um") - mean).abs() < 0.1);
        let name = |k: usize| reported["contributions"][k]["name"].as_str().unwrap().to_owned();
        assert_eq!(
            [name(1), name(2)],
            ["path without load, both directions", "reversal"]
        );
        // What is left of 45 cos 2a and 18 cos 3a: root of half of the squares.
        let rms = number(&reported, "/contributions/1/rms_um");
        assert!(
            (rms - (45.0_f64.hypot(18.0)) / 2.0_f64.sqrt()).abs() < 0.1,
            "{rms}"
        );
        // A square wave less its first harmonic, 4/pi of it, which a shifted centre is.
        let left = 30.0 * (1.0 - 8.0 / (std::f64::consts::PI * std::f64::consts::PI)).sqrt();
        assert!(
            (number(&reported, "/contributions/2/rms_um") - left).abs() < 0.3,
            "{reported}"
        );
    }
}

#[test]
fn noise_is_reported_as_scatter_and_explains_the_residual() {
    let (folder, _) = experiment([2.0, 3.0], "part_u_um = 3\n", (0.0, 1.0));
    let reported = reported(folder.path());
    assert!(
        (number(&reported, "/repeatability_um") - 2.0).abs() < 0.2,
        "{reported}"
    );
    let [explained, explainable] =
        ["/part/explained_percent", "/part/explainable_percent"].map(|path| number(&reported, path));
    assert!(
        explained > 98.0 && (explained - explainable).abs() < 0.6,
        "{explained} {explainable}"
    );
    assert!((number(&reported, "/part/residual/rms_um") - 3.2).abs() < 0.6);
    let plain = number(&reported, "/sums/load_um") + number(&reported, "/sums/unloaded_um");
    assert!((number(&reported, "/sums/plain_um") - plain).abs() < 1e-9);
}

#[test]
fn a_wrong_zero_is_detected_although_all_sizes_agree() {
    let (folder, _) = experiment([0.0, 0.0], "zero_deg = 45\nballbar_zero_deg = 0\n", (0.0, 1.0));
    let reported = reported(folder.path());
    assert!(number(&reported, "/part/explained_percent") < 20.0);
    let warned = reported["warnings"].to_string();
    assert!(warned.contains("zero_deg is wrong"), "{warned}");
}

#[test]
fn a_run_includes_the_comparison_in_its_report() {
    let (folder, _) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let at = folder.path();
    let (code, _, err) = armill(at, &["run", ".", "--out", "out"]);
    assert_eq!(code, 0, "{err}");
    let result: Value =
        serde_json::from_str(&std::fs::read_to_string(at.join("out/result.json")).unwrap()).unwrap();
    assert_eq!(result["measured"], reported(at));
    let report = std::fs::read_to_string(at.join("out/report.html")).unwrap();
    assert!(report.contains("Measurement and prediction"));
    for picture in ["groove-budget.svg", "groove-measured.svg", "groove-waves.svg"] {
        assert!(at.join("out").join(picture).exists(), "{picture}");
    }
    let (code, out, err) = armill(at, &["budget", ".", "--out", "budget"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("plain sum") && out.contains("explained "), "{out}");
    let table = std::fs::read_to_string(at.join("budget/budget.csv")).unwrap();
    assert_eq!(table.lines().filter(|line| !line.starts_with('#')).count(), 361);
    // Without measurements there is no budget.
    std::fs::write(at.join("study.toml"), STUDY.replace("[measured]\n", "")).unwrap();
    armill(at, &["run", ".", "--out", "bare"]);
    let bare: Value =
        serde_json::from_str(&std::fs::read_to_string(at.join("bare/result.json")).unwrap()).unwrap();
    assert!(bare["measured"].is_null());
    let (code, _, err) = armill(at, &["budget", "."]);
    assert!(code == 2 && err.contains("has no measurements"), "{err}");
}

#[test]
fn all_problems_are_reported_together_at_their_positions() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("bad.csv"), "angle_deg,radius_mm\n0,100\nx,100\n").unwrap();
    let refused = |keys: &str| {
        std::fs::write(at.join("study.toml"), format!("{STUDY}{keys}")).unwrap();
        let (code, out, err) = armill(at, &["budget", "."]);
        assert!(code == 2 && out.is_empty(), "{keys}: {code} {out}");
        err
    };
    let err = refused("analysis = \"grove\"\npart = \"bad.csv\"\nballbar = [\"none.csv\", \"nor.csv\"]\n");
    for said in [
        "no analysis called `grove`",
        "file none.csv not found",
        "file nor.csv not found",
        "bad.csv:3",
        "study.toml:15",
    ] {
        assert!(err.contains(said), "{said}: {err}");
    }
    assert!(refused("analysis = \"groove\"\n").contains("no measurement is named"));
    assert!(refused("part = \"none.csv\"\n").contains("cannot read"));
    assert!(refused("part = \"bad.csv\"\nradius_mm = -1\n").contains("radius_mm"));
    assert!(refused("part = \"bad.csv\"\ncentre = \"middle\"\n").contains("least-squares"));
    // An arc, and a few points.
    let arc = |count: usize| {
        (0..count).fold("angle_deg,radius_mm\n".to_owned(), |text, k| {
            format!("{text}{k},100\n")
        })
    };
    std::fs::write(at.join("arc.csv"), arc(80)).unwrap();
    assert!(refused("part = \"arc.csv\"\n").contains("at least a third of a turn"));
    std::fs::write(at.join("few.csv"), arc(5)).unwrap();
    assert!(refused("part = \"few.csv\"\n").contains("a run of 5 samples"));
    let line = STUDY.replace(
        "circle = { radius_mm = 100 }",
        "line = { from_mm = [0, 0], to_mm = [50, 0] }",
    );
    std::fs::write(
        at.join("study.toml"),
        format!("{line}analysis = \"groove\"\npart = \"arc.csv\"\n"),
    )
    .unwrap();
    let (code, _, err) = armill(at, &["check", "."]);
    assert!(code == 2 && err.contains("`groove` is not a circle"), "{err}");
}

/// The MH12 with backlash in all joints.
fn with_backlash() -> String {
    let mh12 =
        std::fs::read_to_string(crate::documents::repository().join("robots/yaskawa/mh12.toml")).unwrap();
    let play = "\nbacklash_deg = 0.01\nbacklash_u_deg = 0.001\nbacklash_source = \"paper\"\ncompliance_source = \"paper\"";
    mh12.replace("\ncompliance_source = \"paper\"", play)
}

#[test]
fn backlash_measured_by_the_ballbar_is_not_included_twice() {
    let (folder, plain_load) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let at = folder.path();
    let plain = reported(at);
    assert!(plain["without_load"].is_null());
    std::fs::write(at.join("arm.toml"), with_backlash()).unwrap();
    let study = std::fs::read_to_string(at.join("study.toml")).unwrap();
    let study = study.replace("robot = \"yaskawa/mh12\"", "robot = \"arm.toml\"");
    // What backlash adds along this circle, from runs with and without it.
    let (bare, measured) = study.split_once("[measured]").unwrap();
    std::fs::write(at.join("study.toml"), bare).unwrap();
    let with = load_um(at);
    let play: Vec<f64> = with
        .iter()
        .zip(&plain_load)
        .map(|(with, load)| with - load)
        .collect();
    assert!(play.iter().any(|um| um.abs() > 40.0), "{play:?}");

    // The same ball-bar and the same part as without backlash: the budget does not change.
    std::fs::write(at.join("study.toml"), &study).unwrap();
    let same = reported(at);
    for k in 0..3 {
        for key in ["largest_um", "rms_um", "explained_alone_percent"] {
            let path = format!("/contributions/{k}/{key}");
            assert!(
                (number(&same, &path) - number(&plain, &path)).abs() < 0.02,
                "{path}: {same}"
            );
        }
    }
    assert!(
        (number(&same, "/part/explained_percent") - number(&plain, "/part/explained_percent")).abs() < 0.01
    );
    // That ball-bar measured another robot, and the row for comparison shows it.
    assert!(number(&same, "/without_load/predicted_um") > 20.0);
    assert!(number(&same, "/without_load/explained_percent") < 50.0, "{same}");
    let (_, text, _) = armill(at, &["budget", "."]);
    assert!(
        text.contains("without load, predicted") && text.contains("not part of the sums"),
        "{text}"
    );

    // A ball-bar of the arm that is predicted: the row explains it whole.
    let mut file = "# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n".to_owned();
    for (k, um) in play.iter().enumerate() {
        let _ = writeln!(file, "{k},{um:.5},CCW,1");
    }
    std::fs::write(at.join("own.csv"), file).unwrap();
    let own = measured.replace("\"run1.csv\", \"run2.csv\"", "\"own.csv\"");
    std::fs::write(at.join("study.toml"), format!("{bare}[measured]{own}")).unwrap();
    let own = reported(at);
    // The table of the run has three decimals.
    assert!(number(&own, "/without_load/explained_percent") > 99.9, "{own}");

    // Without a ball-bar the prediction is used, as a separate contribution.
    let part = format!("{bare}[measured]\npart = \"cmm.csv\"\n");
    std::fs::write(at.join("study.toml"), part).unwrap();
    let alone = reported(at);
    assert_eq!(alone["contributions"][1]["name"], "path without load, predicted");
    assert_eq!(alone["contributions"][1]["origin"], "unloaded");
    assert!(
        (number(&alone, "/contributions/0/rms_um") - number(&plain, "/contributions/0/rms_um")).abs() < 0.02
    );
    assert!(
        alone["warnings"]
            .to_string()
            .contains("is predicted only from gravity"),
        "{alone}"
    );
    // Gaps known to a tenth: no more than a tenth of what they make, and less, for they are independent.
    let (rms, u) = (
        number(&alone, "/contributions/1/rms_um"),
        number(&alone, "/contributions/1/bias_u_um"),
    );
    assert!(u > 0.02 * rms && u < 0.1 * rms * 6f64.sqrt(), "{u} {rms}");
    assert!(alone["repeatability_um"].is_null());

    // And the repeatability of the data sheet is used for the scatter of runs.
    let study = std::fs::read_to_string(at.join("study.toml")).unwrap();
    let scattering = study.replacen("tolerance_um", "repeatability_mm = 0.08\ntolerance_um", 1);
    std::fs::write(at.join("study.toml"), scattering).unwrap();
    let scattering = reported(at);
    assert_eq!(scattering["contributions"][2]["name"], "repeatability");
    assert!((number(&scattering, "/contributions/2/scatter_um") - 80.0 / 3.616_088).abs() < 1e-4);
    assert!((number(&scattering, "/repeatability_um") - 80.0 / 3.616_088).abs() < 1e-4);
    let sum = |reported: &Value| {
        number(reported, "/sums/with_scatter_um") - number(reported, "/sums/as_functions_um")
    };
    assert!(sum(&scattering) > sum(&alone) + 20.0, "{scattering}");
}

#[test]
fn uncertainty_of_compliances_is_reported_for_the_load_and_is_less_without_centre_and_radius() {
    let (folder, _) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let at = folder.path();
    let free = number(&reported(at), "/contributions/0/bias_u_um");
    assert!(free > 0.05, "{free}");
    let study = std::fs::read_to_string(at.join("study.toml")).unwrap();
    // Twice the load, twice the uncertainty.
    let doubled = study.replace("cases_n = [[6, 10, 10]]", "cases_n = [[12, 20, 20]]");
    std::fs::write(at.join("study.toml"), &doubled).unwrap();
    let twice = number(&reported(at), "/contributions/0/bias_u_um");
    assert!((twice / free - 2.0).abs() < 1e-6, "{twice} {free}");
    let kept = format!("{study}centre = \"as-measured\"\nradius = \"as-measured\"\n");
    std::fs::write(
        at.join("study.toml"),
        kept.replace("ballbar = [\"run1.csv\", \"run2.csv\"]\n", "")
            .replace("part = \"cmm.csv\"", "ballbar = [\"run1.csv\"]"),
    )
    .unwrap();
    let kept = reported(at);
    assert!(number(&kept, "/contributions/0/bias_u_um") > 2.0 * free, "{kept}");
}

#[test]
fn harmonics_of_negligible_amplitude_have_neither_phase_nor_share() {
    let (folder, _) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let reported = reported(folder.path());
    let least = number(&reported, "/part/least_wave_um");
    for wave in reported["part"]["waves"].as_array().unwrap() {
        let is_there = number(wave, "/measured_um") >= least;
        assert_eq!(wave["explained_percent"].is_number(), is_there, "{wave}");
        assert_eq!(wave["measured_phase_deg"].is_number(), is_there, "{wave}");
        assert!(is_there || wave["phase_difference_deg"].is_null(), "{wave}");
    }
    // The reversal is a square wave: it has no even waves but those of the ellipse, and what angles off a sample leave.
    let waves = reported["part"]["waves"].as_array().unwrap();
    assert!(
        waves.iter().any(|wave| wave["explained_percent"].is_null()),
        "{reported}"
    );
    assert!(waves[1]["explained_percent"].is_number());
}

#[test]
fn joints_that_follow_late_are_a_contribution_where_no_ball_bar_measured_them() {
    let (folder, _) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let at = folder.path();
    let plain = reported(at);
    let study = std::fs::read_to_string(at.join("study.toml")).unwrap();
    let motion = "[motion]\nfeed_mm_per_min = 6000\nlag_ms = [20]\nlag_u_ms = [5]\n";
    let (bare, _) = study.split_once("[measured]").unwrap();
    let named = |given: &Value| -> Vec<String> {
        let all = given["contributions"].as_array().unwrap().iter();
        all.map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    // A ball-bar has them in what it measured.
    std::fs::write(
        at.join("study.toml"),
        study.replace("[measured]", &format!("{motion}[measured]")),
    )
    .unwrap();
    let with_ballbar = reported(at);
    assert_eq!(named(&with_ballbar), named(&plain));
    let without = format!("{bare}{motion}[measured]\npart = \"cmm.csv\"\n");
    std::fs::write(at.join("study.toml"), without).unwrap();
    let alone = reported(at);
    assert_eq!(
        named(&alone)[..2],
        ["deviation under load", "joints that follow late"]
    );
    for given in [&with_ballbar, &alone] {
        let rms = |given: &Value| number(given, "/contributions/0/rms_um");
        assert!((rms(given) - rms(&plain)).abs() < 0.02, "{given}");
    }
    // The radius shrinks by half the square of the angle per time constant: 100 mm/s, 100 mm, 20 ms.
    let shrunk = number(&alone, "/contributions/1/radius_um");
    let expected = 100e3 * (1.0 / 0.02f64.hypot(1.0) - 1.0);
    assert!((shrunk / expected - 1.0).abs() < 0.2, "{shrunk}");
    let (rms, u) = (
        number(&alone, "/contributions/1/rms_um"),
        number(&alone, "/contributions/1/bias_u_um"),
    );
    assert!((u / (0.25 * rms) - 1.0).abs() < 1e-6, "{u} {rms}");
}

#[test]
fn the_vibration_under_the_teeth_is_a_contribution_of_a_cut_with_one_wall() {
    let (folder, _) = experiment([0.0, 0.0], "", (0.0, 1.0));
    let at = folder.path();
    let study = std::fs::read_to_string(at.join("study.toml")).unwrap();
    let (bare, measured) = study.split_once("[measured]").unwrap();
    let mass = "tool = { mass = [{ at = \"tool\", mass_kg = 40, centre_mm = [0, 0, 0], source = \"own\" }], ";
    let of = |side: &str, vibration: &str| {
        let cut = format!(
            "[cut]\nmaterial = \"aluminium-7075-t6\"\naxial_depth_mm = 1\n{side}\nspindle_rpm = 3000\n\
             feed_mm_per_min = 600\ncutter = {{ diameter_mm = 10, flutes = 2 }}\n{vibration}"
        );
        let text = bare
            .replace("tool = { ", mass)
            .replace("[[analysis]]", &format!("{cut}[[analysis]]"));
        std::fs::write(at.join("study.toml"), format!("{text}[measured]{measured}")).unwrap();
        reported(at)
    };
    let named = |given: &Value| -> Vec<String> {
        let all = given["contributions"].as_array().unwrap().iter();
        all.map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    let name = "vibration under the teeth".to_owned();
    let down = "side = \"down\"\nradial_depth_mm = 2";
    let with = of(down, "[vibration]\n");
    assert_eq!(named(&with)[1], name);
    let rms = number(&with, "/contributions/1/rms_um");
    let u = number(&with, "/contributions/1/bias_u_um");
    assert!(rms > 0.0 && u > 0.0 && u.is_finite(), "{with}");
    assert_eq!(with["contributions"][1]["origin"], "load");
    assert!(!named(&of(down, "")).contains(&name));
    // Of a slot it is not known which wall was measured.
    assert!(!named(&of("side = \"slot\"", "[vibration]\n")).contains(&name));
}
