//! SDF 1.11 out (`mimic` is newer than 1.9): links and joints of one model, fixed to the world.
//!
//! | element | content |
//! |---|---|
//! | `joint` with `pose relative_to` its parent | pose at zero; the link of a body is at its last joint |
//! | `axis xyz` | axes of the joint; `limit` if known, `mimic` for a joint that follows another |
//! | `dynamics spring_reference spring_stiffness` | 1/compliance; of a spring joint behind its drive, or of the joint itself |
//! | `inertial` | mass, centre and inertia; a placeholder where not known, because SDF would take 1 kg and 1 kg m^2 |
//! | `frame` | flange, if it is rigid on the last link; frames of the robot file |
//!
//! Gravity is that of the world. A posture is not part of a model.
//!
//! Source: sdformat.org/spec.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Vector3};

use super::bodies::{Body, BodyJoint, BodyShape, Inertial, JointKind, Linkage};
use super::options::Exported;
use super::shapes::{Primitive, primitives};
use super::spelling::{attribute, exact, head, line, number, vector, xyz_and_quaternion};

/// Placeholder of a mass that is not known, kg, and of an inertia, kg m^2.
const PLACEHOLDER: f64 = 1e-6;
/// What a link is fixed to, or moves relative to.
const WORLD: &str = "world";

/// The text of an SDF model.
pub(super) fn write(linkage: &Linkage, about: &[String]) -> Exported {
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    text.push_str(&head(about));
    line(&mut text, "<sdf version=\"1.11\">");
    line(
        &mut text,
        &format!("  <model name=\"{}\">", attribute(&linkage.name)),
    );
    let mut unknown = Vec::new();
    let mut parent = String::from(WORLD);
    for (index, body) in linkage.bodies.iter().enumerate() {
        let name = attribute(&body.name);
        let is_rigid = body.joints.is_empty();
        match (index, is_rigid) {
            (0, true) => {
                link(&mut text, (&name, None), body, &mut unknown);
                line(
                    &mut text,
                    &format!(
                        "    <joint name=\"{WORLD}-{name}\" type=\"fixed\"><parent>{WORLD}</parent><child>{name}</child></joint>"
                    ),
                );
            }
            (_, true) => frame(&mut text, [&name, &parent], &body.parent_from_body),
            _ => joints(&mut text, (body, &name), &parent, &mut unknown),
        }
        parent = name;
    }
    let base = linkage
        .bodies
        .first()
        .map_or_else(String::new, |body| attribute(&body.name));
    for (name, base_from_frame) in &linkage.frames {
        frame(&mut text, [&attribute(name), &base], base_from_frame);
    }
    line(&mut text, "  </model>");
    line(&mut text, "</sdf>");
    let mut warnings = Vec::new();
    if !unknown.is_empty() {
        warnings.push(format!(
            "motion under forces is not that of the robot: masses of {} are not known, the file has placeholders of {PLACEHOLDER:e} kg",
            unknown.join(", ")
        ));
    }
    Exported {
        text,
        arguments: None,
        warnings,
    }
}

/// A pose relative to another frame.
fn pose(relative_to: &str, pose: &Isometry) -> String {
    let [xyz, quaternion] = xyz_and_quaternion(pose, false);
    let relative_to = match relative_to {
        "" => String::new(),
        other => format!(" relative_to=\"{other}\""),
    };
    format!("<pose{relative_to} rotation_format=\"quat_xyzw\">{xyz} {quaternion}</pose>")
}

/// A frame that is rigid on a link or another frame.
fn frame(text: &mut String, [name, on]: [&str; 2], on_from_frame: &Isometry) {
    line(
        text,
        &format!(
            "    <frame name=\"{name}\" attached_to=\"{on}\">{}</frame>",
            pose("", on_from_frame)
        ),
    );
}

/// The joints between a body and its parent, with links between them.
fn joints(text: &mut String, (body, own): (&Body, &str), parent: &str, unknown: &mut Vec<String>) {
    let last = body.joints.len().saturating_sub(1);
    let mut from = parent.to_owned();
    let mut from_joint = body.parent_from_body;
    for (index, joint) in body.joints.iter().enumerate() {
        let name = attribute(&joint.name);
        let to = match index == last {
            true => own.to_owned(),
            false => attribute(body.between.get(index).map_or("", String::as_str)),
        };
        let here = Isometry::translation(joint.point.x, joint.point.y, joint.point.z);
        joint_element(text, joint, ([&from, &to], &(from_joint * here)));
        let placed = Some((name.as_str(), here.inverse()));
        match index == last {
            true => link_at(text, (own, placed), Some(body), unknown),
            false => link_at(text, (&to, placed), None, unknown),
        }
        from_joint = Isometry::identity();
        from = to;
    }
}

fn joint_element(
    text: &mut String,
    joint: &BodyJoint,
    ([parent, child], parent_from_joint): ([&str; 2], &Isometry),
) {
    let kind = match joint.slides {
        true => "prismatic",
        false => "revolute",
    };
    line(
        text,
        &format!("    <joint name=\"{}\" type=\"{kind}\">", attribute(&joint.name)),
    );
    // A joint with the world as parent is placed relative to the model.
    let relative_to = if parent == WORLD { "__model__" } else { parent };
    line(text, &format!("      {}", pose(relative_to, parent_from_joint)));
    line(
        text,
        &format!("      <parent>{parent}</parent><child>{child}</child>"),
    );
    line(text, "      <axis>");
    line(text, &format!("        <xyz>{}</xyz>", vector(&joint.axis)));
    let mut spring = None;
    match &joint.kind {
        JointKind::Drive(drive) => {
            let mut limit = String::new();
            if let Some(limits) = drive.limits {
                limit += &format!(
                    "<lower>{}</lower><upper>{}</upper>",
                    number(limits.lower),
                    number(limits.upper)
                );
            }
            if let Some(speed) = drive.max_speed {
                limit += &format!("<velocity>{}</velocity>", number(speed));
            }
            if !limit.is_empty() {
                line(text, &format!("        <limit>{limit}</limit>"));
            }
            spring = drive.spring;
        }
        JointKind::Follower { of, factor } => line(
            text,
            &format!(
                "        <mimic joint=\"{}\"><multiplier>{}</multiplier><offset>0</offset><reference>0</reference></mimic>",
                attribute(of),
                exact(*factor)
            ),
        ),
        JointKind::Spring { stiffness } => spring = Some([*stiffness, 0.0]),
    }
    if let Some([stiffness, reference]) = spring {
        line(
            text,
            &format!(
                "        <dynamics><spring_reference>{}</spring_reference><spring_stiffness>{}</spring_stiffness></dynamics>",
                number(reference),
                exact(stiffness)
            ),
        );
    }
    line(text, "      </axis>");
    line(text, "    </joint>");
}

/// The link of a body that has no joints.
fn link(
    text: &mut String,
    (name, placed): (&str, Option<(&str, Isometry)>),
    body: &Body,
    unknown: &mut Vec<String>,
) {
    link_at(text, (name, placed), Some(body), unknown);
}

/// A link at a joint: of a body, or one between two joints.
fn link_at(
    text: &mut String,
    (name, placed): (&str, Option<(&str, Isometry)>),
    body: Option<&Body>,
    unknown: &mut Vec<String>,
) {
    line(text, &format!("    <link name=\"{name}\">"));
    if let Some((joint, joint_from_link)) = placed {
        line(text, &format!("      {}", pose(joint, &joint_from_link)));
    }
    match body.and_then(|body| body.inertial) {
        Some(inertial) => inertial_element(text, &inertial),
        None if body.is_none() || placed.is_some() => {
            line(text, "      <!-- Placeholder: mass and inertia -->");
            let inertia = Matrix3::identity() * PLACEHOLDER;
            let mass = PLACEHOLDER;
            inertial_element(
                text,
                &Inertial {
                    mass,
                    centre: Vector3::zeros(),
                    inertia,
                },
            );
            if let Some(body) = body {
                unknown.push(body.name.clone());
            }
        }
        // The base is fixed.
        None => {}
    }
    let shapes = body.map_or(&[][..], |body| &body.shapes);
    for (number, shape) in shapes.iter().enumerate() {
        shape_element(text, number, shape);
    }
    line(text, "    </link>");
}

fn inertial_element(text: &mut String, inertial: &Inertial) {
    let i = &inertial.inertia;
    // SDF refuses a body without extent.
    let at_least = |value: f64| if value > 0.0 { value } else { PLACEHOLDER };
    let inertia = [("ixx", 0, 0), ("iyy", 1, 1), ("izz", 2, 2)]
        .map(|(key, row, column)| format!("<{key}>{}</{key}>", exact(at_least(i[(row, column)]))));
    let products = [("ixy", 0, 1), ("ixz", 0, 2), ("iyz", 1, 2)]
        .map(|(key, row, column)| format!("<{key}>{}</{key}>", exact(i[(row, column)])));
    line(
        text,
        &format!(
            "      <inertial><pose>{} 0 0 0</pose><mass>{}</mass><inertia>{}{}</inertia></inertial>",
            vector(&inertial.centre),
            exact(if inertial.mass > 0.0 {
                inertial.mass
            } else {
                PLACEHOLDER
            }),
            inertia.concat(),
            products.concat()
        ),
    );
}

fn shape_element(text: &mut String, index: usize, shape: &BodyShape) {
    let Some((at, primitive)) = primitives(shape) else {
        return;
    };
    let size = |radius: f64, length: f64| {
        format!(
            "<radius>{}</radius><length>{}</length>",
            number(radius),
            number(length)
        )
    };
    let (geometry, kinds): (String, &[&str]) = match &primitive {
        Primitive::Box(edges) => (
            format!("<box><size>{}</size></box>", vector(edges)),
            &["visual", "collision"],
        ),
        Primitive::Cylinder(radius, length) => (
            format!("<cylinder>{}</cylinder>", size(*radius, *length)),
            &["visual", "collision"],
        ),
        Primitive::Capsule(radius, length) => (
            format!("<capsule>{}</capsule>", size(*radius, *length)),
            &["visual", "collision"],
        ),
        Primitive::Sphere(radius) => (
            format!("<sphere><radius>{}</radius></sphere>", number(*radius)),
            &["visual", "collision"],
        ),
        Primitive::Mesh(file, scale, looks) => (
            format!(
                "<mesh><uri>{}</uri><scale>{}</scale></mesh>",
                attribute(file),
                scale.map(number).join(" ")
            ),
            if *looks { &["visual"] } else { &["collision"] },
        ),
    };
    for kind in kinds {
        line(
            text,
            &format!(
                "      <{kind} name=\"{kind}_{}\">{}<geometry>{geometry}</geometry></{kind}>",
                index + 1,
                pose("", &at)
            ),
        );
    }
}
