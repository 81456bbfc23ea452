use nalgebra::{Point3, Vector3};

use super::*;

/// Two lines of 100 mm with a corner of this angle, a point every 10 mm; one prismatic joint for each coordinate.
fn corner(angle: f64) -> (Vec<Point3<f64>>, Vec<f64>) {
    let turned = Vector3::new(angle.cos(), angle.sin(), 0.0);
    let points: Vec<Point3<f64>> = (0..21)
        .map(|i| {
            let s = 0.01 * (f64::from(i) - 10.0);
            Point3::origin() + if s < 0.0 { Vector3::x() * s } else { turned * s }
        })
        .collect();
    let positions = points.iter().flat_map(|at| [at.x, at.y, at.z]).collect();
    (points, positions)
}

#[test]
fn a_corner_between_lines_is_as_far_from_its_path_as_by_hand() {
    let angle = 0.52_f64;
    let (points, positions) = corner(angle);
    let feeds = [0.1; 20];
    for radius in [0.001, 0.02, 0.043] {
        let path = Programmed {
            points: &points,
            positions: &positions,
            feeds: &feeds,
            zones: &[(10, radius)],
        }
        .rounded();
        let middle = path.errors[10];
        assert!(
            (middle.norm() - 7.0 / 16.0 * radius * (0.5 * angle).sin()).abs() < 1e-12,
            "{radius}: {middle}"
        );
        let inwards = Vector3::new(angle.cos() - 1.0, angle.sin(), 0.0).normalize();
        assert!((middle.normalize() - inwards).norm() < 1e-9);
        // Shorter than the programmed path, symmetrical, and where it is programmed outside the zone.
        let length = path.along[path.along.len() - 1];
        assert!(length < 0.2 - 1e-6 * radius && length > 0.2 - 2.0 * radius * (1.0 - (0.5 * angle).cos()));
        assert!((path.passes[10] - 0.5 * length).abs() < 1e-12 && length == path.along[path.along.len() - 1]);
        assert!(
            path.errors[..(10.0 - radius * 100.0) as usize]
                .iter()
                .all(|error| error.norm() == 0.0)
        );
        assert_eq!((path.passes.len(), path.errors.len()), (21, 21));
        assert_eq!(path.feeds.len() + 1, path.points.len());
        assert!(path.along.is_sorted_by(|a, b| a < b) && path.passes.is_sorted());
        // Joints that are the coordinates are where the tip is.
        for (at, q) in path.points.iter().zip(path.positions.chunks(3)) {
            assert!((at - Point3::new(q[0], q[1], q[2])).norm() < 1e-15);
        }
    }
}

#[test]
fn zones_take_at_most_half_of_a_move_and_meet_there() {
    let points: Vec<Point3<f64>> = [[0., 0.], [0.1, 0.], [0.1, 0.02], [0.2, 0.02]]
        .map(|[x, y]| Point3::new(x, y, 0.0))
        .to_vec();
    let positions: Vec<f64> = points.iter().flat_map(|at| [at.x, at.y]).collect();
    let path = Programmed {
        points: &points,
        positions: &positions,
        feeds: &[0.1, 0.2, 0.3],
        zones: &[(1, 1.0), (2, 0.03)],
    }
    .rounded();
    let farthest = path.errors.iter().map(Vector3::norm).fold(0.0, f64::max);
    assert!(
        (farthest - 7.0 / 32.0 * 0.01 * 2f64.sqrt()).abs() < 1e-12,
        "{farthest}"
    );
    assert!(path.along.is_sorted_by(|a, b| a < b), "no point twice");
    assert!(
        path.points
            .iter()
            .any(|at| (at - Point3::new(0.1, 0.01, 0.0)).norm() < 1e-12)
    );
    let feeds = |from: f64, to: f64| {
        path.along
            .iter()
            .zip(&path.feeds)
            .filter(move |(at, _)| (from..to).contains(*at))
            .map(|(_, feed)| *feed)
    };
    assert!(feeds(0.0, 0.09).all(|feed| feed == 0.1) && feeds(0.12, 1.0).all(|feed| feed == 0.3));
}

#[test]
fn without_zones_the_path_is_the_programmed_one() {
    let (points, positions) = corner(1.0);
    let path = Programmed {
        points: &points,
        positions: &positions,
        feeds: &[0.1; 20],
        zones: &[(10, 0.0)],
    }
    .rounded();
    assert_eq!(path.passes.len(), points.len());
    for (index, at) in path.passes.iter().enumerate() {
        let there = path.along.iter().position(|along| along == at).unwrap();
        assert_eq!(
            (path.points[there], &path.positions[3 * there..3 * there + 3]),
            (points[index], &positions[3 * index..3 * index + 3])
        );
    }
    // Towards the stops points are dense.
    assert!(path.along[1] < 2e-5 && path.points.len() < points.len() + 30);
}
