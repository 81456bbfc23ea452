//! The analytic Jacobian against central differences of the forward kinematics. See README.md.
//!
//! `J_k ~ (x(q_k + h) - x(q_k - h)) / 2 h`, with `x` the pose of the TCP: displacement of its origin and
//! rotation vector in base axes. The error is `h^2 / 6` times the third derivative, and rounding over `h`.

use nalgebra::Vector6;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::jacobian::jacobian;

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const SEED: u64 = 3;
/// Postures an arm.
const POSTURES: usize = 2000;
/// Step, rad or m: about the cube root of the rounding error, where both errors are small.
const STEP: f64 = 1e-5;

/// Jacobians against central differences of poses, twist by twist.
pub fn checks() -> Vec<Check> {
    let mut random = Random::seeded(SEED);
    [
        ("Yaskawa MH12", arms::mh12()),
        ("KUKA KR 150 R3100-2, first axis points down", arms::kr150()),
        ("Staubli TX2-90, second axis to the side", arms::tx2_90()),
        ("FANUC R-2000iC, joint 3 coupled to joint 2", arms::r2000ic()),
        ("seven joints, two of them prismatic, one coupled", arms::railed()),
    ]
    .iter()
    .map(|(title, robot)| {
        let errors: Vec<f64> = (0..POSTURES).map(|_| error_at(robot, &mut random)).collect();
        // Truncation h^2/6 of a third derivative below (1 + 1)^3 times 4 m, and rounding 4 m eps / h: 1e-9 together.
        let gap = ErrorBound {
            worst: worst(errors),
            tolerance: 1e-9,
            unit: "m/rad",
        };
        Check::computed(
            format!("{title}: {POSTURES} random postures and tools"),
            "central differences",
            gap,
        )
    })
    .collect()
}

/// Greatest length of the difference of a column, m/rad (m/m for a joint that slides), at a random posture with
/// a random tool.
fn error_at(robot: &Robot, random: &mut Random) -> f64 {
    let mut q: Vec<f64> = random.joints::<8>()[..robot.joints().len()].to_vec();
    for (index, position) in q.iter_mut().enumerate() {
        // Sliding joints within a metre.
        *position *= if robot.slides(index) {
            1.0 / std::f64::consts::PI
        } else {
            1.0
        };
    }
    let tool = from_xyz_and_fixed_angles(random.vector(0.3), random.vector(3.0));
    let analytic = jacobian(robot, &posture_at(robot, &q, &tool).screws);
    let errors = (0..q.len()).map(|joint| {
        let moved = |by: f64| {
            let mut q = q.clone();
            q[joint] += by;
            posture_at(robot, &q, &tool).base_from_tool
        };
        let numeric = twist_between(&moved(-STEP), &moved(STEP)) / (2.0 * STEP);
        (analytic.column(joint) - numeric).norm()
    });
    worst(errors)
}

/// Displacement of the origin (m), then rotation vector (rad), base axes; for small rotations.
fn twist_between(from: &Isometry, to: &Isometry) -> Vector6<f64> {
    let linear = to.translation.vector - from.translation.vector;
    // Of a small rotation the vector part of the quaternion is half the angle; its error is the angle cubed / 24.
    let turn = to.rotation * from.rotation.inverse();
    let angular = turn.imag() * (2.0 * turn.w.signum());
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
