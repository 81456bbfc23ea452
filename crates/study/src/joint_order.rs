//! The order of joints in results, tables and keys: that of the robot.
//!
//! The chain of a robot that holds the part begins at its flange ([`armill_core::robot::hand`]): its joints are in the order `A6` ... `A1`. For a user
//! they are in that of the robot, `A1` ... `A6`, and so are their shares. The joints of a positioner come first, from its table back.

use armill_core::robot::Robot;
use armill_core::source::{MotionDisplacement, StiffnessModel};

use crate::error::StudyError;
use crate::joint_unit::JointUnit;

/// The joints of the chain in the order of the robot.
pub fn joint_order(robot: &Robot) -> Vec<usize> {
    let joints = 0..robot.joints().len();
    match robot.chain().ground().part_is_in_hand() {
        true => joints.rev().collect(),
        false => joints.collect(),
    }
}

/// Values of the joints of the chain, and after them others, with the joints in the order of the robot.
pub fn in_joint_order<T: Clone>(robot: &Robot, values: &[T]) -> Vec<T> {
    let joints = robot.joints().len().min(values.len());
    let mut shown = values.to_vec();
    if robot.chain().ground().part_is_in_hand() {
        shown[..joints].reverse();
    }
    shown
}

/// Their names.
pub fn joint_names(robot: &Robot) -> Vec<String> {
    let names = joint_order(robot).into_iter();
    names.map(|joint| robot.joints()[joint].name.clone()).collect()
}

/// The names of the contributors to a deviation: the joints, then the others of the model, then, along a path, those of its motion.
pub fn contributor_names(robot: &Robot, model: &StiffnessModel, has_motion: bool) -> Vec<String> {
    let of_motion = MotionDisplacement::CONTRIBUTORS.map(|contributor| contributor.name(robot.joints()));
    let of_model = in_joint_order(robot, &model.contributor_names(robot.joints()));
    let of_motion = of_motion.into_iter().filter(|_| has_motion);
    of_model.into_iter().chain(of_motion).collect()
}

/// Joint positions in deg (mm) from those of the chain in rad (m).
pub fn shown_positions(robot: &Robot, q: &[f64]) -> Vec<f64> {
    let joints = joint_order(robot).into_iter();
    joints
        .map(|joint| q[joint] * JointUnit::of(robot, joint).scale)
        .collect()
}

/// Joint positions of the chain in rad (m) from those given in deg (mm); those of a positioner may be left out, and are then those of
/// the study.
///
/// # Errors
/// Not one a joint.
pub fn joint_positions(robot: &Robot, given: &[f64]) -> Result<Vec<f64>, StudyError> {
    let mut order = joint_order(robot);
    let of_positioner = robot.chain().ground().positioner_joints();
    if of_positioner > 0 && given.len() + of_positioner == order.len() {
        order.drain(..of_positioner);
    }
    if given.len() != order.len() {
        let message = format!(
            "{} joint positions for the {} joints of `{}`",
            given.len(),
            order.len(),
            robot.name()
        );
        let hint = format!("one each for {}", joint_names(robot).join(", "));
        return Err(StudyError::value(message, hint));
    }
    let mut all = match order.len() == robot.joints().len() {
        true => vec![0.0; order.len()],
        false => robot.home(None),
    };
    for (joint, value) in order.into_iter().zip(given) {
        all[joint] = JointUnit::of(robot, joint).to_si(*value);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use armill_core::frame::Isometry;

    use super::*;

    fn arm() -> Robot {
        crate::library::robot("kuka/kr210r2700extra")
            .unwrap()
            .unwrap()
            .robot
    }

    #[test]
    fn joints_of_a_robot_that_holds_the_part_are_shown_in_its_own_order() {
        let arm = arm();
        let hand = arm.holding_part(&Isometry::translation(2.0, 0.0, 1.0)).unwrap();
        let names = ["A1", "A2", "A3", "A4", "A5", "A6"];
        assert_eq!(joint_names(&arm), names);
        assert_eq!(joint_names(&hand), names);
        let given = [10.0, -20.0, 30.0, 40.0, -50.0, 60.0];
        let q = joint_positions(&hand, &given).unwrap();
        assert!((q[0] - 60_f64.to_radians()).abs() < 1e-15);
        for (shown, given) in shown_positions(&hand, &q).into_iter().zip(given) {
            assert!((shown - given).abs() < 1e-12);
        }
        let model = StiffnessModel::DRIVES.clone();
        assert_eq!(contributor_names(&hand, &model, false)[..6], names);
        assert_eq!(
            in_joint_order(&hand, &[1, 2, 3, 4, 5, 6, 7]),
            [6, 5, 4, 3, 2, 1, 7]
        );
        assert_eq!(
            in_joint_order(&arm, &[1, 2, 3, 4, 5, 6, 7]),
            [1, 2, 3, 4, 5, 6, 7]
        );
    }

    #[test]
    fn a_wrong_number_of_positions_names_the_joints_in_that_order() {
        let hand = arm().holding_part(&Isometry::identity()).unwrap();
        let error = joint_positions(&hand, &[0.0; 5]).unwrap_err().to_string();
        assert!(error.contains("5 joint positions for the 6 joints"), "{error}");
        assert!(error.contains("A1, A2, A3, A4, A5, A6"), "{error}");
    }
}
