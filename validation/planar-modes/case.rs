//! Modes of planar arms against closed forms. See README.md.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `l`, `c` | length of a link, its centre of mass from its joint | m |
//! | `m`, `i` | its mass, its inertia about the centre | kg, kg m^2 |
//! | `k` | stiffness of its joint | N m/rad |
//! | `b` | bend of the second joint | rad |

use nalgebra::{Matrix3, Point3, Vector3};

use armill_core::frame::Isometry;
use armill_core::robot::{Amount, Attachment, Axis, Joint, JointCompliance, Mass, Motion, Robot, Structure};
use armill_core::source::{Arm, ArmState, StiffnessModel};

use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const SEED: u64 = 29;
/// Arms of each kind.
const ARMS: usize = 1000;

#[derive(Clone, Copy)]
struct Link {
    l: f64,
    c: f64,
    m: f64,
    i: f64,
    k: f64,
}

/// Arms of one and of two links.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let mut one = Vec::new();
    let mut two = Vec::new();
    for _ in 0..ARMS {
        let (a, b) = (link(&mut random), link(&mut random));
        let bend = random.between(-3.0, 3.0);
        one.extend(relative(
            &squares(&[a], &[bend]),
            &[a.k / (a.i + a.m * a.c * a.c)],
        ));
        two.extend(relative(&squares(&[a, b], &[0.4, bend]), &of_two(a, b, bend)));
    }
    let check = |what: &str, errors: Vec<f64>| {
        Check::computed(
            format!("squares of the frequencies of 1000 planar arms of {what}, relative"),
            "closed form",
            ErrorBound {
                worst: worst(errors),
                // The eigenvalues of an arm differ by factors of up to 1e4, and each has the rounding of the largest.
                tolerance: 1e-11,
                unit: "",
            },
        )
    };
    vec![check("one link", one), check("two links", two)]
}

fn link(random: &mut Random) -> Link {
    let l = random.between(0.3, 1.5);
    Link {
        l,
        c: l * random.between(0.2, 0.8),
        m: random.between(5.0, 100.0),
        i: random.between(0.1, 10.0),
        k: random.between(1e5, 1e7),
    }
}

/// Roots of `det(K - w2 M) = 0` with the textbook mass matrix, rising.
fn of_two(a: Link, b: Link, bend: f64) -> Vec<f64> {
    let h = b.m * a.l * b.c * bend.cos();
    let m22 = b.i + b.m * b.c * b.c;
    let m12 = m22 + h;
    let m11 = a.i + a.m * a.c * a.c + b.m * a.l * a.l + m22 + 2.0 * h;
    let (p, q, r) = (m11 * m22 - m12 * m12, a.k * m22 + b.k * m11, a.k * b.k);
    let root = (q * q - 4.0 * p * r).sqrt();
    vec![2.0 * r / (q + root), (q + root) / (2.0 * p)]
}

fn relative(found: &[f64], expected: &[f64]) -> Vec<f64> {
    if found.len() != expected.len() {
        return vec![f64::NAN];
    }
    found
        .iter()
        .zip(expected)
        .map(|(found, expected)| found / expected - 1.0)
        .collect()
}

/// Squares of the angular frequencies of the arm of these links, joints about z at `q`.
fn squares(links: &[Link], q: &[f64]) -> Vec<f64> {
    let each = links.iter().enumerate();
    let motions = each.clone().flat_map(|(index, link)| {
        [
            Motion::About(Axis::Z, Amount::Joint(index)),
            Motion::Along(Axis::X, Amount::Constant(link.l)),
        ]
    });
    let joints = each.clone().map(|(index, _)| Joint::plain(format!("J{index}")));
    let robot = Robot::new("planar", motions.collect(), joints.collect()).expect("a chain of its joints");
    let masses = each.map(|(index, link)| Mass {
        attachment: Attachment::Joint(index),
        mass: link.m,
        centre: Point3::new(link.c, 0.0, 0.0),
        inertia: Some(Matrix3::from_diagonal(&Vector3::new(0.0, link.i, link.i))),
        relative_uncertainty: 0.0,
    });
    let model = StiffnessModel {
        structure: Structure {
            masses: masses.collect(),
            ..Structure::EMPTY
        },
        ..StiffnessModel::DRIVES.clone()
    };
    let soft = links.iter().map(|link| JointCompliance {
        value: 1.0 / link.k,
        standard_uncertainty: 0.0,
    });
    let compliance: Vec<JointCompliance> = soft.collect();
    let tool = Isometry::identity();
    let mut state = ArmState::new(Arm {
        robot: &robot,
        compliance: &compliance,
        model: &model,
        flange_from_tool: &tool,
    });
    state.set_joints(q);
    let found = state.modes().expect("the arm has no compensator");
    let modes = found.modes.iter();
    modes.map(|mode| mode.at_tool.angular_frequency.powi(2)).collect()
}
