//! Springs of an arm as joints with a stiffness.
//!
//! A spring moves all behind it along its twist `u = (v, w)` per unit, with the compliance `c`:
//!
//! | twist | joint | stiffness |
//! |---|---|---|
//! | `w = 0` | prismatic along `v` | `1 / (c v^2)`, N/m |
//! | `v w = 0` | revolute about `w` through `w x v / w^2` | `1 / (c w^2)`, N m/rad |
//! | any other (a screw) | none: left out with a warning | - |
//!
//! A torque curve has no constant stiffness: the slope at zero torque is taken, with a warning.

use armill_core::nalgebra::Vector3;
use armill_core::robot::{Attachment, Robot, Spring};

use super::bodies::{BodyJoint, JointKind, body_of};
use super::error::ExportError;
use super::names::Names;

/// A twist with less pitch than this, m/rad, is a turn.
const PITCH: f64 = 1e-9;

/// Stiffness of the drive of joint `index`, N m/rad (N/m); `None` for one that is rigid.
///
/// # Errors
/// A compliance that is not known.
pub(super) fn drive_stiffness(
    robot: &Robot,
    index: usize,
    warnings: &mut Vec<String>,
) -> Result<Option<f64>, ExportError> {
    let compliance = match robot.structure().curve(index) {
        Some(curve) => {
            warnings.push(format!(
                "the stiffness of joint {} is that at zero torque: its torque curve is not expressed",
                robot.joints()[index].name
            ));
            curve.rising.slope(0.0)
        }
        None => {
            let all = robot.compliance().ok_or(ExportError::NoCompliance)?;
            all[index].value
        }
    };
    Ok((compliance > 0.0).then(|| compliance.recip()))
}

/// The joint of a spring and the index of the body that it moves; none for a rigid spring.
///
/// # Errors
/// A warning for a spring that no joint expresses.
pub(super) fn spring_joint(
    robot: &Robot,
    spring: &Spring,
    names: &mut Names,
) -> Result<Option<(usize, BodyJoint)>, String> {
    let (compliance, v, w) = (
        spring.compliance.value,
        spring.direction.linear,
        spring.direction.angular,
    );
    if compliance == 0.0 || (v == Vector3::zeros() && w == Vector3::zeros()) {
        return Ok(None);
    }
    let at = match spring.attachment {
        Attachment::Base => "base",
        Attachment::Joint(index) => &robot.joints()[index].name,
        Attachment::Flange => "flange",
        Attachment::Tool => "tool",
    };
    let Some(body) = body_of(spring.attachment, robot) else {
        return Err("springs of the tool are left out: an exported robot ends at its flange".to_owned());
    };
    let name = names.unique(&format!("{at}_structure_spring"));
    let turn = w.norm();
    let joint = |slides, axis, point, stiffness| BodyJoint {
        name,
        slides,
        axis,
        point,
        kind: JointKind::Spring { stiffness },
    };
    if turn == 0.0 {
        let length = v.norm();
        let stiffness = (compliance * length * length).recip();
        return Ok(Some((body, joint(true, v / length, Vector3::zeros(), stiffness))));
    }
    let pitch = v.dot(&w) / (turn * turn);
    if pitch.abs() > PITCH {
        return Err(format!(
            "the exported arm is stiffer: a spring at {at} is left out, because it moves along a screw (pitch {pitch:.3e} m/rad)"
        ));
    }
    let point = w.cross(&v) / (turn * turn);
    let stiffness = (compliance * turn * turn).recip();
    Ok(Some((body, joint(false, w / turn, point, stiffness))))
}
