use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use armill_core::frame::Isometry;
use armill_core::nalgebra::Matrix4;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::joint::Sign;

use super::*;

/// Puma 560, standard convention. Numbers: P. Corke, Robotics Toolbox for Python, models/DH/Puma560.py (MIT), typed.
const PUMA: &str = "\
convention = standard
name = Puma 560
a_m, alpha_deg, d_m, theta_deg
0, 90, 0, 0
0.4318, 0, 0, 0
0.0203, -90, 0.15005, 0
0, 90, 0.4318, 0
0, -90, 0, 0
0, 0, 0, 0
";

/// Yaskawa MH12 in modified rows, heights from the axes of S and L. Numbers: SaltworkerMLU/robotkinematicscatalogue,
/// typed.
const MH12: &str = "\
# alpha and a lead from the axis before
convention = modified
joint; alpha_deg; a_mm; d_mm; theta_deg; sign; lower_deg; upper_deg
S; 0; 0; 0; 0; 1; -170; 170
L; -90; 155,0; 0; -90; 1; -90; 155
U; 0; 614; 0; 0; -1; -85; 150
R; -90; 200; 640; 0; -1; -180; 180
B; 90; 0; 0; 0; -1; ;
T; -90; 0; 100; 0; -1; -360; 360
";

fn flange(text: &str, q: &[f64]) -> Matrix4<f64> {
    let robot = read("a.dh", "a", text).unwrap().robot;
    posture_at(&robot, q, &Isometry::identity())
        .base_from_tool
        .to_homogeneous()
}

fn refusal(text: &str) -> String {
    read("a.dh", "a", text).unwrap_err().to_string()
}

#[test]
fn the_puma_matches_the_pose_of_its_toolbox() {
    // `p560.fkine(p560.qz)` and `p560.fkine(p560.qn)`, printed to four decimals.
    let zero = flange(PUMA, &[0.0; 6]);
    let expected = [0.4521, -0.15005, 0.4318];
    for (row, value) in expected.into_iter().enumerate() {
        assert!((zero[(row, 3)] - value).abs() < 1e-12, "{zero}");
    }
    let nominal = flange(PUMA, &[0.0, FRAC_PI_4, PI, 0.0, FRAC_PI_4, 0.0]);
    #[rustfmt::skip]
    let expected = Matrix4::new(
        0.0, 0.0, 1.0, 0.5963,
        0.0, 1.0, 0.0, -0.15005,
        -1.0, 0.0, 0.0, -0.01435,
        0.0, 0.0, 0.0, 1.0,
    );
    // Half of the last digit printed.
    assert!((nominal - expected).amax() < 5e-5, "{nominal}");
}

#[test]
fn modified_rows_give_the_mh12_of_its_urdf() {
    // Flange at zero by the URDF (0.895, 0, 1.264) m, 0.45 m of it below this table's frame 0.
    let zero = flange(MH12, &[0.0; 6]);
    for (row, value) in [0.895, 0.0, 0.814].into_iter().enumerate() {
        assert!((zero[(row, 3)] - value).abs() < 1e-12, "{zero}");
    }
    // U raises the forearm where it counts up.
    let raised = flange(MH12, &[0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
    assert!(raised[(2, 3)] > zero[(2, 3)], "{raised}");
}

/// The link matrices as Craig prints them (eq. 3.6) and as Denavit and Hartenberg's are printed in textbooks.
fn link(convention: Convention, [a, alpha, d, theta]: [f64; 4]) -> Matrix4<f64> {
    let ((sa, ca), (st, ct)) = (alpha.sin_cos(), theta.sin_cos());
    #[rustfmt::skip]
    let matrix = match convention {
        Convention::Modified => Matrix4::new(
            ct, -st, 0.0, a,
            st * ca, ct * ca, -sa, -sa * d,
            st * sa, ct * sa, ca, ca * d,
            0.0, 0.0, 0.0, 1.0,
        ),
        Convention::Standard => Matrix4::new(
            ct, -st * ca, st * sa, a * ct,
            st, ct * ca, -ct * sa, a * st,
            0.0, sa, ca, d,
            0.0, 0.0, 0.0, 1.0,
        ),
        Convention::Hayati => unreachable!("its matrix has five parameters"),
    };
    matrix
}

#[test]
fn both_conventions_are_the_products_of_the_textbooks() {
    let rows = [
        [0.3, 0.4, 0.5, 0.6],
        [-0.1, -1.2, 0.0, 2.0],
        [0.7, 1.5, -0.2, -0.3],
    ];
    let q = [0.3, -0.2, 0.9];
    for (label, convention) in [
        ("standard", Convention::Standard),
        ("modified", Convention::Modified),
    ] {
        let mut text = format!("convention = {label}\ntype a_m alpha_rad d_m theta_rad sign\n");
        let mut expected = Matrix4::identity();
        for (index, [a, alpha, d, theta]) in rows.into_iter().enumerate() {
            // The second joint slides, the third counts the other way.
            let (kind, sign) = (["r", "p", "r"][index], [1.0, 1.0, -1.0][index]);
            text.push_str(&format!("{kind} {a} {alpha} {d} {theta} {sign}\n"));
            let moved = sign * q[index];
            let row = if kind == "p" {
                [a, alpha, d + moved, theta]
            } else {
                [a, alpha, d, theta + moved]
            };
            expected *= link(convention, row);
        }
        text.push_str("fixed 0.1 0.2 0.3 0.4 1\n");
        expected *= link(convention, [0.1, 0.2, 0.3, 0.4]);
        assert!((flange(&text, &q) - expected).norm() < 1e-14, "{label}");
    }
}

#[test]
fn limits_signs_and_names_are_taken() {
    let found = read("a.dh", "a", MH12).unwrap();
    let joints = found.robot.joints();
    assert_eq!(joints[2].name, "U");
    assert_eq!(joints[2].sign, Sign::Negative);
    assert!((joints[0].limits.unwrap().upper - 170_f64.to_radians()).abs() < 1e-15);
    assert_eq!(joints[4].limits, None);
    assert_eq!(read("a.dh", "a", PUMA).unwrap().title, "Puma 560");
}

#[test]
fn without_label_both_meanings_are_explained() {
    for text in [
        MH12.replace("convention = modified\n", ""),
        MH12.replace("= modified", "= craig86"),
    ] {
        let text = refusal(&text);
        for words in [
            "convention = standard",
            "Rz(theta) Tz(d) Tx(a) Rx(alpha)",
            "Craig: Rx(alpha)",
        ] {
            assert!(text.contains(words), "no `{words}` in {text}");
        }
    }
}

#[test]
fn columns_need_their_units_and_all_four_are_needed() {
    for (column, words) in [
        ("a", "a.dh:3:19: column `a` names no unit"),
        ("a_deg", "column `a_deg` has a unit that does not fit `a`"),
        ("a_inch", "unknown column `a_inch`"),
        ("d_m", "two columns contain `d`"),
    ] {
        let text = refusal(&MH12.replace("a_mm;", &format!("{column};")));
        assert!(text.contains(words), "no `{words}` in {text}");
    }
    assert!(refusal(&MH12.replace("a_mm", "type")).contains("no column contains `a`"));
}

#[test]
fn every_cell_that_is_wrong_is_reported() {
    let broken = MH12
        .replace("L; -90", "L; ninety")
        .replace("0; -1; -85; 150", "0; -2; -85; 150")
        .replace("0; -1; -180; 180", "0; -1; 180; -180")
        .replace("B;", "S;")
        .replace("100; 0;", "1e9; 0;")
        .replace("T; -90", "T; -900");
    let text = refusal(&broken);
    for words in [
        "a.dh:5:4: `ninety` is not a number",
        "`-2` is not 1 or -1",
        "`-180` is an upper limit not above the lower one",
        "another joint is called `S`",
        "`1e9` is beyond 1000 m",
        "`-900` is an angle beyond two turns",
    ] {
        assert!(text.contains(words), "no `{words}` in {text}");
    }
    // A robot file could not contain it.
    let turned = refusal(&MH12.replace("T; -90", "T; -690"));
    assert!(turned.contains("`-690` is an angle beyond a turn"), "{turned}");
    assert!(refusal(&MH12.replace("S; 0; 0; 0;", "S; 0; 0;")).contains("7 cells where the header has 8"));
    assert!(refusal("convention = standard\n").contains("no header"));
    assert!(refusal("convention = standard\na_m, alpha_deg, d_m, theta_deg\n").contains("no row"));
}

#[test]
fn a_limit_on_one_side_alone_is_reported() {
    let lower = refusal(&MH12.replace("-1; ;", "-1; -120;"));
    assert!(
        lower.contains("`-120` is a lower limit without an upper one"),
        "{lower}"
    );
    let upper = refusal(&MH12.replace("-85; 150", "; 150"));
    assert!(
        upper.contains("`150` is an upper limit without a lower one"),
        "{upper}"
    );
}

#[test]
fn a_table_of_more_rows_than_any_arm_has_is_refused() {
    let rows = |count: usize| {
        format!(
            "convention = standard\na_mm alpha_deg d_mm theta_deg\n{}",
            "0 0 0 0\n".repeat(count)
        )
    };
    assert!(refusal(&rows(65)).contains("more than 64 rows"));
    assert!(read("a.dh", "a", &rows(64)).is_ok());
}

/// The link matrix of Hayati and Mirmirani (1985), eq. (3), with an offset along z.
#[test]
fn the_convention_of_hayati_has_a_turn_about_y_at_the_end_of_a_row() {
    let [a, alpha, beta, d, theta] = [0.7, 0.02, -0.03, 0.1, 0.6_f64];
    let text = format!(
        "convention = hayati\ntype a_m alpha_rad beta_rad d_m theta_rad\nr {a} {alpha} {beta} {d} {theta}\n"
    );
    let ((sa, ca), (sb, cb), (st, ct)) = (alpha.sin_cos(), beta.sin_cos(), (theta + 0.4).sin_cos());
    #[rustfmt::skip]
    let expected = Matrix4::new(
        ct * cb - st * sa * sb, -st * ca, ct * sb + st * sa * cb, a * ct,
        st * cb + ct * sa * sb, ct * ca, st * sb - ct * sa * cb, a * st,
        -ca * sb, sa, ca * cb, d,
        0.0, 0.0, 0.0, 1.0,
    );
    assert!((flange(&text, &[0.4]) - expected).norm() < 1e-15);
}

#[test]
fn beta_is_a_column_of_hayati_alone() {
    let refused = |text: &str| read("t.dh", "t", text).unwrap_err().to_string();
    let with = refused("convention = standard\na_m alpha_rad beta_rad d_m theta_rad\n0 0 0 0 0\n");
    assert!(with.contains("`beta` in another convention"), "{with}");
    let without = refused("convention = hayati\na_m alpha_rad d_m theta_rad\n0 0 0 0\n");
    assert!(without.contains("no column contains `beta`"), "{without}");
}
