//! A study with another robot in place of its own: what follows the robot is taken out, everything else stays.
//!
//! | of the study | with another robot |
//! |---|---|
//! | `[compliance]` | left out: the values are the own robot's. Of a robot that has none the class of its payload, marked as assumed |
//! | `home_deg` of postures | left out: joints are counted along another chain |
//! | `[[statement]]` | left out: they speak of the own robot |
//! | `gravity.reference_joints_deg` | a problem: nothing tells how the other arm stood when the tool was set |
//! | plane, tool, load, cut, tolerance, positioner, branch | stay: what the other arm does not reach is told as out of reach |

use armill_formats::robot::RobotDescription;

use super::format::{ComplianceTable, PostureTable, StudyFile};
use super::places::Places;
use crate::compliance_class::ComplianceClass;
use crate::error::StudyError;

/// Makes `file` one for `robot`.
///
/// # Errors
/// A robot without compliance that no class stands for.
pub(super) fn put(
    places: &mut Places<'_>,
    file: &mut StudyFile,
    robot: &RobotDescription,
) -> Result<(), StudyError> {
    let name = robot.robot.name();
    if file.gravity.is_some() {
        let message = format!(
            "gravity.reference_joints_deg are joints of {}, not of {name}",
            file.robot
        );
        let hint = "where gravity counts, compare with a study of its own for each robot";
        places.problem("gravity.reference_joints_deg", message, hint);
    }
    name.clone_into(&mut file.robot);
    file.compliance = assumed(robot)?;
    file.statement.clear();
    let of_asks = file.ask.iter_mut().map(|ask| &mut ask.posture);
    for posture in of_asks.chain([&mut file.posture]) {
        leave_home(posture);
    }
    Ok(())
}

/// The class of compliances for a robot that has none of its own.
fn assumed(robot: &RobotDescription) -> Result<Option<ComplianceTable>, StudyError> {
    if robot.robot.compliance().is_some() {
        return Ok(None);
    }
    let name = robot.robot.name();
    let hint = "give it a study of its own with [compliance], and compare the two studies";
    let Some(payload) = robot.payload_kg else {
        let message =
            format!("robot `{name}` has neither joint compliances nor a payload that would tell their class");
        return Err(StudyError::value(message, hint));
    };
    let class = ComplianceClass::of_payload(payload);
    class.compliance_of(&robot.robot).map_err(|error| match error {
        StudyError::Value { message, .. } => StudyError::value(message, hint),
        other => other,
    })?;
    Ok(Some(ComplianceTable {
        rad_per_n_m: None,
        u_rad_per_n_m: None,
        class: Some(class),
        source: None,
        assumed: None,
    }))
}

/// Takes the home of joints to spare out.
fn leave_home(posture: &mut Option<PostureTable>) {
    if let Some(table) = posture {
        table.home_deg = None;
    }
}
