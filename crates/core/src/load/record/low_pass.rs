//! Low-pass without lag: a Butterworth filter of second order, forward and then backward.
//!
//! `amplitude(f) = 1 / (1 + (tan(pi f / fs) / tan(pi fc / fs))^4)`: one half at the cutoff, since both passes take
//! `1 / sqrt(2)` each; no phase at any frequency.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f`, `fc`, `fs` | frequency, cutoff, sampling rate | Hz |
//!
//! The ends are continued by turning the record about its first and last sample, so that constants and lines pass as
//! they are. Source: bilinear transform of `1 / (s^2 + sqrt(2) s + 1)`; Gustafsson, Determining the initial states in
//! forward-backward filtering, IEEE Trans. Signal Processing 44 (1996).

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::{Record, RecordError};

/// The ends are extended by this many periods of the cutoff: the memory of the filter fades to e^-13 over them.
const CONTINUED_PERIODS: f64 = 3.0;

/// The record without components above `cutoff_hz`.
///
/// # Errors
/// Steps that are not equal; a cutoff that is not between 0 and half the sampling rate.
pub fn low_pass(record: &Record, cutoff_hz: f64) -> Result<Record, RecordError> {
    let rate_hz = record.step()?.recip();
    let half_rate_hz = rate_hz / 2.0;
    // Not `>=`: a cutoff that is not a number is refused too.
    if !(cutoff_hz > 0.0 && cutoff_hz < half_rate_hz) {
        return Err(RecordError::Cutoff {
            cutoff_hz,
            half_rate_hz,
        });
    }
    let filter = Butterworth::new(cutoff_hz / rate_hz);
    let periods = (CONTINUED_PERIODS * rate_hz / cutoff_hz).ceil();
    let continued = periods.min((record.time.len() - 1) as f64) as usize;
    let mut smooth = record.clone();
    smooth.force = filter.both_ways(&record.force, continued);
    smooth.moment = record
        .moment
        .as_ref()
        .map(|moment| filter.both_ways(moment, continued));
    Ok(smooth)
}

/// `y[k] = b0 (x[k] + 2 x[k-1] + x[k-2]) - a1 y[k-1] - a2 y[k-2]`
struct Butterworth {
    b0: f64,
    a1: f64,
    a2: f64,
}

impl Butterworth {
    /// With a cutoff in parts of the sampling rate.
    fn new(cutoff: f64) -> Butterworth {
        let w = (PI * cutoff).tan();
        let norm = 1.0 + std::f64::consts::SQRT_2 * w + w * w;
        Butterworth {
            b0: w * w / norm,
            a1: 2.0 * (w * w - 1.0) / norm,
            a2: (1.0 - std::f64::consts::SQRT_2 * w + w * w) / norm,
        }
    }

    fn both_ways(&self, values: &[Vector3<f64>], continued: usize) -> Vec<Vector3<f64>> {
        let (Some(first), Some(last)) = (values.first(), values.last()) else {
            return Vec::new();
        };
        let before = values[1..=continued]
            .iter()
            .rev()
            .map(|value| first * 2.0 - value);
        let after = values[values.len() - 1 - continued..values.len() - 1]
            .iter()
            .rev()
            .map(|value| last * 2.0 - value);
        let mut all: Vec<Vector3<f64>> = before.chain(values.iter().copied()).chain(after).collect();
        self.pass(&mut all);
        all.reverse();
        self.pass(&mut all);
        all.reverse();
        all[continued..continued + values.len()].to_vec()
    }

    /// One pass in place, started in the steady state of the first value.
    fn pass(&self, values: &mut [Vector3<f64>]) {
        let Some(first) = values.first().copied() else {
            return;
        };
        let [mut x1, mut x2, mut y1, mut y2] = [first; 4];
        for value in values {
            let x = *value;
            let y = (x + x1 * 2.0 + x2) * self.b0 - y1 * self.a1 - y2 * self.a2;
            (x2, x1, y2, y1) = (x1, x, y1, y);
            *value = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ActsOn;
    use super::*;

    const RATE_HZ: f64 = 1000.0;

    fn record(of: impl Fn(f64) -> f64) -> Record {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) / RATE_HZ).collect();
        let force = time.iter().map(|t| Vector3::new(of(*t), -of(*t), 0.0)).collect();
        Record::new(time, force, None, ActsOn::Tool).unwrap()
    }

    /// What a tone of `frequency_hz` keeps of its amplitude: the formula of this page.
    fn amplitude(frequency_hz: f64, cutoff_hz: f64, rate_hz: f64) -> f64 {
        let warped = |f: f64| (PI * f / rate_hz).tan();
        1.0 / (1.0 + (warped(frequency_hz) / warped(cutoff_hz)).powi(4))
    }

    #[test]
    fn tones_keep_the_amplitude_of_the_formula_and_their_phase() {
        for (frequency, cutoff) in [
            (10.0, 50.0),
            (50.0, 50.0),
            (100.0, 50.0),
            (3.0, 8.0),
            (200.0, 300.0),
            (40.0, 400.0),
        ] {
            let smooth = low_pass(&record(|t| (2.0 * PI * frequency * t).sin()), cutoff).unwrap();
            // Projection on sine and cosine over whole periods in the middle, far from the ends.
            let (mut sine, mut cosine) = (0.0, 0.0);
            for k in 1000..3000 {
                let angle = 2.0 * PI * frequency * smooth.time()[k];
                sine += smooth.force()[k].x * angle.sin() / 1000.0;
                cosine += smooth.force()[k].x * angle.cos() / 1000.0;
            }
            let expected = amplitude(frequency, cutoff, RATE_HZ);
            assert!(
                (sine - expected).abs() < 1e-9,
                "{frequency} Hz at {cutoff} Hz: {sine} is not {expected}"
            );
            assert!(cosine.abs() < 1e-9, "{frequency} Hz at {cutoff} Hz lags");
        }
        assert!((amplitude(50.0, 50.0, RATE_HZ) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn constants_and_lines_pass_as_they_are() {
        for slope in [0.0, 7.0] {
            let before = record(|t| 3.0 + slope * t);
            let after = low_pass(&before, 20.0).unwrap();
            let worst = before
                .force()
                .iter()
                .zip(after.force())
                .map(|(a, b)| (a - b).norm())
                .fold(0.0, f64::max);
            // A line starts the filter in the steady state of its first value: that fades by e^-13 in the continued
            // part.
            assert!(worst < 1e-4, "{worst} with slope {slope}");
        }
    }

    #[test]
    fn backward_in_time_is_the_same_backward() {
        let forward = record(|t| (40.0 * t).sin() + t * t);
        let backward = record(|t| {
            let u = 3.999 - t;
            (40.0 * u).sin() + u * u
        });
        let (a, b) = (
            low_pass(&forward, 30.0).unwrap(),
            low_pass(&backward, 30.0).unwrap(),
        );
        let reversed = b.force().iter().rev();
        assert!(a.force().iter().zip(reversed).all(|(a, b)| (a - b).norm() < 1e-4));
    }

    #[test]
    fn refuses_invalid_cutoffs_and_steps() {
        let record = record(|t| t);
        for cutoff in [0.0, -1.0, 500.0, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(low_pass(&record, cutoff), Err(RecordError::Cutoff { .. })),
                "{cutoff}"
            );
        }
        let uneven = Record::new(vec![0.0, 1.0, 3.0], vec![Vector3::zeros(); 3], None, ActsOn::Tool).unwrap();
        assert!(matches!(
            low_pass(&uneven, 0.1),
            Err(RecordError::UnequalSteps { .. })
        ));
        let short = Record::new(vec![0.0, 1.0], vec![Vector3::x(); 2], None, ActsOn::Tool).unwrap();
        assert!((low_pass(&short, 0.1).unwrap().force()[0].x - 1.0).abs() < 1e-12);
    }
}
