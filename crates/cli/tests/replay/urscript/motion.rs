//! Moves of URScript.
//!
//! Source: URScript manual, module motion: movej(q, a=1.4, v=1.05, t=0, r=0), movel(pose, a=1.2, v=0.25, t=0, r=0),
//! movec(pose_via, pose_to, a=1.2, v=0.25, r=0, mode=0); rad, m [recalled].

use super::Arguments;
use crate::event::{Action, Blend, JointMove, JointTarget, LinearMove, Posture, Reference, Speed};
use crate::pose::Pose;
use crate::source::ReplayError;
use crate::value::Value;
use crate::words::Cursor;

const MM_PER_M: f64 = 1000.0;
/// m/s, of movel and movec without v.
const LINE_SPEED: f64 = 0.25;
/// rad/s, of movej without v.
const JOINT_SPEED: f64 = 1.05;

/// The tool that is set.
#[derive(Default)]
pub struct Motion {
    tool: Reference,
}

/// `p[x, y, z, rx, ry, rz]`: m, rotation vector in rad.
pub fn pose_of(cursor: &Cursor, numbers: &Value) -> Result<Pose, ReplayError> {
    match numbers.numbers().as_deref() {
        Some(&[x, y, z, rx, ry, rz]) => Ok(Pose::rotation_vector(
            [x, y, z].map(|metre| metre * MM_PER_M),
            [rx, ry, rz],
        )),
        _ => Err(cursor.error("a pose has six numbers")),
    }
}

fn axes_deg(cursor: &Cursor, axes: &Value) -> Result<Vec<f64>, ReplayError> {
    match axes.numbers() {
        Some(axes) if axes.len() == 6 => Ok(axes.into_iter().map(f64::to_degrees).collect()),
        _ => Err(cursor.error("joint positions are six numbers")),
    }
}

impl Motion {
    pub fn set_tool(&mut self, tool: Pose) {
        self.tool = Reference::new("tcp", Some(tool));
    }

    /// Poses are relative to the base of the robot.
    fn base() -> Reference {
        Reference::new("base", Some(Pose::IDENTITY))
    }

    /// `movej` or `movel`.
    pub fn moved(&self, cursor: &Cursor, name: &str, given: &Arguments) -> Result<Action, ReplayError> {
        let target_name = if name == "movej" { "q" } else { "pose" };
        given.known(cursor, &[target_name, "a", "v", "t", "r"])?;
        let target = given.at(cursor, 0, target_name)?;
        let number = |position: usize, key: &str, default: f64| {
            given
                .maybe(position, key)
                .map_or(Ok(default), |value| value.number(cursor))
        };
        let blend = blend(number(4, "r", 0.0)?);
        let duration = number(3, "t", 0.0)?;
        if name == "movel" {
            let Value::Pose(to) = target else {
                return Err(cursor.error("movel to axes needs the model of the arm"));
            };
            let speed = number(2, "v", LINE_SPEED)?;
            return Ok(Action::Linear(LinearMove {
                to: *to,
                external: Vec::new(),
                base: Motion::base(),
                tool: self.tool.clone(),
                speed: timed(duration, Speed::MmPerS(speed * MM_PER_M)),
                blend,
            }));
        }
        let to = match target {
            Value::Pose(pose) => JointTarget::Pose {
                pose: *pose,
                posture: Posture::Unspecified,
            },
            Value::List(parts) => match &parts[..] {
                [Value::Pose(pose), near] => JointTarget::Pose {
                    pose: *pose,
                    posture: Posture::Near(axes_deg(cursor, near)?),
                },
                _ => JointTarget::Axes(axes_deg(cursor, target)?),
            },
            other => return Err(cursor.error(format!("movej needs axes or a pose, found {other:?}"))),
        };
        Ok(Action::Joint(JointMove {
            to,
            external: Vec::new(),
            base: Motion::base(),
            tool: self.tool.clone(),
            speed: timed(
                duration,
                Speed::DegPerS(number(2, "v", JOINT_SPEED)?.to_degrees()),
            ),
            blend,
        }))
    }

    /// `movec`.
    pub fn arc(&self, cursor: &Cursor, given: &Arguments) -> Result<Action, ReplayError> {
        given.known(cursor, &["pose_via", "pose_to", "a", "v", "r", "mode"])?;
        let pose = |position: usize, key: &str| match given.at(cursor, position, key)? {
            Value::Pose(pose) => Ok(*pose),
            other => Err(cursor.error(format!("movec needs poses, found {other:?}"))),
        };
        let number = |position: usize, key: &str, default: f64| {
            given
                .maybe(position, key)
                .map_or(Ok(default), |value| value.number(cursor))
        };
        Ok(Action::Circular {
            via: pose(0, "pose_via")?,
            end: LinearMove {
                to: pose(1, "pose_to")?,
                external: Vec::new(),
                base: Motion::base(),
                tool: self.tool.clone(),
                speed: Speed::MmPerS(number(3, "v", LINE_SPEED)? * MM_PER_M),
                blend: blend(number(4, "r", 0.0)?),
            },
        })
    }
}

/// A duration has priority over a speed.
fn timed(duration: f64, speed: Speed) -> Speed {
    if duration > 0.0 {
        Speed::Seconds(duration)
    } else {
        speed
    }
}

fn blend(radius_m: f64) -> Blend {
    if radius_m == 0.0 {
        Blend::Exact
    } else {
        Blend::DistanceMm(radius_m * MM_PER_M)
    }
}
