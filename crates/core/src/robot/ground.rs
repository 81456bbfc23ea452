//! The ground: the link of a chain that does not move, where arm and positioner stand.
//!
//! The base of an arm alone stands on the ground. If a positioner carries the part, the base of the whole chain is the
//! table of the positioner, and the ground is a link between the joints of the positioner and those of the arm:
//!
//! ```text
//! table (base) - joints of the positioner, from the table back - ground - joints of the arm - flange
//! ```
//!
//! If the arm itself holds the part, and the tool stands in the cell, all joints are in front of the ground:
//!
//! ```text
//! flange of the arm (base) - joints of the arm, from the flange back - ground - mount of the tool
//! ```
//!
//! Gravity is constant in the ground, and the links of the arm grow from there. Positions in the ground are relative to the
//! base of the arm ([`crate::robot::positioner`], [`crate::robot::hand`]).

use nalgebra::IsometryMatrix3;

use super::compensator::Mass;
use super::spring::{Attachment, Spring};
use crate::frame::Isometry;
use crate::spatial::Twist;

/// What the arm of a chain holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldByArm {
    /// The tool: the arm is behind the ground.
    Tool,
    /// The part: the arm is in front of the ground, and the tool stands there.
    Part,
}

/// The attachments that a drive or spring moves relative to the ground, by [`Attachment::rank`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovedBy {
    /// Between the ground and the tool: it moves the attachment of this rank and all after it, with its screw.
    Behind(usize),
    /// Between the part and the ground: it moves this many attachments, from the base of the chain on, against its screw.
    InFront(usize),
}

/// Where the ground is in a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Number of joints between the base of the chain and the ground: those of the positioner, or of an arm that holds
    /// the part; 0 without either.
    pub joints: usize,
    /// The ground in the frame of the last of these joints; in the base of the chain without any.
    pub joint_from_ground: Isometry,
    /// What the arm holds.
    pub held: HeldByArm,
}

impl Ground {
    /// The ground of an arm without a positioner: its base.
    pub fn at_base() -> Ground {
        Ground {
            joints: 0,
            joint_from_ground: Isometry::identity(),
            held: HeldByArm::Tool,
        }
    }

    /// Number of joints of the positioner: the first ones of the chain.
    pub fn positioner_joints(&self) -> usize {
        match self.held {
            HeldByArm::Tool => self.joints,
            HeldByArm::Part => 0,
        }
    }

    /// Whether the arm holds the part, and the tool stands on the ground.
    pub fn part_is_in_hand(&self) -> bool {
        self.held == HeldByArm::Part
    }

    /// Whether the spring with this attachment, of a chain of `joints` joints, is between the part and the ground. One at
    /// the base of the arm is on the side of the arm.
    pub fn spring_is_in_front(&self, attachment: Attachment, joints: usize) -> bool {
        self.part_is_in_hand() && attachment.rank(joints) <= self.joints
    }

    /// What drive `index` of a chain moves.
    pub fn moved_by_drive(&self, index: usize) -> MovedBy {
        let rank = index + 1;
        match index < self.joints {
            true => MovedBy::InFront(rank),
            false => MovedBy::Behind(rank),
        }
    }

    /// What a spring at this attachment of a chain of `joints` joints moves: its own attachment too.
    pub fn moved_by_spring(&self, attachment: Attachment, joints: usize) -> MovedBy {
        let rank = attachment.rank(joints);
        match self.spring_is_in_front(attachment, joints) {
            true => MovedBy::InFront(rank + 1),
            false => MovedBy::Behind(rank),
        }
    }

    /// Whether the base of the chain is the ground.
    pub fn is_base(&self) -> bool {
        self.joints == 0
    }

    /// The ground in the base of the chain, in a posture with these frames of its joints, base.
    pub fn in_base(&self, base_from_joint: &[IsometryMatrix3<f64>]) -> IsometryMatrix3<f64> {
        match self.joints.checked_sub(1) {
            None => IsometryMatrix3::identity(),
            Some(last) => {
                let rotation = self.joint_from_ground.rotation.to_rotation_matrix();
                let joint_from_ground =
                    IsometryMatrix3::from_parts(self.joint_from_ground.translation, rotation);
                base_from_joint[last] * joint_from_ground
            }
        }
    }

    /// The attachment of what stands on the ground, such as the base of the arm.
    pub fn attachment(&self) -> Attachment {
        self.joints
            .checked_sub(1)
            .map_or(Attachment::Base, Attachment::Joint)
    }

    /// A spring of the arm; one at its base is at the ground, wherever that is in the chain.
    pub fn spring_of_arm(&self, spring: &Spring) -> Spring {
        if spring.attachment != Attachment::Base {
            return *spring;
        }
        let turn = self.joint_from_ground.rotation;
        let at_ground = Twist {
            linear: turn * spring.direction.linear,
            angular: turn * spring.direction.angular,
        };
        Spring {
            attachment: self.attachment(),
            direction: at_ground.moved(-self.joint_from_ground.translation.vector),
            ..*spring
        }
    }

    /// A mass of the arm; one at its base is on the ground, wherever that is in the chain.
    pub fn mass_of_arm(&self, mass: &Mass) -> Mass {
        match mass.attachment {
            Attachment::Base => mass.attached_to(self.attachment(), &self.joint_from_ground),
            _ => *mass,
        }
    }
}
