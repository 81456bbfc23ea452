//! Data of a VAL3 project: arrays of typed values.
//!
//! Source: VAL3 XML format (versions s6, s7), data file; VAL3 reference manual 5.3, types `frame`, `tool`, `pointRx`,
//! `jointRx`, `mdesc` [recalled].

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use crate::event::{Blend, Reference};
use crate::pose::Pose;
use crate::source::{Place, ReplayError, SourceFile};

type Attributes = BTreeMap<String, String>;

struct Array {
    kind: String,
    size: u32,
    values: BTreeMap<u32, (Place, Attributes)>,
}

/// Arrays by name.
#[derive(Default)]
pub struct Data(BTreeMap<String, Array>);

/// A value that a move needs.
pub enum Item {
    Joint(Vec<f64>),
    Point {
        /// Relative to its frame.
        pose: Pose,
        frame: Box<Reference>,
        /// Shoulder, elbow, wrist.
        posture: [String; 3],
    },
    Tool {
        name: String,
        pose: Pose,
    },
    Motion {
        /// Of the largest speed of the axes.
        percent: f64,
        /// Limit of the tool centre point, mm/s.
        speed: f64,
        blend: Blend,
    },
}

impl Data {
    pub fn load(&mut self, file: &SourceFile, document: &Document<'_>) -> Result<(), ReplayError> {
        let element = |node: &Node<'_, '_>, tag: &str| node.is_element() && node.tag_name().name() == tag;
        for node in document.descendants().filter(|node| element(node, "Data")) {
            let place =
                |node: &Node<'_, '_>| file.place(document.text_pos_at(node.range().start).row as usize);
            // `type`, not `xsi:type`.
            let text = |key: &str| {
                node.attributes()
                    .find(|attribute| attribute.name() == key && attribute.namespace().is_none())
                    .map(|attribute| attribute.value().to_owned())
                    .ok_or_else(|| place(&node).error(format!("data without {key}")))
            };
            let size = text("size")?;
            let size: u32 = size
                .parse()
                .map_err(|_| place(&node).error(format!("size {size} is not a number")))?;
            let mut values = BTreeMap::new();
            for value in node.children().filter(|node| element(node, "Value")) {
                let attributes: Attributes = value
                    .attributes()
                    .map(|a| (a.name().to_owned(), a.value().to_owned()))
                    .collect();
                let key = attributes.get("key").and_then(|key| key.parse().ok());
                let key = key.ok_or_else(|| place(&value).error("a value without key"))?;
                if key >= size {
                    return Err(place(&value).error(format!("key {key}, but the size is {size}")));
                }
                if values.insert(key, (place(&value), attributes)).is_some() {
                    return Err(place(&value).error(format!("key {key} is given twice")));
                }
            }
            let (name, kind) = (text("name")?, text("type")?);
            if self
                .0
                .insert(name.clone(), Array { kind, size, values })
                .is_some()
            {
                return Err(place(&node).error(format!("{name} is declared twice")));
            }
        }
        Ok(())
    }

    /// The type of a variable.
    pub fn kind(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(|array| array.kind.as_str())
    }

    pub fn item(&self, name: &str, index: u32) -> Result<Item, String> {
        let array = self
            .0
            .get(name)
            .ok_or_else(|| format!("`{name}` is not in the data"))?;
        if index >= array.size {
            return Err(format!("{name}[{index}], but the size is {}", array.size));
        }
        // Elements without a value have the default of their type.
        let (place, values) = array
            .values
            .get(&index)
            .ok_or_else(|| format!("{name}[{index}] has no value in the data"))?;
        let number = |key: &str| -> Result<f64, String> {
            let text = values
                .get(key)
                .ok_or_else(|| format!("{name}[{index}] has no {key} ({place})"))?;
            text.parse()
                .map_err(|_| format!("`{text}` is not a number ({place})"))
        };
        let pose = || -> Result<Pose, String> {
            let mut numbers = [0.0; 6];
            for (value, key) in numbers.iter_mut().zip(["x", "y", "z", "rx", "ry", "rz"]) {
                *value = number(key)?;
            }
            Ok(Pose::staubli(numbers))
        };
        let father = || values.get("fatherId").map_or("", String::as_str);
        match array.kind.as_str() {
            "jointRx" => {
                let axes: Result<Vec<f64>, String> =
                    (1..=6).map(|axis| number(&format!("j{axis}"))).collect();
                Ok(Item::Joint(axes?))
            }
            "pointRx" => {
                let word = |key: &str| values.get(key).cloned().unwrap_or_else(|| "ssame".to_owned());
                Ok(Item::Point {
                    pose: pose()?,
                    frame: Box::new(Reference::new(
                        father(),
                        Some(self.ancestor(father(), "world", 0)?),
                    )),
                    posture: [word("shoulder"), word("elbow"), word("wrist")],
                })
            }
            "tool" => {
                let parent = self.ancestor(father(), "flange", 0)?;
                Ok(Item::Tool {
                    name: format!("{name}[{index}]"),
                    pose: parent.then(&pose()?),
                })
            }
            "mdesc" => {
                let leave = number("leave")?;
                let blend = match values.get("blend").map(String::as_str) {
                    Some("off") => Blend::Exact,
                    // The move leaves its path at this distance, and the next one is reached at `reach`.
                    Some("joint" | "cartesian") if leave > 0.0 => Blend::DistanceMm(leave),
                    Some("joint" | "cartesian") => Blend::Exact,
                    other => {
                        return Err(format!(
                            "blend {other:?} is not off, joint or cartesian ({place})"
                        ));
                    }
                };
                Ok(Item::Motion {
                    percent: number("vel")?,
                    speed: number("tmax")?,
                    blend,
                })
            }
            other => Err(format!("{name} has the type {other}")),
        }
    }

    /// Frames and tools are relative to their father, down to `world[0]` or `flange[0]`.
    fn ancestor(&self, father: &str, root: &str, depth: u32) -> Result<Pose, String> {
        if father == root || father == format!("{root}[0]") {
            return Ok(Pose::IDENTITY);
        }
        if depth > 8 {
            return Err(format!("more than 8 frames inside each other at {father}"));
        }
        let (name, index) = father
            .strip_suffix(']')
            .and_then(|father| father.split_once('['))
            .ok_or_else(|| format!("`{father}` is not the name of a frame"))?;
        let array = self
            .0
            .get(name)
            .ok_or_else(|| format!("`{name}` is not in the data"))?;
        let values = index.parse().ok().and_then(|index: u32| array.values.get(&index));
        let (place, values) = values.ok_or_else(|| format!("{father} has no value in the data"))?;
        let mut numbers = [0.0; 6];
        for (number, key) in numbers.iter_mut().zip(["x", "y", "z", "rx", "ry", "rz"]) {
            let text = values
                .get(key)
                .ok_or_else(|| format!("{father} has no {key} ({place})"))?;
            *number = text
                .parse()
                .map_err(|_| format!("`{text}` is not a number ({place})"))?;
        }
        let above = values.get("fatherId").map_or("", String::as_str);
        Ok(self
            .ancestor(above, root, depth + 1)?
            .then(&Pose::staubli(numbers)))
    }
}
