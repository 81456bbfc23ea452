//! A line through points, and an arc.

use armill_core::nalgebra::{Matrix3, Point3, Vector3};

/// A line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// A point of it.
    pub point: Point3<f64>,
    /// Unit vector, from the first points towards the last.
    pub direction: Vector3<f64>,
}

impl Line {
    /// The line with the least sum of squares of distances; `None` of points at one place.
    pub(super) fn through(points: &[Point3<f64>]) -> Option<Line> {
        let (first, last) = (points.first()?, points.last()?);
        let centre = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64;
        let spread: Matrix3<f64> = points
            .iter()
            .map(|point| (point.coords - centre) * (point.coords - centre).transpose())
            .sum();
        let eigen = spread.symmetric_eigen();
        let direction = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
        let turned = if direction.dot(&(last - first)) < 0.0 {
            -direction
        } else {
            direction
        };
        turned.try_normalize(1e-9).map(|direction| Line {
            point: centre.into(),
            direction,
        })
    }

    /// Distance of a point along the line from its point, m.
    pub(super) fn along(&self, point: &Point3<f64>) -> f64 {
        (point - self.point).dot(&self.direction)
    }

    /// From the line to a point, across the line, m.
    pub(super) fn offset(&self, point: &Point3<f64>) -> Vector3<f64> {
        let all = point - self.point;
        all - self.direction * all.dot(&self.direction)
    }

    /// The nearest point of the line.
    pub(super) fn nearest(&self, point: &Point3<f64>) -> Point3<f64> {
        self.point + self.direction * self.along(point)
    }

    /// The middle of the shortest connection of two lines; `None` if they are parallel.
    pub(super) fn crossing(&self, other: &Line) -> Option<Point3<f64>> {
        let between = other.point - self.point;
        let c = self.direction.dot(&other.direction);
        let apart = 1.0 - c * c;
        if apart < 1e-9 {
            return None;
        }
        let (a, b) = (between.dot(&self.direction), between.dot(&other.direction));
        let one = self.point + self.direction * ((a - c * b) / apart);
        let two = other.point + other.direction * ((c * a - b) / apart);
        Some(one + (two - one) * 0.5)
    }
}

/// Radius of the circle through the first, the middle and the last of these points, m, and the largest distance of the others from it; `None` if they are on a line.
pub(super) fn circle(points: &[Point3<f64>]) -> Option<(f64, f64)> {
    let (a, b, c) = (points.first()?, points.get(points.len() / 2)?, points.last()?);
    let (u, v) = (b - a, c - a);
    let normal = u.cross(&v);
    let area = normal.norm_squared();
    if area <= 1e-18 {
        return None;
    }
    let to_centre =
        (v.norm_squared() * normal.cross(&u) - u.norm_squared() * normal.cross(&v)) / (2.0 * area);
    let (centre, radius, axis) = (a + to_centre, to_centre.norm(), normal.normalize());
    let far = |point: &Point3<f64>| {
        let offset = point - centre;
        let height = offset.dot(&axis);
        height.hypot((offset - axis * height).norm() - radius)
    };
    Some((radius, points.iter().map(far).fold(0.0, f64::max)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_cross_in_the_middle_of_their_shortest_connection() {
        let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
        let one = Line::through(&[at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(2.0, 0.0, 0.0)]).unwrap();
        let two = Line::through(&[at(3.0, 0.0, 0.2), at(3.0, 1.0, 0.2)]).unwrap();
        assert!((one.crossing(&two).unwrap() - at(3.0, 0.0, 0.1)).norm() < 1e-12);
        assert!(one.crossing(&one).is_none());
        assert!((one.offset(&at(5.0, 0.3, 0.4)).norm() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_circle_has_its_radius() {
        let points: Vec<Point3<f64>> = (0..20)
            .map(|k| {
                Point3::new(
                    0.3 * (0.05 * f64::from(k)).cos(),
                    0.3 * (0.05 * f64::from(k)).sin(),
                    0.7,
                )
            })
            .collect();
        let (radius, far) = circle(&points).unwrap();
        assert!((radius - 0.3).abs() < 1e-9 && far < 1e-9);
        assert!(
            circle(&[
                Point3::origin(),
                Point3::new(1.0, 0.0, 0.0),
                Point3::new(2.0, 0.0, 0.0)
            ])
            .is_none()
        );
    }
}
