//! Studies with more than drive springs: the effect of each part, its report, and errors.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::map::PlaneMap;
use armill_core::nalgebra::Vector3;
use armill_core::watch::Watch;
use armill_study::analysis::AnalysisData;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::{Study, read};
use armill_study::run::run;

#[path = "shared/without_masses.rs"]
mod without_masses;
use without_masses::without_masses;

/// 5 x 5 points in front of an MH12; tool along base x, tables can be appended.
const PLATE: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
load_dependent = false
plane = { centre_mm = [900, 0, 800], tilt_deg = 0, half_size_mm = 200, step_mm = 100 }
load = { cases_n = [[3, 5, -5]] }
[tool]
flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0]
"#;

const CUTTER: &str = "stick_out_mm = 50\ndiameter_mm = 10\nmodulus_gpa = 600\n";

const SPINDLE: &str = r#"
[[tool.mass]]
at = "flange"
mass_kg = 8
centre_mm = [0, 0, 60]
source = "weighed"
"#;

fn study(text: &str) -> Study {
    read("study.toml", Path::new("."), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn map(study: &Study) -> PlaneMap {
    match run(study, Watch::NONE).unwrap().remove(0).found {
        AnalysisData::Map(_, map) => map,
        _ => panic!("the study has one map"),
    }
}

fn answered(study: &Study) -> StudyAnswer {
    answer(study, &run(study, Watch::NONE).unwrap())
}

fn refused(text: &str) -> String {
    match read("study.toml", Path::new("."), text.as_bytes()) {
        Ok(_) => panic!("taken:\n{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_cutter_adds_its_bending_across_the_tool_axis() {
    let (plain, bent) = (map(&study(PLATE)), map(&study(&format!("{PLATE}{CUTTER}"))));
    // F L^3 / (3 E I), I = pi (10 mm)^4 / 64 = 4.9087e-10 m^4: 1.4147e-7 m/N, across base x.
    let c = 0.05_f64.powi(3) / (3.0 * 6e11 * 4.908_738_521e-10);
    let bending = Vector3::new(0.0, 5.0, -5.0) * c;
    for (a, b) in plain.answers.deviations.iter().zip(&bent.answers.deviations) {
        assert!((b - a - bending).norm() < 1e-9 * bending.norm(), "{a} {b}");
    }
}

#[test]
fn the_result_reports_the_active_parts_and_the_contributors() {
    let plain = answered(&study(PLATE));
    assert_eq!(plain.maps[0].setting.model, ["drive springs"]);
    assert_eq!(plain.maps[0].setting.contributors, ["S", "L", "U", "R", "B", "T"]);
    let flange = "[[tool.spring]]\nat = \"flange\"\nabout = \"x\"\ncompliance_rad_per_n_m = 1e-6\nsource = \"guess\"\n";
    let reference = "[gravity]\nreference_joints_deg = [0, 0, 0, 0, 0, 0]\n";
    let text = format!("{PLATE}{CUTTER}{flange}{SPINDLE}{reference}")
        .replace("load_dependent = false", "load_dependent = true");
    let full = answered(&study(&text));
    let setting = &full.maps[0].setting;
    assert_eq!(
        setting.contributors,
        ["S", "L", "U", "R", "B", "T", "flange", "tool"]
    );
    assert_eq!(
        setting.model,
        [
            "drive springs",
            "3 further springs",
            "gravity, relative to the posture where the tool was set",
            "load-dependent stiffness"
        ]
    );
    let worst = full.maps[0].worst.as_ref().unwrap();
    let sum: f64 = worst.joint_share_um.iter().sum();
    assert_eq!(worst.joint_share_um.len(), 8);
    // To first order of turns of some 1e-4 rad.
    assert!(
        (sum / worst.in_plane_um - 1.0).abs() < 1e-2,
        "{sum} of {}",
        worst.in_plane_um
    );
}

#[test]
fn gravity_is_zero_at_the_reference_position() {
    let plain = answered(&study(PLATE));
    let there = plain.maps[0].worst.as_ref().unwrap();
    let reference = format!("[gravity]\nreference_joints_deg = {:?}\n", there.joints_deg);
    let weighed = map(&study(&format!("{PLATE}{SPINDLE}{reference}")));
    let (plain, mut same, mut moved) = (map(&study(PLATE)), 0, 0);
    for (a, b) in plain.answers.deviations.iter().zip(&weighed.answers.deviations) {
        // Degrees and back: some 1e-15 rad of a sag that changes by a millimetre a radian.
        same += usize::from((a - b).norm() < 1e-13);
        moved += usize::from((a - b).norm() > 1e-6);
    }
    assert_eq!(same, 1);
    assert!(moved > 10, "{moved}");
}

#[test]
fn known_masses_without_gravity_are_reported_and_change_nothing() {
    let given = answered(&study(&format!("{PLATE}{SPINDLE}")));
    assert!(
        given
            .warnings
            .iter()
            .any(|w| w.contains("1 mass is known, but gravity is neglected"))
    );
    let (plain, weighed) = (map(&study(PLATE)), map(&study(&format!("{PLATE}{SPINDLE}"))));
    assert_eq!(plain.answers.deviations, weighed.answers.deviations);
}

#[test]
fn load_dependence_is_a_small_correction_for_small_loads() {
    let text = PLATE.replace("load_dependent = false", "load_dependent = true");
    let (plain, loaded) = (map(&study(PLATE)), map(&study(&text)));
    for (a, b) in plain.answers.deviations.iter().zip(&loaded.answers.deviations) {
        let apart = (a - b).norm() / a.norm();
        assert!(apart > 1e-7 && apart < 1e-3, "{apart}");
    }
}

#[test]
fn an_unstable_load_is_counted_by_its_reason() {
    let text = PLATE
        .replace("load_dependent = false", "load_dependent = true")
        .replace("[3, 5, -5]", "[-1e6, 0, -1e6]");
    let given = answered(&study(&text));
    let (map, counts) = (&given.maps[0], given.maps[0].counts);
    assert_eq!(counts.unstable, 25);
    assert!(map.worst.is_none() && map.grid.in_plane_um.iter().all(Option::is_none));
    assert_eq!(
        (map.grid.flags[0].reason.as_str(), map.grid.flags[0].points.len()),
        ("unstable", 25)
    );
}

#[test]
fn what_makes_no_model_is_refused_with_its_place() {
    let spring = "[[tool.spring]]\nat = \"flange\"\nabout = \"x\"\ncompliance_rad_per_n_m = 1e-6\nsource = \"guess\"\n";
    let gravity = "[gravity]\nreference_joints_deg = [0, 0, 0, 0, 0, 0]\n";
    for (text, said) in [
        (
            without_masses(&format!("{PLATE}{gravity}")),
            "gravity has no effect",
        ),
        (
            format!("{PLATE}{SPINDLE}{}", gravity.replace("0, 0]", "0]")),
            "5 joint positions for the 6 joints",
        ),
        (
            format!("{PLATE}{SPINDLE}{gravity}direction = [0, 0, 0]\n"),
            "the direction of gravity has zero length",
        ),
        (
            format!("{PLATE}stick_out_mm = 50\n"),
            "requires stick-out, diameter and material",
        ),
        (
            format!("{PLATE}stick_out_mm = 50\ndiameter_mm = 10\n"),
            "either a `material` or a `modulus_gpa`",
        ),
        (
            format!("{PLATE}{}", spring.replace("flange", "elbow")),
            "`elbow` is not a part of the arm",
        ),
        (
            format!("{PLATE}{}", spring.replace("about", "along")),
            "the unit of the compliance does not fit the axis",
        ),
        (
            format!("{PLATE}{}", spring.replace("1e-6", "-1e-6")),
            "compliance_rad_per_n_m",
        ),
        (format!("{PLATE}{}", SPINDLE.replace("= 8", "= -8")), "mass_kg"),
    ] {
        let problems = refused(&text);
        assert!(problems.contains(said), "no `{said}` in:\n{problems}");
        assert!(problems.contains("study.toml:"), "no place in:\n{problems}");
    }
}
