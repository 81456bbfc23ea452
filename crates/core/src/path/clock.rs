//! Time at each point of a program, from the first point of its first cut.
//!
//! `t[i] = t[i-1] + (s[i] - s[i-1]) / v[i]` along a cut; a rapid between two cuts takes its length over its speed.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `t` | time at a point | s |
//! | `s` | distance along all cuts | m |
//! | `v` | feed of the program for the piece before a point | m/s |
//!
//! Not modelled: acceleration and deceleration of the machine, pauses, tool changes.

use nalgebra::Vector3;

use super::program::Pace;
use super::sampled::SampledPath;
use crate::load::{ActsOn, Record, RecordError};

/// When the tip is at each point.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    time: Vec<f64>,
    /// First point of each stretch of cuts without a rapid between.
    starts: Vec<usize>,
}

/// Speeds that are not given in the program, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Speeds {
    /// Of cuts without a feed.
    pub feed: Option<f64>,
    /// Of rapids.
    pub rapid: Option<f64>,
}

/// Why the time is not known.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoTime {
    /// No feed is given.
    #[error("line {line}: no feed is given for this cut")]
    NoFeed {
        /// Line of the program.
        line: u32,
    },
    /// No rapid speed is given.
    #[error("line {line}: no speed is given for the rapid of {:.1} mm before this cut", .length * 1e3)]
    NoRapid {
        /// Line of the cut after it.
        line: u32,
        /// m
        length: f64,
    },
}

impl Clock {
    /// The time at the points of `path`.
    ///
    /// # Errors
    /// [`NoTime`] at the first point where a required speed is not given.
    pub fn of(path: &SampledPath, speeds: Speeds) -> Result<Clock, NoTime> {
        let points = &path.points;
        let (mut time, mut starts) = (Vec::with_capacity(points.len()), Vec::new());
        let mut now = 0.0;
        for (index, point) in points.iter().enumerate() {
            if path.begins(index) {
                let length = path.rapids.get(starts.len()).map_or(0.0, |rapids| rapids.length);
                if index > 0 && length > 0.0 {
                    let line = point.line;
                    let speed = speeds.rapid.filter(|speed| *speed > 0.0);
                    now += length / speed.ok_or(NoTime::NoRapid { line, length })?;
                }
                starts.push(index);
            } else {
                let given = match point.pace {
                    Pace::Feed(speed) => Some(speed),
                    Pace::Rapid | Pace::Unknown => None,
                };
                let known = given.filter(|speed| *speed > 0.0).or(speeds.feed);
                let speed = known.filter(|speed| *speed > 0.0);
                let speed = speed.ok_or(NoTime::NoFeed { line: point.line })?;
                now += (point.along - points[index - 1].along) / speed;
            }
            time.push(now);
        }
        Ok(Clock { time, starts })
    }

    /// Time at each point, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Time at the last point, s.
    pub fn duration(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0)
    }

    /// Resamples a force given at each point (N) to a record with equal steps of `step` s, with `margin` s of zero
    /// force at both ends; no force in rapids.
    ///
    /// # Errors
    /// Fewer than two samples, or more than the limit; a force that is not finite.
    pub fn record(
        &self,
        force: impl Fn(usize) -> Vector3<f64>,
        step: f64,
        margin: f64,
    ) -> Result<Record, RecordError> {
        let lead = (margin / step).ceil();
        // Computed as a float first: very large numbers must not overflow.
        let count = (self.duration() / step).ceil() + 2.0 * lead + 1.0;
        if count > MOST_SAMPLES {
            let most = MOST_SAMPLES;
            return Err(RecordError::TooManySamples { count, most });
        }
        if count.is_nan() || count < 2.0 {
            let count = count.clamp(0.0, 1.0) as usize;
            return Err(RecordError::TooShort { count, least: 2 });
        }
        let instants: Vec<f64> = (0..count as usize).map(|k| (k as f64 - lead) * step).collect();
        let mut next = 0;
        let forces = instants.iter().map(|t| {
            while next < self.time.len() && self.time[next] <= *t {
                next += 1;
            }
            let cutting = next > 0 && next < self.time.len() && self.starts.binary_search(&next).is_err();
            if !cutting {
                return Vector3::zeros();
            }
            let (before, after) = (self.time[next - 1], self.time[next]);
            let part = (t - before) / (after - before);
            force(next - 1) * (1.0 - part) + force(next) * part
        });
        let forces = forces.collect();
        Record::new(instants, forces, None, ActsOn::Tool)
    }
}

/// Maximum number of samples of a record: the same as for reading.
const MOST_SAMPLES: f64 = 5e7;

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::super::program::{Course, Move};
    use super::super::sampled::Rapids;
    use super::super::sampler::{Sampler, Sampling};
    use super::*;

    /// 20 mm at 10 mm/s, a rapid of 5.0 mm, 10 mm without a feed.
    fn path() -> SampledPath {
        let mut sampler = Sampler::new(Sampling {
            chord_error: 1e-5,
            step: 1e-3,
        });
        let to = |x: f64, y: f64, pace| Move {
            end: Point3::new(x * 1e-3, y * 1e-3, 0.0),
            axis: None,
            spin: None,
            course: Course::Line,
            pace,
            line: x as u32 + 1,
        };
        let mut path = SampledPath {
            rapids: [0.3, 0.005]
                .map(|length| Rapids {
                    length,
                    ..Rapids::default()
                })
                .to_vec(),
            ..SampledPath::default()
        };
        for next in [
            to(0.0, 0.0, Pace::Rapid),
            to(20.0, 0.0, Pace::Feed(0.01)),
            to(20.0, 5.0, Pace::Rapid),
            to(10.0, 5.0, Pace::Unknown),
        ] {
            sampler.points(&next, |point| path.points.push(point));
        }
        path
    }

    const SPEEDS: Speeds = Speeds {
        feed: Some(0.005),
        rapid: Some(0.1),
    };

    #[test]
    fn cuts_take_their_length_over_the_feed_and_rapids_theirs() {
        let path = path();
        let clock = Clock::of(&path, SPEEDS).unwrap();
        // Times before the first cut are negative.
        assert_eq!(clock.time()[0], 0.0);
        assert!((clock.time()[20] - 2.0).abs() < 1e-12 && path.begins(21));
        assert!((clock.time()[21] - 2.05).abs() < 1e-12);
        assert!((clock.duration() - 4.05).abs() < 1e-12);
    }

    #[test]
    fn a_speed_that_is_not_given_is_reported_where_it_is_first_required() {
        let path = path();
        let no_rapid = Speeds {
            rapid: None,
            ..SPEEDS
        };
        let found = Clock::of(&path, no_rapid).unwrap_err();
        assert_eq!(
            found.to_string(),
            "line 11: no speed is given for the rapid of 5.0 mm before this cut"
        );
        let found = Clock::of(&path, Speeds { feed: None, ..SPEEDS });
        assert_eq!(found.unwrap_err(), NoTime::NoFeed { line: 11 });
        // A rapid of zero length takes no time and needs no speed.
        let path = SampledPath {
            rapids: vec![Rapids::default(); 2],
            ..path
        };
        assert!(Clock::of(&path, no_rapid).is_ok());
    }

    #[test]
    fn a_record_has_the_forces_of_the_points_and_none_in_rapids_and_margins() {
        let clock = Clock::of(&path(), SPEEDS).unwrap();
        let times = clock.time().to_vec();
        let record = clock
            .record(|i| Vector3::x() * (1.0 + times[i]), 0.01, 0.5)
            .unwrap();
        assert!((record.begin() + 0.5).abs() < 1e-12 && record.end() >= clock.duration() + 0.5 - 1e-9);
        for (t, force) in record.time().iter().zip(record.force()) {
            let cutting = (0.0..2.0).contains(t) || (2.05..4.05).contains(t);
            // At the ends of a cut rounding decides.
            if [0.0, 2.0, 2.05, 4.05].iter().any(|end| (t - end).abs() < 1e-9) {
                continue;
            }
            let expected = if cutting { 1.0 + t } else { 0.0 };
            assert!((force.x - expected).abs() < 1e-9, "{t}: {force}");
        }
    }

    #[test]
    fn a_record_with_too_many_or_too_few_samples_is_refused() {
        let clock = Clock::of(&path(), SPEEDS).unwrap();
        let of_step = |step: f64| clock.record(|_| Vector3::x(), step, 0.0).unwrap_err();
        for step in [1e-12, 1e-300] {
            let error = of_step(step);
            assert!(
                matches!(error, RecordError::TooManySamples { .. }),
                "{step}: {error}"
            );
        }
        let given = of_step(1e-12).to_string();
        assert_eq!(
            given,
            "a record of 4.1e12 instants exceeds the maximum of 5e7: increase the time step"
        );
        assert_eq!(
            of_step(f64::INFINITY),
            RecordError::TooShort { count: 1, least: 2 }
        );
        for step in [-1.0, 0.0, f64::NAN] {
            assert_eq!(
                of_step(step),
                RecordError::TooShort { count: 0, least: 2 },
                "{step}"
            );
        }
        let endless = clock.record(|_| Vector3::x() * f64::INFINITY, 0.1, 0.5);
        // First half a second of zero force.
        assert_eq!(endless, Err(RecordError::NotFinite(5)));
    }
}
