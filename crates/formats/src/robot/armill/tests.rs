use super::checks::exact_radians;
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
fn every_problem_is_told_at_once_with_its_place() {
    let broken = SMALL
        .replace("limits_deg = [-100, 120]", "limits_deg = [120, -100]")
        .replace("joint = \"B\" }", "joint = \"C\" }")
        .replace("source = \"made-up\"\nmotions", "source = \"hearsay\"\nmotions");
    let text = read("lever.toml", "lever", &broken).unwrap_err().to_string();
    for part in [
        "lever.toml:16:",
        "lower limit 120 deg is not below upper limit -100 deg",
        "joint `C` stands where `B` comes next",
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
fn quarter_turns_are_exact() {
    assert_eq!(exact_radians(-90.0), -std::f64::consts::FRAC_PI_2);
    assert_eq!(exact_radians(180.0), std::f64::consts::PI);
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
