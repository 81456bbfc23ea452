//! Correct tables, and all ways in which they can be wrong.

use super::*;
use armill_core::robot::{Amount, Joint, Limits, Motion};

/// Two revolute joints with limits of 170 degrees and a prismatic one.
fn arm() -> Robot {
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Constant(0.5)),
        Motion::About(Axis::Y, Amount::Joint(1)),
        Motion::Along(Axis::X, Amount::Joint(2)),
    ];
    let limits = |name: &str, far: f64| Joint {
        limits: Some(Limits {
            lower: -far,
            upper: far,
        }),
        ..Joint::plain(name)
    };
    let turn = 170f64.to_radians();
    Robot::new(
        "arm",
        motions,
        vec![limits("A1", turn), limits("A2", turn), limits("Z", 0.8)],
    )
    .unwrap()
}

fn table(text: &str) -> Result<LoadTests, Problems> {
    read("tests.csv", text.as_bytes(), &arm(), Vector3::new(0.0, 0.0, 0.1))
}

fn problems(text: &str) -> String {
    table(text).unwrap_err().to_string()
}

#[test]
fn units_in_the_names_are_converted_to_si() {
    let text = "test,A1_deg,q2_rad,z_mm,fz_kN,mx_n_m,dx_um,dz_mm,d_u_um,gauge_z_mm\n\
                first,90,0.5,250,-0.1,3,120,,5,80\n";
    let found = table(text).unwrap();
    let test = &found.tests[0];
    assert!((test.joints[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(test.joints[1..], [0.5, 0.25]);
    assert_eq!(test.wrench.force, Vector3::new(0.0, 0.0, -100.0));
    assert_eq!(test.wrench.moment, Vector3::new(3.0, 0.0, 0.0));
    assert_eq!(test.force_point, Vector3::new(0.0, 0.0, 0.1));
    assert_eq!(test.measured_point, Vector3::new(0.0, 0.0, 0.08));
    assert_eq!(test.readings.len(), 1, "dz was not measured");
    assert!((test.readings[0].value - 1.2e-4).abs() < 1e-18);
    assert!((test.readings[0].standard_uncertainty - 5e-6).abs() < 1e-18);
    assert!(found.uncertainties_stated);
    assert_eq!(found.names, ["first"]);
}

#[test]
fn semicolons_allow_decimal_commas_and_rows_without_reading_are_skipped() {
    let text = "\u{feff}# my tests\r\nA1_deg;A2_deg;Z_mm;fz_n;dz_mm;expected_dz_mm\r\n\
                10,5;-20;0;-98,1;-0,25;-0,3\r\n;;;;;\r\n30;-20;0;-98,1;;-0,3\r\n";
    let found = table(text).unwrap();
    assert_eq!(found.tests.len(), 1);
    assert_eq!(found.empty_rows, 1);
    assert_eq!(found.names, ["line 3"]);
    assert!((found.tests[0].wrench.force.z + 98.1).abs() < 1e-12);
    assert!((found.tests[0].readings[0].value + 2.5e-4).abs() < 1e-18);
    assert!(!found.uncertainties_stated);
}

#[test]
fn a_rotation_of_one_link_is_read_with_its_joint() {
    let text = "A1_deg,A2_deg,Z_mm,fz_n,joint,turn_mrad\n10,20,0,-50,a2,0.4\n";
    let found = table(text).unwrap();
    assert_eq!(found.tests[0].readings[0].what, Measured::Turn(1));
    assert!((found.tests[0].readings[0].value - 4e-4).abs() < 1e-18);
}

#[test]
fn missing_columns_are_reported_together() {
    let given = problems("A1_deg,note\n10,x\n");
    for part in [
        "tests.csv:1:1: missing joint positions: `A2_deg`, `Z_mm`",
        "missing forces",
        "missing readings",
    ] {
        assert!(given.contains(part), "{given}");
    }
}

#[test]
fn unknown_and_duplicate_columns_are_reported_with_a_suggestion() {
    let given = problems("A1,A2_deg,q2_rad,Z_mm,fz_n,dz_mm,colour\n1,2,3,4,5,6,7\n");
    assert!(
        given.contains("1:1: unknown column `A1`")
            && given.contains("angles carry their unit: write `a1_deg`"),
        "{given}"
    );
    assert!(given.contains("1:11: `q2_rad` repeats `A2_deg`"), "{given}");
    assert!(given.contains("unknown column `colour`"), "{given}");
}

#[test]
fn cells_that_are_not_numbers_are_reported_with_line_and_column() {
    let given =
        problems("A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n10,20,0,-98.1 N,0.1\n,20,0,nan,0.1\n10,20,0,-98,1,0,2\n");
    assert!(
        given.contains("tests.csv:2:9: `-98.1 N` is not a number"),
        "{given}"
    );
    assert!(
        given.contains("tests.csv:3:1: no position of joint A1"),
        "{given}"
    );
    assert!(
        given.contains("tests.csv:3:7: `nan` is not a number from"),
        "{given}"
    );
    assert!(
        given.contains("tests.csv:4:1: 7 cells, but the table has 5 columns"),
        "{given}"
    );
    assert!(given.contains("separate cells with `;`"), "{given}");
}

#[test]
fn reports_uncertainties_and_weights_out_of_range() {
    let given = problems(
        "A1_deg,A2_deg,Z_mm,fz_n,dz_mm,d_u_mm,weight\n10,20,0,-98,0.1,1e-10,1\n10,20,0,-98,0.1,2000,1e7\n\
         10,20,0,-98,0.1,-1,0\n",
    );
    for part in [
        "2:17: `1e-10` is 1e-13 in SI units, not from 1e-12 to 1e0",
        "3:17: `2000` is 2e0 in SI units",
        "3:22: `1e7` is 1e7 in SI units, not from 1e-6 to 1e6",
        "4:17: `-1` is not above 0",
        "4:20: `0` is not above 0",
    ] {
        assert!(given.contains(part), "{given}");
    }
}

#[test]
fn latin_letters_and_lone_carriage_returns_are_read() {
    let text = b"A1_deg,A2_deg,Z_mm,fz_n,dz_mm,note\r10,20,0,-98,0.1,kr\xe4ftig\r30,20,0,-98,0.2,\r";
    let found = read("tests.csv", &text[..], &arm(), Vector3::zeros()).unwrap();
    assert_eq!((found.tests.len(), found.names[1].as_str()), (2, "line 3"));
}

#[test]
fn detects_degrees_named_radians_and_radians_named_degrees() {
    let given = problems("A1_rad,A2_rad,Z_mm,fz_n,dz_mm\n90,20,0,-98,0.1\n-45,30,0,-98,0.1\n");
    assert!(
        given.contains("`A1_rad` contains 90 rad") && given.contains("name the column `A1_deg`"),
        "{given}"
    );
    let given = problems("A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n1.57,0.3,0,-98,0.1\n-0.7,0.5,0,-98,0.1\n");
    assert!(
        given.contains("no joint exceeds 1.57 deg") && given.contains("radians"),
        "{given}"
    );
}

#[test]
fn a_posture_outside_the_limits_is_reported_with_value_limit_and_unit() {
    let given = problems("A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n181,20,900,-98,0.1\n");
    assert!(
        given.contains("joint A1 at 181.0 deg is outside its limits -170.0 to 170.0 deg"),
        "{given}"
    );
    assert!(
        given.contains("joint Z at 900.0 mm is outside its limits -800.0 to 800.0 mm"),
        "{given}"
    );
}

#[test]
fn a_measured_posture_a_little_outside_the_limits_is_used_and_noted() {
    let text = b"A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n173.9,20,0,-98,0.1\n";
    let found = read("tests.csv", &text[..], &arm(), Vector3::zeros()).unwrap();
    assert_eq!(found.tests.len(), 1);
    assert_eq!(
        found.outside_limits,
        ["line 2: joint A1 at 173.9 deg is outside its limits -170.0 to 170.0 deg"]
    );
}

#[test]
fn refuses_files_without_a_table_or_a_reading() {
    assert!(problems("# nothing\n\n").contains("the file has no table"));
    let given = problems("A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n10,20,0,-98,\n");
    assert!(given.contains("none of the 1 rows has a reading"), "{given}");
}

#[test]
fn no_text_causes_a_panic() {
    for text in [
        "",
        ",",
        ";",
        "\"",
        "a\"b,c\n\"",
        "A1_deg\n\u{fffd}",
        "fx_n;\n;;;\n",
        "é,ü\n1,2\n",
    ] {
        assert!(table(text).is_err(), "{text:?}");
    }
}

#[test]
fn a_table_that_is_wrong_everywhere_is_not_reported_in_full() {
    let wide = "x,".repeat(200) + "x\n1\n";
    assert!(problems(&wide).contains("more than 200 columns"));
    let long = format!("A1_deg,A2_deg,Z_mm,fz_n,dz_mm\n{}", "a,b,c,d,e\n".repeat(5000));
    let given = table(&long).unwrap_err();
    // One row may bring several beyond the thousand.
    assert!(
        (1000..1010).contains(&given.as_slice().len()),
        "{}",
        given.as_slice().len()
    );
}
