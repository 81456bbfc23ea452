//! The robot: chain, joints, compliance, frames. Immutable and shareable.

use super::branch::BranchPattern;
use super::chain::{Chain, ChainError, Motion};
use super::inverse::{Inverse, OrthoParallel};
use super::joint::{Joint, JointCompliance, SOFTEST};
use super::structure::Structure;
use super::structure_error::StructureError;
use crate::frame::Isometry;

/// A reference frame for positions, other than the base.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrame {
    /// Its name, such as `controller`.
    pub name: String,
    /// The frame in base.
    pub base_from_frame: Isometry,
}

/// A serial robot. Made by [`Robot::new`], which checks it; never changes afterwards.
#[derive(Clone, Debug)]
pub struct Robot {
    name: String,
    chain: Chain,
    joints: Vec<Joint>,
    compliance: Option<Vec<JointCompliance>>,
    structure: Structure,
    frames: Vec<NamedFrame>,
    nominal: BranchPattern,
    inverse: Inverse,
    rest: Option<Vec<f64>>,
    hand: Option<Box<Hand>>,
}

/// What a chain that begins at the flange of an arm is made of: the arm holds the part.
#[derive(Clone, Debug)]
pub struct Hand {
    /// The arm without a part, base to flange.
    pub arm: Robot,
    /// From its base to the mount of the tool.
    pub base_from_mount: Isometry,
}

/// Why a robot description is not consistent. Joint positions are in rad (m for prismatic joints).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RobotError {
    /// The chain is not valid.
    #[error(transparent)]
    Chain(#[from] ChainError),
    /// Chain and joint list disagree.
    #[error("the chain has {in_chain} joints, but {described} are described")]
    JointCount {
        /// Joints that the chain uses.
        in_chain: usize,
        /// Joints described.
        described: usize,
    },
    /// A number of a joint is NaN or infinite.
    #[error("joint {joint}: its {what} is not finite")]
    NotFinite {
        /// Name of the joint.
        joint: String,
        /// The quantity.
        what: &'static str,
    },
    /// The structure (springs, masses, backlash, ...) is not valid for any arm, or not for this one.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// Lower limit not below the upper.
    #[error("joint {joint}: lower limit {lower} is not below upper limit {upper} (rad or m)")]
    LimitsReversed {
        /// Name of the joint.
        joint: String,
        /// The value given.
        lower: f64,
        /// The value given.
        upper: f64,
    },
    /// A compliance or its uncertainty below zero, beyond [`SOFTEST`], or not a number.
    #[error("joint {joint}: {what} {value} rad/(N m) is not a number from 0 to {SOFTEST}")]
    Compliance {
        /// Name of the joint.
        joint: String,
        /// The quantity.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// A list of compliances of another length than the joints.
    #[error("{given} compliances for {joints} joints")]
    ComplianceCount {
        /// Compliances given.
        given: usize,
        /// Joints of the chain.
        joints: usize,
    },
    /// External axes, and no arm behind them.
    #[error("all {joints} joints are external axes: no joint is left for the arm")]
    AllExternal {
        /// Joints of the chain.
        joints: usize,
    },
    /// A positioner with coupled joints.
    #[error("joint {joint} of the positioner is coupled to another")]
    CoupledPositioner {
        /// Name of the joint.
        joint: String,
    },
    /// An arm on external axes that holds the part.
    #[error(
        "an arm on {external} external axes cannot hold the part: their joints are not known in this chain"
    )]
    ExternalAxesOfHand {
        /// Number of external axes in front of the arm.
        external: usize,
    },
    /// An arm of a positioner, or one that holds the part already, where a plain arm is needed.
    #[error("the chain of robot `{robot}` begins at a part, not at the base of an arm")]
    NotAnArm {
        /// Name of the robot.
        robot: String,
    },
    /// A joint coupled to itself or to a later joint.
    #[error("joint {joint} is coupled to joint number {other}: it can only be coupled to an earlier joint")]
    Coupling {
        /// Name of the joint.
        joint: String,
        /// Index of the other joint, from 0.
        other: usize,
    },
}

impl Robot {
    /// The robot of this chain and these joints, without compliance; nominal branch front, elbow up.
    ///
    /// # Errors
    /// See [`RobotError`].
    pub fn new(
        name: impl Into<String>,
        motions: Vec<Motion>,
        joints: Vec<Joint>,
    ) -> Result<Robot, RobotError> {
        Robot::of_chain(name, Chain::new(motions)?, joints)
    }

    /// [`Robot::new`] of a chain, with its ground and external axes.
    pub(super) fn of_chain(
        name: impl Into<String>,
        chain: Chain,
        joints: Vec<Joint>,
    ) -> Result<Robot, RobotError> {
        if chain.links().len() != joints.len() {
            return Err(RobotError::JointCount {
                in_chain: chain.links().len(),
                described: joints.len(),
            });
        }
        let in_hand = chain.ground().part_is_in_hand();
        for (index, joint) in joints.iter().enumerate() {
            check_joint(joint, |other| {
                // Earlier is nearer to the ground.
                match in_hand {
                    true => (index + 1..joints.len()).contains(&other),
                    false => other < index,
                }
            })?;
        }
        let inverse = Inverse::recognise(&chain);
        Ok(Robot {
            name: name.into(),
            chain,
            joints,
            compliance: None,
            structure: Structure::EMPTY,
            frames: Vec::new(),
            nominal: BranchPattern::FRONT_ELBOW_UP,
            inverse,
            rest: None,
            hand: None,
        })
    }

    /// This robot with these joint compliances, one per joint.
    ///
    /// # Errors
    /// Another count than joints; a value or uncertainty that is not a number from 0 to [`SOFTEST`].
    pub fn with_compliance(mut self, compliance: Vec<JointCompliance>) -> Result<Robot, RobotError> {
        if compliance.len() != self.joints.len() {
            return Err(RobotError::ComplianceCount {
                given: compliance.len(),
                joints: self.joints.len(),
            });
        }
        for (joint, c) in self.joints.iter().zip(&compliance) {
            for (what, value) in [
                ("compliance", c.value),
                ("standard uncertainty of compliance", c.standard_uncertainty),
            ] {
                if !(0.0..=SOFTEST).contains(&value) {
                    return Err(RobotError::Compliance {
                        joint: joint.name.clone(),
                        what,
                        value,
                    });
                }
            }
        }
        self.compliance = Some(compliance);
        Ok(self)
    }

    /// This robot with joint compliances from another source than its file. Curves of its drives,
    /// covariance and model error are removed: they belong to the replaced compliances. Other springs and masses stay.
    ///
    /// # Errors
    /// As [`Robot::with_compliance`].
    pub fn with_other_compliance(self, compliance: Vec<JointCompliance>) -> Result<Robot, RobotError> {
        let mut robot = self.with_compliance(compliance)?;
        robot.structure.curves.clear();
        robot.structure.covariance = None;
        robot.structure.model_error = 0.0;
        Ok(robot)
    }

    /// This robot with this structure (springs, masses, backlash, ...).
    ///
    /// # Errors
    /// See [`StructureError`].
    pub fn with_structure(mut self, structure: Structure) -> Result<Robot, RobotError> {
        structure.check(&self.chain)?;
        self.structure = structure;
        Ok(self)
    }

    /// This robot with its first joints as external axes, of any kind: those of a turntable that carries an arm.
    ///
    /// # Errors
    /// As many external axes as joints, or more.
    pub fn with_external_joints(mut self, external: usize) -> Result<Robot, RobotError> {
        if external >= self.joints.len() {
            return Err(RobotError::AllExternal {
                joints: self.joints.len(),
            });
        }
        self.chain = self.chain.with_external(external);
        self.inverse = Inverse::recognise(&self.chain);
        Ok(self)
    }

    /// This robot with further reference frames for positions.
    #[must_use]
    pub fn with_frames(mut self, frames: Vec<NamedFrame>) -> Robot {
        self.frames = frames;
        self
    }

    /// This robot with another nominal branch.
    #[must_use]
    pub fn with_nominal_branch(mut self, nominal: BranchPattern) -> Robot {
        self.nominal = nominal;
        self
    }

    /// This robot with other joint positions where none are given, rad (m), than the middle of each range.
    pub(super) fn with_rest(mut self, rest: Vec<f64>) -> Robot {
        self.rest = Some(rest);
        self
    }

    /// This robot with the inverse kinematics of the arm that holds its part.
    pub(super) fn with_hand(mut self, hand: Hand) -> Robot {
        self.inverse = Inverse::InHand(Box::new(hand.arm.inverse.clone()));
        self.hand = Some(Box::new(hand));
        self
    }

    /// The name given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The chain of elementary motions.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The joints, base to flange.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Joint compliances, one per joint, if known.
    pub fn compliance(&self) -> Option<&[JointCompliance]> {
        self.compliance.as_deref()
    }

    /// The structure in addition to the drives; empty in the simple model.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Reference frames for positions, other than the base.
    pub fn frames(&self) -> &[NamedFrame] {
        &self.frames
    }

    /// The default branch.
    pub fn nominal_branch(&self) -> BranchPattern {
        self.nominal
    }

    /// The method of the inverse kinematics.
    pub fn inverse(&self) -> &Inverse {
        &self.inverse
    }

    /// The arm that holds the part, and where the tool stands; `None` if the tool is on the flange.
    pub fn hand(&self) -> Option<&Hand> {
        self.hand.as_deref()
    }

    /// The geometry of an ortho-parallel arm with spherical wrist, if it is one.
    pub fn ortho_parallel(&self) -> Option<&OrthoParallel> {
        self.inverse.ortho_parallel()
    }

    /// The middle of every joint's range; 0 where it has no limits.
    pub fn middles(&self) -> Vec<f64> {
        let middle = |joint: &Joint| joint.limits.map_or(0.0, |limits| limits.middle());
        self.joints.iter().map(middle).collect()
    }

    /// Whether joint `index` is prismatic.
    pub fn slides(&self, index: usize) -> bool {
        self.chain.slides(index)
    }

    /// Whether joint `index` is an external axis: one of a rail or gantry that carries the arm, or of a positioner that
    /// carries the part; in front of the joints of the arm, at home wherever inverse kinematics has a choice.
    pub fn is_external(&self, index: usize) -> bool {
        index < self.inverse.rail_joints()
    }

    /// The external axes in the order of a controller: those that carry the arm, then those of the positioner, each
    /// from the ground on.
    pub fn external_axes(&self) -> impl Iterator<Item = usize> + use<> {
        let of_part = self.chain.ground().positioner_joints();
        (of_part..self.inverse.rail_joints().max(of_part)).chain((0..of_part).rev())
    }

    /// Index of the joint with this number of the arm, counted from 0 at its base, without external axes.
    ///
    /// Not checked: that the arm has it.
    pub fn joint_of_arm(&self, number: usize) -> usize {
        match self.chain.ground().part_is_in_hand() {
            true => self.joints.len() - 1 - number,
            false => self.inverse.rail_joints() + number,
        }
    }

    /// Chain position `theta` of joint `index` at the joint positions `q`.
    pub fn theta(&self, index: usize, q: &[f64]) -> f64 {
        let joint = &self.joints[index];
        let coupled: f64 = joint.coupling.iter().map(|c| c.factor * q[c.joint]).sum();
        joint.sign.factor() * (q[index] + coupled) + joint.zero_offset
    }

    /// Joint position `q` of joint `index` from its chain position; `q` must contain the earlier joints.
    pub fn joint_position(&self, index: usize, theta: f64, q: &[f64]) -> f64 {
        let joint = &self.joints[index];
        let coupled: f64 = joint.coupling.iter().map(|c| c.factor * q[c.joint]).sum();
        joint.sign.factor() * (theta - joint.zero_offset) - coupled
    }

    /// `home`, rad (m); without it the positions of a positioner in its study, and of all other joints the middle of
    /// each range, zero where there is none.
    pub fn home(&self, home: Option<&[f64]>) -> Vec<f64> {
        home.or(self.rest.as_deref())
            .map_or_else(|| self.middles(), <[f64]>::to_vec)
    }

    /// Joint positions where none are given, rad (m); `None`: the middle of each range.
    pub(super) fn rest(&self) -> Option<&[f64]> {
        self.rest.as_deref()
    }

    /// The joint nearest to one of its limits, or farthest outside, and its margin: rad, m of a
    /// prismatic joint, compared by number; negative outside. `None` where no joint has limits.
    pub fn limit_margin(&self, q: &[f64]) -> Option<(usize, f64)> {
        let margins = self
            .joints
            .iter()
            .enumerate()
            .filter_map(|(i, j)| Some((i, j.limits?.margin(q[i]))));
        margins.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn check_joint(joint: &Joint, is_earlier: impl Fn(usize) -> bool) -> Result<(), RobotError> {
    let finite = |what, value: f64| {
        if value.is_finite() {
            Ok(())
        } else {
            Err(RobotError::NotFinite {
                joint: joint.name.clone(),
                what,
            })
        }
    };
    finite("zero offset", joint.zero_offset)?;
    for coupling in &joint.coupling {
        finite("coupling factor", coupling.factor)?;
        if !is_earlier(coupling.joint) {
            return Err(RobotError::Coupling {
                joint: joint.name.clone(),
                other: coupling.joint,
            });
        }
    }
    if let Some(limits) = joint.limits {
        finite("lower limit", limits.lower)?;
        finite("upper limit", limits.upper)?;
        if limits.lower >= limits.upper {
            let (lower, upper) = (limits.lower, limits.upper);
            return Err(RobotError::LimitsReversed {
                joint: joint.name.clone(),
                lower,
                upper,
            });
        }
    }
    joint
        .max_speed
        .map_or(Ok(()), |speed| finite("maximal speed", speed))
}

#[cfg(test)]
mod tests;
