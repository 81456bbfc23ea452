//! What carries the arm, or rides with it: the pedestal, and obstacles `on` a joint in front of the arm.
//!
//! Their coordinates are relative to the reference frame where all joints in front of the arm are at 0, and those of a
//! positioner at home: there a body of such a joint has the pose
//!
//! ```text
//! joint_from_body = joint_from_base(0) base_from_reference reference_from_body
//! ```
//!
//! Where a positioner carries the part, its table is the base of the chain: obstacles and the floor stand on the ground and
//! move relative to it. They are bodies of the ground there. Where the robot holds the part, their coordinates are relative to its `base_link`,
//! the ground itself.
//!
//! They are bodies of the link of that joint, and not checked against the links next to it, as links of the arm are not.

use armill_core::clearance::{ArmBody, Bounds, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{self, Point3};
use armill_core::robot::forward::forward;
use armill_core::robot::{Attachment, Robot};

use crate::input::cell::named_shape::{FLOOR, NamedShape};
use crate::input::problem_log::ProblemLog;

/// A body that carries the arm or rides with it.
#[derive(Clone, Debug)]
pub struct CarriedBody {
    /// The body, in the reference frame.
    pub body: NamedShape,
    /// What it moves with: the base, or a joint in front of the arm.
    pub attachment: Attachment,
    /// What it is.
    pub role: Role,
}

impl CarriedBody {
    /// Whether it is the floor.
    pub(super) fn is_floor(&self) -> bool {
        self.role == Role::Obstacle && self.body.table == FLOOR
    }

    /// The body with its frame.
    pub(super) fn placed(&self, robot: &Robot, base_from_reference: &Isometry) -> ArmBody {
        let base_from_body = base_from_reference * self.body.frame_from_body;
        let ground = robot.chain().ground();
        let attachment_from_body = match self.attachment {
            _ if ground.part_is_in_hand() => ground.joint_from_ground * self.body.frame_from_body,
            Attachment::Joint(joint) => {
                let mut at = robot.home(None);
                at[ground.joints..].fill(0.0);
                let base_from_joint: Isometry = nalgebra::convert(forward(robot, &at).base_from_joint[joint]);
                base_from_joint.inverse() * base_from_body
            }
            _ => base_from_body,
        };
        ArmBody {
            name: self.body.name.clone(),
            attachment: self.attachment,
            attachment_from_body,
            shape: self.body.shape.clone(),
            role: self.role,
        }
    }
}

/// Joints between the ground and the arm: those of a rail or gantry.
fn in_front(robot: &Robot) -> std::ops::Range<usize> {
    let ground = robot.chain().ground().joints;
    let joints = 0..robot.joints().len();
    let external = joints.take_while(|joint| robot.is_external(*joint)).count();
    ground..external.max(ground)
}

/// What the pedestal of this robot moves with: the last joint in front of the arm, or the ground.
pub(super) fn under_the_arm(robot: &Robot) -> Attachment {
    let ground = robot.chain().ground().attachment();
    in_front(robot).last().map_or(ground, Attachment::Joint)
}

/// Whether a link is the base of the arm, its first link, or carries them: above the floor by design.
pub(super) fn is_near_the_ground(body: &ArmBody, robot: &Robot) -> bool {
    let ground = robot.chain().ground();
    if ground.part_is_in_hand() {
        // The first link of the arm is in front of its base.
        return matches!(body.attachment, Attachment::Joint(joint) if joint + 2 >= ground.joints);
    }
    let (ground, first_of_arm) = (ground.joints, in_front(robot).end);
    matches!(body.attachment, Attachment::Joint(joint) if joint + 1 >= ground && joint <= first_of_arm)
}

/// The thickness and half the width of the floor where it is a body, m.
const SLAB: [f64; 2] = [1.0, 6.0];

/// The floor at this height (m, reference frame) as a body of the ground.
pub(super) fn slab(height: f64, ground: Attachment) -> CarriedBody {
    let [thickness, half] = SLAB;
    CarriedBody {
        body: NamedShape {
            name: FLOOR.to_owned(),
            shape: Shape::Box(Bounds::of([
                Point3::new(-half, -half, -thickness),
                Point3::new(half, half, 0.0),
            ])),
            frame_from_body: Isometry::translation(0.0, 0.0, height),
            table: FLOOR.to_owned(),
        },
        attachment: ground,
        role: Role::Obstacle,
    }
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
