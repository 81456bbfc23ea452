//! The lobes of a profile: its waves of once, twice, n times a turn.
//!
//! ```text
//! dr(a) = mean + sum over n of  A_n cos(n a - phi_n)
//! ```
//!
//! The first is the position of the circle, not its roundness; the second is the ellipse of scale and squareness; three
//! lobes are caused by bent guideways.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::profile::Profile;
use super::run::{CircularTest, Direction, Run};
use crate::roundness::{Harmonic, Polar};

/// A mean and its lobes.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobes {
    /// m
    pub mean: f64,
    /// 1 lobe a turn, 2, ...
    pub harmonics: Vec<Harmonic>,
}

impl Lobes {
    /// Sum of all of them at an angle, m.
    pub fn at(&self, angle: f64) -> f64 {
        let lobe = |lobe: &Harmonic| lobe.amplitude * (lobe.waves as f64 * angle - lobe.phase).cos();
        self.mean + self.harmonics.iter().map(lobe).sum::<f64>()
    }
}

/// Maximum number of lobes that the samples of every run resolve: more than two samples a lobe at the widest step.
pub fn most_lobes(test: &CircularTest) -> usize {
    let steps = test.runs().iter().map(|run| Profile::of(run).widest_step());
    let widest = steps.fold(0.0, f64::max);
    // With 36 even samples 17, whatever the rounding.
    if widest > 0.0 {
        (PI / widest * (1.0 - 1e-6)) as usize
    } else {
        0
    }
}

/// The mean and the lobes 1 to `most` of the common part of both directions, the mean of their means; with one
/// direction, of its mean. No more lobes than [`most_lobes`]; `None` where a run has a gap.
///
/// By least squares over the samples of each run: straight lines between them would flatten a lobe with few samples.
pub fn lobes(test: &CircularTest, most: usize) -> Option<Lobes> {
    let most = most.min(most_lobes(test));
    let directions = Direction::BOTH.map(|direction| test.of(direction).collect::<Vec<&Run>>());
    let measured = directions.iter().filter(|runs| !runs.is_empty()).count();
    // The mean, then each lobe.
    let mut sums = vec![Complex::new(0.0, 0.0); most + 1];
    for runs in &directions {
        let weight = 1.0 / (measured * runs.len()) as f64;
        for run in runs {
            let of_run = of_run(&Profile::of(run), most)?;
            sums.iter_mut()
                .zip(of_run)
                .for_each(|(sum, of)| *sum += of * weight);
        }
    }
    let (mean, lobes) = sums.split_first()?;
    let harmonics = lobes.iter().enumerate().map(|(index, lobe)| Harmonic {
        waves: index + 1,
        amplitude: lobe.norm(),
        phase: lobe.arg(),
    });
    Some(Lobes {
        mean: mean.re,
        harmonics: harmonics.collect(),
    })
}

/// The mean of a run and its lobes, as `amplitude e^(i phase)`.
fn of_run(profile: &Profile, most: usize) -> Option<Vec<Complex<f64>>> {
    let (angle, deviation): (Vec<f64>, Vec<f64>) = profile.samples().unzip();
    let harmonics = Polar::of_deviations(&angle, &deviation).harmonics(most);
    let given = Lobes { mean: 0.0, harmonics };
    // The remainder has the mean of the fit.
    let left: f64 = angle
        .iter()
        .zip(&deviation)
        .map(|(a, dr)| dr - given.at(*a))
        .sum();
    let mean = Complex::new(left / angle.len() as f64, 0.0);
    let lobes = given
        .harmonics
        .iter()
        .map(|lobe| Complex::from_polar(lobe.amplitude, lobe.phase));
    let known = profile.gaps().is_empty() && given.harmonics.len() == most;
    known.then(|| [mean].into_iter().chain(lobes).collect())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn run(direction: Direction, count: usize, of: impl Fn(f64) -> f64) -> Run {
        let angle: Vec<f64> = (0..count).map(|k| TAU * k as f64 / count as f64).collect();
        let deviation = angle.iter().map(|a| of(*a)).collect();
        Run::new(direction, angle, deviation).unwrap()
    }

    #[test]
    fn lobes_are_found_with_their_height_and_crest() {
        let wave = |a: f64| 4e-6 + 3e-6 * (2.0 * (a - 0.3)).cos() + 1e-6 * (5.0 * (a - 1.0)).cos();
        // Three runs one way and one the other: the lag of each way cancels.
        let runs = [-1.0, -1.0, -1.0, 1.0].map(|sign| {
            let direction = if sign < 0.0 {
                Direction::Clockwise
            } else {
                Direction::Anticlockwise
            };
            run(direction, 720, |a| wave(a) + sign * 7e-6 * (2.0 * a).sin())
        });
        let found = lobes(&CircularTest::new(0.1, runs.to_vec()).unwrap(), 6).unwrap();
        assert!((found.mean - 4e-6).abs() < 1e-17);
        for (lobe, amplitude) in found.harmonics.iter().zip([0.0, 3e-6, 0.0, 0.0, 1e-6, 0.0]) {
            assert!((lobe.amplitude - amplitude).abs() < 1e-17, "{lobe:?}");
        }
        assert!((found.harmonics[1].phase - 0.6).abs() < 1e-9);
        for a in [0.0, 1.0, 4.0] {
            assert!((found.at(a) - wave(a)).abs() < 1e-16);
        }
    }

    #[test]
    fn few_samples_resolve_few_lobes_and_these_completely() {
        let of = |a: f64| 2e-6 * (10.0 * a).cos();
        let test = CircularTest::new(0.1, vec![run(Direction::Clockwise, 36, of)]).unwrap();
        let found = lobes(&test, 100).unwrap();
        // Straight lines between the samples would leave 1.5 um of the tenth, and make a 26th.
        assert_eq!((found.harmonics.len(), most_lobes(&test)), (17, 17));
        for lobe in &found.harmonics {
            let amplitude = if lobe.waves == 10 { 2e-6 } else { 0.0 };
            assert!((lobe.amplitude - amplitude).abs() < 1e-17, "{lobe:?}");
        }
        assert_eq!(lobes(&test, 0).unwrap().harmonics, []);
        let dense = CircularTest::new(
            0.1,
            vec![run(Direction::Clockwise, 720, |a| (360.0 * a).cos() * 1e-6)],
        );
        assert_eq!(most_lobes(&dense.unwrap()), 359);
    }

    #[test]
    fn a_gap_leaves_no_lobes() {
        let whole = run(Direction::Clockwise, 720, |_| 0.0);
        let gap = whole.without(&(100..140).collect::<Vec<_>>()).unwrap();
        assert_eq!(lobes(&CircularTest::new(0.1, vec![whole, gap]).unwrap(), 3), None);
    }
}
