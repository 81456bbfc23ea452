//! Calibration file of Universal Robots, as `ur_calibration` writes it and `ur_description` reads it.
//!
//! ```text
//! kinematics:
//!   shoulder: {x, y, z, roll, pitch, yaw}     each key on a line of its own; m, turns about the fixed axes x, y, z in rad
//!   upper_arm, forearm, wrist_1, wrist_2, wrist_3: the same
//!   hash: calib_...
//! ```
//!
//! Each is the pose of a link in the link before, where its joint is at zero; the joint turns about z of its link. As in `ur_description` the base is
//! `base_link`, half a turn about z from the base of the controller, which becomes the frame `controller`; the flange is `tool0`, the frame of
//! `wrist_3`. Joints have the names of `ur_description`; the file has no limits and no speeds. The hash is not read.
//!
//! Lengths up to 100 m, angles up to two turns: more is a number under the wrong unit.
//!
//! Source: Universal Robots, ur_description, `urdf/ur_macro.xacro` and `config/ur10e/default_kinematics.yaml`.

use std::f64::consts::PI;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Amount, Axis, Joint, Motion, Robot};

use super::TWO_TURNS;
use super::description::RobotDescription;
use super::export::{UR_KEYS, UR_LINKS};
use super::opw::yaml::{self, Entry};
use crate::document::{Problems, Source};

/// Longest link of an arm, m: a file in mm has one beyond.
const LONGEST_LINK: f64 = 100.0;
/// Names of the joints in `ur_description`.
const JOINTS: [&str; 6] = [
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
];

/// The robot of this calibration file; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// No key `kinematics`; links or keys that are missing, double or unknown; what is not a number, a length or an angle.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let file = Source::new(path, text);
    let poses = poses(&file)?;
    let half_turn = Motion::About(Axis::Z, Amount::Constant(PI));
    let mut motions = vec![half_turn];
    for (joint, pose) in poses.iter().enumerate() {
        let [x, y, z, roll, pitch, yaw] = *pose;
        let constants = [
            Motion::Along(Axis::X, Amount::Constant(x)),
            Motion::Along(Axis::Y, Amount::Constant(y)),
            Motion::Along(Axis::Z, Amount::Constant(z)),
            Motion::About(Axis::Z, Amount::Constant(yaw)),
            Motion::About(Axis::Y, Amount::Constant(pitch)),
            Motion::About(Axis::X, Amount::Constant(roll)),
        ];
        motions.extend(
            constants
                .into_iter()
                .filter(|motion| motion.amount() != Amount::Constant(0.0)),
        );
        motions.push(Motion::About(Axis::Z, Amount::Joint(joint)));
    }
    let robot = Robot::new(id, motions, JOINTS.map(Joint::plain).to_vec())
        .map_err(|error| Problems::from(file.problem(0..0, error.to_string(), None)))?;
    let base_from_frame: Isometry = from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(0.0, 0.0, PI));
    let robot = robot.with_frames(vec![NamedFrame {
        name: "controller".to_owned(),
        base_from_frame,
    }]);
    let mut found = RobotDescription::of_one_source(robot, "ur", path, "poses of the six joints");
    found.remarks = vec![
        "the base is `base_link` of ur_description, the flange its `tool0`; the base of the controller is the frame `controller`".to_owned(),
        "the file has no limits and no speeds: add those of the type of the robot".to_owned(),
    ];
    Ok(found)
}

/// The six poses.
fn poses(file: &Source) -> Result<[[f64; 6]; 6], Problems> {
    let entries = yaml::entries(file.text());
    let Some(start) = entries.iter().position(|entry| entry.key == "kinematics") else {
        let hint = "a calibration file has the key `kinematics`, with shoulder, upper_arm, forearm and wrist_1 to wrist_3 below".to_owned();
        return Err(file
            .problem(
                0..0,
                "no UR calibration: the key `kinematics` is missing",
                Some(hint),
            )
            .into());
    };
    let mut problems = Vec::new();
    let mut found: [[Option<f64>; 6]; 6] = [[None; 6]; 6];
    let mut seen = [false; 6];
    let mut link: Option<usize> = None;
    for entry in entries.iter().skip(start + 1) {
        let mut refuse = |message: String, hint: Option<&str>| {
            problems.push(file.problem(entry.place.clone(), message, hint.map(str::to_owned)));
        };
        if let Some(index) = UR_LINKS.iter().position(|name| *name == entry.key) {
            if !entry.values.is_empty() {
                refuse(
                    format!("`{}` has values on its line", entry.key),
                    Some("write each key on a line of its own"),
                );
            }
            if std::mem::replace(&mut seen[index], true) {
                refuse(format!("`{}` is given twice", entry.key), Some("one arm a file"));
            }
            link = Some(index);
        } else if let Some(key) = UR_KEYS.iter().position(|name| *name == entry.key) {
            let Some(link) = link else {
                refuse(
                    format!("`{}` belongs to no link", entry.key),
                    Some("begin with `shoulder:`"),
                );
                continue;
            };
            match value(file, entry, key) {
                Err(found) => problems.extend(found),
                Ok(_) if found[link][key].is_some() => {
                    refuse(
                        format!("`{}` of `{}` is given twice", entry.key, UR_LINKS[link]),
                        None,
                    );
                }
                Ok(value) => found[link][key] = Some(value),
            }
        } else if entry.key != "hash" {
            refuse(
                format!("unknown key `{}`", entry.key),
                Some(
                    "links are shoulder, upper_arm, forearm, wrist_1, wrist_2, wrist_3; keys x, y, z, roll, pitch, yaw",
                ),
            );
        }
    }
    let mut poses = [[0.0; 6]; 6];
    for (index, name) in UR_LINKS.iter().enumerate() {
        if !seen[index] {
            let hint = "each of the six links is required".to_owned();
            problems.push(file.problem(0..0, format!("`{name}` is missing"), Some(hint)));
            continue;
        }
        for (key, name_of_key) in UR_KEYS.iter().enumerate() {
            match found[index][key] {
                Some(value) => poses[index][key] = value,
                None if problems.is_empty() => {
                    problems.push(file.problem(
                        0..0,
                        format!("`{name_of_key}` of `{name}` is missing"),
                        None,
                    ));
                }
                None => {}
            }
        }
    }
    Problems::from(problems).into_result().map(|()| poses)
}

/// The number of a key, m or rad.
///
/// # Errors
/// More or fewer values than one; what is not a length or an angle.
fn value(file: &Source, entry: &Entry<'_>, key: usize) -> Result<f64, Problems> {
    let [scalar] = entry.values.as_slice() else {
        let message = format!("`{}` has {} values: 1 required", entry.key, entry.values.len());
        return Err(file.problem(entry.place.clone(), message, None).into());
    };
    let (most, what) = match key < 3 {
        true => (LONGEST_LINK, "a length within 100 m (lengths are in m)"),
        false => (TWO_TURNS, "an angle within two turns (angles are in rad)"),
    };
    let value = scalar
        .text
        .parse::<f64>()
        .ok()
        .filter(|value| value.abs() <= most);
    value.ok_or_else(|| {
        let message = format!("`{}` of `{}` is not {what}", scalar.text, entry.key);
        file.problem(scalar.place.clone(), message, None).into()
    })
}

#[cfg(test)]
mod tests;
