//! Triangles and polygons of a file, one after the other, as a mesh.
//!
//! | step | reason |
//! |---|---|
//! | a coordinate below 1e-10 of the largest one of the file is 0 | CAD systems write 6e-18 next to 0 (rounding of cos 90 deg), which would open edges |
//! | corners at exactly the same place become one vertex | STL has no shared vertices, and exporters of other formats split them |
//! | a triangle with two corners at one place is dropped and counted | it has no normal; without it all edges remain paired |
//! | a triangle with its corners on one line is kept apart | it has no normal, but a closed mesh needs its edges |
//! | vertices that no triangle uses are dropped | bounds are those of the surface |

use std::collections::HashMap;

use super::polygon::{PolygonFault, is_straight, triangles_of};
use super::triangle_mesh::TriangleMesh;
use crate::document::{Problem, Problems};

/// A file may have this many triangles.
pub const MOST_TRIANGLES: usize = 5_000_000;
/// No coordinate may be larger, file units: 1 km in um.
pub const LARGEST_COORDINATE: f64 = 1e9;

/// A coordinate below this part of the largest one is rounding: that of numbers of 32 bits is 6e-8.
const ROUNDING: f64 = 1e-10;

/// What to do about too many triangles.
pub(super) const REDUCE: &str = "export it with a coarser tolerance, or split it";

/// The mesh so far.
#[derive(Default)]
pub(super) struct Assembly {
    mesh: TriangleMesh,
    /// The vertex at a place, by the bits of its coordinates.
    places: HashMap<[u64; 3], u32>,
    /// Work for polygons that are not convex.
    comparisons: u64,
}

/// Why a triangle or polygon is not accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refusal {
    /// The file has more than [`MOST_TRIANGLES`]: reading ends here.
    TooManyTriangles,
    /// A polygon without triangles.
    Polygon(PolygonFault),
}

impl Refusal {
    /// What is wrong.
    pub fn message(self) -> String {
        match self {
            Refusal::TooManyTriangles => format!("more than {MOST_TRIANGLES} triangles"),
            Refusal::Polygon(fault) => fault.message(),
        }
    }

    /// What to do about it.
    pub fn hint(self) -> &'static str {
        match self {
            Refusal::TooManyTriangles => REDUCE,
            Refusal::Polygon(_) => "export the mesh with triangles only",
        }
    }

    /// Whether nothing that follows can be accepted.
    pub fn is_final(self) -> bool {
        matches!(
            self,
            Refusal::TooManyTriangles | Refusal::Polygon(PolygonFault::TooMuchWork)
        )
    }
}

impl Assembly {
    /// The vertex at this place; not checked: that its coordinates are finite.
    pub fn vertex(&mut self, place: [f64; 3]) -> u32 {
        // The sum makes 0 of -0.
        let place = place.map(|value| value + 0.0);
        let next = self.mesh.vertices.len() as u32;
        let vertex = *self.places.entry(place.map(f64::to_bits)).or_insert(next);
        if vertex == next {
            self.mesh.vertices.push(place);
        }
        vertex
    }

    /// Triangles so far, with those that were dropped.
    pub fn triangles(&self) -> usize {
        self.mesh.triangles.len() + self.mesh.without_area.len() + self.mesh.collapsed
    }

    /// Adds a triangle of these vertices.
    ///
    /// # Errors
    /// Too many triangles.
    pub fn triangle(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Refusal> {
        if self.triangles() == MOST_TRIANGLES {
            return Err(Refusal::TooManyTriangles);
        }
        if a == b || b == c || c == a {
            self.mesh.collapsed += 1;
            return Ok(());
        }
        let [p, q, r] = self.mesh.corners([a, b, c]);
        match is_straight(p, q, r) {
            true => self.mesh.without_area.push([a, b, c]),
            false => self.mesh.triangles.push([a, b, c]),
        }
        Ok(())
    }

    /// Adds the triangles of a polygon of at least three vertices.
    ///
    /// # Errors
    /// Too many triangles; a polygon that has none.
    pub fn polygon(&mut self, polygon: &[u32]) -> Result<(), Refusal> {
        if let [a, b, c] = *polygon {
            return self.triangle([a, b, c]);
        }
        let corners: Vec<[f64; 3]> = polygon
            .iter()
            .map(|vertex| self.mesh.vertices[*vertex as usize])
            .collect();
        let triangles = triangles_of(&corners, &mut self.comparisons).map_err(Refusal::Polygon)?;
        triangles
            .into_iter()
            .try_for_each(|triangle| self.triangle(triangle.map(|at| polygon[at])))
    }

    /// The same with 0 for every coordinate that is not 0 by rounding alone.
    fn without_rounding(self) -> Assembly {
        let coordinates = self.mesh.vertices.as_flattened();
        let largest = coordinates
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let is_rounding = |value: f64| value != 0.0 && value.abs() < ROUNDING * largest;
        if !coordinates.iter().any(|value| is_rounding(*value)) {
            return self;
        }
        let mut rounded = Assembly::default();
        rounded.mesh.collapsed = self.mesh.collapsed;
        let vertices: Vec<u32> = self
            .mesh
            .vertices
            .iter()
            .map(|place| rounded.vertex(place.map(|value| if is_rounding(value) { 0.0 } else { value })))
            .collect();
        for triangle in self.mesh.triangles.iter().chain(&self.mesh.without_area) {
            // There are not more of them than before.
            let _ = rounded.triangle(triangle.map(|vertex| vertices[vertex as usize]));
        }
        rounded
    }

    /// The mesh; `name` is the file that problems show.
    ///
    /// # Errors
    /// No triangle with an area.
    pub fn finish(self, name: &str) -> Result<TriangleMesh, Problems> {
        let count = self.triangles();
        let mut mesh = self.without_rounding().mesh;
        if mesh.triangles.is_empty() {
            let message = match count {
                0 => "the mesh has no triangles".to_owned(),
                _ => format!("all {count} triangles of the mesh have no area"),
            };
            return Err(Problem::of_file(name, message, "export the surface of a body").into());
        }
        drop_unused(&mut mesh);
        Ok(mesh)
    }
}

/// Removes the vertices that no triangle uses.
fn drop_unused(mesh: &mut TriangleMesh) {
    let mut used = vec![false; mesh.vertices.len()];
    let corners = mesh.triangles.iter().chain(&mesh.without_area).flatten();
    corners.for_each(|vertex| used[*vertex as usize] = true);
    if used.iter().all(|used| *used) {
        return;
    }
    let mut next = 0;
    let moved: Vec<u32> = used
        .iter()
        .map(|used| {
            let index = next;
            next += u32::from(*used);
            index
        })
        .collect();
    let corners = mesh.triangles.iter_mut().chain(&mut mesh.without_area).flatten();
    corners.for_each(|vertex| *vertex = moved[*vertex as usize]);
    let mut index = 0;
    mesh.vertices.retain(|_| {
        index += 1;
        used[index - 1]
    });
}

/// The points of an object, which its faces refer to by index: each becomes a vertex at its first use.
pub(super) struct Points<'a> {
    points: &'a [[f64; 3]],
    vertices: Vec<Option<u32>>,
}

impl<'a> Points<'a> {
    /// These points, none of them used.
    pub fn new(points: &'a [[f64; 3]]) -> Points<'a> {
        Points {
            points,
            vertices: vec![None; points.len()],
        }
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The vertex of the point with this index; `None` if there is no such point.
    pub fn vertex(&mut self, index: usize, assembly: &mut Assembly) -> Option<u32> {
        let vertex = self.vertices.get_mut(index)?;
        Some(*vertex.get_or_insert_with(|| assembly.vertex(self.points[index])))
    }
}

/// A coordinate that can be calculated with.
///
/// # Errors
/// Not finite, or larger than [`LARGEST_COORDINATE`]: what is wrong.
pub(super) fn checked(value: f64) -> Result<f64, String> {
    if !value.is_finite() {
        return Err(format!("{value} is not a finite number"));
    }
    if value.abs() > LARGEST_COORDINATE {
        return Err(format!(
            "{value:e} exceeds the largest coordinate of {LARGEST_COORDINATE:e} file units"
        ));
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assembled(triangles: &[[[f64; 3]; 3]]) -> Result<TriangleMesh, Problems> {
        let mut assembly = Assembly::default();
        for corners in triangles {
            let vertices = corners.map(|corner| assembly.vertex(corner));
            assembly.triangle(vertices).unwrap();
        }
        assembly.finish("a.stl")
    }

    const GOOD: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn corners_at_the_same_place_are_one_vertex_also_with_a_negative_zero() {
        let other = [[1.0, 0.0, -0.0], [-0.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        let mesh = assembled(&[GOOD, other]).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 0, 3]]);
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn a_coordinate_that_is_zero_but_for_rounding_is_zero() {
        let other = [[1.0, 6e-18, 0.0], [-3e-17, 0.0, 9e-11], [0.0, -1.0, 0.0]];
        let thin = [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-14], [1.0, 0.0, 0.0]];
        let mesh = assembled(&[GOOD, other, thin]).unwrap();
        assert_eq!(
            (mesh.vertices.len(), mesh.triangles.len(), mesh.collapsed),
            (4, 2, 1)
        );
        assert!(
            mesh.vertices
                .as_flattened()
                .iter()
                .all(|value| *value == value.round())
        );
        let small = GOOD.map(|corner| corner.map(|value| value * 1e-15));
        assert_eq!(assembled(&[small]).unwrap().triangles.len(), 1);
        let near = [[1.0, 2e-10, 0.0], [0.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        assert_eq!(assembled(&[GOOD, near]).unwrap().vertices.len(), 5);
    }

    #[test]
    fn triangles_without_area_are_dropped_or_kept_apart_with_their_vertices() {
        let collapsed = [[9.0, 9.0, 9.0], [9.0, 9.0, 9.0], [1.0, 0.0, 0.0]];
        let straight = [[0.0, 0.0, 0.0], [0.3, 0.1, 0.7], [0.9, 0.3, 2.1]];
        let mesh = assembled(&[collapsed, straight, GOOD]).unwrap();
        assert_eq!((mesh.collapsed, mesh.without_area.len()), (1, 1));
        assert_eq!(mesh.vertices.len(), 5, "that at 9 9 9 is not used");
        assert_eq!(mesh.corners(mesh.triangles[0]), GOOD);
        assert_eq!(mesh.corners(mesh.without_area[0]), straight);
    }

    #[test]
    fn a_mesh_without_area_is_refused() {
        let given = assembled(&[]).unwrap_err().to_string();
        assert!(given.contains("a.stl:1:1: the mesh has no triangles"), "{given}");
        let given = assembled(&[[[1.0; 3]; 3]]).unwrap_err().to_string();
        assert!(
            given.contains("all 1 triangles of the mesh have no area"),
            "{given}"
        );
    }

    #[test]
    fn the_limit_of_triangles_is_the_last_that_is_accepted() {
        let mut assembly = Assembly::default();
        let same = assembly.vertex([0.0; 3]);
        // Those that collapse count, too.
        for _ in 0..MOST_TRIANGLES {
            assembly.triangle([same; 3]).unwrap();
        }
        assert_eq!(assembly.triangle([same; 3]), Err(Refusal::TooManyTriangles));
        assert_eq!(Refusal::TooManyTriangles.message(), "more than 5000000 triangles");
    }

    #[test]
    fn coordinates_are_finite_and_not_too_large() {
        assert_eq!(checked(-1e9), Ok(-1e9));
        assert_eq!(checked(f64::NAN).unwrap_err(), "NaN is not a finite number");
        assert_eq!(
            checked(1e30).unwrap_err(),
            "1e30 exceeds the largest coordinate of 1e9 file units"
        );
    }
}
