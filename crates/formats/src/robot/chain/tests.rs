use std::f64::consts::FRAC_PI_2;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Isometry3, Rotation3, Vector3};
use armill_core::robot::inverse::posture_at;

use super::*;

/// Yaskawa MH12, lengths of ros-industrial/motoman (Apache-2.0), typed.
const MH12: &str = "\
# MH12 as its URDF counts
Tz(450) Rz(q1) Tx(155) Ry(q2) Tz(614) Ry(-q3) Tz(200) Rx(-q4) Tx(640)
Ry(-q5) Rx(-q6) Tx(100) Ry(-90) Rx(180)
";

/// The same by eq. 6 of the paper.
const PAPER: &str = "\
H = 450
sx = 155
sz = 0
lz = 614
ux = 0
uz = 200
rx = 640
bx = 0
tx = 100
A = A^3(H) A^6(phi) A^1(sx) A^3(sz) A^5(psi1) A^3(lz) A^5(psi2) A^1(ux)
A3(uz) * A4(theta1) * A1(rx) * A5(psi3) * A1(bx) * A4(theta2) * A1(tx) A5(-90) A4(180)
";

fn flange(text: &str, q: &[f64]) -> Isometry {
    let robot = read("a.chain", "a", text).unwrap().robot;
    posture_at(&robot, q, &Isometry::identity()).base_from_tool
}

fn refusal(text: &str) -> String {
    read("a.chain", "a", text).unwrap_err().to_string()
}

#[test]
fn the_flange_at_zero_matches_the_urdf() {
    let at = flange(MH12, &[0.0; 6]).translation.vector;
    assert!((at - Vector3::new(0.895, 0.0, 1.264)).norm() < 1e-15, "{at}");
}

#[test]
fn factors_are_products_of_matrices() {
    let q = [0.3, 0.2, -0.7];
    let text = "Tx(100) Ry(q1-30) Tz(q2+50)*Rx(90-phi) Ty(-20)";
    let turn = |axis: Vector3<f64>, angle: f64| {
        Isometry3::from_parts(Default::default(), Rotation3::new(axis * angle).into())
    };
    let expected = Isometry3::translation(0.1, 0.0, 0.0)
        * turn(Vector3::y(), q[0] - 30_f64.to_radians())
        * Isometry3::translation(0.0, 0.0, q[1] + 0.05)
        * turn(Vector3::x(), FRAC_PI_2 - q[2])
        * Isometry3::translation(0.0, -0.02, 0.0);
    let apart = flange(text, &q).to_homogeneous() - expected.to_homogeneous();
    assert!(apart.norm() < 1e-15, "{apart}");
}

#[test]
fn the_form_of_the_paper_is_the_same_arm() {
    let q = [0.4, -0.3, 0.7, 1.1, -0.6, 2.0];
    // The paper turns U, R, B, T by the right hand.
    let paper = [q[0], q[1], -q[2], -q[3], -q[4], -q[5]];
    let apart = flange(MH12, &q).to_homogeneous() - flange(PAPER, &paper).to_homogeneous();
    assert!(apart.norm() < 1e-14, "{apart}");
    let found = read("a.chain", "a", PAPER).unwrap();
    assert_eq!(found.symbols[0].as_deref(), Some("H"));
    let names: Vec<&str> = found
        .robot
        .joints()
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, ["phi", "psi1", "psi2", "theta1", "psi3", "theta2"]);
}

#[test]
fn a_length_without_value_is_no_slide() {
    let text = refusal(&PAPER.replace("sx = 155\n", ""));
    assert!(
        text.contains("a.chain:9:25: the length `sx` has no value") && text.contains("sx = 155"),
        "{text}"
    );
}

#[test]
fn every_word_that_is_not_a_factor_is_reported() {
    let text = refusal("Tz(450) Rw(q1) Tx 155 Ry(q2 Tz(q2*3) A7(1) Rz(q1+q2) Rz() Rz(q9) Rx(q9) Tx(1e9)");
    for words in [
        "`Rw` is not an elementary motion",
        "`Tx` has no bracket",
        "the bracket of `Ry` is not closed",
        "`A7` is not an elementary motion",
        "`q2` is a second joint in one factor",
        "a number, joint or symbol is missing here",
        "1000000000 mm is beyond 1000000 mm",
    ] {
        assert!(text.contains(words), "no `{words}` in {text}");
    }
    assert!(refusal("Rz(q1) Tx(1) Ry(q1)").contains("a.chain:1:14: joint `q1` moves a second time"));
    assert!(refusal("Tz(450)").contains("no joint"));
    assert!(refusal("H = tall\nTz(H) Rz(q1)").contains("`H = tall` defines nothing"));
}

#[test]
fn a_second_sign_is_reported_rather_than_dropped() {
    for (text, place) in [
        ("Rz(q1--90)", "a.chain:1:7:"),
        ("Rz(q1) Tz(--5)", "a.chain:1:12:"),
        ("Rz(q1 + -90)", "a.chain:1:9:"),
    ] {
        let given = refusal(text);
        assert!(
            given.contains(place) && given.contains("a number, joint or symbol is missing here"),
            "{given}"
        );
    }
}

#[test]
fn more_joints_than_any_arm_has_are_refused() {
    let chain = |count: usize| {
        (0..count)
            .map(|joint| format!("Rz(q{joint}) "))
            .collect::<String>()
    };
    assert!(refusal(&chain(65)).contains("more than 64 joints move"));
    assert!(read("a.chain", "a", &chain(64)).is_ok());
}
