use super::*;

/// Numbers between -1 and 1 from a seed (a linear congruence; only variety is needed).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed
        .wrapping_mul(2_862_933_555_777_941_757)
        .wrapping_add(3_037_000_493);
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Points in a body of these half lengths, turned.
fn cloud(seed: u64, half: [f64; 3], count: usize) -> Vec<Point3<f64>> {
    let mut number = numbers(seed);
    let turn = nalgebra::Rotation3::from_euler_angles(number() * 3.0, number() * 1.5, number() * 3.0);
    (0..count)
        .map(|_| turn * Point3::new(half[0] * number(), half[1] * number(), half[2] * number()))
        .collect()
}

fn is_inside(capsule: &Capsule, point: &Point3<f64>) -> bool {
    (capsule.axis.nearest_to_point(point) - point).norm() <= capsule.radius
}

/// The smallest capsule of all lines of a fine grid: directions over a half sphere, and shifts about the middle.
fn smallest_of_a_grid(points: &[Point3<f64>]) -> f64 {
    let mut best = f64::INFINITY;
    for index in 0..700 {
        let direction = on_sphere(index, 1400);
        let (u, v) = across(&direction);
        let along = |axis: &Vector3<f64>| {
            let reach = points.iter().map(|point| point.coords.dot(axis));
            reach.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            })
        };
        let (in_u, in_v) = (along(&u), along(&v));
        for i in 0..7 {
            for j in 0..7 {
                let at = |[least, greatest]: [f64; 2], k: i32| {
                    0.5 * (least + greatest) + 0.03 * f64::from(k - 3) * (greatest - least)
                };
                let from = Point3::from(u * at(in_u, i) + v * at(in_v, j));
                let to = from + direction;
                best = best.min(volume(&Capsule::around(points, &Segment { from, to })));
            }
        }
    }
    best
}

#[test]
fn every_point_is_inside() {
    let shapes = [[1.0, 0.3, 0.2], [0.5, 0.5, 0.1], [1.0, 1.0, 1.0], [0.4, 0.0, 0.0]];
    for (seed, half) in (0..20).zip(shapes.into_iter().cycle()) {
        for count in [1, 2, 5, 60, 900] {
            let points = cloud(seed, half, count);
            let capsule = enclosing_capsule(&points).unwrap();
            let outside = points.iter().filter(|point| !is_inside(&capsule, point)).count();
            assert_eq!(outside, 0, "seed {seed}, {count} points");
        }
    }
    assert!(enclosing_capsule(&[]).is_none());
}

#[test]
fn no_line_of_a_fine_grid_has_a_capsule_that_is_smaller_by_five_percent() {
    for (seed, half) in [
        (1, [1.0, 0.3, 0.2]),
        (2, [0.6, 0.5, 0.1]),
        (3, [0.5, 0.5, 0.5]),
        (4, [1.0, 0.7, 0.4]),
    ] {
        let points = cloud(seed, half, 40);
        let own = volume(&enclosing_capsule(&points).unwrap());
        let grid = smallest_of_a_grid(&points);
        assert!(own <= 1.05 * grid, "seed {seed}: {own} m^3, grid {grid} m^3");
    }
}

#[test]
fn the_capsule_of_points_on_a_capsule_is_that_capsule() {
    // The witness is the body that the points are on.
    let (from, to, radius) = (Point3::new(0.3, -0.2, 0.1), Point3::new(0.9, 0.5, 0.4), 0.15);
    let unit = (to - from).normalize();
    let points: Vec<Point3<f64>> = (0..1200)
        .map(|index| {
            let out = on_sphere(index, 1200) * radius;
            if out.dot(&unit) > 0.0 {
                to + out
            } else {
                from + out
            }
        })
        .collect();
    let found = enclosing_capsule(&points).unwrap();
    assert!((found.radius - radius).abs() < 2e-3, "{found:?}");
    let ends = [from, to].map(|end| (found.axis.nearest_to_point(&end) - end).norm());
    assert!(ends.iter().all(|apart| *apart < 3e-3), "{found:?}");
}

/// The faces of a box between two corners.
fn faces(least: [f64; 3], greatest: [f64; 3]) -> Vec<[Point3<f64>; 3]> {
    let corners = Bounds {
        least: Point3::from(least),
        greatest: Point3::from(greatest),
    }
    .corners();
    let quads = [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ];
    quads
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .map(|triangle| triangle.map(|corner: usize| corners[corner]))
        .collect()
}

#[test]
fn an_angle_of_two_bars_takes_two_capsules_with_far_less_volume() {
    let mut surface = faces([0.0, -0.05, -0.05], [1.0, 0.05, 0.05]);
    surface.extend(faces([0.0, -0.05, 0.0], [0.1, 0.05, 1.0]));
    let one = enclosing_capsules(&surface, 1);
    let two = enclosing_capsules(&surface, 2);
    let sum = |parts: &[Enclosed]| parts.iter().map(|part| volume(&part.capsule)).sum::<f64>();
    assert_eq!((one.len(), two.len()), (1, 2));
    assert!(sum(&two) < 0.25 * sum(&one), "{} of {}", sum(&two), sum(&one));
    // Every point of the surface, not its corners alone, is in one of them.
    let mut number = numbers(7);
    for [a, b, c] in &surface {
        for _ in 0..50 {
            let (s, t) = (0.5 + 0.5 * number(), 0.5 + 0.5 * number());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let point = a + (b - a) * s + (c - a) * t;
            assert!(two.iter().any(|part| is_inside(&part.capsule, &point)), "{point}");
        }
    }
}

#[test]
fn a_cut_that_saves_nothing_is_not_made() {
    let ball = faces([-0.1; 3], [0.1; 3]);
    assert_eq!(enclosing_capsules(&ball, 3).len(), 1);
    assert!(enclosing_capsules(&[], 3).is_empty());
}

#[test]
fn a_given_axis_keeps_its_ends() {
    let axis = Segment {
        from: Point3::new(0.0, 0.0, 0.0),
        to: Point3::new(1.0, 0.0, 0.0),
    };
    let points = [Point3::new(0.5, 0.2, 0.0), Point3::new(1.3, 0.0, 0.4)];
    let capsule = about_axis(axis, &points);
    assert_eq!(capsule.axis, axis);
    assert!((capsule.radius - 0.5).abs() < 1e-15);
}
