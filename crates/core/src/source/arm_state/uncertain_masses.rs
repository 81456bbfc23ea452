//! Uncertainty of the displacement by gravity due to masses whose uncertainty is known.
//!
//! ```text
//! l_j = u_j ( sum_k s_k c_k tau_jk  -  the same at tool setting )        cov(delta) = ... + sum_j l_j l_j^T
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u_j` | relative standard uncertainty of mass `j`; the masses are independent | - |
//! | `tau_jk` | torque of mass `j` alone on drive or spring `k` | N m (N) |
//! | `c_k` | its compliance under the weight of all: slope of a torque curve, with the compensator | rad/(N m) (m/N) |
//! | `l_j` | displacement by one standard uncertainty of mass `j` | m, base |

use nalgebra::{IsometryMatrix3, Rotation3, Vector3};

use crate::robot::{Attachment, Mass, MovedBy, Structure};
use crate::source::gravity::{Carried, carry_into, torque_by};
use crate::spatial::Twist;

/// The uncertain masses of an arm, in one posture.
#[derive(Clone, Debug)]
pub(super) struct UncertainMasses {
    masses: Vec<Mass>,
    carried: Vec<Carried>,
    /// `l_j` without the part at tool setting, m, base.
    here: Vec<Vector3<f64>>,
    /// That part, m, in the axes of the ground.
    at_reference: Vec<Vector3<f64>>,
}

/// An arm in a posture, as far as weights act on it.
pub(super) struct Weighed<'a> {
    /// Of drives, then springs, at the TCP, base.
    pub screws: &'a [Twist],
    /// What each moves.
    pub moved: &'a [MovedBy],
    /// Acceleration of free fall, base, m/s^2.
    pub g: Vector3<f64>,
    /// TCP, m, base.
    pub tcp: Vector3<f64>,
}

impl UncertainMasses {
    /// Those of a structure on an arm of this many joints.
    pub(super) fn of(structure: &Structure, joints: usize) -> UncertainMasses {
        let uncertain = |mass: &&Mass| mass.relative_uncertainty > 0.0;
        let masses: Vec<Mass> = structure.masses.iter().filter(uncertain).copied().collect();
        let none = vec![Vector3::zeros(); masses.len()];
        UncertainMasses {
            carried: vec![Carried::NOTHING; Attachment::count(joints)],
            here: none.clone(),
            at_reference: none,
            masses,
        }
    }

    /// Sets the posture. `compliance` is that of each drive, then each spring, under the weight.
    pub(super) fn set(
        &mut self,
        arm: &Weighed<'_>,
        frame: impl Fn(Attachment) -> IsometryMatrix3<f64>,
        compliance: impl Fn(usize) -> f64,
    ) {
        for (mass, here) in self.masses.iter().zip(&mut self.here) {
            carry_into(std::slice::from_ref(mass), &frame, arm.tcp, &mut self.carried);
            let each = arm.screws.iter().zip(arm.moved).enumerate();
            let moved = each.map(|(k, (screw, moved))| {
                screw.linear * (compliance(k) * torque_by(screw, &self.carried, *moved, &arm.g))
            });
            *here = moved.sum::<Vector3<f64>>() * mass.relative_uncertainty;
        }
    }

    /// Takes the posture for that of tool setting.
    pub(super) fn set_reference(&mut self, ground_from_base: &Rotation3<f64>) {
        let turned = self.here.iter().map(|here| ground_from_base * here);
        self.at_reference = turned.collect();
    }

    /// `l_j` of each, m, base.
    pub(super) fn changes<'a>(
        &'a self,
        base_from_ground: &'a Rotation3<f64>,
    ) -> impl Iterator<Item = Vector3<f64>> + 'a {
        let each = self.here.iter().zip(&self.at_reference);
        each.map(move |(here, there)| here - base_from_ground * there)
    }
}
