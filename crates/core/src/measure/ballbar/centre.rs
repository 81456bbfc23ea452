//! Centre of the measured circle: the pivot is never exactly at the centre of the path.
//!
//! Least over `e` and `rho`: `sum of w (|p - e| - rho)^2` over the samples of all runs, as
//! [`least_squares`](mod@crate::roundness::least_squares) finds it. One centre for all runs, since the pivot is fixed
//! between them: differences between the two directions stay. Each direction has the same weight, whatever the number
//! of its runs and samples.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p` | a sample, from the set-up centre: `(R + dr) (cos a, sin a)` | m |
//! | `e` | the centre, from there | m |
//! | `rho` | radius of the least-squares circle | m |

use nalgebra::Vector2;

use super::profile::Profile;
use super::run::{CircularTest, Direction, Run, RunError};
use crate::roundness::least_squares::{ReferenceCircle, weighed_least_squares};

/// The least-squares circle of all runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centre {
    /// From the set-up centre, along both axes of the plane, m.
    pub offset: Vector2<f64>,
    /// m
    pub radius: f64,
}

/// Least arc from which a centre is determined, rad: on a shorter one centre and radius are strongly correlated.
pub const LEAST_ARC: f64 = std::f64::consts::TAU / 3.0;

/// The least-squares circle of all runs; `None` where no direction has an arc of [`LEAST_ARC`].
pub fn least_squares_centre(test: &CircularTest) -> Option<Centre> {
    let mut samples: Vec<(f64, Vector2<f64>)> = Vec::new();
    let mut widest: f64 = 0.0;
    for direction in Direction::BOTH {
        let profiles: Vec<Profile> = test.of(direction).map(Profile::of).collect();
        for profile in &profiles {
            widest = widest.max(profile.arc());
            let weight = 1.0 / (profiles.len() * profile.samples().count()) as f64;
            let place = |(a, dr): (f64, f64)| Vector2::new(a.cos(), a.sin()) * (test.radius() + dr);
            samples.extend(profile.samples().map(|sample| (weight, place(sample))));
        }
    }
    if widest < LEAST_ARC {
        return None;
    }
    let ReferenceCircle { centre, radius, .. } = weighed_least_squares(&samples)?;
    let found = centre.coords.norm() < 0.5 * test.radius();
    found.then_some(Centre {
        offset: centre.coords,
        radius,
    })
}

/// The same runs relative to a centre at `offset` (m) from that of the set-up.
///
/// # Errors
/// A centre so far off that a sample leaves half the radius.
pub fn seen_from(test: &CircularTest, offset: Vector2<f64>) -> Result<CircularTest, RunError> {
    let seen = |run: &Run| -> Result<Run, RunError> {
        let samples = run.samples().map(|(a, dr)| {
            let place = Vector2::new(a.cos(), a.sin()) * (test.radius() + dr) - offset;
            // The turn of a sample is kept: only its direction changes slightly.
            let plain = Vector2::new(a.cos(), a.sin());
            let turn = plain.perp(&place).atan2(plain.dot(&place));
            (a + turn, place.norm() - test.radius())
        });
        let (angle, deviation) = samples.unzip();
        Run::new(run.direction(), angle, deviation)
    };
    let runs = test.runs().iter().map(seen).collect::<Result<_, _>>()?;
    CircularTest::new(test.radius(), runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a circle of 100.02 mm about (30, -50) um, over an arc from 10 degrees on, of a bar of 100 mm.
    fn shifted(direction: Direction, arc_deg: f64, count: i32) -> Run {
        let e = Vector2::new(30e-6, -50e-6);
        let samples = (0..count).map(|k| {
            let a = (10.0 + arc_deg * f64::from(k) / f64::from(count)).to_radians();
            let place = Vector2::new(a.cos(), a.sin()) * 0.100_02 + e;
            (place.y.atan2(place.x), place.norm() - 0.1)
        });
        let (angle, deviation) = samples.unzip();
        Run::new(direction, angle, deviation).unwrap()
    }

    #[test]
    fn the_centre_of_a_shifted_circle_is_found_and_nothing_is_left_about_it() {
        for arc in [360.0, 220.0, 130.0] {
            let test = CircularTest::new(0.1, vec![shifted(Direction::Clockwise, arc, 720)]).unwrap();
            let centre = least_squares_centre(&test).unwrap();
            // Two samples in one cell of a profile become one, off the circle by 50 um times half the square of their
            // angle.
            assert!(
                (centre.offset - Vector2::new(30e-6, -50e-6)).norm() < 1e-10,
                "{centre:?}"
            );
            assert!((centre.radius - 0.100_02).abs() < 1e-10);
            let round = seen_from(&test, centre.offset).unwrap();
            let off = round.runs()[0].deviation().iter().map(|dr| (dr - 20e-6).abs());
            assert!(off.fold(0.0, f64::max) < 2e-10);
        }
        let short = CircularTest::new(0.1, vec![shifted(Direction::Clockwise, 110.0, 720)]).unwrap();
        assert_eq!(least_squares_centre(&short), None);
    }

    #[test]
    fn directions_have_equal_weight_whatever_the_number_of_runs() {
        let flat = |direction, e: f64| {
            let angle: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
            let deviation = angle.iter().map(|a| e * a.cos()).collect();
            Run::new(direction, angle, deviation).unwrap()
        };
        let [cw, ccw] = [
            flat(Direction::Clockwise, 4e-6),
            flat(Direction::Anticlockwise, 0.0),
        ];
        let test = CircularTest::new(0.1, vec![cw.clone(), cw.clone(), cw, ccw]).unwrap();
        let centre = least_squares_centre(&test).unwrap();
        assert!((centre.offset.x - 2e-6).abs() < 1e-9, "{centre:?}");
    }

    #[test]
    fn samples_keep_their_turn_relative_to_another_centre() {
        let angle: Vec<f64> = (0..24).map(|k| 7.0 + f64::from(k)).collect();
        let run = Run::new(Direction::Anticlockwise, angle.clone(), vec![0.0; 24]).unwrap();
        let test = CircularTest::new(0.1, vec![run]).unwrap();
        let seen = seen_from(&test, Vector2::new(1e-4, 0.0)).unwrap();
        let turned = seen.runs()[0]
            .angle()
            .iter()
            .zip(&angle)
            .map(|(b, a)| (b - a).abs());
        assert!(turned.fold(0.0, f64::max) < 2e-3);
    }
}
