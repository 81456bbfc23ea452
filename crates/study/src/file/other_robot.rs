//! A study with another robot in place of its own: what follows the robot is taken out, everything else stays.
//!
//! | of the study | with another robot |
//! |---|---|
//! | `[compliance]` | left out: the values are the own robot's. Of a robot that has none the class of its payload, marked as assumed |
//! | `home_deg` of postures | left out: joints are counted along another chain |
//! | `[[statement]]` | left out: they speak of the own robot |
//! | `[gravity]` | refused: nothing tells how the other arm stood when the tool was set |
//! | plane, tool, load, cut, tolerance, positioner, branch | stay: what the other arm does not reach is told as out of reach |

use armill_formats::robot::RobotDescription;

use super::format::{ComplianceTable, PostureTable, StudyFile};
use crate::compliance_class::ComplianceClass;
use crate::error::StudyError;

/// Makes `file` one for this robot, which is found as `name`.
///
/// # Errors
/// A study that counts gravity; a robot without compliance that no class stands for.
pub(crate) fn put(file: &mut StudyFile, (name, robot): (&str, &RobotDescription)) -> Result<(), StudyError> {
    let own = std::mem::replace(&mut file.robot, name.to_owned());
    file.compliance = assumed(robot)?;
    file.statement.clear();
    let of_asks = file.analysis.iter_mut().map(|analysis| &mut analysis.posture);
    for posture in of_asks.chain([&mut file.posture]) {
        leave_home(posture);
    }
    if file.gravity.take().is_some() {
        let message = format!(
            "gravity.reference_joints_deg are joints of {own}, not of {}",
            robot.robot.name()
        );
        let hint = "where gravity counts, compare with a study of its own for each robot";
        return Err(StudyError::value(message, hint));
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
