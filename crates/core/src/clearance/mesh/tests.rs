use nalgebra::{Rotation3, Translation3};

use super::*;
use crate::arms::Stream;
use crate::clearance::nearest::Segment;

/// A ball of triangles: an octahedron, divided and pushed out to the radius.
fn ball_triangles(radius: f64, divisions: usize) -> Vec<[Point3<f64>; 3]> {
    let ends = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut all: Vec<[Vector3<f64>; 3]> = Vec::new();
    for signs in 0..8 {
        let sign = |axis: usize| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
        let mut corners = [0, 1, 2].map(|axis| ends[axis] * sign(axis));
        if sign(0) * sign(1) * sign(2) < 0.0 {
            corners.swap(0, 1);
        }
        all.push(corners);
    }
    for _ in 0..divisions {
        all = all
            .iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [(a + b), (b + c), (c + a)].map(|sum| sum.normalize());
                [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
            })
            .collect();
    }
    all.iter()
        .map(|corners| corners.map(|corner| Point3::from(corner * radius)))
        .collect()
}

fn ball(radius: f64) -> Mesh {
    Mesh::new(ball_triangles(radius, 4), true).unwrap()
}

fn frame(stream: &mut Stream) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(
        Translation3::from(stream.vector(1.0)),
        Rotation3::new(stream.vector(3.0)),
    )
}

fn capsule(stream: &mut Stream) -> (Convex, Capsule) {
    let hull = Capsule {
        axis: Segment {
            from: stream.vector(1.0).into(),
            to: stream.vector(1.0).into(),
        },
        radius: stream.between(0.0, 0.1),
    };
    let body = Convex {
        core: Core::Segment(hull.axis),
        radius: hull.radius,
    };
    (body, hull)
}

#[test]
fn the_tree_finds_what_all_triangles_give() {
    let mut stream = Stream(21);
    let (mesh, other) = (ball(0.5), ball(0.3));
    for _ in 0..100 {
        let (body, hull) = capsule(&mut stream);
        let all = mesh.triangles().iter().map(|triangle| {
            body.nearest(&Convex {
                core: Core::Triangle(*triangle),
                radius: 0.0,
            })
            .distance
        });
        let least = all.fold(f64::INFINITY, f64::min);
        let found = mesh.nearest_to_convex(&body, &hull, f64::INFINITY).unwrap();
        let inside = mesh.contains(&hull.axis.middle());
        let expected = if inside { 0.0 } else { least };
        assert!((found.distance - expected).abs() < 1e-15);
        // A limit below the distance finds nothing, one at it finds the same.
        if expected > 0.0 {
            assert!(mesh.nearest_to_convex(&body, &hull, 0.999 * expected).is_none());
            let again = mesh.nearest_to_convex(&body, &hull, expected + 1e-15).unwrap();
            assert!((again.distance - expected).abs() < 1e-15);
        }
        let by = frame(&mut stream);
        let pairs = mesh.triangles().iter().step_by(29).flat_map(|ours| {
            other
                .triangles()
                .iter()
                .step_by(23)
                .map(move |theirs| ours.nearest(&Triangle(theirs.0.map(|p| by * p))).distance)
        });
        let least_of_some = pairs.fold(f64::INFINITY, f64::min);
        let found = mesh.nearest_to_mesh(&other, &by, f64::INFINITY).unwrap();
        assert!(found.distance <= least_of_some);
    }
}

#[test]
fn meshes_of_balls_are_as_far_as_balls() {
    // The chord of a triangle with edges of 0.05 is some 0.6 mm inside of a ball of 0.5 m.
    let mut stream = Stream(22);
    let (mesh, other) = (ball(0.5), ball(0.3));
    for _ in 0..300 {
        let by = frame(&mut stream);
        let apart = by.translation.vector.norm() - 0.8;
        let found = mesh.nearest_to_mesh(&other, &by, f64::INFINITY).unwrap();
        if apart > 0.0 {
            assert!(
                (0.0..3e-3).contains(&(found.distance - apart)),
                "{} {apart}",
                found.distance
            );
        } else if apart < -3e-3 {
            assert_eq!(found.distance, 0.0);
        }
    }
}

#[test]
fn a_point_is_inside_of_a_closed_ball_by_its_radius() {
    let mut stream = Stream(23);
    let mesh = ball(0.5);
    let open = Mesh::new(ball_triangles(0.5, 4).split_off(1), false).unwrap();
    for _ in 0..5_000 {
        let point = Point3::from(stream.vector(0.6));
        let radius = point.coords.norm();
        if !(0.498..=0.5).contains(&radius) {
            assert_eq!(mesh.contains(&point), radius < 0.498, "{point}");
        }
        assert!(!open.contains(&point));
    }
}

#[test]
fn what_is_inside_of_a_closed_mesh_touches_it() {
    let (mesh, small) = (ball(0.5), ball(0.1));
    let (body, hull) = {
        let axis = Segment {
            from: Point3::new(0.0, 0.0, -0.1),
            to: Point3::new(0.0, 0.0, 0.1),
        };
        (
            Convex {
                core: Core::Segment(axis),
                radius: 0.05,
            },
            Capsule { axis, radius: 0.05 },
        )
    };
    let here = IsometryMatrix3::identity();
    assert_eq!(mesh.nearest_to_convex(&body, &hull, 1.0).unwrap().distance, 0.0);
    assert_eq!(mesh.nearest_to_mesh(&small, &here, 1.0).unwrap().distance, 0.0);
    assert_eq!(small.nearest_to_mesh(&mesh, &here, 1.0).unwrap().distance, 0.0);
    let open = Mesh::new(ball_triangles(0.5, 4).split_off(1), false).unwrap();
    assert!(open.nearest_to_convex(&body, &hull, 1.0).unwrap().distance > 0.3);
}

#[test]
fn every_vertex_is_inside_of_the_capsule_around_a_mesh() {
    let mut stream = Stream(24);
    for _ in 0..50 {
        let points: Vec<_> = (0..30)
            .map(|_| {
                [0; 3].map(|_| Point3::from(stream.vector(1.0).component_mul(&Vector3::new(3.0, 0.4, 0.2))))
            })
            .collect();
        let mesh = Mesh::new(points, false).unwrap();
        let hull = mesh.hull();
        for corner in mesh.triangles().iter().flat_map(|triangle| triangle.0) {
            assert!((hull.axis.nearest_to_point(&corner) - corner).norm() <= hull.radius);
        }
    }
}

#[test]
fn a_mesh_without_triangles_is_none() {
    assert!(Mesh::new(Vec::new(), true).is_none());
}
