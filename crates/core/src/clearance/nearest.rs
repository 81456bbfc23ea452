//! The nearest points of segments and triangles, in closed form.
//!
//! | pair | candidates |
//! |---|---|
//! | point and segment | projection, clamped to the ends |
//! | segment and segment | common perpendicular, clamped to the ends of one after the other |
//! | point and triangle | projection if it is inside, else the edges |
//! | segment and triangle | piercing point; else ends above the inside, and the three edges |
//! | triangle and triangle | piercing points; else pairs of edges, and corners above the inside of the other |
//!
//! Points in m, all in one frame. Where segments are parallel, any of their nearest points is valid. Exact but for rounding: segments
//! within 1e-8 rad of parallel may be found as much as 1e-8 of their length too far apart.
//! Source: Ericson 2005, *Real-Time Collision Detection*, chapter 5.

use nalgebra::{IsometryMatrix3, Point3, Vector3};

/// The nearest points of two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Their distance, m; 0 where the bodies touch or overlap.
    pub distance: f64,
    /// The point of the first body, and that of the second.
    pub points: [Point3<f64>; 2],
}

impl Nearest {
    /// Of these two points.
    pub fn between(first: Point3<f64>, second: Point3<f64>) -> Nearest {
        Nearest {
            distance: (second - first).norm(),
            points: [first, second],
        }
    }

    /// Of bodies that have this point in common.
    pub fn touching(at: Point3<f64>) -> Nearest {
        Nearest {
            distance: 0.0,
            points: [at, at],
        }
    }

    /// With the bodies in the other order.
    pub fn swapped(self) -> Nearest {
        let [first, second] = self.points;
        Nearest {
            points: [second, first],
            ..self
        }
    }

    /// The nearer one; this one if they are equal.
    pub fn or_nearer(self, other: Nearest) -> Nearest {
        if other.distance < self.distance {
            other
        } else {
            self
        }
    }
}

/// A line segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// One end.
    pub from: Point3<f64>,
    /// The other end; may be the same point.
    pub to: Point3<f64>,
}

impl Segment {
    /// Its point nearest to `point`.
    pub fn nearest_to_point(&self, point: &Point3<f64>) -> Point3<f64> {
        let along = self.to - self.from;
        let square = along.norm_squared();
        if square == 0.0 {
            return self.from;
        }
        self.at(((point - self.from).dot(&along) / square).clamp(0.0, 1.0))
    }

    /// The point at this fraction of its length.
    pub fn at(&self, fraction: f64) -> Point3<f64> {
        self.from + (self.to - self.from) * fraction
    }

    /// The point in the middle.
    pub fn middle(&self) -> Point3<f64> {
        self.at(0.5)
    }

    /// Half its length.
    pub fn half_length(&self) -> f64 {
        0.5 * (self.to - self.from).norm()
    }

    /// The nearest points of two segments.
    pub fn nearest(&self, other: &Segment) -> Nearest {
        let (first, second) = (self.to - self.from, other.to - other.from);
        let between = self.from - other.from;
        let (a, e) = (first.norm_squared(), second.norm_squared());
        let f = second.dot(&between);
        if a == 0.0 {
            return Nearest::between(self.from, other.nearest_to_point(&self.from));
        }
        let c = first.dot(&between);
        if e == 0.0 {
            return Nearest::between(self.nearest_to_point(&other.from), other.from);
        }
        let b = first.dot(&second);
        let denominator = a * e - b * b;
        // Of parallel segments any point is a start.
        let s = if denominator > 0.0 {
            ((b * f - c * e) / denominator).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let t = ((b * s + f) / e).clamp(0.0, 1.0);
        // The point of the first for that of the second: the same where nothing was clamped.
        let s = ((b * t - c) / a).clamp(0.0, 1.0);
        Nearest::between(self.at(s), other.at(t))
    }
}

/// A triangle; may be degenerate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle(pub [Point3<f64>; 3]);

impl Triangle {
    /// Its edges.
    pub fn edges(&self) -> [Segment; 3] {
        let [a, b, c] = self.0;
        [(a, b), (b, c), (c, a)].map(|ends| Segment {
            from: ends.0,
            to: ends.1,
        })
    }

    /// In another frame.
    pub fn moved(&self, by: &IsometryMatrix3<f64>) -> Triangle {
        Triangle(self.0.map(|corner| by * corner))
    }

    /// A ball around it: centre and radius.
    pub(super) fn ball(&self) -> (Point3<f64>, f64) {
        let [a, b, c] = self.0;
        let centre = Point3::from((a.coords + b.coords + c.coords) / 3.0);
        let squares = self.0.map(|corner| (corner - centre).norm_squared());
        (centre, squares.into_iter().fold(0.0, f64::max).sqrt())
    }

    /// The length of its longest edge, m.
    pub(super) fn longest_edge(&self) -> f64 {
        let squares = self.edges().map(|edge| (edge.to - edge.from).norm_squared());
        squares.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// Its halves on both sides of the middle of its longest edge.
    pub(super) fn halves(&self) -> [Triangle; 2] {
        let [a, b, c] = self.0;
        let square = |a: &Point3<f64>, b: &Point3<f64>| (b - a).norm_squared();
        let (ab, bc, ca) = (square(&a, &b), square(&b, &c), square(&c, &a));
        let [a, b, c] = match (ab >= bc && ab >= ca, bc >= ca) {
            (true, _) => [a, b, c],
            (false, true) => [b, c, a],
            (false, false) => [c, a, b],
        };
        let middle = nalgebra::center(&a, &b);
        [Triangle([a, middle, c]), Triangle([middle, b, c])]
    }

    /// Twice its area along its normal.
    pub fn area_vector(&self) -> Vector3<f64> {
        let [a, b, c] = self.0;
        (b - a).cross(&(c - a))
    }

    /// The foot of the perpendicular from `point`, if it is inside of the triangle.
    fn foot(&self, point: &Point3<f64>, normal: &Vector3<f64>) -> Option<Point3<f64>> {
        let square = normal.norm_squared();
        if square == 0.0 {
            return None;
        }
        let inside = |edge: &Segment| normal.cross(&(edge.to - edge.from)).dot(&(point - edge.from)) >= 0.0;
        let height = normal.dot(&(point - self.0[0])) / square;
        self.edges().iter().all(inside).then(|| point - normal * height)
    }

    /// Its point nearest to `point`.
    pub fn nearest_to_point(&self, point: &Point3<f64>) -> Point3<f64> {
        if let Some(foot) = self.foot(point, &self.area_vector()) {
            return foot;
        }
        let [first, second, third] = self.edges().map(|edge| edge.nearest_to_point(point));
        let nearer = |a: Point3<f64>, b: Point3<f64>| {
            if (b - point).norm_squared() < (a - point).norm_squared() {
                b
            } else {
                a
            }
        };
        nearer(nearer(first, second), third)
    }

    /// Where this segment pierces the triangle.
    fn pierced_by(&self, segment: &Segment, normal: &Vector3<f64>) -> Option<Point3<f64>> {
        let [from, to] = [segment.from, segment.to].map(|end| normal.dot(&(end - self.0[0])));
        // A segment in the plane of the triangle meets an edge, if anything.
        if from * to > 0.0 || from == to {
            return None;
        }
        self.foot(&segment.at(from / (from - to)), normal)
    }

    /// The nearest points of a segment and this triangle, that of the segment first.
    pub fn nearest_to_segment(&self, segment: &Segment) -> Nearest {
        let normal = self.area_vector();
        if let Some(at) = self.pierced_by(segment, &normal) {
            return Nearest::touching(at);
        }
        let [first, second, third] = self.edges().map(|edge| segment.nearest(&edge));
        let mut best = first.or_nearer(second).or_nearer(third);
        for end in [segment.from, segment.to] {
            if let Some(foot) = self.foot(&end, &normal) {
                best = best.or_nearer(Nearest::between(end, foot));
            }
        }
        best
    }

    /// How far it reaches against and along a direction, m: the least and the greatest product with its corners.
    pub fn extent(&self, direction: &Vector3<f64>) -> [f64; 2] {
        self.range(|corner| direction.dot(&corner.coords))
    }

    /// The least and the greatest value of its corners.
    fn range(&self, value: impl Fn(&Point3<f64>) -> f64) -> [f64; 2] {
        let [a, b, c] = self.0.each_ref().map(value);
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// A lower bound of the distance of points from it, m: the gap between its plane and what is between these points.
    pub fn gap(&self, points: &[Point3<f64>]) -> f64 {
        let normal = self.area_vector();
        let length = normal.norm();
        let height = |point: &Point3<f64>| normal.dot(&(point - self.0[0]));
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for height in points.iter().map(height) {
            (least, greatest) = (least.min(height), greatest.max(height));
        }
        let gap = least.max(-greatest);
        // A degenerate triangle has no plane.
        if gap > 0.0 && length > 0.0 {
            gap / length
        } else {
            0.0
        }
    }

    /// The nearest points of two triangles.
    pub fn nearest(&self, other: &Triangle) -> Nearest {
        let (normal, others) = (self.area_vector(), other.area_vector());
        let (own, theirs) = (self.edges(), other.edges());
        let pierced = own.iter().find_map(|edge| other.pierced_by(edge, &others));
        if let Some(at) = pierced.or_else(|| theirs.iter().find_map(|edge| self.pierced_by(edge, &normal))) {
            return Nearest::touching(at);
        }
        let mut best = Nearest::between(self.0[0], other.0[0]);
        for first in &own {
            for second in &theirs {
                best = best.or_nearer(first.nearest(second));
            }
        }
        for corner in &self.0 {
            if let Some(foot) = other.foot(corner, &others) {
                best = best.or_nearer(Nearest::between(*corner, foot));
            }
        }
        for corner in &other.0 {
            if let Some(foot) = self.foot(corner, &normal) {
                best = best.or_nearer(Nearest::between(foot, *corner));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests;
