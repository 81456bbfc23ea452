use super::*;

const SMALL: &str = r#"
format = 1
name = "lever"
[chain]
source = "made-up"
motions = [
  { along = "z", length_mm = 300 },
  { about = "z", joint = "A" },
  { along = "x", length_mm = 500 },
  { along = "x", joint = "B" },
]
[[joint]]
name = "A"
sign = -1
zero_offset_deg = 90
limits_deg = [-100, 120]
source = "made-up"
compliance_rad_per_n_m = 2e-6
compliance_u_rad_per_n_m = 1e-7
compliance_source = "made-up"
[[joint]]
name = "B"
sign = 1
coupling = [{ joint = "A", factor = 0.5 }]
limits_mm = [0, 250]
source = "made-up"
compliance_um_per_n = 0.02
compliance_source = "made-up"
[sources.made-up]
what = "nothing real"
where = "this test"
licence = "none"
"#;

fn problems(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "the sample has no `{from}`");
    read("lever.toml", "lever", &SMALL.replacen(from, to, 1))
        .unwrap_err()
        .to_string()
}

#[test]
fn lengths_angles_signs_zeros_and_couplings_arrive_in_si() {
    let lever = read("lever.toml", "lever", SMALL).unwrap().robot;
    assert_eq!(lever.joints()[0].limits.unwrap().upper, 120_f64.to_radians());
    assert_eq!(lever.joints()[1].limits.unwrap().upper, 0.25);
    assert_eq!(lever.compliance().unwrap()[1].value, 0.02e-6);
    // A = 90 deg counted against the axis from a zero at 90 deg: chain angle 0. B adds half of A (rad as m).
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(lever.theta(0, &[quarter, 0.0]), 0.0);
    assert_eq!(lever.theta(1, &[0.4, 0.1]), 0.1 + 0.5 * 0.4);
}

#[test]
fn every_problem_is_reported_at_once_with_its_place() {
    let broken = SMALL
        .replace("limits_deg = [-100, 120]", "limits_deg = [120, -100]")
        .replace("joint = \"B\" }", "joint = \"C\" }")
        .replace("source = \"made-up\"\nmotions", "source = \"hearsay\"\nmotions");
    let text = read("lever.toml", "lever", &broken).unwrap_err().to_string();
    for part in [
        "lever.toml:16:",
        "lower limit 120 deg is not below upper limit -100 deg",
        "joint `C` is where `B` is expected",
        "source `hearsay` is not among the sources",
    ] {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

#[test]
fn a_negative_compliance_is_refused() {
    let text = problems("compliance_rad_per_n_m = 2e-6", "compliance_rad_per_n_m = -2e-6");
    assert!(
        text.contains("lever.toml:18:") && text.contains("compliance_rad_per_n_m"),
        "{text}"
    );
}

#[test]
fn a_missing_unit_suffix_is_named_in_the_hint() {
    let text = problems("length_mm = 300", "length = 300");
    assert!(text.contains("length_mm"), "{text}");
}

#[test]
fn a_compliance_without_source_is_refused() {
    let text = problems(
        "compliance_um_per_n = 0.02\ncompliance_source = \"made-up\"",
        "compliance_um_per_n = 0.02",
    );
    assert!(text.contains("joint B: its compliance names no source"), "{text}");
}

#[test]
fn compliance_for_some_joints_only_is_refused() {
    let text = problems(
        "compliance_um_per_n = 0.02\ncompliance_source = \"made-up\"\n",
        "",
    );
    assert!(text.contains("1 of 2 joints have a compliance"), "{text}");
}

#[test]
fn a_chain_without_joint_is_refused() {
    let start = SMALL.find("[[joint]]").unwrap();
    let end = SMALL.find("[sources").unwrap();
    let text = format!("{}joint = []\n{}", &SMALL[..start], &SMALL[end..])
        .replace("joint = []\n", "")
        .replace("name = \"lever\"", "name = \"lever\"\njoint = []")
        .replace("  { about = \"z\", joint = \"A\" },\n", "")
        .replace("  { along = \"x\", joint = \"B\" },\n", "");
    let problems = read("lever.toml", "lever", &text).unwrap_err().to_string();
    assert!(problems.contains("the chain has no joint"), "{problems}");
}

#[test]
fn a_motion_with_two_amounts_is_refused() {
    let text = problems(
        "{ along = \"z\", length_mm = 300 }",
        "{ along = \"z\", length_mm = 300, angle_deg = 4 }",
    );
    assert!(text.contains("exactly one of length, angle and joint"), "{text}");
}

#[test]
fn quarter_turns_are_exact_to_two_turns_and_a_half() {
    // What every reader of degrees relies on: axes that are parallel on paper are parallel in the chain.
    for quarters in -10..=10 {
        let (quarters, quarter) = (f64::from(quarters), std::f64::consts::FRAC_PI_2);
        assert_eq!((90.0 * quarters).to_radians(), quarters * quarter);
    }
}

#[test]
fn limits_in_the_unit_of_the_other_kind_of_joint_are_refused() {
    let text = problems("limits_mm = [0, 250]", "limits_deg = [0, 250]");
    assert!(
        text.contains("joint B slides: `limits_deg` does not fit it") && text.contains("`limits_mm`"),
        "{text}"
    );
    let text = problems("compliance_rad_per_n_m = 2e-6", "compliance_um_per_n = 2e-6");
    assert!(
        text.contains("joint A turns: `compliance_um_per_n` does not fit it"),
        "{text}"
    );
}

#[test]
fn two_joints_of_one_name_are_refused() {
    let text = problems("name = \"B\"", "name = \"A\"");
    assert!(text.contains("another joint is called `A`"), "{text}");
}

/// Springs and masses of the sample in addition to the drives.
const STRUCTURE: &str = r#"
[[spring]]
at = "A"
about = "x"
compliance_rad_per_n_m = 5e-8
compliance_u_rad_per_n_m = 1e-8
source = "made-up"
[[spring]]
at = "flange"
along = "z"
compliance_um_per_n = 0.02
source = "made-up"
[[spring]]
at = "base"
compliance_matrix = [[1e-9,0,0,0,0,0],[0,2e-9,0,0,0,0],[0,0,0,0,0,0],[0,0,0,1e-8,0,0],[0,0,0,0,0,0],[0,0,0,0,0,3e-8]]
source = "made-up"
[[mass]]
at = "A"
mass_kg = 12.5
centre_mm = [100, 0, -50]
source = "made-up"
[compensator]
joint = "A"
fixed_radius_mm = 690
arm_radius_mm = 185
free_length_mm = 458
stiffness_n_per_mm = 4000
angle_deg = 90
source = "made-up"
[covariance]
of = ["A about x", "A"]
matrix_rad2_per_n2_m2 = [[4e-16, 1e-16], [1e-16, 9e-14]]
source = "made-up"
"#;

fn structured(from: &str, to: &str) -> Result<RobotDescription, Problems> {
    assert!(STRUCTURE.contains(from), "the sample has no `{from}`");
    let text = format!("{SMALL}{}", STRUCTURE.replacen(from, to, 1));
    read("lever.toml", "lever", &text)
}

#[test]
fn springs_masses_compensator_and_covariance_arrive_in_si() {
    use armill_core::robot::Attachment;
    let robot = structured("", "").unwrap().robot;
    let s = robot.structure();
    // One about, one along, and the four directions in which the matrix is compliant.
    assert_eq!(s.springs.len(), 6);
    assert_eq!(s.springs[0].attachment, Attachment::Joint(0));
    assert_eq!(s.springs[0].direction.angular, Vector3::x());
    assert_eq!(s.springs[0].compliance.standard_uncertainty, 1e-8);
    assert_eq!(s.springs[1].compliance.value, 0.02 * 1e-6);
    assert!(
        s.springs[2..]
            .iter()
            .all(|spring| spring.attachment == Attachment::Base)
    );
    assert_eq!(s.masses[0].mass, 12.5);
    assert!((s.masses[0].centre.z + 0.05).abs() < 1e-17);
    let compensator = s.compensator.unwrap();
    assert_eq!((compensator.joint, compensator.stiffness), (0, 4e6));
    assert_eq!(compensator.angle, std::f64::consts::FRAC_PI_2);
    // Drives A, B, then the springs: A and `A about x` are tied, the rest keep their own squares.
    let covariance = s.covariance.as_ref().unwrap();
    assert_eq!(
        (covariance[(0, 0)], covariance[(2, 2)], covariance[(0, 2)]),
        (9e-14, 4e-16, 1e-16)
    );
    assert_eq!(covariance[(1, 1)], 0.0);
}

#[test]
fn a_torque_curve_replaces_a_compliance() {
    let curve = "torque_curve_n_m_rad = [[-100, -2e-4], [100, 2e-4], [300, 3e-4]]";
    let text = SMALL.replace("compliance_rad_per_n_m = 2e-6", curve);
    let robot = read("lever.toml", "lever", &text).unwrap().robot;
    assert!((robot.compliance().unwrap()[0].value - 2e-6).abs() < 1e-20);
    assert_eq!(robot.structure().curve(0).unwrap().rising.points().len(), 3);
    assert!(robot.structure().curve(1).is_none());
    for (wrong, said) in [
        ("torque_curve_n_m_rad = [[0, 0]]", "at least 2 are needed"),
        ("torque_curve_n_m_rad = [[0, 0], [10, -1e-5]]", "does not rise"),
        (
            "torque_curve_falling_n_m_rad = [[0, 0], [10, 1e-5]]",
            "without the rising one",
        ),
        (
            "compliance_rad_per_n_m = 2e-6\ntorque_curve_n_m_rad = [[0, 0], [10, 1e-5]]",
            "both a compliance",
        ),
    ] {
        let text = SMALL.replace("compliance_rad_per_n_m = 2e-6", wrong);
        let problems = read("lever.toml", "lever", &text).unwrap_err().to_string();
        assert!(problems.contains(said), "no `{said}` in:\n{problems}");
    }
    let slides = SMALL.replace(
        "compliance_um_per_n = 0.02",
        "torque_curve_n_m_rad = [[0, 0], [10, 1e-5]]",
    );
    let problems = read("lever.toml", "lever", &slides).unwrap_err().to_string();
    assert!(problems.contains("joint B slides"), "{problems}");
}

#[test]
fn backlash_is_read_in_the_unit_of_its_joint_and_needs_a_source() {
    let with = |of_a: &str, of_b: &str| {
        let text = SMALL
            .replace(
                "compliance_rad_per_n_m = 2e-6",
                &format!("compliance_rad_per_n_m = 2e-6\n{of_a}"),
            )
            .replace(
                "compliance_um_per_n = 0.02",
                &format!("compliance_um_per_n = 0.02\n{of_b}"),
            );
        read("lever.toml", "lever", &text)
    };
    let sourced = |backlash: &str| format!("{backlash}\nbacklash_source = \"made-up\"");
    let of_a = sourced("backlash_deg = 0.018\nbacklash_u_deg = 0.0018\nbacklash_side = \"torque\"");
    let robot = with(&of_a, &sourced("backlash_mm = 0.05")).unwrap().robot;
    let gaps: Vec<_> = robot
        .structure()
        .joints_with_backlash()
        .map(|(_, backlash)| *backlash)
        .collect();
    assert_eq!(gaps[0].side, armill_core::robot::BacklashSide::Torque);
    assert_eq!(gaps[1].side, armill_core::robot::BacklashSide::Motion);
    let given = [
        gaps[0].gap,
        gaps[0].standard_uncertainty,
        gaps[1].gap,
        gaps[1].standard_uncertainty,
    ];
    for (given, meant) in given
        .into_iter()
        .zip([0.018_f64.to_radians(), 0.0018_f64.to_radians(), 5e-5, 0.0])
    {
        assert!((given - meant).abs() < 1e-18, "{given} {meant}");
    }
    assert!(
        read("lever.toml", "lever", SMALL)
            .unwrap()
            .robot
            .structure()
            .joints_with_backlash()
            .next()
            .is_none()
    );
    for (of_a, of_b, said) in [
        ("backlash_deg = 0.01", "", "joint A: its backlash names no source"),
        (
            &sourced("backlash_mm = 0.01")[..],
            "",
            "joint A turns: `backlash_mm` does not fit it",
        ),
        (
            "",
            &sourced("backlash_deg = 0.01")[..],
            "joint B slides: `backlash_deg` does not fit it",
        ),
        (
            "backlash_u_deg = 0.01",
            "",
            "backlash details are given without a backlash",
        ),
        (&sourced("backlash_deg = -0.01")[..], "", "-0.01"),
        (
            &sourced("backlash_deg = 0.01\nbacklash_side = \"gravity\"")[..],
            "",
            "gravity",
        ),
        (
            "backlash_deg = 0.01\nbacklash_source = \"missing\"",
            "",
            "missing",
        ),
    ] {
        let problems = with(of_a, of_b).unwrap_err().to_string();
        assert!(problems.contains(said), "no `{said}` in:\n{problems}");
    }
}

#[test]
fn a_wrong_structure_is_refused_with_place_and_hint() {
    for (from, to, said) in [
        (
            "at = \"A\"\nabout",
            "at = \"C\"\nabout",
            "`C` is not a part of the arm",
        ),
        (
            "about = \"x\"\n",
            "",
            "turns `about` an axis or slides `along` one",
        ),
        (
            "about = \"x\"",
            "along = \"x\"",
            "the unit of the compliance does not fit the axis",
        ),
        ("compliance_um_per_n = 0.02\n", "", "the spring has no compliance"),
        ("[[1e-9,0,", "[[1e-9,5e-9,", "is not symmetric"),
        ("[[1e-9,0,", "[[-1e-9,0,", "negative eigenvalue"),
        (
            "at = \"base\"\n",
            "at = \"base\"\nabout = \"z\"\n",
            "either an axis or a whole matrix",
        ),
        ("mass_kg = 12.5", "mass_kg = -1", "mass_kg"),
        (
            "joint = \"A\"\nfixed",
            "joint = \"Z\"\nfixed",
            "`Z` is not a joint of the arm",
        ),
        (
            "arm_radius_mm = 185",
            "arm_radius_mm = 690",
            "differ by less than 1 mm",
        ),
        (
            "of = [\"A about x\", \"A\"]",
            "of = [\"A about x\", \"A about z\"]",
            "`A about z` is not a compliance",
        ),
        (
            "of = [\"A about x\", \"A\"]",
            "of = [\"A\", \"A\"]",
            "is given twice",
        ),
        (
            "of = [\"A about x\", \"A\"]",
            "of = [\"B\", \"A\"]",
            "`B` is a translation",
        ),
        (
            "of = [\"A about x\", \"A\"]",
            "of = [\"A\"]",
            "needs 1 rows of 1 numbers",
        ),
        ("[1e-16, 9e-14]", "[1e-16, -9e-14]", "negative eigenvalue"),
    ] {
        let problems = structured(from, to).unwrap_err().to_string();
        assert!(problems.contains(said), "no `{said}` in:\n{problems}");
        assert!(problems.contains("lever.toml:"), "no place in:\n{problems}");
    }
}

#[test]
fn the_first_joints_may_be_external_axes_and_no_others() {
    let external = |joint: &str| {
        let name = format!("name = \"{joint}\"");
        SMALL.replace(&name, &format!("{name}\nexternal = true"))
    };
    let lever = read("lever.toml", "lever", &external("A")).unwrap().robot;
    assert!(lever.is_external(0) && !lever.is_external(1));
    let error = read("lever.toml", "lever", &external("B"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("joint `B` is behind a joint of the arm"),
        "{error}"
    );
    let both = external("A").replace("name = \"B\"", "name = \"B\"\nexternal = true");
    let error = read("lever.toml", "lever", &both).unwrap_err().to_string();
    assert!(error.contains("all 2 joints are external axes"), "{error}");
}
