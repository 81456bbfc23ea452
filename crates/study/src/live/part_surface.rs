//! The surface of the machined part of a path as a page draws it: one header and columns of numbers, without text for each vertex.
//!
//! | bytes | content |
//! |---|---|
//! | 4 | length of the header, little-endian |
//! | header | [`PartSurfaceHeader`] as JSON, filled with spaces to a multiple of 4 bytes with its length |
//! | each column | numbers of 4 bytes, little-endian, one vertex (or triangle) after the other |
//!
//! | column | content |
//! |---|---|
//! | `triangles` | three vertices each, counter-clockwise seen from outside; whole numbers |
//! | `xyz_mm` | vertices, frame of the program |
//! | `normal` | out of the material: x, y, z in three signed bytes, 127 for 1, and a fourth that is 0 |
//! | `point` | the point of the path whose move made the surface, from 0; whole number, -1 of the stock and where it is not known |
//! | `deviation_um`, `u_um` | deviation from the nominal surface along the normal and its standard uncertainty; only of the finished part |
//! | `measured_um`, `measured_less_predicted_um` | deviation of a scan, and what it differs from the prediction after the same alignment |
//!
//! Values that are not known are NaN.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::removal::SurfaceMesh;
use armill_core::units::{to_mm, to_um};
use armill_report::PartView;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::machined_part::MachinedPart;
use crate::analysis::path::machined_part::answer::MachinedPartAnswer;
use crate::error::StudyError;
use crate::live::bodies::BodyPose;

/// What is before the columns.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PartSurfaceHeader {
    /// Points of the path that are cut.
    pub points: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Where the frame of the program is, base.
    pub program: BodyPose,
    /// The columns, in their order.
    pub columns: Vec<SurfaceColumnInView>,
    /// The answer of the finished part; `null` of a part in process.
    pub part: Option<MachinedPartAnswer>,
}

/// A column.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SurfaceColumnInView {
    /// Its key.
    pub key: &'static str,
    /// Numbers of 4 bytes for each vertex, of `triangles` for each triangle.
    pub components: usize,
    /// Of a deviation: the range of its colours on both sides of zero, as in pictures; `null` where no value is known.
    pub range_um: Option<f64>,
}

/// Columns and their bytes.
struct Columns {
    about: Vec<SurfaceColumnInView>,
    bytes: Vec<u8>,
}

/// What every surface has.
struct Shape<'a> {
    vertices: &'a [Point3<f64>],
    normals: &'a [Vector3<f64>],
    triangles: &'a [[u32; 3]],
}

impl Columns {
    fn of(shape: &Shape<'_>, made_by: impl Iterator<Item = Option<u32>>) -> Columns {
        let mut columns = Columns {
            about: Vec::new(),
            bytes: Vec::new(),
        };
        columns.add(
            "triangles",
            3,
            shape.triangles.iter().flatten().map(|v| v.to_le_bytes()),
        );
        let xyz = shape
            .vertices
            .iter()
            .flat_map(|at| <[f64; 3]>::from(at.coords.map(to_mm)));
        columns.add("xyz_mm", 3, xyz.map(|mm| (mm as f32).to_le_bytes()));
        columns.add("normal", 1, shape.normals.iter().map(packed));
        let point = |index: Option<u32>| index.and_then(|index| i32::try_from(index).ok()).unwrap_or(-1);
        columns.add("point", 1, made_by.map(|index| point(index).to_le_bytes()));
        columns
    }

    fn add(&mut self, key: &'static str, components: usize, values: impl Iterator<Item = [u8; 4]>) {
        self.bytes.extend(values.flatten());
        self.about.push(SurfaceColumnInView {
            key,
            components,
            range_um: None,
        });
    }

    /// A column of lengths (m), in um.
    fn add_um(&mut self, key: &'static str, values: &[f64]) {
        self.add(key, 1, values.iter().map(|m| (to_um(*m) as f32).to_le_bytes()));
        if let Some(column) = self.about.last_mut().filter(|_| key != "u_um") {
            let um: Vec<f64> = values.iter().map(|m| to_um(*m)).collect();
            column.range_um = PartView::colour_limit(&um);
        }
    }

    /// Header and columns.
    fn finished(self, header: PartSurfaceHeader) -> Result<Vec<u8>, StudyError> {
        let header = PartSurfaceHeader {
            columns: self.about,
            ..header
        };
        let mut json = serde_json::to_vec(&header)?;
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = (json.len() as u32).to_le_bytes().to_vec();
        bytes.extend(json);
        bytes.extend(self.bytes);
        Ok(bytes)
    }
}

fn pose_of(pose: &Isometry) -> BodyPose {
    BodyPose::of(&pose.translation.vector.into(), &pose.rotation)
}

/// A unit vector in three signed bytes.
fn packed(normal: &Vector3<f64>) -> [u8; 4] {
    let byte = |component: f64| ((127.0 * component).round() as i8).to_le_bytes()[0];
    [byte(normal.x), byte(normal.y), byte(normal.z), 0]
}

/// The finished part with its deviations and its answer; `points`: those of the path.
///
/// # Errors
/// An answer that cannot be written as JSON.
pub(super) fn finished_surface(
    part: &MachinedPart,
    answer: Option<MachinedPartAnswer>,
    points: usize,
) -> Result<Vec<u8>, StudyError> {
    let mesh = &part.mesh;
    let shape = Shape {
        vertices: &mesh.vertices,
        normals: &mesh.normals,
        triangles: &mesh.triangles,
    };
    // A circle is closed with its first point.
    let made_by = mesh
        .made_by
        .iter()
        .map(|index| index.map(|index| index % points.max(1) as u32));
    let mut columns = Columns::of(&shape, made_by);
    columns.add_um("deviation_um", &mesh.deviations);
    columns.add_um("u_um", &mesh.uncertainties);
    if let Some(scan) = part.scan.as_ref().map(|scan| &scan.comparison) {
        let at = |value: &dyn Fn(usize) -> f64| scan.at_vertices(mesh.vertices.len(), value);
        columns.add_um("measured_um", &at(&|point| scan.measured[point]));
        let difference = at(&|point| scan.measured[point] - scan.predicted[point]);
        columns.add_um("measured_less_predicted_um", &difference);
    }
    columns.finished(PartSurfaceHeader {
        points,
        vertices: mesh.vertices.len(),
        triangles: mesh.triangles.len(),
        program: pose_of(&part.track.placing.base_from_path),
        columns: Vec::new(),
        part: answer,
    })
}

/// The part after the first `points` points of its path.
///
/// # Errors
/// A header that cannot be written as JSON.
pub(super) fn in_process_surface(
    mesh: &SurfaceMesh,
    base_from_program: &Isometry,
    points: usize,
) -> Result<Vec<u8>, StudyError> {
    let shape = Shape {
        vertices: &mesh.vertices,
        normals: &mesh.normals,
        triangles: &mesh.triangles,
    };
    let made_by = |vertex: usize| {
        let mut of_vertex = mesh.points_of(vertex).iter();
        let index = of_vertex.find_map(|point| mesh.points[*point as usize].origin.move_index());
        index.map(|index| index as u32)
    };
    let columns = Columns::of(&shape, (0..mesh.vertices.len()).map(made_by));
    columns.finished(PartSurfaceHeader {
        points,
        vertices: mesh.vertices.len(),
        triangles: mesh.triangles.len(),
        program: pose_of(base_from_program),
        columns: Vec::new(),
        part: None,
    })
}
