//! Pictures of an arm alone, and of the postures of a single pose.

use armill_core::frame::Isometry;
use armill_core::nalgebra::Point3;
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_core::units::to_mm;
use armill_report::{ArmDrawing, View};

use crate::analysis::arm::{FromGround, arm_on_ground, standing_tool};
use crate::joint_order::joint_positions;
use crate::pose::{PoseAnswer, PostureAnswer};

/// Half the side of the plate in the picture of a single pose, m.
const PLATE: f64 = 0.15;

/// The arm in the first posture of an answer that is inside limits, the others faintly, with a plate in front of the
/// tool.
pub fn posture_drawing(robot: &Robot, flange_from_tool: &Isometry, answer: &PoseAnswer) -> String {
    let joints = |posture: &PostureAnswer| -> Vec<f64> {
        // As many as the robot has: it is the robot of the answer.
        joint_positions(robot, &posture.joints_deg).unwrap_or_else(|_| robot.home(None))
    };
    let draw = |posture: &PostureAnswer| arm_on_ground(robot, &joints(posture), flange_from_tool);
    let plate = |posture: &PostureAnswer| {
        let joints = joints(posture);
        let base_from_tool = posture_at(robot, &joints, flange_from_tool).base_from_tool;
        let seen = FromGround::at(robot, &joints);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| -> [f64; 3] {
            let corner = base_from_tool * Point3::new(x * PLATE, y * PLATE, 0.0);
            seen.point_mm(to_mm(corner.coords).into())
        })
    };
    let chosen = answer
        .postures
        .iter()
        .position(|posture| posture.within_limits)
        .unwrap_or(0);
    let others = answer.postures.iter().enumerate().filter(|(i, _)| *i != chosen);
    let name = |posture: &PostureAnswer| posture.branch.clone();
    let drawing = ArmDrawing {
        title: answer.robot.clone(),
        subtitle: answer
            .postures
            .get(chosen)
            .map_or_else(|| "out of reach".to_owned(), name),
        posture: answer.postures.get(chosen).map(draw).unwrap_or_default(),
        ghosts: others.map(|(_, posture)| draw(posture)).collect(),
        plate_mm: answer.postures.get(chosen).map(plate),
        standing_tool_mm: standing_tool(robot, flange_from_tool),
        ..ArmDrawing::default()
    };
    drawing.to_svg_views(&[View::Iso, View::Side])
}

/// The arm alone, with all joints at zero, from four sides.
pub fn arm_drawing(robot: &Robot, title: &str) -> String {
    let zeros = vec![0.0; robot.joints().len()];
    let drawing = ArmDrawing {
        title: title.to_owned(),
        subtitle: "all joints at zero; base frame at the base of the arm".to_owned(),
        posture: arm_on_ground(robot, &zeros, &Isometry::identity()),
        ..ArmDrawing::default()
    };
    drawing.to_svg_views(&[View::Iso, View::Front, View::Side, View::Top])
}
