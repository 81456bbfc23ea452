//! The motion of a study: its table with the values of the robot file.

use armill_formats::document::Document;
use armill_formats::motion::MotionTable;
use armill_formats::robot::RobotDescription;

use super::format::StudyFile;
use crate::input::problem_log::ProblemLog;

/// The table `motion` of the study with the values of the robot file; `None` if the study has none, or it has problems, which are reported.
pub(super) fn merged(
    log: &mut ProblemLog<'_>,
    document: &Document,
    file: &StudyFile,
    robot: Option<&RobotDescription>,
) -> Option<MotionTable> {
    let table = file.motion.as_ref()?;
    let robot = robot?;
    if file.part_in_hand.is_some() {
        let message = "the motion of an arm that holds the part is not predicted";
        log.problem("motion", message, "leave `[motion]` out");
        return None;
    }
    let problems = table.problems(document, robot.robot.joints().len());
    if !problems.is_empty() {
        log.problems.extend(problems);
        return None;
    }
    Some(
        robot
            .motion
            .as_ref()
            .map_or_else(|| table.clone(), |of_robot| table.or(of_robot)),
    )
}
