//! parry of dimforge: distances of the pairs of [`crate::clearance`], in double precision.
//!
//! Shapes are made once; a trimesh has the tree that parry builds for it. Cylinders of parry are along y: a turn of the frame, made before
//! the timing, places them along z.

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

use armill_core::frame::Isometry;
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Capsule, Cuboid, Cylinder, Shape, TriMesh};

use crate::clearance::{Ball, FRAMES, HALF_EDGES, HALF_LENGTH, RADIUS, balls, distances_of_pairs, frames};
use crate::clock::Candidate;
use crate::work::{CAPSULE_FINE_MESH, CAPSULE_MESH, CYLINDER_BOX, MESH_MESH};

/// Frames that are checked for agreement.
const CHECKED: usize = 100;

/// Two bodies with the frames of the first in that of the second.
struct Pair {
    work: &'static str,
    first: Box<dyn Shape>,
    second: Box<dyn Shape>,
    frames: Vec<Pose>,
}

/// Rows of every pair.
pub fn candidates<'a>() -> Vec<Candidate<'a>> {
    let row = |pair: Pair| {
        Candidate::new("parry3d-f64 0.31.1", pair.work, FRAMES, move || {
            black_box(pair.distances(FRAMES));
        })
        .note("query::distance")
    };
    pairs().into_iter().map(row).collect()
}

/// Largest difference of a distance from that of armill, m, where both find the bodies apart.
pub fn difference() -> f64 {
    let ours = distances_of_pairs(CHECKED);
    let of_pair = |(pair, (work, ours)): (Pair, (&str, Vec<f64>))| {
        debug_assert_eq!(pair.work, work);
        let both = pair.distances(CHECKED).into_iter().zip(ours);
        // Bodies inside of a mesh touch a solid, and not its surface.
        let apart = both.filter(|(theirs, ours)| *theirs > 0.0 && *ours > 0.0);
        crate::agreement::worst(apart.map(|(theirs, ours)| (theirs - ours).abs()))
    };
    crate::agreement::worst(pairs().into_iter().zip(ours).map(of_pair))
}

impl Pair {
    /// Distances in the first `count` frames, m.
    fn distances(&self, count: usize) -> Vec<f64> {
        let here = Pose::identity();
        let distance = |frame: &Pose| {
            query::distance(frame, self.first.as_ref(), &here, self.second.as_ref())
                .map_or(f64::NAN, |found| found.distance)
        };
        self.frames.iter().take(count).map(distance).collect()
    }
}

fn pairs() -> Vec<Pair> {
    let frames: Vec<Pose> = frames().iter().map(pose).collect();
    let along_z = Pose::from_rotation(Rotation::from_rotation_x(FRAC_PI_2));
    let turned = frames.iter().map(|frame| *frame * along_z).collect();
    let capsule = || Box::new(Capsule::new_z(HALF_LENGTH, RADIUS));
    let [coarse, fine, small, large] = balls().each_ref().map(|ball| Box::new(mesh(ball)));
    let pair = |work, first: Box<dyn Shape>, second: Box<dyn Shape>, frames| Pair {
        work,
        first,
        second,
        frames,
    };
    let cuboid = Box::new(Cuboid::new(Vector::from_array(HALF_EDGES)));
    vec![
        pair(CAPSULE_MESH, capsule(), coarse, frames.clone()),
        pair(CAPSULE_FINE_MESH, capsule(), fine, frames.clone()),
        pair(MESH_MESH, small, large, frames),
        pair(
            CYLINDER_BOX,
            Box::new(Cylinder::new(HALF_LENGTH, RADIUS)),
            cuboid,
            turned,
        ),
    ]
}

fn mesh(ball: &Ball) -> TriMesh {
    let vertices = ball
        .vertices
        .iter()
        .map(|vertex| Vector::new(vertex.x, vertex.y, vertex.z));
    TriMesh::new(vertices.collect(), ball.triangles.clone()).expect("a ball has triangles")
}

fn pose(frame: &Isometry) -> Pose {
    let [x, y, z] = <[f64; 3]>::from(frame.translation.vector);
    let [i, j, k, w] = <[f64; 4]>::from(frame.rotation.coords);
    Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w))
}
