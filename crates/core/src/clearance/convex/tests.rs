use std::f64::consts::FRAC_PI_4;

use nalgebra::{Rotation3, Translation3};

use super::*;
use crate::arms::Stream;

fn frame(stream: &mut Stream, away: f64) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(
        Translation3::from(stream.vector(away)),
        Rotation3::new(stream.vector(3.0)),
    )
}

fn segment(from: [f64; 3], to: [f64; 3]) -> Segment {
    Segment {
        from: from.into(),
        to: to.into(),
    }
}

fn solid(core: Core) -> Convex {
    Convex { core, radius: 0.0 }
}

fn ball(centre: [f64; 3], radius: f64) -> Convex {
    Convex {
        core: Core::Segment(segment(centre, centre)),
        radius,
    }
}

fn block(half: [f64; 3]) -> Convex {
    solid(Core::Box {
        centre: Point3::origin(),
        half_edges: [0, 1, 2].map(|axis| Vector3::ith(axis, half[axis])),
    })
}

fn rod(length: f64, radius: f64) -> Convex {
    solid(Core::Cylinder {
        axis: segment([0.0, 0.0, -0.5 * length], [0.0, 0.0, 0.5 * length]),
        radius,
    })
}

fn any(stream: &mut Stream, kind: usize) -> Convex {
    let mut size = || stream.between(0.02, 0.8);
    let (a, b, c) = (size(), size(), size());
    let body = match kind {
        0 => block([a, b, c]),
        1 => rod(a, b),
        2 => Convex {
            core: Core::Segment(segment([0.0; 3], [a, 0.0, 0.0])),
            radius: 0.2 * b,
        },
        _ => solid(Core::Triangle(Triangle(
            [[a, 0.0, 0.0], [0.0, b, 0.0], [-c, 0.0, 0.0]].map(Point3::from),
        ))),
    };
    body.moved(&frame(stream, 1.2))
}

/// The width of the gap between two bodies along a direction: never more than their distance.
fn gap_along(first: &Convex, second: &Convex, unit: &Vector3<f64>) -> f64 {
    let from = unit.dot(&first.core.support(unit).coords) + first.radius;
    let to = unit.dot(&second.core.support(&-unit).coords) - second.radius;
    to - from
}

/// The widest gap of all directions near this one, by smaller and smaller steps.
fn widest_gap(first: &Convex, second: &Convex, near: &Vector3<f64>) -> f64 {
    let mut best = (*near, gap_along(first, second, near));
    let mut step = 1e-4;
    while step > 1e-10 {
        let tries = (0..6).map(|i| {
            let side = Vector3::ith(i / 2, if i % 2 == 0 { step } else { -step });
            (best.0 + side).normalize()
        });
        let wider = tries
            .map(|unit| (unit, gap_along(first, second, &unit)))
            .find(|found| found.1 > best.1);
        match wider {
            Some(found) => best = found,
            None => step *= 0.5,
        }
    }
    best.1
}

#[test]
fn a_gap_as_wide_as_the_distance_proves_it() {
    let mut stream = Stream(11);
    let (mut apart, mut touching, mut worst) = (0, 0, 0.0_f64);
    for _ in 0..3_000 {
        for (one, other) in [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3)] {
            let (first, second) = (any(&mut stream, one), any(&mut stream, other));
            let found = first.nearest(&second);
            if found.distance == 0.0 {
                touching += 1;
                continue;
            }
            apart += 1;
            let [from, to] = found.points;
            assert!(((to - from).norm() - found.distance).abs() < 1e-9);
            let unit = (to - from).normalize();
            let mut gap = gap_along(&first, &second, &unit);
            // Bodies of a metre: a direction that is wrong by 1e-7 rad makes the gap look some 1e-7 m narrower.
            if found.distance - gap > 1e-8 {
                gap = widest_gap(&first, &second, &unit);
            }
            worst = worst.max(found.distance - gap);
        }
    }
    assert!(worst < 1e-7, "{worst:e}");
    assert!(apart > 10_000 && touching > 2_000, "{apart} {touching}");
}

#[test]
fn bodies_that_touch_have_a_point_in_common() {
    let mut stream = Stream(12);
    for _ in 0..3_000 {
        let (first, second) = (any(&mut stream, 0), any(&mut stream, 1));
        let found = first.nearest(&second);
        if found.distance > 0.0 {
            continue;
        }
        // Pulled apart by less than a nanometre, the two must be as near.
        let [at, _] = found.points;
        for body in [&first, &second] {
            assert!(ball(at.into(), 0.0).nearest(body).distance < 1e-8);
        }
    }
}

#[test]
fn closed_forms_of_balls_boxes_and_cylinders() {
    let up = |height: f64| IsometryMatrix3::translation(0.0, 0.0, height);
    let turned = |height: f64, about: Vector3<f64>| {
        IsometryMatrix3::from_parts(Translation3::new(0.0, 0.0, height), Rotation3::new(about))
    };
    let cube = block([0.5; 3]);
    let pipe = rod(1.0, 0.25);
    let on_edge = cube.moved(&turned(2.0, Vector3::x() * FRAC_PI_4));
    let lying = pipe.moved(&turned(2.0, Vector3::x() * 2.0 * FRAC_PI_4));
    for (first, second, distance) in [
        (ball([0.0; 3], 0.1), ball([1.0, 0.0, 0.0], 0.2), 0.7),
        (cube, cube.moved(&up(1.75)), 0.75),
        (cube, on_edge, 1.5 - 0.5_f64.sqrt()),
        (cube, ball([1.5, 1.5, 1.5], 0.5), 3.0_f64.sqrt() - 0.5),
        (cube, ball([0.0, 0.0, 0.0], 0.5), 0.0),
        (pipe, pipe.moved(&up(1.4)), 0.4),
        (pipe, lying, 2.0 - 0.5 - 0.25),
        (
            pipe,
            pipe.moved(&IsometryMatrix3::translation(0.9, 0.0, 0.2)),
            0.4,
        ),
        (pipe, ball([1.0, 0.0, 0.9], 0.05), 0.85 - 0.05),
        (
            pipe,
            cube.moved(&IsometryMatrix3::translation(2.0, 0.3, 0.0)),
            1.25,
        ),
    ] {
        for found in [first.nearest(&second), second.nearest(&first)] {
            assert!((found.distance - distance).abs() < 1e-9, "{found:?} {distance}");
        }
    }
}

#[test]
fn the_distance_does_not_depend_on_the_frame() {
    let mut stream = Stream(13);
    for _ in 0..500 {
        let (first, second) = (any(&mut stream, 0), any(&mut stream, 1));
        let by = frame(&mut stream, 5.0);
        let [here, there] = [
            first.nearest(&second),
            first.moved(&by).nearest(&second.moved(&by)),
        ];
        assert!((here.distance - there.distance).abs() < 1e-9);
    }
}

#[test]
fn points_of_a_cylinder_are_on_its_end_for_directions_almost_along_the_axis() {
    let mut stream = Stream(33);
    for _ in 0..2_000 {
        let axis = Segment {
            from: stream.vector(1.0).into(),
            to: stream.vector(1.0).into(),
        };
        let core = Core::Cylinder { axis, radius: 0.15 };
        let along = axis.to - axis.from;
        let unit = along.normalize();
        let across = unit.cross(&stream.vector(1.0)).normalize();
        let direction = unit + across * 10_f64.powf(stream.between(-12.0, -3.0));
        let point = core.support(&direction);
        assert!((point - axis.to).dot(&unit).abs() < 1e-14, "{direction}");
        assert!((point - axis.to).norm() < 0.15 + 1e-14);
    }
}
