//! The nominal surface of a part: the nearest place to a point, and the signed deviation from it.
//!
//! ```text
//! q   the place nearest to p;   d = s |p - q|,   s the sign of N(q) (p - q)
//! N   in a triangle its normal; on an edge the sum of the two normals; at a vertex their sum weighted with the angles there
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p`, `q` | measured point, foot point | m |
//! | `d` | deviation, above 0 outside of the part | m |
//!
//! With these pseudonormals the sign is right everywhere off the surface of a closed mesh. Triangles are counter-clockwise seen
//! from outside. Corners at exactly the same place are one vertex.
//! Source: J. Baerentzen, H. Aanaes, Signed distance computation using the angle weighted pseudonormal, IEEE TVCG 11, 2005.

use nalgebra::{Point3, Vector3};

use super::profile::NormalDeviation;
use crate::clearance::{Mesh, MeshPoint};

/// A weight of a corner below this is that of a place on the opposite edge.
const ON_EDGE: f64 = 1e-9;
/// Below this distance the direction from the surface is rounding, m.
const TOUCHING: f64 = 1e-9;

/// A triangle mesh with the normals of its triangles, edges and vertices.
#[derive(Clone, Debug)]
pub struct NominalSurface {
    mesh: Mesh,
    /// By the triangles of the mesh: vertices, and sums of normals of the edges opposite to them.
    vertices: Vec<[u32; 3]>,
    edge_normals: Vec<[Vector3<f64>; 3]>,
    /// By vertices.
    vertex_normals: Vec<Vector3<f64>>,
}

/// The foot point of a measured point, and its deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootPoint {
    /// Index of the triangle in [`Mesh::triangles`].
    pub triangle: usize,
    /// Deviation along the normal, and the foot point.
    pub deviation: NormalDeviation,
}

impl NominalSurface {
    /// The surface of these triangles, m; `None` without any triangle.
    pub fn new(triangles: Vec<[Point3<f64>; 3]>) -> Option<NominalSurface> {
        let mesh = Mesh::new(triangles, false)?;
        let corners: Vec<Point3<f64>> = mesh.triangles().iter().flat_map(|triangle| triangle.0).collect();
        let (of_corner, count) = joined(&corners);
        let vertices: Vec<[u32; 3]> = of_corner
            .chunks_exact(3)
            .map(|ids| [ids[0], ids[1], ids[2]])
            .collect();
        let normal = |triangle: usize| unit(mesh.triangles()[triangle].area_vector());
        let mut vertex_normals = vec![Vector3::zeros(); count];
        let mut edges: Vec<([u32; 2], u32, u32)> = Vec::with_capacity(corners.len());
        for (triangle, ids) in vertices.iter().enumerate() {
            let [a, b, c] = mesh.triangles()[triangle].0;
            for (k, [at, one, other]) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
                let angle = (one - at).angle(&(other - at));
                // Of a triangle without area it may not be a number.
                if angle.is_finite() {
                    vertex_normals[ids[k] as usize] += normal(triangle) * angle;
                }
                let (first, second) = (ids[(k + 1) % 3], ids[(k + 2) % 3]);
                edges.push(([first.min(second), first.max(second)], triangle as u32, k as u32));
            }
        }
        edges.sort_unstable();
        let mut edge_normals = vec![[Vector3::zeros(); 3]; vertices.len()];
        for same in edges.chunk_by(|one, other| one.0 == other.0) {
            let sum: Vector3<f64> = same.iter().map(|edge| normal(edge.1 as usize)).sum();
            for edge in same {
                edge_normals[edge.1 as usize][edge.2 as usize] = sum;
            }
        }
        Some(NominalSurface {
            mesh,
            vertices,
            edge_normals,
            vertex_normals,
        })
    }

    /// Its triangles, with a tree of boxes.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The foot point of `point`; `None` where the surface is farther than `limit`, m.
    pub fn foot(&self, point: &Point3<f64>, limit: f64) -> Option<FootPoint> {
        Some(self.foot_at(point, self.mesh.nearest_to_point(point, limit)?))
    }

    /// The same with a triangle that is likely near: fewer others are looked at.
    pub fn foot_near(&self, point: &Point3<f64>, limit: f64, guess: usize) -> Option<FootPoint> {
        let Some(triangle) = self.mesh.triangles().get(guess) else {
            return self.foot(point, limit);
        };
        let at = triangle.nearest_to_point(point);
        let guessed = (at - point).norm();
        let found = self.mesh.nearest_to_point(point, guessed.min(limit));
        let own = MeshPoint { triangle: guess, at };
        let found = found.or_else(|| (guessed <= limit).then_some(own))?;
        Some(self.foot_at(point, found))
    }

    fn foot_at(&self, point: &Point3<f64>, found: MeshPoint) -> FootPoint {
        let pseudonormal = self.pseudonormal(&found);
        let off = point - found.at;
        let distance = off.norm();
        let side = if off.dot(&pseudonormal) < 0.0 { -1.0 } else { 1.0 };
        let normal = match distance > TOUCHING {
            true => off * (side / distance),
            false => unit(pseudonormal),
        };
        FootPoint {
            triangle: found.triangle,
            deviation: NormalDeviation {
                at: found.at,
                normal,
                deviation: side * distance,
            },
        }
    }

    /// The normal of the triangle, edge or vertex at a place, of any length.
    fn pseudonormal(&self, found: &MeshPoint) -> Vector3<f64> {
        let triangle = &self.mesh.triangles()[found.triangle];
        let area = triangle.area_vector();
        let square = area.norm_squared();
        let [a, b, c] = triangle.0;
        let part = |one: Point3<f64>, other: Point3<f64>| {
            (one - found.at).cross(&(other - found.at)).dot(&area) / square
        };
        let parts = [part(b, c), part(c, a), part(a, b)];
        // Of a triangle without area the parts are not numbers, and it has no inside.
        let on_edge = parts.map(|part| part.is_nan() || part <= ON_EDGE);
        let is_vertex = |k: usize| on_edge[(k + 1) % 3] && on_edge[(k + 2) % 3];
        if let Some(k) = (0..3).find(|k| is_vertex(*k)) {
            return self.vertex_normals[self.vertices[found.triangle][k] as usize];
        }
        match on_edge.iter().position(|is_on| *is_on) {
            Some(k) => self.edge_normals[found.triangle][k],
            None => area,
        }
    }
}

/// The vector at length 1; zero stays zero.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector.try_normalize(0.0).unwrap_or_default()
}

/// The vertex of each corner, and the number of vertices: corners at the same place are one.
fn joined(corners: &[Point3<f64>]) -> (Vec<u32>, usize) {
    // -0 and 0 are one place.
    let key = |corner: u32| corners[corner as usize].coords.map(|x| x + 0.0);
    let compare = |one: &u32, other: &u32| {
        let (one, other) = (key(*one), key(*other));
        (one.x.total_cmp(&other.x))
            .then(one.y.total_cmp(&other.y))
            .then(one.z.total_cmp(&other.z))
    };
    let mut order: Vec<u32> = (0..corners.len() as u32).collect();
    order.sort_unstable_by(compare);
    let mut of_corner = vec![0; corners.len()];
    let mut count = 0;
    for same in order.chunk_by(|one, other| compare(one, other).is_eq()) {
        for corner in same {
            of_corner[*corner as usize] = count;
        }
        count += 1;
    }
    (of_corner, count as usize)
}

#[cfg(test)]
pub(super) mod tests;
