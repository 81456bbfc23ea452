//! OPW parameters: the seven lengths of an arm with ortho-parallel basis and spherical wrist, as MoveIt keeps them.
//!
//! ```text
//! Tz(c1) Rz(1) Tx(a1) Ty(b) Ry(2) Tz(c2) Ry(3) Tx(a2) Tz(c3) Rz(4) Ry(5) Rz(6) Tz(c4)     theta = sign q - offset
//! ```
//!
//! | key | holds |
//! |---|---|
//! | `opw_kinematics_geometric_parameters` | a1 a2 b c1 c2 c3 c4, m |
//! | `opw_kinematics_joint_offsets` | six angles, rad or `deg(-90.0)` |
//! | `opw_kinematics_joint_sign_corrections` | six times 1 or -1 |
//!
//! At chain zero the arm stands upright; the flange has z out of it and at chain zero the axes of the base. The
//! file names no joints, limits or speeds.
//!
//! Source: Brandstoetter, Angerer, Hofbaur 2014; the YAML keys of ROS-Industrial's support packages.

mod yaml;

use armill_core::robot::joint::Sign;
use armill_core::robot::{Amount, Axis, Joint, Motion, Robot};

use self::yaml::{Entry, Scalar};
use super::TWO_TURNS;
use super::description::RobotDescription;
use crate::document::{Problem, Problems, Source};

/// Longest link of an arm, m: a file in mm has one beyond.
const LONGEST_LINK: f64 = 100.0;

const LENGTHS: [&str; 7] = ["a1", "a2", "b", "c1", "c2", "c3", "c4"];
const OFFSETS: &str = "opw_kinematics_joint_offsets";
const SIGNS: &str = "opw_kinematics_joint_sign_corrections";

/// The robot of these OPW parameters; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// A YAML file of another kind, keys that are missing or double, what is no number, length, angle or sign.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = Source::new(path, text);
    let entries = yaml::entries(file.text());
    if !entries
        .iter()
        .any(|entry| entry.key.starts_with("opw_kinematics"))
    {
        let hint = if entries.iter().any(|entry| entry.key.ends_with("joint_names")) {
            "it lists joint names: no chain can be made of them"
        } else {
            "an OPW file has the keys opw_kinematics_geometric_parameters, opw_kinematics_joint_offsets and opw_kinematics_joint_sign_corrections"
        };
        let message = "no OPW parameters: no key begins with `opw_kinematics`";
        return Err(file.problem(0..0, message, Some(hint.to_owned())).into());
    }
    let mut problems = Vec::new();
    let mut keep = |result: Result<Vec<f64>, Vec<Problem>>| {
        result.unwrap_or_else(|mut found| {
            problems.append(&mut found);
            Vec::new()
        })
    };
    let lengths: Vec<f64> = LENGTHS
        .into_iter()
        .flat_map(|key| keep(list(&file, &entries, key, 1, length)))
        .collect();
    let offsets = keep(list(&file, &entries, OFFSETS, 6, angle));
    let signs = keep(list(&file, &entries, SIGNS, 6, sign));
    Problems::from(problems).into_result()?;

    let (&[a1, a2, b, c1, c2, c3, c4], true) = (
        <&[f64; 7]>::try_from(lengths.as_slice()).unwrap_or(&[0.0; 7]),
        lengths.len() == 7,
    ) else {
        return Err(file
            .problem(0..0, "the seven lengths are not complete", None)
            .into());
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
    let joints = offsets
        .iter()
        .zip(&signs)
        .enumerate()
        .map(|(index, (offset, sign))| Joint {
            sign: if *sign < 0.0 {
                Sign::Negative
            } else {
                Sign::Positive
            },
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
        "the base lies c1 below axis 2, on axis 1; the flange has z out of it, and may be turned about z against the maker's".to_owned(),
    ];
    Ok(found)
}

/// The values of a key, each judged by `of`.
fn list(
    file: &Source,
    entries: &[Entry<'_>],
    key: &str,
    count: usize,
    of: fn(&str) -> Result<f64, &'static str>,
) -> Result<Vec<f64>, Vec<Problem>> {
    let mut named = entries.iter().filter(|entry| entry.key == key);
    let Some(entry) = named.next() else {
        let hint = match count {
            1 => format!("add `{key}: 0.0` below opw_kinematics_geometric_parameters, in m"),
            _ => format!("add `{key}: [...]` with six values"),
        };
        return Err(vec![file.problem(
            0..0,
            format!("`{key}` is missing"),
            Some(hint),
        )]);
    };
    if let Some(second) = named.next() {
        let message = format!("`{key}` stands twice");
        let hint = "one arm a file".to_owned();
        return Err(vec![file.problem(second.place.clone(), message, Some(hint))]);
    }
    if entry.values.len() != count {
        let message = format!(
            "`{key}` has {} values where {count} are wanted",
            entry.values.len()
        );
        return Err(vec![file.problem(entry.place.clone(), message, None)]);
    }
    let judged = |Scalar { text, place }: &Scalar<'_>| {
        of(text).map_err(|what| {
            let message = format!("`{text}` of `{key}` is not {what}");
            Box::new(file.problem(place.clone(), message, None))
        })
    };
    let (mut values, mut problems) = (Vec::new(), Vec::new());
    for scalar in &entry.values {
        match judged(scalar) {
            Ok(value) => values.push(value),
            Err(problem) => problems.push(*problem),
        }
    }
    match problems.is_empty() {
        true => Ok(values),
        false => Err(problems),
    }
}

fn length(text: &str) -> Result<f64, &'static str> {
    let value = text.parse::<f64>().ok();
    value
        .filter(|value| value.abs() <= LONGEST_LINK)
        .ok_or("a length within 100 m (lengths of an OPW file are in m)")
}

fn angle(text: &str) -> Result<f64, &'static str> {
    let inside = |name: &str| {
        text.strip_prefix(name)?
            .trim()
            .strip_prefix('(')?
            .strip_suffix(')')
    };
    let value = match (inside("deg"), inside("rad")) {
        (Some(degrees), _) => degrees.trim().parse::<f64>().map(f64::to_radians),
        (_, Some(radians)) => radians.trim().parse::<f64>(),
        _ => text.parse::<f64>(),
    };
    let value = value.ok().filter(|value| value.abs() <= TWO_TURNS);
    value.ok_or("an angle within two turns, such as -1.5708 (rad) or deg(-90.0)")
}

fn sign(text: &str) -> Result<f64, &'static str> {
    let value = text.parse::<f64>().ok();
    value.filter(|value| value.abs() == 1.0).ok_or("1 or -1")
}

#[cfg(test)]
mod tests;
