//! Mass matrix of an arm over its drives and springs.
//!
//! ```text
//! M_kl = s_k . I_kl s_l + delta_kl J_k          T = xdot^T M xdot / 2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s_k` | screw of drive or spring k at the TCP, base | m/rad, rad/rad |
//! | `I_kl` | inertia of the bodies that both k and l move, about the TCP ([`super::inertia`]) | kg, kg m, kg m^2 |
//! | `J_k` | inertia of the rotor of drive k at the joint ([`crate::robot::motor`]) | kg m^2 (kg) |
//! | `x_k` | deflection of drive or spring k | rad (m) |
//! | `T` | kinetic energy | J |
//!
//! Source: composite rigid bodies, Walker & Orin 1982; Featherstone, Rigid body dynamics algorithms, 6.2 (recalled).

use nalgebra::DMatrix;

use super::inertia::CarriedInertia;
use crate::robot::{Motor, MovedBy, Robot};
use crate::spatial::Twist;

/// The mass matrix, symmetric, kg m^2 (kg m, kg): of drives, then springs, with these screws at the TCP. The rotors of `motors` move
/// with their joints; a motor that is left out holds its rotor.
///
/// # Panics
/// If there are fewer entries of `moved` than of `screws`, or a motor of a joint without a screw.
pub fn mass_matrix(
    screws: &[Twist],
    moved: &[MovedBy],
    carried: &CarriedInertia,
    motors: &[Motor],
) -> DMatrix<f64> {
    let size = screws.len();
    let mut matrix = DMatrix::zeros(size, size);
    for l in 0..size {
        for k in 0..=l {
            let Some(inertia) = carried.moved_by_both(moved[k], moved[l]) else {
                continue;
            };
            let part = screws[k].dot(&inertia.momentum(&screws[l]));
            matrix[(k, l)] = part;
            matrix[(l, k)] = part;
        }
    }
    for motor in motors {
        matrix[(motor.joint, motor.joint)] += motor.inertia_at_joint();
    }
    matrix
}

/// The mass matrix over the joint positions of the controller (kg m^2; kg m, kg), from that over the chain positions of the drives. A
/// coupled joint turns with the joints that it is coupled to; rotors turn with the chain position of their joint.
///
/// # Panics
/// If the matrix has fewer rows than the robot has joints; rows of springs are left out.
pub fn over_joint_positions(robot: &Robot, of_chain: &DMatrix<f64>) -> DMatrix<f64> {
    // theta = T q + constant
    let joints = robot.joints();
    let count = joints.len();
    let mut turns = DMatrix::<f64>::zeros(count, count);
    for (index, joint) in joints.iter().enumerate() {
        turns[(index, index)] += joint.sign.factor();
        for coupling in &joint.coupling {
            turns[(index, coupling.joint)] += joint.sign.factor() * coupling.factor;
        }
    }
    turns.transpose() * of_chain.view((0, 0), (count, count)) * turns
}

#[cfg(test)]
mod tests;
