//! The meshes of the robot, if its file names them.
//!
//! Where they are found: `link_meshes`.

use std::path::Path;

use armill_core::robot::Robot;
use armill_core::robot::forward::base_from_ground;
use armill_core::units::to_mm;
use armill_formats::input;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::StudyError;
use crate::file::resolve::Parsed;
use crate::link_meshes::{LinkMesh, LinkMeshes, Preferred};
use crate::live::StudyText;
use crate::number::without_rounding;

/// A shape of a link, in base.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DrawnMesh {
    /// Its link.
    pub link: String,
    /// Its file, as in the robot file.
    pub file: String,
    /// Millimetres for one unit of the file, along its axes.
    pub scale_mm: [f64; 3],
    /// Its position.
    pub xyz_mm: [f64; 3],
    /// Its orientation, unit quaternion.
    pub quaternion_wxyz: [f64; 4],
}

/// The shapes of a robot, each with its file.
pub(super) struct Shapes(Vec<LinkMesh>);

impl Shapes {
    /// Those that the file of this robot names; none if it names none, or if one is missing.
    pub(super) fn of(robot: &str, folder: &Path) -> Shapes {
        match LinkMeshes::of(robot, folder, Preferred::Looks) {
            LinkMeshes::Found(found) => Shapes(found),
            LinkMeshes::None | LinkMeshes::Missing(_) => Shapes(Vec::new()),
        }
    }

    /// The meshes at these joint positions (rad, m).
    pub(super) fn drawn(&self, robot: &Robot, q: &[f64]) -> Vec<DrawnMesh> {
        let position = |name: &str| {
            let index = robot.joints().iter().position(|joint| joint.name == name)?;
            q.get(index).copied()
        };
        // They are given in the base of the arm: the ground, wherever that is in the chain.
        let base_from_ground = base_from_ground(robot, q);
        let one = |LinkMesh { mesh, .. }: &LinkMesh| {
            let at = base_from_ground * mesh.base_from_mesh(position);
            let turn = at.rotation.coords;
            DrawnMesh {
                link: mesh.link.clone(),
                file: mesh.file.clone(),
                scale_mm: mesh.scale.map(to_mm),
                xyz_mm: at.translation.vector.map(|m| without_rounding(to_mm(m))).into(),
                quaternion_wxyz: [turn.w, turn.x, turn.y, turn.z].map(without_rounding),
            }
        };
        self.0.iter().map(one).collect()
    }
}

/// The bytes of this mesh of the study's robot, by its name in the robot file.
///
/// # Errors
/// A text that is not a study; a robot that names no such mesh, or whose file is missing or too large.
pub fn mesh_bytes(text: StudyText<'_>, file: &str) -> Result<Vec<u8>, StudyError> {
    let robot = Parsed::of(text.shown, text.bytes)?.file.robot;
    let Shapes(shapes) = Shapes::of(&robot, text.folder);
    let named = shapes.into_iter().find(|found| found.mesh.file == file);
    let bytes = named.and_then(|found| input::read(&found.path).ok());
    bytes.ok_or_else(|| {
        let message = format!("the robot has no mesh `{file}`");
        StudyError::value(
            message,
            "mesh files must be in the folder of the URDF or in the folder of the study",
        )
    })
}
