//! The springs to be identified from load tests.
//!
//! Each unknown has an **attachment** and moves everything after it along a **direction**, a twist at the origin of the
//! attachment, in its axes. Under a wrench it deflects by `x = c g(tau)`, with `tau` the work of the wrench on its
//! screw:
//!
//! | role | `g(tau)` | unit of `c` |
//! |---|---|---|
//! | rotational spring | `tau` | rad/(N m) |
//! | translational spring | `tau` | m/N |
//! | lost motion | `tanh(tau / tau_0)` | rad: half the backlash |
//!
//! The attachment of a joint is the frame right after the joint's motion.

use nalgebra::Vector3;

use crate::robot::chain::{Axis, Motion};
use crate::robot::deflected_arm::{attachment_frame, spring_screw};
use crate::robot::forward::{Frames, forward, joint_axis};
use crate::robot::{Attachment, Robot};
use crate::spatial::Twist;

/// The part that deflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// The drive of a joint, control loop included.
    Drive,
    /// A bearing or link, in addition to its drive.
    Bending,
    /// The floor under the arm.
    Base,
    /// Tool and holder.
    Tool,
    /// The backlash of a drive, taken up by a torque of about `torque` (N m, or N).
    LostMotion {
        /// `tau_0`.
        torque: f64,
    },
}

/// One spring or backlash of unknown size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknown {
    /// Its attachment.
    pub attachment: Attachment,
    /// Its direction, per unit: a twist at the origin of the attachment, in its axes.
    pub direction: Twist,
    /// Its role.
    pub role: Role,
}

impl Unknown {
    /// A rotational spring about an axis of its attachment.
    pub fn about(attachment: Attachment, axis: Axis, role: Role) -> Unknown {
        let direction = Twist {
            linear: Vector3::zeros(),
            angular: axis.unit(),
        };
        Unknown {
            attachment,
            direction,
            role,
        }
    }

    /// A translational spring along an axis of its attachment.
    pub fn along(attachment: Attachment, axis: Axis, role: Role) -> Unknown {
        let direction = Twist {
            linear: axis.unit(),
            angular: Vector3::zeros(),
        };
        Unknown {
            attachment,
            direction,
            role,
        }
    }

    /// Whether it is rotational; a translational spring has its compliance in m/N.
    pub fn turns(&self) -> bool {
        self.direction.angular != Vector3::zeros()
    }

    /// Its screw at the flange origin in base axes.
    pub fn screw_at_flange(&self, frames: &Frames) -> Twist {
        let flange = &frames.base_from_flange;
        // Tests are given in the flange frame: the tool is included.
        let base_from_attachment = attachment_frame(self.attachment, frames, flange);
        spring_screw(&self.direction, &base_from_attachment, flange.translation.vector)
    }

    /// `g(tau)` and its derivative.
    pub fn force_law(&self, torque: f64) -> (f64, f64) {
        match self.role {
            Role::LostMotion { torque: to_close } => {
                let closed = (torque / to_close).tanh();
                (closed, (1.0 - closed * closed) / to_close)
            }
            _ => (torque, 1.0),
        }
    }
}

/// The drives of all joints, base to flange.
pub fn drives(robot: &Robot) -> Vec<Unknown> {
    let links = robot.chain().links().iter().enumerate();
    links
        .map(|(index, link)| match link.motion {
            Motion::About(axis, _) => Unknown::about(Attachment::Joint(index), axis, Role::Drive),
            Motion::Along(axis, _) => Unknown::along(Attachment::Joint(index), axis, Role::Drive),
        })
        .collect()
}

/// Bending of every revolute joint about the two other axes of its frame.
///
/// A bending about the axis of the next drive is left out: the two are not distinguishable.
pub fn bending(robot: &Robot) -> Vec<Unknown> {
    let mut found = Vec::new();
    for (index, link) in robot.chain().links().iter().enumerate() {
        let Motion::About(own, _) = link.motion else {
            continue;
        };
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let spring = Unknown::about(Attachment::Joint(index), axis, Role::Bending);
            if axis != own && !is_drive(robot, index + 1, &spring) {
                found.push(spring);
            }
        }
    }
    found
}

/// The floor: rotations about the base axes, without the one that is the axis of the first drive.
pub fn base(robot: &Robot) -> Vec<Unknown> {
    [Axis::X, Axis::Y, Axis::Z]
        .map(|axis| Unknown::about(Attachment::Base, axis, Role::Base))
        .into_iter()
        .filter(|spring| !is_drive(robot, 0, spring))
        .collect()
}

/// Tool and holder: translations along the axes of the flange.
pub fn tool() -> Vec<Unknown> {
    [Axis::X, Axis::Y, Axis::Z]
        .map(|axis| Unknown::along(Attachment::Flange, axis, Role::Tool))
        .to_vec()
}

/// Lost motion of every revolute drive, taken up by these torques (N m), one per joint.
pub fn lost_motion(robot: &Robot, torques: &[f64]) -> Vec<Unknown> {
    drives(robot)
        .into_iter()
        .zip(torques)
        .filter(|(drive, torque)| drive.turns() && **torque > 0.0)
        .map(|(drive, torque)| Unknown {
            role: Role::LostMotion { torque: *torque },
            ..drive
        })
        .collect()
}

/// Axes closer than this (m, rad) are one axis: far below any tolerance of a casting.
const SAME_AXIS: f64 = 1e-9;

/// Whether `spring`, attached to the link before joint `index`, turns about that joint's axis. Both are fixed in
/// that link, so one posture decides.
fn is_drive(robot: &Robot, index: usize, spring: &Unknown) -> bool {
    if !matches!(
        robot.chain().links().get(index).map(|link| link.motion),
        Some(Motion::About(..))
    ) {
        return false;
    }
    let frames = forward(robot, &vec![0.0; robot.joints().len()]);
    let screw = spring.screw_at_flange(&frames);
    let axis = joint_axis(robot, &frames, index);
    let at_axis = screw.moved(frames.origin(index).coords - frames.base_from_flange.translation.vector);
    axis.cross(&screw.angular).norm() < SAME_AXIS && at_axis.linear.norm() < SAME_AXIS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Amount, Joint};

    /// Three axes z, y, y and a wrist x, y, x that meet in one point.
    fn arm() -> Robot {
        let about = |axis, joint| Motion::About(axis, Amount::Joint(joint));
        let along = |axis, by| Motion::Along(axis, Amount::Constant(by));
        let motions = vec![
            along(Axis::Z, 0.45),
            about(Axis::Z, 0),
            along(Axis::X, 0.155),
            about(Axis::Y, 1),
            along(Axis::Z, 0.614),
            about(Axis::Y, 2),
            along(Axis::X, 0.64),
            about(Axis::X, 3),
            about(Axis::Y, 4),
            about(Axis::X, 5),
        ];
        Robot::new(
            "arm",
            motions,
            ["1", "2", "3", "4", "5", "6"].map(Joint::plain).to_vec(),
        )
        .unwrap()
    }

    #[test]
    fn screws_of_drives_are_those_of_the_jacobian() {
        let robot = arm();
        let frames = forward(&robot, &[0.3, -0.4, 0.9, 1.1, -0.7, 0.2]);
        let flange = frames.base_from_flange.translation.vector.into();
        let screws = crate::robot::jacobian::screws_at(&robot, &frames, &flange);
        for (drive, screw) in drives(&robot).iter().zip(screws) {
            let difference = drive.screw_at_flange(&frames).to_vector() - screw.to_vector();
            assert!(difference.norm() < 1e-15);
        }
    }

    #[test]
    fn springs_that_are_not_distinguishable_from_a_drive_are_left_out() {
        let robot = arm();
        // Of twelve, three are drives: 3 about x is drive 4, 4 about y drive 5, 5 about x drive 6.
        assert_eq!(bending(&robot).len(), 9);
        let of_4: Vec<_> = bending(&robot)
            .into_iter()
            .filter(|spring| spring.attachment == Attachment::Joint(3))
            .collect();
        assert_eq!(
            of_4,
            [Unknown::about(Attachment::Joint(3), Axis::Z, Role::Bending)]
        );
        // The floor turns about x and y; about z it is the first drive.
        assert_eq!(base(&robot).len(), 2);
    }

    #[test]
    fn lost_motion_is_limited_to_its_backlash() {
        let gap = lost_motion(&arm(), &[50.0; 6])[0];
        assert_eq!(gap.force_law(0.0).0, 0.0);
        assert!((gap.force_law(-500.0).0 + 1.0).abs() < 1e-8);
        let (at, slope) = gap.force_law(20.0);
        let difference = (gap.force_law(20.0 + 1e-4).0 - at) / 1e-4;
        assert!((slope - difference).abs() < 1e-6, "{slope} against {difference}");
    }
}
