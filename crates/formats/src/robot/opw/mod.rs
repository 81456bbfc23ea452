//! OPW parameters: the seven lengths of an arm with ortho-parallel basis and spherical wrist, as MoveIt keeps them.
//!
//! ```text
//! Tz(c1) Rz(1) Tx(a1) Ty(b) Ry(2) Tz(c2) Ry(3) Tx(a2) Tz(c3) Rz(4) Ry(5) Rz(6) Tz(c4)     theta = sign q - offset
//! ```
//!
//! | key | meaning |
//! |---|---|
//! | `opw_kinematics_geometric_parameters` | a1 a2 b c1 c2 c3 c4, m |
//! | `opw_kinematics_joint_offsets` | six angles, rad or `deg(-90.0)` |
//! | `opw_kinematics_joint_sign_corrections` | six times 1 or -1 |
//!
//! At chain zero the arm is upright; the flange has z out of it and at chain zero the axes of the base. The
//! file names no joints, limits or speeds.
//!
//! `yaml` finds keys and values, each with its place; here they become an arm.
//!
//! ```text
//! opw_kinematics_geometric_parameters:
//!   a1: 0.155
//!   ...
//! opw_kinematics_joint_offsets: [0.0, 0.0, deg(-90.0), 0.0, 0.0, 0.0]
//! opw_kinematics_joint_sign_corrections: [1, 1, -1, -1, -1, -1]
//! ```
//!
//! Lengths up to 100 m, angles up to two turns: more is a number under the wrong unit. The offset of a file is
//! `sign q` at chain zero; ours is the chain position at the controller's zero: `-offset`.
//!
//! Source: Brandstoetter, Angerer, Hofbaur 2014; the YAML keys of ROS-Industrial's support packages.

pub(super) mod yaml;

use std::ops::Range;

use armill_core::robot::joint::Sign;
use armill_core::robot::{Amount, Axis, Joint, Motion, Robot};
use armill_core::units::from_deg;

use self::yaml::{Entry, Scalar};
use super::TWO_TURNS;
use super::description::RobotDescription;
use crate::document::{Problem, Problems, Source};

/// Longest link of an arm, m: a file in mm has one beyond.
const LONGEST_LINK: f64 = 100.0;

/// Keys of the lengths, one number each.
const LENGTHS: [&str; 7] = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];
/// Key of the joint offsets, six numbers.
const OFFSETS: &str = "opw_kinematics_joint_offsets";
/// Key of the signs, six numbers.
const SIGNS: &str = "opw_kinematics_joint_sign_corrections";

/// The robot of these OPW parameters; `path` is what errors show, `id` the robot's name in results.
///
/// Six joints, `joint_1` to `joint_6`; each length is a motion of its own, with its key as symbol.
///
/// # Errors
/// A YAML file of another kind, keys that are missing or double, what is not a number, length, angle or sign.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = Source::new(path, text);
    let mut keys = Keys::of(&file)?;
    let lengths = LENGTHS.map(|key| keys.values(key, length).map(|[length]| length));
    let offsets: Option<[f64; 6]> = keys.values(OFFSETS, angle);
    let signs: Option<[Sign; 6]> = keys.values(SIGNS, sign);
    let (
        [
            Some(a1),
            Some(a2),
            Some(b),
            Some(c1),
            Some(c2),
            Some(c3),
            Some(c4),
        ],
        Some(offsets),
        Some(signs),
    ) = (lengths, offsets, signs)
    else {
        return Err(keys.problems.into());
    };
    let along = |axis, metres| Motion::Along(axis, Amount::Constant(metres));
    let about = |axis, joint| Motion::About(axis, Amount::Joint(joint));
    let (motions, symbols): (Vec<Motion>, Vec<Option<&str>>) = [
        (along(Axis::Z, c1), Some("c1")),
        (about(Axis::Z, 0), None),
        (along(Axis::X, a1), Some("a1")),
        (along(Axis::Y, b), Some("b")),
        (about(Axis::Y, 1), None),
        (along(Axis::Z, c2), Some("c2")),
        (about(Axis::Y, 2), None),
        (along(Axis::X, a2), Some("a2")),
        (along(Axis::Z, c3), Some("c3")),
        (about(Axis::Z, 3), None),
        (about(Axis::Y, 4), None),
        (about(Axis::Z, 5), None),
        (along(Axis::Z, c4), Some("c4")),
    ]
    .into_iter()
    .unzip();
    let joints = offsets.into_iter().zip(signs).enumerate();
    let joints = joints.map(|(index, (offset, sign))| Joint {
        sign,
        zero_offset: -offset,
        ..Joint::plain(format!("joint_{}", index + 1))
    });
    let robot = Robot::new(id, motions, joints.collect())
        .map_err(|error| Problems::from(file.problem(0..0, error.to_string(), None)))?;
    let mut found = RobotDescription::of_one_source(robot, "opw", path, "lengths, joint offsets and signs");
    found.symbols = symbols
        .into_iter()
        .map(|symbol| symbol.map(str::to_owned))
        .collect();
    found.remarks = vec![
        "the file names no joints: they are called joint_1 to joint_6".to_owned(),
        "the base is c1 below axis 2, on axis 1; the flange has z out of it, and may be rotated about z relative to the maker's".to_owned(),
    ];
    Ok(found)
}

/// The keys of a file, and what was wrong with those that were requested.
struct Keys<'a> {
    /// Finds places.
    file: &'a Source,
    /// In the order of the file.
    entries: Vec<Entry<'a>>,
    /// Of the keys that were requested so far.
    problems: Vec<Problem>,
}

impl<'a> Keys<'a> {
    /// All keys of the file.
    ///
    /// # Errors
    /// A YAML file of another kind.
    fn of(file: &'a Source) -> Result<Keys<'a>, Problems> {
        let entries = yaml::entries(file.text());
        let has = |requested: fn(&str) -> bool| entries.iter().any(|entry| requested(entry.key));
        if has(|key| key.starts_with("opw_kinematics")) {
            return Ok(Keys {
                file,
                entries,
                problems: Vec::new(),
            });
        }
        let hint = if has(|key| key.ends_with("joint_names")) {
            "it lists joint names only: they do not define a chain"
        } else {
            "an OPW file has the keys opw_kinematics_geometric_parameters, opw_kinematics_joint_offsets and opw_kinematics_joint_sign_corrections"
        };
        let message = "no OPW parameters: no key begins with `opw_kinematics`";
        Err(file.problem(0..0, message, Some(hint.to_owned())).into())
    }

    /// The values of a key, each checked by `of`; where there are not `N`, or one is refused, a problem is kept.
    ///
    /// The position of the key does not matter: below which other key, or how far indented.
    fn values<T, const N: usize>(
        &mut self,
        key: &str,
        of: fn(&str) -> Result<T, &'static str>,
    ) -> Option<[T; N]> {
        let mut refuse = |place: Range<usize>, message: String, hint: Option<String>| {
            self.problems.push(self.file.problem(place, message, hint));
        };
        let mut named = self.entries.iter().filter(|entry| entry.key == key);
        let Some(entry) = named.next() else {
            let hint = match N {
                1 => format!("add `{key}: 0.0` below opw_kinematics_geometric_parameters, in m"),
                _ => format!("add `{key}: [...]` with six values"),
            };
            refuse(0..0, format!("`{key}` is missing"), Some(hint));
            return None;
        };
        if let Some(second) = named.next() {
            let hint = "one arm a file".to_owned();
            refuse(
                second.place.clone(),
                format!("`{key}` is given twice"),
                Some(hint),
            );
            return None;
        }
        if entry.values.len() != N {
            let count = entry.values.len();
            let message = format!("`{key}` has {count} values: {N} required");
            refuse(entry.place.clone(), message, None);
            return None;
        }
        let mut values = Vec::new();
        for Scalar { text, place } in &entry.values {
            match of(text) {
                Ok(value) => values.push(value),
                Err(what) => refuse(place.clone(), format!("`{text}` of `{key}` is not {what}"), None),
            }
        }
        values.try_into().ok()
    }
}

/// A length in m; refused is what is not a number, or beyond [`LONGEST_LINK`].
fn length(text: &str) -> Result<f64, &'static str> {
    let value = text.parse::<f64>().ok();
    value
        .filter(|value| value.abs() <= LONGEST_LINK)
        .ok_or("a length within 100 m (lengths of an OPW file are in m)")
}

/// An angle in rad, from `-1.57`, `rad(-1.57)` or `deg(-90.0)`.
fn angle(text: &str) -> Result<f64, &'static str> {
    let inside = |name: &str| {
        text.strip_prefix(name)?
            .trim()
            .strip_prefix('(')?
            .strip_suffix(')')
    };
    let value = match (inside("deg"), inside("rad")) {
        (Some(degrees), _) => degrees.trim().parse::<f64>().map(from_deg),
        (_, Some(radians)) => radians.trim().parse::<f64>(),
        _ => text.parse::<f64>(),
    };
    let value = value.ok().filter(|value| value.abs() <= TWO_TURNS);
    value.ok_or("an angle within two turns, such as -1.5708 (rad) or deg(-90.0)")
}

/// 1 or -1, also as `1.0`.
fn sign(text: &str) -> Result<Sign, &'static str> {
    match text.parse::<f64>() {
        Ok(1.0) => Ok(Sign::Positive),
        Ok(-1.0) => Ok(Sign::Negative),
        _ => Err("1 or -1"),
    }
}

#[cfg(test)]
mod tests;
