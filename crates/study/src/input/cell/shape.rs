//! The shape of a body from its table; meshes are read from their files.

use std::path::Path;
use std::sync::Arc;

use armill_core::clearance::{Mesh, Shape};
use armill_core::nalgebra::Point3;
use armill_core::units::to_mm;
use armill_formats::mesh::{self, MeshUnit, TriangleMesh, likely_unit};

use crate::error::StudyError;
use crate::input::cell::tables::ShapeKeys;
use crate::input::problem_log::ProblemLog;
use crate::number::decimals;

/// Sizes of a mesh that are expected, m: others have another unit.
const LEAST_SIZE: f64 = 1e-3;
const GREATEST_SIZE: f64 = 100.0;

fn shown_mm(m: f64) -> f64 {
    decimals(to_mm(m), 3)
}

/// A shape, and what a user should know of it.
pub struct BodyShape {
    /// The shape, m, in the frame of its coordinates.
    pub shape: Shape,
    /// Notes on a mesh: what its reader left out, or that it is open.
    pub notes: Vec<String>,
}

/// The shape that these keys give; `None` if they are wrong, reported below `path`. Meshes are looked for in `folder`.
///
/// # Errors
/// The problems of a mesh file.
pub fn shape_of(
    log: &mut ProblemLog<'_>,
    path: &str,
    keys: ShapeKeys<'_>,
    folder: &Path,
) -> Result<Option<BodyShape>, StudyError> {
    let given = [
        ("box_mm", keys.box_mm.is_some()),
        ("cylinder_mm", keys.cylinder_mm.is_some()),
        ("capsule_mm", keys.capsule_mm.is_some()),
        ("mesh", keys.mesh.is_some()),
    ];
    let names: Vec<&str> = given
        .iter()
        .filter(|(_, given)| *given)
        .map(|(name, _)| *name)
        .collect();
    if names.len() != 1 {
        let message = match names.as_slice() {
            [] => format!("`{path}` has no shape"),
            several => format!("`{path}` has {} shapes: {}", several.len(), several.join(", ")),
        };
        log.problem(
            path,
            message,
            "exactly one of box_mm, cylinder_mm, capsule_mm, mesh",
        );
        return Ok(None);
    }
    if keys.mesh_unit.is_some() && keys.mesh.is_none() {
        let key = format!("{path}.mesh_unit");
        log.problem(
            &key,
            "`mesh_unit` without a mesh",
            "box_mm, cylinder_mm and capsule_mm are in mm",
        );
    }
    let plain = match (keys.box_mm, keys.cylinder_mm, keys.capsule_mm) {
        (Some(table), _, _) => Some(table.shape()),
        (_, Some(table), _) => Some(table.cylinder()),
        (_, _, Some(table)) => Some(Ok(table.capsule())),
        _ => None,
    };
    match (plain, keys.mesh) {
        (Some(Ok(shape)), _) => Ok(Some(BodyShape {
            shape,
            notes: Vec::new(),
        })),
        (Some(Err((message, hint))), _) => {
            log.problem(&format!("{path}.{}", names[0]), message, hint);
            Ok(None)
        }
        (None, Some(file)) => from_file(log, path, file, keys, folder),
        (None, None) => Ok(None),
    }
}

/// The mesh of this file.
fn from_file(
    log: &mut ProblemLog<'_>,
    path: &str,
    file: &str,
    keys: ShapeKeys<'_>,
    folder: &Path,
) -> Result<Option<BodyShape>, StudyError> {
    let shown = folder.join(file);
    let bytes = match armill_formats::input::read(&shown) {
        Ok(bytes) => bytes,
        Err(error) => {
            let message = format!("cannot read `{}`: {error}", shown.display());
            log.problem(
                &format!("{path}.mesh"),
                message,
                "the path of a mesh file relative to the study",
            );
            return Ok(None);
        }
    };
    let read = mesh::read(&shown.display().to_string(), &bytes)?;
    let Some(metres) = unit_of(log, path, file, keys, &read) else {
        return Ok(None);
    };
    let longest = read.longest_side() * metres;
    if !(LEAST_SIZE..=GREATEST_SIZE).contains(&longest) {
        let message = format!(
            "the longest side of `{file}` is {} mm: sizes from {} mm to {} mm are expected",
            shown_mm(longest),
            shown_mm(LEAST_SIZE),
            shown_mm(GREATEST_SIZE)
        );
        let hint = "is its unit right? mesh_unit = \"mm\", \"m\" or \"inch\" replaces that of the file";
        log.problem(&format!("{path}.mesh"), message, hint);
        return Ok(None);
    }
    let report = read.report();
    let Some(mesh) = mesh_of(&read, [metres; 3], report.is_closed) else {
        log.problem(
            &format!("{path}.mesh"),
            format!("`{file}` has no triangle"),
            "another file",
        );
        return Ok(None);
    };
    let mut notes: Vec<String> = read.notes.iter().map(|note| format!("{file}: {note}")).collect();
    if !report.is_closed {
        notes.push(format!(
            "{file} is an open mesh ({} open edges): it counts as a surface, and what is behind it is not found.",
            report.open_edges
        ));
    }
    Ok(Some(BodyShape {
        shape: Shape::Mesh(Arc::new(mesh)),
        notes,
    }))
}

/// Length of the unit of a mesh, m: that of the study, else that of the file, else millimetres if these are likely.
fn unit_of(
    log: &mut ProblemLog<'_>,
    path: &str,
    file: &str,
    keys: ShapeKeys<'_>,
    read: &TriangleMesh,
) -> Option<f64> {
    if let Some(unit) = keys.mesh_unit {
        return Some(unit.metres());
    }
    if let Some(unit) = read.unit {
        return Some(unit.metres());
    }
    let millimetre = MeshUnit::millimetre();
    let longest = read.longest_side();
    if likely_unit(longest) == Some(millimetre) {
        return Some(millimetre.metres());
    }
    let message = format!("the unit of `{file}` is not known: its longest side is {longest:.4}");
    log.problem(
        &format!("{path}.mesh"),
        message,
        "add mesh_unit = \"mm\", \"m\" or \"inch\"",
    );
    None
}

/// The triangles with these factors along the axes of the file; `None` without any.
pub fn mesh_of(read: &TriangleMesh, scale: [f64; 3], closed: bool) -> Option<Mesh> {
    let corner = |vertex: u32| {
        let at = read.vertices[vertex as usize];
        Point3::from(std::array::from_fn::<f64, 3, _>(|axis| at[axis] * scale[axis]))
    };
    let triangles = read
        .triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect();
    Mesh::new(triangles, closed)
}
