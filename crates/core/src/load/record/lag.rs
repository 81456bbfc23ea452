//! Lag of a measured force behind a predicted one: `measured(t) = predicted(t - lag)`.
//!
//! By start: both cross a threshold of force for the first time. By correlation: the lag `k` at which
//!
//! `r(k) = sum of m[i + k] . p[i] / sqrt(sum of |m[i + k]|^2 sum of |p[i]|^2)`
//!
//! is largest, `m` and `p` without their means, sums over the samples that both have; then the top of the parabola
//! through `r(k)` and its neighbours.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m`, `p` | measured and predicted force | N |
//! | `r` | correlation, from -1 to 1 | 1 |
//!
//! A force that repeats with each tooth fits again one tooth later: the second best peak gives the confidence in the
//! best. Noise peaks next to the best one are ignored: the correlation must fall between two peaks.

use nalgebra::Vector3;

use super::{Record, RecordError};

/// A lag and its confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// Lag of the measured force behind the predicted one, s.
    pub seconds: f64,
    /// Correlation there: 1 for the same shape.
    pub likeness: f64,
    /// Correlation of the second best peak; as high as the first where the force repeats. `None` if there is no other.
    pub runner_up: Option<f64>,
}

impl Lag {
    /// From 0 to 1: lead of the best lag over the second best, times its correlation.
    pub fn confidence(&self) -> f64 {
        let likeness = self.likeness.clamp(0.0, 1.0);
        let other = self.runner_up.unwrap_or(0.0).clamp(0.0, 1.0);
        (likeness - other).max(0.0)
    }
}

/// Maximum number of products of two forces in a search: some seconds.
const MOST_PRODUCTS: f64 = 2e9;
/// The parts that overlap are at least this share of the shorter record.
const LEAST_OVERLAP: f64 = 0.5;
/// Fall of the correlation between two peaks; noise makes smaller waves on the slopes of one.
const LEAST_FALL: f64 = 0.01;
/// Steps of both records are equal within this.
const STEP_SLACK: f64 = 1e-4;

/// The instant (s) at which the force is larger than `threshold` N for the first time, on a line between samples.
///
/// # Errors
/// A force that never crosses the threshold, or is above it from the beginning.
pub fn start(record: &Record, threshold: f64) -> Result<f64, RecordError> {
    let size = |k: usize| record.force[k].norm();
    match (0..record.time.len()).find(|k| size(*k) > threshold) {
        None => Err(RecordError::NoLag("a force never crosses the threshold")),
        Some(0) => Err(RecordError::NoLag(
            "a force is above the threshold from the beginning",
        )),
        Some(k) => {
            let part = (threshold - size(k - 1)) / (size(k) - size(k - 1));
            Ok(record.time[k - 1] + (record.time[k] - record.time[k - 1]) * part)
        }
    }
}

/// The lag by correlation, searched in a range of seconds about equal times.
///
/// # Errors
/// Steps that are not equal within a record or between both; forces that do not change; too many products.
pub fn lag_within(measured: &Record, predicted: &Record, [from, to]: [f64; 2]) -> Result<Lag, RecordError> {
    let (step, other) = (measured.step()?, predicted.step()?);
    if (step - other).abs() > STEP_SLACK * step {
        return Err(RecordError::OtherSteps {
            measured_s: step,
            predicted_s: other,
        });
    }
    let (m, p) = (without_mean(&measured.force), without_mean(&predicted.force));
    let shorter = m.len().min(p.len()) as f64;
    // Lags are relative to equal times, shifts to equal samples.
    let ahead = (predicted.time[0] - measured.time[0]) / step;
    let (low, high) = ((ahead + from / step).ceil(), (ahead + to / step).floor());
    let products = (high - low + 1.0) * shorter;
    if products.is_nan() || products > MOST_PRODUCTS {
        return Err(RecordError::TooMuchWork {
            products,
            most: MOST_PRODUCTS,
        });
    }
    let likenesses: Vec<(f64, f64)> = (low as i64..=high as i64)
        .filter_map(|shift| Some((shift as f64, likeness(&m, &p, shift, LEAST_OVERLAP * shorter)?)))
        .collect();
    let peaks: Vec<usize> = (0..likenesses.len())
        .filter(|k| {
            let here = likenesses[*k].1;
            let before = k.checked_sub(1).is_none_or(|before| likenesses[before].1 < here);
            before && likenesses.get(k + 1).is_none_or(|after| after.1 <= here)
        })
        .collect();
    let best = peaks
        .iter()
        .copied()
        .max_by(|a, b| likenesses[*a].1.total_cmp(&likenesses[*b].1));
    let Some(best) = best else {
        return Err(RecordError::NoLag(
            "a force does not change, or the records hardly overlap",
        ));
    };
    let apart = |peak: usize| {
        let between = &likenesses[peak.min(best)..=peak.max(best)];
        let valley = between.iter().map(|(_, r)| *r).fold(f64::INFINITY, f64::min);
        likenesses[peak].1 - valley >= LEAST_FALL
    };
    let others = peaks.iter().filter(|peak| apart(**peak));
    let others = others.map(|peak| likenesses[*peak].1);
    let (top, height) = parabola(&likenesses, best);
    Ok(Lag {
        seconds: (likenesses[best].0 + top - ahead) * step,
        likeness: height.min(1.0),
        runner_up: others.max_by(f64::total_cmp),
    })
}

fn without_mean(force: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mean = force.iter().sum::<Vector3<f64>>() / force.len() as f64;
    force.iter().map(|force| force - mean).collect()
}

/// Likeness of `m` moved forward by `shift` samples with `p`; `None` where too few overlap or one does not change.
fn likeness(m: &[Vector3<f64>], p: &[Vector3<f64>], shift: i64, least: f64) -> Option<f64> {
    let from = usize::try_from((-shift).max(0)).ok()?;
    let ahead = usize::try_from(shift.max(0)).ok()?;
    let (m, p) = (m.get(ahead..)?, p.get(from..)?);
    let count = m.len().min(p.len());
    if (count as f64) < least {
        return None;
    }
    let [mut both, mut of_m, mut of_p] = [0.0; 3];
    for (m, p) in m.iter().zip(p) {
        both += m.dot(p);
        of_m += m.norm_squared();
        of_p += p.norm_squared();
    }
    let norm = (of_m * of_p).sqrt();
    (norm > 0.0).then(|| both / norm)
}

/// The top of the parabola through a peak and its neighbours: where, in samples from the peak, and how high.
fn parabola(likenesses: &[(f64, f64)], peak: usize) -> (f64, f64) {
    let here = likenesses[peak].1;
    let neighbours = peak.checked_sub(1).zip(likenesses.get(peak + 1));
    let Some((before, after)) = neighbours.map(|(before, after)| (likenesses[before].1, after.1)) else {
        return (0.0, here);
    };
    let bend = before - 2.0 * here + after;
    if bend >= 0.0 {
        return (0.0, here);
    }
    let top = 0.5 * (before - after) / bend;
    (top, here - 0.25 * (before - after) * top)
}

#[cfg(test)]
mod tests {
    use super::super::ActsOn;
    use super::*;

    /// From `first` s on at 5 kHz: a cut that begins at 0.1 s, in which every tooth is a little different.
    fn record(first: f64, count: i32, late: f64) -> Record {
        let time: Vec<f64> = (0..count).map(|k| first + f64::from(k) / 5000.0).collect();
        let cut = |t: f64| match t < 0.1 {
            true => Vector3::zeros(),
            false => {
                let grows = 1.0 - (-(t - 0.1) / 0.03).exp();
                Vector3::new((400.0 * t).sin() + 0.3 * (61.0 * t).cos(), (400.0 * t).cos(), 0.4)
                    * (100.0 * grows)
            }
        };
        let force = time.iter().map(|t| cut(t - late)).collect();
        Record::new(time, force, None, ActsOn::Tool).unwrap()
    }

    #[test]
    fn a_known_lag_is_found_to_a_small_part_of_a_sample() {
        let predicted = record(0.0, 3000, 0.0);
        for late in [0.0, 0.0123, -0.0077, 0.00333] {
            let lag = lag_within(&record(0.0, 3000, late), &predicted, [-0.02, 0.02]).unwrap();
            // A twentieth of the step of 0.2 ms.
            assert!((lag.seconds - late).abs() < 1e-5, "{late}: {lag:?}");
            assert!(lag.likeness > 0.98, "{lag:?}");
        }
    }

    #[test]
    fn records_that_begin_at_other_times_have_the_same_lag() {
        let predicted = record(0.0, 3000, 0.0);
        let lag = lag_within(&record(0.0305, 3000, 0.0123), &predicted, [-0.02, 0.02]).unwrap();
        assert!((lag.seconds - 0.0123).abs() < 2e-5, "{lag:?}");
    }

    #[test]
    fn the_size_of_the_measured_force_does_not_matter() {
        let predicted = record(0.0, 3000, 0.0);
        let measured = record(0.0, 3000, 0.0042);
        let larger = measured.clone().mapped(|force| force * 7.0);
        let (a, b) = (
            lag_within(&measured, &predicted, [-0.02, 0.02]),
            lag_within(&larger, &predicted, [-0.02, 0.02]),
        );
        assert!((a.unwrap().seconds - b.unwrap().seconds).abs() < 1e-12);
    }

    #[test]
    fn a_force_that_repeats_gives_a_lag_of_low_confidence() {
        let wave = |late: f64| {
            let time: Vec<f64> = (0..5000).map(|k| f64::from(k) / 5000.0).collect();
            let force = time
                .iter()
                .map(|t| Vector3::new((400.0 * (t - late)).sin(), 0.0, 0.0))
                .collect();
            Record::new(time, force, None, ActsOn::Tool).unwrap()
        };
        let unsure = lag_within(&wave(0.001), &wave(0.0), [-0.04, 0.04]).unwrap();
        assert!(unsure.confidence() < 0.02, "{unsure:?}");
        let lag = lag_within(&wave(0.001), &wave(0.0), [-0.006, 0.006]).unwrap();
        assert!(
            (lag.seconds - 0.001).abs() < 1e-5 && lag.confidence() > 0.9,
            "{lag:?}"
        );
    }

    #[test]
    fn the_start_is_where_the_threshold_is_crossed() {
        let ramp = |late: f64| {
            let time = vec![0.0, 1.0, 2.0, 3.0, 4.0];
            let force = time
                .iter()
                .map(|t: &f64| Vector3::new(0.0, 0.0, -10.0 * (t - late).max(0.0)))
                .collect();
            Record::new(time, force, None, ActsOn::Tool).unwrap()
        };
        // 5 N are reached half a second after the ramp has begun.
        for late in [0.0, 1.0, 2.0] {
            let found = start(&ramp(late), 5.0).unwrap();
            assert!((found - late - 0.5).abs() < 1e-15, "{late}: {found}");
        }
        assert!(matches!(start(&ramp(2.0), 50.0), Err(RecordError::NoLag(_))));
        assert!(matches!(start(&ramp(-5.0), 5.0), Err(RecordError::NoLag(_))));
    }

    #[test]
    fn refuses_records_that_cannot_be_compared() {
        let predicted = record(0.0, 3000, 0.0);
        let slow = Record::new(vec![0.0, 1.0], vec![Vector3::x(); 2], None, ActsOn::Tool).unwrap();
        assert!(matches!(
            lag_within(&slow, &predicted, [-0.1, 0.1]),
            Err(RecordError::OtherSteps { .. })
        ));
        assert!(matches!(
            lag_within(&slow, &slow, [-0.1, 0.1]),
            Err(RecordError::NoLag(_))
        ));
        for most in [1e9, f64::INFINITY, f64::NAN] {
            let found = lag_within(&predicted, &predicted, [-most, most]);
            assert!(
                matches!(found, Err(RecordError::TooMuchWork { .. })),
                "{most}: {found:?}"
            );
        }
        let far = record(100.0, 3000, 0.0);
        assert!(matches!(
            lag_within(&far, &predicted, [-0.1, 0.1]),
            Err(RecordError::NoLag(_))
        ));
    }
}
