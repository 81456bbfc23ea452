//! Modes against closed forms of planar arms, and of the arm of a robot against its compliance.

use std::f64::consts::FRAC_PI_3;

use nalgebra::{Matrix3, Point3, Vector3};

use super::*;
use crate::arms;
use crate::dynamics::receptance;
use crate::frame::Isometry;
use crate::robot::{
    Amount, Attachment, Axis, Joint, JointCompliance, Mass, Motion, Motor, Robot, Spring, Structure,
};
use crate::source::{Arm, ArmState, StiffnessModel};

/// A link of a planar arm: length, centre of mass from its joint (m), mass (kg), inertia about the centre (kg m^2), stiffness of its
/// joint (N m/rad).
#[derive(Clone, Copy)]
struct Link {
    l: f64,
    c: f64,
    m: f64,
    i: f64,
    k: f64,
}

const LINKS: [Link; 3] = [
    Link {
        l: 0.9,
        c: 0.4,
        m: 60.0,
        i: 5.0,
        k: 2e6,
    },
    Link {
        l: 0.7,
        c: 0.3,
        m: 25.0,
        i: 1.2,
        k: 8e5,
    },
    Link {
        l: 0.3,
        c: 0.1,
        m: 9.0,
        i: 0.1,
        k: 1e5,
    },
];

/// Modes of the arm of these links in the plane z = 0, axes along z, the tool at the end of the last link.
fn planar(links: &[Link], q: &[f64], change: impl Fn(&mut Structure)) -> ArmModes {
    of_planar(links, q, change, |state| state.modes().unwrap())
}

/// A value of this arm.
fn of_planar<T>(
    links: &[Link],
    q: &[f64],
    change: impl Fn(&mut Structure),
    value: impl FnOnce(&mut ArmState<'_>) -> T,
) -> T {
    let mut motions = Vec::new();
    for (index, link) in links.iter().enumerate() {
        motions.push(Motion::About(Axis::Z, Amount::Joint(index)));
        motions.push(Motion::Along(Axis::X, Amount::Constant(link.l)));
    }
    let joints = (0..links.len()).map(|index| Joint::plain(format!("J{}", index + 1)));
    let robot = Robot::new("planar", motions, joints.collect()).unwrap();
    let mass = |(index, link): (usize, &Link)| Mass {
        attachment: Attachment::Joint(index),
        mass: link.m,
        centre: Point3::new(link.c, 0.0, 0.0),
        // Inertia about x and y has no effect.
        inertia: Some(Matrix3::from_diagonal(&Vector3::new(7.0, 7.0, link.i))),
        relative_uncertainty: 0.0,
    };
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.masses = links.iter().enumerate().map(mass).collect();
    change(&mut model.structure);
    let compliance: Vec<JointCompliance> = links
        .iter()
        .map(|link| JointCompliance {
            value: 1.0 / link.k,
            standard_uncertainty: 0.0,
        })
        .collect();
    let tool = Isometry::identity();
    let mut state = ArmState::new(Arm {
        robot: &robot,
        compliance: &compliance,
        model: &model,
        flange_from_tool: &tool,
    });
    state.set_joints(q);
    value(&mut state)
}

fn squares(found: &ArmModes) -> Vec<f64> {
    let modes = found.modes.iter();
    modes.map(|mode| mode.at_tool.angular_frequency.powi(2)).collect()
}

fn near(found: f64, expected: f64) {
    // Some roundings of a matrix whose eigenvalues differ by a factor of 1e3.
    assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
}

#[test]
fn one_link_vibrates_with_k_over_its_inertia_about_the_joint() {
    let link = LINKS[0];
    let found = planar(&[link], &[0.4], |_| ());
    let about_joint = link.i + link.m * link.c * link.c;
    near(squares(&found)[0], link.k / about_joint);
    let mode = &found.modes[0];
    assert_eq!(mode.shares, [1.0]);
    // The tool moves across the link, by l per radian: modal mass I/l^2.
    let across = Vector3::new(-0.4_f64.sin(), 0.4_f64.cos(), 0.0);
    near(mode.modal_mass(&across), about_joint / (link.l * link.l));
    assert_eq!(mode.at_tool.damping_ratio, ASSUMED_DAMPING);
}

#[test]
fn a_rotor_adds_its_inertia_times_the_ratio_squared() {
    let link = LINKS[0];
    let found = planar(&[link], &[0.4], |structure| {
        structure.motors = vec![Motor {
            joint: 0,
            rotor_inertia: 3e-3,
            ratio: 130.0,
        }];
    });
    near(
        squares(&found)[0],
        link.k / (link.i + link.m * link.c * link.c + 3e-3 * 16_900.0),
    );
}

#[test]
fn two_links_have_the_roots_of_the_characteristic_equation() {
    let [a, b, _] = LINKS;
    for bend in [0.0_f64, 0.8, FRAC_PI_3, 2.5] {
        let found = planar(&[a, b], &[0.3, bend], |_| ());
        // Textbook mass matrix of the planar arm of two links.
        let h = b.m * a.l * b.c * bend.cos();
        let m22 = b.i + b.m * b.c * b.c;
        let m12 = m22 + h;
        let m11 = a.i + a.m * a.c * a.c + b.m * a.l * a.l + m22 + 2.0 * h;
        // det(K - w2 M) = 0
        let (p, q, r) = (m11 * m22 - m12 * m12, a.k * m22 + b.k * m11, a.k * b.k);
        let root = (q * q - 4.0 * p * r).sqrt();
        near(squares(&found)[0], 2.0 * r / (q + root));
        near(squares(&found)[1], (q + root) / (2.0 * p));
    }
}

#[test]
fn three_links_have_the_eigenvalues_of_the_textbook_matrix() {
    let [a, b, c] = LINKS;
    let q = [0.3, -1.1, 0.7];
    let found = planar(&LINKS, &q, |_| ());
    // In absolute angles, then in joint angles.
    let turns = [q[0], q[0] + q[1], q[0] + q[1] + q[2]];
    let cos = |i: usize, j: usize| (turns[i] - turns[j]).cos();
    let m12 = (b.m * b.c + c.m * b.l) * a.l * cos(0, 1);
    let (m13, m23) = (c.m * c.c * a.l * cos(0, 2), c.m * c.c * b.l * cos(1, 2));
    let absolute = Matrix3::new(
        a.i + a.m * a.c * a.c + (b.m + c.m) * a.l * a.l,
        m12,
        m13,
        m12,
        b.i + b.m * b.c * b.c + c.m * b.l * b.l,
        m23,
        m13,
        m23,
        c.i + c.m * c.c * c.c,
    );
    let sums = Matrix3::new(1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0);
    let mass = sums.transpose() * absolute * sums;
    let stiffness = Matrix3::from_diagonal(&Vector3::new(a.k, b.k, c.k));
    // Not symmetric: another method than the one tested.
    let mut expected: Vec<f64> = (mass.try_inverse().unwrap() * stiffness)
        .complex_eigenvalues()
        .iter()
        .map(|value| value.re)
        .collect();
    expected.sort_by(f64::total_cmp);
    for (found, expected) in squares(&found).into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }
}

#[test]
fn dampers_in_proportion_to_the_stiffness_give_b_omega_over_2() {
    let b = 1e-4;
    let found = planar(&LINKS, &[0.3, -1.1, 0.7], |structure| {
        structure.damping = Some(Damping::Joints(LINKS.map(|link| b * link.k).to_vec()));
    });
    for mode in &found.modes {
        near(
            mode.at_tool.damping_ratio,
            0.5 * b * mode.at_tool.angular_frequency,
        );
    }
    let given = planar(&LINKS, &[0.3, -1.1, 0.7], |structure| {
        structure.damping = Some(Damping::Ratio(0.017));
    });
    assert!(given.modes.iter().all(|mode| mode.at_tool.damping_ratio == 0.017));
}

#[test]
fn a_motion_without_mass_has_no_mode_but_a_compliance() {
    // The last joint carries nothing.
    let mut links = LINKS;
    (links[2].m, links[2].i) = (0.0, 0.0);
    let q = [0.3, -1.1, 0.7];
    let found = planar(&links, &q, |_| ());
    let without = planar(&links[..2], &q[..2], |_| ());
    assert_eq!(found.modes.len(), 2);
    for (one, other) in squares(&found).into_iter().zip(squares(&without)) {
        near(one, other);
    }
    let turn = found.static_compliance[(5, 5)];
    near(turn, 1.0 / links[2].k);
}

/// The arm of the library with bodies on all links, springs and a tool.
fn heavy_arm(run: impl Fn(&mut ArmState<'_>)) {
    let robot = &arms::ALL[1];
    let body = |attachment, mass| Mass {
        attachment,
        mass,
        centre: Point3::new(0.05, -0.1, 0.2),
        inertia: Some(Matrix3::identity() * (0.01 * mass)),
        relative_uncertainty: 0.0,
    };
    let spring = |attachment, axis| {
        let compliance = JointCompliance {
            value: 1e-7,
            standard_uncertainty: 0.0,
        };
        Spring::about(attachment, axis, compliance)
    };
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.masses = (0..6)
        .map(|joint| body(Attachment::Joint(joint), 300.0 / (1.0 + joint as f64)))
        .chain([body(Attachment::Base, 400.0), body(Attachment::Tool, 20.0)])
        .collect();
    model.structure.springs = vec![
        spring(Attachment::Base, Vector3::y()),
        spring(Attachment::Joint(1), Vector3::x()),
    ];
    model.structure.compensator = Some(arms::compensator(1));
    let tool = arms::bent_tool();
    let mut state = ArmState::new(Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: &model,
        flange_from_tool: &tool,
    });
    let mut stream = arms::Stream(3);
    for _ in 0..20 {
        state.set_joints(&stream.joints(robot));
        run(&mut state);
    }
}

#[test]
fn receptance_at_zero_is_the_compliance_of_the_arm() {
    heavy_arm(|state| {
        let compliance = state.compliance().unwrap();
        let found = state.modes().unwrap();
        assert_eq!(found.modes.len(), 8);
        let modes: Vec<Mode> = found.modes.iter().map(|mode| mode.at_tool).collect();
        let still = receptance(&modes, 0.0).map(|part| part.re);
        assert!((still - compliance).amax() < 1e-10 * compliance.amax());
        assert_eq!(found.static_compliance, Matrix6::zeros());
    });
}

#[test]
fn modes_are_normalised_orthogonal_and_satisfy_the_equation_of_motion() {
    heavy_arm(|state| {
        let (mass, found) = (state.mass_matrix(), state.modes().unwrap());
        let compliances = state.tangent_compliances().unwrap();
        let mut last = 0.0;
        for mode in &found.modes {
            let omega = mode.at_tool.angular_frequency;
            assert!(omega >= last);
            last = omega;
            assert!((mode.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let x = nalgebra::DVector::from_column_slice(&mode.deflections);
            // C M x = x / omega^2
            let inertia = &mass * &x;
            for k in 0..8 {
                let static_turn = compliances[k] * inertia[k] * omega * omega;
                assert!(
                    (static_turn - x[k]).abs() < 1e-8 * x.amax(),
                    "{static_turn} {}",
                    x[k]
                );
            }
            for other in &found.modes {
                let y = nalgebra::DVector::from_column_slice(&other.deflections);
                let expected = if std::ptr::eq(mode, other) { 1.0 } else { 0.0 };
                assert!((y.dot(&inertia) - expected).abs() < 1e-8);
            }
        }
    });
}

#[test]
fn the_uncertainty_of_a_frequency_is_half_that_of_the_compliances() {
    let found = planar(&LINKS, &[0.3, -1.1, 0.7], |_| ());
    let compliances = LINKS.map(|link| 1.0 / link.k);
    for mode in &found.modes {
        // All compliances 2 % too large together: all frequencies 1 % too low.
        let together = |k: usize, l: usize| 4e-4 * compliances[k] * compliances[l];
        near(mode.relative_uncertainty(&compliances, together), 0.01);
        // By difference, each compliance by itself.
        let alone = |k: usize, l: usize| {
            if k == l && k == 1 {
                4e-4 * compliances[1] * compliances[1]
            } else {
                0.0
            }
        };
        near(
            mode.relative_uncertainty(&compliances, alone),
            0.01 * mode.shares[1],
        );
    }
    let mut softer = LINKS;
    softer[1].k /= 1.0 + 1e-6;
    let changed = planar(&softer, &[0.3, -1.1, 0.7], |_| ());
    for (mode, (before, after)) in found
        .modes
        .iter()
        .zip(squares(&found).into_iter().zip(squares(&changed)))
    {
        let slope = (after / before - 1.0) / 1e-6;
        assert!(
            (slope + mode.shares[1]).abs() < 1e-5,
            "{slope} {}",
            mode.shares[1]
        );
    }
}

#[test]
fn the_uncertainty_by_a_mass_is_its_slope_by_difference() {
    let q = [0.3, -1.1, 0.7];
    let u = 0.4;
    let uncertain = |structure: &mut Structure| structure.masses[1].relative_uncertainty = u;
    let (found, by_masses) = of_planar(&LINKS, &q, uncertain, |state| {
        let modes = state.modes().unwrap();
        let by_masses = state.frequency_uncertainties_by_masses(&modes.modes);
        (modes, by_masses)
    });
    let mut heavier = LINKS;
    heavier[1].m *= 1.0 + 1e-6;
    heavier[1].i *= 1.0 + 1e-6;
    let changed = planar(&heavier, &q, |_| ());
    let pairs = squares(&found).into_iter().zip(squares(&changed));
    for ((before, after), by_mass) in pairs.zip(&by_masses) {
        let slope = -0.5 * (after / before - 1.0) / 1e-6;
        assert!((by_mass - u * slope).abs() < 1e-5, "{by_mass} {slope}");
    }
    // The shares of all masses add up to 1, so that independent ones give between u/2 and u/(2 sqrt 3).
    let all = |structure: &mut Structure| {
        structure
            .masses
            .iter_mut()
            .for_each(|mass| mass.relative_uncertainty = u);
    };
    let of_all = of_planar(&LINKS, &q, all, |state| {
        state.frequency_uncertainties_by_masses(&found.modes)
    });
    for of_all in of_all {
        assert!(
            of_all <= 0.5 * u + 1e-12 && of_all >= 0.5 * u / 3f64.sqrt() - 1e-12,
            "{of_all}"
        );
    }
}
