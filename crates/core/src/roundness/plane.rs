//! Points in space, projected on their least-squares plane.
//!
//! The least-squares plane passes through the mean of the points; its normal `n` is the direction of their least
//! spread, pointing to the positive side of the base axis that it is nearest to. The axes of the plane are:
//!
//! | `n` nearest to | x of the plane, nearest to | y of the plane, nearest to |
//! |---|---|---|
//! | z | x | y |
//! | x | y | z |
//! | y | z | x |
//!
//! x is that base axis without its part along `n`, y is `n x x`. Source: ISO 12781, LSPL.

use nalgebra::{Matrix3, Point2, Point3, Vector3};

use super::least_squares::ON_A_LINE;

/// A plane with its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Mean of the points, m.
    pub origin: Point3<f64>,
    /// First axis of the plane, of length 1.
    pub x: Vector3<f64>,
    /// Second axis.
    pub y: Vector3<f64>,
    /// Normal: x, y and it make a right-handed frame.
    pub normal: Vector3<f64>,
    /// Peak to valley of the points along the normal, m.
    pub flatness: f64,
}

impl Plane {
    /// The least-squares plane of `points` (m); `None` below three, and where they are on a line.
    pub fn nearest(points: &[Point3<f64>]) -> Option<Plane> {
        let sum: Vector3<f64> = points.iter().map(|p| p.coords).sum();
        let origin = Point3::from(sum / points.len().max(1) as f64);
        let off = || points.iter().map(|p| p - origin);
        let spread: Matrix3<f64> = off().map(|v| v * v.transpose()).sum();
        if !spread.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let eigen = spread.symmetric_eigen();
        let values = eigen.eigenvalues;
        let (least, most) = (values.imin(), values.imax());
        let middle = values.sum() - values[least] - values[most];
        if points.len() < 3 || middle <= ON_A_LINE * values[most] {
            return None;
        }
        let normal = eigen.eigenvectors.column(least).into_owned();
        let nearest_axis = normal.iamax();
        let normal = normal * normal[nearest_axis].signum();
        let along = Vector3::ith((nearest_axis + 1) % 3, 1.0);
        let x = (along - normal * along.dot(&normal)).normalize();
        let heights = off().map(|v| v.dot(&normal));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
        Some(Plane {
            origin,
            x,
            y: normal.cross(&x),
            normal,
            flatness: high - low,
        })
    }

    /// Projection of `point` on the plane, from its origin.
    pub fn seen(&self, point: &Point3<f64>) -> Point2<f64> {
        let from = point - self.origin;
        Point2::new(from.dot(&self.x), from.dot(&self.y))
    }

    /// The point in space of the plane coordinates `point`.
    pub fn at(&self, point: &Point2<f64>) -> Point3<f64> {
        self.origin + self.x * point.x + self.y * point.y
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;

    /// Points over x and y of the plane through (5, -3, 2) m whose normal is turned from z.
    fn tilted(turn: &Rotation3<f64>, height: impl Fn(f64, f64) -> f64) -> Vec<Point3<f64>> {
        let grid = (-5..=5).flat_map(|i| (-4..=4).map(move |j| (f64::from(i) / 10.0, f64::from(j) / 10.0)));
        grid.map(|(x, y)| Point3::new(5.0, -3.0, 2.0) + turn * Vector3::new(x, y, height(x, y)))
            .collect()
    }

    #[test]
    fn a_plane_is_found_at_any_orientation_and_projected_points_are_recovered() {
        for turn in [[0.0, 0.0, 0.0], [0.3, -0.2, 1.1], [2.0, 0.7, -0.4]] {
            let turn = Rotation3::new(turn.into());
            let points = tilted(&turn, |_, _| 0.0);
            let plane = Plane::nearest(&points).unwrap();
            assert!(plane.normal.cross(&(turn * Vector3::z())).norm() < 1e-14);
            assert!((plane.x.cross(&plane.y) - plane.normal).norm() < 1e-14);
            assert!(plane.flatness < 1e-14);
            for point in &points {
                assert!((plane.at(&plane.seen(point)) - point).norm() < 1e-14);
            }
        }
    }

    #[test]
    fn the_axes_of_a_coordinate_plane_are_the_coordinate_axes() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        for normal in 0..3 {
            let (first, second) = (axes[(normal + 1) % 3], axes[(normal + 2) % 3]);
            let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
            let points = corners.map(|[a, b]| Point3::from(axes[normal] * 7.0 + first * a + second * b));
            let plane = Plane::nearest(&points).unwrap();
            assert_eq!((plane.x, plane.y, plane.normal), (first, second, axes[normal]));
            assert_eq!(plane.seen(&points[2]), Point2::new(1.0, 0.5));
        }
    }

    #[test]
    fn a_twist_is_flatness_and_does_not_tilt_the_plane() {
        let turn = Rotation3::new(Vector3::new(0.3, 0.1, 0.0));
        let plane = Plane::nearest(&tilted(&turn, |x, y| 1e-3 * x * y)).unwrap();
        // The corners of 0.5 by 0.4 m are 0.2 mm up and down.
        assert!((plane.flatness - 0.4e-3).abs() < 1e-12, "{}", plane.flatness);
        assert!(plane.normal.cross(&(turn * Vector3::z())).norm() < 1e-12);
    }

    #[test]
    fn points_on_a_line_at_one_position_or_too_few_have_no_plane() {
        let line: Vec<_> = (0..9)
            .map(|i| Point3::new(f64::from(i), 2.0 * f64::from(i), 1.0))
            .collect();
        assert_eq!(Plane::nearest(&line), None);
        assert_eq!(Plane::nearest(&[Point3::new(1.0, 2.0, 3.0); 5]), None);
        assert_eq!(Plane::nearest(&line[..2]), None);
        assert_eq!(Plane::nearest(&[]), None);
    }
}
