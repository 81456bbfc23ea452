use nalgebra::{IsometryMatrix3, Vector3};

use super::*;
use crate::arms::Stream;
use crate::clearance::shape::Shape;

/// Two boxes and a cylinder.
fn bodies() -> (Bounds, Vec<Placed>) {
    let block = |from: [f64; 3], to: [f64; 3]| Shape::Box(Bounds::of([from.into(), to.into()]));
    let post = Shape::Cylinder(
        Segment {
            from: Point3::new(-0.5, 0.2, 0.0),
            to: Point3::new(-0.5, 0.2, 1.0),
        },
        0.1,
    );
    let shapes = [
        block([0.0; 3], [0.3, 0.4, 0.5]),
        block([0.6, 0.6, -0.1], [0.7, 1.0, 1.0]),
        post,
    ];
    let around = shapes
        .iter()
        .fold(Bounds::EMPTY, |bounds, shape| bounds.joined(&shape.bounds()));
    let here = IsometryMatrix3::identity();
    (around, shapes.iter().map(|shape| shape.placed(&here)).collect())
}

fn exact(capsule: &Capsule, bodies: &[Placed]) -> f64 {
    let own = Shape::Capsule(*capsule).placed(&IsometryMatrix3::identity());
    let distances = bodies
        .iter()
        .map(|body| own.nearest(body, f64::INFINITY).unwrap().distance);
    distances.fold(f64::INFINITY, f64::min)
}

fn capsule(stream: &mut Stream) -> Capsule {
    let from: Point3<f64> = stream.vector(1.5).into();
    Capsule {
        axis: Segment {
            from,
            to: from + stream.vector(0.5),
        },
        radius: stream.between(0.0, 0.1),
    }
}

#[test]
fn the_bound_never_exceeds_the_distance_and_comes_near_it() {
    let mut stream = Stream(41);
    let (around, bodies) = bodies();
    let field = Field::around(&around);
    let (mut decided, mut clear) = (0, 0);
    for _ in 0..5_000 {
        let capsule = capsule(&mut stream);
        let distance = exact(&capsule, &bodies);
        for enough in [0.0, 0.02, 0.1, f64::INFINITY] {
            let bound = field.bound_of(&capsule, &bodies, enough);
            assert!(bound <= distance + 1e-9, "{bound} {distance}");
        }
        if distance > 0.05 + 0.02 {
            clear += 1;
            decided += usize::from(field.bound_of(&capsule, &bodies, 0.02) >= 0.02);
        }
    }
    // What is 5 cm better than demanded is seen as clear at once.
    assert!(clear > 1_000 && decided == clear, "{decided} of {clear}");
}

#[test]
fn values_do_not_depend_on_the_order_of_use() {
    let mut stream = Stream(42);
    let (around, bodies) = bodies();
    let capsules: Vec<Capsule> = (0..500).map(|_| capsule(&mut stream)).collect();
    let values = |field: &Field, order: &mut dyn Iterator<Item = &Capsule>| -> Vec<f64> {
        order
            .map(|capsule| field.bound_of(capsule, &bodies, 0.05))
            .collect()
    };
    let forward = values(&Field::around(&around), &mut capsules.iter());
    let mut backward = values(&Field::around(&around), &mut capsules.iter().rev());
    backward.reverse();
    assert_eq!(forward, backward);
}

#[test]
fn far_from_all_bodies_the_box_around_them_is_the_bound() {
    let (around, bodies) = bodies();
    let far = around.greatest + Vector3::repeat(10.0);
    let capsule = Capsule {
        axis: Segment { from: far, to: far },
        radius: 0.5,
    };
    let bound = Field::around(&around).bound_of(&capsule, &bodies, 1.0);
    assert!((bound - (300.0_f64.sqrt() - 0.5)).abs() < 1e-12);
}
