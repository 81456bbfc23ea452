//! A robot written for other programs: `armill export`.

use std::path::Path;

use armill_formats::robot::RobotDescription;
use armill_formats::robot::export::{
    ExportError, ExportFormat, ExportOptions, Exported, ExportedMesh, export,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::StudyError;
use crate::input::cell::links::attachment_of;
use crate::link_meshes::named_meshes;

/// What came of a robot, as JSON.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExportedRobotAnswer {
    /// The files that were written; none if they were printed.
    pub files: Vec<String>,
    /// The text of the file, if it was printed.
    pub text: Option<String>,
    /// The text of the file of arguments that belongs to it, if it was printed.
    pub arguments: Option<String>,
    /// The format.
    pub format: &'static str,
    /// Manufacturer and type.
    pub title: String,
    /// Names of the joints, base to flange.
    pub joints: Vec<String>,
    /// What the file does not express, and what was assumed.
    pub warnings: Vec<String>,
}

impl ExportedRobotAnswer {
    /// What came of `found`; `files` are those that were written.
    pub fn of(
        found: &RobotDescription,
        format: ExportFormat,
        exported: &Exported,
        files: Vec<String>,
    ) -> ExportedRobotAnswer {
        let printed = files.is_empty();
        ExportedRobotAnswer {
            text: printed.then(|| exported.text.clone()),
            arguments: exported.arguments.clone().filter(|_| printed),
            files,
            format: format.name(),
            title: found.title.clone(),
            joints: found
                .robot
                .joints()
                .iter()
                .map(|joint| joint.name.clone())
                .collect(),
            warnings: exported.warnings.clone(),
        }
    }
}

/// The robot `found`, which the user called `name`, in this format; with the meshes that its file names.
///
/// # Errors
/// What the format cannot express, see [`ExportError`].
pub fn exported(
    name: &str,
    found: &RobotDescription,
    format: ExportFormat,
    options: ExportOptions,
) -> Result<Exported, StudyError> {
    let meshes = meshes(name, found);
    let is_relative = |mesh: &ExportedMesh| !mesh.file.contains("://") && !mesh.file.starts_with('/');
    let relative = meshes
        .iter()
        .find(|mesh| is_relative(mesh))
        .map(|mesh| mesh.file.clone());
    let mut exported = export(found, format, &ExportOptions { meshes, ..options }).map_err(refused)?;
    let has_meshes = matches!(
        format,
        ExportFormat::Urdf | ExportFormat::Xacro | ExportFormat::Sdf
    );
    if let Some(file) = relative.filter(|_| has_meshes) {
        exported.warnings.push(format!(
            "links are drawn only if the file is in the folder of its source: the path `{file}` of a mesh is relative to it"
        ));
    }
    Ok(exported)
}

/// The meshes of the links, with what they move with.
fn meshes(name: &str, found: &RobotDescription) -> Vec<ExportedMesh> {
    let meshes = named_meshes(name, Path::new(".")).into_iter();
    let placed = meshes.map(|mesh| {
        let (attachment, attachment_from_mesh) = attachment_of(found, &mesh);
        ExportedMesh {
            attachment,
            attachment_from_mesh,
            file: mesh.file,
            scale: mesh.scale,
            looks: mesh.looks,
        }
    });
    placed.collect()
}

/// The error with its hint.
pub fn refused(error: ExportError) -> StudyError {
    StudyError::value(error.to_string(), error.hint())
}
