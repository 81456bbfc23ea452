//! Mean and extremes of the force over each turn of the spindle.
//!
//! `mean = 1/T integral of F dt` over `T = 2 pi / omega`, by trapezia with the force between samples on a line: a turn
//! need not contain a whole number of samples.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `T` | time of a revolution | s |
//! | `omega` | speed of the spindle, either sense | rad/s |

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::{Record, RecordError};

/// The extremes of a revolution with fewer samples are not reported: with 8, one wave a turn is met within 8 percent of
/// its height.
const LEAST_SAMPLES: usize = 8;

/// One turn of the spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution {
    /// When it begins, s.
    pub start: f64,
    /// Its middle, s.
    pub middle: f64,
    /// Mean force, N.
    pub mean: Vector3<f64>,
    /// Least of each component, N.
    pub least: Vector3<f64>,
    /// Most of each component, N.
    pub most: Vector3<f64>,
    /// The force where it is largest, N.
    pub strongest: Vector3<f64>,
}

/// The whole turns of a spindle at `spindle` rad/s, from the first instant on.
///
/// # Errors
/// Fewer than 8 samples a revolution, or no whole revolution.
pub fn revolutions(record: &Record, spindle: f64) -> Result<Vec<Revolution>, RecordError> {
    let (time, force) = (record.time(), record.force());
    let period = TAU / spindle.abs();
    let (first, last) = (time[0], time[time.len() - 1]);
    let samples = period * (time.len() - 1) as f64 / (last - first);
    // A hair of slack, so that a record of exactly n turns has n.
    let whole = ((last - first) / period + 1e-9).floor();
    if !(samples >= LEAST_SAMPLES as f64 && whole >= 1.0) {
        return Err(RecordError::Revolution {
            samples,
            least: LEAST_SAMPLES,
        });
    }
    let mut turns = Vec::new();
    let mut before = 0;
    // Each turn has at least a sample, so that there are no more turns than samples.
    for turn in 0..(whole as usize).min(time.len()) {
        let start = first + period * turn as f64;
        let end = (start + period).min(last);
        let mut sum = Vector3::zeros();
        let (mut at, mut value) = (start, record.force_at(start));
        let (mut least, mut most, mut strongest) = (value, value, value);
        let mut next = before;
        while next < time.len() && time[next] <= start {
            next += 1;
        }
        loop {
            let inside = next < time.len() && time[next] < end;
            let (to, here) = match inside {
                true => (time[next], force[next]),
                false => (end, record.force_at(end)),
            };
            sum += (value + here) * (0.5 * (to - at));
            (at, value) = (to, here);
            (least, most) = (least.inf(&here), most.sup(&here));
            if here.norm_squared() > strongest.norm_squared() {
                strongest = here;
            }
            if !inside {
                break;
            }
            next += 1;
        }
        before = next.saturating_sub(1);
        turns.push(Revolution {
            start,
            middle: 0.5 * (start + end),
            mean: sum / (end - start),
            least,
            most,
            strongest,
        });
    }
    Ok(turns)
}

/// The mean force at an instant, on a line between the middles of the turns; before the first middle and after the last
/// constant. `None` without turns.
pub fn mean_at(turns: &[Revolution], time: f64) -> Option<Vector3<f64>> {
    let after = turns.partition_point(|turn| turn.middle <= time);
    let Some((before, next)) = after.checked_sub(1).map(|k| &turns[k]).zip(turns.get(after)) else {
        return turns.get(after).or(turns.last()).map(|turn| turn.mean);
    };
    let part = (time - before.middle) / (next.middle - before.middle);
    Some(before.mean + (next.mean - before.mean) * part)
}

/// The turn that contains an instant, the nearest one beyond the ends; `None` without turns.
pub fn turn_at(turns: &[Revolution], time: f64) -> Option<&Revolution> {
    let after = turns.partition_point(|turn| turn.start <= time);
    turns.get(after.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::super::ActsOn;
    use super::*;

    fn record(count: i32, rate_hz: f64, of: impl Fn(f64) -> Vector3<f64>) -> Record {
        let time: Vec<f64> = (0..count).map(|k| 2.0 + f64::from(k) / rate_hz).collect();
        let force = time.iter().map(|t| of(*t - 2.0)).collect();
        Record::new(time, force, None, ActsOn::Tool).unwrap()
    }

    #[test]
    fn means_and_extremes_of_a_wave_are_exact_even_with_a_fractional_number_of_samples() {
        // 97.3 samples a turn.
        let spindle = TAU * 10_000.0 / 97.3;
        let wave = |t: f64| {
            let a = spindle * t;
            Vector3::new(50.0 + 20.0 * a.sin(), 4.0 * (3.0 * a).cos(), -7.0)
        };
        let turns = revolutions(&record(10_000, 10_000.0, wave), spindle).unwrap();
        assert_eq!(turns.len(), 102);
        for (k, turn) in turns.iter().enumerate() {
            assert!((turn.start - 2.0 - 97.3e-4 * k as f64).abs() < 1e-12);
            // A trapezium errs by (2 pi 3 / 97.3)^2 / 12 of the amplitude, and much less over a whole period.
            assert!(
                (turn.mean - Vector3::new(50.0, 0.0, -7.0)).norm() < 0.02,
                "{turn:?}"
            );
            // The highest sample is at most half a step off the crest.
            let lost = |height: f64, waves: f64| height * (1.0 - (waves * TAU / 97.3 / 2.0).cos()) + 1e-9;
            assert!(turn.most.x <= 70.0 && turn.most.x >= 70.0 - lost(20.0, 1.0));
            assert!(turn.least.y >= -4.0 && turn.least.y <= -4.0 + lost(4.0, 3.0));
            assert_eq!((turn.least.z, turn.most.z), (-7.0, -7.0));
            let strongest = turn.strongest.norm();
            assert!(strongest >= turn.mean.norm() && strongest < 71.0);
            assert!(strongest >= turn.most.x && turn.strongest.x > 69.0);
        }
    }

    #[test]
    fn a_ramp_has_the_mean_of_its_middle() {
        let spindle = TAU / 0.01234;
        let turns = revolutions(&record(1001, 1000.0, |t| Vector3::new(t, 0.0, 0.0)), spindle).unwrap();
        for turn in turns {
            assert!((turn.mean.x - (turn.start - 2.0 + 0.00617)).abs() < 1e-12);
            assert!((turn.most.x - turn.least.x - 0.01234).abs() < 1e-12);
        }
    }

    #[test]
    fn a_record_of_whole_turns_has_all_of_them() {
        let turns = revolutions(&record(1001, 1000.0, |_| Vector3::x()), -TAU / 0.1).unwrap();
        assert_eq!(turns.len(), 10);
        assert!(turns.iter().all(|turn| (turn.mean - Vector3::x()).norm() < 1e-12));
    }

    #[test]
    fn the_mean_of_a_ramp_is_the_ramp_at_every_instant_between_the_middles() {
        let spindle = TAU / 0.1;
        let turns = revolutions(
            &record(1001, 1000.0, |t| Vector3::new(3.0 * t, 0.0, 0.0)),
            spindle,
        )
        .unwrap();
        for k in 0..=90 {
            let t = 0.05 + 0.01 * f64::from(k);
            let mean = mean_at(&turns, 2.0 + t).unwrap();
            assert!((mean.x - 3.0 * t).abs() < 1e-12, "{t}: {mean}");
        }
        for (time, x) in [(0.0, 0.15), (2.01, 0.15), (2.99, 2.85), (9.0, 2.85)] {
            assert!((mean_at(&turns, time).unwrap().x - x).abs() < 1e-12, "{time}");
        }
        let starts = [(0.0, 2.0), (2.05, 2.0), (2.15, 2.1), (9.0, 2.9)];
        for (time, start) in starts {
            assert!(
                (turn_at(&turns, time).unwrap().start - start).abs() < 1e-12,
                "{time}"
            );
        }
        assert!(mean_at(&[], 0.0).is_none() && turn_at(&[], 0.0).is_none());
    }

    #[test]
    fn refuses_speeds_that_the_record_cannot_resolve() {
        let record = record(100, 1000.0, |_| Vector3::zeros());
        for spindle in [TAU * 200.0, TAU * 5.0, 0.0, f64::NAN, f64::INFINITY] {
            let found = revolutions(&record, spindle);
            assert!(
                matches!(found, Err(RecordError::Revolution { .. })),
                "{spindle}: {found:?}"
            );
        }
    }
}
