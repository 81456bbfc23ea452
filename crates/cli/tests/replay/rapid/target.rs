//! Targets, tools and work objects of RAPID.
//!
//! Source: Technical reference manual, RAPID instructions, functions and data types (3HAC16581-1): `robtarget`,
//! `tooldata`, `wobjdata`, `extjoint`, `Offs`, `RelTool` [recalled].

use super::records::list;
use crate::event::Reference;
use crate::pose::Pose;
use crate::source::ReplayError;
use crate::value::Value;
use crate::words::Cursor;

/// From here a value of an external axis says that there is none.
const NO_AXIS: f64 = 9e8;

pub struct RobTarget {
    pub pose: Pose,
    /// cf1, cf4, cf6, cfx.
    pub quadrants: [f64; 4],
    pub external: Vec<Option<f64>>,
}

/// Lists of numbers of these lengths.
pub fn lists(value: &Value, lengths: &[usize]) -> Option<Vec<Vec<f64>>> {
    let Value::List(parts) = value else { return None };
    let numbers: Option<Vec<Vec<f64>>> = parts.iter().map(Value::numbers).collect();
    numbers.filter(|numbers| numbers.iter().map(Vec::len).eq(lengths.iter().copied()))
}

pub fn robtarget(cursor: &Cursor, value: &Value) -> Result<RobTarget, ReplayError> {
    let parts = lists(value, &[3, 4, 4, 6]).ok_or_else(|| cursor.error("not a robtarget"))?;
    Ok(RobTarget {
        pose: pose_of(cursor, &parts[0], &parts[1])?,
        quadrants: [parts[2][0], parts[2][1], parts[2][2], parts[2][3]],
        external: used(&parts[3]),
    })
}

fn pose_of(cursor: &Cursor, place: &[f64], turn: &[f64]) -> Result<Pose, ReplayError> {
    let (&[x, y, z], &[q1, q2, q3, q4]) = (place, turn) else {
        return Err(cursor.error("not a pose"));
    };
    Pose::abb([x, y, z], [q1, q2, q3, q4]).ok_or_else(|| {
        cursor.error(format!(
            "the quaternion [{q1},{q2},{q3},{q4}] does not have length 1"
        ))
    })
}

fn frame_of(cursor: &Cursor, value: &Value) -> Result<Pose, ReplayError> {
    let parts = lists(value, &[3, 4]).ok_or_else(|| cursor.error("not a pose"))?;
    pose_of(cursor, &parts[0], &parts[1])
}

/// The tool of this name: on the flange, or standing in the world frame.
pub fn tool(cursor: &Cursor, name: String, value: &Value) -> Result<Reference, ReplayError> {
    let Value::List(parts) = value else {
        return Err(cursor.error("not a tooldata"));
    };
    match &parts[..] {
        [Value::Truth(is_held), frame, _load] => Ok(Reference {
            is_swapped: !is_held,
            ..Reference::new(name, Some(frame_of(cursor, frame)?))
        }),
        _ => Err(cursor.error("not a tooldata")),
    }
}

/// The work object of this name: user frame, then object frame; of one that a mechanical unit moves the object frame, which is
/// relative to this unit; of one that the robot holds both are relative to the flange.
pub fn work_object(cursor: &Cursor, name: String, value: Option<&Value>) -> Result<Reference, ReplayError> {
    let Some(Value::List(parts)) = value else {
        return Err(cursor.error("not a wobjdata"));
    };
    match &parts[..] {
        [
            Value::Truth(is_held),
            Value::Truth(fixed),
            Value::Text(unit),
            user,
            object,
        ] => {
            let (user, object) = (frame_of(cursor, user)?, frame_of(cursor, object)?);
            let pose = if *fixed { user.then(&object) } else { object };
            if *is_held && !*fixed {
                return Err(cursor.error("a work object at the robot is not moved by a unit"));
            }
            Ok(Reference {
                unit: (!fixed).then(|| unit.clone()),
                is_swapped: *is_held,
                ..Reference::new(name, Some(pose))
            })
        }
        _ => Err(cursor.error("not a wobjdata")),
    }
}

/// External axes up to the last that is used.
pub fn used(axes: &[f64]) -> Vec<Option<f64>> {
    let count = axes
        .iter()
        .rposition(|axis| *axis < NO_AXIS)
        .map_or(0, |last| last + 1);
    axes[..count]
        .iter()
        .map(|axis| (*axis < NO_AXIS).then_some(*axis))
        .collect()
}

/// Offs: distances along the axes of the work object; RelTool: along those of the tool.
pub fn moved(cursor: &Cursor, name: &str, given: &[Value], turns: [f64; 3]) -> Result<Value, ReplayError> {
    let [target, x, y, z] = given else {
        return Err(cursor.error(format!("unknown function `{name}`")));
    };
    let by = [x.number(cursor)?, y.number(cursor)?, z.number(cursor)?];
    let pose = robtarget(cursor, target)?.pose;
    let new = match name.to_uppercase().as_str() {
        "OFFS" if turns == [0.0; 3] => std::array::from_fn(|axis| pose.position_mm[axis] + by[axis]),
        "RELTOOL" if turns == [0.0; 3] => pose.point(by),
        "RELTOOL" => return Err(cursor.error("RelTool with a rotation is not interpreted")),
        _ => return Err(cursor.error(format!("unknown function `{name}`"))),
    };
    let Value::List(mut parts) = target.clone() else {
        return Err(cursor.error("not a robtarget"));
    };
    parts[0] = list(&new);
    Ok(Value::List(parts))
}
