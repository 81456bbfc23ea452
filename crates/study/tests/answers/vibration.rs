//! The vibration at points: lowest mode and stable depth of cut.

use std::path::Path;

use armill_core::dynamics::{Mode, release};
use armill_core::load::drilling::Drilling;
use armill_core::nalgebra::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};
use armill_core::stability::{CutOfAnyDepth, StabilityLobes};
use armill_core::units::from_deg;
use armill_core::watch::Watch;
use armill_study::analysis::Subject;
use armill_study::file::resolve::read;
use armill_study::live::{StudyText, table_csv};

use crate::{PLATE, study};

/// All mass of the arm in one point, at the tip.
const MASS_KG: f64 = 40.0;
const AT_THE_TIP: &str = "[tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\n[[tool.mass]]\nat = \"tool\"\nmass_kg = 40\ncentre_mm = [0, 0, 0]\nsource = \"own\"\n";
const CUT: &str = "[cut]\nmaterial = \"aluminium-7075-t6\"\naxial_depth_mm = 1\nside = \"slot\"\nspindle_rpm = 9000\nfeed_mm_per_min = 1800\ncutter = { diameter_mm = 10, flutes = 2 }\n";

/// The rows of the table of the only analysis of a study: heads, then values.
fn rows(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let given = StudyText {
        shown: "study.toml",
        folder: Path::new("."),
        bytes: text.as_bytes(),
    };
    let csv = table_csv(given, None, Watch::NONE).unwrap_or_else(|error| panic!("{error}"));
    let csv = String::from_utf8(csv).unwrap();
    let mut rows = csv
        .lines()
        .filter(|row| !row.starts_with('#'))
        .map(|row| row.split(',').map(str::to_owned).collect::<Vec<String>>());
    (rows.next().unwrap(), rows.collect())
}

fn column(heads: &[String], key: &str) -> usize {
    let found = heads.iter().position(|head| head.split(' ').next() == Some(key));
    found.unwrap_or_else(|| panic!("{key} in {heads:?}"))
}

/// Modes of the mass at the tip, on springs with this compliance, in axes turned by `turn`.
fn modes_of_a_mass_at_the_tip(compliance: &Matrix6<f64>, turn: &Rotation3<f64>) -> Vec<Mode> {
    let translation: Matrix3<f64> = compliance.fixed_view::<3, 3>(0, 0).into();
    let eigen = translation.symmetric_eigen();
    let mode = |k: usize| {
        let along = turn * Vector3::from(eigen.eigenvectors.column(k)) / MASS_KG.sqrt();
        Mode {
            angular_frequency: 1.0 / (MASS_KG * eigen.eigenvalues[k]).sqrt(),
            damping_ratio: 0.02,
            shape: Vector6::new(along.x, along.y, along.z, 0.0, 0.0, 0.0),
        }
    };
    (0..3).map(mode).collect()
}

#[test]
fn a_mass_at_the_tip_vibrates_as_its_compliance_says_and_cuts_as_deep_as_its_modes_permit() {
    let text = format!("{PLATE}{AT_THE_TIP}[vibration]\ndamping_ratio = 0.02\nfeed_deg = 30\n{CUT}");
    let (heads, rows) = rows(&text);
    let (mode, depth) = (
        column(&heads, "lowest_mode_hz"),
        column(&heads, "stable_depth_mm"),
    );
    let joints = column(&heads, "joint_S_deg");
    let study = study(&text);
    let Subject::Map(sheet) = &study.analyses[0].subject else {
        panic!("a map")
    };
    let setting = &sheet.setting;
    let on_plane = setting.vibration.as_ref().unwrap().on_plane.unwrap();
    // The feed lies in the plane, 30 deg from y' towards z'; the tool axis is its normal.
    let axes = on_plane.base_from_feed;
    let part = setting.plane.base_from_part.rotation;
    let expected = part * Vector3::new(-from_deg(30.0).cos(), from_deg(30.0).sin(), 0.0);
    assert!((axes * Vector3::x() - expected).norm() < 1e-12);
    assert!((axes * Vector3::z() - part * Vector3::z()).norm() < 1e-12);
    let mut compared = 0;
    for row in rows.iter().filter(|row| !row[mode].is_empty()).step_by(7) {
        let q: Vec<f64> = (0..6)
            .map(|k| from_deg(row[joints + k].parse::<f64>().unwrap()))
            .collect();
        let compliance = setting.compliance_at(&study.robot.robot, &q);
        let modes = modes_of_a_mass_at_the_tip(&compliance, &axes.inverse());
        let lowest = modes.iter().map(Mode::frequency_hz).fold(f64::INFINITY, f64::min);
        // Decimals of the table.
        assert!(
            (row[mode].parse::<f64>().unwrap() / lowest - 1.0).abs() < 1e-3,
            "{lowest} {row:?}"
        );
        let cut = CutOfAnyDepth::new(&on_plane.milling);
        let lobes = StabilityLobes::new(&modes, &cut, 0.02).unwrap();
        let limit = lobes
            .at_speed(on_plane.spindle)
            .map_or(20.0, |limit| limit.depth * 1e3);
        let given: f64 = row[depth].parse().unwrap();
        assert!((given - limit).abs() < 1e-3 * limit + 1e-3, "{given} {limit}");
        compared += 1;
    }
    assert!(compared >= 5, "{compared} of {}", rows.len());
}

#[test]
fn a_path_has_the_columns_too_and_a_study_without_the_table_has_none() {
    let path =
        "[[analysis]]\nkind = \"path\"\nname = \"s\"\nrectangle = { size_mm = [120, 80] }\nstep_mm = 20\n";
    let (heads, rows_of_path) = rows(&format!("{PLATE}{AT_THE_TIP}{CUT}[vibration]\n{path}"));
    let (mode, depth) = (
        column(&heads, "lowest_mode_hz"),
        column(&heads, "stable_depth_mm"),
    );
    assert!(rows_of_path.len() > 10);
    for row in &rows_of_path {
        let [mode, depth] = [mode, depth].map(|k| row[k].parse::<f64>().unwrap());
        assert!(
            mode > 1.0 && mode < 100.0 && depth > 0.0 && depth <= 20.0,
            "{row:?}"
        );
    }
    let (heads, _) = rows(&format!("{PLATE}{AT_THE_TIP}{CUT}{path}"));
    assert!(
        !heads
            .iter()
            .any(|head| head.contains("stable_depth") || head.contains("lowest_mode"))
    );
}

#[test]
fn a_drill_springs_forward_by_the_release_of_its_thrust() {
    let holes = "[[analysis]]\nkind = \"holes\"\nname = \"h\"\nholes = { at_mm = [[-50, 0, 0], [60, 30, 0]], drill = { material = \"aluminium-7075-t6\", diameter_mm = 10, feed_mm_per_min = 600, spindle_rpm = 3000 } }\n";
    let text = format!("{PLATE}{AT_THE_TIP}[vibration]\ndamping_ratio = 0.02\n{holes}");
    let (heads, rows) = rows(&text);
    let at = |key: &str| column(&heads, key);
    let study = study(&text);
    let Subject::Holes(analysis) = &study.analyses[0].subject else {
        panic!("holes")
    };
    let drill = &analysis.path.drill.as_ref().unwrap().drill;
    // 10 mm/s at 50 turns a second.
    let drilling = Drilling {
        diameter: 0.01,
        point_angle: drill.point_angle,
        feed: 0.2e-3,
        law: drill.law,
    };
    let thrust = drilling.force().unwrap().thrust;
    for (index, row) in rows.iter().enumerate() {
        let number = |key: &str| row[at(key)].parse::<f64>().unwrap();
        let q: Vec<f64> = (0..6)
            .map(|k| from_deg(row[at("joint_S_deg") + k].parse::<f64>().unwrap()))
            .collect();
        let compliance = analysis.path.setting.compliance_at(&study.robot.robot, &q);
        let modes = modes_of_a_mass_at_the_tip(&compliance, &Rotation3::identity());
        let forward = analysis.path.track.base_from_feed(index) * -Vector3::z();
        let released = release(&modes, &forward, thrust);
        let speed = 10.0 + released.peak_speed * 1e3;
        assert!(
            (number("breakthrough_speed_mm_per_s") / speed - 1.0).abs() < 1e-3,
            "{speed} {row:?}"
        );
        assert!((number("breakthrough_overshoot_um") / (released.overshoot * 1e6) - 1.0).abs() < 1e-3);
        // With this part of the feed, the drill has 20 mm/s.
        let part = number("breakthrough_feed");
        assert!(part > 0.0 && part < 1.0, "{part}");
        let slower = Drilling {
            feed: part * 0.2e-3,
            ..drilling
        };
        let slower = slower.force().unwrap().thrust / thrust * released.peak_speed * 1e3 + part * 10.0;
        assert!((slower - 20.0).abs() < 0.01, "{slower}");
    }
    assert_eq!(rows.len(), 2);
}

#[test]
fn what_cannot_vibrate_or_be_read_is_reported_at_its_key() {
    let refused = |tables: &str| {
        let text = format!("{PLATE}{tables}");
        let found = read("study.toml", Path::new("."), text.as_bytes());
        found.err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(refused("[vibration]\n").contains("nothing vibrates"));
    let missing = refused("[vibration]\ntool_modes = \"none.toml\"\n");
    assert!(
        missing.contains("none.toml") && missing.contains("study.toml:"),
        "{missing}"
    );
    let still = CUT.replace("spindle_rpm = 9000\n", "");
    let still = refused(&format!("{AT_THE_TIP}[vibration]\n{still}"));
    assert!(still.contains("needs the spindle speed and the feed"), "{still}");
    assert!(refused(&format!("{AT_THE_TIP}[vibration]\ndamping_ratio = 2\n")).contains("damping_ratio"));
}
