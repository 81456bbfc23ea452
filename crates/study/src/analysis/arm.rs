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
/// holds the part has no tool.
pub fn arm_posture(robot: &Robot, joints: &[f64], flange_from_tool: &Isometry) -> ArmPosture {
    let frames = forward(robot, joints);
    let mm = |v: &Vector3<f64>| -> [f64; 3] { to_mm(v).into() };
    let ground = robot.chain().ground();
    let base_from_tool = tool_on(&frames, flange_from_tool);
    // The base of the chain is the flange of an arm that holds the part.
    let end = |v: &Vector3<f64>| match ground.part_is_in_hand() {
        true => [0.0; 3],
        false => mm(v),
    };
    let of_arm = ground.positioner_joints()..robot.joints().len();
    let from_base: Vec<usize> = match ground.part_is_in_hand() {
        true => of_arm.rev().collect(),
        false => of_arm.collect(),
    };
    ArmPosture {
        base_mm: mm(&ground.in_base(&frames.base_from_joint).translation.vector),
        joints: from_base
            .into_iter()
            .map(|i| ArmJoint {
                name: robot.joints()[i].name.clone(),
                origin_mm: mm(&frames.origin(i).coords),
                axis: joint_axis(robot, &frames, i).into(),
            })
            .collect(),
        flange_mm: end(&frames.base_from_flange.translation.vector),
        tool_mm: end(&base_from_tool.translation.vector),
    }
}
