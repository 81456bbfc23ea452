//! Two-step teaching: the circle to teach so that the tool path is round.
//!
//! ```text
//! r_taught(a) = R - c(a)        c(a): common part of both directions, about its own centre, smooth
//! ```
//!
//! One set of points corrects the common part of both directions. Half of their difference remains on either side of
//! the middle: no taught circle removes it. `c` is the mean of the directions in lobes up to a given number, without
//! the first, which is the position of the pivot; therefore neither noise nor a step of a reversal affects the points.
//!
//! Source: step B.2 of Shneor and Chapsky, Error prediction in industrial robot machining (the two-step procedure; the
//! formula is ours).

use super::centre::{least_squares_centre, seen_from};
use super::difference::between_directions;
use super::lobes::{Lobes, lobes};
use super::profile::Profile;
use super::quantities::{Quantities, quantities};
use super::run::{CircularTest, Run};

/// A circle to teach, and the expected result.
#[derive(Clone, Debug, PartialEq)]
pub struct Taught {
    /// The correction: the mean and lobes 2, 3, ...
    pub lobes: Lobes,
    /// Half of the largest difference between the directions, m: it remains; `None` of one direction only.
    pub stays: Option<f64>,
    /// G and F of all runs about their centre without the correction, m.
    pub before: Quantities,
    /// And as expected with the correction.
    pub expected: Quantities,
}

impl Taught {
    /// The change of the taught radius at an angle (rad), m.
    pub fn correction(&self, angle: f64) -> f64 {
        -self.lobes.at(angle)
    }
}

/// The circle to teach with lobes up to `most`, or as many as the samples resolve; `None` where the runs are not full
/// turns.
pub fn taught(test: &CircularTest, most: usize) -> Option<Taught> {
    if test.runs().iter().any(|run| !Profile::of(run).gaps().is_empty()) {
        return None;
    }
    let centre = least_squares_centre(test)?;
    let centred = seen_from(test, centre.offset).ok()?;
    let mut lobes = lobes(&centred, most)?;
    lobes.harmonics.retain(|lobe| lobe.waves != 1);
    let corrected = |run: &Run| -> Option<Run> {
        let samples = run.samples().map(|(a, dr)| (a, dr - lobes.at(a)));
        let (angle, deviation) = samples.unzip();
        Run::new(run.direction(), angle, deviation).ok()
    };
    let runs: Vec<Run> = centred.runs().iter().map(corrected).collect::<Option<_>>()?;
    let corrected = CircularTest::new(test.radius(), runs).ok()?;
    let of_all = |test: &CircularTest| quantities(test, &test.runs().iter().collect::<Vec<_>>());
    let stays = between_directions(&centred).span();
    Some(Taught {
        stays: stays.map(|span| 0.5 * span.largest.abs()),
        before: of_all(&centred)?,
        expected: of_all(&corrected)?,
        lobes,
    })
}

#[cfg(test)]
mod tests {
    use super::super::run::Direction;
    use super::*;

    fn run(direction: Direction, of: impl Fn(f64, f64) -> f64) -> Run {
        let angle: Vec<f64> = (0..720).map(|k| f64::from(k).to_radians() / 2.0).collect();
        let deviation = angle.iter().map(|a| of(*a, direction.sign())).collect();
        Run::new(direction, angle, deviation).unwrap()
    }

    #[test]
    fn the_common_part_is_removed_and_the_part_of_the_direction_remains() {
        let of = |a: f64, sign: f64| {
            20e-6
                + 300e-6 * (a - 1.0).cos()
                + 80e-6 * (2.0 * a).cos()
                + 15e-6 * (3.0 * a).sin()
                + sign * 10e-6
        };
        let runs = Direction::BOTH.map(|direction| run(direction, of));
        let taught = taught(&CircularTest::new(0.1, runs.to_vec()).unwrap(), 8).unwrap();
        assert!((taught.stays.unwrap() - 10e-6).abs() < 1e-7);
        // The square of the offset over the radius, and its product with the lobes: below a micrometre.
        let [least, greatest] = taught.expected.radial;
        assert!((least.deviation + 10e-6).abs() < 1e-6 && (greatest.deviation - 10e-6).abs() < 1e-6);
        assert!(taught.before.circular.unwrap() > 170e-6 && taught.expected.circular.unwrap() < 22e-6);
    }

    #[test]
    fn lobes_beyond_the_given_number_remain() {
        let runs = Direction::BOTH.map(|direction| run(direction, |a, _| 5e-6 * (9.0 * a).cos()));
        let test = CircularTest::new(0.1, runs.to_vec()).unwrap();
        let coarse = taught(&test, 8).unwrap();
        assert!(
            coarse
                .lobes
                .harmonics
                .iter()
                .all(|lobe| lobe.amplitude.abs() < 1e-9)
        );
        let fine = taught(&test, 9).unwrap();
        assert!(fine.expected.circular.unwrap() < 1e-7);
        assert!((coarse.expected.circular.unwrap() - 10e-6).abs() < 1e-7);
    }

    #[test]
    fn part_of_a_turn_is_not_taught() {
        let arc: Vec<f64> = (0..220).map(|deg| f64::from(deg).to_radians()).collect();
        let run = Run::new(Direction::Clockwise, arc, vec![1e-6; 220]).unwrap();
        assert_eq!(taught(&CircularTest::new(0.1, vec![run]).unwrap(), 5), None);
    }
}
