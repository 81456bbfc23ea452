//! Moves of RAPID with their speed, zone, tool and work object.
//!
//! Source: Technical reference manual, RAPID instructions, functions and data types (3HAC16581-1): `MoveAbsJ`,
//! `MoveJ`, `MoveL`, `MoveC`, `speeddata`, `zonedata` [recalled].

use super::data::Data;
use super::records::predefined;
use super::target::{RobTarget, lists, robtarget, tool as tool_of, used, work_object};
use crate::event::{Action, Blend, JointMove, JointTarget, LinearMove, Posture, Reference, Speed};
use crate::source::ReplayError;
use crate::value::Value;
use crate::words::{Cursor, Word};

struct How {
    speed: Speed,
    blend: Blend,
    tool: Reference,
    base: Reference,
}

/// `MoveAbsJ`.
pub fn move_axes(data: &Data, cursor: &mut Cursor, module: &str) -> Result<Action, ReplayError> {
    let target = data.value(cursor, module)?;
    let parts = lists(&target, &[6, 6]).ok_or_else(|| cursor.error("not a jointtarget"))?;
    // Without it an offset of the controller would be added.
    if cursor.eat("\\") && !cursor.eat_name("NoEOffs") {
        return Err(cursor.unexpected("NoEOffs"));
    }
    let how = how(data, cursor, module)?;
    let [axes, external] = [&parts[0], &parts[1]];
    Ok(Action::Joint(JointMove {
        to: JointTarget::Axes(axes.clone()),
        external: used(external),
        base: how.base,
        tool: how.tool,
        speed: how.speed,
        blend: how.blend,
    }))
}

/// `MoveJ`, `MoveL`, `MoveC`; the word in capital letters.
pub fn move_pose(data: &Data, cursor: &mut Cursor, module: &str, word: &str) -> Result<Action, ReplayError> {
    let mut target = target_here(data, cursor, module)?;
    let mut via = None;
    if word == "MOVEC" {
        cursor.expect(",")?;
        via = Some(target.pose);
        target = target_here(data, cursor, module)?;
    }
    let how = how(data, cursor, module)?;
    let action = if word == "MOVEJ" {
        Action::Joint(JointMove {
            to: JointTarget::Pose {
                pose: target.pose,
                posture: Posture::Quadrants(target.quadrants),
            },
            external: target.external,
            base: how.base,
            tool: how.tool,
            speed: how.speed,
            blend: how.blend,
        })
    } else {
        let end = LinearMove {
            to: target.pose,
            external: target.external,
            base: how.base,
            tool: how.tool,
            speed: how.speed,
            blend: how.blend,
        };
        match via {
            Some(via) => Action::Circular { via, end },
            None => Action::Linear(end),
        }
    };
    Ok(action)
}

fn target_here(data: &Data, cursor: &mut Cursor, module: &str) -> Result<RobTarget, ReplayError> {
    let value = data.value(cursor, module)?;
    robtarget(cursor, &value)
}

/// `, speed [\V:=..|\T:=..], zone [\Z:=..] [\Inpos:=..], tool [\WObj:=..]`.
fn how(data: &Data, cursor: &mut Cursor, module: &str) -> Result<How, ReplayError> {
    cursor.expect(",")?;
    let speed = data
        .value(cursor, module)?
        .numbers()
        .filter(|parts| parts.len() == 4);
    let speed = speed.ok_or_else(|| cursor.error("not a speeddata"))?;
    let mut speed = Speed::MmPerS(speed[0]);
    if cursor.eat("\\") {
        let switch = cursor.name()?;
        cursor.expect(":=")?;
        let number = data.value(cursor, module)?.number(cursor)?;
        speed = match switch.to_uppercase().as_str() {
            "V" => Speed::MmPerS(number),
            "T" => Speed::Seconds(number),
            _ => return Err(cursor.error(format!("\\{switch} is not interpreted"))),
        };
    }
    cursor.expect(",")?;
    let zone = data.value(cursor, module)?;
    let (fine, mut distance) = match &zone {
        Value::List(parts) => match parts[..] {
            [Value::Truth(fine), Value::Number(distance), ..] if parts.len() == 7 => (fine, distance),
            _ => return Err(cursor.error("not a zonedata")),
        },
        _ => return Err(cursor.error("not a zonedata")),
    };
    if cursor.eat("\\") {
        if !cursor.eat_name("Z") {
            return Err(cursor.unexpected("Z"));
        }
        cursor.expect(":=")?;
        distance = data.value(cursor, module)?.number(cursor)?;
    }
    cursor.expect(",")?;
    let (tool_name, tool) = named(data, cursor, module)?;
    let mut base = ("wobj0".to_owned(), predefined("WOBJ0").map(|(_, value)| value));
    // An optional argument may have a comma before it.
    if cursor.sees(",\\") {
        cursor.expect(",")?;
    }
    if cursor.eat("\\") {
        if !cursor.eat_name("WObj") {
            return Err(cursor.unexpected("WObj"));
        }
        cursor.expect(":=")?;
        let (name, value) = named(data, cursor, module)?;
        base = (name, Some(value));
    }
    let tool = tool_of(cursor, tool_name, &tool)?;
    let base = work_object(cursor, base.0, base.1.as_ref())?;
    if tool.is_swapped != base.is_swapped {
        return Err(cursor.error("the robot holds either the tool or the work object"));
    }
    Ok(How {
        speed,
        blend: if fine || distance == 0.0 {
            Blend::Exact
        } else {
            Blend::DistanceMm(distance)
        },
        tool,
        base,
    })
}

fn named(data: &Data, cursor: &mut Cursor, module: &str) -> Result<(String, Value), ReplayError> {
    let Some(Word::Name(name)) = cursor.peek().cloned() else {
        return Err(cursor.unexpected("a name of a tool or work object"));
    };
    Ok((name, data.value(cursor, module)?))
}
