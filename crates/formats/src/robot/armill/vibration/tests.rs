//! Inertias, motors and damping of a robot file, and what is refused of them.

use armill_core::robot::{Damping, Motor};

use crate::document::Problems;
use crate::robot::RobotDescription;
use crate::robot::armill::{read, write};

/// A revolute and a prismatic joint, with all that vibration depends on.
const ARM: &str = r#"
format = 1
name = "lever"
[chain]
source = "made-up"
motions = [
  { about = "z", joint = "A" },
  { along = "x", length_mm = 500 },
  { along = "x", joint = "B" },
]
[[joint]]
name = "A"
sign = 1
source = "made-up"
compliance_rad_per_n_m = 2e-6
compliance_source = "made-up"
damping_n_m_s_per_rad = 40
damping_source = "made-up"
[[joint]]
name = "B"
sign = 1
source = "made-up"
compliance_um_per_n = 0.02
compliance_source = "made-up"
damping_n_s_per_m = 900
damping_source = "made-up"
[[mass]]
at = "A"
mass_kg = 12.5
centre_mm = [100, 0, -50]
inertia_kg_m2 = [[0.2, 0.01, 0], [0.01, 0.3, 0], [0, 0, 0.4]]
source = "made-up"
[[motor]]
joint = "A"
rotor_inertia_kg_m2 = 1e-3
ratio = -120
source = "made-up"
[[motor]]
joint = "B"
rotor_inertia_kg_m2 = 2e-3
lead_mm = 20
source = "made-up"
[sources.made-up]
what = "nothing real"
where = "this test"
licence = "none"
"#;

fn changed(from: &str, to: &str) -> Result<RobotDescription, Problems> {
    assert!(ARM.contains(from), "the sample has no `{from}`");
    read("lever.toml", "lever", &ARM.replacen(from, to, 1))
}

#[test]
fn inertias_motors_and_damping_arrive_in_si() {
    let robot = changed("", "").unwrap().robot;
    let structure = robot.structure();
    let inertia = structure.masses[0].inertia.unwrap();
    assert_eq!((inertia[(0, 1)], inertia[(2, 2)]), (0.01, 0.4));
    let motor = |joint, rotor_inertia, ratio| Motor {
        joint,
        rotor_inertia,
        ratio,
    };
    assert_eq!(structure.motors[0], motor(0, 1e-3, -120.0));
    // One turn moves the slide by 20 mm: 314 rad/m, and 2e-3 kg m^2 are as heavy as 197 kg.
    assert!(
        (structure.motors[1].inertia_at_joint() - 2e-3 * (2.0 * std::f64::consts::PI / 0.02).powi(2)).abs()
            < 1e-9
    );
    assert_eq!(structure.damping, Some(Damping::Joints(vec![40.0, 900.0])));
}

#[test]
fn one_ratio_is_the_other_way_to_give_the_damping() {
    let without = ARM
        .replace("damping_n_m_s_per_rad = 40\ndamping_source = \"made-up\"\n", "")
        .replace("damping_n_s_per_m = 900\ndamping_source = \"made-up\"\n", "");
    let ratio = "[damping]\nratio = 0.02\nsource = \"made-up\"\n";
    let of = |text: &str| {
        read("lever.toml", "lever", text)
            .unwrap()
            .robot
            .structure()
            .damping
            .clone()
    };
    assert_eq!(of(&without), None);
    assert_eq!(of(&format!("{without}{ratio}")), Some(Damping::Ratio(0.02)));
    let twice = read("lever.toml", "lever", &format!("{ARM}{ratio}"))
        .unwrap_err()
        .to_string();
    assert!(twice.contains("the damping is given twice"), "{twice}");
}

#[test]
fn what_no_arm_has_is_refused_with_its_place() {
    let cases = [
        (
            "[0.2, 0.01, 0]",
            "[0.2, 0.02, 0]",
            "inertia_kg_m2",
            "not symmetric",
        ),
        (
            "[0, 0, 0.4]]",
            "[0, 0, 0.9]]",
            "inertia_kg_m2",
            "at most the sum of the others",
        ),
        (
            "[0, 0, 0.4]]",
            "[0, 0, -0.4]]",
            "inertia_kg_m2",
            "must not be negative",
        ),
        ("[0, 0, 0.4]]", "[0, 0]]", "inertia_kg_m2", "3"),
        (
            "joint = \"A\"\nrotor",
            "joint = \"C\"\nrotor",
            "joint = \"C\"",
            "`C` is not a joint of the arm",
        ),
        (
            "joint = \"B\"\nrotor",
            "joint = \"A\"\nrotor",
            "joint = \"A\"",
            "joint `A` has two motors",
        ),
        (
            "ratio = -120",
            "lead_mm = 20",
            "[[motor]]",
            "needs `ratio` and no `lead_mm`",
        ),
        (
            "lead_mm = 20",
            "ratio = 20",
            "[[motor]]",
            "needs `lead_mm` and no `ratio`",
        ),
        (
            "rotor_inertia_kg_m2 = 1e-3",
            "rotor_inertia_kg_m2 = -1e-3",
            "rotor_inertia_kg_m2",
            "must be at least 0 kg m^2",
        ),
        (
            "damping_n_s_per_m = 900",
            "damping_n_m_s_per_rad = 900",
            "[[joint]]",
            "the unit of its damping",
        ),
        (
            "damping_n_m_s_per_rad = 40\ndamping_source = \"made-up\"\n",
            "",
            "[[joint]]",
            "joint A has no damping, but others have",
        ),
        (
            "damping_n_m_s_per_rad = 40\ndamping_source = \"made-up\"\n",
            "damping_n_m_s_per_rad = 40\n",
            "[[joint]]",
            "names no source",
        ),
        (
            "damping_n_m_s_per_rad = 40\n",
            "",
            "[[joint]]",
            "a source of its damping without the damping",
        ),
    ];
    for (from, to, shown, said) in cases {
        let problems = changed(from, to).unwrap_err().to_string();
        assert!(problems.contains(said), "no `{said}` in:\n{problems}");
        assert!(
            problems.contains("lever.toml:") && problems.contains(shown),
            "no `{shown}` in:\n{problems}"
        );
    }
}

#[test]
fn masses_are_written_and_read_back() {
    let found = changed("", "").unwrap();
    let back = read("back.toml", "lever", &write(&found)).unwrap().robot;
    let (before, after) = (&found.robot.structure().masses[0], &back.structure().masses[0]);
    assert_eq!(
        (before.mass, before.inertia, before.attachment),
        (after.mass, after.inertia, after.attachment)
    );
    assert!((before.centre - after.centre).norm() < 1e-12);
}
