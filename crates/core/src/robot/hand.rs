//! An arm that holds the part, and a tool that stands in the cell, as one chain from the part to the tool.
//!
//! ```text
//! flange_from_mount = A(q)^-1 base_from_mount        A: arm, base_link to flange
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `A`, `q` | chain of the arm and its joint positions | rad (m) |
//! | `base_from_mount` | mount of the tool, such as the housing of a spindle on a pedestal, in the base of the arm | m, rad |
//! | base of the chain | the flange of the arm: what is fixed to the part is constant | |
//! | flange of the chain | the mount of the tool | |
//!
//! The chain is that of a positioner without an arm behind it ([`super::positioner`]): the joints in the opposite order, each with its
//! own coordinate and the opposite sign, then the ground. The load on the tool acts on the part in the opposite direction,
//! and the deviation is that of the tool relative to the part: the joints deflect under it as those of an arm that holds the
//! tool, and the deviation in the cell is the opposite. All parts of the arm keep their model: springs, masses, compensator, torque curves, backlash,
//! covariance. The postures are those of the arm, with their names.
//!
//! Source: a chain read from its other end, `(A_1 A_2 ... A_m)^-1 = A_m^-1 ... A_2^-1 A_1^-1`; virtual work.

use nalgebra::DMatrix;

use super::chain::Chain;
use super::compensator::Compensator;
use super::damping::Damping;
use super::ground::{Ground, HeldByArm};
use super::joint::{Coupling, Joint};
use super::model::{Hand, Robot, RobotError};
use super::motor::Motor;
use super::positioner::{Positioner, constants, reversed};
use super::spring::Spring;
use super::structure::Structure;
use super::torque_curve::JointCurve;
use crate::frame::Isometry;
use crate::spatial::Twist;

impl Robot {
    /// The chain from the flange of this arm, which holds the part, to the mount of a tool that stands at `base_from_mount`.
    /// It has no frames but its base: those of the arm move relative to the part.
    ///
    /// # Errors
    /// An arm on external axes; a chain that begins at a part already.
    pub fn holding_part(&self, base_from_mount: &Isometry) -> Result<Robot, RobotError> {
        if !self.chain().ground().is_base() {
            return Err(RobotError::NotAnArm {
                robot: self.name().to_owned(),
            });
        }
        let external = self.inverse().rail_joints();
        if external > 0 {
            return Err(RobotError::ExternalAxesOfHand { external });
        }
        let stand = Isometry::identity();
        let read_back = Positioner {
            robot: self,
            base_from_root: &stand,
            home: &[],
        };
        let ground = Ground {
            held: HeldByArm::Part,
            ..read_back.ground()
        };
        let mut motions = read_back.motions_from_table();
        motions.extend(constants(base_from_mount));
        let chain = Chain::new(motions)?.with_ground(ground);
        let count = self.joints().len();
        let joints = self.joints().iter().rev().map(|joint| in_front(joint, count));
        let mut robot = Robot::of_chain(self.name(), chain, joints.collect())?;
        if let Some(compliance) = self.compliance() {
            robot = robot.with_compliance(compliance.iter().rev().copied().collect())?;
        }
        let hand = Hand {
            arm: self.clone(),
            base_from_mount: *base_from_mount,
        };
        let robot = robot
            .with_hand(hand)
            .with_nominal_branch(self.nominal_branch())
            .with_structure(structure_read_back(&read_back))?;
        Ok(match self.rest() {
            Some(rest) => robot.with_rest(in_opposite_order(rest)),
            None => robot,
        })
    }
}

/// Joint positions in the opposite order: of the arm from those of the chain that begins at its flange, and back.
pub(super) fn in_opposite_order(q: &[f64]) -> Vec<f64> {
    q.iter().rev().copied().collect()
}

/// A joint of the arm of `count` joints, read from the flange back.
fn in_front(joint: &Joint, count: usize) -> Joint {
    let coupled = joint.coupling.iter().map(|coupling| Coupling {
        joint: count - 1 - coupling.joint,
        ..*coupling
    });
    Joint {
        coupling: coupled.collect(),
        ..reversed(joint)
    }
}

/// The structure of the arm, read from its flange back.
fn structure_read_back(arm: &Positioner<'_>) -> Structure {
    let (own, count) = (arm.robot.structure(), arm.robot.joints().len());
    let springs = own.springs.iter().map(|spring| {
        let (attachment, new_from_old) = arm.attached(spring.attachment);
        Spring {
            attachment,
            direction: seen_from(&new_from_old, &spring.direction),
            ..*spring
        }
    });
    let masses = own.masses.iter().map(|mass| {
        let (attachment, new_from_old) = arm.attached(mass.attachment);
        mass.attached_to(attachment, &new_from_old)
    });
    Structure {
        springs: springs.collect(),
        masses: masses.collect(),
        motors: own
            .motors
            .iter()
            .map(|motor| Motor {
                joint: count - 1 - motor.joint,
                ..*motor
            })
            .collect(),
        damping: own.damping.as_ref().map(|damping| match damping {
            Damping::Ratio(ratio) => Damping::Ratio(*ratio),
            Damping::Joints(dampers) => Damping::Joints(
                (0..count)
                    .rev()
                    .map(|joint| dampers.get(joint).copied().unwrap_or_default())
                    .collect(),
            ),
        }),
        compensator: own.compensator.map(|compensator| Compensator {
            joint: count - 1 - compensator.joint,
            // The chain position of its joint is the opposite.
            angle: -compensator.angle,
            ..compensator
        }),
        curves: match own.curves.is_empty() {
            true => Vec::new(),
            false => (0..count)
                .rev()
                .map(|joint| own.curve(joint).map(JointCurve::reversed))
                .collect(),
        },
        covariance: own
            .covariance
            .as_ref()
            .map(|known| covariance_read_back(known, arm.robot)),
        backlash: match own.backlash.is_empty() {
            true => Vec::new(),
            false => (0..count)
                .rev()
                .map(|joint| own.backlash.get(joint).copied().flatten())
                .collect(),
        },
        repeatability: own.repeatability,
        model_error: own.model_error,
        learnt: own.learnt.clone(),
        // Its small motions are not those of the chain read back.
        geometry: None,
    }
}

/// A twist at the origin of a frame and in its axes, as seen from the frame in which it is at `new_from_old`.
fn seen_from(new_from_old: &Isometry, twist: &Twist) -> Twist {
    let turned = Twist {
        linear: new_from_old.rotation * twist.linear,
        angular: new_from_old.rotation * twist.angular,
    };
    turned.moved(-new_from_old.translation.vector)
}

/// The covariance of drives, then springs, with the drives in the opposite order.
fn covariance_read_back(known: &DMatrix<f64>, arm: &Robot) -> DMatrix<f64> {
    let drives = arm.joints().len();
    let index = |k: usize| if k < drives { drives - 1 - k } else { k };
    let independent = |k: usize| {
        let compliance = arm.compliance().and_then(|all| all.get(k));
        compliance.map_or(0.0, |compliance| compliance.standard_uncertainty.powi(2))
    };
    let size = known.nrows().max(drives);
    DMatrix::from_fn(size, size, |i, j| {
        let [i, j] = [index(i), index(j)];
        let own = known.get((i, j)).copied();
        own.unwrap_or_else(|| if i == j { independent(i) } else { 0.0 })
    })
}

#[cfg(test)]
mod tests;
