//! Modes of the arm at a point of a path, in the feed frame, as modes of the cut.

use armill_core::nalgebra::Rotation3;
use armill_core::robot::Robot;
use armill_core::source::ArmState;
use armill_core::stability::{ModeUncertainty, NamedMode};

use crate::analysis::path::PathAnalysis;
use crate::analysis::vibration::has_modes;
use crate::joint_order::joint_positions;
use crate::modes::compliance_covariance;
use crate::{Study, StudyError};

/// Relative standard uncertainty of a damping ratio that is assumed.
const ASSUMED_U: f64 = 0.5;

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
    let arm = setting.arm(robot);
    let mut state = ArmState::new(arm);
    state.set_joints(&q);
    let unstable = |error: armill_core::source::Unstable| StudyError::value(error.to_string(), "");
    let found = state.modes().map_err(unstable)?;
    let compliances = state.tangent_compliances().map_err(unstable)?;
    let covariance = compliance_covariance(&arm);
    let known = arm.has_known_uncertainty();
    let damping_u = match setting.model.structure.damping {
        Some(_) => 0.0,
        None => ASSUMED_U,
    };
    let base_from_feed: Rotation3<f64> = path.track.base_from_feed(posture.point - 1);
    let by_masses = state.frequency_uncertainties_by_masses(&found.modes);
    let modes = found.modes.iter().enumerate().map(|(index, mode)| {
        let by_compliances = match known {
            true => mode.relative_uncertainty(&compliances, &covariance),
            false => 0.0,
        };
        NamedMode {
            name: format!("arm mode {}{}", index + 1, most_of(robot, &mode.shares)),
            mode: mode.at_tool.in_axes(&base_from_feed),
            // The frequency follows the root of the stiffness.
            uncertainty: ModeUncertainty {
                frequency: by_compliances.hypot(by_masses[index]),
                damping: damping_u,
                stiffness: 2.0 * by_compliances,
            },
        }
    });
    Ok(modes.collect())
}

/// The joint with the largest share, in words; empty if a spring has it.
fn most_of(robot: &Robot, shares: &[f64]) -> String {
    let largest = shares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let of_joint = largest.and_then(|(k, share)| Some((robot.joints().get(k)?, share)));
    of_joint.map_or_else(String::new, |(joint, share)| {
        format!(" ({:.0} % {})", 100.0 * share, joint.name)
    })
}
