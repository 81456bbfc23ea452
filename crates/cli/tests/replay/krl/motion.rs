//! Moves of KRL: what stays from one move to the next, and what a target that is not complete means.
//!
//! Source: KRL reference guide of KR C2 / KR C3 (release 4.1), PTP, LIN, CIRC; KUKA System Software 8.3, approximate
//! positioning [recalled].

use std::collections::BTreeMap;

use crate::event::{Blend, JointMove, JointTarget, LinearMove, Posture, Reference, Speed};
use crate::pose::Pose;
use crate::source::ReplayError;
use crate::value::Value;
use crate::words::{Cursor, Word};

/// Components of a frame or position by name.
pub type Record = BTreeMap<String, f64>;

const CARTESIAN: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

#[derive(Default)]
pub struct Motion {
    pub base: Reference,
    pub tool: Reference,
    /// m/s.
    pub path_speed: Option<f64>,
    /// `$APO.CDIS`, mm.
    pub distance: Option<f64>,
    /// `$APO.CPTP`, %.
    pub percent: Option<f64>,
    /// `$VEL_AXIS`, %, by axis.
    pub axis_speed: BTreeMap<u32, f64>,
    axes: Option<Record>,
    /// The last Cartesian target, with the frames in which it was given.
    last: Option<(Record, Reference, Reference)>,
    external: BTreeMap<usize, f64>,
}

impl Motion {
    /// A PTP move.
    pub fn ptp(&mut self, cursor: &mut Cursor, target: &Value) -> Result<JointMove, ReplayError> {
        let to = match target {
            Value::Text(actual) if actual == "$AXIS_ACT" || actual == "$POS_ACT" => JointTarget::Current,
            Value::Record(record) if record.keys().any(|key| is_axis(key)) => {
                JointTarget::Axes(self.axes(cursor, record)?)
            }
            _ => {
                let record = self.cartesian(cursor, target)?;
                let bits = |key: &str| record.get(key).map(|number| *number as u32);
                JointTarget::Pose {
                    pose: frame(cursor, &record)?,
                    posture: Posture::StatusTurn {
                        status: bits("S"),
                        turn: bits("T"),
                    },
                }
            }
        };
        let slowest = self.axis_speed.values().copied().reduce(f64::min);
        Ok(JointMove {
            to,
            external: self.external(),
            base: self.base.clone(),
            tool: self.tool.clone(),
            speed: slowest.map_or(Speed::Unspecified, Speed::Percent),
            blend: self.blend(cursor, "C_PTP")?,
        })
    }

    /// Axes that are not given stay where they are.
    fn axes(&mut self, cursor: &Cursor, given: &Record) -> Result<Vec<f64>, ReplayError> {
        let mut axes = self.axes.clone().unwrap_or_default();
        for (name, value) in given {
            if is_axis(name) {
                axes.insert(name.clone(), *value);
            } else if !self.take_external(name, *value) {
                return Err(cursor.error(format!("`{name}` is not a component of AXIS")));
            }
        }
        let all: Option<Vec<f64>> = (1..=6)
            .map(|axis| axes.get(&format!("A{axis}")).copied())
            .collect();
        let all =
            all.ok_or_else(|| cursor.error("an axis is not given, and its last position is not known"))?;
        self.axes = Some(axes);
        self.last = None;
        Ok(all)
    }

    fn take_external(&mut self, name: &str, value: f64) -> bool {
        let number = name.strip_prefix('E').and_then(|number| number.parse().ok());
        match number {
            Some(number @ 1..=6) => {
                self.external.insert(number, value);
                true
            }
            _ => false,
        }
    }

    fn external(&self) -> Vec<Option<f64>> {
        let count = self.external.keys().max().copied().unwrap_or(0);
        (1..=count)
            .map(|axis| self.external.get(&axis).copied())
            .collect()
    }

    /// A target with all of its components, which becomes the last one.
    pub fn cartesian(&mut self, cursor: &Cursor, target: &Value) -> Result<Record, ReplayError> {
        let record = self.completed(cursor, target)?;
        let mut place = Record::new();
        for (name, value) in &record {
            if CARTESIAN.contains(&name.as_str()) {
                place.insert(name.clone(), *value);
            } else if name != "S" && name != "T" && !self.take_external(name, *value) {
                return Err(cursor.error(format!("`{name}` is not a component of a position")));
            }
        }
        self.axes = None;
        self.last = Some((place, self.base.clone(), self.tool.clone()));
        Ok(record)
    }

    /// Components that are not given keep their last value, in the frames that are set now.
    pub fn completed(&self, cursor: &Cursor, target: &Value) -> Result<Record, ReplayError> {
        let Value::Record(record) = target else {
            return Err(cursor.error(format!("a position expected, found {target:?}")));
        };
        let mut record = record.clone();
        if record.keys().any(|key| is_axis(key)) {
            return Err(cursor.error("a Cartesian position expected, found axes"));
        }
        let missing: Vec<&str> = CARTESIAN
            .into_iter()
            .filter(|key| !record.contains_key(*key))
            .collect();
        if missing.is_empty() {
            return Ok(record);
        }
        let unknown = || {
            let keys = missing.join(", ");
            cursor.error(format!(
                "{keys} not given, and the last position is not known in this base with this tool"
            ))
        };
        let (last, base, tool) = self.last.as_ref().ok_or_else(unknown)?;
        let last = if *base == self.base && *tool == self.tool {
            last.clone()
        } else {
            let known = |of: &Reference| of.pose.ok_or_else(unknown);
            let flange = known(base)?
                .then(&frame(cursor, last)?)
                .then(&known(tool)?.inverse());
            let new = known(&self.base)?
                .inverse()
                .then(&flange)
                .then(&known(&self.tool)?);
            record_of(&new)
        };
        for key in &missing {
            record.insert((*key).to_owned(), last[*key]);
        }
        Ok(record)
    }

    /// The target of LIN_REL: distances from the last target along the axes of the base.
    pub fn moved(&mut self, cursor: &Cursor, by: &Value) -> Result<Record, ReplayError> {
        let Value::Record(by) = by else {
            return Err(cursor.error("LIN_REL needs components"));
        };
        let mut target = self.completed(cursor, &Value::Record(Record::new()))?;
        for (name, distance) in by {
            if !["X", "Y", "Z"].contains(&name.as_str()) {
                return Err(cursor.error(format!("LIN_REL by {name} is not interpreted")));
            }
            *target.entry(name.clone()).or_default() += *distance;
        }
        self.cartesian(cursor, &Value::Record(target))
    }

    pub fn linear(&mut self, cursor: &mut Cursor, target: &Record) -> Result<LinearMove, ReplayError> {
        Ok(LinearMove {
            to: frame(cursor, target)?,
            external: self.external(),
            base: self.base.clone(),
            tool: self.tool.clone(),
            // $VEL.CP is in m/s.
            speed: self
                .path_speed
                .map_or(Speed::Unspecified, |speed| Speed::MmPerS(speed * 1000.0)),
            blend: self.blend(cursor, "C_DIS")?,
        })
    }

    /// The words after the target; without any, the move ends exactly.
    fn blend(&self, cursor: &mut Cursor, usual: &str) -> Result<Blend, ReplayError> {
        let mut blend = Blend::Exact;
        while let Some(Word::Name(word)) = cursor.peek() {
            let word = word.to_uppercase();
            let first = blend == Blend::Exact;
            let next = match word.as_str() {
                "C_DIS" => self.distance.map_or(Blend::Unspecified, Blend::DistanceMm),
                "C_PTP" if usual == "C_PTP" => self.percent.map_or(Blend::Unspecified, Blend::Percent),
                "C_VEL" | "C_ORI" => Blend::Unspecified,
                _ => break,
            };
            cursor.eat_name(&word);
            if first {
                blend = next;
            }
        }
        // A distance of zero leaves nothing to approximate.
        Ok(match blend {
            Blend::DistanceMm(0.0) | Blend::Percent(0.0) => Blend::Exact,
            other => other,
        })
    }
}

fn is_axis(name: &str) -> bool {
    matches!(name, "A1" | "A2" | "A3" | "A4" | "A5" | "A6")
}

/// A frame of all six components.
pub fn frame(cursor: &Cursor, record: &Record) -> Result<Pose, ReplayError> {
    let mut numbers = [0.0; 6];
    for (number, key) in numbers.iter_mut().zip(CARTESIAN) {
        *number = *record
            .get(key)
            .ok_or_else(|| cursor.error(format!("component {key} of the frame is not given")))?;
    }
    Ok(Pose::kuka(numbers))
}

pub fn record_of(pose: &Pose) -> Record {
    CARTESIAN
        .iter()
        .map(|key| (*key).to_owned())
        .zip(pose.kuka_numbers())
        .collect()
}
