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

use nalgebra::{DMatrix, Vector3};

use super::inertia::CarriedInertia;
use crate::robot::deflected_arm::attachment_frame;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::jacobian::screws_into;
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

/// Working memory for the mass matrices of a robot in many postures.
#[derive(Clone, Debug)]
pub struct JointInertia<'a> {
    robot: &'a Robot,
    frames: Frames,
    screws: Vec<Twist>,
    moved: Vec<MovedBy>,
    carried: CarriedInertia,
}

impl<'a> JointInertia<'a> {
    /// For this robot, with the masses and motors of its structure; masses at its tool are on the flange.
    pub fn new(robot: &'a Robot) -> JointInertia<'a> {
        let joints = robot.joints().len();
        JointInertia {
            robot,
            frames: Frames::for_robot(robot),
            screws: vec![Twist::ZERO; joints],
            moved: (0..joints)
                .map(|joint| robot.chain().ground().moved_by_drive(joint))
                .collect(),
            carried: CarriedInertia::for_joints(joints),
        }
    }

    /// The mass matrix over the joint positions `q` (rad, m) of the controller: kg m^2 (kg m, kg), symmetric. A coupled joint turns
    /// with the joints that it is coupled to; rotors turn with the chain position of their joint.
    pub fn mass_matrix(&mut self, q: &[f64]) -> DMatrix<f64> {
        forward_into(self.robot, q, &mut self.frames);
        let flange = self.frames.base_from_flange;
        let point: Vector3<f64> = flange.translation.vector;
        screws_into(self.robot, &self.frames, &point.into(), &mut self.screws);
        let frames = &self.frames;
        let frame = |attachment| attachment_frame(attachment, frames, &flange);
        let structure = self.robot.structure();
        self.carried.set(&structure.masses, frame, &point);
        let of_chain = mass_matrix(&self.screws, &self.moved, &self.carried, &structure.motors);
        // theta = T q + constant
        let joints = self.robot.joints();
        let mut turns = DMatrix::<f64>::zeros(joints.len(), joints.len());
        for (index, joint) in joints.iter().enumerate() {
            turns[(index, index)] += joint.sign.factor();
            for coupling in &joint.coupling {
                turns[(index, coupling.joint)] += joint.sign.factor() * coupling.factor;
            }
        }
        turns.transpose() * of_chain * turns
    }
}

#[cfg(test)]
mod tests;
