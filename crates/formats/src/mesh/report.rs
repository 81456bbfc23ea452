//! Whether a mesh encloses a volume, and which.
//!
//! ```text
//! edge:     triangles on each side of it     closed: as many in one direction as in the other, for every edge
//! volume:   sum of a . (b x c) / 6           a, b, c: corners of a triangle, relative to the centre of the bounds
//! ```
//!
//! Of a closed mesh the volume is exact (divergence theorem), and positive if triangles are counter-clockwise seen from
//! outside. Not checked: whether triangles cross each other.

use super::polygon::{cross, minus};
use super::triangle_mesh::TriangleMesh;

/// What checks of a mesh need. Lengths are in file units.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshReport {
    /// Triangles with an area.
    pub triangles: usize,
    /// Smallest coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
    /// Edges with one triangle: the rim of a hole.
    pub open_edges: usize,
    /// Edges with more than two triangles. A closed mesh has some where bodies touch along an edge.
    pub crowded_edges: usize,
    /// Whether the triangles at every edge with an even number of them have opposite directions.
    pub is_oriented: bool,
    /// Whether every edge has an even number of triangles.
    pub is_closed: bool,
    /// Signed volume, file units cubed; without meaning unless the mesh is closed and oriented. Negative: triangles are
    /// clockwise seen from outside.
    pub volume: f64,
    /// Area of all triangles, file units squared.
    pub area: f64,
}

impl TriangleMesh {
    /// Its edges, size and volume. Takes a second for some millions of triangles.
    pub fn report(&self) -> MeshReport {
        let [min, max] = self.bounds();
        let edges = edges(self);
        let centre = [0, 1, 2].map(|axis| min[axis] / 2.0 + max[axis] / 2.0);
        let (mut volume, mut area) = (0.0, 0.0);
        for triangle in &self.triangles {
            let [a, b, c] = self.corners(*triangle).map(|corner| minus(corner, centre));
            let normal = cross(minus(b, a), minus(c, a));
            volume += (a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]) / 6.0;
            area += (normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]).sqrt() / 2.0;
        }
        MeshReport {
            triangles: self.triangles.len(),
            min,
            max,
            open_edges: edges.open,
            crowded_edges: edges.crowded,
            is_oriented: !edges.opposed,
            is_closed: !edges.odd,
            volume,
            area,
        }
    }
}

/// Counts of edges.
#[derive(Default)]
struct Edges {
    open: usize,
    crowded: usize,
    /// Some edge has an odd number of triangles.
    odd: bool,
    /// Some edge has an even number of triangles, more of them in one direction.
    opposed: bool,
}

/// The edges of all triangles, those without area included.
fn edges(mesh: &TriangleMesh) -> Edges {
    // Both vertices, the smaller first, and the direction in the last bit.
    let triangles = mesh.triangles.iter().chain(&mesh.without_area);
    let mut sides: Vec<u64> = triangles
        .flat_map(|[a, b, c]| {
            [[a, b], [b, c], [c, a]].map(|[from, to]| {
                let [low, high] = [u64::from(*from.min(to)), u64::from(*from.max(to))];
                low << 33 | high << 1 | u64::from(from > to)
            })
        })
        .collect();
    sides.sort_unstable();
    let mut edges = Edges::default();
    for edge in sides.chunk_by(|one, other| one >> 1 == other >> 1) {
        let reversed = edge.iter().filter(|side| *side & 1 == 1).count();
        edges.open += usize::from(edge.len() == 1);
        edges.crowded += usize::from(edge.len() > 2);
        edges.odd |= edge.len() % 2 == 1;
        edges.opposed |= edge.len() % 2 == 0 && 2 * reversed != edge.len();
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::super::solids::{cube, mesh_of, tetrahedron};

    #[test]
    fn a_cube_has_the_volume_and_area_of_the_closed_form() {
        let report = mesh_of(&cube(3.0, [10.0, -20.0, 30.0])).report();
        assert_eq!(report.triangles, 12);
        assert_eq!(
            (report.min, report.max),
            ([10.0, -20.0, 30.0], [13.0, -17.0, 33.0])
        );
        assert!((report.volume - 27.0).abs() < 27.0 * 1e-14, "{report:?}");
        assert!((report.area - 54.0).abs() < 54.0 * 1e-14, "{report:?}");
        assert!(report.is_closed && report.is_oriented);
        assert_eq!((report.open_edges, report.crowded_edges), (0, 0));
    }

    #[test]
    fn a_tetrahedron_has_the_volume_and_area_of_the_closed_form() {
        // Corner of a cube of side 2: volume 2^3 / 6, area 3 * 2 + 2^2 * sqrt(3) / 2.
        let report = mesh_of(&tetrahedron(2.0)).report();
        assert!((report.volume - 8.0 / 6.0).abs() < 1e-14, "{report:?}");
        assert!(
            (report.area - (6.0 + 2.0 * 3.0_f64.sqrt())).abs() < 1e-14,
            "{report:?}"
        );
        assert!(report.is_closed && report.is_oriented);
    }

    #[test]
    fn an_open_cube_has_the_rim_of_its_hole_as_open_edges() {
        let report = mesh_of(&cube(1.0, [0.0; 3])[2..]).report();
        assert_eq!(
            (report.open_edges, report.is_closed, report.is_oriented),
            (4, false, true)
        );
        let one_missing = mesh_of(&cube(1.0, [0.0; 3])[1..]).report();
        assert_eq!((one_missing.open_edges, one_missing.is_closed), (3, false));
    }

    #[test]
    fn a_triangle_in_the_wrong_direction_is_found_and_an_inverted_mesh_has_a_negative_volume() {
        let mut turned = cube(1.0, [0.0; 3]);
        turned[5].reverse();
        let report = mesh_of(&turned).report();
        assert!(report.is_closed && !report.is_oriented);
        let mut inverted = cube(2.0, [0.0; 3]);
        inverted.iter_mut().for_each(|corners| corners.reverse());
        let report = mesh_of(&inverted).report();
        assert!(report.is_oriented && (report.volume + 8.0).abs() < 1e-14);
    }

    #[test]
    fn two_cubes_that_touch_along_an_edge_are_closed() {
        let mut both = cube(1.0, [0.0; 3]);
        both.extend(cube(1.0, [1.0, 1.0, 0.0]));
        let report = mesh_of(&both).report();
        assert_eq!((report.crowded_edges, report.open_edges), (1, 0));
        assert!(report.is_closed && report.is_oriented && (report.volume - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_mesh_with_a_corner_on_a_side_is_closed_by_its_triangle_without_area() {
        // One side of the tetrahedron has a corner in its middle for one of its faces only.
        let mut faces = tetrahedron(2.0);
        let [a, b, c] = faces.remove(0);
        let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0);
        faces.extend([[a, middle, c], [middle, b, c]]);
        assert!(!mesh_of(&faces).report().is_closed);
        faces.push([a, b, middle]);
        let report = mesh_of(&faces).report();
        assert!(report.is_closed && report.is_oriented, "{report:?}");
    }
}
