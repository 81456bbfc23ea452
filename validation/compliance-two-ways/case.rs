//! `J diag(c) J^T` against equations (7) to (9) of the paper, moved to the TCP. See README.md.
//!
//! ```text
//! C_base = sum over the joints of  A_i C_i A_i^T          (7) to (9); C_i contains one number, A_i moves twists
//! C_tcp  = S C_base S^T,  S = [1  -[p]; 0  1]             missing in the paper; p the TCP in base
//! ```
//!
//! Compliances are 6 x 6, linear before angular, m and rad per N and N m.

use nalgebra::{Matrix6, Point3, Vector3};

use armill_core::compliance::{compliance_at_tool, stiffness_at_tool};
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Axis, BranchPattern, Chain, JointCompliance, Motion, Posture, Robot};
use armill_core::workpiece::{Plane, Split};

use crate::arms;
use crate::check::{Check, ErrorBound, worst, worst_difference};
use crate::random::Random;

const PAPER: &str = "equations (7) to (9), Shneor & Chapsky 2021";
const SEED: u64 = 2;
/// Postures an arm.
const POSTURES: usize = 2000;
/// Postures whose stiffness is known worse than this are left out of the comparison of stiffness.
const MOST_CONDITION: f64 = 1e6;
/// Points on the circle of the paper, of radius 0.1 m, one every 5 deg.
const CIRCLE_POINTS: usize = 72;
/// The four force cases of the paper on the tool, base axes, N.
const CASES_N: [[f64; 3]; 4] = [
    [3.0, -5.0, -5.0],
    [3.0, -5.0, 5.0],
    [3.0, 5.0, -5.0],
    [3.0, 5.0, 5.0],
];

/// Compliance of the whole arm at the base origin: the sum (7) of the joints according to (8).
///
/// The joint matrix contains one number, the compliance about (or along) the joint's axis. It is moved by the screw
/// transform (9), the product of the elementary motions from the base to the joint.
fn compliance_at_base(robot: &Robot, q: &[f64]) -> Matrix6<f64> {
    let theta: Vec<f64> = (0..q.len()).map(|joint| robot.theta(joint, q)).collect();
    let joints = robot.compliance().expect("arms of this case have compliance");
    joints
        .iter()
        .enumerate()
        .map(|(joint, c)| joint_compliance_at_base(robot.chain(), &theta, (joint, c)))
        .sum()
}

/// What one joint gives to the sum: its number on the diagonal, moved by the motions up to it.
pub(crate) fn joint_compliance_at_base(
    chain: &Chain,
    theta: &[f64],
    (joint, c): (usize, &JointCompliance),
) -> Matrix6<f64> {
    let motion = chain.links()[joint].motion;
    let last = chain
        .motions()
        .iter()
        .position(|m| *m == motion)
        .expect("the motion of a joint is in its chain");
    let to_joint = Chain::new(chain.motions()[..=last].to_vec()).expect("it ends with a joint");
    let (axis, first) = match motion {
        Motion::Along(axis, _) => (axis, 0),
        Motion::About(axis, _) => (axis, 3),
    };
    let place = first
        + [Axis::X, Axis::Y, Axis::Z]
            .iter()
            .position(|a| *a == axis)
            .expect("one of three");
    let mut in_joint = Matrix6::zeros();
    in_joint[(place, place)] = c.value;
    // The paper's T moves wrenches, the inverse transpose of this one; so (T^T)^-1 C T^-1 reads A C A^T.
    let base_from_joint = to_joint.screw(theta);
    base_from_joint * in_joint * base_from_joint.transpose()
}

/// The step missing in the paper: the compliance at the base origin, moved to the TCP at `tcp` in base,
/// m.
pub(crate) fn moved_to(tcp: &Vector3<f64>, at_base: &Matrix6<f64>) -> Matrix6<f64> {
    let mut shift = Matrix6::identity();
    shift.fixed_view_mut::<3, 3>(0, 3).copy_from(&-tcp.cross_matrix());
    shift * at_base * shift.transpose()
}

/// Compliance and stiffness at the TCP against the equations of the paper.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    let (mut compliance, mut stiffness) = (Vec::new(), Vec::new());
    for robot in [
        arms::mh12(),
        arms::r2000ic(),
        arms::tx200([2.3e6, 8.6e6, 2.8e6, 3.0e6, 0.2e6, 0.9e6]),
    ] {
        for _ in 0..POSTURES {
            let q: [f64; 6] = random.joints();
            let tool = from_xyz_and_fixed_angles(random.vector(0.3), random.vector(3.0));
            let posture = posture_at(&robot, &q, &tool);
            let ours = compliance_at_tool(&posture.screws, robot.compliance().expect("given above"));
            let theirs = moved_to(
                &posture.base_from_tool.translation.vector,
                &compliance_at_base(&robot, &q),
            );
            compliance.push((ours - theirs).norm() / ours.norm());
            stiffness.extend(stiffness_error(&ours, &theirs));
        }
    }
    vec![
        Check::computed(
            format!(
                "compliance at the TCP, 6 x 6, {} random postures of three arms, relative",
                compliance.len()
            ),
            PAPER,
            ErrorBound {
                worst: worst(compliance),
                tolerance: 1e-12,
                unit: "",
            },
        ),
        Check::computed(
            format!(
                "stiffness as its inverse, {} of them, relative, over the condition number",
                stiffness.len()
            ),
            PAPER,
            ErrorBound {
                worst: worst(stiffness),
                tolerance: 1e-12,
                unit: "",
            },
        ),
        Check::printed(
            "equations taken literally (reference point at the base), four interpretations: 0.5 to 1.2 mm in plane",
            "independent computation",
            ErrorBound {
                worst: worst_difference(&literal_range_mm(), &LITERAL_RANGE_MM),
                tolerance: 0.05,
                unit: "mm",
            },
            3,
        ),
    ]
}

/// Distance of our stiffness from the inverse of the other compliance, relative to the condition number; none if
/// the condition is worse than is compared.
fn stiffness_error(ours: &Matrix6<f64>, theirs: &Matrix6<f64>) -> Option<f64> {
    let stiffness = stiffness_at_tool(ours, 1.0);
    let inverse = theirs.lu().try_inverse()?;
    (stiffness.condition_number < MOST_CONDITION)
        .then(|| (stiffness.matrix - inverse).norm() / inverse.norm() / stiffness.condition_number)
}

/// In-plane envelope over all interpretations, reference point at the base: result of another program, mm.
const LITERAL_RANGE_MM: [f64; 2] = [0.5, 1.2];

/// An interpretation of the experiment: tilt (deg), tool length (m), height of the centre (m), branch.
type Reading = (f64, f64, f64, &'static str);

/// In the order of their names in mh12-readings: (i) with elbow up, (ii) with elbow down and up, (iii) with
/// elbow down, with heights relative to the controller's frame, 0.45 m above the base.
const READINGS: [Reading; 4] = [
    (90.0, 0.150, 0.8, "front elbow-up"),
    (0.0, 0.0, 0.8, "front elbow-down"),
    (0.0, 0.0, 0.8, "front elbow-up"),
    (0.0, 0.0, 1.25, "front elbow-down"),
];

/// Smallest and largest in-plane envelope (mm) over the circle and its interpretations if compliance and force are
/// both relative to the base origin.
fn literal_range_mm() -> [f64; 2] {
    let robot = &arms::mh12();
    let of =
        |reading: Reading| (0..CIRCLE_POINTS).map(move |index| literal_in_plane_mm(robot, reading, index));
    let values: Vec<f64> = READINGS.into_iter().flat_map(of).collect();
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        worst(values),
    ]
}

/// In-plane envelope (mm) at one point of the paper's circle.
fn literal_in_plane_mm(robot: &Robot, (tilt_deg, beyond, height, branch): Reading, index: usize) -> f64 {
    let plane = Plane::tilted(Point3::new(1.0, 0.0, height), tilt_deg.to_radians());
    let phi = std::f64::consts::TAU * index as f64 / CIRCLE_POINTS as f64;
    let base_from_tool = plane.base_from_tool([0.1 * phi.cos(), 0.1 * phi.sin()].into(), 0.0);
    let posture = posture_of(
        robot,
        branch,
        &(base_from_tool * Isometry::translation(0.0, 0.0, -beyond)),
    );
    let at_base = compliance_at_base(robot, &posture.joints);
    let in_plane = CASES_N.map(|force| {
        let deviation = at_base.fixed_view::<3, 3>(0, 0) * Vector3::from(force);
        Split::of(&deviation, plane.normal()).in_plane * 1e3
    });
    worst(in_plane)
}

/// The posture of this flange pose in the branch of this name. Every interpretation has it.
fn posture_of(robot: &Robot, branch: &str, base_from_flange: &Isometry) -> Posture {
    let branch: BranchPattern = branch.parse().expect("names of branches");
    let tool = ToolAt {
        flange_from_tool: &Isometry::identity(),
        near: None,
        home: None,
    };
    let found = postures(robot, base_from_flange, tool).expect("the circle is in reach");
    let mut named = found
        .into_iter()
        .filter(|posture| posture.name.branch().is_some_and(|b| branch.matches(b)));
    named.next().expect("both branches reach the circle")
}
