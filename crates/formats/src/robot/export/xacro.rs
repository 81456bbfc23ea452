//! xacro out: macros that read the pose of every joint from a YAML file, and that file.
//!
//! | macro | content |
//! |---|---|
//! | `armill_origin joint` | `<origin>` of a joint, from the file: for the xacro of a manufacturer, in place of its own |
//! | `armill_flange_origin` | `<origin>` of the flange in the link of the last joint |
//! | `armill_arm prefix` | all links and joints |
//!
//! ```text
//! joints:
//!   NAME: {x, y, z, roll, pitch, yaw}       pose of the joint in the link before, at zero; m and rad
//! flange: {x, y, z, roll, pitch, yaw}
//! ```
//!
//! Nominal poses are in comments, with the distance and the angle from them, if the robot was calibrated by armill.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::robot::Amount;
use armill_core::units::{to_deg, to_mm};

use super::bodies::{Body, JointKind, Linkage};
use super::error::ExportError;
use super::options::{ExportOptions, Exported};
use super::spelling::{attribute, comment_line, head, line, number};
use super::urdf;
use crate::robot::RobotDescription;
use crate::robot::armill::CALIBRATED;

/// Name of the file of arguments where none is given.
const ARGUMENTS: &str = "armill_geometry.yaml";
/// Keys of a pose.
const KEYS: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// The macros and the file of arguments.
///
/// # Errors
/// As of a URDF.
pub(super) fn write(
    found: &RobotDescription,
    (linkage, options): (&Linkage, &ExportOptions),
    about: &[String],
) -> Result<Exported, ExportError> {
    let file = options.arguments_file.as_deref().unwrap_or(ARGUMENTS);
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    text.push_str(&head(about));
    line(
        &mut text,
        &format!(
            "<robot name=\"{}\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">",
            attribute(&linkage.name)
        ),
    );
    line(
        &mut text,
        &format!(
            "  <xacro:property name=\"armill_geometry\" lazy_eval=\"false\" value=\"${{xacro.load_yaml('{}')}}\"/>",
            attribute(file)
        ),
    );
    macro_of_origin(
        &mut text,
        "armill_origin",
        "joint",
        "armill_geometry['joints'][joint]",
    );
    macro_of_origin(&mut text, "armill_flange_origin", "", "armill_geometry['flange']");
    line(
        &mut text,
        "  <xacro:macro name=\"armill_arm\" params=\"prefix:=''\">",
    );
    let origin = |body: &Body| match first_drive(body) {
        Some(joint) => format!("<xacro:armill_origin joint=\"{}\"/>", attribute(&joint)),
        None => "<xacro:armill_flange_origin/>".to_owned(),
    };
    let mut inner = String::new();
    urdf::elements(&mut inner, linkage, &origin)?;
    text.push_str(&prefixed(&inner));
    line(&mut text, "  </xacro:macro>");
    line(&mut text, "</robot>");
    Ok(Exported {
        text,
        arguments: Some(arguments(found, linkage, about)),
        warnings: Vec::new(),
    })
}

/// Names of links and joints behind the parameter `prefix`.
fn prefixed(elements: &str) -> String {
    let mut text = elements.to_owned();
    for before in ["<link name=\"", "<joint name=\"", " link=\"", "<mimic joint=\""] {
        text = text.replace(before, &format!("{before}${{prefix}}"));
    }
    text.lines().map(|content| format!("  {content}\n")).collect()
}

/// A macro that gives an `<origin>`.
fn macro_of_origin(text: &mut String, name: &str, parameters: &str, of: &str) {
    let [x, y, z, roll, pitch, yaw] = KEYS.map(|key| format!("${{{of}['{key}']}}"));
    line(
        text,
        &format!("  <xacro:macro name=\"{name}\" params=\"{parameters}\">"),
    );
    line(
        text,
        &format!("    <origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/>"),
    );
    line(text, "  </xacro:macro>");
}

/// Name of the drive of a body.
fn first_drive(body: &Body) -> Option<String> {
    let mut joints = body.joints.iter();
    let drive = joints.find(|joint| matches!(joint.kind, JointKind::Drive(_)))?;
    Some(drive.name.clone())
}

/// The file of arguments.
fn arguments(found: &RobotDescription, linkage: &Linkage, about: &[String]) -> String {
    let mut text = String::new();
    for content in about {
        comment_line(&mut text, content);
    }
    line(
        &mut text,
        "# Poses in the link before, at zero: m; turns about the fixed axes x, y, z in rad.",
    );
    line(&mut text, "joints:");
    let nominal = nominal_poses(found);
    let moved = linkage.bodies.iter().skip(1).enumerate();
    for (index, body) in moved {
        match first_drive(body) {
            Some(joint) => line(&mut text, &format!("  {}:", quoted(&joint))),
            None => line(&mut text, "flange:"),
        }
        let indent = if first_drive(body).is_some() { "    " } else { "  " };
        if let Some(nominal) = nominal.as_ref().and_then(|poses| poses.get(index)) {
            let apart = nominal.inverse() * body.parent_from_body;
            line(
                &mut text,
                &format!(
                    "{indent}# nominal: {}; moved by {:.4} mm, turned by {:.5} deg",
                    values(nominal).join(" "),
                    to_mm(apart.translation.vector.norm()),
                    to_deg(apart.rotation.angle())
                ),
            );
        }
        for (key, value) in KEYS.iter().zip(values(&body.parent_from_body)) {
            line(&mut text, &format!("{indent}{key}: {value}"));
        }
    }
    text
}

/// Position and turns of a pose.
fn values(pose: &Isometry) -> [String; 6] {
    let (at, turns) = (pose.translation.vector, fixed_angles(&pose.rotation));
    [at.x, at.y, at.z, turns.x, turns.y, turns.z].map(number)
}

/// Nominal pose of every joint and of the flange; none of a robot whose calibrated motions are not marked.
fn nominal_poses(found: &RobotDescription) -> Option<Vec<Isometry>> {
    let is_calibrated = |symbol: &Option<String>| symbol.as_deref() == Some(CALIBRATED);
    if !found.symbols.iter().any(is_calibrated) {
        return None;
    }
    let mut poses = Vec::new();
    let mut fixed = Isometry::identity();
    for (motion, symbol) in found.robot.chain().motions().iter().zip(&found.symbols) {
        match motion.amount() {
            Amount::Constant(_) if is_calibrated(symbol) => {}
            Amount::Constant(value) => fixed *= motion.displacement(value),
            Amount::Joint(joint) => {
                let offset = found
                    .robot
                    .joints()
                    .get(joint)
                    .map_or(0.0, |joint| joint.zero_offset);
                poses.push(fixed * motion.displacement(offset));
                fixed = Isometry::identity();
            }
        }
    }
    poses.push(fixed);
    Some(poses)
}

/// A YAML text in double quotes.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
