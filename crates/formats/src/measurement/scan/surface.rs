//! Meshes and point clouds: the vertices are the points; normals are those of the file, else the mean of the normals of the
//! triangles around a vertex, weighted with their area.

use armill_core::nalgebra::Vector3;

use super::measured::{EMPTY_HINT, Scan, ScanFormat, ScanReadOptions, normal_of, point_of};
use crate::document::{Problem, Problems};
use crate::measurement::profile::LengthUnit;
use crate::mesh::{self, MeshFormat, TriangleMesh};

/// The points of a mesh or a PLY file without faces.
///
/// # Errors
/// Those of the mesh; a unit that contradicts that of the file; no points.
pub(super) fn read(shown: &str, bytes: &[u8], given: &ScanReadOptions) -> Result<Scan, Problems> {
    let mut scan = Scan::empty(ScanFormat::Surface);
    let is_ply = bytes.starts_with(b"ply") || MeshFormat::of_path(shown.as_ref()) == Some(MeshFormat::Ply);
    if is_ply {
        let cloud = mesh::read_ply_points(shown, bytes)?;
        if cloud.normals.is_some() || !cloud.has_faces {
            let factor = super::measured::unit_of(given, &mut scan);
            add(shown, &cloud.points, factor, &mut scan)?;
            scan.normals = cloud.normals.into_iter().flatten().map(normal_of).collect();
            return Ok(scan.finished());
        }
    }
    let surface = mesh::read(shown, bytes)?;
    let factor = match (surface.unit, given.unit) {
        (Some(unit), None) => unit.metres(),
        (None, _) => super::measured::unit_of(given, &mut scan),
        (Some(unit), Some(other)) => {
            if (unit.metres() - LengthUnit::factor(other)).abs() > 1e-9 * unit.metres() {
                let message = format!(
                    "the unit {other} was specified, but the file is in units of {} m",
                    unit.metres()
                );
                return Err(Problem::of_file(shown, message, "leave out the unit").into());
            }
            unit.metres()
        }
    };
    add(shown, &surface.vertices, factor, &mut scan)?;
    scan.normals = vertex_normals(&surface);
    scan.notes.extend(surface.notes.iter().cloned());
    Ok(scan.finished())
}

/// Adds points in file units.
fn add(shown: &str, points: &[[f64; 3]], factor: f64, scan: &mut Scan) -> Result<(), Problems> {
    if points.is_empty() {
        return Err(Problem::of_file(shown, "the file has no points", EMPTY_HINT).into());
    }
    scan.points.reserve(points.len());
    for point in points {
        let point = point_of(point.map(|x| x * factor));
        let hint = "check the unit of the file";
        scan.points
            .push(point.map_err(|message| Problem::of_file(shown, message, hint))?);
    }
    Ok(())
}

/// The normal of each vertex; `None` where triangles cancel.
fn vertex_normals(mesh: &TriangleMesh) -> Vec<Option<Vector3<f64>>> {
    let mut sums = vec![Vector3::zeros(); mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| Vector3::from(mesh.vertices[vertex as usize]));
        let twice_the_area = (b - a).cross(&(c - a));
        for vertex in triangle {
            sums[*vertex as usize] += twice_the_area;
        }
    }
    sums.iter().map(|sum| sum.try_normalize(0.0)).collect()
}
