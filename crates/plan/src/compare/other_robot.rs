//! A study with another robot in place of its own: values of the original robot are removed, everything else is kept.
//!
//! | of the study | with another robot |
//! |---|---|
//! | `[compliance]` | removed: the values are those of the original robot. A robot without any gets the class of its payload, marked as assumed |
//! | `home_deg` of postures | left out: joints are counted along another chain |
//! | `[[statement]]` | left out: they speak of the own robot |
//! | `[gravity]` | refused: the posture of the other arm when the tool was set is not known |
//! | plane, tool, load, cut, tolerance, positioner, branch | unchanged: points beyond the reach of the other arm are reported |

use armill_formats::robot::RobotDescription;
use armill_study::compliance_class::ComplianceClass;
use armill_study::error::StudyError;
use armill_study::file::format::{ComplianceTable, StudyFile};
use armill_study::input::tables::PostureTable;

/// Changes `file` to this robot, which was found as `name`.
///
/// # Errors
/// A study with gravity; a robot without compliance and without a compliance class.
pub(super) fn put(file: &mut StudyFile, name: &str, robot: &RobotDescription) -> Result<(), StudyError> {
    let own = std::mem::replace(&mut file.robot, name.to_owned());
    file.compliance = assumed(robot)?;
    file.statement.clear();
    let of_analyses = file.analysis.iter_mut().map(|analysis| &mut analysis.posture);
    for posture in of_analyses.chain([&mut file.posture]) {
        leave_home(posture);
    }
    if file.gravity.take().is_some() {
        let message = format!(
            "gravity.reference_joints_deg are joints of {own}, not of {}",
            robot.robot.name()
        );
        let hint = "if gravity is included, compare separate studies for each robot";
        return Err(StudyError::value(message, hint));
    }
    Ok(())
}

/// The class of compliances for a robot without compliances.
fn assumed(robot: &RobotDescription) -> Result<Option<ComplianceTable>, StudyError> {
    if robot.robot.compliance().is_some() {
        return Ok(None);
    }
    let name = robot.robot.name();
    let hint = "write a separate study with [compliance] for it, and compare the two studies";
    let Some(payload) = robot.payload_kg else {
        let message =
            format!("robot `{name}` has neither joint compliances nor a payload that determines their class");
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

/// Removes the preferred positions of redundant joints.
fn leave_home(posture: &mut Option<PostureTable>) {
    if let Some(table) = posture {
        table.home_deg = None;
    }
}
