//! The units of a joint: degrees and rad/(N m) if it is revolute, millimetres and µm/N if it is prismatic.

use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm};

use crate::error::StudyError;

/// The units of one joint at the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointUnit {
    /// Unit of its positions, limits, and (a second) speed.
    pub name: &'static str,
    /// That unit in one rad (m).
    pub scale: f64,
    /// Unit of its compliance.
    pub compliance_name: &'static str,
    /// That unit in one rad/(N m) (m/N).
    pub compliance_scale: f64,
}

impl JointUnit {
    /// Of a revolute joint.
    pub const TURNING: JointUnit = JointUnit {
        name: "deg",
        scale: 180.0 / std::f64::consts::PI,
        compliance_name: "rad/(N m)",
        compliance_scale: 1.0,
    };

    /// Of a prismatic joint.
    pub const SLIDING: JointUnit = JointUnit {
        name: "mm",
        scale: 1e3,
        compliance_name: "µm/N",
        compliance_scale: 1e6,
    };

    /// A position in rad (m) from one in this unit.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            JointUnit::SLIDING => from_mm(value),
            _ => from_deg(value),
        }
    }

    /// The units of joint `index` of `robot`.
    pub fn of(robot: &Robot, index: usize) -> JointUnit {
        if robot.slides(index) {
            JointUnit::SLIDING
        } else {
            JointUnit::TURNING
        }
    }
}

/// Joint positions in rad (m) from those given in deg (mm); those of a positioner may be left out, and are then those of
/// the study.
///
/// # Errors
/// Not one a joint.
pub fn joint_positions(robot: &Robot, given: &[f64]) -> Result<Vec<f64>, StudyError> {
    let of_positioner = robot.chain().ground().positioner_joints();
    if of_positioner > 0 && given.len() + of_positioner == robot.joints().len() {
        let home = robot.home(None);
        let of_arm = given.iter().enumerate();
        let of_arm = of_arm.map(|(joint, value)| JointUnit::of(robot, joint + of_positioner).to_si(*value));
        return Ok(home[..of_positioner].iter().copied().chain(of_arm).collect());
    }
    let order: Vec<usize> = (0..robot.joints().len()).collect();
    positions_in(&order, robot, given)
}

/// [`joint_positions`] in the order of the robot itself, from its base on: the opposite of that of the chain where it holds
/// the part.
///
/// # Errors
/// Not one a joint.
pub fn joint_positions_from_base(robot: &Robot, given: &[f64]) -> Result<Vec<f64>, StudyError> {
    if !robot.chain().ground().part_is_in_hand() {
        return joint_positions(robot, given);
    }
    let order: Vec<usize> = (0..robot.joints().len()).rev().collect();
    positions_in(&order, robot, given)
}

/// Joint positions in rad (m) from those in deg (mm) of the joints in this order.
fn positions_in(order: &[usize], robot: &Robot, given: &[f64]) -> Result<Vec<f64>, StudyError> {
    if given.len() != order.len() {
        let message = format!(
            "{} joint positions for the {} joints of `{}`",
            given.len(),
            order.len(),
            robot.name()
        );
        let names = order.iter().map(|joint| robot.joints()[*joint].name.as_str());
        let names: Vec<&str> = names.collect();
        return Err(StudyError::value(
            message,
            format!("one each for {}", names.join(", ")),
        ));
    }
    let mut all = vec![0.0; order.len()];
    for (joint, value) in order.iter().zip(given) {
        all[*joint] = JointUnit::of(robot, *joint).to_si(*value);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_is_shown_as_by_to_degrees() {
        for q in [1.0_f64, -2.705260340591211, 0.1] {
            assert_eq!(q * JointUnit::TURNING.scale, q.to_degrees());
        }
    }
}
