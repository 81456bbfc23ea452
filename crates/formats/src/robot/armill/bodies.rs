//! Bodies of the links, and pairs of them that are apart in every posture.
//!
//! ```text
//! [[body]]      at, name, exactly one of capsule_mm, cylinder_mm, box_mm, accuracy_mm, source
//! [clearance]   apart = [["base", "link L"], ...], source
//! ```
//!
//! A body without a name is called `base`, `flange` or `link L` after its attachment; where several bodies of an attachment
//! have none, the second is `link L 2`. `apart` names bodies.

use armill_core::clearance::{ArmBody, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::robot::Attachment;

use super::super::description::BodyNote;
use super::checks::Checks;
use super::file::{BodyEntry, RobotFile};
use crate::robot::spring_tables::attachment;

/// Bodies, what else is known of each, and pairs of them that are apart.
pub(super) struct Bodies {
    pub bodies: Vec<ArmBody>,
    pub notes: Vec<BodyNote>,
    pub apart: Vec<[usize; 2]>,
}

impl Checks<'_> {
    /// The bodies of the file, m; what is wrong goes into the problems.
    pub(super) fn bodies(&mut self, file: &RobotFile) -> Bodies {
        let joints: Vec<&str> = file.joint.iter().map(|joint| joint.name.as_str()).collect();
        let (mut bodies, mut notes, mut names) = (Vec::new(), Vec::new(), Vec::new());
        for (index, entry) in file.body.iter().enumerate() {
            let path = format!("body[{index}]");
            let name = body_name(&file.body[..=index]);
            if names.contains(&name) {
                let hint = "each body needs a name of its own";
                let at = if entry.name.is_some() {
                    format!("{path}.name")
                } else {
                    path.clone()
                };
                self.problem(&at, format!("another body is called `{name}`"), hint);
            }
            names.push(name.clone());
            let attached = self.attached(&path, entry, &joints);
            let shape = self.shape(&path, entry);
            if let (Some(attachment), Some(shape)) = (attached, shape) {
                bodies.push(ArmBody {
                    name,
                    attachment,
                    attachment_from_body: Isometry::identity(),
                    shape,
                    role: Role::Link,
                });
                notes.push(BodyNote {
                    accuracy_mm: entry.accuracy_mm,
                    source: entry.source.clone(),
                });
            }
        }
        let apart = self.apart(file, &names);
        Bodies { bodies, notes, apart }
    }

    /// What a body is attached to; a robot file has no tool.
    fn attached(&mut self, path: &str, entry: &BodyEntry, joints: &[&str]) -> Option<Attachment> {
        let known = attachment(&entry.at, joints);
        match known {
            Ok(Attachment::Tool) | Err(_) => {
                let message = format!("`{}` is not a part of the robot", entry.at);
                let hint = format!("`base`, `flange`, or a joint: {}", joints.join(", "));
                self.problem(&format!("{path}.at"), message, &hint);
                None
            }
            Ok(attachment) => Some(attachment),
        }
    }

    /// The shape of a body, in the frame of its attachment.
    fn shape(&mut self, path: &str, entry: &BodyEntry) -> Option<Shape> {
        let (key, shape) = match (&entry.capsule_mm, &entry.cylinder_mm, &entry.box_mm) {
            (Some(capsule), None, None) => return Some(capsule.capsule()),
            (None, Some(cylinder), None) => ("cylinder_mm", cylinder.cylinder()),
            (None, None, Some(cuboid)) => ("box_mm", cuboid.shape()),
            _ => {
                let hint =
                    "write one of capsule_mm, cylinder_mm, box_mm; further shapes are bodies of their own";
                self.problem(path, "a body has exactly one shape", hint);
                return None;
            }
        };
        match shape {
            Ok(shape) => Some(shape),
            Err((message, hint)) => {
                self.problem(&format!("{path}.{key}"), message, hint);
                None
            }
        }
    }

    /// Pairs of bodies that are apart in every posture, by index.
    fn apart(&mut self, file: &RobotFile, names: &[String]) -> Vec<[usize; 2]> {
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        let Some(table) = &file.clearance else {
            return pairs;
        };
        for (index, pair) in table.apart.iter().enumerate() {
            let mut found = Vec::new();
            for (place, name) in pair.iter().enumerate() {
                match names.iter().position(|known| known == name) {
                    Some(body) => found.push(body),
                    None => {
                        let path = format!("clearance.apart[{index}][{place}]");
                        let hint = match names.is_empty() {
                            true => "the file has no [[body]]".to_owned(),
                            false => format!("one of: {}", names.join(", ")),
                        };
                        self.problem(&path, format!("`{name}` is not a body"), &hint);
                    }
                }
            }
            let [first, second] = found[..] else { continue };
            let pair = [first.min(second), first.max(second)];
            let wrong = if first == second {
                Some("a body is not apart from itself")
            } else if pairs.contains(&pair) {
                Some("the pair is given twice")
            } else {
                None
            };
            match wrong {
                Some(message) => {
                    self.problem(
                        &format!("clearance.apart[{index}]"),
                        message,
                        "two bodies, each pair once",
                    );
                }
                None => pairs.push(pair),
            }
        }
        pairs
    }
}

/// The name of the last of these bodies.
fn body_name(entries: &[BodyEntry]) -> String {
    let Some(own) = entries.last() else {
        return String::new();
    };
    if let Some(name) = &own.name {
        return name.clone();
    }
    let stem = match own.at.as_str() {
        "base" | "flange" => own.at.clone(),
        joint => format!("link {joint}"),
    };
    let alike = |entry: &&BodyEntry| entry.name.is_none() && entry.at == own.at;
    match entries.iter().filter(alike).count() {
        1 => stem,
        count => format!("{stem} {count}"),
    }
}

#[cfg(test)]
mod tests;
