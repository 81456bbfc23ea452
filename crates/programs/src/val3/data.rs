//! The data of a project: points, joints, frames, tools and descriptions of moves, by name and key.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use armill_core::frame::Isometry;
use armill_core::robot::BranchPattern;
use armill_core::units::{from_deg, from_mm};
use armill_formats::convention::Convention;

use super::tags::{Attribute, Piece, attributes, pieces, value};
use crate::messages::ProgramMessages;
use crate::posture::Configuration;
use crate::program::{Spelled, Target};
use crate::spelling::number;

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

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}]", self.name, self.key)
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
    pub fn take(&mut self, messages: &mut ProgramMessages) {
        let mut of: Option<(String, String)> = None;
        for piece in pieces(messages.text().text()) {
            if messages.is_full() {
                return;
            }
            match piece {
                Piece::Broken(part) => {
                    let hint = "check whether the file is cut off or a quote is missing";
                    messages.problem(part.range(), "this tag does not end", hint);
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
                    let given = GivenValue {
                        reference: &reference,
                        attributes: &said,
                        bytes: tag.inside.range(),
                    };
                    let Some(datum) = given.datum(kind, messages) else {
                        continue;
                    };
                    let message = format!("{reference} is given twice");
                    if self.list.insert(reference, datum).is_some() {
                        messages.problem(tag.inside.range(), message, "give each value its own key");
                    }
                }
                Piece::Tag(tag) if matches!(tag.name, "valuePoint" | "valueJoint") => {
                    let message = "the data of an older project (s6) cannot be read";
                    let hint = "convert the project to s7 or later with the manufacturer's suite";
                    messages.problem(tag.inside.range(), message, hint);
                    return;
                }
                _ => {}
            }
        }
    }
}

/// A value of the data as given: its name and key, its attributes, and the bytes of these.
struct GivenValue<'a> {
    reference: &'a Reference,
    attributes: &'a [Attribute<'a>],
    bytes: Range<usize>,
}

impl GivenValue<'_> {
    /// The datum of this type; `None` for a type that moves do not need.
    fn datum(&self, kind: &str, messages: &mut ProgramMessages) -> Option<Datum> {
        let root = if kind == "tool" { "flange" } else { "world" };
        let father = value(self.attributes, "fatherId").unwrap_or(root).to_owned();
        match kind {
            "pointRx" | "frame" | "tool" => {
                let Some(pose) = self.pose(messages) else {
                    return Some(Datum::Refused);
                };
                Some(match kind {
                    "frame" => Datum::Frame { pose, father },
                    "tool" => Datum::Tool { pose, father },
                    _ => Datum::Point {
                        target: Target::Pose {
                            pose,
                            branch: self.branch(),
                            turns: Vec::new(),
                            spelled: Spelled {
                                text: messages.index(),
                                bytes: self.bytes.clone(),
                            },
                        },
                        father,
                    },
                })
            }
            "jointRx" => {
                let joints = self.numbers(&["j1", "j2", "j3", "j4", "j5", "j6"], messages);
                Some(joints.map_or(Datum::Refused, |joints| {
                    Datum::Joints(Target::Joints(joints.into_iter().map(from_deg).collect()))
                }))
            }
            "mdesc" => {
                if value(self.attributes, "tmax").is_none() {
                    return Some(Datum::Speed(None));
                }
                let tip = self.numbers(&["tmax"], messages);
                Some(tip.map_or(Datum::Refused, |tip| {
                    let limit = tip.first().copied().filter(|tip| *tip < NO_LIMIT && *tip >= 0.0);
                    Datum::Speed(limit.map(from_mm))
                }))
            }
            _ => None,
        }
    }

    /// The numbers of these attributes; missing ones are zero.
    fn numbers(&self, keys: &[&str], messages: &mut ProgramMessages) -> Option<Vec<f64>> {
        let mut found = Vec::with_capacity(keys.len());
        for key in keys {
            let Some(attribute) = self.attributes.iter().find(|attribute| attribute.name == *key) else {
                found.push(0.0);
                continue;
            };
            let text = attribute.value.text;
            let Some(value) = number(text) else {
                let message = format!("`{text}` is not a number: {key} of {}", self.reference);
                let hint = "write numbers with a decimal point: `x=\"100.5\"`";
                messages.problem(attribute.value.range(), message, hint);
                return None;
            };
            found.push(value);
        }
        Some(found)
    }

    fn pose(&self, messages: &mut ProgramMessages) -> Option<Isometry> {
        let numbers = self.numbers(&super::KEYS, messages)?;
        match Convention::Staubli.pose(&numbers) {
            Ok(pose) => Some(pose),
            Err(error) => {
                let message = format!("{} is not a valid pose: {error}", self.reference);
                messages.problem(self.bytes.clone(), message, "lengths are in mm, angles in deg");
                None
            }
        }
    }

    fn branch(&self) -> BranchPattern {
        let of = |key: &str, [not, yes]: [&str; 2]| match value(self.attributes, key) {
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
}
