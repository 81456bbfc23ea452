//! MJCF out, for MuJoCo: bodies inside each other, several joints in a body.
//!
//! | element | content |
//! |---|---|
//! | `body pos quat` | pose at zero |
//! | `joint` | with the name of the robot file; `hinge` or `slide`; `range` if known; `armature` is the inertia of the rotor |
//! | `joint stiffness` | 1/compliance; a spring joint behind its drive, or with `springref` the joint itself |
//! | `inertial` | mass, centre and inertia; `boundmass` of the compiler where none are known, a placeholder |
//! | `geom` | shapes of links, without contacts |
//! | `site` | flange, frames of the robot file |
//! | `motor` | one for each drive, of gear 1: force or torque of the joint |
//!
//! A body of MuJoCo has at most six joints: further ones are in a body inside it. Gravity is along -z of the base.
//!
//! Source: mujoco.readthedocs.io, XML reference.

use armill_core::source::stiffness_model::FREE_FALL;

use super::bodies::{Body, BodyJoint, BodyShape, Inertial, JointKind, Linkage};
use super::options::{ExportOptions, Exported, ExportedStiffness};
use super::shapes::{Primitive, primitives};
use super::spelling::{attribute, exact, head, line, number, vector, xyz_and_quaternion};
use crate::robot::RobotDescription;

/// Most joints of a body.
const MOST_JOINTS: usize = 6;
/// Placeholder of a mass that is not known, kg, and of an inertia, kg m^2.
const PLACEHOLDER_MASS: f64 = 1e-6;
/// Placeholder of the inertia of a rotor in front of a spring, kg m^2 (kg).
const PLACEHOLDER_ROTOR: f64 = 1.0;
/// Time step of a model with springs, s: a stiff wrist vibrates with some hundred hertz.
const STEP: &str = "0.0001";

/// The text of a model of MuJoCo.
pub(super) fn write(
    found: &RobotDescription,
    (linkage, options): (&Linkage, &ExportOptions),
    about: &[String],
) -> Exported {
    let mut text = head(about);
    let mut warnings = Vec::new();
    line(
        &mut text,
        &format!("<mujoco model=\"{}\">", attribute(&linkage.name)),
    );
    let unknown: Vec<&str> = linkage.without_mass().map(|body| body.name.as_str()).collect();
    let bounds = match unknown.is_empty() && !has_point_masses(linkage) {
        true => String::new(),
        false => format!(" boundmass=\"{0}\" boundinertia=\"{0}\"", exact(PLACEHOLDER_MASS)),
    };
    if !bounds.is_empty() {
        line(
            &mut text,
            "  <!-- Placeholder: boundmass (kg) and boundinertia (kg m^2) stand for masses and inertias that are not known. -->",
        );
    }
    if !unknown.is_empty() {
        warnings.push(format!(
            "motion under forces cannot be simulated: masses of {} are not known, the file has placeholders of {PLACEHOLDER_MASS:e} kg; \
             positions and static deflection do not depend on them",
            unknown.join(", ")
        ));
    }
    line(
        &mut text,
        &format!(
            "  <compiler angle=\"radian\" autolimits=\"true\" inertiafromgeom=\"false\" balanceinertia=\"true\"{bounds}/>"
        ),
    );
    let step = match options.stiffness {
        ExportedStiffness::None => String::new(),
        _ => format!(" timestep=\"{STEP}\" integrator=\"implicitfast\""),
    };
    line(
        &mut text,
        &format!("  <option gravity=\"0 0 {}\"{step}/>", number(-FREE_FALL)),
    );
    line(&mut text, "  <worldbody>");
    let mut writer = Bodies {
        text: &mut text,
        linkage,
        placeholder_rotors: Vec::new(),
        meshes: false,
    };
    writer.body(0);
    let (rotors, meshes) = (writer.placeholder_rotors, writer.meshes);
    line(&mut text, "  </worldbody>");
    if !rotors.is_empty() {
        warnings.push(format!(
            "vibration is not that of the robot: inertias of the rotors of {} are not known, the file has placeholders of \
             {PLACEHOLDER_ROTOR} kg m^2 (kg); static deflection does not depend on them",
            rotors.join(", ")
        ));
    }
    if meshes {
        warnings.push(
            "links are not drawn: mesh files of the source are left out, because MuJoCo reads other formats and paths".to_owned(),
        );
    }
    actuators(&mut text, linkage);
    keyframe(&mut text, found, (linkage, options));
    line(&mut text, "</mujoco>");
    Exported {
        text,
        arguments: None,
        warnings,
    }
}

/// Whether a body has a mass without inertia.
fn has_point_masses(linkage: &Linkage) -> bool {
    let mut known = linkage.bodies.iter().filter_map(|body| body.inertial);
    known.any(|own| own.inertia.diagonal().min() <= 0.0)
}

/// Writes bodies inside each other.
struct Bodies<'a> {
    text: &'a mut String,
    linkage: &'a Linkage,
    /// Drives whose rotor is a placeholder.
    placeholder_rotors: Vec<String>,
    /// Whether meshes are left out.
    meshes: bool,
}

impl Bodies<'_> {
    /// Body `index` and all behind it.
    fn body(&mut self, index: usize) {
        let Some(body) = self.linkage.bodies.get(index) else {
            return;
        };
        let indent = "  ".repeat(index + 2);
        let [pos, quat] = xyz_and_quaternion(&body.parent_from_body, true);
        let pose = format!("pos=\"{pos}\" quat=\"{quat}\"");
        let name = attribute(&body.name);
        let groups: Vec<&[BodyJoint]> = body.joints.chunks(MOST_JOINTS).collect();
        // The first groups are bodies of their own, without mass.
        let own = groups.len().max(1);
        for group in 0..own {
            let (name, pose) = match (group + 1 == own, group) {
                (true, 0) => (name.clone(), pose.clone()),
                (true, _) => (name.clone(), String::new()),
                (false, _) => (format!("{name}_part_{}", group + 1), pose.clone()),
            };
            line(
                self.text,
                format!("{indent}<body name=\"{name}\" {pose}").trim_end(),
            );
            self.text.truncate(self.text.trim_end().len());
            line(self.text, ">");
            for joint in groups.get(group).copied().unwrap_or_default() {
                self.joint(&indent, body, joint);
            }
        }
        self.content(&indent, index, body);
        self.body(index + 1);
        for _ in 0..own {
            line(self.text, &format!("{indent}</body>"));
        }
    }

    /// Mass, shapes and sites of a body.
    fn content(&mut self, indent: &str, index: usize, body: &Body) {
        if let Some(inertial) = &body.inertial {
            line(self.text, &format!("{indent}  {}", inertial_element(inertial)));
        }
        for shape in &body.shapes {
            match geom(shape) {
                Some(geom) => line(self.text, &format!("{indent}  {geom}")),
                None => self.meshes = true,
            }
        }
        if index == 0 {
            for (name, base_from_frame) in &self.linkage.frames {
                let [pos, quat] = xyz_and_quaternion(base_from_frame, true);
                let name = attribute(name);
                line(
                    self.text,
                    &format!("{indent}  <site name=\"{name}\" pos=\"{pos}\" quat=\"{quat}\"/>"),
                );
            }
        }
        if index + 1 == self.linkage.bodies.len() {
            line(self.text, &format!("{indent}  <site name=\"flange\"/>"));
        }
    }

    fn joint(&mut self, indent: &str, body: &Body, joint: &BodyJoint) {
        let kind = if joint.slides { "slide" } else { "hinge" };
        let mut element = format!(
            "<joint name=\"{}\" type=\"{kind}\" axis=\"{}\"",
            attribute(&joint.name),
            vector(&joint.axis)
        );
        if !joint.slides && joint.point.amax() > 0.0 {
            element += &format!(" pos=\"{}\"", vector(&joint.point));
        }
        match &joint.kind {
            JointKind::Spring { stiffness } => element += &format!(" stiffness=\"{}\"", exact(*stiffness)),
            // Refused before: MuJoCo has no joint that follows another.
            JointKind::Follower { .. } => {}
            JointKind::Drive(drive) => {
                if let Some(limits) = drive.limits {
                    let range = [limits.lower, limits.upper].map(number).join(" ");
                    element += &format!(" range=\"{range}\"");
                }
                if let Some([stiffness, position]) = drive.spring {
                    element += &format!(
                        " stiffness=\"{}\" springref=\"{}\"",
                        exact(stiffness),
                        number(position)
                    );
                } else {
                    let before_spring = body
                        .joints
                        .iter()
                        .any(|other| matches!(other.kind, JointKind::Spring { .. }));
                    match drive.rotor_inertia {
                        Some(inertia) => element += &format!(" armature=\"{}\"", exact(inertia)),
                        None if before_spring => {
                            line(self.text, &format!("{indent}  <!-- Placeholder: armature -->"));
                            element += &format!(" armature=\"{}\"", exact(PLACEHOLDER_ROTOR));
                            self.placeholder_rotors.push(joint.name.clone());
                        }
                        None => {}
                    }
                }
            }
        }
        line(self.text, &format!("{indent}  {element}/>"));
    }
}

/// The element `<inertial>`.
fn inertial_element(inertial: &Inertial) -> String {
    let i = &inertial.inertia;
    let inertia = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| exact(i[at]));
    let centre = vector(&inertial.centre);
    let mass = exact(inertial.mass);
    // A point with mass: the compiler raises the inertia to its bound.
    match i.amax() > 0.0 {
        true => format!(
            "<inertial pos=\"{centre}\" mass=\"{mass}\" fullinertia=\"{}\"/>",
            inertia.join(" ")
        ),
        false => format!("<inertial pos=\"{centre}\" mass=\"{mass}\" diaginertia=\"0 0 0\"/>"),
    }
}

/// A shape without contacts; none for a mesh.
fn geom(shape: &BodyShape) -> Option<String> {
    let (pose, primitive) = primitives(shape)?;
    let [pos, quat] = xyz_and_quaternion(&pose, true);
    let (kind, size) = match primitive {
        Primitive::Box(edges) => ("box", vector(&(edges * 0.5))),
        Primitive::Cylinder(radius, length) => ("cylinder", [radius, 0.5 * length].map(number).join(" ")),
        Primitive::Capsule(radius, length) => ("capsule", [radius, 0.5 * length].map(number).join(" ")),
        Primitive::Sphere(radius) => ("sphere", number(radius)),
        Primitive::Mesh(..) => return None,
    };
    Some(format!(
        "<geom type=\"{kind}\" pos=\"{pos}\" quat=\"{quat}\" size=\"{size}\" contype=\"0\" conaffinity=\"0\"/>"
    ))
}

/// A motor for each drive that is not a spring itself.
fn actuators(text: &mut String, linkage: &Linkage) {
    let drives = linkage.bodies.iter().flat_map(|body| &body.joints);
    let names: Vec<String> = drives
        .filter(|joint| matches!(&joint.kind, JointKind::Drive(drive) if drive.spring.is_none()))
        .map(|joint| attribute(&joint.name))
        .collect();
    if names.is_empty() {
        return;
    }
    line(text, "  <actuator>");
    for name in names {
        line(text, &format!("    <motor name=\"{name}\" joint=\"{name}\"/>"));
    }
    line(text, "  </actuator>");
}

/// The given posture, springs at zero.
fn keyframe(text: &mut String, found: &RobotDescription, (linkage, options): (&Linkage, &ExportOptions)) {
    let joints = linkage.bodies.iter().flat_map(|body| &body.joints);
    let positions: Option<Vec<String>> = joints
        .map(|joint| match &joint.kind {
            JointKind::Drive(drive) => options.positions(&found.robot, drive.joint).ok().map(number),
            JointKind::Follower { .. } | JointKind::Spring { .. } => Some("0".to_owned()),
        })
        .collect();
    if let Some(positions) = positions {
        line(text, "  <keyframe>");
        line(
            text,
            &format!("    <key name=\"posture\" qpos=\"{}\"/>", positions.join(" ")),
        );
        line(text, "  </keyframe>");
    }
}
