//! The springs that load tests are asked for.
//!
//! Each unknown sits at a **seat** and moves all that comes after it by a **direction**, a twist at the seat's origin
//! in the seat's axes. Under a wrench it gives way by `x = c g(tau)`, with `tau` the work of the wrench on its screw:
//!
//! | role | `g(tau)` | unit of `c` |
//! |---|---|---|
//! | spring that turns | `tau` | rad/(N m) |
//! | spring that slides | `tau` | m/N |
//! | lost motion | `tanh(tau / tau_0)` | rad: half the gap |
//!
//! The seat of a joint is the frame right after the joint's motion.

use nalgebra::Vector3;

use crate::robot::chain::{Axis, Motion};
use crate::robot::forward::{Frames, forward, joint_axis};
use crate::robot::deflected_arm::{attachment_frame, spring_screw};
use crate::robot::{Robot, Attachment};
use crate::spatial::Twist;

/// What yields there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// The drive of a joint, control loop included.
    Drive,
    /// A bearing or link beside its drive.
    Bending,
    /// The floor under the arm.
    Base,
    /// Tool and holder.
    Tool,
    /// The gap in a drive, taken up by a torque of about `torque` (N m, or N).
    LostMotion {
        /// `tau_0`.
        torque: f64,
    },
}

/// One spring or gap whose size is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknown {
    /// Where it sits.
    pub attachment: Attachment,
    /// How it moves what comes after it, per unit: a twist at the seat's origin, in the seat's axes.
    pub direction: Twist,
    /// What it is.
    pub role: Role,
}

impl Unknown {
    /// A spring that turns about an axis of its seat.
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

    /// A spring that slides along an axis of its seat.
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

    /// Whether it turns; a spring that slides has its compliance in m/N.
    pub fn turns(&self) -> bool {
        self.direction.angular != Vector3::zeros()
    }

    /// Its screw at the flange origin in base axes.
    pub fn screw_at_flange(&self, frames: &Frames) -> Twist {
        let flange = &frames.base_from_flange;
        // Tests are told in the flange frame: a tool sits on it as it is.
        let base_from_attachment = attachment_frame(self.attachment, frames, flange);
        spring_screw(&self.direction, &base_from_attachment, flange.translation.vector)
    }

    /// `g(tau)` and its derivative.
    pub fn gives_way(&self, torque: f64) -> (f64, f64) {
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

/// Bending of every turning joint about the two axes of its frame beside its own.
///
/// A bending that lies on the axis of the next drive is left out: nothing tells the two apart.
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

/// The floor: turns about the base axes, without the one that is the axis of the first drive.
pub fn base(robot: &Robot) -> Vec<Unknown> {
    [Axis::X, Axis::Y, Axis::Z]
        .map(|axis| Unknown::about(Attachment::Base, axis, Role::Base))
        .into_iter()
        .filter(|spring| !is_drive(robot, 0, spring))
        .collect()
}

/// Tool and holder: slides along the axes of the flange.
pub fn tool() -> Vec<Unknown> {
    [Axis::X, Axis::Y, Axis::Z]
        .map(|axis| Unknown::along(Attachment::Flange, axis, Role::Tool))
        .to_vec()
}

/// Lost motion of every turning drive, taken up by these torques (N m), one a joint.
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

/// Axes nearer than this (m, rad) are one axis: far below any tolerance of a casting.
const SAME_AXIS: f64 = 1e-9;

/// Whether `spring`, which sits on the link before joint `index`, turns about that joint's axis. Both stand still in
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
    fn what_no_test_can_tell_from_a_drive_is_not_asked() {
        let robot = arm();
        // Of twelve, three are drives: 3 about x is drive 4, 4 about y drive 5, 5 about x drive 6.
        assert_eq!(bending(&robot).len(), 9);
        let of_4: Vec<_> = bending(&robot)
            .into_iter()
            .filter(|spring| spring.attachment == Attachment::Joint(3))
            .collect();
        assert_eq!(of_4, [Unknown::about(Attachment::Joint(3), Axis::Z, Role::Bending)]);
        // The floor turns about x and y; about z it is the first drive.
        assert_eq!(base(&robot).len(), 2);
    }

    #[test]
    fn lost_motion_closes_its_gap_and_no_more() {
        let gap = lost_motion(&arm(), &[50.0; 6])[0];
        assert_eq!(gap.gives_way(0.0).0, 0.0);
        assert!((gap.gives_way(-500.0).0 + 1.0).abs() < 1e-8);
        let (at, slope) = gap.gives_way(20.0);
        let difference = (gap.gives_way(20.0 + 1e-4).0 - at) / 1e-4;
        assert!((slope - difference).abs() < 1e-6, "{slope} against {difference}");
    }
}
