//! Solids for tests, as triangles that are counter-clockwise seen from outside.

use super::assembly::Assembly;
use super::triangle_mesh::TriangleMesh;

/// A cube with its smallest corner at `at`: 12 triangles, the first two are its bottom.
pub fn cube(side: f64, at: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner = |bits: usize| [0, 1, 2].map(|axis| at[axis] + side * ((bits >> axis) & 1) as f64);
    // Corners of each face, counter-clockwise; the bits of a corner are its x, y and z.
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    faces
        .into_iter()
        .flat_map(halves)
        .map(|triangle| triangle.map(corner))
        .collect()
}

/// The corner of a cube at the origin: its volume is `side`^3 / 6.
pub fn tetrahedron(side: f64) -> Vec<[[f64; 3]; 3]> {
    let [o, x, y, z] = [[0.0; 3], [side, 0.0, 0.0], [0.0, side, 0.0], [0.0, 0.0, side]];
    vec![[o, y, x], [o, x, z], [o, z, y], [x, y, z]]
}

/// These triangles as a mesh.
pub fn mesh_of(triangles: &[[[f64; 3]; 3]]) -> TriangleMesh {
    let mut assembly = Assembly::default();
    for corners in triangles {
        let vertices = corners.map(|corner| assembly.vertex(corner));
        assembly.triangle(vertices).unwrap();
    }
    assembly.finish("solid").unwrap()
}
