//! `armill modes`: frequencies, directions and contributors of an arm; what it refuses.

use crate::cell::{Cell, LEVER, number, numbers};

/// A rod on the lever's turning joint: 4 kg m^2 about the axis, which is at its end.
const ROD: &str = r#"
[[mass]]
at = "A"
mass_kg = 3
centre_mm = [1000, 0, 0]
inertia_kg_m2 = [[0, 0, 0], [0, 1, 0], [0, 0, 1]]
source = "made-up"
"#;

/// The lever of 0.5 m with a rigid slide: 1/2e-6 N m/rad on 4 kg m^2.
fn lever(more: &str) -> Cell {
    let cell = Cell::new();
    let rigid = LEVER
        .replace("compliance_um_per_n = 0.02", "compliance_um_per_n = 0")
        .replace(
            "compliance_rad_per_n_m = 2e-6\n",
            "compliance_rad_per_n_m = 2e-6\ncompliance_u_rad_per_n_m = 1e-7\n",
        );
    cell.file("lever.toml", format!("{rigid}{ROD}{more}"));
    cell
}

const AT: [&str; 4] = ["modes", "lever.toml", "--joints-deg", "0,0"];

/// sqrt(k/J)/(2 pi).
const HZ: f64 = 56.269_769_7;

#[test]
fn a_rod_on_a_soft_joint_vibrates_as_the_closed_form_says() {
    let answer = lever("").armill(&[&AT[..], &["--json"]].concat()).fine().json();
    let modes = answer["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 1);
    let mode = &modes[0];
    assert!((number(&mode["frequency_hz"]) - HZ).abs() < 1e-5, "{mode}");
    // The compliance is known to 5 %: the frequency to half of it.
    assert!(
        (number(&mode["frequency_u_hz"]) - 0.025 * HZ).abs() < 1e-5,
        "{mode}"
    );
    assert_eq!(numbers(&mode["direction"]), [0.0, 1.0, 0.0]);
    // J/L^2, and nothing along the lever.
    assert!((number(&mode["modal_mass_along_kg"]) - 16.0).abs() < 1e-9);
    assert!((number(&mode["modal_stiffness_along_n_per_um"]) - 2.0).abs() < 1e-9);
    assert!(mode["modal_mass_kg"][0].is_null() && mode["modal_mass_kg"][2].is_null());
    assert_eq!(mode["shares"][0]["contributor"], "A");
    assert_eq!(
        (
            number(&mode["shares"][0]["share"]),
            number(&mode["shares"][1]["share"])
        ),
        (1.0, 0.0)
    );
    assert_eq!(
        (number(&mode["damping_ratio"]), &answer["damping_assumed"]),
        (0.03, &true.into())
    );
}

#[test]
fn the_text_has_a_table_a_sentence_and_what_was_assumed() {
    let said = lever("").armill(&AT).fine();
    assert!(
        said.out
            .contains("lowest mode 56.3 Hz: 100 % A, moves the tool along y"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("note: damping ratio 0.03 assumed"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("rotors of the motors are neglected"),
        "{}",
        said.out
    );
    let given = lever("[damping]\nratio = 0.01\nsource = \"made-up\"\n")
        .armill(&AT)
        .fine();
    assert!(
        given.out.contains("0.010") && !given.out.contains("assumed for every mode"),
        "{}",
        given.out
    );
}

#[test]
fn rotors_make_the_arm_slower_and_a_tool_mass_too() {
    let motor = "[[motor]]\njoint = \"A\"\nrotor_inertia_kg_m2 = 1e-3\nratio = 100\nsource = \"made-up\"\n";
    let tool = "[[mass]]\nat = \"flange\"\nmass_kg = 40\ncentre_mm = [0, 0, 0]\nsource = \"made-up\"\n";
    // 10 kg m^2 each, in addition to 4.
    for more in [motor, tool] {
        let answer = lever(more).armill(&[&AT[..], &["--json"]].concat()).fine().json();
        let found = number(&answer["modes"][0]["frequency_hz"]);
        assert!((found - HZ * (4.0_f64 / 14.0).sqrt()).abs() < 1e-5, "{found}");
    }
}

#[test]
fn what_is_missing_is_refused_with_what_to_add() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    cell.armill(&AT).refused(&[
        "robot `lever` has no masses",
        "inertia_kg_m2",
        "rotor_inertia_kg_m2",
    ]);
    let soft = lever("");
    soft.armill(&["modes", "lever.toml", "--joints-deg", "0"])
        .refused(&["1 joint positions for the 2 joints"]);
    soft.armill(&[&AT[..], &["--damping-ratio", "1"]].concat())
        .refused(&["a damping ratio of 1 is not a number from 0 to below 1"]);
    soft.armill(&[&AT[..], &["--compliance-rad-per-n-m", "0,0"]].concat())
        .refused(&["all joints and springs are rigid"]);
    soft.armill(&[&AT[..], &["--base", "moon"]].concat())
        .refused(&["has no frame `moon`"]);
    let only_base = ROD.replace("at = \"A\"", "at = \"base\"");
    cell.file("lever.toml", format!("{LEVER}{only_base}"));
    cell.armill(&AT)
        .refused(&["no mass moves when the joints and springs of the arm deflect"]);
}

/// The rod as a URDF: no compliance of its own.
const URDF: &str = r#"<robot name="rod"><link name="base_link"/>
<link name="rod"><inertial><origin xyz="1 0 0"/><mass value="3"/><inertia ixx="0" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="tool0"/>
<joint name="A" type="revolute"><parent link="base_link"/><child link="rod"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="0" velocity="0"/></joint>
<joint name="tip" type="fixed"><parent link="rod"/><child link="tool0"/><origin xyz="0.5 0 0"/></joint></robot>"#;

#[test]
fn a_urdf_brings_its_masses_and_needs_compliances() {
    let cell = Cell::new();
    cell.file("rod.urdf", URDF);
    let at = ["modes", "rod.urdf", "--joints-deg", "0"];
    cell.armill(&at).refused(&[
        "no joint compliance of robot `rod` is known",
        "--compliance-rad-per-n-m",
    ]);
    let answer = cell
        .armill(&[&at[..], &["--compliance-rad-per-n-m", "2e-6", "--json"]].concat())
        .fine()
        .json();
    assert!(
        (number(&answer["modes"][0]["frequency_hz"]) - HZ).abs() < 1e-5,
        "{answer}"
    );
    // No other answer changes by the masses: neither gravity nor a load is asked for.
    let pose = |urdf: &str| {
        let cell = Cell::new();
        cell.file("rod.urdf", urdf);
        let push = [
            "pose",
            "rod.urdf",
            "--joints-deg",
            "10",
            "--compliance-rad-per-n-m",
            "2e-6",
            "--wrench-n",
            "3,4,5",
            "--json",
        ];
        cell.armill(&push).fine().json()["postures"].clone()
    };
    let start = URDF.find("<inertial>").unwrap();
    let end = URDF.find("</inertial>").unwrap() + "</inertial>".len();
    assert_eq!(pose(URDF), pose(&[&URDF[..start], &URDF[end..]].concat()));
}
