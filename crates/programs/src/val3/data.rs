//! The data of a project: points, joints, frames, tools and descriptions of moves, by name and key.

use std::collections::BTreeMap;
use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;
use armill_formats::convention::Convention;

use super::tags::{Attribute, Piece, attributes, pieces, value};
use crate::messages::ProgramMessages;
use crate::posture::Configuration;
use crate::program::{Spelled, Target};
use crate::spelling::number;
use crate::text::ProgramText;

/// Maximum nesting of frames.
const DEEPEST: usize = 30;

/// A `tmax` above this value is not a limit, mm/s.
const NO_LIMIT: f64 = 99_999.0;

/// A name with its key, `pPoint[0]`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Reference {
    pub name: String,
    pub key: String,
}

impl Reference {
    /// The reference in an expression that contains nothing else; without a key the first one.
    pub fn of(text: &str) -> Option<Reference> {
        let text = text.trim();
        let end = text
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == ':'))
            .unwrap_or(text.len());
        let (name, behind) = text.split_at(end);
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return None;
        }
        let key = match behind.trim() {
            "" => "0",
            keyed => {
                let inside = keyed.strip_prefix('[')?.strip_suffix(']')?.trim();
                let quoted = inside.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
                let counted = !inside.is_empty() && inside.bytes().all(|byte| byte.is_ascii_digit());
                match (quoted, counted) {
                    (Some(key), _) if !key.contains('"') => key,
                    (_, true) => inside,
                    _ => return None,
                }
            }
        };
        Some(Reference {
            name: name.to_owned(),
            key: key.to_owned(),
        })
    }
}

/// A datum.
#[derive(Clone, Debug)]
pub(super) enum Datum {
    Point {
        target: Target,
        father: String,
    },
    Joints(Target),
    Frame {
        pose: Isometry,
        father: String,
    },
    Tool {
        pose: Isometry,
        father: String,
    },
    /// Tip speed, m/s, if it is given.
    Speed(Option<f64>),
    /// Invalid, and reported as a problem.
    Refused,
}

/// All data.
#[derive(Debug, Default)]
pub(super) struct Data {
    list: BTreeMap<Reference, Datum>,
}

impl Data {
    /// The datum with this name.
    pub fn get(&self, reference: &Reference) -> Option<&Datum> {
        self.list.get(reference)
    }

    /// Whether any datum has this name, with any key.
    pub fn knows(&self, name: &str) -> bool {
        let first = Reference {
            name: name.to_owned(),
            key: String::new(),
        };
        self.list
            .range(first..)
            .next()
            .is_some_and(|(found, _)| found.name == name)
    }

    /// Robot base to this frame, or flange to this tool; `None` if a part of the chain is not known.
    pub fn pose_of(&self, father: &str) -> Option<Isometry> {
        let mut pose = Isometry::identity();
        let mut at = Reference::of(father)?;
        for _ in 0..DEEPEST {
            if matches!(at.name.as_str(), "world" | "flange") {
                return Some(pose);
            }
            match self.list.get(&at)? {
                Datum::Frame { pose: own, father } | Datum::Tool { pose: own, father } => {
                    pose = own * pose;
                    at = Reference::of(father)?;
                }
                _ => return None,
            }
        }
        None
    }

    /// Reads the data of one file.
    pub fn take(&mut self, (text, index): (&ProgramText, usize), messages: &mut ProgramMessages) {
        let mut of: Option<(String, String)> = None;
        for piece in pieces(text.text()) {
            if messages.is_full() {
                return;
            }
            match piece {
                Piece::Broken(part) => {
                    let message = "this tag does not end".to_owned();
                    messages.problem(
                        text,
                        part.range(),
                        message,
                        "check whether the file is cut off or a quote is missing",
                    );
                }
                Piece::Tag(tag) if tag.name == "Data" => {
                    let said = attributes(tag.inside);
                    let name = value(&said, "name").unwrap_or_default();
                    let kind = value(&said, "type").unwrap_or_default();
                    of = Some((name.to_owned(), kind.to_owned()));
                }
                Piece::Tag(tag) if tag.name == "/Data" => of = None,
                Piece::Tag(tag) if tag.name == "Value" => {
                    let Some((name, kind)) = &of else {
                        continue;
                    };
                    let said = attributes(tag.inside);
                    let reference = Reference {
                        name: name.clone(),
                        key: value(&said, "key").unwrap_or("0").to_owned(),
                    };
                    let file = File {
                        text,
                        index,
                        tag: tag.inside.range(),
                    };
                    let Some(datum) = datum(&file, (kind, &reference, &said), messages) else {
                        continue;
                    };
                    let shown = format!("{}[{}]", reference.name, reference.key);
                    if self.list.insert(reference, datum).is_some() {
                        let message = format!("{shown} is given twice");
                        messages.problem(text, tag.inside.range(), message, "give each value its own key");
                    }
                }
                Piece::Tag(tag) if matches!(tag.name, "valuePoint" | "valueJoint") => {
                    let message = "the data of an older project (s6) cannot be read".to_owned();
                    let hint = "convert the project to s7 or later with the manufacturer's suite";
                    messages.problem(text, tag.inside.range(), message, hint);
                    return;
                }
                _ => {}
            }
        }
    }
}

/// A tag of a file.
struct File<'a> {
    text: &'a ProgramText,
    index: usize,
    tag: Range<usize>,
}

fn datum(
    file: &File,
    (kind, reference, said): (&str, &Reference, &[Attribute]),
    messages: &mut ProgramMessages,
) -> Option<Datum> {
    let root = if kind == "tool" { "flange" } else { "world" };
    let father = value(said, "fatherId").unwrap_or(root).to_owned();
    match kind {
        "pointRx" | "frame" | "tool" => {
            let Some(pose) = pose(file, (reference, said), messages) else {
                return Some(Datum::Refused);
            };
            Some(match kind {
                "frame" => Datum::Frame { pose, father },
                "tool" => Datum::Tool { pose, father },
                _ => Datum::Point {
                    target: Target::Pose {
                        pose,
                        branch: branch(said),
                        turns: Vec::new(),
                        spelled: Spelled {
                            text: file.index,
                            bytes: file.tag.clone(),
                        },
                    },
                    father,
                },
            })
        }
        "jointRx" => {
            let joints = numbers(
                file,
                (reference, said),
                (&["j1", "j2", "j3", "j4", "j5", "j6"], messages),
            );
            Some(joints.map_or(Datum::Refused, |joints| {
                Datum::Joints(Target::Joints(joints.into_iter().map(f64::to_radians).collect()))
            }))
        }
        "mdesc" => {
            if value(said, "tmax").is_none() {
                return Some(Datum::Speed(None));
            }
            let tip = numbers(file, (reference, said), (&["tmax"], messages));
            Some(tip.map_or(Datum::Refused, |tip| {
                let limit = tip.first().copied().filter(|tip| *tip < NO_LIMIT && *tip >= 0.0);
                Datum::Speed(limit.map(|tip| tip * 1e-3))
            }))
        }
        _ => None,
    }
}

/// The numbers of these attributes; missing ones are zero.
fn numbers(
    file: &File,
    (reference, said): (&Reference, &[Attribute]),
    (keys, messages): (&[&str], &mut ProgramMessages),
) -> Option<Vec<f64>> {
    let mut found = Vec::with_capacity(keys.len());
    for key in keys {
        let Some(attribute) = said.iter().find(|attribute| attribute.name == *key) else {
            found.push(0.0);
            continue;
        };
        let Some(value) = number(attribute.value.text) else {
            let Reference { name, key: at } = reference;
            let message = format!(
                "`{}` is not a number: {key} of {name}[{at}]",
                attribute.value.text
            );
            let hint = "write numbers with a decimal point: `x=\"100.5\"`";
            messages.problem(file.text, attribute.value.range(), message, hint);
            return None;
        };
        found.push(value);
    }
    Some(found)
}

fn pose(
    file: &File,
    (reference, said): (&Reference, &[Attribute]),
    messages: &mut ProgramMessages,
) -> Option<Isometry> {
    let numbers = numbers(file, (reference, said), (&super::KEYS, messages))?;
    match Convention::Staubli.pose(&numbers) {
        Ok(pose) => Some(pose),
        Err(error) => {
            let message = format!(
                "{}[{}] is not a valid pose: {error}",
                reference.name, reference.key
            );
            messages.problem(
                file.text,
                file.tag.clone(),
                message,
                "lengths are in mm, angles in deg",
            );
            None
        }
    }
}

fn branch(said: &[Attribute]) -> BranchPattern {
    let of = |key: &str, [not, yes]: [&str; 2]| match value(said, key) {
        Some(word) if word == not => Some(false),
        Some(word) if word == yes => Some(true),
        _ => None,
    };
    Configuration {
        rear: of("shoulder", ["lefty", "righty"]),
        lower: of("elbow", ["epositive", "enegative"]),
        flip: of("wrist", ["wpositive", "wnegative"]),
    }
    .pattern()
}
