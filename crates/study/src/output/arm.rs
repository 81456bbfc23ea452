//! The arm as the pictures need it: joint axes, flange and tool as points.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::robot::inverse::tool_on;
use armill_report::{ArmDrawing, ArmJoint, Posture, View};

/// The arm at these joint positions (rad, m), base frame.
pub fn arm_posture(robot: &Robot, joints: &[f64], flange_from_tool: &Isometry) -> Posture {
    let frames = forward(robot, joints);
    let mm = |v: &Vector3<f64>| -> [f64; 3] { (v * 1e3).into() };
    let base_from_tool = tool_on(&frames, flange_from_tool);
    Posture {
        base_mm: [0.0; 3],
        joints: (0..robot.joints().len())
            .map(|i| ArmJoint {
                name: robot.joints()[i].name.clone(),
                origin_mm: mm(&frames.origin(i).coords),
                axis: joint_axis(robot, &frames, i).into(),
            })
            .collect(),
        flange_mm: mm(&frames.base_from_flange.translation.vector),
        tool_mm: mm(&base_from_tool.translation.vector),
    }
}

/// The arm alone, at its joint zeros, from four sides.
pub fn arm_drawing(robot: &Robot, title: &str) -> String {
    let zeros = vec![0.0; robot.joints().len()];
    let drawing = ArmDrawing {
        title: title.to_owned(),
        subtitle: "all joints at zero; base frame at the foot".to_owned(),
        posture: arm_posture(robot, &zeros, &Isometry::identity()),
        ..ArmDrawing::default()
    };
    drawing.to_svg_views(&[View::Iso, View::Front, View::Side, View::Top])
}
