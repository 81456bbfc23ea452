//! The surface of a part as triangles.

use nalgebra::{Point3, Vector3};

use super::surface::SurfacePoint;

/// Triangles of a surface, the vertices that they share, and the ends of dexels that made these.
///
/// Closed: each edge belongs to two triangles, which run through it in opposite directions. Not checked: whether triangles cross each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// Frame of the part, m.
    pub vertices: Vec<Point3<f64>>,
    /// Out of the material, unit vectors: mean of the normals of the crossings around a vertex.
    pub normals: Vec<Vector3<f64>>,
    /// Three vertices each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of dexels at the crossings of the lattice.
    pub points: Vec<SurfacePoint>,
    /// The points of all vertices, one after the other.
    pub point_numbers: Vec<u32>,
    /// For each vertex where its points begin in `point_numbers`; and their end.
    pub point_starts: Vec<u32>,
}

impl SurfaceMesh {
    /// The numbers of the points that a vertex is made from; none where dexels of two directions disagree, and on walls of a part with z dexels alone.
    pub fn points_of(&self, vertex: usize) -> &[u32] {
        let start = |n: usize| self.point_starts.get(n).map(|start| *start as usize);
        let range = start(vertex).zip(start(vertex + 1));
        range
            .and_then(|(start, end)| self.point_numbers.get(start..end))
            .unwrap_or_default()
    }

    /// For each vertex the mean of the values of its points; points without a value (NaN, or beyond the list) are left out, and a vertex
    /// without any has none.
    pub fn vertex_values(&self, of_points: &[f64]) -> Vec<Option<f64>> {
        let of_vertex = |vertex: usize| {
            let values = self
                .points_of(vertex)
                .iter()
                .filter_map(|point| of_points.get(*point as usize));
            let (mut sum, mut count) = (0.0, 0);
            for value in values.filter(|value| !value.is_nan()) {
                sum += value;
                count += 1;
            }
            (count > 0).then(|| sum / f64::from(count))
        };
        (0..self.vertices.len()).map(of_vertex).collect()
    }
}
