//! Predicted and measured waves compared: amplitude, phase, and the probability of agreement by chance.
//!
//! ```text
//! m(a) = sum of A_n cos(n a - phi_n)     p(a) = sum of B_n cos(n a - psi_n)
//! explained of wave n  = 1 - |A_n e^(i phi_n) - B_n e^(i psi_n)|^2 / A_n^2
//! <m, p turned by t>   = 1/2 sum of A_n B_n cos(phi_n - psi_n - n t)
//! ```
//!
//! A very small wave has no useful phase and share. The least amplitude that is reported is
//!
//! ```text
//! A_least = max(A_largest / 100, 2 s / sqrt N)        noise s of N angles makes waves of 2 s / sqrt N (rms)
//! ```
//!
//! A prediction that is unrelated to the measurement may agree by chance. Rotated about the centre it keeps
//! its size and its shape, and would agree as well: [`turns_as_good`] is the share of all rotations at which it does.

use std::f64::consts::TAU;

use crate::roundness::{Harmonic, Polar};

use super::turn::Turn;

/// One wave, measured and predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavePair {
    /// Of the measurement.
    pub measured: Harmonic,
    /// Of the prediction.
    pub predicted: Harmonic,
}

impl WavePair {
    /// This pair without amplitudes below `least` (m): phases require both waves, a share the measured one.
    pub fn reported(&self, least: f64) -> ReportedPair {
        let is_there = |wave: &Harmonic| wave.amplitude >= least && wave.amplitude > 0.0;
        let [measured, predicted] = [is_there(&self.measured), is_there(&self.predicted)];
        ReportedPair {
            measured_phase: measured.then_some(self.measured.phase),
            predicted_phase: predicted.then_some(self.predicted.phase),
            phase_difference: (measured && predicted).then(|| self.phase_difference()),
            explained: self.explained().filter(|_| measured),
        }
    }

    /// Phase of the prediction relative to the measurement, -pi to pi, rad.
    pub fn phase_difference(&self) -> f64 {
        let by = self.predicted.phase - self.measured.phase;
        (by + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU
    }

    /// Share of the measured wave that the predicted one explains; none where none was measured.
    pub fn explained(&self) -> Option<f64> {
        let [m, p] = [self.measured.amplitude, self.predicted.amplitude];
        let left = m * m + p * p - 2.0 * m * p * self.phase_difference().cos();
        (m > 0.0).then(|| 1.0 - left / (m * m))
    }
}

/// A pair of waves, limited to significant values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportedPair {
    /// rad
    pub measured_phase: Option<f64>,
    /// rad
    pub predicted_phase: Option<f64>,
    /// rad
    pub phase_difference: Option<f64>,
    /// Share of the measured wave that is explained.
    pub explained: Option<f64>,
}

/// Waves of less than this part of the largest of both curves are ignored.
const LITTLE: f64 = 0.01;

/// The least significant amplitude (m) of curves with noise of this standard deviation (m) at this many angles.
pub fn least_amplitude(pairs: &[WavePair], noise: f64, angles: usize) -> f64 {
    let sizes = pairs
        .iter()
        .flat_map(|pair| [pair.measured.amplitude, pair.predicted.amplitude]);
    let of_noise = 2.0 * noise / (angles.max(1) as f64).sqrt();
    (LITTLE * sizes.fold(0.0, f64::max)).max(of_noise)
}

/// Waves 1 to `most` of both curves, or as many as the angles resolve.
pub fn pairs(turn: &Turn, predicted: &[f64], measured: &[f64], most: usize) -> Vec<WavePair> {
    let waves = |curve: &[f64]| Polar::of_deviations(turn.angle(), curve).harmonics(most);
    let both = waves(measured).into_iter().zip(waves(predicted));
    both.map(|(measured, predicted)| WavePair { measured, predicted })
        .collect()
}

/// Rotations that are tried: every half degree.
const TURNS: usize = 720;

/// The share of all rotations of the prediction about the centre at which its correlation with the measurement is at
/// least that without rotation; none where either has no waves.
pub fn turns_as_good(pairs: &[WavePair]) -> Option<f64> {
    let like = |turned: usize| -> f64 {
        let by = TAU * turned as f64 / TURNS as f64;
        let of = |pair: &WavePair| {
            let [m, p] = [pair.measured.amplitude, pair.predicted.amplitude];
            m * p * (pair.phase_difference() + pair.measured.waves as f64 * by).cos()
        };
        pairs.iter().map(of).sum()
    };
    let size: f64 = pairs
        .iter()
        .map(|pair| pair.measured.amplitude * pair.predicted.amplitude)
        .sum();
    let least = like(0) - 1e-9 * size;
    let as_good = (0..TURNS).filter(|turned| like(*turned) >= least).count();
    (size > 0.0).then_some(as_good as f64 / TURNS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn() -> Turn {
        Turn::new((0..360).map(|deg| f64::from(deg).to_radians()).collect()).unwrap()
    }

    fn curve(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..360).map(|deg| of(f64::from(deg).to_radians())).collect()
    }

    #[test]
    fn waves_are_paired_with_their_phases() {
        let m = curve(|a| 2e-5 * (2.0 * a - 0.5).cos() + 4e-6 * (3.0 * a).cos());
        let p = curve(|a| 1e-5 * (2.0 * a - 0.9).cos() + 4e-6 * (3.0 * a).cos());
        let reported = pairs(&turn(), &p, &m, 6);
        assert_eq!(reported.len(), 6);
        let two = reported[1];
        assert!(
            (two.measured.amplitude - 2e-5).abs() < 1e-15 && (two.predicted.amplitude - 1e-5).abs() < 1e-15
        );
        assert!((two.phase_difference() - 0.4).abs() < 1e-9);
        let left = (1.0 + 0.25 - 0.4_f64.cos()) * 4e-10;
        assert!((two.explained().unwrap() - (1.0 - left / 4e-10)).abs() < 1e-9);
        assert!((reported[2].explained().unwrap() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn shares_of_waves_weighted_by_their_squares_are_the_share_of_the_curve() {
        let m = curve(|a| 2e-5 * (2.0 * a - 0.5).cos() + 4e-6 * (3.0 * a).cos());
        let p = curve(|a| 1e-5 * (2.0 * a - 0.9).cos() + 7e-6 * (3.0 * a + 1.0).cos());
        let reported = pairs(&turn(), &p, &m, 10);
        let squares = |pair: &WavePair| pair.measured.amplitude.powi(2);
        let all: f64 = reported.iter().map(squares).sum();
        let seen = reported.iter().filter(|pair| pair.measured.amplitude > 1e-9);
        let weighed: f64 = seen.map(|pair| pair.explained().unwrap() * squares(pair)).sum();
        let whole = super::super::agreement(&turn(), &p, &m).unwrap().explained;
        assert!((weighed / all - whole).abs() < 1e-9);
    }

    #[test]
    fn a_wave_below_the_least_amplitude_has_neither_phase_nor_share() {
        // The ellipse is 20 um; wave three is a thousandth of it, wave four a fiftieth and predicted alone.
        let m = curve(|a| 2e-5 * (2.0 * a).cos() + 2e-8 * (3.0 * a).cos());
        let p = curve(|a| 1e-5 * (2.0 * a - 0.9).cos() + 2e-8 * (3.0 * a).sin() + 4e-7 * (4.0 * a).cos());
        let found = pairs(&turn(), &p, &m, 6);
        let least = least_amplitude(&found, 0.0, 360);
        assert!((least - 2e-7).abs() < 1e-12);
        let reported: Vec<ReportedPair> = found.iter().map(|pair| pair.reported(least)).collect();
        assert!(reported[1].phase_difference.is_some() && reported[1].explained.is_some());
        let nothing = ReportedPair {
            measured_phase: None,
            predicted_phase: None,
            phase_difference: None,
            explained: None,
        };
        assert_eq!([reported[2], reported[4]], [nothing; 2]);
        assert!(reported[3].predicted_phase.is_some() && reported[3].explained.is_none());
        assert_eq!(reported[3].phase_difference, None);
    }

    #[test]
    fn waves_of_noise_have_the_least_significant_amplitude() {
        // Hashed, so that neighbours are independent: evenly spread, standard deviation 1 / root of 12.
        let noise = |seed: u64, k: usize| {
            let hashed = ((seed << 32) | (k as u64 + 1)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let hashed = (hashed ^ (hashed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            ((hashed ^ (hashed >> 32)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut squares = Vec::new();
        for seed in 0..20 {
            let m: Vec<f64> = (0..360).map(|k| noise(seed, k)).collect();
            squares.extend(
                pairs(&turn(), &m, &m, 12)
                    .iter()
                    .map(|pair| pair.measured.amplitude.powi(2)),
            );
        }
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        let expected = least_amplitude(&[], (1.0_f64 / 12.0).sqrt(), 360);
        // 240 squares of two degrees of freedom each: 6 % of the mean square, three times that.
        assert!((rms / expected - 1.0).abs() < 0.1, "{rms} {expected}");
    }

    #[test]
    fn a_rotated_prediction_is_seldom_as_good_as_a_true_one_and_often_as_good_as_a_wrong_one() {
        let of = |a: f64| (2.0 * a - 0.5).cos() + 0.5 * (3.0 * a).cos() + 0.4 * (5.0 * a + 1.0).cos();
        let m = curve(|a| 1e-5 * of(a));
        let right = turns_as_good(&pairs(&turn(), &m, &m, 8)).unwrap();
        assert!((right - 1.0 / 720.0).abs() < 1e-12);
        let opposite = curve(|a| -1e-5 * of(a));
        assert!(turns_as_good(&pairs(&turn(), &opposite, &m, 8)).unwrap() > 0.99);
        assert_eq!(turns_as_good(&pairs(&turn(), &[0.0; 360], &m, 8)), None);
    }
}
