//! Drift of the charge amplifier: a straight line in time through the air cuts, where no force acts.
//!
//! `drift(t) = offset + rate (t - t0)`, by least squares through the samples of all air cuts, each channel separately.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `offset`, `rate` | drift at the first instant, and its growth | N, N/s (N m, N m/s) |
//! | `t0` | the first instant | s |
//!
//! Air cuts that are not given are found: the record is cut into blocks; the quietest block of the first half and the
//! quietest of the second half, each with its neighbours that are as quiet. Quiet is a small scatter about the mean of
//! the block, all axes of the force together.

use nalgebra::Vector3;

use super::{Record, RecordError};

/// Selection of the air cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AirCut<'a> {
    /// Start and end times given by the user, s.
    Given(&'a [[f64; 2]]),
    /// The quietest stretches of both halves.
    Found,
}

/// The drift removed, and the air cuts used.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Of the force at the first instant, N.
    pub offset: Vector3<f64>,
    /// Its growth, N/s.
    pub rate: Vector3<f64>,
    /// Air cuts, from when to when, s.
    pub through: Vec<[f64; 2]>,
    /// Samples in them.
    pub samples: usize,
}

/// Blocks of a record that is searched for air cuts: a few revolutions each in a record of some seconds.
const BLOCKS: usize = 64;
/// No block has fewer samples: fewer give no scatter.
const LEAST_SAMPLES: usize = 8;
/// Two blocks in each half, so that one can be quieter than the other.
const LEAST_BLOCKS: usize = 4;
/// A neighbour with up to this multiple of the scatter belongs to the air cut.
const AS_QUIET: f64 = 2.0;
/// The median scatter of all blocks is at least this multiple of the scatter of an air cut.
const QUIETER: f64 = 3.0;

/// The record without its drift, and the drift.
///
/// # Errors
/// Given air cuts without two samples at different times; no stretch that is quiet enough.
pub fn remove(record: &Record, air_cut: AirCut) -> Result<(Record, Drift), RecordError> {
    let through = match air_cut {
        AirCut::Given(ranges) => ranges.to_vec(),
        AirCut::Found => quiet_stretches(record)?,
    };
    let start = record.time[0];
    let within = |time: f64| through.iter().any(|[from, to]| (*from..=*to).contains(&time));
    let chosen: Vec<usize> = (0..record.time.len())
        .filter(|k| within(record.time[*k]))
        .collect();
    let line = Line::of(&chosen, |k| record.time[k] - start, |k| record.force[k])
        .ok_or(RecordError::NoSamplesOfAirCut(chosen.len()))?;
    let moment_line = record
        .moment
        .as_ref()
        .and_then(|moment| Line::of(&chosen, |k| record.time[k] - start, |k| moment[k]));
    let mut freed = record.clone();
    for (k, force) in freed.force.iter_mut().enumerate() {
        *force -= line.at(record.time[k] - start);
    }
    if let (Some(moment), Some(line)) = (&mut freed.moment, moment_line) {
        for (k, moment) in moment.iter_mut().enumerate() {
            *moment -= line.at(record.time[k] - start);
        }
    }
    let drift = Drift {
        offset: line.offset,
        rate: line.rate,
        through,
        samples: chosen.len(),
    };
    Ok((freed, drift))
}

struct Line {
    offset: Vector3<f64>,
    rate: Vector3<f64>,
}

impl Line {
    /// Through the chosen samples; `None` if they are at less than two times.
    fn of(
        chosen: &[usize],
        time: impl Fn(usize) -> f64,
        value: impl Fn(usize) -> Vector3<f64>,
    ) -> Option<Line> {
        let count = chosen.len() as f64;
        let mean_time = chosen.iter().map(|k| time(*k)).sum::<f64>() / count;
        let mean = chosen.iter().map(|k| value(*k)).sum::<Vector3<f64>>() / count;
        // About the means, so that large times cost no digits.
        let (mut spread, mut product) = (0.0, Vector3::zeros());
        for k in chosen {
            let apart = time(*k) - mean_time;
            spread += apart * apart;
            product += (value(*k) - mean) * apart;
        }
        (spread > 0.0).then(|| {
            let rate = product / spread;
            Line {
                offset: mean - rate * mean_time,
                rate,
            }
        })
    }

    fn at(&self, time: f64) -> Vector3<f64> {
        self.offset + self.rate * time
    }
}

/// The quietest stretch of each half, s.
fn quiet_stretches(record: &Record) -> Result<Vec<[f64; 2]>, RecordError> {
    let count = record.time.len();
    let size = (count / BLOCKS).max(LEAST_SAMPLES);
    let scatters: Vec<f64> = record.force.chunks_exact(size).map(scatter).collect();
    if scatters.len() < LEAST_BLOCKS {
        let least = LEAST_BLOCKS * LEAST_SAMPLES;
        return Err(RecordError::TooShort { count, least });
    }
    let mut sorted = scatters.clone();
    sorted.sort_by(f64::total_cmp);
    let (quietest, median) = (sorted[0], sorted[sorted.len() / 2]);
    let half = scatters.len() / 2;
    let stretch = |from: usize, to: usize| {
        let first = (from..to)
            .min_by(|a, b| scatters[*a].total_cmp(&scatters[*b]))
            .unwrap_or(from);
        let loud = AS_QUIET * scatters[first];
        let begin = (from..first)
            .rev()
            .take_while(|k| scatters[*k] <= loud)
            .last()
            .unwrap_or(first);
        let end = (first..to)
            .take_while(|k| scatters[*k] <= loud)
            .last()
            .unwrap_or(first);
        (
            scatters[first],
            [record.time[begin * size], record.time[(end + 1) * size - 1]],
        )
    };
    let (before, after) = (stretch(0, half), stretch(half, scatters.len()));
    if before.0.max(after.0) * QUIETER > median {
        return Err(RecordError::NoQuietStretch {
            quietest_n: quietest,
            median_n: median,
        });
    }
    Ok(vec![before.1, after.1])
}

/// Standard deviation of a block, all axes together, N.
fn scatter(block: &[Vector3<f64>]) -> f64 {
    let count = block.len() as f64;
    let mean = block.iter().sum::<Vector3<f64>>() / count;
    (block
        .iter()
        .map(|force| (force - mean).norm_squared())
        .sum::<f64>()
        / count)
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::ActsOn;
    use super::*;

    const OFFSET: Vector3<f64> = Vector3::new(3.0, -2.0, 0.5);
    const RATE: Vector3<f64> = Vector3::new(0.4, 0.0, -1.2);

    /// Cutting from 1 s to 3 s of 4 s at 2 kHz, with a little noise of no chance at all.
    fn record(noise: f64) -> (Record, Vec<Vector3<f64>>) {
        let time: Vec<f64> = (0..8000).map(|k| f64::from(k) / 2000.0).collect();
        let cut = |t: f64| match (1.0..3.0).contains(&t) {
            true => Vector3::new(100.0 + 50.0 * (500.0 * t).sin(), 30.0 * (500.0 * t).cos(), -20.0),
            false => Vector3::zeros(),
        };
        let pure: Vec<Vector3<f64>> = time.iter().map(|t| cut(*t)).collect();
        let force = (0..time.len())
            .map(|k| {
                let wiggle = noise * (1.7 * k as f64).sin();
                pure[k] + OFFSET + RATE * time[k] + Vector3::repeat(wiggle)
            })
            .collect();
        (Record::new(time, force, None, ActsOn::Tool).unwrap(), pure)
    }

    #[test]
    fn a_known_drift_is_found_from_given_air_cuts() {
        let (record, pure) = record(0.0);
        let (freed, drift) = remove(&record, AirCut::Given(&[[0.0, 0.9], [3.1, 4.0]])).unwrap();
        // Rounding of sums of some thousand numbers of some newtons.
        assert!((drift.offset - OFFSET).norm() < 1e-11 && (drift.rate - RATE).norm() < 1e-11);
        assert!(
            freed
                .force()
                .iter()
                .zip(&pure)
                .all(|(a, b)| (a - b).norm() < 1e-10)
        );
        assert_eq!(drift.samples, 1801 + 1800);
    }

    #[test]
    fn air_cuts_are_found_before_and_after_the_cut() {
        let (record, pure) = record(0.2);
        let (freed, drift) = remove(&record, AirCut::Found).unwrap();
        let [before, after] = drift.through[..] else {
            panic!("{drift:?}")
        };
        assert!(
            before[1] < 1.0 && after[0] >= 3.0 && before[0] < before[1] && after[0] < after[1],
            "{drift:?}"
        );
        // A sine has no mean over many periods; what is left is far less than the noise.
        assert!(
            freed
                .force()
                .iter()
                .zip(&pure)
                .all(|(a, b)| (a - b).norm() < 0.2 * 3f64.sqrt() + 0.02)
        );
        assert!((drift.rate - RATE).norm() < 0.01, "{drift:?}");
    }

    #[test]
    fn drift_of_the_moment_is_removed_too() {
        let time = vec![0.0, 1.0, 2.0, 3.0];
        let ramp: Vec<Vector3<f64>> = time.iter().map(|t| Vector3::new(1.0 + t, 0.0, 2.0 * t)).collect();
        let record = Record::new(time, ramp.clone(), Some(ramp), ActsOn::Tool).unwrap();
        let (freed, _) = remove(&record, AirCut::Given(&[[0.0, 3.0]])).unwrap();
        assert!(
            freed
                .moment()
                .unwrap()
                .iter()
                .chain(freed.force())
                .all(|v| v.norm() < 1e-14)
        );
    }

    #[test]
    fn refuses_records_without_air_cut() {
        let (record, _) = record(0.0);
        assert_eq!(
            remove(&record, AirCut::Given(&[[9.0, 10.0]])).unwrap_err(),
            RecordError::NoSamplesOfAirCut(0)
        );
        assert_eq!(
            remove(&record, AirCut::Given(&[[0.0, 1e-6]])).unwrap_err(),
            RecordError::NoSamplesOfAirCut(1)
        );
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) / 2000.0).collect();
        let force = time
            .iter()
            .map(|t| Vector3::new((500.0 * t).sin(), 0.0, 0.0))
            .collect();
        let steady = Record::new(time, force, None, ActsOn::Tool).unwrap();
        assert!(matches!(
            remove(&steady, AirCut::Found),
            Err(RecordError::NoQuietStretch { .. })
        ));
        // As many as are too few by one, and as many as are needed.
        let of = |count: usize| {
            let time = (0..count).map(|k| k as f64).collect();
            Record::new(time, vec![OFFSET; count], None, ActsOn::Tool).unwrap()
        };
        let least = LEAST_BLOCKS * LEAST_SAMPLES;
        assert_eq!(
            remove(&of(least - 1), AirCut::Found).unwrap_err(),
            RecordError::TooShort {
                count: least - 1,
                least
            }
        );
        assert!(remove(&of(least), AirCut::Found).is_ok());
    }
}
