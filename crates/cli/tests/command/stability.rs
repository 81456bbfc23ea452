//! `armill stability` as a user runs it: a slot, whose limit is on both sides of the programmed depth, its picture, and invalid input.

use crate::cell::{Cell, SMALL, number};

/// A path with a slot by straight teeth.
pub const CUT: &str = r#"
[cut]
material = "aluminium-7075-t6"
cutter = { diameter_mm = 20, flutes = 2, helix_deg = 0 }
axial_depth_mm = 0.1
side = "slot"
feed_mm_per_min = 2400
spindle_rpm = 12000

[[analysis]]
kind = "path"
name = "slot"
circle.radius_mm = 60
step_mm = 20
"#;

/// The mode of the published benchmark, and one across the feed.
const MODES: &str = r#"format = 1
name = "benchmark"
source = "Insperger and Stepan"

[[mode]]
name = "along"
frequency_hz = 922
frequency_u_hz = 5
damping_percent = 1.1
damping_u_percent = 0.2
direction = [1, 0, 0]
modal_mass_kg = 0.03993
stiffness_u_percent = 5

[[mode]]
name = "across"
frequency_hz = 1400
damping_ratio = 0.02
direction = [0, 1, 0]
stiffness_n_per_um = 40
"#;

fn cell() -> Cell {
    let cell = Cell::new();
    cell.file("study.toml", format!("{SMALL}{CUT}"));
    cell.file("modes.toml", MODES);
    cell
}

const CALL: [&str; 4] = ["stability", "study.toml", "--modes", "modes.toml"];

#[test]
fn a_cut_is_stable_below_its_limit_and_unstable_above_it() {
    let cell = cell();
    let with = |more: &[&str]| cell.armill(&[&CALL, more, &["--json"]].concat()).fine().json();
    let found = with(&[]);
    let limit = number(&found["stable_depth_mm"]);
    assert!(limit > 0.1 && found["is_stable"] == true, "{limit}");
    assert_eq!(found["lobes"].as_array().unwrap().len(), 500);
    assert_eq!(found["path"], "slot");
    assert!(["along", "across"].contains(&found["cause"].as_str().unwrap()));
    for (part, is_stable) in [(0.98, true), (1.02, false)] {
        let depth = format!("{}", part * limit);
        let there = with(&["--depth-mm", &depth]);
        assert_eq!(there["is_stable"], is_stable, "{part}: {}", there["verdict"]);
        let begin = if is_stable {
            "stable at 12000 rpm"
        } else {
            "unstable at 12000 rpm"
        };
        assert!(there["verdict"].as_str().unwrap().starts_with(begin));
        let probability = number(&there["probability_stable"]);
        assert!((probability > 0.5) == is_stable, "{probability}");
    }
    let lowest = number(&found["lowest_depth_mm"]);
    assert!(number(&found["critical_depth_mm"]) <= lowest * (1.0 + 1e-9));
    assert!(number(&found["preferred_speeds"][0]["depth_mm"]) > lowest);
    let walls: Vec<&str> = found["vibration"]["walls"]
        .as_array()
        .unwrap()
        .iter()
        .map(|wall| wall["side"].as_str().unwrap())
        .collect();
    assert_eq!(walls, ["left", "right"]);
}

#[test]
fn the_text_names_the_limits_and_a_picture_is_written() {
    let cell = cell();
    let said = cell
        .armill(
            &[
                &CALL[..],
                &["--speeds-rpm", "6000,20000", "--drawing", "lobes.svg"],
            ]
            .concat(),
        )
        .fine();
    for words in [
        "limit at this speed",
        "by mode coupling alone",
        "lowest, 6000 to 20000 rpm",
        "lower of both ",
        "stable with a probability of",
        "preferred speed",
        "wall on the left",
        "note: Not modelled: process damping",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
    let svg = std::fs::read_to_string(cell.at("lobes.svg")).unwrap();
    assert!(svg.contains("limit of stability") && svg.contains("programmed cut"));
}

#[test]
fn invalid_input_is_refused_with_its_reason() {
    let cell = cell();
    cell.file("plain.toml", SMALL);
    cell.file(
        "bare.toml",
        format!("{SMALL}{}", CUT.replace("spindle_rpm = 12000\n", "")),
    );
    cell.file(
        "wrong.toml",
        MODES
            .replace("damping_percent = 1.1\n", "")
            .replace("[0, 1, 0]", "[0, 0, 0]"),
    );
    for (study, modes, more, parts) in [
        (
            "plain.toml",
            "modes.toml",
            &[][..],
            &["no path of the study has a cut"][..],
        ),
        (
            "bare.toml",
            "modes.toml",
            &[],
            &["no spindle speed is given for this cut"],
        ),
        ("study.toml", "none.toml", &[], &["none.toml"]),
        (
            "study.toml",
            "wrong.toml",
            &[],
            &["wrong.toml:5", "no damping", "`direction` is zero"],
        ),
        (
            "study.toml",
            "modes.toml",
            &["--path", "other"],
            &["no path `other` with a cut"],
        ),
        (
            "study.toml",
            "modes.toml",
            &["--speeds-rpm", "6000"],
            &["--speeds-rpm: 1 numbers"],
        ),
        (
            "study.toml",
            "modes.toml",
            &["--speeds-rpm", "9000,6000"],
            &["--speeds-rpm: 6000"],
        ),
        ("study.toml", "modes.toml", &["--depth-mm", "0"], &["--depth-mm"]),
        (
            "study.toml",
            "modes.toml",
            &["--spindle-rpm", "nan"],
            &["--spindle-rpm"],
        ),
        (
            "study.toml",
            "modes.toml",
            &["--drawing", "lobes.pdf"],
            &["does not end in .svg or .png"],
        ),
    ] {
        let call = [&["stability", study, "--modes", modes], more].concat();
        cell.armill(&call).refused(parts);
    }
}

#[test]
fn a_cut_of_options_has_the_numbers_of_that_of_a_study_and_all_its_problems_are_reported() {
    let cell = cell();
    let given = [
        "stability",
        "--modes",
        "modes.toml",
        "--material",
        "aluminium-7075-t6",
        "--cutter-diameter-mm",
        "20",
        "--teeth",
        "2",
        "--helix-deg",
        "0",
        "--side",
        "slot",
        "--depth-mm",
        "0.1",
        "--spindle-rpm",
        "12000",
        "--feed-mm-per-min",
        "2400",
        "--json",
    ];
    let alone = cell.armill(&given).fine().json();
    let of_study = cell.armill(&[&CALL[..], &["--json"]].concat()).fine().json();
    for key in [
        "stable_depth_mm",
        "mode_coupling_depth_mm",
        "probability_stable",
        "feed_mm_per_tooth",
    ] {
        assert_eq!(number(&alone[key]), number(&of_study[key]), "{key}");
    }
    let wrong = given.map(|word| match word {
        "slot" => "above",
        "20" => "2000",
        other => other,
    });
    cell.armill(&wrong).refused(&["side", "diameter_mm"]);
    cell.armill(&[&CALL[..], &["--teeth", "3"]].concat())
        .refused(&["--teeth"]);
    cell.armill(&["stability", "--modes", "modes.toml"])
        .refused(&["--material", "--teeth"]);
}
