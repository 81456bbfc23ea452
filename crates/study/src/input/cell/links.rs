//! The bodies of the robot: those of its robot file, or the collision meshes of its URDF.

use std::path::Path;
use std::sync::Arc;

use armill_core::clearance::{ArmBody, Role, Shape};
use armill_core::frame::Isometry;
use armill_core::nalgebra;
use armill_core::robot::forward::forward;
use armill_core::robot::{Attachment, Robot};
use armill_formats::mesh;
use armill_formats::robot::RobotDescription;
use armill_formats::robot::urdf::meshes::Mesh;

use crate::error::StudyError;
use crate::input::cell::shape::mesh_of;
use crate::link_meshes::{LinkMesh, LinkMeshes, Preferred};

/// The bodies of the links.
pub struct LinkBodies {
    /// The bodies.
    pub links: Vec<ArmBody>,
    /// Pairs of them that are apart in every posture.
    pub apart: Vec<[usize; 2]>,
    /// Of each whether it is so much larger than its link that a tool or part on the wrist would touch it without touching the link.
    pub is_coarse: Vec<bool>,
    /// What a user should know of them.
    pub notes: Vec<String>,
}

/// A body of a link of the wrist that may be larger than the link by more than this is not checked against what is in the hand, mm.
const COARSE_MM: f64 = 20.0;
/// Joints of a wrist.
const WRIST: usize = 3;

impl LinkBodies {
    /// The bodies of this robot, which the study calls `name`.
    ///
    /// # Errors
    /// The problems of a mesh file.
    pub fn of(robot: &RobotDescription, name: &str, folder: &Path) -> Result<LinkBodies, StudyError> {
        if !robot.bodies.is_empty() {
            return Ok(LinkBodies::of_file(robot));
        }
        let found = LinkMeshes::of(name, folder, Preferred::Collision);
        let notes = match &found {
            LinkMeshes::Found(_) => Vec::new(),
            LinkMeshes::None => vec![format!(
                "The shapes of the links of {} are not known: the clearance is that of tool and part alone.",
                robot.title
            )],
            LinkMeshes::Missing(file) => vec![format!(
                "The mesh `{file}` of {} is not in the folder of its file or of the study: the shapes of its links are not \
                 known, and the clearance is that of tool and part alone.",
                robot.title
            )],
        };
        let links: Vec<ArmBody> = match found {
            LinkMeshes::Found(meshes) => meshes
                .iter()
                .map(|mesh| body_of(robot, mesh))
                .collect::<Result<_, StudyError>>()?,
            _ => Vec::new(),
        };
        Ok(LinkBodies {
            is_coarse: vec![false; links.len()],
            links,
            apart: Vec::new(),
            notes,
        })
    }

    /// Those of the robot file.
    fn of_file(robot: &RobotDescription) -> LinkBodies {
        let is_coarse: Vec<bool> = robot
            .bodies
            .iter()
            .zip(&robot.body_notes)
            .map(|(body, note)| {
                is_of_wrist(body.attachment, &robot.robot)
                    && note.accuracy_mm.is_none_or(|accuracy| accuracy > COARSE_MM)
            })
            .collect();
        let mut notes = Vec::new();
        if is_coarse.contains(&true) {
            notes.push(format!(
                "{} is not checked against the wrist of {}: its bodies may be larger than its links by more than \
                 {COARSE_MM} mm. A URDF with collision meshes has exact ones.",
                match robot.robot.chain().ground().part_is_in_hand() {
                    true => "The part",
                    false => "The tool",
                },
                robot.title
            ));
        }
        LinkBodies {
            links: robot.bodies.clone(),
            apart: robot.apart.clone(),
            is_coarse,
            notes,
        }
    }
}

/// Whether a body with this attachment is a link of the wrist: one of the last of the arm.
fn is_of_wrist(attachment: Attachment, robot: &Robot) -> bool {
    let joints = robot.joints().len();
    // Number of links between the body and the part or tool in the hand.
    let before_hand = match robot.chain().ground().part_is_in_hand() {
        true => attachment.rank(joints),
        false => joints.saturating_sub(attachment.rank(joints)),
    };
    before_hand < WRIST
}

/// The body of one mesh.
fn body_of(robot: &RobotDescription, found: &LinkMesh) -> Result<ArmBody, StudyError> {
    let LinkMesh { mesh, path } = found;
    let bytes = armill_formats::input::read(path).map_err(|error| {
        let message = format!("cannot read the mesh `{}`: {error}", path.display());
        StudyError::value(message, "make it readable, or remove it from the robot file")
    })?;
    let read = mesh::read(&path.display().to_string(), &bytes)?;
    let unit = read.unit.map_or(1.0, mesh::MeshUnit::metres);
    let scale = mesh.scale.map(|factor| factor * unit);
    let Some(shape) = mesh_of(&read, scale, read.report().is_closed) else {
        let message = format!("the mesh `{}` of link `{}` has no triangle", mesh.file, mesh.link);
        return Err(StudyError::value(message, "another file"));
    };
    let (attachment, attachment_from_body) = attachment_of(robot, mesh);
    Ok(ArmBody {
        name: mesh.link.clone(),
        attachment,
        attachment_from_body,
        shape: Shape::Mesh(Arc::new(shape)),
        role: Role::Link,
    })
}

/// What a mesh moves with, and its position there.
pub fn attachment_of(robot: &RobotDescription, mesh: &Mesh) -> (Attachment, Isometry) {
    let joints = robot.robot.joints();
    let index = |name: &str| joints.iter().position(|joint| joint.name == name);
    let base_from_mesh = mesh.base_from_mesh(|_| None);
    // A mesh is given in the base of the arm: the ground, wherever that is in the chain.
    let ground = robot.robot.chain().ground();
    match mesh.joints().filter_map(index).last() {
        None => (ground.attachment(), ground.joint_from_ground * base_from_mesh),
        Some(joint) => {
            let zero = forward(&robot.robot, &vec![0.0; joints.len()]);
            // In a chain that begins at the flange a link is in front of its joint.
            let moved_by = match ground.part_is_in_hand() {
                true => joint.checked_sub(1),
                false => Some(joint),
            };
            let attachment = moved_by.map_or(Attachment::Base, Attachment::Joint);
            let base_from_attachment: Isometry = match moved_by {
                None => Isometry::identity(),
                Some(joint) => nalgebra::convert(zero.base_from_joint[joint]),
            };
            let base_from_ground: Isometry = nalgebra::convert(ground.in_base(&zero.base_from_joint));
            (
                attachment,
                base_from_attachment.inverse() * base_from_ground * base_from_mesh,
            )
        }
    }
}
