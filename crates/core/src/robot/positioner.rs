//! An arm and the positioner of its part, as one chain from the table to the flange.
//!
//! ```text
//! table_from_flange = (base_from_root P(q))^-1 A(q)        P: positioner, root to table    A: arm, base_link to flange
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `base_from_root` | position of the positioner: base of the arm to its root | m, rad |
//! | `P`, `A` | chains of the positioner and of the arm | m, rad |
//! | base of the chain | the table: what is fixed to the part is constant | |
//!
//! The joints of the positioner come first, from the table back to its root, each with its own coordinate, limits, compliance and
//! backlash. A joint that turns its table by `q` turns the ground, as seen from there, by `-q`: its sign in the chain is
//! the opposite. The load on the tool acts on the part in the opposite direction, so that a joint of the positioner deflects
//! under it as a joint of the arm. Masses of the positioner and of the part load the joints between them and the
//! ground alone ([`crate::source::gravity`]).
//!
//! Source: a chain read from its other end, `(A_1 A_2 ... A_m)^-1 = A_m^-1 ... A_2^-1 A_1^-1`; virtual work.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::backlash::Backlash;
use super::chain::{Amount, Axis, Chain, Motion};
use super::compensator::Mass;
use super::damping::Damping;
use super::ground::{Ground, HeldByArm};
use super::joint::{Joint, JointCompliance, Sign};
use super::model::{NamedFrame, Robot, RobotError};
use super::motor::Motor;
use super::spring::{Attachment, Spring};
use super::structure::Structure;
use crate::frame::{Isometry, fixed_angles};

/// A joint that is rigid as far as is known.
const RIGID: JointCompliance = JointCompliance {
    value: 0.0,
    standard_uncertainty: 0.0,
};

/// A positioner and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Positioner<'a> {
    /// Its chain, root to table.
    pub robot: &'a Robot,
    /// Its root in the base of the arm.
    pub base_from_root: &'a Isometry,
    /// Its joint positions at home, rad (m): there the frames of the arm are relative to the table.
    pub home: &'a [f64],
}

impl Positioner<'_> {
    /// Number of its joints.
    fn joints(&self) -> usize {
        self.robot.joints().len()
    }

    /// Its motions read from the table back, up to the base of the arm.
    pub(super) fn motions_from_table(&self) -> Vec<Motion> {
        let own = self.robot.chain().motions().iter().rev();
        let own = own.map(|motion| backwards(motion, self.joints()));
        own.chain(constants(&self.base_from_root.inverse())).collect()
    }

    /// The ground in the whole chain.
    pub(super) fn ground(&self) -> Ground {
        let joints = self.joints();
        Ground {
            joints,
            joint_from_ground: last_joint_from_end(&self.motions_from_table(), joints),
            held: HeldByArm::Tool,
        }
    }

    /// The table in the base of the arm at these joint positions, rad (m).
    pub fn base_from_table(&self, q: &[f64]) -> Isometry {
        let theta: Vec<f64> = (0..self.joints())
            .map(|index| self.robot.theta(index, q))
            .collect();
        self.base_from_root * self.robot.chain().base_from_flange(&theta)
    }

    /// Where an attachment of the positioner is in the whole chain, and its frame there.
    pub fn attached(&self, attachment: Attachment) -> (Attachment, Isometry) {
        let count = self.joints();
        let joint = match attachment {
            Attachment::Base => {
                let ground = self.ground();
                return (
                    ground.attachment(),
                    ground.joint_from_ground * self.base_from_root,
                );
            }
            Attachment::Joint(joint) => joint,
            Attachment::Flange | Attachment::Tool => return (Attachment::Base, Isometry::identity()),
        };
        // The frame of the next joint before its motion is that of the one before it, read from the table.
        let behind = (count - 1).checked_sub(joint + 1);
        let next_from_here = constants_between(self.robot.chain(), joint).inverse();
        (behind.map_or(Attachment::Base, Attachment::Joint), next_from_here)
    }
}

impl Robot {
    /// The chain from the table of this positioner to the flange of this arm. Its frames are relative to the table, with the
    /// positioner at home; one more of them, called `ground_name`, is the base of the arm. Springs, masses of the root and
    /// repeatability of the positioner are neglected; its joints are rigid where their compliance is not known.
    ///
    /// # Errors
    /// A positioner with coupled joints; a structure that the chain cannot have.
    pub fn on_positioner(&self, positioner: &Positioner<'_>, ground_name: &str) -> Result<Robot, RobotError> {
        let count = positioner.joints();
        let own = positioner.robot;
        if let Some(joint) = own.joints().iter().find(|joint| !joint.coupling.is_empty()) {
            return Err(RobotError::CoupledPositioner {
                joint: joint.name.clone(),
            });
        }
        let (mut motions, ground) = (positioner.motions_from_table(), positioner.ground());
        motions.extend(self.chain().motions().iter().map(|motion| after(motion, count)));
        let joints = own.joints().iter().rev().map(reversed);
        let joints = joints.chain(self.joints().iter().map(|joint| behind(joint, count)));
        let chain = Chain::new(motions)?
            .with_ground(ground)
            .with_external(count + self.chain().external());
        let mut robot = Robot::of_chain(self.name(), chain, joints.collect())?;
        if let Some(compliance) = self.compliance() {
            let of_positioner = own.compliance().map_or_else(
                || vec![RIGID; count],
                |known| known.iter().rev().copied().collect(),
            );
            robot = robot.with_compliance([&of_positioner, compliance].concat())?;
        }
        let table_from_base = positioner.base_from_table(positioner.home).inverse();
        let mut frames = vec![NamedFrame {
            name: ground_name.to_owned(),
            base_from_frame: table_from_base,
        }];
        frames.extend(self.frames().iter().map(|frame| NamedFrame {
            name: frame.name.clone(),
            base_from_frame: table_from_base * frame.base_from_frame,
        }));
        robot
            .with_frames(frames)
            .with_nominal_branch(self.nominal_branch())
            .with_rest(
                positioner
                    .home
                    .iter()
                    .rev()
                    .copied()
                    .chain(self.home(None))
                    .collect(),
            )
            .with_structure(self.structure_behind(positioner, &ground))
    }

    /// The structure of this arm behind the positioner, with the masses and the backlash of the positioner.
    fn structure_behind(&self, positioner: &Positioner<'_>, ground: &Ground) -> Structure {
        let count = positioner.joints();
        let (own, other) = (self.structure(), positioner.robot.structure());
        let springs = own.springs.iter().map(|spring| Spring {
            attachment: moved(spring.attachment, count),
            ..ground.spring_of_arm(spring)
        });
        let masses = own.masses.iter().map(|mass| Mass {
            attachment: moved(mass.attachment, count),
            ..ground.mass_of_arm(mass)
        });
        let motors = own.motors.iter().map(|motor| Motor {
            joint: motor.joint + count,
            ..*motor
        });
        let of_positioner = other.motors.iter().map(|motor| Motor {
            joint: count - 1 - motor.joint,
            ..*motor
        });
        let carried = other
            .masses
            .iter()
            .filter_map(|mass| mass_of_positioner(mass, positioner));
        let mut curves = own.curves.clone();
        if !curves.is_empty() {
            curves.splice(0..0, vec![None; count]);
        }
        let backlash: Vec<Option<Backlash>> = (0..count)
            .rev()
            .map(|joint| other.backlash.get(joint).copied().flatten())
            .chain(own.backlash.iter().copied())
            .collect();
        Structure {
            springs: springs.collect(),
            masses: masses.chain(carried).collect(),
            motors: motors.chain(of_positioner).collect(),
            damping: damping_behind(own.damping.as_ref(), other.damping.as_ref(), count),
            compensator: own.compensator.map(|mut compensator| {
                compensator.joint += count;
                compensator
            }),
            curves,
            covariance: own
                .covariance
                .as_ref()
                .map(|known| covariance_behind(known, positioner)),
            backlash: match backlash.iter().all(Option::is_none) {
                true => Vec::new(),
                false => backlash,
            },
            repeatability: own.repeatability,
            model_error: own.model_error,
            learnt: own.learnt.clone(),
            geometry: (own.geometry.as_ref()).map(|geometry| Arc::new(geometry.behind(count))),
        }
    }
}

/// A motion of the positioner, `count` joints, read from the table back: with the opposite amount.
fn backwards(motion: &Motion, count: usize) -> Motion {
    let amount = match motion.amount() {
        Amount::Constant(value) => Amount::Constant(-value),
        // The opposite sign is that of the joint.
        Amount::Joint(joint) => Amount::Joint(count - 1 - joint),
    };
    with_amount(motion, amount)
}

/// A motion of the arm behind `count` joints.
fn after(motion: &Motion, count: usize) -> Motion {
    match motion.amount() {
        Amount::Joint(joint) => with_amount(motion, Amount::Joint(joint + count)),
        Amount::Constant(_) => *motion,
    }
}

fn with_amount(motion: &Motion, amount: Amount) -> Motion {
    match *motion {
        Motion::Along(axis, _) => Motion::Along(axis, amount),
        Motion::About(axis, _) => Motion::About(axis, amount),
    }
}

/// The constant motions that make this displacement.
pub(super) fn constants(displacement: &Isometry) -> Vec<Motion> {
    let along = displacement.translation.vector;
    let about = fixed_angles(&displacement.rotation);
    let slides = Axis::ALL.map(|axis| Motion::Along(axis, Amount::Constant(along[axis.index()])));
    let turns = [Axis::Z, Axis::Y, Axis::X];
    let turns = turns.map(|axis| Motion::About(axis, Amount::Constant(about[axis.index()])));
    let all = slides.into_iter().chain(turns);
    all.filter(|motion| motion.amount() != Amount::Constant(0.0))
        .collect()
}

/// What follows the last of `count` joints in these motions.
fn last_joint_from_end(motions: &[Motion], count: usize) -> Isometry {
    let last = motions
        .iter()
        .rposition(|motion| motion.amount() == Amount::Joint(count - 1));
    let rest = motions.iter().skip(last.map_or(0, |last| last + 1));
    rest.fold(Isometry::identity(), |end, motion| match motion.amount() {
        Amount::Constant(value) => end * motion.displacement(value),
        Amount::Joint(_) => end,
    })
}

/// A joint of the positioner as seen from its table.
pub(super) fn reversed(joint: &Joint) -> Joint {
    Joint {
        sign: match joint.sign {
            Sign::Positive => Sign::Negative,
            Sign::Negative => Sign::Positive,
        },
        zero_offset: -joint.zero_offset,
        ..joint.clone()
    }
}

/// A joint of the arm behind `count` joints.
fn behind(joint: &Joint, count: usize) -> Joint {
    let mut joint = joint.clone();
    for coupling in &mut joint.coupling {
        coupling.joint += count;
    }
    joint
}

/// An attachment of the arm in a chain with `count` joints in front of it.
pub fn moved(attachment: Attachment, count: usize) -> Attachment {
    match (attachment, count.checked_sub(1)) {
        (Attachment::Base, Some(last)) => Attachment::Joint(last),
        (Attachment::Joint(joint), _) => Attachment::Joint(joint + count),
        (other, _) => other,
    }
}

/// What is constant between joint `joint` of a chain and the next one, or the flange.
fn constants_between(chain: &Chain, joint: usize) -> Isometry {
    let motions = chain.motions().iter();
    let behind = motions
        .skip_while(|motion| motion.amount() != Amount::Joint(joint))
        .skip(1);
    let constants = behind.map_while(|motion| match motion.amount() {
        Amount::Constant(value) => Some(motion.displacement(value)),
        Amount::Joint(_) => None,
    });
    constants.fold(Isometry::identity(), |end, displacement| end * displacement)
}

/// A mass of the positioner on the whole chain; none if it stands on the ground.
fn mass_of_positioner(mass: &Mass, positioner: &Positioner<'_>) -> Option<Mass> {
    let (attachment, new_from_old) = positioner.attached(mass.attachment);
    (mass.attachment != Attachment::Base).then(|| mass.attached_to(attachment, &new_from_old))
}

/// The damping of an arm behind a positioner of `count` joints: a ratio of the arm is kept, and dampers of both are joined.
fn damping_behind(arm: Option<&Damping>, positioner: Option<&Damping>, count: usize) -> Option<Damping> {
    let Damping::Joints(own) = arm? else {
        return arm.cloned();
    };
    let of_positioner = |joint: usize| match positioner {
        Some(Damping::Joints(dampers)) => dampers.get(joint).copied().unwrap_or_default(),
        _ => 0.0,
    };
    let all = (0..count).rev().map(of_positioner).chain(own.iter().copied());
    Some(Damping::Joints(all.collect()))
}

/// The covariance of the arm with the compliances of the positioner in front, which are independent.
fn covariance_behind(known: &DMatrix<f64>, positioner: &Positioner<'_>) -> DMatrix<f64> {
    let count = positioner.joints();
    let size = known.nrows();
    let mut all = DMatrix::zeros(size + count, size + count);
    all.view_mut((count, count), (size, size)).copy_from(known);
    let of_positioner = positioner.robot.compliance().into_iter().flatten().rev();
    for (index, compliance) in of_positioner.enumerate() {
        all[(index, index)] = compliance.standard_uncertainty.powi(2);
    }
    all
}

#[cfg(test)]
pub(super) mod tests;
