//! The least-squares circle (LSCI) of points.
//!
//! Least over `c` and `R`: `sum of w (|p - c| - R)^2`, by Gauss-Newton steps from the circle with the least
//! `sum of w (|p - c|^2 - R^2)^2`, which has a closed form about the mean of the points:
//!
//! ```text
//! c = 1/2 (sum w p p^T)^-1 sum w p |p|^2,    R^2 = |c|^2 + mean |p|^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p`, `w` | a point, from the mean of all; its weight | m, - |
//! | `c`, `R` | centre, from there, and radius | m |
//!
//! A part of a circle is sufficient; the shorter it is, the less accurate is its centre.
//!
//! Source: closed circle after Kasa, A circle fitting procedure and its error analysis, IEEE Transactions on
//! Instrumentation and Measurement 25, 1976; steps as in Gander, Golub and Strebel, Least-squares fitting of circles
//! and ellipses, BIT 34, 1994 \[recalled\].

use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};

/// A circle of points, and their deviation from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceCircle {
    /// Centre, m.
    pub centre: Point2<f64>,
    /// m
    pub radius: f64,
    /// Peak to valley of the distances from the centre (RONt), m.
    pub peak_to_valley: f64,
}

/// Points on a line spread across it by less than this part of what they spread along it, squared.
/// Below 1e-16 it would be rounding.
pub(super) const ON_A_LINE: f64 = 1e-14;
/// The steps have converged where they move no point's distance by more than this part of the spread.
const SETTLED: f64 = 1e-13;
/// Maximum number of steps: each reduces the error to about the roundness over the radius, so that a circle needs four
/// or five.
const MOST_ROUNDS: usize = 50;

/// The least-squares circle of `points` (m); `None` below three points, where they are on a line, and where no circle
/// is nearest.
pub fn least_squares(points: &[Point2<f64>]) -> Option<ReferenceCircle> {
    let weighed: Vec<(f64, Vector2<f64>)> = points.iter().map(|p| (1.0, p.coords)).collect();
    weighed_least_squares(&weighed)
}

/// The same of points (m) with weights, each above 0.
pub(crate) fn weighed_least_squares(points: &[(f64, Vector2<f64>)]) -> Option<ReferenceCircle> {
    if points.len() < 3 {
        return None;
    }
    let all: f64 = points.iter().map(|(w, _)| w).sum();
    let mean = points.iter().fold(Vector2::zeros(), |sum, (w, p)| sum + p * *w) / all;
    let off: Vec<(f64, Vector2<f64>)> = points.iter().map(|(w, p)| (*w, p - mean)).collect();
    let (mut centre, mut radius) = closed(&off, all)?;
    let least_step = SETTLED * SETTLED * off.iter().map(|(w, p)| w * p.norm_squared()).sum::<f64>();
    for _ in 0..MOST_ROUNDS {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (w, p) in &off {
            let away = p - centre;
            let distance = away.norm();
            // A point on the centre has no direction from it.
            if distance == 0.0 {
                continue;
            }
            let row = (away / distance).push(1.0);
            normal += row * row.transpose() * *w;
            right += row * ((distance - radius) * w);
        }
        let step = normal.lu().solve(&right)?;
        centre += step.xy();
        radius += step.z;
        if (normal * step).dot(&step) <= least_step {
            let distances = off.iter().map(|(_, p)| (p - centre).norm());
            let (low, high) =
                distances.fold((f64::MAX, f64::MIN), |(low, high), d| (low.min(d), high.max(d)));
            return (radius > 0.0).then_some(ReferenceCircle {
                centre: (centre + mean).into(),
                radius,
                peak_to_valley: high - low,
            });
        }
    }
    None
}

/// The closed-form circle through points about their mean, of this total weight; `None` where they are on a line.
fn closed(off: &[(f64, Vector2<f64>)], all: f64) -> Option<(Vector2<f64>, f64)> {
    let spread: Matrix2<f64> = off.iter().map(|(w, p)| p * p.transpose() * *w).sum();
    let along = spread.symmetric_eigenvalues();
    if along.min() <= ON_A_LINE * along.max() {
        return None;
    }
    let weighed: Vector2<f64> = off.iter().map(|(w, p)| p * (p.norm_squared() * w)).sum();
    let centre = spread.try_inverse()? * weighed * 0.5;
    Some((centre, (centre.norm_squared() + spread.trace() / all).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

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
        let round = least_squares(&points).unwrap();
        assert!((round.centre - Point2::new(0.3, -0.1)).norm() < 1e-12);
        assert!((round.peak_to_valley - 40e-6).abs() < 1e-9, "{round:?}");
    }

    /// Points of a circle about (0.3, -0.1) m over an arc from `from` on (deg), off it by `by(phi)`.
    fn arc([from, sweep]: [f64; 2], radius: f64, by: impl Fn(f64) -> f64) -> Vec<Point2<f64>> {
        let at = |k: i32| {
            let phi = (from + sweep * f64::from(k) / 400.0).to_radians();
            let r = radius + by(phi);
            Point2::new(0.3 + r * phi.cos(), -0.1 + r * phi.sin())
        };
        (0..=400).map(at).collect()
    }

    #[test]
    fn the_roundness_of_lobes_is_twice_their_height_and_one_lobe_is_a_shift() {
        for lobes in 2..9 {
            // A sum over even steps contains no cosine.
            let whole: Vec<_> = arc([0.0, 360.0], 0.1, |phi| 8e-6 * (f64::from(lobes) * phi).cos());
            let round = least_squares(&whole[..400]).unwrap();
            // 400 points miss the crests by at most (lobes/2 step)^2/2 of the height; the centre goes with height
            // squared.
            let missed = 8e-6 * (f64::from(lobes) * PI / 400.0).powi(2) + 2e-9;
            assert!(
                (round.peak_to_valley - 16e-6).abs() < missed,
                "{lobes}: {round:?}"
            );
            assert!((round.radius - 0.1).abs() < 1e-9, "{lobes}: {round:?}");
        }
        let shifted = arc([0.0, 360.0], 0.1, |phi| 8e-6 * phi.cos());
        let round = least_squares(&shifted[..400]).unwrap();
        // The difference is the square of the shift over the radius.
        assert!(round.peak_to_valley < 8e-6 * 8e-6 / 0.1 && (round.centre.x - 0.300_008).abs() < 1e-12);
    }

    #[test]
    fn a_part_of_a_circle_has_the_centre_and_radius_of_the_whole() {
        for sweep in [360.0, 200.0, 120.0, 60.0, 20.0] {
            for from in [0.0, 77.0, 230.0] {
                let round = least_squares(&arc([from, sweep], 0.1, |_| 0.0)).unwrap();
                // Rounding of 1e-17 m, times 1/(1 - cos(sweep/2)) squared or so.
                let given = (round.centre - Point2::new(0.3, -0.1)).norm();
                assert!(
                    given < 1e-11 && (round.radius - 0.1).abs() < 1e-11,
                    "{sweep} {from}: {given}"
                );
                assert!(round.peak_to_valley < 1e-14, "{sweep} {from}: {round:?}");
            }
        }
    }

    #[test]
    fn no_circle_near_the_result_is_nearer_to_the_points() {
        for sweep in [360.0, 120.0, 60.0] {
            let wavy = arc([10.0, sweep], 0.1, |phi| {
                6e-6 * (5.0 * phi).cos() + 3e-6 * (11.0 * phi).sin()
            });
            let round = least_squares(&wavy).unwrap();
            let squares = |centre: Point2<f64>, radius: f64| -> f64 {
                wavy.iter().map(|p| ((p - centre).norm() - radius).powi(2)).sum()
            };
            let least = squares(round.centre, round.radius);
            for k in 0..24 {
                let turn = f64::from(k) * PI / 12.0;
                for (size, change) in [(1e-6, 0.0), (0.0, 1e-6), (1e-6, -1e-6), (1e-6, 1e-6)] {
                    let centre = round.centre + Vector2::new(turn.cos(), turn.sin()) * size;
                    assert!(squares(centre, round.radius + change) > least, "{sweep} {k}");
                }
            }
        }
    }

    #[test]
    fn shift_rotation_and_scale_do_not_change_the_roundness() {
        let wave = |phi: f64| 20e-6 * (3.0 * phi).cos();
        let here = least_squares(&arc([0.0, 150.0], 0.1, wave)).unwrap();
        let turned: Vec<_> = arc([0.0, 150.0], 0.1, wave)
            .iter()
            .map(|p| Point2::new(5.0 - 2.0 * p.y, 2.0 * p.x - 7.0))
            .collect();
        let there = least_squares(&turned).unwrap();
        // Coordinates of 7 m are rounded to 1e-15 m.
        assert!((there.peak_to_valley - 2.0 * here.peak_to_valley).abs() < 1e-13);
        assert!((there.radius - 2.0 * here.radius).abs() < 1e-11);
    }

    #[test]
    fn three_points_are_on_their_circle_and_points_on_a_line_have_none() {
        let three = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point2::from);
        let round = least_squares(&three).unwrap();
        assert!((round.centre - Point2::new(0.5, 0.5)).norm() < 1e-14 && round.peak_to_valley < 1e-14);
        for turn in [0.0, 0.7] {
            let on_line =
                |i: i32| Point2::new(3.0, -2.0) + Vector2::new(f64::cos(turn), turn.sin()) * f64::from(i);
            let line: Vec<_> = (0..5).map(on_line).collect();
            assert_eq!(least_squares(&line), None);
            assert_eq!(least_squares(&line[..2]), None);
        }
        assert_eq!(least_squares(&[Point2::new(0.1, 0.2); 9]), None);
        // A line far away, rounded to a part of 1e-16 of its coordinates.
        let far: Vec<_> = (0..9)
            .map(|i| Point2::new(0.1, 0.3) * (1e3 + f64::from(i) / 7.0))
            .collect();
        assert_eq!(least_squares(&far), None);
    }

    #[test]
    fn a_point_on_the_centre_is_valid_and_weights_equal_repeated_points() {
        // Four of a square and its middle: the radius is their mean distance.
        let square = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Point2::from);
        let with: Vec<_> = square.into_iter().chain([Point2::origin()]).collect();
        let round = least_squares(&with).unwrap();
        assert!(
            round.centre.coords.norm() < 1e-12 && round.radius.is_finite() && round.peak_to_valley <= 1.0
        );
        let wavy = arc([0.0, 200.0], 0.1, |phi| 8e-6 * (3.0 * phi).cos());
        let twice: Vec<_> = wavy.iter().chain(&wavy[..100]).copied().collect();
        let weighed: Vec<_> = (wavy.iter().enumerate())
            .map(|(k, p)| (if k < 100 { 2.0 } else { 1.0 }, p.coords))
            .collect();
        let [one, other] = [
            least_squares(&twice).unwrap(),
            weighed_least_squares(&weighed).unwrap(),
        ];
        assert!((one.centre - other.centre).norm() < 1e-13 && (one.radius - other.radius).abs() < 1e-13);
    }
}
