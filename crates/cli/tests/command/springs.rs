//! `armill pose` and `armill robots` with more than drive springs.

use crate::cell::{Cell, LEVER, number, numbers};

/// A base that turns about z, and a mass at the end of the lever.
const BODY: &str = r#"
[[spring]]
at = "base"
about = "z"
compliance_rad_per_n_m = 1e-6
compliance_u_rad_per_n_m = 1e-7
source = "made-up"
[[mass]]
at = "flange"
mass_kg = 20
centre_mm = [0, 0, 0]
source = "made-up"
"#;

fn with_body() -> Cell {
    let cell = Cell::new();
    // The slide is rigid here: 600 kN would shorten the lever by it.
    let rigid = LEVER.replace("compliance_um_per_n = 0.02", "compliance_um_per_n = 0");
    cell.file("lever.toml", format!("{rigid}{BODY}"));
    cell
}

const STRETCHED: [&str; 4] = ["pose", "lever.toml", "--joints-deg", "0,0"];

#[test]
fn a_spring_of_the_base_has_its_own_contribution() {
    let cell = with_body();
    let push = [&STRETCHED[..], &["--wrench-n", "0,10,0"]].concat();
    let said = cell.armill(&push).fine();
    // c L^2 F: 2e-6 x 0.25 x 10 = 5 um by the drive, half of it by the base.
    assert!(
        said.out.contains("by joint    A 5.00  B 0.00  base 2.50 µm"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("model: drive springs; 1 further spring"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("1 mass is known, but gravity is neglected"),
        "{}",
        said.out
    );
    let answer = cell.armill(&[&push[..], &["--json"]].concat()).fine().json();
    assert_eq!(answer["contributors"].as_array().unwrap().len(), 3);
    let posture = &answer["postures"][0];
    assert!((numbers(&posture["deviation_um"])[1] - 7.5).abs() < 1e-9);
    // Ten per cent of the base's share.
    assert!((numbers(&posture["deviation_u_um"])[1] - 0.25).abs() < 1e-9);
    assert!(posture["loaded_compliance"].is_null() && posture["unstable"].is_null());
}

#[test]
fn gravity_counts_against_the_pose_where_the_tool_was_set() {
    let cell = Cell::new();
    let tilting = BODY.replace("at = \"base\"\nabout = \"z\"", "at = \"A\"\nabout = \"y\"");
    cell.file("lever.toml", format!("{LEVER}{tilting}"));
    let deviation_z = |reference: &str| {
        let arguments = [
            "--wrench-n",
            "0,0,0",
            "--json",
            "--reference-joints-deg",
            reference,
        ];
        let answer = cell.armill(&[&STRETCHED[..], &arguments].concat()).fine().json();
        numbers(&answer["postures"][0]["deviation_um"])[2]
    };
    assert_eq!(deviation_z("0,0"), 0.0);
    // 20 kg at 0.5 m against 0.75 m: -c m g (0.5^2 - 0.75^2), um.
    let witness = 1e-6 * 20.0 * 9.80665 * (0.75 * 0.75 - 0.25) * 1e6;
    assert!((deviation_z("0,250") - witness).abs() < 1e-9 * witness);
    cell.armill(&[&STRETCHED[..], &["--reference-joints-deg", "0"]].concat())
        .refused(&["1 joint positions for the 2 joints"]);
}

#[test]
fn a_lever_that_is_pressed_too_hard_buckles() {
    let cell = with_body();
    // Both springs in series: 3e-6 rad/(N m), lever 0.5 m: stable up to 1/(3e-6 x 0.5) = 666 667 N.
    let press = |force: &str| {
        let arguments = ["--wrench-n", force, "--load-dependent"];
        cell.armill(&[&STRETCHED[..], &arguments].concat()).fine().out
    };
    assert!(press("-666000,0,0").contains("deviation"));
    let buckled = press("-667000,0,0");
    assert!(
        buckled.contains("UNSTABLE") && buckled.contains("buckles"),
        "{buckled}"
    );
    assert!(
        !buckled.contains("deviation") && !buckled.contains("NaN"),
        "{buckled}"
    );
}

#[test]
fn the_compliance_under_load_is_softer_where_the_load_presses() {
    let cell = with_body();
    let arguments = ["--wrench-n", "-333333.333,0,0", "--load-dependent", "--json"];
    let answer = cell.armill(&[&STRETCHED[..], &arguments].concat()).fine().json();
    let posture = &answer["postures"][0];
    let c_yy = |matrix: &str| number(&posture[matrix][1][1]);
    // Half of the buckling load halves the stiffness.
    assert!((c_yy("loaded_compliance") / c_yy("compliance") - 2.0).abs() < 1e-6);
}

#[test]
fn robots_shows_what_a_robot_has_apart_from_its_drives() {
    let cell = with_body();
    let said = cell.armill(&["robots", "lever.toml"]).fine();
    assert!(
        said.out
            .contains("spring at base: about z, 1.00e-6 ± 1.0e-7 rad/(N m)"),
        "{}",
        said.out
    );
    assert!(said.out.contains("mass at flange: 20 kg"), "{}", said.out);
    let json = cell.armill(&["robots", "lever.toml", "--json"]).fine().json();
    let spring = &json["structure"]["springs"][0];
    assert_eq!(number(&spring["compliance_rad_per_n_m"]), 1e-6);
    assert_eq!(number(&json["structure"]["masses"][0]["mass_kg"]), 20.0);
}

#[test]
fn a_prismatic_joint_is_reported_in_mm_and_um_per_n() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    let said = cell.armill(&["robots", "lever.toml"]).fine();
    for line in [
        "A    chain +A    -100 to 120 deg      speed not known 2.00e-6 ± not known rad/(N m)",
        "B    chain +B    0 to 250 mm          speed not known 2.00e-2 ± not known µm/N",
    ] {
        assert!(said.out.contains(line), "no `{line}` in:\n{}", said.out);
    }
    let json = cell.armill(&["robots", "lever.toml", "--json"]).fine().json();
    let [turning, sliding] = [&json["joints"][0], &json["joints"][1]];
    assert_eq!(number(&turning["compliance_rad_per_n_m"]), 2e-6);
    assert!(turning["compliance_u_rad_per_n_m"].is_null(), "{turning}");
    assert!((number(&sliding["compliance_um_per_n"]) - 0.02).abs() < 1e-15);
    assert_eq!(numbers(&sliding["limits_mm"]), [0.0, 250.0]);
    assert!(sliding.get("compliance_rad_per_n_m").is_none() && turning.get("limits_mm").is_none());
}

#[test]
fn a_posture_reports_the_position_and_limit_margin_of_a_prismatic_joint_in_mm() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    // 0.1 mm from its end the slide is nearest: rad and m are compared as they are.
    let said = cell
        .armill(&["pose", "lever.toml", "--joints-deg", "10,249.9"])
        .fine();
    assert!(
        said.out
            .contains("A 10.000  B 249.900 mm   (inside limits, smallest margin B, 0.1 mm)"),
        "{}",
        said.out
    );
    let json = cell
        .armill(&["pose", "lever.toml", "--joints-deg", "10,249.9", "--json"])
        .fine()
        .json();
    assert_eq!(json["joint_units"], serde_json::json!(["deg", "mm"]));
}
