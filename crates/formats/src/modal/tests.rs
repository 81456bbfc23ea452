use super::*;

const HEAD: &str = "format = 1\nname = \"cutter\"\nsource = \"impact test\"\n";

fn problems(modes: &str) -> String {
    read("tool.toml", &format!("{HEAD}{modes}"))
        .unwrap_err()
        .to_string()
}

#[test]
fn mass_and_stiffness_of_the_same_mode_give_the_same_shape() {
    let by_mass = "[[mode]]\nfrequency_hz = 922\ndamping_percent = 1.1\ndirection = [2, 0, 0]\nmodal_mass_kg = 0.03993\n";
    // 0.03993 kg (2 pi 922 Hz)^2 = 1.3400496 N/um.
    let by_stiffness = "[[mode]]\nname = \"b\"\nfrequency_hz = 922\nfrequency_u_hz = 9.22\ndamping_ratio = 0.011\n\
                        damping_u_percent = 0.22\ndirection = [1, 0, 0]\nstiffness_n_per_um = 1.3400496\n\
                        stiffness_u_percent = 5\n";
    let found = read("tool.toml", &format!("{HEAD}{by_mass}{by_stiffness}")).unwrap();
    let [first, second] = &found.modes[..] else {
        panic!("two modes")
    };
    assert!((first.mode.shape - second.mode.shape).norm() < 1e-6 * first.mode.shape.norm());
    assert!((first.mode.shape.x - 1.0 / 0.03993_f64.sqrt()).abs() < 1e-12);
    assert!((first.mode.angular_frequency - 5793.0969).abs() < 1e-3);
    assert!((first.mode.damping_ratio - 0.011).abs() < 1e-15);
    assert_eq!([first.name.as_str(), second.name.as_str()], ["1", "b"]);
    assert_eq!(first.uncertainty, ModeUncertainty::default());
    let u = second.uncertainty;
    assert!(
        (u.frequency - 0.01).abs() < 1e-15
            && (u.damping - 0.2).abs() < 1e-12
            && (u.stiffness - 0.05).abs() < 1e-15
    );
}

#[test]
fn all_problems_are_reported_together_with_their_lines() {
    let text = problems(
        "[[mode]]\nfrequency_hz = 922\ndirection = [0, 0, 0]\n\
         [[mode]]\nfrequency_hz = 30\ndamping_percent = 2\ndamping_ratio = 0.02\ndirection = [0, 1, 0]\n\
         modal_mass_kg = 1\nstiffness_n_per_um = 1\n",
    );
    for expected in [
        "tool.toml:4",
        "no damping",
        "neither modal mass nor stiffness",
        "`direction` is zero",
        "`damping_percent` and `damping_ratio` are both given",
        "`modal_mass_kg` and `stiffness_n_per_um` are both given",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
}

#[test]
fn values_out_of_range_and_contradictions_are_reported_in_one_round() {
    let text = problems(
        "[[mode]]\nfrequency_hz = -922\ndirection = [0, 0, 0]\nmodal_mass_kg = 1\n\
         [[mode]]\nfrequency_hz = \"30\"\ndamping_percent = 2\ndirection = [0, 1]\n",
    );
    for expected in [
        "tool.toml:5",
        "no damping",
        "`direction` is zero",
        "tool.toml:9",
        "neither modal mass nor stiffness",
        "tool.toml:11",
    ] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    // Lists and tables in the place of modes.
    for modes in [
        "mode = [1, [], \"a\"]\n",
        "mode = 3\n",
        "[mode]\nfrequency_hz = 1\n",
    ] {
        assert!(!problems(modes).is_empty(), "{modes}");
    }
}

#[test]
fn values_out_of_range_unknown_keys_and_no_mode_are_refused() {
    let mode = |line: &str| {
        format!(
            "[[mode]]\nfrequency_hz = 922\ndamping_percent = 2\ndirection = [1, 0, 0]\nmodal_mass_kg = 1\n{line}\n"
        )
    };
    assert!(read("tool.toml", &format!("{HEAD}{}", mode(""))).is_ok());
    for line in [
        "damping = 1",
        "frequency_u_hz = -1",
        "stiffness_u_percent = 200",
        "name = \"\"",
    ] {
        assert!(!problems(&mode(line)).is_empty(), "{line}");
    }
    let fast = mode("").replace("922", "1e9");
    assert!(problems(&fast).contains("frequency_hz"), "{}", problems(&fast));
    assert!(!problems("mode = []\n").is_empty());
    assert!(!problems("").is_empty());
    assert!(read("tool.toml", "format = 1\n[[mode").is_err());
}

#[test]
fn a_written_file_is_read_again() {
    let mode = WrittenMode {
        name: "a \"b\"\\".to_owned(),
        frequency_hz: 1150.0,
        frequency_u_hz: 1e-7,
        damping_percent: 1.25,
        damping_u_percent: 0.01,
        direction: [0.6, -0.8, 0.0],
        stiffness_n_per_um: 9.5,
        stiffness_u_percent: 250.0,
    };
    let mut content = WrittenModes {
        name: "tip".to_owned(),
        source: "tap.uff".to_owned(),
        note: "two\nlines".to_owned(),
        modes: vec![mode],
    };
    let found = read("new.toml", &write("new.toml", &content).unwrap()).unwrap();
    assert_eq!(found.note.as_deref(), Some("two\nlines"));
    let own = &found.modes[0];
    assert_eq!((own.name.as_str(), own.mode.damping_ratio), ("a \"b\"\\", 0.0125));
    assert!((own.uncertainty.frequency - 1e-7 / 1150.0).abs() < 1e-20 && own.uncertainty.stiffness == 1.0);
    assert!((own.mode.shape[1] / own.mode.shape[0] + 0.8 / 0.6).abs() < 1e-12);
    content.modes[0].stiffness_n_per_um = 1e9;
    assert!(
        write("new.toml", &content)
            .unwrap_err()
            .to_string()
            .contains("stiffness_n_per_um")
    );
}
