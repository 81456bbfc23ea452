//! The arm in the form that pictures need: joint axes, flange and tool as points.
//!
//! Joint positions are in rad (m), points in mm, both in base; an axis is a unit vector from the origin of its
//! joint.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::inverse::tool_on;
use armill_core::units::to_mm;
use armill_report::{ArmJoint, ArmPosture};

/// The arm at these joint positions (rad, m), base frame; from the ground on, without the joints of a positioner. An arm that
/// holds the part ends at its flange, and the tool stands in front of it.
pub fn arm_posture(robot: &Robot, joints: &[f64], flange_from_tool: &Isometry) -> ArmPosture {
    let frames = forward(robot, joints);
    let mm = |v: &Vector3<f64>| -> [f64; 3] { to_mm(v).into() };
    let ground = robot.chain().ground();
    let base_from_tool = tool_on(&frames, flange_from_tool);
    ArmPosture {
        base_mm: mm(&ground.in_base(&frames.base_from_joint).translation.vector),
        joints: (0..robot.joints().len() - ground.positioner_joints())
            .map(|number| match ground.part_is_in_hand() {
                true => robot.joints().len() - 1 - number,
                false => ground.positioner_joints() + number,
            })
            .map(|i| ArmJoint {
                name: robot.joints()[i].name.clone(),
                origin_mm: mm(&frames.origin(i).coords),
                axis: joint_axis(robot, &frames, i).into(),
            })
            .collect(),
        flange_mm: match ground.part_is_in_hand() {
            true => [0.0; 3],
            false => mm(&frames.base_from_flange.translation.vector),
        },
        tool_mm: mm(&base_from_tool.translation.vector),
    }
}
