//! The positions of a listing: `P[1:"name"]{ GP1: UF : 0, UT : 1, CONFIG : '...', X = 1.0 mm, ... };`.

use armill_core::units::{from_deg, from_mm};
use std::collections::BTreeMap;
use std::ops::Range;

use armill_formats::convention::Convention;

use crate::messages::ProgramMessages;
use crate::posture::Configuration;
use crate::program::{Spelled, Target};
use crate::spelling::{Line, Part, number};

/// Names of the numbers of a pose, in the order of its convention.
pub(super) const KEYS: [&str; 6] = ["X", "Y", "Z", "W", "P", "R"];

/// A position of the first group.
#[derive(Clone, Debug)]
pub(super) struct Position {
    /// Its user frame and tool, if it has its own.
    pub numbers: [Option<u32>; 2],
    /// Its value.
    pub taught: Taught,
    /// X, Y, Z, W, P, R of a pose, mm and deg.
    pub values: Option<[f64; 6]>,
}

/// Value of a position.
#[derive(Clone, Debug)]
pub(super) enum Taught {
    /// A target.
    There(Target),
    /// Not known, with the reason.
    Missing(String),
    /// Refused and reported.
    Refused,
}

/// The name and the number of a field, `X = 200.0 mm` or `UF : 1`; `None` without `=` or `:`.
pub(super) fn field(part: Part<'_>) -> Option<(&str, Part<'_>)> {
    let at = part.text.find(['=', ':'])?;
    let value = part.from(at + 1);
    let first = value.words().next().unwrap_or(value.trimmed());
    Some((part.text[..at].trim(), first))
}

/// A position while it is read.
struct Open {
    number: u32,
    span: Range<usize>,
    group: u32,
    numbers: [Option<u32>; 2],
    configuration: Configuration,
    turns: Vec<i32>,
    pose: [Option<f64>; 6],
    /// From the first of the six numbers to the last.
    spelled: Option<Range<usize>>,
    joints: BTreeMap<u32, f64>,
    untaught: Option<String>,
    /// Given as RX, RY, ..., relative to another group.
    relative: bool,
    broken: bool,
}

/// The positions of a listing by their numbers.
pub(super) fn positions(lines: &[Line], messages: &mut ProgramMessages) -> BTreeMap<u32, Position> {
    let mut done = BTreeMap::new();
    let mut open: Option<Open> = None;
    for line in lines {
        if messages.is_full() {
            break;
        }
        let said = line.trimmed();
        let mut rest = said;
        if said.text.starts_with("P[") || said.text.starts_with("p[") {
            if let Some(open) = open.take() {
                let message = format!("the position P[{}] has no end", open.number);
                messages.problem(open.span, message, "a position ends with `};`");
            }
            open = begin(line, messages);
            rest = said
                .text
                .find('{')
                .map_or(said.from(said.text.len()), |at| said.from(at + 1));
        }
        let Some(position) = &mut open else {
            continue;
        };
        let (inside, ends) = match rest.text.find('}') {
            Some(at) => (
                Part {
                    at: rest.at,
                    text: &rest.text[..at],
                },
                true,
            ),
            None => (rest, false),
        };
        fields(line, inside, position, messages);
        if ends && let Some(position) = open.take() {
            end(position, &mut done, messages);
        }
    }
    if let Some(open) = open {
        let message = format!("the position P[{}] has no end", open.number);
        messages.problem(open.span, message, "a position ends with `};`");
    }
    done
}

fn begin(line: &Line, messages: &mut ProgramMessages) -> Option<Open> {
    let said = line.trimmed();
    let inside = said.text[2..].split([']', ':']).next().unwrap_or_default().trim();
    let Ok(number) = inside.parse() else {
        let message = format!("`{inside}` is not a number of a position");
        messages.problem(line.span(), message, "positions are written `P[1]{`");
        return None;
    };
    Some(Open {
        number,
        span: line.span(),
        group: 1,
        numbers: [None; 2],
        configuration: Configuration::default(),
        turns: Vec::new(),
        pose: [None; 6],
        spelled: None,
        joints: BTreeMap::new(),
        untaught: None,
        relative: false,
        broken: false,
    })
}

/// Reads the fields of one line of a position.
fn fields(line: &Line, inside: Part, position: &mut Open, messages: &mut ProgramMessages) {
    // Commas of the configuration are between quotes.
    let mut quoted = false;
    let begin = inside.at;
    let mut start = inside;
    let mut parts = Vec::new();
    for (at, c) in inside.text.char_indices() {
        match c {
            '\'' => quoted = !quoted,
            ',' if !quoted => {
                let from = start.at - begin;
                parts.push(Part {
                    at: start.at,
                    text: &inside.text[from..at],
                });
                start = inside.from(at + 1);
            }
            _ => {}
        }
    }
    parts.push(start);
    for part in parts {
        let before = position.group;
        let part = group(part, position);
        if position.group > 1 && before <= 1 {
            let what = "further motion groups (GP2, ...) are ignored: they are assumed not to move";
            messages.note(line.number, what);
        }
        if position.group <= 1 {
            one_field(line, part, position, messages);
        }
    }
}

/// The part after `GP1:`, if there is one; the first group is not resumed after another one.
fn group<'a>(part: Part<'a>, position: &mut Open) -> Part<'a> {
    let said = part.trimmed();
    let given = said
        .text
        .get(..2)
        .filter(|begin| begin.eq_ignore_ascii_case("gp"));
    match (given, said.text.find(':')) {
        (Some(_), Some(colon)) => {
            let number = said.text[2..colon].trim().parse().unwrap_or(u32::MAX);
            position.group = position.group.max(number);
            said.from(colon + 1)
        }
        _ => part,
    }
}

fn one_field(line: &Line, part: Part, position: &mut Open, messages: &mut ProgramMessages) {
    let Some((key, value)) = field(part) else {
        return;
    };
    let key = key.to_ascii_uppercase();
    let axis = key.strip_prefix('J').and_then(|axis| axis.parse::<u32>().ok());
    match (key.as_str(), axis) {
        ("UF", _) => position.numbers[0] = value.text.parse().ok(),
        ("UT", _) => position.numbers[1] = value.text.parse().ok(),
        ("CONFIG", _) => configure(part, position),
        (_, Some(axis)) => {
            if let Some(value) = taught(line, &key, value, position, messages) {
                let turning = part.text.trim_end().to_ascii_lowercase().ends_with("deg");
                let value = if turning { from_deg(value) } else { from_mm(value) };
                position.joints.insert(axis, value);
            }
        }
        _ => {
            let known = KEYS.iter().position(|known| *known == key);
            if let Some(at) = known {
                if position.pose[at].is_some() {
                    position.broken = true;
                    let message = format!("{key} is given twice in P[{}]", position.number);
                    return messages.problem(line.span_of(&value), message, "give each number once");
                }
                let place = line.span_of(&value);
                position.pose[at] = taught(line, &key, value, position, messages);
                let spelled = position
                    .spelled
                    .get_or_insert_with(|| line.start + part.trimmed().at..place.end);
                spelled.end = spelled.end.max(place.end);
            } else if key.strip_prefix('R').is_some_and(|key| KEYS.contains(&key)) {
                position.relative = true;
            } else if key.starts_with('E') {
                let what = "extended axes (E1, ...) are ignored: they are assumed not to move";
                messages.note(line.number, what);
            }
        }
    }
}

/// The number of a field; `None` if it was never taught or is not a number.
fn taught(
    line: &Line,
    key: &str,
    value: Part,
    position: &mut Open,
    messages: &mut ProgramMessages,
) -> Option<f64> {
    let found = number(value.text);
    if found.is_some() {
        return found;
    }
    if value.text.starts_with('*') {
        position.untaught.get_or_insert_with(|| key.to_owned());
    } else {
        position.broken = true;
        let message = format!(
            "`{}` is not a number of {key} in P[{}]",
            value.text, position.number
        );
        let hint = "write it as `X = 200.000 mm`";
        messages.problem(line.span_of(&value), message, hint);
    }
    None
}

fn configure(part: Part, position: &mut Open) {
    let inside = part.text.split('\'').nth(1).unwrap_or_default();
    let mut parts = inside.split(',');
    for letter in parts.next().unwrap_or_default().split_whitespace() {
        let said = &mut position.configuration;
        match letter {
            "N" => said.flip = Some(false),
            "F" => said.flip = Some(true),
            "U" => said.lower = Some(false),
            "D" => said.lower = Some(true),
            "T" => said.rear = Some(false),
            "B" => said.rear = Some(true),
            _ => {}
        }
    }
    position.turns = parts.filter_map(|turn| turn.trim().parse().ok()).collect();
}

fn end(open: Open, done: &mut BTreeMap<u32, Position>, messages: &mut ProgramMessages) {
    let values = open.pose.iter().copied().collect::<Option<Vec<f64>>>();
    let values = values.and_then(|values| <[f64; 6]>::try_from(values).ok());
    let nothing = open.pose.iter().all(Option::is_none);
    let taught = match (&open.untaught, values, open.spelled) {
        _ if open.broken => Taught::Refused,
        _ if open.relative => {
            Taught::Missing("it is given relative to another group (RX, RY, ...)".to_owned())
        }
        (Some(key), ..) => Taught::Missing(format!("its {key} was never taught")),
        (None, Some(values), Some(bytes)) => match Convention::Fanuc.pose(&values) {
            Ok(pose) => Taught::There(Target::Pose {
                pose,
                branch: open.configuration.pattern(),
                turns: open.turns,
                spelled: Spelled {
                    text: messages.index(),
                    bytes,
                },
            }),
            Err(error) => {
                let message = format!("the position P[{}] is not a valid pose: {error}", open.number);
                messages.problem(open.span.clone(), message, "lengths are in mm, angles in deg");
                Taught::Refused
            }
        },
        _ if nothing && !open.joints.is_empty() => {
            let joints: Vec<f64> = open.joints.values().copied().collect();
            match open
                .joints
                .keys()
                .zip(1..)
                .all(|(axis, expected)| *axis == expected)
            {
                true => Taught::There(Target::Joints(joints)),
                false => Taught::Missing("some of its joints are not given".to_owned()),
            }
        }
        _ => Taught::Missing(missing(&open.pose)),
    };
    let position = Position {
        numbers: open.numbers,
        taught,
        values,
    };
    if done.insert(open.number, position).is_some() {
        let message = format!("the position P[{}] is given twice", open.number);
        messages.problem(open.span, message, "give each position its own number");
    }
}

fn missing(pose: &[Option<f64>; 6]) -> String {
    let keys: Vec<&str> = KEYS
        .iter()
        .zip(pose)
        .filter(|(_, value)| value.is_none())
        .map(|(key, _)| *key)
        .collect();
    format!("it has no {}", keys.join(", "))
}
