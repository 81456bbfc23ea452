//! Positions of a listing: `/POS`.
//!
//! Source: R-30iB HandlingTool operator's manual (B-83284EN), position data; listings that robots printed [recalled].

use std::collections::BTreeMap;

use crate::event::{JointTarget, Posture};
use crate::pose::Pose;
use crate::source::{Place, ReplayError};
use crate::words::Cursor;

#[derive(Clone, Debug)]
pub struct Target {
    pub to: JointTarget,
    pub external: Vec<Option<f64>>,
    /// UF; `None` for the active frame.
    pub frame: Option<u32>,
    /// UT; `None` for the active tool.
    pub tool: Option<u32>,
}

impl Target {
    /// A position register has neither frame nor tool of its own.
    pub fn of_register(pose: Pose) -> Target {
        Target {
            to: JointTarget::Pose {
                pose,
                posture: Posture::Unspecified,
            },
            external: Vec::new(),
            frame: None,
            tool: None,
        }
    }
}

/// Position by number.
pub fn positions(lines: &[(Place, &str)]) -> Result<BTreeMap<u32, Target>, ReplayError> {
    let mut all = BTreeMap::new();
    let mut open: Option<(Place, String)> = None;
    for (place, line) in lines {
        let (_, text) = open.get_or_insert_with(|| (place.clone(), String::new()));
        text.push_str(line);
        text.push(' ');
        if line.ends_with("};")
            && let Some((place, text)) = open.take()
        {
            let (number, target) = position(&text, &place)?;
            if all.insert(number, target).is_some() {
                return Err(place.error(format!("P[{number}] is given twice")));
            }
        }
    }
    match open {
        Some((place, text)) if !text.trim().is_empty() => {
            Err(place.error("the position does not end with `};`"))
        }
        _ => Ok(all),
    }
}

/// `P[1:"name"]{ GP1: UF : 1, UT : 1, CONFIG : '..', X = 1 mm, .. GP2: .. };`
fn position(text: &str, place: &Place) -> Result<(u32, Target), ReplayError> {
    let mut cursor = Cursor::new(text, place)?;
    if !cursor.eat_name("P") {
        return Err(cursor.unexpected("P[..]"));
    }
    cursor.expect("[")?;
    let number = cursor.count()?;
    if cursor.eat(":") {
        cursor.text()?;
    }
    cursor.expect("]{")?;
    let mut robot: Option<Target> = None;
    let mut external = Vec::new();
    let mut groups = 0;
    while !cursor.eat("};") {
        let group = cursor.name()?;
        groups += 1;
        if group != format!("GP{groups}") {
            return Err(cursor.error(format!("GP{groups} expected, found {group}")));
        }
        cursor.expect(":")?;
        let (target, numbers) = group_of(&mut cursor)?;
        if robot.is_none() {
            robot = Some(target);
            external.extend(external_axes(&mut cursor, &numbers, "E")?);
        } else {
            external.extend(external_axes(&mut cursor, &numbers, "J")?);
        }
    }
    cursor.end()?;
    let mut target = robot.ok_or_else(|| place.error(format!("P[{number}] has no group")))?;
    target.external = external;
    Ok((number, target))
}

type Numbers = BTreeMap<String, f64>;

/// The robot's part of a group, and all its numbers.
fn group_of(cursor: &mut Cursor) -> Result<(Target, Numbers), ReplayError> {
    let mut numbers = Numbers::new();
    let mut config = None;
    let mut active: BTreeMap<String, Option<u32>> = BTreeMap::new();
    loop {
        if cursor.sees("}") || cursor.sees_name("GP2") || cursor.sees_name("GP3") {
            break;
        }
        let key = cursor.name()?;
        if cursor.eat(":") {
            if key == "CONFIG" {
                config = Some(configuration(cursor)?);
            } else if key == "UF" || key == "UT" {
                // F: whatever is active.
                let number = if cursor.eat_name("F") {
                    None
                } else {
                    Some(cursor.count()?)
                };
                active.insert(key, number);
            } else {
                return Err(cursor.error(format!("unknown key `{key}`")));
            }
        } else {
            cursor.expect("=")?;
            let number = cursor.number()?;
            let unit = cursor.name()?;
            let expected = match key.as_str() {
                "X" | "Y" | "Z" => unit == "mm",
                "W" | "P" | "R" => unit == "deg",
                _ => unit == "mm" || unit == "deg",
            };
            if !expected {
                return Err(cursor.error(format!("`{unit}` is not the unit of {key}")));
            }
            numbers.insert(key, number);
        }
        // The last number of a line of a group has no comma.
        cursor.eat(",");
    }
    let all =
        |keys: [&str; 6]| -> Option<Vec<f64>> { keys.iter().map(|key| numbers.get(*key).copied()).collect() };
    let to = if let Some(place) = all(["X", "Y", "Z", "W", "P", "R"]) {
        let posture = config.ok_or_else(|| cursor.error("a Cartesian position needs CONFIG"))?;
        let pose = Pose::fixed_xyz(std::array::from_fn(|axis| place[axis]));
        JointTarget::Pose { pose, posture }
    } else if let Some(axes) = all(["J1", "J2", "J3", "J4", "J5", "J6"]) {
        JointTarget::Axes(axes)
    } else if numbers.keys().all(|key| key.starts_with('J')) {
        // A group of external axes has as many as it has.
        JointTarget::Axes(Vec::new())
    } else {
        return Err(cursor.error("a group has X, Y, Z, W, P, R or J1 to J6"));
    };
    let of = |key: &str| active.get(key).copied().flatten();
    let target = Target {
        to,
        external: Vec::new(),
        frame: of("UF"),
        tool: of("UT"),
    };
    Ok((target, numbers))
}

fn external_axes(
    cursor: &mut Cursor,
    numbers: &Numbers,
    letter: &str,
) -> Result<Vec<Option<f64>>, ReplayError> {
    let is_external = |key: &&String| {
        key.strip_prefix(letter)
            .is_some_and(|number| number.parse::<usize>().is_ok())
    };
    let count = numbers.keys().filter(is_external).count();
    (1..=count)
        .map(|axis| {
            let key = format!("{letter}{axis}");
            numbers
                .get(&key)
                .map(|number| Some(*number))
                .ok_or_else(|| cursor.error(format!("{key} is not given")))
        })
        .collect()
}

/// `'N U T, 0, 0, -1'`: wrist, elbow, shoulder, and the turns of three axes.
fn configuration(cursor: &mut Cursor) -> Result<Posture, ReplayError> {
    cursor.expect("'")?;
    let mut letters = String::new();
    while !cursor.sees(",") {
        letters.push_str(&cursor.name()?);
    }
    let known = letters.len() == 3
        && letters
            .chars()
            .zip(["NF", "UD", "TB"])
            .all(|(letter, allowed)| allowed.contains(letter));
    if !known {
        return Err(cursor.error(format!("`{letters}` is not N or F, U or D, T or B")));
    }
    let mut turns = [0; 3];
    for turn in &mut turns {
        cursor.expect(",")?;
        *turn = cursor.number()? as i32;
    }
    cursor.expect("'")?;
    Ok(Posture::Config { letters, turns })
}
