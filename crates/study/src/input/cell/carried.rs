//! What carries the arm, or rides with it: the pedestal, and obstacles `on` a joint in front of the arm.
//!
//! Their coordinates are relative to the reference frame where all joints in front of the arm are at 0: there a body of such a joint
//! has the pose
//!
//! ```text
//! joint_from_body = joint_from_base(0) base_from_reference reference_from_body
//! ```
//!
//! They are bodies of the link of that joint, and not checked against the links next to it, as links of the arm are not.

use armill_core::clearance::{ArmBody, Role};
use armill_core::frame::Isometry;
use armill_core::nalgebra;
use armill_core::robot::forward::forward;
use armill_core::robot::{Attachment, Robot};

use crate::input::cell::named_shape::NamedShape;
use crate::input::problem_log::ProblemLog;

/// A body that carries the arm or rides with it.
#[derive(Clone, Debug)]
pub struct CarriedBody {
    /// The body, in the reference frame.
    pub body: NamedShape,
    /// What it moves with: the base, or a joint in front of the arm.
    pub attachment: Attachment,
}

impl CarriedBody {
    /// The body with its frame.
    pub(super) fn placed(&self, robot: &Robot, base_from_reference: &Isometry) -> ArmBody {
        let base_from_body = base_from_reference * self.body.frame_from_body;
        let attachment_from_body = match self.attachment {
            Attachment::Joint(joint) => {
                let zero = forward(robot, &vec![0.0; robot.joints().len()]);
                let base_from_joint: Isometry = nalgebra::convert(zero.base_from_joint[joint]);
                base_from_joint.inverse() * base_from_body
            }
            _ => base_from_body,
        };
        ArmBody {
            name: self.body.name.clone(),
            attachment: self.attachment,
            attachment_from_body,
            shape: self.body.shape.clone(),
            role: Role::Link,
        }
    }
}

/// Joints in front of the arm: those of a rail or gantry.
fn in_front(robot: &Robot) -> std::ops::Range<usize> {
    let joints = 0..robot.joints().len();
    0..joints.take_while(|joint| robot.carries_the_arm(*joint)).count()
}

/// What the pedestal of this robot moves with: the last joint in front of the arm, or its base.
pub(super) fn under_the_arm(robot: &Robot) -> Attachment {
    in_front(robot).last().map_or(Attachment::Base, Attachment::Joint)
}

/// The joint in front of the arm with this name or number; `None` if there is none, reported at `key`.
pub(super) fn joint_in_front(
    log: &mut ProblemLog<'_>,
    key: &str,
    named: &str,
    robot: &Robot,
) -> Option<Attachment> {
    let joints = robot.joints();
    let of_number = || {
        let number: usize = named.parse().ok()?;
        (1..=joints.len()).contains(&number).then(|| number - 1)
    };
    let found = joints
        .iter()
        .position(|joint| joint.name == named)
        .or_else(of_number);
    if let Some(joint) = found.filter(|joint| in_front(robot).contains(joint)) {
        return Some(Attachment::Joint(joint));
    }
    let (message, of_arm) = match found {
        Some(_) => (
            format!(
                "joint `{named}` of robot `{}` is a joint of the arm itself",
                robot.name()
            ),
            "bodies of a link belong in the robot file ([[body]]), those of the tool in [[tool.body]]; ",
        ),
        None => (format!("robot `{}` has no joint `{named}`", robot.name()), ""),
    };
    let names: Vec<&str> = joints[in_front(robot)]
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    let hint = match names.as_slice() {
        [] => format!(
            "{of_arm}an obstacle rides on a joint in front of the arm, as of a rail; this robot has none"
        ),
        names => format!("{of_arm}its joints in front of the arm: {}", names.join(", ")),
    };
    log.problem(key, message, &hint);
    None
}
