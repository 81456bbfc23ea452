//! What a format does not express of a robot.

use armill_core::robot::{Attachment, Structure};

use super::format::{ExportFormat, title};
use super::options::{ExportOptions, ExportedStiffness};
use crate::robot::RobotDescription;

/// What of this robot is not in a file of this format, one sentence each.
pub(super) fn left_out(
    found: &RobotDescription,
    format: ExportFormat,
    options: &ExportOptions,
) -> Vec<String> {
    let robot = &found.robot;
    let structure = robot.structure();
    let mut parts = Vec::new();
    if options.stiffness == ExportedStiffness::None {
        if robot.compliance().is_some() || has_curves(structure) {
            parts.push("joint compliances");
        }
        if !structure.springs.is_empty() {
            parts.push("springs of the structure");
        }
    } else if has_curves(structure) {
        parts.push("torque curves");
    }
    for (is_known, what) in [
        (structure.compensator.is_some(), "the gravity compensator"),
        (structure.joints_with_backlash().next().is_some(), "backlash"),
        (structure.learnt.is_some(), "the learnt residual"),
        (structure.geometry.is_some(), "the uncertainty of the geometry"),
        (
            !structure.motors.is_empty() && format != ExportFormat::Mjcf,
            "inertia of the rotors",
        ),
        (structure.damping.is_some(), "damping"),
        (found.motion.is_some(), "the motion of the controller"),
    ] {
        if is_known {
            parts.push(what);
        }
    }
    let geometry_only = matches!(format, ExportFormat::Ur | ExportFormat::Dh);
    if geometry_only
        && structure
            .masses
            .iter()
            .any(|mass| mass.attachment != Attachment::Tool)
    {
        parts.push("masses");
    }
    if geometry_only && !found.bodies.is_empty() {
        parts.push("shapes of the links");
    }
    if parts.is_empty() {
        return Vec::new();
    }
    vec![format!(
        "predictions of armill that depend on these are not in {}: {}",
        title(format),
        parts.join(", ")
    )]
}

fn has_curves(structure: &Structure) -> bool {
    structure.curves.iter().any(Option::is_some)
}
