//! The arm in the form that pictures need: joint axes, flange and tool as points.
//!
//! Joint positions are in rad (m), points in mm, in base; an axis is a unit vector from the origin of its
//! joint. Still pictures are drawn from the ground, where the robot stands: with a positioner, or with the part in the hand,
//! the base of the chain moves there with the part ([`FromGround`]).

use armill_core::frame::Isometry;
use armill_core::nalgebra::{self, IsometryMatrix3, Point3, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::forward::{base_from_ground, forward, joint_axis};
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

/// How a posture is seen from the ground; without a positioner, and with the tool in the hand, from the base.
#[derive(Clone, Copy, Debug)]
pub struct FromGround {
    ground_from_base: IsometryMatrix3<f64>,
}

impl FromGround {
    /// At these joint positions (rad, m).
    pub fn at(robot: &Robot, joints: &[f64]) -> FromGround {
        FromGround {
            ground_from_base: nalgebra::convert(base_from_ground(robot, joints).inverse()),
        }
    }

    /// The frame of the base as it is seen.
    pub fn ground_from_base(&self) -> &IsometryMatrix3<f64> {
        &self.ground_from_base
    }

    /// A point of the base, mm.
    pub fn point_mm(&self, at: [f64; 3]) -> [f64; 3] {
        let turned = self.ground_from_base.rotation * Vector3::from(at);
        (turned + to_mm(self.ground_from_base.translation.vector)).into()
    }
}

/// [`arm_posture`] seen from the ground.
pub fn arm_on_ground(robot: &Robot, joints: &[f64], flange_from_tool: &Isometry) -> ArmPosture {
    let seen = FromGround::at(robot, joints);
    let arm = arm_posture(robot, joints, flange_from_tool);
    let turned = |axis: [f64; 3]| (seen.ground_from_base.rotation * Vector3::from(axis)).into();
    let joints = arm.joints.into_iter().map(|joint| ArmJoint {
        name: joint.name,
        origin_mm: seen.point_mm(joint.origin_mm),
        axis: turned(joint.axis),
    });
    ArmPosture {
        base_mm: seen.point_mm(arm.base_mm),
        joints: joints.collect(),
        flange_mm: seen.point_mm(arm.flange_mm),
        tool_mm: seen.point_mm(arm.tool_mm),
    }
}

/// Mount and tip of a tool that stands in the cell, mm, seen from the ground; `None` of a robot that holds the tool.
pub fn standing_tool(robot: &Robot, flange_from_tool: &Isometry) -> Option<[[f64; 3]; 2]> {
    let ground_from_mount = robot.hand()?.base_from_mount;
    let tip = ground_from_mount * Point3::from(flange_from_tool.translation.vector);
    Some([ground_from_mount.translation.vector, tip.coords].map(|at| to_mm(at).into()))
}

#[cfg(test)]
mod tests {
    use armill_core::robot::positioner::Positioner;
    use armill_core::robot::{Amount, Axis, Joint, Motion};

    use super::*;

    fn arm() -> Robot {
        crate::library::robot("yaskawa/mh12").unwrap().unwrap().robot
    }

    fn tool() -> Isometry {
        Isometry::translation(0.03, 0.0, 0.2)
    }

    /// Positions of a posture, mm, and the directions of its axes.
    fn numbers(posture: &ArmPosture) -> Vec<f64> {
        let joints = posture
            .joints
            .iter()
            .flat_map(|joint| [joint.origin_mm, joint.axis]);
        let ends = [posture.base_mm, posture.flange_mm, posture.tool_mm];
        joints.chain(ends).flatten().collect()
    }

    fn is_near(a: &[f64], b: &[f64]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn a_robot_stands_upright_however_the_positioner_turns_the_part() {
        let motions = vec![
            Motion::Along(Axis::Z, Amount::Constant(0.4)),
            Motion::About(Axis::X, Amount::Joint(0)),
            Motion::About(Axis::Z, Amount::Joint(1)),
        ];
        let table = Robot::new("table", motions, ["tilt", "turn"].map(Joint::plain).to_vec()).unwrap();
        let positioner = Positioner {
            robot: &table,
            base_from_root: &Isometry::translation(1.0, 0.2, 0.0),
            home: &[0.0, 0.0],
        };
        let arm = arm();
        let both = arm.on_positioner(&positioner, "base_link").unwrap();
        let q = [0.3, -0.2, 0.1, 0.5, -0.7, 0.4];
        let alone = arm_posture(&arm, &q, &tool());
        for [turn, tilt] in [[0.0, 0.0], [1.2, 0.0], [-0.4, 0.9]] {
            let all = [&[turn, tilt], q.as_slice()].concat();
            let shown = arm_on_ground(&both, &all, &tool());
            assert!(is_near(&numbers(&shown), &numbers(&alone)), "{shown:?}");
            // The part turns: the origin of the table is where the positioner has it.
            let at = FromGround::at(&both, &all).point_mm([0.0; 3]);
            assert!(is_near(&at, &[1000.0, 200.0, 400.0]), "{at:?}");
            let relative_to_table = arm_posture(&both, &all, &tool());
            let is_turned = !is_near(&numbers(&relative_to_table), &numbers(&alone));
            assert!(is_turned, "the table is not the ground");
        }
        assert!(standing_tool(&both, &tool()).is_none());
    }

    #[test]
    fn a_robot_with_the_part_in_its_hand_stands_upright_next_to_the_tool() {
        let arm = arm();
        let mount = Isometry::translation(1.1, 0.3, 0.8);
        let hand = arm.holding_part(&mount).unwrap();
        let q = [0.3, -0.2, 0.1, 0.5, -0.7, 0.4];
        let back: Vec<f64> = q.iter().rev().copied().collect();
        let alone = arm_posture(&arm, &q, &Isometry::identity());
        let shown = arm_on_ground(&hand, &back, &tool());
        let names = |posture: &ArmPosture| -> Vec<String> {
            posture.joints.iter().map(|joint| joint.name.clone()).collect()
        };
        assert_eq!(names(&shown), names(&alone));
        // Axes of the chain from the flange back are the same lines.
        for (a, b) in shown.joints.iter().zip(&alone.joints) {
            let (axis, other) = (Vector3::from(a.axis), Vector3::from(b.axis));
            let between = Vector3::from(a.origin_mm) - Vector3::from(b.origin_mm);
            assert!(axis.cross(&other).norm() < 1e-12, "{a:?} {b:?}");
            assert!(axis.cross(&between).norm() < 1e-9, "{a:?} {b:?}");
        }
        assert!(is_near(&shown.flange_mm, &alone.flange_mm));
        assert!(is_near(&shown.base_mm, &[0.0; 3]));
        let [mount_mm, tip_mm] = standing_tool(&hand, &tool()).unwrap();
        assert!(is_near(&mount_mm, &[1100.0, 300.0, 800.0]));
        assert!(is_near(&tip_mm, &[1130.0, 300.0, 1000.0]));
        // What the tip touches is there in the picture, wherever the flange is.
        let tip = tool_on(&forward(&hand, &back), &tool()).translation.vector;
        let touched = FromGround::at(&hand, &back).point_mm(to_mm(tip).into());
        assert!(is_near(&touched, &tip_mm), "{touched:?}");
    }
}
