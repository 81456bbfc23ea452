//! Paths on a workpiece plane: circle, line, polyline, rectangle, sampled into points.
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

/// The least-squares circle of a closed path, and how far its points lie off it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roundness {
    /// Centre, m.
    pub centre: Point2<f64>,
    /// m
    pub radius: f64,
    /// Peak to valley of the radial distances from the least-squares circle (RONt, LSCI), m.
    pub peak_to_valley: f64,
}

/// Roundness of `points` (m) about their least-squares circle (LSCI); `None` below three points or where they
/// lie on a line.
pub fn roundness(points: &[Point2<f64>]) -> Option<Roundness> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mut centre = points.iter().fold(Vector2::zeros(), |sum, p| sum + p.coords) / n;
    let mut radius = points.iter().map(|p| (p.coords - centre).norm()).sum::<f64>() / n;
    // Gauss-Newton on radial distances; quadratic convergence from the centroid of a closed path.
    for _ in 0..50 {
        let mut normal = nalgebra::Matrix3::zeros();
        let mut right = nalgebra::Vector3::zeros();
        for p in points {
            let away = p.coords - centre;
            let distance = away.norm();
            let row = nalgebra::Vector3::new(away.x / distance, away.y / distance, 1.0);
            normal += row * row.transpose();
            right += row * (distance - radius);
        }
        let step = normal
            .lu()
            .solve(&right)
            .filter(|s| s.iter().all(|v| v.is_finite()))?;
        centre += step.xy();
        radius += step.z;
        if step.norm() <= 1e-15 * radius.abs() {
            break;
        }
    }
    let distances = points.iter().map(|p| (p.coords - centre).norm());
    let (low, high) = distances.fold((f64::MAX, f64::MIN), |(low, high), d| (low.min(d), high.max(d)));
    (radius.is_finite() && radius > 0.0).then_some(Roundness {
        centre: centre.into(),
        radius,
        peak_to_valley: high - low,
    })
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

    #[test]
    fn roundness_of_an_ellipse_like_shift_is_twice_its_amplitude() {
        // r = R + a cos 2 phi has its least-squares circle at R, and peak to valley 2 a.
        let points: Vec<_> = (0..360)
            .map(|i| {
                let phi = f64::from(i).to_radians();
                let r = 0.1 + 20e-6 * (2.0 * phi).cos();
                Point2::new(0.3 + r * phi.cos(), -0.1 + r * phi.sin())
            })
            .collect();
        let round = roundness(&points).unwrap();
        assert!((round.centre - Point2::new(0.3, -0.1)).norm() < 1e-12);
        assert!((round.peak_to_valley - 40e-6).abs() < 1e-9, "{round:?}");
    }

    #[test]
    fn roundness_needs_three_points_off_a_line() {
        let line: Vec<_> = (0..5).map(|i| Point2::new(f64::from(i), 0.0)).collect();
        assert!(roundness(&line[..2]).is_none());
        let fitted = roundness(&line);
        assert!(fitted.is_none_or(|r| r.radius.is_finite()), "{fitted:?}");
    }
}
