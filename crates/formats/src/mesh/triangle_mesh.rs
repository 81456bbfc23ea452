//! A mesh as it was read, in the unit of its file.

use super::unit::MeshUnit;

/// Triangles with shared vertices, in the unit and in the axes of the file.
///
/// Vertices at exactly the same place are one; each is used. A coordinate below 1e-10 of the largest one is 0. Not checked: whether the mesh is closed, and whether
/// triangles cross each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Places, file units.
    pub vertices: Vec<[f64; 3]>,
    /// Indices of the three vertices of each triangle, counter-clockwise seen from outside. None is without area.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles with three different vertices on one line. They have no area, but without them a closed mesh would have
    /// open edges: only [`TriangleMesh::report`] uses them.
    pub without_area: Vec<[u32; 3]>,
    /// How many triangles were dropped, since two of their vertices are at the same place.
    pub collapsed: usize,
    /// The unit, if the file gives it.
    pub unit: Option<MeshUnit>,
    /// What the reader assumed or left out, one sentence each.
    pub notes: Vec<String>,
}

/// Points without triangles, in the unit and in the axes of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Places, file units.
    pub points: Vec<[f64; 3]>,
    /// A normal of each point as the file gives it; `None` if it has none.
    pub normals: Option<Vec<[f64; 3]>>,
    /// Whether the file has faces too.
    pub has_faces: bool,
}

impl TriangleMesh {
    /// Smallest and largest coordinates, file units; zeros for a mesh without vertices.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let Some(first) = self.vertices.first() else {
            return [[0.0; 3]; 2];
        };
        let mut bounds = [*first; 2];
        for vertex in &self.vertices {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(vertex[axis]);
                bounds[1][axis] = bounds[1][axis].max(vertex[axis]);
            }
        }
        bounds
    }

    /// Length of the longest side of the bounds, file units.
    pub fn longest_side(&self) -> f64 {
        let [min, max] = self.bounds();
        (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max)
    }

    /// The three corners of a triangle.
    pub(super) fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|vertex| self.vertices[vertex as usize])
    }
}
