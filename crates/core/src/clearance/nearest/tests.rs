use super::*;
use crate::arms::Stream;

fn point(stream: &mut Stream) -> Point3<f64> {
    stream.vector(1.0).into()
}

fn segment(stream: &mut Stream) -> Segment {
    Segment {
        from: point(stream),
        to: point(stream),
    }
}

fn triangle(stream: &mut Stream) -> Triangle {
    Triangle([0; 3].map(|_| point(stream)))
}

/// Convex bodies are nearest at these two points if the planes through them, across their connection, have one body on each
/// side.
fn assert_certified(first: &[Point3<f64>], second: &[Point3<f64>], found: &Nearest) {
    let [from, to] = found.points;
    let across = to - from;
    assert!((across.norm() - found.distance).abs() < 1e-12);
    if found.distance == 0.0 {
        return;
    }
    let unit = across / found.distance;
    for corner in first {
        assert!(unit.dot(&(corner - from)) < 1e-9, "{found:?}");
    }
    for corner in second {
        assert!(unit.dot(&(corner - to)) > -1e-9, "{found:?}");
    }
}

#[test]
fn planes_between_segments_and_triangles_prove_the_distance() {
    let mut stream = Stream(1);
    for _ in 0..20_000 {
        let (a, b) = (segment(&mut stream), segment(&mut stream));
        let (t, u) = (triangle(&mut stream), triangle(&mut stream));
        let ends = |segment: &Segment| [segment.from, segment.to];
        assert_certified(&ends(&a), &ends(&b), &a.nearest(&b));
        assert_certified(&ends(&a), &t.0, &t.nearest_to_segment(&a));
        assert_certified(&t.0, &u.0, &t.nearest(&u));
        let p = point(&mut stream);
        assert_certified(&[p], &t.0, &Nearest::between(p, t.nearest_to_point(&p)));
    }
}

#[test]
fn the_points_are_on_both_bodies() {
    let mut stream = Stream(2);
    for _ in 0..5_000 {
        let (t, u) = (triangle(&mut stream), triangle(&mut stream));
        let [on_first, on_second] = t.nearest(&u).points;
        assert!((t.nearest_to_point(&on_first) - on_first).norm() < 1e-12);
        assert!((u.nearest_to_point(&on_second) - on_second).norm() < 1e-12);
    }
}

#[test]
fn triangles_that_cross_touch() {
    let corners = |points: [[f64; 3]; 3]| Triangle(points.map(Point3::from));
    let flat = corners([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let through = corners([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [0.3, 0.1, 1.0]]);
    let beside = corners([[0.6, 0.6, -1.0], [0.6, 0.6, 1.0], [0.9, 0.9, 0.5]]);
    assert_eq!(flat.nearest(&through).distance, 0.0);
    // Across the long edge, by hand.
    assert!((flat.nearest(&beside).distance - 0.2 / 2.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(flat.nearest(&flat).distance, 0.0);
}

#[test]
fn parallel_and_degenerate_segments_are_as_far_as_by_hand() {
    let along = |from: [f64; 3], to: [f64; 3]| Segment {
        from: from.into(),
        to: to.into(),
    };
    let first = along([0.0; 3], [1.0, 0.0, 0.0]);
    for (other, distance) in [
        (along([0.5, 0.3, 0.0], [2.0, 0.3, 0.0]), 0.3),
        (along([2.0, 0.0, 0.0], [5.0, 0.0, 0.0]), 1.0),
        (along([-3.0, 0.4, 0.0], [-1.0, 0.4, 0.0]), 1.16_f64.sqrt()),
        (along([0.2, 0.0, 0.7], [0.2, 0.0, 0.7]), 0.7),
        (along([0.2, -1.0, 0.1], [0.2, 1.0, 0.1]), 0.1),
    ] {
        assert!((first.nearest(&other).distance - distance).abs() < 1e-15);
        assert!((other.nearest(&first).distance - distance).abs() < 1e-15);
    }
}

#[test]
fn nearly_parallel_segments_lose_no_more_than_is_said() {
    let mut stream = Stream(3);
    for power in 6..12 {
        for _ in 0..500 {
            let first = segment(&mut stream);
            let tilt = stream.vector(1.0) * 10.0_f64.powi(-power);
            let offset = stream.vector(0.1);
            let other = Segment {
                from: first.from + offset,
                to: first.to + offset + tilt,
            };
            let found = first.nearest(&other);
            let steps = (0..=1000).map(|i| first.at(f64::from(i) / 1000.0));
            let least = steps
                .map(|p| (other.nearest_to_point(&p) - p).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(found.distance < least + 1e-7, "{found:?} {least}");
        }
    }
}

#[test]
fn a_gap_is_never_above_the_distance_and_that_of_parallel_planes() {
    let mut stream = Stream(4);
    let mut positive = 0;
    for _ in 0..20_000 {
        let (t, u, a) = (triangle(&mut stream), triangle(&mut stream), segment(&mut stream));
        let gaps = [t.gap(&u.0), u.gap(&t.0)];
        assert!(gaps[0].max(gaps[1]) <= t.nearest(&u).distance + 1e-12);
        assert!(t.gap(&[a.from, a.to]) <= t.nearest_to_segment(&a).distance + 1e-12);
        positive += usize::from(gaps[0] > 0.0);
    }
    assert!(positive > 2_000, "{positive}");
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    let above = corners.map(|corner| corner + Vector3::z() * 0.3);
    assert!((Triangle(corners).gap(&above) - 0.3).abs() < 1e-15);
    let degenerate = Triangle([corners[0], corners[0], corners[1]]);
    assert_eq!(degenerate.gap(&above), 0.0);
}

#[test]
fn halves_of_a_triangle_are_inside_of_it_and_have_half_its_area_each() {
    let mut stream = Stream(23);
    for _ in 0..1000 {
        let triangle = triangle(&mut stream);
        let area = triangle.area_vector();
        let (centre, radius) = triangle.ball();
        for half in triangle.halves() {
            assert!((half.area_vector() * 2.0 - area).norm() < 1e-14);
            assert!(half.longest_edge() <= triangle.longest_edge());
            for corner in half.0 {
                assert!((triangle.nearest_to_point(&corner) - corner).norm() < 1e-14);
                assert!((corner - centre).norm() <= radius * (1.0 + 1e-15));
            }
        }
    }
}
