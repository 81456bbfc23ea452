//! The lag of a prediction anywhere in a long record: coarse first, then finer.
//!
//! Both are thinned to means of `k` samples, so that a search over the whole range takes a bounded number of products;
//! around the best lag the search continues with means of `k / 8`, `k / 64`, ... down to single samples.
//!
//! The confidence of the lag is that of the first search, which alone covers the whole range.

use nalgebra::Vector3;

use super::lag::{Lag, lag_within};
use super::{Record, RecordError};

/// Products of the first search: a tenth of a second.
const FIRST_PRODUCTS: f64 = 2e7;
/// From one search to the next.
const FINER: usize = 8;
/// Range of a search to either side, in steps of the one before.
const REACH: f64 = 2.0;

/// The lag of `measured` behind `predicted` (s), searched from the first to the last of a range of seconds.
///
/// # Errors
/// Steps that are not equal within a record or between both; forces that do not change.
pub fn align(measured: &Record, predicted: &Record, range: [f64; 2]) -> Result<Lag, RecordError> {
    let step = measured.step()?;
    let shorter = measured.time.len().min(predicted.time.len()) as f64;
    let products = ((range[1] - range[0]) / step + 1.0) * shorter;
    // Both the samples and the lags grow fewer.
    let mut many = (products / FIRST_PRODUCTS).sqrt().ceil().max(1.0) as usize;
    let first = thinned(measured, predicted, many, range)?;
    let mut best = first.seconds;
    while many > 1 {
        let reach = REACH * many as f64 * step;
        many = many.div_ceil(FINER);
        best = thinned(measured, predicted, many, [best - reach, best + reach])?.seconds;
    }
    Ok(Lag {
        seconds: best,
        ..first
    })
}

fn thinned(measured: &Record, predicted: &Record, many: usize, range: [f64; 2]) -> Result<Lag, RecordError> {
    match many {
        1 => lag_within(measured, predicted, range),
        many => lag_within(&means(measured, many)?, &means(predicted, many)?, range),
    }
}

/// Means of this many samples each; the remainder is dropped.
fn means(record: &Record, many: usize) -> Result<Record, RecordError> {
    let time = record.time.chunks_exact(many);
    let force = record.force.chunks_exact(many);
    Record::new(
        time.map(|block| block.iter().sum::<f64>() / many as f64)
            .collect(),
        force
            .map(|block| block.iter().sum::<Vector3<f64>>() / many as f64)
            .collect(),
        None,
        record.acts_on,
    )
}

#[cfg(test)]
mod tests {
    use super::super::ActsOn;
    use super::*;

    const RATE_HZ: f64 = 20_000.0;

    /// A cut of 4 s whose force turns once, begun at `start` s of a record from `first` s to `last` s.
    fn cut([first, last]: [f64; 2], start: f64, noise: f64) -> Record {
        let count = ((last - first) * RATE_HZ) as usize;
        let time: Vec<f64> = (0..count).map(|k| first + k as f64 / RATE_HZ).collect();
        let force = |(k, t): (usize, &f64)| {
            let phase = std::f64::consts::TAU * (t - start) / 4.0;
            let inside = (0.0..4.0).contains(&(t - start));
            let pure = Vector3::new(100.0 * phase.cos(), 100.0 * phase.sin(), 20.0);
            // Numbers without pattern, from the sample's own.
            let wild = |axis: f64| ((k as f64 * 12.9898 + axis).sin() * 43758.5453).fract();
            pure * f64::from(inside) + Vector3::new(wild(0.1), wild(0.7), wild(1.9)) * noise
        };
        let force = time.iter().enumerate().map(force).collect();
        Record::new(time, force, None, ActsOn::Tool).unwrap()
    }

    #[test]
    fn a_cut_in_a_long_noisy_record_is_found_to_a_part_of_a_sample() {
        // 20 s by 6 s at 20 kHz: 3e10 products if every lag were tried.
        let predicted = cut([-1.0, 5.0], 0.0, 0.0);
        for start in [3.00003, 11.23456, 14.9] {
            let measured = cut([0.0, 20.0], start, 30.0);
            let lag = align(&measured, &predicted, [0.0, 16.0]).unwrap();
            assert!((lag.seconds - start).abs() < 1.0 / RATE_HZ, "{start}: {lag:?}");
            // The noise makes no second peak.
            assert!(lag.confidence() > 0.8, "{lag:?}");
        }
    }

    #[test]
    fn short_records_are_searched_as_they_are() {
        let (predicted, measured) = (cut([-0.1, 0.5], 0.0, 0.0), cut([0.0, 0.8], 0.05, 0.0));
        let range = [0.03, 0.07];
        assert_eq!(
            align(&measured, &predicted, range),
            lag_within(&measured, &predicted, range)
        );
    }

    #[test]
    fn two_equal_cuts_give_a_lag_of_low_confidence() {
        let predicted = cut([-1.0, 5.0], 0.0, 0.0);
        let (one, two) = (cut([0.0, 20.0], 3.0, 0.0), cut([0.0, 20.0], 12.0, 0.0));
        let both = one.force().iter().zip(two.force()).map(|(a, b)| a + b).collect();
        let both = Record::new(one.time().to_vec(), both, None, ActsOn::Tool).unwrap();
        let lag = align(&both, &predicted, [0.0, 16.0]).unwrap();
        assert!(lag.confidence() < 0.02, "{lag:?}");
    }
}
