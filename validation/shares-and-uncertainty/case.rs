//! Worst case, shares, uncertainty and probability of single points against differences and samples of the in-plane
//! deviation as a function of the compliances. See README.md.
//!
//! ```text
//! d(c) = |(1 - n n^T) sum c_i v_i|,   v_i = linear part of (S A_i E_i A_i^T S^T) w,   E_i one 1 on the diagonal
//! share_i = c_i dd/dc_i,   u^2 = sum (u_i dd/dc_i)^2,   P = samples with d(c) <= e, over all
//! ```
//!
//! Compliances in rad/(N m), wrenches `w` in N and N m at the TCP, lengths in m.

use nalgebra::{Vector3, Vector6};

use armill_core::robot::{JointCompliance, Robot};
use armill_study::answer::{MapAnswer, PointAnswer};

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::compliance_two_ways::{joint_compliance_at_base, moved_to};
use crate::random::Random;
use crate::studies::answer_to;

const STUDY: &str = include_str!("study.toml");
/// Robot, tolerance (um), x and z of the centre (mm), first of 14 distances and their step (mm).
const ARMS: [(&str, f64, [f64; 4]); 2] = [
    ("yaskawa/mh12", 1300.0, [900.0, 700.0, 640.0, 40.0]),
    ("fanuc/r2000ic", 220.0, [1700.0, 1100.0, 1300.0, 70.0]),
];
/// Load cases of the study: force (N), moment (N m).
const CASES: [[f64; 6]; 4] = [
    [30.0, -50.0, 20.0, 1.0, 0.0, 2.0],
    [-25.0, 40.0, 45.0, 0.0, -2.0, 1.0],
    [10.0, 60.0, -30.0, 2.0, 1.0, 0.0],
    [-40.0, -35.0, 15.0, -1.0, 1.0, 1.0],
];
/// Step of a difference, relative to the compliance.
const STEP: f64 = 1e-5;
const SAMPLES: usize = 20_000;
const REFERENCE: &str = "differences and samples of the deviation";

/// Errors of all points.
#[derive(Default)]
struct Errors {
    wrong_cases: usize,
    deviation: Vec<f64>,
    share: Vec<f64>,
    uncertainty: Vec<f64>,
    probability: Vec<f64>,
    /// Points whose probability is neither nearly 0 nor nearly 1.
    undecided: usize,
}

/// All points of both arms.
pub fn checks() -> Vec<Check> {
    let mut errors = Errors::default();
    let mut random = Random::seeded(5);
    for (name, tolerance_um, numbers) in ARMS {
        let robot = arms::library(name);
        let answer = answer_to(
            "validation/shares-and-uncertainty/study.toml",
            &text(name, tolerance_um, numbers),
        );
        for map in &answer.maps {
            compare(&robot, map, tolerance_um, &mut random, &mut errors);
        }
    }
    let points = errors.deviation.len();
    let relative = |what: &str, errors: Vec<f64>| {
        let bound = ErrorBound {
            worst: worst(errors),
            tolerance: 1e-8,
            unit: "",
        };
        Check::computed(
            format!("{what} of {points} points, over the deviation"),
            REFERENCE,
            bound,
        )
    };
    vec![
        Check::none_wrong(
            format!("wrong worst load cases of {points} points of two arms"),
            REFERENCE,
            errors.wrong_cases,
        ),
        relative("in-plane deviation", errors.deviation),
        relative("share of each joint", errors.share),
        relative("standard uncertainty", errors.uncertainty),
        Check::printed(
            format!(
                "probability to be within the tolerance, {SAMPLES} samples a point; between 0.02 and 0.98 at {} points",
                errors.undecided
            ),
            REFERENCE,
            ErrorBound {
                worst: worst(errors.probability),
                tolerance: 0.02,
                unit: "",
            },
            3,
        ),
    ]
}

/// The study of an arm.
fn text(robot: &str, tolerance_um: f64, [x, z, first, step]: [f64; 4]) -> String {
    let distances: Vec<String> = (0..14)
        .map(|index| (first + step * f64::from(index)).to_string())
        .collect();
    STUDY
        .replace("DISTANCES", &distances.join(", "))
        .replace("[X, 150, Z]", &format!("[{x}, 150, {z}]"))
        .replace("TOLERANCE", &tolerance_um.to_string())
        .replace("\"ROBOT\"", &format!("\"{robot}\""))
}

/// The one point of a plane.
fn compare(robot: &Robot, map: &MapAnswer, tolerance_um: f64, random: &mut Random, errors: &mut Errors) {
    let Some(point) = &map.worst else {
        return;
    };
    let tilt = map.setting.tilt_deg.expect("every plane has a tilt").to_radians();
    let normal = Vector3::new(-tilt.cos(), 0.0, tilt.sin());
    let of_cases = CASES.map(|wrench| displacements(robot, point, &wrench.into(), &normal));
    let joints = robot.compliance().expect("both arms have compliances");
    let c: Vec<f64> = joints.iter().map(|joint| joint.value).collect();
    let sizes = of_cases.each_ref().map(|case| length(case, &c));
    let largest = worst(sizes);
    errors.wrong_cases += usize::from(sizes[point.worst_case - 1] < largest * (1.0 - 1e-9));

    let case = &of_cases[point.worst_case - 1];
    let slopes: Vec<f64> = (0..c.len()).map(|joint| slope(case, &c, joint)).collect();
    errors.deviation.push(point.in_plane_um * 1e-6 / largest - 1.0);
    for ((share_um, slope), c) in point.joint_share_um.iter().zip(&slopes).zip(&c) {
        errors.share.push((share_um * 1e-6 - c * slope) / largest);
    }
    let u = slopes
        .iter()
        .zip(joints)
        .map(|(slope, joint)| (slope * joint.standard_uncertainty).powi(2))
        .sum::<f64>()
        .sqrt();
    let stated = point.in_plane_u_um.unwrap_or(f64::NAN) * 1e-6;
    errors.uncertainty.push((stated - u) / largest);
    let within = (0..SAMPLES)
        .filter(|_| length(case, &sample(joints, random)) <= tolerance_um * 1e-6)
        .count();
    let stated = map.grid.probability_within[0].unwrap_or(f64::NAN);
    errors.undecided += usize::from((0.02..0.98).contains(&stated));
    errors.probability.push(within as f64 / SAMPLES as f64 - stated);
}

/// In-plane displacement of the TCP by a compliance of 1 rad/(N m) of each joint under a wrench, m.
fn displacements(
    robot: &Robot,
    point: &PointAnswer,
    wrench: &Vector6<f64>,
    normal: &Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let q: Vec<f64> = point.joints_deg.iter().map(|deg| deg.to_radians()).collect();
    let theta: Vec<f64> = (0..q.len()).map(|joint| robot.theta(joint, &q)).collect();
    let tcp = Vector3::from(point.xyz_mm) * 1e-3;
    let unit = JointCompliance {
        value: 1.0,
        standard_uncertainty: 0.0,
    };
    (0..q.len())
        .map(|joint| {
            let at_base = joint_compliance_at_base(robot.chain(), &theta, (joint, &unit));
            let linear: Vector3<f64> = (moved_to(&tcp, &at_base) * wrench).fixed_rows::<3>(0).into();
            linear - normal * normal.dot(&linear)
        })
        .collect()
}

/// `d(c)`, m.
fn length(displacements: &[Vector3<f64>], c: &[f64]) -> f64 {
    let sum: Vector3<f64> = displacements.iter().zip(c).map(|(v, c)| v * *c).sum();
    sum.norm()
}

/// `dd/dc_i` as a central difference.
fn slope(displacements: &[Vector3<f64>], c: &[f64], joint: usize) -> f64 {
    let step = STEP * c[joint];
    let at = |change: f64| {
        let mut moved = c.to_vec();
        moved[joint] += change;
        length(displacements, &moved)
    };
    (at(step) - at(-step)) / (2.0 * step)
}

/// Compliances with normally distributed errors (Box and Muller 1958).
fn sample(joints: &[JointCompliance], random: &mut Random) -> Vec<f64> {
    joints
        .iter()
        .map(|joint| {
            let radius = (-2.0 * random.between(f64::MIN_POSITIVE, 1.0).ln()).sqrt();
            let normal = radius * random.between(0.0, std::f64::consts::TAU).cos();
            joint.value + joint.standard_uncertainty * normal
        })
        .collect()
}
