//! The meshes of bodies: binary STL files in mm, whatever the format of the file in which the study found them.
//!
//! A mesh is requested by a key made of its triangles. Only meshes that the cell of the analysis has are sent, and never the
//! bytes of a file.

use std::hash::{DefaultHasher, Hasher};

use armill_core::clearance::{Mesh, Shape};
use armill_core::nalgebra::Point3;
use armill_core::units::to_mm;

use crate::error::StudyError;
use crate::live::StudyText;

/// Triangles that are sent at most: 50 MB.
const MOST_TRIANGLES: usize = 1_000_000;
/// Bytes before the triangles: 80 of the header, 4 of their number.
const HEADER: usize = 84;
/// Bytes of a triangle: a normal and three corners of 4-byte numbers, and 2 bytes.
const TRIANGLE: usize = 50;

/// Identifies the triangles of a mesh.
pub(super) fn mesh_key(mesh: &Mesh) -> String {
    let mut hasher = DefaultHasher::new();
    for corner in mesh.triangles().iter().flat_map(|triangle| triangle.0) {
        for coordinate in corner.iter() {
            hasher.write_u64(coordinate.to_bits());
        }
    }
    format!("{:016x}", hasher.finish())
}

/// The mesh of a body of this analysis, or of the first, with this key: a binary STL file, mm, in the frame of the body.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no mesh with this key; one with more than a million triangles.
pub fn body_mesh(text: StudyText<'_>, analysis: Option<&str>, key: &str) -> Result<Vec<u8>, StudyError> {
    let edited = text.one_analysis(analysis)?;
    let cell = edited.setting(0)?.cell.as_ref();
    let shapes = cell.into_iter().flat_map(|cell| {
        let still = cell.still.iter().map(|body| &body.shape);
        cell.cell.arm().iter().map(|body| &body.shape).chain(still)
    });
    let mut meshes = shapes.filter_map(|shape| match shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    let Some(mesh) = meshes.find(|mesh| mesh_key(mesh) == key) else {
        let message = format!("no body of the analysis has a mesh with the key `{key}`");
        return Err(StudyError::value(
            message,
            "keys are in the scene of the analysis",
        ));
    };
    let count = mesh.triangles().len();
    if count > MOST_TRIANGLES {
        return Err(StudyError::value(
            format!("the mesh has {count} triangles"),
            format!("{MOST_TRIANGLES} are sent at most"),
        ));
    }
    Ok(stl(mesh))
}

/// A binary STL file, mm.
fn stl(mesh: &Mesh) -> Vec<u8> {
    let triangles = mesh.triangles();
    let mut bytes = vec![0; HEADER - 4];
    bytes.reserve(4 + TRIANGLE * triangles.len());
    bytes.extend_from_slice(&(triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let [a, b, c] = triangle.0;
        let normal = (b - a).cross(&(c - a));
        let normal = normal.try_normalize(0.0).unwrap_or_default();
        let corners = [a, b, c].map(|corner: Point3<f64>| to_mm(corner.coords));
        for vector in [&normal].into_iter().chain(&corners) {
            for coordinate in vector.iter() {
                bytes.extend_from_slice(&(*coordinate as f32).to_le_bytes());
            }
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(size: f64) -> Mesh {
        let [o, x, y, z] = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]].map(Point3::from);
        Mesh::new(vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]], true).unwrap()
    }

    #[test]
    fn the_stl_file_has_the_triangles_in_mm() {
        let mesh = tetrahedron(0.25);
        let bytes = stl(&mesh);
        assert_eq!(bytes.len(), 84 + 4 * 50);
        // As another reader sees it.
        let read = armill_formats::mesh::read("body.stl", &bytes).unwrap();
        let report = read.report();
        assert!(report.is_closed);
        assert_eq!((read.triangles.len(), read.longest_side()), (4, 250.0));
    }

    #[test]
    fn keys_are_those_of_the_triangles() {
        assert_eq!(mesh_key(&tetrahedron(0.25)), mesh_key(&tetrahedron(0.25)));
        assert_ne!(mesh_key(&tetrahedron(0.25)), mesh_key(&tetrahedron(0.26)));
    }
}
