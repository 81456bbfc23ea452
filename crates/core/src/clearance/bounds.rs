//! Simple bodies around others, for lower bounds of distances: boxes along the axes, and capsules.
//!
//! A bound never exceeds the true distance, so that what it excludes is excluded rightly. Lengths in m.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

use super::nearest::Segment;

/// A box along the axes of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub least: Point3<f64>,
    /// Greatest coordinates.
    pub greatest: Point3<f64>,
}

impl Bounds {
    /// Around nothing.
    pub const EMPTY: Bounds = Bounds {
        least: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        greatest: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// Around these points.
    pub fn of(points: impl IntoIterator<Item = Point3<f64>>) -> Bounds {
        points
            .into_iter()
            .fold(Bounds::EMPTY, |bounds, point| bounds.with(&point))
    }

    /// Grown to this point.
    pub fn with(&self, point: &Point3<f64>) -> Bounds {
        Bounds {
            least: self.least.inf(point),
            greatest: self.greatest.sup(point),
        }
    }

    /// Around both.
    pub fn joined(&self, other: &Bounds) -> Bounds {
        Bounds {
            least: self.least.inf(&other.least),
            greatest: self.greatest.sup(&other.greatest),
        }
    }

    /// Larger by this on every side.
    pub fn grown(&self, by: f64) -> Bounds {
        let by = Vector3::repeat(by);
        Bounds {
            least: self.least - by,
            greatest: self.greatest + by,
        }
    }

    /// Its centre.
    pub fn centre(&self) -> Point3<f64> {
        nalgebra::center(&self.least, &self.greatest)
    }

    /// Half its edges.
    pub fn half(&self) -> Vector3<f64> {
        (self.greatest - self.least) * 0.5
    }

    /// Its eight corners.
    pub fn corners(&self) -> [Point3<f64>; 8] {
        let pick = |corner: usize, axis: usize| {
            if corner >> axis & 1 == 1 {
                self.greatest[axis]
            } else {
                self.least[axis]
            }
        };
        std::array::from_fn(|corner| Point3::new(pick(corner, 0), pick(corner, 1), pick(corner, 2)))
    }

    /// Distance of two boxes in the same frame; 0 where they overlap.
    pub fn distance(&self, other: &Bounds) -> f64 {
        let gap = |axis: usize| {
            let before = other.least[axis] - self.greatest[axis];
            let behind = self.least[axis] - other.greatest[axis];
            before.max(behind).max(0.0)
        };
        Vector3::new(gap(0), gap(1), gap(2)).norm()
    }

    /// Distance of a point from the box; 0 inside.
    pub fn distance_of(&self, point: &Point3<f64>) -> f64 {
        let gap = |axis: usize| {
            (self.least[axis] - point[axis])
                .max(point[axis] - self.greatest[axis])
                .max(0.0)
        };
        Vector3::new(gap(0), gap(1), gap(2)).norm()
    }

    /// How far it reaches against and along a direction, m: the least and the greatest product with its points.
    pub fn extent(&self, direction: &Vector3<f64>) -> [f64; 2] {
        let (middle, half) = (
            direction.dot(&self.centre().coords),
            direction.abs().dot(&self.half()),
        );
        [middle - half, middle + half]
    }

    /// A box around this one, seen from another frame; `turn` is the rotation of `by` without signs.
    pub fn moved(&self, by: &IsometryMatrix3<f64>, turn: &Matrix3<f64>) -> Bounds {
        let (centre, half) = (by * self.centre(), turn * self.half());
        Bounds {
            least: centre - half,
            greatest: centre + half,
        }
    }
}

/// A capsule: all within a radius of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Its axis, a point for a ball.
    pub axis: Segment,
    /// Its radius, m.
    pub radius: f64,
}

impl Capsule {
    /// In another frame.
    pub fn moved(&self, by: &IsometryMatrix3<f64>) -> Capsule {
        Capsule {
            axis: self.axis.moved(by),
            radius: self.radius,
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds::of([self.axis.from, self.axis.to]).grown(self.radius)
    }

    /// How far it reaches against and along a direction (unit, or zero), m.
    pub fn extent(&self, direction: &Vector3<f64>) -> [f64; 2] {
        let ends = [self.axis.from, self.axis.to].map(|end| direction.dot(&end.coords));
        [
            ends[0].min(ends[1]) - self.radius,
            ends[0].max(ends[1]) + self.radius,
        ]
    }

    /// A lower bound of the distance to whatever is inside of the box, m; may be negative.
    pub fn bound_to(&self, bounds: &Bounds) -> f64 {
        let of_boxes = Bounds::of([self.axis.from, self.axis.to]).distance(bounds);
        let centre = bounds.centre();
        let of_ball = (self.axis.nearest_to_point(&centre) - centre).norm() - bounds.half().norm();
        of_boxes.max(of_ball) - self.radius
    }

    /// Distance to another capsule, m; negative where they overlap.
    pub fn distance(&self, other: &Capsule) -> f64 {
        self.axis.nearest(&other.axis).distance - self.radius - other.radius
    }

    /// A lower bound of that distance, from balls around both.
    pub fn bound_of_balls(&self, other: &Capsule) -> f64 {
        let apart = (self.axis.middle() - other.axis.middle()).norm();
        apart - self.axis.half_length() - other.axis.half_length() - self.radius - other.radius
    }

    /// The smallest capsule about this axis that contains all points: each end is moved along the axis as far as the
    /// points permit.
    ///
    /// The radius is the largest distance of a point from the line, the ends are where the half balls still cover all.
    pub fn around(points: &[Point3<f64>], line: &Segment) -> Capsule {
        let along = line.to - line.from;
        let length = along.norm();
        if length == 0.0 {
            let radius = points
                .iter()
                .map(|point| (point - line.from).norm())
                .fold(0.0, f64::max);
            return Capsule { axis: *line, radius };
        }
        let unit = along / length;
        let height = |point: &Point3<f64>| (point - line.from).dot(&unit);
        let square = |point: &Point3<f64>| (point - line.from).cross(&unit).norm_squared();
        let radius = points.iter().map(square).fold(0.0, f64::max).sqrt();
        let reach = |point: &Point3<f64>| (radius * radius - square(point)).max(0.0).sqrt();
        let from = points
            .iter()
            .map(|point| height(point) + reach(point))
            .fold(f64::INFINITY, f64::min);
        let to = points
            .iter()
            .map(|point| height(point) - reach(point))
            .fold(f64::NEG_INFINITY, f64::max);
        // Where a ball is enough, the two ends pass each other: any point between them is its centre.
        let (from, to) = if from > to {
            (0.5 * (from + to), 0.5 * (from + to))
        } else {
            (from, to)
        };
        Capsule {
            axis: Segment {
                from: line.from + unit * from,
                to: line.from + unit * to,
            },
            radius,
        }
    }
}

#[cfg(test)]
mod tests;
