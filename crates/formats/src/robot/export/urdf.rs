//! URDF out: a link for each body, a joint between two.
//!
//! | element | content |
//! |---|---|
//! | `link` | base, one for each joint (`NAME_link`), flange; one for each frame of the robot file, `base` for that of the controller |
//! | `joint` | with the name of the robot file; `revolute`, `continuous` where no limits are known, `prismatic` |
//! | `origin` | pose at zero; calibrated small motions are in it, so that the axis is that of the nominal arm |
//! | `axis` | along a coordinate axis, negative for a joint of negative sign |
//! | `limit` | limits and greatest speed; `effort="0"`, and `velocity="0"` where no speed is known: not given |
//! | `mimic` | a joint that follows another, in front of a coupled joint |
//!
//! Source: wiki.ros.org/urdf/XML.

use super::bodies::{Body, BodyJoint, Drive, Inertial, JointKind, Linkage};
use super::error::ExportError;
use super::options::Exported;
use super::shapes::{Primitive, primitives, urdf_geometry};
use super::spelling::{attribute, exact, head, line, number, vector, xyz_rpy};
use armill_core::frame::Isometry;

/// The text of a URDF.
///
/// # Errors
/// A prismatic joint without limits.
pub(super) fn write(linkage: &Linkage, about: &[String]) -> Result<Exported, ExportError> {
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    text.push_str(&head(about));
    line(
        &mut text,
        &format!("<robot name=\"{}\">", attribute(&linkage.name)),
    );
    let origins = |body: &Body| origin(&body.parent_from_body);
    elements(&mut text, linkage, &origins)?;
    line(&mut text, "</robot>");
    Ok(Exported {
        text,
        arguments: None,
        warnings: Vec::new(),
    })
}

/// `<origin>` of a pose.
pub(super) fn origin(pose: &Isometry) -> String {
    let [xyz, rpy] = xyz_rpy(pose);
    format!("<origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>")
}

/// Links and joints, with what `origin_of` gives as the origin of a body in the body before.
///
/// # Errors
/// A prismatic joint without limits.
pub(super) fn elements(
    text: &mut String,
    linkage: &Linkage,
    origin_of: &dyn Fn(&Body) -> String,
) -> Result<(), ExportError> {
    let mut parent: Option<&str> = None;
    for body in &linkage.bodies {
        let own = attribute(&body.name);
        if let Some(parent) = parent {
            joints(text, (body, &own), parent, &origin_of(body))?;
        }
        link(text, &own, body);
        parent = Some(&body.name);
    }
    let base = linkage
        .bodies
        .first()
        .map_or_else(String::new, |body| attribute(&body.name));
    for (name, base_from_frame) in &linkage.frames {
        let name = attribute(name);
        line(text, &format!("  <link name=\"{name}\"/>"));
        fixed(text, [&base, &name], &origin(base_from_frame));
    }
    Ok(())
}

/// A fixed joint between two links.
fn fixed(text: &mut String, [parent, child]: [&str; 2], origin: &str) {
    line(
        text,
        &format!("  <joint name=\"{parent}-{child}\" type=\"fixed\">"),
    );
    line(
        text,
        &format!("    <parent link=\"{parent}\"/><child link=\"{child}\"/>"),
    );
    line(text, &format!("    {origin}"));
    line(text, "  </joint>");
}

/// The joints between a body and its parent, with links of no mass between them.
fn joints(
    text: &mut String,
    (body, own): (&Body, &str),
    parent: &str,
    origin: &str,
) -> Result<(), ExportError> {
    let Some(last) = body.joints.len().checked_sub(1) else {
        fixed(text, [&attribute(parent), own], origin);
        return Ok(());
    };
    let mut from = attribute(parent);
    for (index, joint) in body.joints.iter().enumerate() {
        let to = match index == last {
            true => own.to_owned(),
            false => attribute(body.between.get(index).map_or("", String::as_str)),
        };
        let name = attribute(&joint.name);
        let kind = kind(joint)?;
        line(text, &format!("  <joint name=\"{name}\" type=\"{kind}\">"));
        line(
            text,
            &format!("    <parent link=\"{from}\"/><child link=\"{to}\"/>"),
        );
        match index {
            0 => line(text, &format!("    {origin}")),
            _ => line(text, "    <origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>"),
        }
        line(text, &format!("    <axis xyz=\"{}\"/>", vector(&joint.axis)));
        match &joint.kind {
            JointKind::Drive(drive) => limit(text, drive),
            JointKind::Follower { of, factor } => {
                let (of, factor) = (attribute(of), exact(*factor));
                line(
                    text,
                    &format!("    <mimic joint=\"{of}\" multiplier=\"{factor}\" offset=\"0\"/>"),
                );
            }
            JointKind::Spring { .. } => {}
        }
        line(text, "  </joint>");
        if index != last {
            line(text, &format!("  <link name=\"{to}\"/>"));
        }
        from = to;
    }
    Ok(())
}

/// The type of a joint.
fn kind(joint: &BodyJoint) -> Result<&'static str, ExportError> {
    let limits = match &joint.kind {
        JointKind::Drive(drive) => drive.limits,
        JointKind::Follower { .. } | JointKind::Spring { .. } => None,
    };
    match (joint.slides, limits) {
        (false, Some(_)) => Ok("revolute"),
        (false, None) => Ok("continuous"),
        (true, Some(_)) => Ok("prismatic"),
        (true, None) => Err(ExportError::NoLimits(joint.name.clone())),
    }
}

fn limit(text: &mut String, drive: &Drive) {
    let speed = drive.max_speed.map_or("0".to_owned(), number);
    match drive.limits {
        Some(limits) => line(
            text,
            &format!(
                "    <limit lower=\"{}\" upper=\"{}\" effort=\"0\" velocity=\"{speed}\"/>",
                number(limits.lower),
                number(limits.upper)
            ),
        ),
        None if drive.max_speed.is_some() => {
            line(text, &format!("    <limit effort=\"0\" velocity=\"{speed}\"/>"));
        }
        None => {}
    }
}

/// A link with its mass and its shapes.
fn link(text: &mut String, name: &str, body: &Body) {
    if body.inertial.is_none() && body.shapes.is_empty() {
        line(text, &format!("  <link name=\"{name}\"/>"));
        return;
    }
    line(text, &format!("  <link name=\"{name}\">"));
    if let Some(inertial) = &body.inertial {
        inertial_element(text, inertial);
    }
    for (pose, primitive) in body.shapes.iter().filter_map(primitives) {
        let kinds: &[&str] = match &primitive {
            Primitive::Mesh(_, _, true) => &["visual"],
            Primitive::Mesh(_, _, false) => &["collision"],
            _ => &["visual", "collision"],
        };
        for kind in kinds {
            for (pose, geometry) in urdf_geometry(&pose, &primitive) {
                line(text, &format!("    <{kind}>{}{geometry}</{kind}>", origin(&pose)));
            }
        }
    }
    line(text, "  </link>");
}

/// The element `<inertial>`.
fn inertial_element(text: &mut String, inertial: &Inertial) {
    let i = &inertial.inertia;
    let inertia = [
        ("ixx", 0, 0),
        ("ixy", 0, 1),
        ("ixz", 0, 2),
        ("iyy", 1, 1),
        ("iyz", 1, 2),
        ("izz", 2, 2),
    ]
    .map(|(key, row, column)| format!("{key}=\"{}\"", exact(i[(row, column)])));
    line(text, "    <inertial>");
    let centre = vector(&inertial.centre);
    line(text, &format!("      <origin xyz=\"{centre}\" rpy=\"0 0 0\"/>"));
    line(text, &format!("      <mass value=\"{}\"/>", exact(inertial.mass)));
    line(text, &format!("      <inertia {}/>", inertia.join(" ")));
    line(text, "    </inertial>");
}
