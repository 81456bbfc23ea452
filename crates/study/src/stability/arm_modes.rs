//! Modes of the arm at a point of a path, in the feed frame, as modes of the cut.

use armill_core::stability::NamedMode;

use crate::analysis::path::PathAnalysis;
use crate::analysis::vibration::arm_modes::{has_modes, in_feed_frame, named_modes};
use crate::joint_order::joint_positions;
use crate::{Study, StudyError};

/// A posture at a point of a path.
#[derive(Clone, Debug)]
pub struct ArmPosture {
    /// Joint positions, deg (mm).
    pub joints_deg: Vec<f64>,
    /// Point of the path whose feed direction is used, from 1.
    pub point: usize,
}

/// The modes of the arm of `path` in this posture, in the feed frame at its point.
///
/// # Errors
/// An arm without compliances or masses; a wrong number of joints; no such point.
pub fn arm_modes(
    study: &Study,
    path: &PathAnalysis,
    posture: &ArmPosture,
) -> Result<Vec<NamedMode>, StudyError> {
    let robot = &study.robot.robot;
    let setting = &path.setting;
    if !has_modes(robot, setting) {
        let message = format!(
            "the modes of `{}` cannot be predicted: it has no masses",
            robot.name()
        );
        let hint = "add [[mass]] to the robot file, or [[tool.mass]] to the study";
        return Err(StudyError::value(message, hint));
    }
    let count = path.track.len();
    if posture.point == 0 || posture.point > count {
        let message = format!(
            "--point: {} is no point of the path, which has {count}",
            posture.point
        );
        return Err(StudyError::value(message, "from 1"));
    }
    let q = joint_positions(robot, &posture.joints_deg)?;
    let modes =
        named_modes(setting.arm(robot), &q).map_err(|error| StudyError::value(error.to_string(), ""))?;
    Ok(in_feed_frame(
        modes,
        &path.track.base_from_feed(posture.point - 1),
    ))
}
