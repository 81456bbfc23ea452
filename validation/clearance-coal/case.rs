//! Clearance against recorded distances of coal, and against closed forms. See README.md.
//!
//! `pairs.tsv` and `arm.tsv` were written by `record.py`, which has the shapes of this file typed again.

use std::f64::consts::TAU;
use std::sync::Arc;

use armill_core::clearance::{
    ArmBody, Bounds, Capsule, Cell, CellState, FixedBody, Mesh, PlacedCell, Role, Segment, Shape,
};
use armill_core::frame::Isometry;
use armill_core::robot::forward::forward;
use armill_core::robot::{Attachment, Robot};
use armill_core::units::{from_deg, from_mm};
use armill_formats::robot::urdf;
use nalgebra::{IsometryMatrix3, Point3, UnitQuaternion, Vector3};

use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const REFERENCE: &str = "coal 3.0.3";
/// Records of coal.
const PAIRS: &str = include_str!("pairs.tsv");
const ARM: &str = include_str!("arm.tsv");
/// The arm of `arm.tsv`.
const MH12: &str = include_str!("../urdf-forward/mh12.urdf");

const SEED: u64 = 1;
/// Random placements of each closed form.
const PLACEMENTS: usize = 2000;
/// Largest permitted difference from coal, m: that of the demand of the case.
const TOLERANCE: f64 = 1e-6;
/// Largest permitted difference from a closed form, m: that of GJK with cylinders of a metre.
const OF_CLOSED_FORMS: f64 = 1e-7;

/// Half the length of the axis of the capsule, and its radius, m.
const CAPSULE: [f64; 2] = [0.3, 0.1];
/// The same of the cylinder.
const CYLINDER: [f64; 2] = [0.2, 0.15];
/// Half the edges of the box, m.
const HALF: [f64; 3] = [0.15, 0.2, 0.3];

/// The bodies of the arm: the links that they are on, counted from the base, their shapes, their frames in base at zero.
const BODIES: [(usize, &str, [f64; 6]); 5] = [
    (0, "box", [-0.25, 0.0, 0.15, 0.0, 0.0, 0.0]),
    (2, "torus", [0.155, 0.0, 0.86, 90.0, 0.0, 0.0]),
    (3, "angle", [-0.1, -0.2, 1.2, 0.0, 0.0, 0.0]),
    (5, "capsule", [0.87, 0.0, 1.264, 90.0, 0.0, 0.0]),
    (6, "cylinder", [1.15, 0.0, 1.264, 0.0, 90.0, 0.0]),
];
/// The obstacles, in base.
const OBSTACLES: [(&str, [f64; 6]); 2] = [
    ("box", [1.2, 0.9, 0.3, 0.0, 0.0, 30.0]),
    ("torus", [0.4, -1.1, 1.2, 40.0, 0.0, 0.0]),
];

/// The checks.
pub fn checks() -> Vec<Check> {
    let pairs: Vec<[f64; 2]> = PAIRS.lines().skip(1).map(of_pair).collect();
    let arm = of_arm();
    let recorded = [
        ("pairs of capsule, cylinder, box and two meshes", pairs),
        ("postures of an arm of five bodies between two obstacles", arm),
    ];
    let of_coal = recorded.into_iter().flat_map(|(what, both)| rows(what, &both));
    of_coal.chain(closed_forms()).collect()
}

/// The checks of pairs of distances, m: ours, and those of coal.
fn rows(what: &str, both: &[[f64; 2]]) -> [Check; 2] {
    let (touching, apart): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
        both.iter().partition(|[_, theirs]| *theirs == 0.0);
    let different = both
        .iter()
        .filter(|[ours, theirs]| (*ours == 0.0) != (*theirs == 0.0));
    let count = both.len();
    [
        Check::none_wrong(
            format!(
                "{count} {what}: contact of one alone ({} are in contact)",
                touching.len()
            ),
            REFERENCE,
            different.count(),
        ),
        Check::computed(
            "distances of the others",
            REFERENCE,
            ErrorBound {
                worst: worst(apart.iter().map(|[ours, theirs]| ours - theirs)),
                tolerance: TOLERANCE,
                unit: "m",
            },
        ),
    ]
}

/// The distance of a pair, m: ours, and that of coal.
fn of_pair(line: &str) -> [f64; 2] {
    let mut fields = line.split('\t');
    let [first, second] = [(); 2].map(|()| shape(fields.next().unwrap_or_default()));
    let numbers: Vec<f64> = fields.map_while(|field| field.parse().ok()).collect();
    let Ok([at @ .., recorded]) = <[f64; 7]>::try_from(numbers) else {
        return [f64::NAN; 2];
    };
    [distance(&first, &second, &frame(&at)), from_mm(recorded)]
}

/// The distance of two shapes, the second one at `at`, m.
fn distance(first: &Shape, second: &Shape, at: &Isometry) -> f64 {
    let [first, second] = [
        first.placed(&IsometryMatrix3::identity()),
        second.placed(&nalgebra::convert(*at)),
    ];
    let found = first.nearest(&second, f64::INFINITY);
    found.map_or(f64::NAN, |found| found.distance)
}

/// The least distances of the arm, m: ours, and those of coal.
fn of_arm() -> Vec<[f64; 2]> {
    let robot = match urdf::read("mh12.urdf", "mh12", MH12) {
        Ok(found) => found.robot,
        Err(problems) => unreachable!("the URDF of a case is sound: {problems}"),
    };
    let cell = cell(&robot);
    let here = Isometry::identity();
    let placed = PlacedCell {
        cell: &cell,
        base_from_part: &here,
    };
    let mut state = CellState::new(placed, &robot, &here);
    let mut both = |line: &str| {
        let numbers: Vec<f64> = line.split('\t').map_while(|field| field.parse().ok()).collect();
        let Ok([joints @ .., recorded]) = <[f64; 7]>::try_from(numbers) else {
            return [f64::NAN; 2];
        };
        state.set_joints(&joints.map(from_deg));
        let found = state.clearance(f64::INFINITY);
        let ours = found.map_or(f64::NAN, |found| found.nearest.distance);
        [ours, from_mm(recorded)]
    };
    ARM.lines().skip(1).map(&mut both).collect()
}

fn cell(robot: &Robot) -> Cell {
    let zero = forward(robot, &[0.0; 6]);
    let body = |(link, name, at): &(usize, &str, [f64; 6])| {
        let (attachment, base_from_link) = match link.checked_sub(1) {
            None => (Attachment::Base, Isometry::identity()),
            Some(joint) => (
                Attachment::Joint(joint),
                nalgebra::convert(zero.base_from_joint[joint]),
            ),
        };
        ArmBody {
            name: (*name).to_owned(),
            attachment,
            attachment_from_body: base_from_link.inverse() * frame(at),
            shape: shape(name),
            role: Role::Link,
        }
    };
    let obstacle = |(name, at): &(&str, [f64; 6])| FixedBody {
        name: format!("fixed {name}"),
        shape: shape(name),
        frame_from_body: frame(at),
        is_part: false,
    };
    let arm = BODIES.iter().map(body).collect();
    Cell::new(
        robot,
        &Isometry::identity(),
        arm,
        &[],
        &OBSTACLES.each_ref().map(obstacle),
    )
}

/// A frame of a record: x, y, z in m, then rotations about the fixed axes x, y, z in deg.
fn frame(at: &[f64; 6]) -> Isometry {
    let [x, y, z, roll, pitch, yaw] = *at;
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(from_deg);
    Isometry::from_parts(
        [x, y, z].into(),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    )
}

/// A shape of the records.
fn shape(name: &str) -> Shape {
    match name {
        "capsule" => Shape::Capsule(Capsule {
            axis: axis(CAPSULE[0]),
            radius: CAPSULE[1],
        }),
        "cylinder" => Shape::Cylinder(axis(CYLINDER[0]), CYLINDER[1]),
        "box" => Shape::Box(cuboid(HALF)),
        "torus" => mesh(torus()),
        "angle" => mesh(angle()),
        _ => unreachable!("the records of a case have its shapes alone"),
    }
}

/// The axis z between these heights.
fn axis(half: f64) -> Segment {
    Segment {
        from: Point3::new(0.0, 0.0, -half),
        to: Point3::new(0.0, 0.0, half),
    }
}

fn cuboid(half: [f64; 3]) -> Bounds {
    Bounds::of([Point3::from(half.map(|half| -half)), Point3::from(half)])
}

fn mesh(triangles: Vec<[Point3<f64>; 3]>) -> Shape {
    Shape::Mesh(Arc::new(Mesh::new(triangles, true).expect("it has triangles")))
}

/// Radii 0.25 and 0.08 m, 24 x 12 points, about z.
fn torus() -> Vec<[Point3<f64>; 3]> {
    let at = |i: usize, j: usize| {
        let [u, v] = [(i % 24, 24.0), (j % 12, 12.0)].map(|(place, count)| TAU * place as f64 / count);
        let across = 0.25 + 0.08 * v.cos();
        Point3::new(across * u.cos(), across * u.sin(), 0.08 * v.sin())
    };
    let places = (0..24).flat_map(|i| (0..12).map(move |j| [i, j]));
    let two = |[i, j]: [usize; 2]| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    places.flat_map(two).collect()
}

/// An L in x and y, 0.2 m high.
fn angle() -> Vec<[Point3<f64>; 3]> {
    let profile = [
        [0.0, 0.0],
        [0.4, 0.0],
        [0.4, 0.1],
        [0.1, 0.1],
        [0.1, 0.5],
        [0.0, 0.5],
    ];
    let [low, high] = [0.0, 0.2].map(|z| profile.map(|[x, y]| Point3::new(x, y, z)));
    let mut triangles = Vec::new();
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
        triangles.extend([[low[c], low[b], low[a]], [high[a], high[b], high[c]]]);
    }
    for i in 0..6 {
        let j = (i + 1) % 6;
        triangles.extend([[low[i], low[j], high[j]], [low[i], high[j], high[i]]]);
    }
    triangles
}

/// Balls at random places next to simple bodies, and bodies turned at random above a plate.
fn closed_forms() -> Vec<Check> {
    let ball = |radius: f64| {
        Shape::Capsule(Capsule {
            axis: axis(0.0),
            radius,
        })
    };
    let of_box = |p: &Vector3<f64>| {
        let gap = |axis: usize| (p[axis].abs() - HALF[axis]).max(0.0);
        Vector3::new(gap(0), gap(1), gap(2)).norm()
    };
    let of_cylinder = |p: &Vector3<f64>| {
        let [half, radius] = CYLINDER;
        let across = (p.x.hypot(p.y) - radius).max(0.0);
        across.hypot((p.z.abs() - half).max(0.0))
    };
    let of_capsule = |p: &Vector3<f64>| {
        let [half, radius] = CAPSULE;
        (p - Vector3::z() * p.z.clamp(-half, half)).norm() - radius
    };
    let next_to = |what: &str, body: &Shape, expected: &dyn Fn(&Vector3<f64>) -> f64| {
        let mut random = Random::seeded(SEED);
        let errors = (0..PLACEMENTS).map(|_| {
            let (place, radius) = (random.vector(0.8), random.between(0.0, 0.2));
            let at = Isometry::translation(place.x, place.y, place.z);
            distance(body, &ball(radius), &at) - (expected(&place) - radius).max(0.0)
        });
        closed_form(
            format!("{PLACEMENTS} balls next to a body: {what}"),
            worst(errors),
        )
    };

    // A body turned by R is as low above a plate as the lowest of its points: z - max over its points of -(R p) . z.
    let low_points = |body: &Shape| -> Vec<Vector3<f64>> {
        match body {
            Shape::Box(bounds) => bounds.corners().iter().map(|corner| corner.coords).collect(),
            Shape::Mesh(mesh) => {
                let corners = mesh.triangles().iter().flat_map(|triangle| triangle.0);
                corners.map(|corner| corner.coords).collect()
            }
            _ => Vec::new(),
        }
    };
    let over_plate = |what: &str, body: &Shape, reach: &dyn Fn(&Vector3<f64>) -> f64| {
        let mut random = Random::seeded(SEED);
        let plate = Shape::Box(Bounds::of([
            Point3::new(-3.0, -3.0, -1.0),
            Point3::new(3.0, 3.0, 0.0),
        ]));
        let errors = (0..PLACEMENTS).map(|_| {
            let (place, turn) = (random.vector(0.8), random.orientation());
            let at = Isometry::from_parts(Vector3::new(place.x, place.y, place.z.abs()).into(), turn);
            // Down, in the frame of the body.
            let down = turn.inverse() * -Vector3::z();
            distance(&plate, body, &at) - (place.z.abs() - reach(&down)).max(0.0)
        });
        closed_form(format!("{PLACEMENTS} turns above a plate: {what}"), worst(errors))
    };
    let lowest_of = |body: &Shape| {
        let points = low_points(body);
        move |down: &Vector3<f64>| {
            points
                .iter()
                .map(|point| point.dot(down))
                .fold(f64::NEG_INFINITY, f64::max)
        }
    };
    let round = |[half, radius]: [f64; 2]| {
        move |down: &Vector3<f64>| half * down.z.abs() + radius * down.x.hypot(down.y)
    };
    let [capsule, cylinder, block] = ["capsule", "cylinder", "box"].map(shape);
    let box_mesh = mesh(faces());
    let [torus, angle] = ["torus", "angle"].map(shape);
    vec![
        next_to("capsule", &capsule, &of_capsule),
        next_to("cylinder", &cylinder, &of_cylinder),
        next_to("box", &block, &of_box),
        next_to("box of 12 triangles", &box_mesh, &of_box),
        over_plate("cylinder", &cylinder, &round(CYLINDER)),
        over_plate("box", &block, &lowest_of(&block)),
        over_plate("torus of 576 triangles", &torus, &lowest_of(&torus)),
        over_plate("angle of 20 triangles", &angle, &lowest_of(&angle)),
    ]
}

/// The box as a mesh: two triangles of each face, by the bits of the corners.
fn faces() -> Vec<[Point3<f64>; 3]> {
    let corners = cuboid(HALF).corners();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let two = |quad: [usize; 4]| {
        let [a, b, c, d] = quad.map(|index| corners[index]);
        [[a, b, c], [a, c, d]]
    };
    quads.into_iter().flat_map(two).collect()
}

fn closed_form(what: String, worst: f64) -> Check {
    let bound = ErrorBound {
        worst,
        tolerance: OF_CLOSED_FORMS,
        unit: "m",
    };
    Check::computed(what, "closed form", bound)
}
