//! The rail of a robot.

use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_study::ENOUGH_JOINTS;
use armill_study::error::StudyError;

/// The joint that is the rail: the first prismatic joint of a robot with redundant joints.
pub(super) fn rail_of(robot: &Robot) -> Option<usize> {
    let joints = robot.joints().len();
    (0..joints).find(|joint| joints > ENOUGH_JOINTS && robot.slides(*joint))
}

/// The home positions `home`, or the middle of each range (rad, m), with the rail at `rail` (m).
pub(super) fn home_at(robot: &Robot, home: Option<&[f64]>, rail: f64) -> Vec<f64> {
    let mut home = robot.home(home);
    if let Some(joint) = rail_of(robot) {
        home[joint] = rail;
    }
    home
}

/// Refuses a rail that is not there, or bounds (m) outside its limits.
pub(super) fn check_rail(robot: &Robot, [least, greatest]: [f64; 2]) -> Result<(), StudyError> {
    let Some(rail) = rail_of(robot) else {
        let message = format!("`rail_mm`: robot `{}` has no rail", robot.name());
        return Err(StudyError::value(
            message,
            "a rail is a prismatic joint before the six of the robot",
        ));
    };
    let joint = &robot.joints()[rail];
    match joint.limits {
        Some(limits) if least < limits.lower || greatest > limits.upper => {
            let message = format!(
                "`rail_mm` ranges from {} to {} mm, joint {} from {} to {} mm",
                to_mm(least),
                to_mm(greatest),
                joint.name,
                to_mm(limits.lower),
                to_mm(limits.upper)
            );
            Err(StudyError::value(message, "bounds inside those of the joint"))
        }
        _ => Ok(()),
    }
}
