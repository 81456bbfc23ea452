//! Harmonics of a profile: amplitude and phase of each whole number of waves per turn.
//!
//! ```text
//! dR(theta) = a_0 + sum over k = 1..N of A_k cos(k theta - phi_k)
//! ```
//!
//! by least squares over the points, so that uneven angles do not add false waves. The sums of products that
//! it uses are those of `cos m theta` and `sin m theta` for `m` up to `2 N`.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `A_k` | amplitude: half of crest to trough | m |
//! | `phi_k` | phase: a crest is at `phi_k / k` | rad |
//!
//! One wave per turn is a shift of the centre: zero about the least-squares circle of even angles; with uneven ones the
//! other waves shift that circle, and this wave shows by how much.

use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use super::polar::Polar;

/// Sums over many points are made in so many parts at most, none shorter than the second.
const PARTS: usize = 64;
const LEAST_PART: usize = 256;

/// One wave of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Waves per turn.
    pub waves: usize,
    /// m
    pub amplitude: f64,
    /// -pi to pi; a crest is at this angle over the number of waves. rad
    pub phase: f64,
}

impl Polar {
    /// The waves 1 to `most`, or to as many as the points resolve: two points per wave at the widest step, and more
    /// points than unknowns.
    pub fn harmonics(&self, most: usize) -> Vec<Harmonic> {
        let count = self.angles.len();
        let given = self
            .most_waves()
            .min(count.saturating_sub(1) as f64 / 2.0)
            .max(0.0) as usize;
        let most = most.min(given);
        if most == 0 {
            return Vec::new();
        }
        let ones = vec![1.0; count];
        let sums = wave_sums(&self.angles, &ones, 2 * most);
        let right = wave_sums(&self.angles, &self.deviations, most);
        // Unknowns: the mean, then cosine and sine of each wave. Products by cos a cos b = (cos(a - b) + cos(a + b)) /
        // 2.
        let normal = DMatrix::from_fn(2 * most + 1, 2 * most + 1, |row, column| {
            let (j, k) = (row.div_ceil(2), column.div_ceil(2));
            let (less, more) = (sums[j.abs_diff(k)], sums[j + k]);
            let turned = if j >= k { less.im } else { -less.im };
            match (is_sine(row), is_sine(column)) {
                (false, false) => (less.re + more.re) / 2.0,
                (true, true) => (less.re - more.re) / 2.0,
                (true, false) => (more.im + turned) / 2.0,
                (false, true) => (more.im - turned) / 2.0,
            }
        });
        let right = DVector::from_fn(2 * most + 1, |row, _| {
            let sum = right[row.div_ceil(2)];
            if is_sine(row) { sum.im } else { sum.re }
        });
        let Some(found) = normal.cholesky().map(|normal| normal.solve(&right)) else {
            return Vec::new();
        };
        (1..=most)
            .map(|waves| {
                let (cosine, sine) = (found[2 * waves - 1], found[2 * waves]);
                Harmonic {
                    waves,
                    amplitude: cosine.hypot(sine),
                    phase: sine.atan2(cosine),
                }
            })
            .collect()
    }
}

/// The sums over all points of `value e^(i m angle)`, for `m` from 0 to `most`.
pub(super) fn wave_sums(angles: &[f64], values: &[f64], most: usize) -> Vec<Complex<f64>> {
    let of_part = |(angles, values): (&[f64], &[f64])| {
        let mut sums = vec![Complex::new(0.0, 0.0); most + 1];
        for (angle, value) in angles.iter().zip(values) {
            let turn = Complex::from_polar(1.0, *angle);
            let mut term = Complex::new(*value, 0.0);
            for sum in &mut sums {
                *sum += term;
                term *= turn;
            }
        }
        sums
    };
    // The size of parts depends only on the number of points, added in order: any number of threads gives the same.
    let part = angles.len().div_ceil(PARTS).max(LEAST_PART);
    let parts: Vec<_> = angles
        .par_chunks(part)
        .zip(values.par_chunks(part))
        .map(of_part)
        .collect();
    let zero = vec![Complex::new(0.0, 0.0); most + 1];
    parts.into_iter().fold(zero, |mut sums, part| {
        sums.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        sums
    })
}

/// Unknown 0 is the mean; odd ones are cosines, even ones sines.
fn is_sine(unknown: usize) -> bool {
    unknown > 0 && unknown.is_multiple_of(2)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use nalgebra::{Point2, Vector2};

    use super::super::Profile;
    use super::*;

    /// `count` points, at even angles or displaced by a third of the step, with waves of 9, 4 and 2 um.
    fn wavy(count: usize, unevenness: f64) -> Polar {
        let at = |i: usize| {
            let even = TAU * i as f64 / count as f64;
            let angle = even + unevenness * TAU / count as f64 * (7.3 * even).sin();
            let by = 9e-6 * (2.0 * angle - 0.5).cos()
                + 4e-6 * (5.0 * angle + 1.1).cos()
                + 2e-6 * (12.0 * angle).sin();
            Point2::new(0.1, -0.3) + Vector2::new(angle.cos(), angle.sin()) * (0.05 + by)
        };
        Profile::new((0..count).map(at).collect()).unwrap().polar()
    }

    #[test]
    fn waves_are_reported_with_amplitude_and_phase_at_even_and_uneven_angles() {
        for unevenness in [0.0, 1.0] {
            let given = wavy(90, unevenness).harmonics(15);
            assert_eq!(given.len(), 15);
            // Uneven points move the least-squares circle, which is seen as one wave.
            let shift = if unevenness > 0.0 { 1 } else { 0 };
            for wave in &given[shift..] {
                let (amplitude, phase) = match wave.waves {
                    2 => (9e-6, 0.5),
                    5 => (4e-6, -1.1),
                    12 => (2e-6, std::f64::consts::FRAC_PI_2),
                    _ => (0.0, wave.phase),
                };
                // A shifted centre mixes waves by deviation over radius.
                assert!((wave.amplitude - amplitude).abs() < 1e-9, "{unevenness} {wave:?}");
                assert!((wave.phase - phase).abs() < 1e-3, "{unevenness} {wave:?}");
            }
        }
    }

    #[test]
    fn no_more_waves_are_reported_than_the_points_resolve() {
        // 24 even points resolve 11 waves: the twelfth has two points per wave, which may be at its zeros.
        assert_eq!(wavy(24, 0.0).harmonics(50).len(), 11);
        assert_eq!(wavy(25, 0.0).harmonics(50).len(), 12);
        assert_eq!(wavy(24, 0.0).harmonics(3).len(), 3);
        assert!(wavy(24, 2.0).harmonics(50).len() < 11);
        assert!(wavy(24, 0.0).harmonics(0).is_empty());
        let half_turn = wavy(200, 0.0);
        let kept: Vec<_> = half_turn.with(&half_turn.deviations).drain(..90).collect();
        assert!(Profile::new(kept).unwrap().polar().harmonics(5).is_empty());
    }
}
