use nalgebra::{Rotation3, Translation3};

use super::*;
use crate::arms::Stream;

fn capsule(stream: &mut Stream) -> Capsule {
    Capsule {
        axis: Segment {
            from: stream.vector(1.0).into(),
            to: stream.vector(1.0).into(),
        },
        radius: stream.between(0.0, 0.2),
    }
}

#[test]
fn no_bound_exceeds_the_distance() {
    let mut stream = Stream(31);
    for _ in 0..2_000 {
        let (first, second) = (capsule(&mut stream), capsule(&mut stream));
        let distance = first.distance(&second);
        assert!(first.bound_of_balls(&second) <= distance + 1e-12);
        assert!(first.bounds().distance(&second.bounds()) <= distance.max(0.0) + 1e-12);
        let bounds = Bounds::of((0..3).map(|_| stream.vector(1.0).into()));
        for _ in 0..20 {
            let inside = bounds.least
                + (bounds.greatest - bounds.least)
                    .component_mul(&Vector3::from_fn(|_, _| stream.between(0.0, 1.0)));
            let distance = (first.axis.nearest_to_point(&inside) - inside).norm() - first.radius;
            assert!(first.bound_to(&bounds) <= distance + 1e-12);
            assert_eq!(bounds.distance_of(&inside), 0.0);
        }
    }
}

#[test]
fn a_moved_box_contains_what_it_contained() {
    let mut stream = Stream(32);
    for _ in 0..500 {
        let bounds = Bounds::of((0..3).map(|_| stream.vector(1.0).into()));
        let by = IsometryMatrix3::from_parts(
            Translation3::from(stream.vector(1.0)),
            Rotation3::new(stream.vector(3.0)),
        );
        let moved = bounds.moved(&by, &by.rotation.matrix().abs());
        for corner in bounds.corners() {
            assert!(moved.distance_of(&(by * corner)) < 1e-12);
        }
    }
}

#[test]
fn a_capsule_around_points_holds_them_and_touches_some() {
    let mut stream = Stream(33);
    for _ in 0..500 {
        let points: Vec<Point3<f64>> = (0..20).map(|_| stream.vector(1.0).into()).collect();
        let line = Segment {
            from: stream.vector(0.3).into(),
            to: stream.vector(0.3).into(),
        };
        let capsule = Capsule::around(&points, &line);
        let outside =
            |point: &Point3<f64>| (capsule.axis.nearest_to_point(point) - point).norm() - capsule.radius;
        let farthest = points.iter().map(outside).fold(f64::NEG_INFINITY, f64::max);
        assert!(farthest.abs() < 1e-9, "{farthest}");
    }
}
