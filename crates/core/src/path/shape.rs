//! Shapes on a workpiece plane: circle, line, polyline, rectangle, sampled into points.
//!
//! Coordinates are part x and y (m). A circle starts at base +y and turns towards z' (see
//! [`crate::workpiece`]), so the point at angle `phi` is `(-r cos phi, r sin phi)` from its centre.

use std::f64::consts::TAU;

use nalgebra::{Point2, Vector2};

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

    /// Points no farther apart than `step` (m) along the shape, evenly spaced on each piece, corners included.
    /// A circle is not closed by a second copy of its first point.
    pub fn sampled(&self, step: f64) -> Vec<Sample> {
        match self {
            Shape::Circle { centre, radius } => {
                let count = pieces(TAU * radius, step).max(3);
                (0..count)
                    .map(|i| {
                        let phi = TAU * i as f64 / count as f64;
                        let at = centre + Vector2::new(-phi.cos(), phi.sin()) * *radius;
                        Sample {
                            at,
                            along: phi * radius,
                        }
                    })
                    .collect()
            }
            Shape::Polyline(corners) => {
                let mut samples = Vec::new();
                let mut along = 0.0;
                for side in corners.windows(2) {
                    let vector = side[1] - side[0];
                    let count = pieces(vector.norm(), step);
                    for i in 0..count {
                        let t = i as f64 / count as f64;
                        samples.push(Sample {
                            at: side[0] + vector * t,
                            along: along + vector.norm() * t,
                        });
                    }
                    along += vector.norm();
                }
                samples.extend(corners.last().map(|last| Sample { at: *last, along }));
                samples
            }
        }
    }
}

/// A point of a sampled path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where, m, part x and y.
    pub at: Point2<f64>,
    /// Distance from the start along the path, m.
    pub along: f64,
}

/// How many pieces no longer than `step` make up `length`; at least one.
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
        let samples = circle.sampled(TAU * 0.1 / 72.0);
        assert_eq!(samples.len(), 72);
        assert!((samples[0].at - Point2::new(-0.1, 0.0)).norm() < 1e-15);
        assert!((samples[18].at - Point2::new(0.0, 0.1)).norm() < 1e-15);
    }

    #[test]
    fn polyline_samples_keep_corners_and_step() {
        let square = Shape::rectangle(Point2::new(0.1, 0.2), Vector2::new(0.3, 0.1));
        let samples = square.sampled(0.04);
        assert_eq!(samples.first().unwrap().at, samples.last().unwrap().at);
        assert!((samples.last().unwrap().along - 0.8).abs() < 1e-15);
        for pair in samples.windows(2) {
            assert!((pair[1].at - pair[0].at).norm() < 0.04 + 1e-12);
        }
        assert!(
            samples
                .iter()
                .any(|s| (s.at - Point2::new(0.25, 0.25)).norm() < 1e-15)
        );
    }
}
