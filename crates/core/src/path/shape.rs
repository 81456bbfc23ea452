//! Shapes on a workpiece plane: circle, line, polyline, rectangle, sampled into points.
//!
//! Coordinates are part x and y (m). A circle starts at base +y and turns towards z' (see
//! [`crate::workpiece`]), so the point at angle `phi` is `(-r cos phi, r sin phi)` from its centre.

use std::f64::consts::TAU;

use nalgebra::{Point2, Point3, Unit, Vector2, Vector3};

use super::passage::{MoveEnd, Passage};
use super::program::Pace;
use super::sampled::{Rapids, SampledPath};
use super::sampler::PathPoint;

/// A shape on the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A full circle.
    Circle {
        /// Centre, m.
        centre: Point2<f64>,
        /// m
        radius: f64,
    },
    /// Straight pieces through these points, at least two; closed if the last repeats the first.
    Polyline(Vec<Point2<f64>>),
}

impl Shape {
    /// The rectangle about `centre` with these side lengths (m, part x and y), from its lower left corner,
    /// counter-clockwise seen from the tool side.
    pub fn rectangle(centre: Point2<f64>, size: Vector2<f64>) -> Shape {
        let corner = |x: f64, y: f64| centre + Vector2::new(x * size.x, y * size.y) * 0.5;
        Shape::Polyline(vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
            corner(-1.0, -1.0),
        ])
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        match self {
            Shape::Circle { radius, .. } => TAU * radius,
            Shape::Polyline(corners) => corners.windows(2).map(|w| (w[1] - w[0]).norm()).sum(),
        }
    }

    /// Whether it ends where it begins without repeating its first point: a circle.
    pub fn is_closed(&self) -> bool {
        matches!(self, Shape::Circle { .. })
    }

    /// Points no farther apart than `step` (m) along the shape, evenly spaced on each piece, corners included; path
    /// axes are those of the part, each piece has its own line, and no feed is given. A circle is not closed by a
    /// second copy of its first point.
    pub fn sampled(&self, step: f64) -> SampledPath {
        let points = match self {
            Shape::Circle { centre, radius } => round(centre, *radius, step),
            Shape::Polyline(corners) => straight(corners, step),
        };
        SampledPath {
            // A circle has none.
            ends: if self.is_closed() {
                Vec::new()
            } else {
                corners(&points)
            },
            moves: points.last().map_or(0, |point| point.line as usize),
            rapids: vec![Rapids::default(); usize::from(!points.is_empty())],
            points,
            ..SampledPath::default()
        }
    }
}

/// The ends of the pieces: where the next one begins, and the last point.
fn corners(points: &[PathPoint]) -> Vec<MoveEnd> {
    let begins = (1..points.len()).filter(|index| points[*index].line != points[*index - 1].line);
    let ends = begins.chain(points.len().checked_sub(1));
    ends.map(|point| MoveEnd {
        point,
        passage: Passage::Unknown,
    })
    .collect()
}

fn round(centre: &Point2<f64>, radius: f64, step: f64) -> Vec<PathPoint> {
    let count = pieces(TAU * radius, step).max(3);
    let point = |i: usize| {
        let phi = TAU * i as f64 / count as f64;
        let (sin, cos) = phi.sin_cos();
        let at = centre + Vector2::new(-cos, sin) * radius;
        point(at, Vector2::new(sin, cos), phi * radius, 0)
    };
    (0..count).map(point).collect()
}

fn straight(corners: &[Point2<f64>], step: f64) -> Vec<PathPoint> {
    let mut points: Vec<PathPoint> = Vec::new();
    let mut along = 0.0;
    let sides = corners.windows(2).map(|ends| (ends[0], ends[1] - ends[0]));
    for (piece, (from, side)) in sides.enumerate().filter(|(_, (_, side))| side.norm() > 0.0) {
        let count = pieces(side.norm(), step);
        for i in 0..count {
            let t = i as f64 / count as f64;
            points.push(point(from + side * t, side, along + side.norm() * t, piece));
        }
        along += side.norm();
    }
    let end = points.last().copied().zip(corners.last());
    points.extend(end.map(|(before, last)| PathPoint {
        at: Point3::new(last.x, last.y, 0.0),
        along,
        ..before
    }));
    points
}

/// A point of piece number `piece`.
fn point(at: Point2<f64>, direction: Vector2<f64>, along: f64, piece: usize) -> PathPoint {
    PathPoint {
        at: Point3::new(at.x, at.y, 0.0),
        axis: None,
        normal: None,
        spin: None,
        direction: Unit::new_normalize(Vector3::new(direction.x, direction.y, 0.0)),
        along,
        pace: Pace::Unknown,
        line: piece as u32 + 1,
    }
}

/// Number of pieces no longer than `step` in `length`; at least one.
fn pieces(length: f64, step: f64) -> usize {
    ((length / step - 1e-9).ceil() as usize).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_radius_100_mm_in_5_deg_steps_has_72_points() {
        let circle = Shape::Circle {
            centre: Point2::origin(),
            radius: 0.1,
        };
        let path = circle.sampled(TAU * 0.1 / 72.0);
        let points = &path.points;
        assert_eq!(points.len(), 72);
        assert!((points[0].at - Point3::new(-0.1, 0.0, 0.0)).norm() < 1e-15);
        assert!((points[18].at - Point3::new(0.0, 0.1, 0.0)).norm() < 1e-15);
        let mut stretches = path.stretches();
        assert_eq!((stretches.next(), stretches.next()), (Some(0..72), None));
    }

    #[test]
    fn the_tip_goes_from_point_to_point() {
        let circle = Shape::Circle {
            centre: Point2::new(0.3, -0.2),
            radius: 0.1,
        };
        let square = Shape::rectangle(Point2::new(0.1, 0.2), Vector2::new(0.3, 0.1));
        // A chord of 1 mm leaves the tangent of a circle of 100 mm by half its angle, 5e-3, and is 4e-9 m shorter than
        // its arc; lines keep to rounding.
        for (shape, bend) in [(circle, 5.1e-3), (square, 1e-12)] {
            let points = shape.sampled(1e-3).points;
            for pair in points.windows(2).filter(|pair| pair[0].line == pair[1].line) {
                let chord = (pair[1].at - pair[0].at).normalize();
                assert!((chord - pair[0].direction.into_inner()).norm() < bend);
                assert!(((pair[1].at - pair[0].at).norm() - (pair[1].along - pair[0].along)).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn polyline_points_keep_corners_and_step() {
        let square = Shape::rectangle(Point2::new(0.1, 0.2), Vector2::new(0.3, 0.1));
        let path = square.sampled(0.04);
        let points = &path.points;
        assert_eq!(points.first().unwrap().at, points.last().unwrap().at);
        assert!((path.length() - 0.8).abs() < 1e-15 && path.moves == 4);
        for pair in points.windows(2) {
            assert!((pair[1].at - pair[0].at).norm() < 0.04 + 1e-12);
        }
        let corner = Point3::new(0.25, 0.25, 0.0);
        assert!(points.iter().any(|p| (p.at - corner).norm() < 1e-15));
    }

    #[test]
    fn a_piece_of_zero_length_has_no_points() {
        let [a, b] = [Point2::new(0.0, 0.0), Point2::new(0.1, 0.0)];
        let twice = Shape::Polyline(vec![a, a, b, b]);
        assert_eq!(twice.sampled(0.05).points.len(), 3);
        assert!(Shape::Polyline(vec![a, a]).sampled(0.05).points.is_empty());
    }
}
