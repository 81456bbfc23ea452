//! Bodies whose distances are timed, and the rows of armill for them: pairs of bodies, and whole cells.
//!
//! | pair | first body | second body |
//! |---|---|---|
//! | [`CAPSULE_MESH`] | capsule, 0.6 m long, radius 0.1 m | ball of 512 triangles, radius 0.5 m |
//! | [`CAPSULE_FINE_MESH`] | the same | ball of 32 768 triangles |
//! | [`MESH_MESH`] | ball of 2048 triangles, radius 0.3 m | ball of 2048 triangles, radius 0.5 m |
//! | [`CYLINDER_BOX`] | cylinder, 0.6 m long, radius 0.1 m | box of 0.6 x 0.8 x 1 m |
//!
//! Frames of the first body in that of the second: random turns, and places in a cube of 2 m, overlapping bodies among them.
//!
//! | cell | arm | obstacle |
//! |---|---|---|
//! | arm of capsules | MH12, eight capsules | a torus of 1000 triangles |
//! | arm of meshes | MH12, eight meshes of 2500 triangles | the same |
//!
//! Postures: moves between random joint positions in steps of at most 0.02 rad, as along a path, or random ones. A check decides whether
//! 10 mm are kept; the distance is the exact least one. One thread. Lengths in m.

use std::f64::consts::{PI, TAU};
use std::hint::black_box;
use std::sync::Arc;

use armill_core::clearance::{
    ArmBody, Bounds, Capsule, Cell, CellState, ClearanceCheck, DemandedClearance, FixedBody, Mesh,
    PlacedCell, Role, Segment, Shape,
};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{self, Point3, Translation3, UnitQuaternion, Vector3};
use armill_core::robot::{Attachment, Robot};

use crate::clock::Candidate;
use crate::work::{CAPSULE_FINE_MESH, CAPSULE_MESH, CYLINDER_BOX, MESH_MESH};

/// Frames of a pair of bodies.
pub const FRAMES: usize = 1000;
/// Postures of a cell.
const POSTURES: usize = 20_000;
/// The demanded clearance, m.
const LEAST: f64 = 0.01;
/// Largest step of a joint between two postures of a move, rad.
const STEP: f64 = 0.02;
const SEED: u64 = 20_260_102;

/// A ball of triangles: vertices, and their indices.
pub struct Ball {
    /// Vertices, m.
    pub vertices: Vec<Point3<f64>>,
    /// Three indices for each triangle, counterclockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Half the length of the axis of capsule and cylinder, and their radius, m.
pub const HALF_LENGTH: f64 = 0.3;
/// Radius of both, m.
pub const RADIUS: f64 = 0.1;
/// Half the edges of the box, m.
pub const HALF_EDGES: [f64; 3] = [0.3, 0.4, 0.5];

/// Balls of the pairs: coarse, fine, and the two that meet.
pub fn balls() -> [Ball; 4] {
    [
        ball(0.5, 16, 17),
        ball(0.5, 128, 129),
        ball(0.3, 32, 33),
        ball(0.5, 32, 33),
    ]
}

/// A ball of `2 around (rings - 1)` triangles between circles of latitude.
fn ball(radius: f64, around: u32, rings: u32) -> Ball {
    let mut vertices = vec![Point3::new(0.0, 0.0, -radius)];
    for ring in 1..rings {
        let latitude = PI * (f64::from(ring) / f64::from(rings) - 0.5);
        for place in 0..around {
            let longitude = TAU * f64::from(place) / f64::from(around);
            let across = radius * latitude.cos();
            vertices.push(Point3::new(
                across * longitude.cos(),
                across * longitude.sin(),
                radius * latitude.sin(),
            ));
        }
    }
    vertices.push(Point3::new(0.0, 0.0, radius));
    let at = |ring: u32, place: u32| 1 + (ring - 1) * around + place % around;
    let top = 1 + (rings - 1) * around;
    let mut triangles = Vec::new();
    for place in 0..around {
        triangles.push([0, at(1, place + 1), at(1, place)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, place), at(ring, place + 1)];
            let [c, d] = [at(ring + 1, place + 1), at(ring + 1, place)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([at(rings - 1, place), at(rings - 1, place + 1), top]);
    }
    Ball { vertices, triangles }
}

impl Ball {
    /// Corners of each triangle.
    fn corners(&self) -> Vec<[Point3<f64>; 3]> {
        let corners = |triangle: &[u32; 3]| triangle.map(|index| self.vertices[index as usize]);
        self.triangles.iter().map(corners).collect()
    }

    fn mesh(&self) -> Shape {
        mesh(self.corners())
    }
}

fn mesh(triangles: Vec<[Point3<f64>; 3]>) -> Shape {
    Shape::Mesh(Arc::new(
        Mesh::new(triangles, true).expect("a ball has triangles"),
    ))
}

/// Uniform random numbers of a seed: splitmix64.
struct Random(u64);

impl Random {
    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let z = z ^ (z >> 31);
        lower + (z >> 11) as f64 * (1.0 / (1_u64 << 53) as f64) * (upper - lower)
    }
}

/// Frames of the first body of a pair in that of the second.
pub fn frames() -> Vec<Isometry> {
    let mut random = Random(SEED);
    let frame = |_| {
        let mut vector = |reach: f64| Vector3::zeros().map(|_: f64| random.between(-reach, reach));
        Isometry::from_parts(
            Translation3::from(vector(1.0)),
            UnitQuaternion::from_scaled_axis(vector(3.0)),
        )
    };
    (0..FRAMES).map(frame).collect()
}

/// The two bodies of each pair, in the order of the table above.
fn pairs() -> [(&'static str, Shape, Shape); 4] {
    let axis = Segment {
        from: Point3::new(0.0, 0.0, -HALF_LENGTH),
        to: Point3::new(0.0, 0.0, HALF_LENGTH),
    };
    let capsule = Shape::Capsule(Capsule { axis, radius: RADIUS });
    let cuboid = Shape::Box(Bounds {
        least: Point3::from(-Vector3::from(HALF_EDGES)),
        greatest: Point3::from(Vector3::from(HALF_EDGES)),
    });
    let [coarse, fine, small, large] = balls().each_ref().map(Ball::mesh);
    [
        (CAPSULE_MESH, capsule.clone(), coarse),
        (CAPSULE_FINE_MESH, capsule, fine),
        (MESH_MESH, small, large),
        (CYLINDER_BOX, Shape::Cylinder(axis, RADIUS), cuboid),
    ]
}

/// Distances of a pair in all frames, m.
fn distances(first: &Shape, second: &Shape, frames: &[Isometry]) -> Vec<f64> {
    let second = second.placed(&nalgebra::IsometryMatrix3::identity());
    let distance = |frame: &Isometry| {
        let first = first.placed(&nalgebra::convert(*frame));
        first
            .nearest(&second, f64::INFINITY)
            .map_or(f64::NAN, |found| found.distance)
    };
    frames.iter().map(distance).collect()
}

/// The work and the distances of every pair in the first `count` of [`frames`], m.
pub fn distances_of_pairs(count: usize) -> Vec<(&'static str, Vec<f64>)> {
    let frames = frames();
    let of_pair =
        |(work, first, second): (_, Shape, Shape)| (work, distances(&first, &second, &frames[..count]));
    pairs().into_iter().map(of_pair).collect()
}

/// A cell of an arm of the workload.
pub struct ArmCell {
    cell: Cell,
    work: [&'static str; 4],
}

/// The arm of capsules and that of meshes.
pub fn cells(robot: &Robot) -> [ArmCell; 2] {
    let capsules = ArmCell {
        cell: cell(robot, Shape::Capsule, LEAST, &[torus_before_arm()]),
        work: [
            "arm of capsules, check along moves",
            "arm of capsules, distance along moves",
            "arm of capsules, check at random",
            "arm of capsules, distance at random",
        ],
    };
    let meshes = ArmCell {
        cell: cell(robot, tessellated, LEAST, &[torus_before_arm()]),
        work: [
            "arm of meshes, check along moves",
            "arm of meshes, distance along moves",
            "arm of meshes, check at random",
            "arm of meshes, distance at random",
        ],
    };
    [capsules, meshes]
}

/// A capsule of 2500 triangles.
pub(crate) fn tessellated(capsule: Capsule) -> Shape {
    let along = capsule.axis.to - capsule.axis.from;
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &along).unwrap_or_default();
    let ball = ball(capsule.radius, 50, 26);
    let place = |corner: Point3<f64>| {
        let end = if corner.z > 0.0 {
            capsule.axis.to
        } else {
            capsule.axis.from
        };
        end + turn * corner.coords
    };
    mesh(
        ball.corners()
            .into_iter()
            .map(|corners| corners.map(place))
            .collect(),
    )
}

/// The cell of an arm of these shapes, of which this clearance is demanded, m, and bodies that stand still.
pub(crate) fn cell(robot: &Robot, shape: impl Fn(Capsule) -> Shape, least: f64, still: &[FixedBody]) -> Cell {
    let body = |(name, attachment, from, to, radius, role): (&str, _, [f64; 3], [f64; 3], f64, _)| ArmBody {
        name: name.to_owned(),
        attachment,
        attachment_from_body: Isometry::identity(),
        shape: shape(Capsule {
            axis: Segment {
                from: from.into(),
                to: to.into(),
            },
            radius,
        }),
        role,
    };
    let joint = Attachment::Joint;
    let arm = [
        (
            "base",
            Attachment::Base,
            [0.0, 0.0, 0.1],
            [0.0, 0.0, 0.2],
            0.14,
            Role::Link,
        ),
        (
            "shoulder",
            joint(0),
            [0.0; 3],
            [0.155, 0.0, 0.0],
            0.15,
            Role::Link,
        ),
        (
            "upper arm",
            joint(1),
            [0.0, -0.1, 0.0],
            [0.0, -0.1, 0.614],
            0.09,
            Role::Link,
        ),
        ("elbow", joint(2), [0.0; 3], [0.0, 0.0, 0.2], 0.12, Role::Link),
        (
            "forearm",
            joint(3),
            [0.15, 0.0, 0.0],
            [0.55, 0.0, 0.0],
            0.07,
            Role::Link,
        ),
        ("wrist", joint(4), [0.0; 3], [0.06, 0.0, 0.0], 0.05, Role::Link),
        (
            "spindle",
            Attachment::Flange,
            [0.0, 0.0, 0.05],
            [0.0, 0.0, 0.2],
            0.05,
            Role::Holder,
        ),
        (
            "cutter",
            Attachment::Flange,
            [0.0, 0.0, 0.2],
            [0.0, 0.0, 0.28],
            0.005,
            Role::Cutter,
        ),
    ];
    let tool = Isometry::translation(0.0, 0.0, 0.28);
    let cell = Cell::new(robot, &tool, arm.map(body).into(), &[], still);
    cell.for_clearance(robot, &tool, least)
}

fn torus_before_arm() -> FixedBody {
    FixedBody {
        name: "torus".to_owned(),
        shape: mesh(torus()),
        frame_from_body: Isometry::translation(0.9, -0.5, 0.9),
        is_part: false,
    }
}

/// A torus about z of 1000 triangles.
fn torus() -> Vec<[Point3<f64>; 3]> {
    const AROUND: [u32; 2] = [25, 20];
    let at = |i: u32, j: u32| {
        let [u, v] = [(i, AROUND[0]), (j, AROUND[1])].map(|(i, n)| TAU * f64::from(i % n) / f64::from(n));
        let across = 0.3 + 0.08 * v.cos();
        Point3::new(across * u.cos(), across * u.sin(), 0.08 * v.sin())
    };
    let places = (0..AROUND[0]).flat_map(|i| (0..AROUND[1]).map(move |j| (i, j)));
    places
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Joint positions of the postures: along moves, and at random.
pub fn postures(robot: &Robot) -> [Vec<[f64; 6]>; 2] {
    let mut random = Random(SEED);
    let mut place = || {
        let mut q = [0.0; 6];
        for (q, joint) in q.iter_mut().zip(robot.joints()) {
            let limits = joint.limits.expect("the joints of the workload have limits");
            *q = random.between(limits.lower, limits.upper);
        }
        q
    };
    let at_random: Vec<[f64; 6]> = (0..POSTURES).map(|_| place()).collect();
    let mut along = Vec::with_capacity(POSTURES);
    let mut from = place();
    while along.len() < POSTURES {
        let to = place();
        let longest = from
            .iter()
            .zip(&to)
            .map(|(a, b)| (b - a).abs())
            .fold(0.0, f64::max);
        let steps = (longest / STEP).ceil();
        for step in 0..steps as u32 {
            let part = f64::from(step) / steps;
            along.push(std::array::from_fn(|i| from[i] + part * (to[i] - from[i])));
        }
        from = to;
    }
    along.truncate(POSTURES);
    [along, at_random]
}

/// Rows of armill.
pub fn candidates<'a>(
    robot: &'a Robot,
    cells: &'a [ArmCell],
    postures: &'a [Vec<[f64; 6]>; 2],
) -> Vec<Candidate<'a>> {
    let mut rows = Vec::new();
    for (work, first, second) in pairs() {
        let frames = frames();
        rows.push(Candidate::new("armill clearance", work, FRAMES, move || {
            black_box(distances(&first, &second, &frames));
        }));
    }
    for ArmCell { cell, work } in cells {
        for (postures, [check, distance]) in postures.iter().zip([[work[0], work[1]], [work[2], work[3]]]) {
            rows.push(Candidate::new("armill clearance", check, POSTURES, move || {
                black_box(conflicts(cell, robot, postures));
            }));
            rows.push(Candidate::new(
                "armill clearance",
                distance,
                POSTURES,
                move || {
                    black_box(least(cell, robot, postures));
                },
            ));
        }
    }
    rows
}

/// Postures that do not keep the demanded clearance.
fn conflicts(cell: &Cell, robot: &Robot, postures: &[[f64; 6]]) -> usize {
    let (here, tool) = (Isometry::identity(), Isometry::translation(0.0, 0.0, 0.28));
    let placed = PlacedCell {
        cell,
        base_from_part: &here,
    };
    let demanded = DemandedClearance { placed, least: LEAST };
    let mut check = ClearanceCheck::new(demanded, robot, &tool);
    postures
        .iter()
        .filter(|q| check.conflict(q.as_slice()).is_some())
        .count()
}

/// The sum of the least distances, m.
fn least(cell: &Cell, robot: &Robot, postures: &[[f64; 6]]) -> f64 {
    let (here, tool) = (Isometry::identity(), Isometry::translation(0.0, 0.0, 0.28));
    let placed = PlacedCell {
        cell,
        base_from_part: &here,
    };
    let mut state = CellState::new(placed, robot, &tool);
    let mut distance = |q: &[f64; 6]| {
        state.set_joints(q);
        state
            .clearance(f64::INFINITY)
            .map_or(0.0, |found| found.nearest.distance)
    };
    postures.iter().map(&mut distance).sum()
}
