//! `armill receptance` as a user runs it: a cantilever by its closed form, an arm, modal data of the nose, the files for other commands, and
//! invalid input.

use std::f64::consts::TAU;

use crate::cell::{Cell, LEVER, SMALL, number, numbers};
use crate::stability::CUT;

/// A steel cylinder of 10 mm x 100 mm after Euler, with losses.
const ROD: &str = "format = 1\nname = \"rod\"\nsource = \"made-up\"\nbeam = \"euler\"\n\
    [[segment]]\nlength_mm = 100\ndiameter_mm = 10\nmaterial = \"steel\"\nloss_factor = 0.02\n";
/// A stub of 6 g.
const STUB: &str = "format = 1\nname = \"stub\"\nsource = \"made-up\"\n\
    [[segment]]\nlength_mm = 10\ndiameter_mm = 10\nmaterial = \"steel\"\n";
const MASS: &str = "\n[[mass]]\nat = \"A\"\nmass_kg = 3\ncentre_mm = [1000, 0, 0]\ninertia_kg_m2 = [[0, 0, 0], [0, 1, 0], [0, 0, 1]]\nsource = \"made-up\"\n";
const NOSE: &str = "format = 1\nname = \"nose\"\nsource = \"impact test\"\n\
    [[mode]]\nfrequency_hz = 500\ndamping_percent = 2\ndirection = [1, 0, 0]\nmodal_mass_kg = 2\n\
    [[mode]]\nfrequency_hz = 700\ndamping_percent = 3\ndirection = [0, 1, 0]\nmodal_mass_kg = 3\n";

fn cell() -> Cell {
    let cell = Cell::new();
    cell.file("rod.toml", ROD);
    cell.file("stub.toml", STUB);
    cell.file("nose.toml", NOSE);
    let rigid = LEVER.replace("compliance_um_per_n = 0.02", "compliance_um_per_n = 0");
    cell.file("lever.toml", format!("{rigid}{MASS}"));
    cell
}

fn is_near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} {expected}");
}

const RIGID: [&str; 6] = [
    "receptance",
    "--rigid",
    "--assembly",
    "rod.toml",
    "--frequencies-hz",
    "50,3000",
];

#[test]
fn a_cantilever_has_the_stiffness_and_the_mode_of_the_closed_form() {
    let answer = cell().armill(&[&RIGID[..], &["--json"]].concat()).fine().json();
    // 3 E I/L^3 with E I = 101.1201 N m^2, and E A/L.
    is_near(
        number(&answer["directions"][0]["static_stiffness_n_per_um"]),
        0.303_360,
        1e-3,
    );
    is_near(
        number(&answer["directions"][1]["static_stiffness_n_per_um"]),
        0.303_360,
        1e-3,
    );
    is_near(
        number(&answer["directions"][2]["static_stiffness_n_per_um"]),
        161.792,
        1e-3,
    );
    let modes = answer["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 2, "{answer}");
    // 1.8751^2 sqrt(E/rho) D/4 / L^2 / (2 pi); a quarter of 61.654 g; half of the loss factor.
    for mode in modes {
        is_near(number(&mode["frequency_hz"]), 716.65, 1e-3);
        is_near(number(&mode["modal_mass_kg"]), 0.015_413, 2e-2);
        is_near(number(&mode["damping_percent"]), 1.0, 3e-2);
    }
    // At resonance: k zeta 2, of which the second mode adds a little.
    let least = &answer["directions"][0];
    is_near(number(&least["at_frequency_hz"]), 716.65, 2e-3);
    is_near(
        number(&least["least_dynamic_stiffness_n_per_um"]),
        0.015_413 * (TAU * 716.65_f64).powi(2) * 0.02 * 1e-6,
        2e-2,
    );
    // Symmetric, and a force along x turns about y.
    let one = &answer["receptance"][0];
    let rotation: Vec<Vec<f64>> = one["rotation_by_force_real_urad_per_n"]
        .as_array()
        .unwrap()
        .iter()
        .map(numbers)
        .collect();
    // L^2/(2 E I) = 49.446 urad/N; the feed frame has z from the tip to the spindle: the force along x turns about -y.
    is_near(rotation[1][0], -49.446, 1e-2);
    is_near(rotation[0][1], 49.446, 1e-2);
}

#[test]
fn table_and_modal_data_are_read_by_the_other_commands() {
    let cell = cell();
    cell.file("study.toml", format!("{SMALL}{CUT}"));
    let files = [
        "--out",
        "tip.csv",
        "--modal-out",
        "modes.toml",
        "--drawing",
        "tip.svg",
    ];
    let said = cell.armill(&[&RIGID[..], &files].concat()).fine();
    assert!(
        said.out.contains("rod on a rigid spindle nose") && said.out.contains("least dynamic stiffness"),
        "{}",
        said.out
    );
    assert!(
        said.out
            .contains("note: all joints of spindle, holder and cutter are rigid"),
        "{}",
        said.out
    );
    let svg = std::fs::read_to_string(cell.at("tip.svg")).unwrap();
    assert!(svg.contains("x, along the feed") && !svg.contains("NaN"));
    let frf = cell.armill(&["frf", "tip.csv", "--json"]).fine().json();
    let modes = frf["modes"].as_array().unwrap();
    // Along the axis there is no mode below 3000 Hz.
    assert!(
        frf["notes"]
            .to_string()
            .contains("no mode of vibration is found in 1Z/1Z"),
        "{frf}"
    );
    assert!(
        modes
            .iter()
            .any(|mode| (number(&mode["frequency_hz"]) - 716.65).abs() < 1.0),
        "{frf}"
    );
    let stability = cell
        .armill(&["stability", "study.toml", "--modes", "modes.toml", "--json"])
        .fine()
        .json();
    assert_eq!(stability["modes"].as_array().unwrap().len(), 2);
    is_near(number(&stability["modes"][0]["frequency_hz"]), 716.65, 1e-3);
}

#[test]
fn a_light_tool_leaves_the_mode_of_the_arm() {
    let cell = cell();
    let call = [
        "receptance",
        "lever.toml",
        "--joints-deg",
        "0,0",
        "--assembly",
        "stub.toml",
        "--frequencies-hz",
        "10,200,300",
        "--json",
    ];
    let answer = cell.armill(&call).fine().json();
    let modes = answer["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 1, "{answer}");
    // The lever alone: 56.2698 Hz, 16 kg; the stub has 0.006 kg.
    is_near(number(&modes[0]["frequency_hz"]), 56.2698, 1e-3);
    is_near(number(&modes[0]["damping_percent"]), 3.0, 1e-2);
    let bare = &answer["directions"];
    let stiffest = |key: &str| {
        bare.as_array()
            .unwrap()
            .iter()
            .filter_map(|own| own[key].as_f64())
            .fold(f64::INFINITY, f64::min)
    };
    // Rigid across the joint: 2 N/um at its end, 2 zeta of it at resonance.
    is_near(
        stiffest("nose_least_dynamic_stiffness_n_per_um"),
        2.0 * 0.06,
        1e-2,
    );
}

#[test]
fn modal_data_of_the_nose_are_those_of_the_tip_of_a_stub() {
    let cell = cell();
    let base = [
        "receptance",
        "--modes",
        "nose.toml",
        "--assembly",
        "stub.toml",
        "--frequencies-hz",
        "100,2000",
    ];
    for turn in ["0", "90"] {
        let answer = cell
            .armill(&[&base[..], &["--feed-deg", turn, "--json"]].concat())
            .fine()
            .json();
        let modes = answer["modes"].as_array().unwrap();
        // The modal data are in the feed frame, whatever its angle on the nose; 6 g on 2 and 3 kg.
        is_near(number(&modes[0]["frequency_hz"]), 500.0, 3e-3);
        is_near(number(&modes[1]["frequency_hz"]), 700.0, 3e-3);
        assert!(
            (numbers(&modes[0]["direction"])[0].abs() - 1.0).abs() < 1e-6,
            "{answer}"
        );
        assert!(
            (numbers(&modes[1]["direction"])[1].abs() - 1.0).abs() < 1e-6,
            "{answer}"
        );
        is_near(number(&modes[0]["modal_mass_kg"]), 2.006, 1e-2);
    }
}

#[test]
fn invalid_input_is_refused_and_nothing_is_written() {
    let cell = cell();
    cell.file(
        "two.toml",
        ROD.replace("diameter_mm = 10", "diameter_mm = 10\nbore_mm = 10")
            .replace("\"steel\"", "\"cheese\""),
    );
    cell.file("there.csv", "mine");
    let with = |more: &[&str]| cell.armill(&[&["receptance"], more].concat());
    for (words, parts) in [
        (
            &["--assembly", "rod.toml"][..],
            &["the spindle nose is not known", "--rigid"][..],
        ),
        (&["lever.toml", "--assembly", "rod.toml"], &["give --joints-deg"]),
        (
            &["lever.toml", "--joints-deg", "0", "--assembly", "rod.toml"],
            &["joint"],
        ),
        (&["--rigid", "--assembly", "none.toml"], &["none.toml"]),
        (
            &["--rigid", "--assembly", "two.toml"],
            &["two.toml:9", "material"],
        ),
        (
            &["--rigid", "--assembly", "rod.toml", "--frequencies-hz", "5"],
            &["--frequencies-hz: 1 numbers"],
        ),
        (
            &["--rigid", "--assembly", "rod.toml", "--frequencies-hz", "9,5"],
            &["--frequencies-hz: 5 is outside 9"],
        ),
        (
            &["--rigid", "--assembly", "rod.toml", "--frequencies-hz", "5,5"],
            &["is no range"],
        ),
        (
            &["--rigid", "--assembly", "rod.toml", "--frequencies-hz", "5,50,9"],
            &["--frequencies-hz: 9"],
        ),
        (
            &["--rigid", "--assembly", "rod.toml", "--frequencies-hz", "-5,50"],
            &["--frequencies-hz: -5 is not above 0"],
        ),
        (
            &[
                "--rigid",
                "--assembly",
                "rod.toml",
                "--drawing",
                "tip.gif",
                "--out",
                "tip.csv",
            ],
            &["does not end in .svg or .png"],
        ),
        (
            &[
                "--rigid",
                "--assembly",
                "rod.toml",
                "--modal-out",
                "tip.csv",
                "--out",
                "there.csv",
            ],
            &["there.csv"],
        ),
        (
            &["--rigid", "--modes", "nose.toml", "--assembly", "rod.toml"],
            &["cannot be used with"],
        ),
    ] {
        with(words).refused(parts);
    }
    assert!(!cell.at("tip.csv").exists());
    assert_eq!(std::fs::read_to_string(cell.at("there.csv")).unwrap(), "mine");
}
