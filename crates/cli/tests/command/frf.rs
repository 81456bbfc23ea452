//! `armill frf` as a user runs it: FRFs of two modes by their closed form, the file of modal data, and invalid input.

use std::f64::consts::TAU;

use crate::cell::{Cell, SMALL, number, numbers};
use crate::stability::CUT;

/// Frequency (Hz), damping ratio, shape along x and y (1/sqrt(kg)).
const MODES: [[f64; 4]; 2] = [[800.0, 0.02, 3.0, 1.0], [1100.0, 0.015, -1.0, 2.0]];

/// Accelerance along x and y by a force along x, from 500 to 1500 Hz, with a small wave in place of noise.
fn table() -> String {
    let mut text =
        "frequency_hz,accelerance_real_m_per_s2_per_n,accelerance_imag_m_per_s2_per_n,response,reference\n"
            .to_owned();
    for (response, place) in [("1X", 2), ("1Y", 3)] {
        for k in 0..500_u32 {
            let hz = 500.0 + 2.0 * f64::from(k);
            let w = TAU * hz;
            let (mut re, mut im) = (0.0, 0.0);
            for mode in MODES {
                let omega = TAU * mode[0];
                let (a, b) = (omega * omega - w * w, 2.0 * mode[1] * omega * w);
                let size = -w * w * mode[2] * mode[place] / (a * a + b * b);
                re += size * a;
                im -= size * b;
            }
            let wave = 0.01 * (f64::from(k) * 12.9898).sin();
            text += &format!("{hz},{},{},{response},1X\n", re + wave, im - wave);
        }
    }
    text
}

#[test]
fn the_modes_of_a_table_are_found_and_written_for_stability() {
    let cell = Cell::new();
    cell.file("tap.csv", table());
    let said = cell
        .armill(&["frf", "tap.csv", "--out", "modes.toml", "--json"])
        .fine();
    let answer = said.json();
    let modes = answer["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 2, "{answer}");
    for (found, mode) in modes.iter().zip(MODES) {
        let within = |key: &str, expected: f64, part: f64| {
            let value = number(&found[key]);
            assert!((value / expected - 1.0).abs() < part, "{key}: {value} {expected}");
        };
        let square = mode[2] * mode[2] + mode[3] * mode[3];
        within("frequency_hz", mode[0], 1e-4);
        within("damping_percent", 100.0 * mode[1], 2e-3);
        within("modal_mass_kg", 1.0 / square, 5e-3);
        within("stiffness_n_per_um", (TAU * mode[0]).powi(2) / square / 1e6, 5e-3);
        let ratio = number(&found["direction"][1]) / number(&found["direction"][0]);
        assert!((ratio - mode[3] / mode[2]).abs() < 1e-2, "{found}");
    }
    // `armill stability` reads the file.
    cell.file("study.toml", format!("{SMALL}{CUT}"));
    let stability = cell
        .armill(&["stability", "study.toml", "--modes", "modes.toml", "--json"])
        .fine()
        .json();
    assert_eq!(stability["modes"].as_array().unwrap().len(), 2);
    assert_eq!(stability["modes"][0]["frequency_hz"], modes[0]["frequency_hz"]);
    let one = cell
        .armill(&["frf", "tap.csv", "--band-hz", "600,950", "--modes", "1"])
        .fine();
    assert!(one.out.contains("direction at point 1"), "{}", one.out);
}

#[test]
fn the_picture_has_both_frfs_and_the_modes() {
    let cell = Cell::new();
    cell.file("tap.csv", table());
    cell.armill(&["frf", "tap.csv", "--drawing", "tap.svg"]).fine();
    let svg = std::fs::read_to_string(cell.at("tap.svg")).unwrap();
    for word in ["1X/1X measured", "1Y/1X fitted", ">mode<", "magnitude"] {
        assert!(svg.contains(word), "{word}");
    }
    assert!(!svg.contains(">coherence<"), "it is not measured");
    cell.armill(&["frf", "tap.csv", "--drawing", "tap.gif", "--out", "modes.toml"])
        .refused(&["does not end in .svg or .png"]);
    assert!(!cell.at("modes.toml").exists());
}

#[test]
fn measured_axes_are_directions_of_the_feed() {
    let cell = Cell::new();
    cell.file("tap.csv", table());
    let directions = |more: &[&str]| -> Vec<Vec<f64>> {
        let answer = cell
            .armill(&[&["frf", "tap.csv", "--json"], more].concat())
            .fine()
            .json();
        answer["modes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|mode| numbers(&mode["direction"]))
            .collect()
    };
    let turned = directions(&["--axes", "X=y,Y=-z"]);
    for (found, measured) in turned.iter().zip(directions(&[])) {
        assert_eq!(found[..], [0.0, measured[0], -measured[1]], "{measured:?}");
    }
}

#[test]
fn invalid_input_is_refused() {
    let cell = Cell::new();
    cell.file("tap.csv", table());
    cell.file("cross.csv", table().replace(",1X\n", ",2X\n"));
    cell.file("wrong.csv", "frequency_hz,phase_deg\n1,2\n");
    for (words, parts) in [
        (&["none.csv"][..], &["cannot read none.csv"][..]),
        (
            &["wrong.csv"],
            &["wrong.csv:1:1", "real and imaginary part, or magnitude and phase"],
        ),
        (&["cross.csv"], &["no drive point among 1X/2X, 1Y/2X"]),
        (
            &["tap.csv", "--point", "7"],
            &["--point 7: no FRF has this point"],
        ),
        (&["tap.csv", "--band-hz", "500"], &["--band-hz: 1 numbers"]),
        (&["tap.csv", "--band-hz", "900,600"], &["--band-hz: 600"]),
        (
            &["tap.csv", "--band-hz", "2000,3000"],
            &["0 frequencies in the band"],
        ),
        (&["tap.csv", "--modes", "0"], &["--modes"]),
        (
            &["tap.csv", "--axes", "X=x,Y=x"],
            &["--axes: the direction of `Y=x` is assigned twice"],
        ),
    ] {
        cell.armill(&[&["frf"], words].concat()).refused(parts);
    }
}
