//! The vibration at points: lowest mode and stable depth of cut.

use std::path::Path;

use armill_core::dynamics::{Mode, release};
use armill_core::load::drilling::Drilling;
use armill_core::nalgebra::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};
use armill_core::stability::{CutOfAnyDepth, Forced, StabilityLobes, WallSide};
use armill_core::units::from_deg;
use armill_core::watch::Watch;
use armill_study::analysis::path::vibration::cuts;
use armill_study::analysis::vibration::wall::WallErrors;
use armill_study::analysis::{AnalysisData, Subject};
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::{Study, read};
use armill_study::joint_order::shown_positions;
use armill_study::live::{LobesQuestion, PathCache, PoseTarget, StudyText, table_csv};
use armill_study::stability::{self, ArmPosture, Options, Question, evaluate};

use crate::without_masses::without_masses;
use crate::{PLATE, answered, found};

/// All mass of the arm in one point, at the tip.
const MASS_KG: f64 = 40.0;
const AT_THE_TIP: &str = "[tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\n[[tool.mass]]\nat = \"tool\"\nmass_kg = 40\ncentre_mm = [0, 0, 0]\nsource = \"own\"\n";
const CUT: &str = "[cut]\nmaterial = \"aluminium-7075-t6\"\naxial_depth_mm = 1\nside = \"slot\"\nspindle_rpm = 9000\nfeed_mm_per_min = 1800\ncutter = { diameter_mm = 10, flutes = 2 }\n";

/// The study in this text with an arm whose only mass is that of its tool.
fn study(text: &str) -> Study {
    crate::study(&without_masses(text))
}

/// The rows of the table of the only analysis of a study: heads, then values.
fn rows(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = without_masses(text);
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
        let text = without_masses(&format!("{PLATE}{tables}"));
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

const RECTANGLE: &str =
    "[[analysis]]\nkind = \"path\"\nname = \"s\"\nrectangle = { size_mm = [120, 80] }\nstep_mm = 20\n";

#[test]
fn the_summary_of_a_map_has_the_least_of_its_column_and_where_it_is() {
    let study = study(&format!(
        "{PLATE}{AT_THE_TIP}[vibration]\ndamping_ratio = 0.02\nfeed_deg = 30\n{CUT}"
    ));
    let done = found(&study);
    let answer = answer(&study, &done);
    let summary = answer.maps[0].vibration.as_ref().unwrap();
    let cut = summary.cut.as_ref().unwrap();
    let [rows] = &done[0].rows()[..] else {
        panic!("a map")
    };
    let points = &rows.vibration.unwrap().points;
    let with_cut = || {
        points
            .iter()
            .enumerate()
            .filter_map(|(k, point)| Some((k, point.as_ref()?.cut?)))
    };
    let (at, least) = with_cut()
        .min_by(|a, b| a.1.stable_depth().total_cmp(&b.1.stable_depth()))
        .unwrap();
    assert!((cut.stable_depth_mm.unwrap() / (least.stable_depth() * 1e3) - 1.0).abs() < 1e-9);
    assert_eq!(cut.at_mm, rows.at_mm[at]);
    assert_eq!((cut.points, cut.depth_mm), (with_cut().count(), 1.0));
    assert!((cut.spindle_rpm - 9000.0).abs() < 1e-9);
    assert_eq!(cut.engagement, "cut");
    let hz: Vec<f64> = points
        .iter()
        .flatten()
        .map(|point| point.lowest.unwrap() / std::f64::consts::TAU)
        .collect();
    let [low, high] = summary.lowest_mode_hz.unwrap();
    assert_eq!(low, hz.iter().copied().fold(f64::INFINITY, f64::min));
    assert_eq!(high, hz.iter().copied().fold(0.0, f64::max));
    assert!(answer.answer.contains(&cut.verdict), "{}", answer.answer);
}

#[test]
fn the_summary_of_a_path_is_that_of_the_stability_command_in_the_same_posture() {
    let text = format!("{PLATE}{AT_THE_TIP}{CUT}[vibration]\n{RECTANGLE}");
    let study = study(&text);
    let done = found(&study);
    let answer = answer(&study, &done);
    let cut = answer.paths[0].vibration.as_ref().unwrap().cut.as_ref().unwrap();
    let AnalysisData::Path(_, path) = &done[0].found else {
        panic!("a path")
    };
    let index = done[0].vibration[0].worst.as_ref().unwrap().index;
    let robot = &study.robot.robot;
    let posture = ArmPosture {
        joints_deg: shown_positions(robot, path.along.answers.joints_at(index)),
        point: index + 1,
    };
    let question = Question::of_study(&study, None, (None, Some(&posture)), &Options::default()).unwrap();
    let command = stability::answer(&question, &evaluate(&question).unwrap());
    let same = |a: Option<f64>, b: Option<f64>| (a.unwrap() / b.unwrap() - 1.0).abs() < 1e-9;
    assert!(same(cut.stable_depth_mm, command.zeroth_order_depth_mm));
    assert!(same(cut.semi_discretisation_depth_mm, command.stable_depth_mm));
    assert!(same(cut.probability_stable, command.probability_stable));
    assert_eq!(cut.is_stable, command.is_stable);
    // The page, with and without a path that is kept.
    let light = without_masses(&text);
    let given = StudyText {
        shown: "study.toml",
        folder: Path::new("."),
        bytes: light.as_bytes(),
    };
    let place = |index: usize| LobesQuestion {
        analysis: None,
        at: PoseTarget {
            point: Some(index),
            ..PoseTarget::default()
        },
        joints_deg: posture.joints_deg.clone(),
    };
    let page = PathCache::default()
        .lobes(given, &place(index), Watch::NONE)
        .unwrap();
    let page = page.stability.unwrap();
    assert!(same(page.zeroth_order_depth_mm, command.zeroth_order_depth_mm));
    assert!(same(page.stable_depth_mm, command.stable_depth_mm));
    assert!(same(page.probability_stable, command.probability_stable));
    let beyond = PathCache::default().lobes(given, &place(9999), Watch::NONE);
    assert!(
        beyond
            .unwrap_err()
            .to_string()
            .contains("point 9999 does not exist")
    );
    // Vibration at this point: the larger of both axes at least, both together at most.
    let point = done[0].vibration[0].points[index].unwrap();
    let forced = point.cut.unwrap().forced.unwrap();
    let [x, y, _] = command.vibration.amplitude_um;
    let amplitude = forced.amplitude * 1e6;
    assert!(
        amplitude >= 0.999 * x.max(y) && amplitude <= 2.001 * x.hypot(y),
        "{amplitude} {x} {y}"
    );
    // Both walls of a slot; the mean across the feed is in the error of the command, and not in that of the point.
    let wall = forced.wall.unwrap() * 1e6;
    let mean = command.vibration.mean_um[1];
    let expected = command.vibration.walls.iter().flat_map(|wall| {
        let sign = if wall.side == "left" { 1.0 } else { -1.0 };
        [wall.least_um, wall.greatest_um].map(|um| um - sign * mean)
    });
    let largest = expected.map(f64::abs).fold(0.0, f64::max);
    assert!((wall.abs() / largest - 1.0).abs() < 1e-9, "{wall} {largest}");
    let (heads, rows) = rows(&text);
    let column = |key: &str| rows[index][column(&heads, key)].parse::<f64>().unwrap();
    assert!((column("vibration_amplitude_um") - amplitude).abs() < 1e-3);
    assert!((column("surface_error_vibration_um") - wall).abs() < 1e-3);
}

#[test]
fn a_cut_that_chatters_is_warned_of_and_does_not_meet_a_demand() {
    let deep = CUT.replace("axial_depth_mm = 1\n", "axial_depth_mm = 15\n");
    let text = |demand: &str| format!("{PLATE}{AT_THE_TIP}{deep}[vibration]\n{demand}{RECTANGLE}");
    let wide = |text: &str| text.replace("tolerance_um = 60", "tolerance_um = 100000");
    let of = |text: &str| answered(&study(&wide(text)));
    let free = of(&text(""));
    let cut = free.paths[0].vibration.as_ref().unwrap().cut.as_ref().unwrap();
    assert!(!cut.is_stable && cut.utilisation > 1.0, "{}", cut.verdict);
    let warning = free
        .warnings
        .iter()
        .find(|warning| warning.starts_with("s: the cut chatters"));
    assert!(warning.unwrap().contains(&cut.verdict));
    assert!(free.meets_tolerance());
    assert!(!of(&text("must_be_stable = true\n")).meets_tolerance());
    let thin =
        of(&text("must_be_stable = true\n").replace("axial_depth_mm = 15\n", "axial_depth_mm = 0.01\n"));
    assert!(thin.meets_tolerance(), "{:?}", thin.warnings);
    assert!(!thin.warnings.iter().any(|warning| warning.contains("chatter")));
}

#[test]
fn a_cut_that_is_stable_only_within_its_uncertainty_may_chatter() {
    let at = |depth: f64| {
        let cut = CUT.replace("axial_depth_mm = 1\n", &format!("axial_depth_mm = {depth}\n"));
        answered(&study(&format!(
            "{PLATE}{AT_THE_TIP}{cut}[vibration]\n{RECTANGLE}"
        )))
    };
    let of = |answer: &StudyAnswer| answer.paths[0].vibration.clone().unwrap().cut.unwrap();
    let found = of(&at(1.0));
    let least = found
        .stable_depth_mm
        .unwrap()
        .min(found.semi_discretisation_depth_mm.unwrap());
    let near = at(0.97 * least);
    let cut = of(&near);
    assert!(
        cut.is_stable && cut.probability_stable.unwrap() < 0.977,
        "{cut:?}"
    );
    assert!(
        near.warnings
            .iter()
            .any(|warning| warning.starts_with("s: the cut may chatter"))
    );
}

#[test]
fn the_error_of_a_wall_changes_with_the_damping_as_that_of_the_modes_of_a_mass_at_the_tip() {
    let up = CUT.replace("side = \"slot\"\n", "side = \"up\"\nradial_depth_mm = 3\n");
    let study = study(&format!("{PLATE}{AT_THE_TIP}{up}[vibration]\n{RECTANGLE}"));
    let done = found(&study);
    let AnalysisData::Path(path, result) = &done[0].found else {
        panic!("a path")
    };
    let (robot, answers) = (&study.robot.robot, &result.along.answers);
    let cuts = cuts(path, &path.track, &result.along.load).unwrap();
    let walls = WallErrors::of(robot, &path.setting, answers, &cuts).unwrap();
    assert_eq!(walls.side, WallSide::Left);
    // Three modes: frequency, damping ratio and stiffness of each.
    assert_eq!((walls.changes.len(), walls.errors.len()), (9, path.track.len()));
    for index in (0..path.track.len()).step_by(5) {
        let axes = path.track.base_from_feed(index);
        let compliance = path.setting.compliance_at(robot, answers.joints_at(index));
        let mut modes = modes_of_a_mass_at_the_tip(&compliance, &axes.inverse());
        modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
        let cut = (cuts.at)(index).unwrap();
        let error = |damping: [f64; 3]| {
            let each = modes.iter().zip(damping);
            let modes: Vec<Mode> = each
                .map(|(mode, damping_ratio)| Mode {
                    damping_ratio,
                    ..*mode
                })
                .collect();
            let forced = Forced::new(&modes, &cut.milling, cut.spindle).unwrap();
            let (wall, mean) = (forced.surface_error(WallSide::Left), forced.mean().y);
            0.5 * (wall.least + wall.greatest) - mean
        };
        // Assumed: 3 %, with half of it as its standard uncertainty.
        let size = error([0.03; 3]).abs();
        assert!((walls.errors[index] - error([0.03; 3])).abs() < 1e-6 * size);
        let changed = 0.5 * (error([0.045, 0.03, 0.03]) - error([0.015, 0.03, 0.03]));
        assert!(
            (walls.changes[1][index] - changed).abs() < 1e-6 * size,
            "{changed}"
        );
    }
    // Both walls of a slot: which of them is measured is not known.
    let slot = self::study(&format!("{PLATE}{AT_THE_TIP}{CUT}[vibration]\n{RECTANGLE}"));
    let Subject::Path(path) = &slot.analyses[0].subject else {
        panic!("a path")
    };
    let done = found(&slot);
    let AnalysisData::Path(_, result) = &done[0].found else {
        panic!("a path")
    };
    let cuts = armill_study::analysis::path::vibration::cuts(path, &path.track, &result.along.load).unwrap();
    assert!(WallErrors::of(&slot.robot.robot, &path.setting, &result.along.answers, &cuts).is_none());
}

#[test]
fn in_a_stock_the_engagement_is_that_of_the_stock() {
    // The rectangle is 120 x 80 mm; the stock ends before its right side, and the tool is 0.5 mm deep in it.
    let stock = CUT.replace(
        "cutter = {",
        "stock = { from_mm = [-100, -100, -0.5], to_mm = [40, 100, 0] }\ncutter = {",
    );
    let program = "[[analysis]]\nkind = \"path\"\nname = \"s\"\nprogram = { file = \"slot.nc\" }\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("slot.nc"),
        "G21 G90\nG0 X-60 Y0 Z-0.5\nG1 X60 Y0 F1800\n",
    )
    .unwrap();
    let text = format!("{PLATE}{AT_THE_TIP}{stock}[vibration]\n{program}");
    let study = read("study.toml", folder.path(), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let done = found(&study);
    let answer = answer(&study, &done);
    let cut = answer.paths[0].vibration.as_ref().unwrap().cut.as_ref().unwrap();
    assert_eq!(cut.engagement, "stock");
    assert!((cut.depth_mm - 0.5).abs() < 1e-6, "{cut:?}");
    let points = &done[0].vibration[0].points;
    assert!(cut.points > 0 && cut.points < points.len(), "{cut:?}");
    // What is permitted is stable: at each point at most its stable depth.
    let AnalysisData::Path(_, result) = &done[0].found else {
        panic!("a path")
    };
    let limits = result.limits.as_ref().unwrap();
    let mut compared = 0;
    for limit in &limits.points {
        let (Some(permitted), Some(here)) = (limit.cut, points[limit.index].unwrap().cut) else {
            continue;
        };
        let stable = here.limit.map_or(f64::INFINITY, |limit| limit.depth);
        assert!(
            permitted.depth.value() <= stable * (1.0 + 1e-9),
            "{permitted:?} {here:?}"
        );
        compared += 1;
    }
    assert!(compared > 3, "{compared}");
}
