//! A measured force over time.
//!
//! [`drift`]: removal of the drift of the amplifier. [`low_pass`]: low-pass filter.
//! [`revolutions`]: mean and extremes of each turn of the spindle. [`lag`]: its lag behind a prediction;
//! [`align`]: the same for long records, coarse first and then finer.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `time` | instants, increasing | s |
//! | `force` | at each instant, axes of the sensor until they are turned | N |
//! | `moment` | the same for the moment, about the origin of the sensor | N m |

pub mod align;
pub mod drift;
pub mod lag;
pub mod low_pass;
pub mod revolutions;

use nalgebra::{UnitQuaternion, Vector3};

/// What the measured force acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActsOn {
    /// The tool: the sign of the loads in armill.
    Tool,
    /// The workpiece: the sign of a dynamometer under it.
    Part,
}

/// A force over time: at least two instants, all lists of one length, numbers that are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    time: Vec<f64>,
    force: Vec<Vector3<f64>>,
    moment: Option<Vec<Vector3<f64>>>,
    acts_on: ActsOn,
}

/// Why a record is not valid, or cannot be treated as requested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordError {
    /// Too few instants: a record needs two, the search for air cuts needs more.
    #[error("a record of {count} instants is too short: at least {least} are needed")]
    TooShort {
        /// Number given.
        count: usize,
        /// Number needed.
        least: usize,
    },
    /// Lists of different lengths.
    #[error("{time} instants but {force} forces or moments")]
    Lengths {
        /// Instants.
        time: usize,
        /// Forces, or moments if these differ.
        force: usize,
    },
    /// A number that is not finite.
    #[error("sample {0} contains a number that is not finite")]
    NotFinite(usize),
    /// Time that does not increase.
    #[error("time does not increase at sample {0}")]
    TimeNotIncreasing(usize),
    /// Steps of different length where equal ones are needed.
    #[error(
        "the step before sample {sample} is {step_s} s, but the mean step is {mean_s} s: equal steps are needed"
    )]
    UnequalSteps {
        /// The sample.
        sample: usize,
        /// The step before it, s.
        step_s: f64,
        /// The mean step, s.
        mean_s: f64,
    },
    /// Two records whose steps differ.
    #[error(
        "the measured steps are {measured_s} s, the predicted ones {predicted_s} s: equal ones are needed"
    )]
    OtherSteps {
        /// s
        measured_s: f64,
        /// s
        predicted_s: f64,
    },
    /// The given air cuts contain too few samples of the record.
    #[error("the given air cuts contain {0} samples: a line needs at least 2 at different times")]
    NoSamplesOfAirCut(usize),
    /// No stretch that is quiet enough to be air cut.
    #[error(
        "no stretch is quiet enough to be air cut: the quietest scatters by {quietest_n} N, half of all by {median_n} N"
    )]
    NoQuietStretch {
        /// Scatter of the quietest stretch, N.
        quietest_n: f64,
        /// Median scatter, N.
        median_n: f64,
    },
    /// A cutoff that is not valid at this sampling rate.
    #[error("a cutoff of {cutoff_hz} Hz is not above 0 and below half the sampling rate, {half_rate_hz} Hz")]
    Cutoff {
        /// Hz
        cutoff_hz: f64,
        /// Hz
        half_rate_hz: f64,
    },
    /// A spindle speed that the record cannot resolve.
    #[error("a revolution has {samples:.1} samples: at least {least} and a whole revolution are needed")]
    Revolution {
        /// Samples in one revolution.
        samples: f64,
        /// Number needed.
        least: usize,
    },
    /// The lag cannot be determined: no force crosses the threshold, or one of the two is constant.
    #[error("the lag cannot be determined: {0}")]
    NoLag(&'static str),
    /// More instants than the maximum.
    #[error("a record of {count:.1e} instants exceeds the maximum of {most:.0e}: increase the time step")]
    TooManySamples {
        /// As requested.
        count: f64,
        /// Maximum.
        most: f64,
    },
    /// A search that takes too long.
    #[error(
        "the search needs {products:.1e} products, the maximum is {most:.0e}: shorten the records or the range of lags"
    )]
    TooMuchWork {
        /// Products that the search needs.
        products: f64,
        /// Maximum.
        most: f64,
    },
}

/// A step may differ by this part of the mean step: time columns are rounded to a few digits.
const STEP_SLACK: f64 = 0.1;

impl Record {
    /// The record of these instants (s), forces (N) and moments (N m).
    ///
    /// # Errors
    /// Less than two instants, lists of other lengths, numbers that are not finite, time that does not go on.
    pub fn new(
        time: Vec<f64>,
        force: Vec<Vector3<f64>>,
        moment: Option<Vec<Vector3<f64>>>,
        acts_on: ActsOn,
    ) -> Result<Record, RecordError> {
        let count = time.len();
        if count < 2 {
            return Err(RecordError::TooShort { count, least: 2 });
        }
        let other = std::iter::once(&force)
            .chain(&moment)
            .map(Vec::len)
            .find(|length| *length != count);
        if let Some(other) = other {
            return Err(RecordError::Lengths {
                time: count,
                force: other,
            });
        }
        let finite = |vectors: &Vec<Vector3<f64>>, k: usize| vectors[k].iter().all(|value| value.is_finite());
        let broken =
            |k: &usize| !time[*k].is_finite() || !finite(&force, *k) || !moment.iter().all(|m| finite(m, *k));
        if let Some(sample) = (0..count).find(broken) {
            return Err(RecordError::NotFinite(sample));
        }
        if let Some(before) = time.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(RecordError::TimeNotIncreasing(before + 1));
        }
        Ok(Record {
            time,
            force,
            moment,
            acts_on,
        })
    }

    /// Instants, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Force at each instant, N.
    pub fn force(&self) -> &[Vector3<f64>] {
        &self.force
    }

    /// Moment at each instant, N m.
    pub fn moment(&self) -> Option<&[Vector3<f64>]> {
        self.moment.as_deref()
    }

    /// The force at an instant, linear between samples and constant before the first and after the last.
    pub fn force_at(&self, time: f64) -> Vector3<f64> {
        let last = self.time.len() - 1;
        let after = self.time.partition_point(|t| *t <= time);
        let Some(before) = after.checked_sub(1).filter(|_| after <= last) else {
            return self.force[after.min(last)];
        };
        let part = (time - self.time[before]) / (self.time[after] - self.time[before]);
        self.force[before] + (self.force[after] - self.force[before]) * part
    }

    /// The first instant, s.
    pub fn begin(&self) -> f64 {
        self.time[0]
    }

    /// The last instant, s.
    pub fn end(&self) -> f64 {
        self.time[self.time.len() - 1]
    }

    /// What the force acts on.
    pub fn acts_on(&self) -> ActsOn {
        self.acts_on
    }

    /// The record with the sign of the force on the tool: opposite to that on the part.
    #[must_use]
    pub fn on_tool(self) -> Record {
        let acts_on = self.acts_on;
        let turned = match acts_on {
            ActsOn::Tool => self,
            ActsOn::Part => self.mapped(|vector| -vector),
        };
        Record {
            acts_on: ActsOn::Tool,
            ..turned
        }
    }

    /// The record in other axes: `turn` takes the axes of the sensor into them.
    #[must_use]
    pub fn turned(self, turn: &UnitQuaternion<f64>) -> Record {
        self.mapped(|vector| turn * vector)
    }

    /// Mean step, s, where all are equal but for rounding.
    ///
    /// # Errors
    /// A step that differs from the mean by more than a tenth.
    pub fn step(&self) -> Result<f64, RecordError> {
        let (first, last) = (self.time[0], self.time[self.time.len() - 1]);
        let mean = (last - first) / (self.time.len() - 1) as f64;
        let uneven = self
            .time
            .windows(2)
            .position(|pair| (pair[1] - pair[0] - mean).abs() > STEP_SLACK * mean);
        match uneven {
            None => Ok(mean),
            Some(before) => Err(RecordError::UnequalSteps {
                sample: before + 1,
                step_s: self.time[before + 1] - self.time[before],
                mean_s: mean,
            }),
        }
    }

    /// All forces and moments through `change`, which keeps them finite.
    fn mapped(mut self, change: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Record {
        for vector in self.force.iter_mut().chain(self.moment.iter_mut().flatten()) {
            *vector = change(*vector);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(time: &[f64]) -> Result<Record, RecordError> {
        let force = vec![Vector3::new(1.0, 2.0, 3.0); time.len()];
        Record::new(time.to_vec(), force, None, ActsOn::Part)
    }

    #[test]
    fn refuses_invalid_records() {
        assert_eq!(plain(&[0.0]), Err(RecordError::TooShort { count: 1, least: 2 }));
        assert_eq!(plain(&[0.0, 1.0, 1.0]), Err(RecordError::TimeNotIncreasing(2)));
        assert_eq!(plain(&[0.0, f64::NAN]), Err(RecordError::NotFinite(1)));
        let two = vec![Vector3::zeros(); 2];
        let short = Record::new(
            vec![0.0, 1.0],
            two.clone(),
            Some(vec![Vector3::zeros()]),
            ActsOn::Tool,
        );
        assert_eq!(short, Err(RecordError::Lengths { time: 2, force: 1 }));
        let endless = vec![Vector3::zeros(), Vector3::new(0.0, f64::INFINITY, 0.0)];
        assert_eq!(
            Record::new(vec![0.0, 1.0], two, Some(endless), ActsOn::Tool),
            Err(RecordError::NotFinite(1))
        );
    }

    #[test]
    fn forces_on_part_and_tool_are_opposite() {
        let on_tool = plain(&[0.0, 1.0]).unwrap().on_tool();
        assert_eq!(on_tool.force()[1], Vector3::new(-1.0, -2.0, -3.0));
        assert_eq!(on_tool.acts_on(), ActsOn::Tool);
        assert_eq!(on_tool.clone().on_tool(), on_tool, "once is enough");
    }

    #[test]
    fn rotated_axes_keep_the_magnitude() {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let turned = plain(&[0.0, 1.0]).unwrap().turned(&turn);
        assert!((turned.force()[0] - Vector3::new(-2.0, 1.0, 3.0)).norm() < 1e-15);
    }

    #[test]
    fn the_force_is_linear_between_samples() {
        let force = [1.0, 3.0, 0.0].map(|x| Vector3::new(x, 0.0, -x));
        let record = Record::new(vec![0.0, 1.0, 3.0], force.to_vec(), None, ActsOn::Tool).unwrap();
        for (time, x) in [
            (-1.0, 1.0),
            (0.0, 1.0),
            (0.5, 2.0),
            (1.0, 3.0),
            (2.0, 1.5),
            (3.0, 0.0),
            (9.0, 0.0),
        ] {
            assert_eq!(record.force_at(time), Vector3::new(x, 0.0, -x), "{time}");
        }
    }

    #[test]
    fn steps_are_equal_within_rounding() {
        assert_eq!(plain(&[0.0, 0.33, 0.67, 1.0]).unwrap().step(), Ok(1.0 / 3.0));
        let uneven = plain(&[0.0, 0.1, 0.2, 0.5]).unwrap().step();
        assert!(
            matches!(uneven, Err(RecordError::UnequalSteps { sample: 1, .. })),
            "{uneven:?}"
        );
    }

    #[test]
    fn every_message_states_what_is_wrong_with_the_record() {
        let given = [
            (
                RecordError::TooShort { count: 1, least: 2 },
                "a record of 1 instants is too short: at least 2 are needed",
            ),
            (
                RecordError::Lengths { time: 3, force: 2 },
                "3 instants but 2 forces or moments",
            ),
            (
                RecordError::NotFinite(7),
                "sample 7 contains a number that is not finite",
            ),
            (
                RecordError::TimeNotIncreasing(4),
                "time does not increase at sample 4",
            ),
            (
                RecordError::NoLag("a force never crosses the threshold"),
                "the lag cannot be determined: a force never crosses the threshold",
            ),
            (
                RecordError::TooMuchWork {
                    products: 3.2e10,
                    most: 2e9,
                },
                "the search needs 3.2e10 products, the maximum is 2e9: shorten the records or the range of lags",
            ),
            (
                RecordError::Revolution {
                    samples: 4.25,
                    least: 8,
                },
                "a revolution has 4.2 samples: at least 8 and a whole revolution are needed",
            ),
        ];
        for (error, text) in given {
            assert_eq!(error.to_string(), text);
        }
    }

    #[test]
    fn rotation_and_its_inverse_restore_forces_and_moments() {
        let vectors = |size: f64| vec![Vector3::new(size, -2.0, 0.3), Vector3::new(4.0, size, -1.0)];
        let record = Record::new(vec![0.5, 1.0], vectors(3.0), Some(vectors(7.0)), ActsOn::Part).unwrap();
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.8, 2.0));
        let there = record.clone().turned(&turn);
        assert!((there.moment().unwrap()[1] - turn * vectors(7.0)[1]).norm() < 1e-15);
        let back = there.turned(&turn.inverse());
        for (one, other) in record.force().iter().zip(back.force()) {
            assert!((one - other).norm() < 1e-14);
        }
        assert_eq!((back.time(), back.acts_on()), (record.time(), ActsOn::Part));
        assert_eq!((back.begin(), back.end()), (0.5, 1.0));
        let on_tool = record.on_tool();
        assert_eq!(on_tool.moment().unwrap()[0], -vectors(7.0)[0]);
    }
}
