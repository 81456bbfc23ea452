//! What is in a record, in numbers: before and after it was treated.
//!
//! Forces are in N along the axes of the sensor, times are those of the record. The size of a force
//! is taken sample by sample, so its mean is not that of the components.

use armill_core::load::Record;
use armill_core::nalgebra::Vector3;
use armill_study::analysis::path::answer::measured::DriftAnswer;
use armill_study::measured::force_record::SensorRecord;
use armill_study::measured::treatment::{ProcessedRecord, Treatment};
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_check;

/// A record in numbers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ForcesAnswer {
    /// Its file.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// Which cycle of how many.
    pub cycle_of: [usize; 2],
    /// Samples of each channel.
    pub samples: usize,
    /// The first instant.
    pub start_s: f64,
    /// From the first instant to the last.
    pub duration_s: f64,
    /// Mean sampling rate.
    pub rate_hz: f64,
    /// Channels that were read.
    pub channels: Vec<&'static str>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// The drift removed; none if it was not removed.
    pub drift: Option<DriftAnswer>,
    /// Slower than this was kept.
    pub low_pass_hz: Option<f64>,
    /// Spindle speed for the revolutions.
    pub spindle_rpm: Option<f64>,
    /// As it was measured.
    pub before: SummaryAnswer,
    /// As it was treated.
    pub after: SummaryAnswer,
    /// What is implausible in the record, each a sentence.
    pub warnings: Vec<String>,
    /// Turns of the spindle.
    pub revolutions: Option<RevolutionsAnswer>,
}

/// Each component of a force, and its size.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SummaryAnswer {
    /// Along x of the sensor.
    pub fx_n: RangeAnswer,
    /// Along y.
    pub fy_n: RangeAnswer,
    /// Along z.
    pub fz_n: RangeAnswer,
    /// Size of all three together.
    pub size_n: RangeAnswer,
}

/// Mean and extremes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RangeAnswer {
    /// Over all samples.
    // unit: that of the name of its field
    pub mean: f64,
    /// The least.
    // unit: that of the name of its field
    pub least: f64,
    /// The greatest.
    // unit: that of the name of its field
    pub greatest: f64,
}

/// Turns of the spindle.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RevolutionsAnswer {
    /// Whole ones.
    pub count: usize,
    /// Largest mean force of one.
    pub largest_mean_n: f64,
    /// Largest force in one.
    pub largest_n: f64,
}

impl SummaryAnswer {
    /// Over all samples of the record.
    fn of(record: &Record) -> SummaryAnswer {
        let axis = |axis: usize| RangeAnswer::of(record, |force| force[axis]);
        SummaryAnswer {
            fx_n: axis(0),
            fy_n: axis(1),
            fz_n: axis(2),
            size_n: RangeAnswer::of(record, Vector3::norm),
        }
    }
}

impl RangeAnswer {
    /// Of one number a sample.
    fn of(record: &Record, value: impl Fn(&Vector3<f64>) -> f64) -> RangeAnswer {
        let (mut sum, mut least, mut greatest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for force in record.force() {
            let value = value(force);
            sum += value;
            (least, greatest) = (value.min(least), value.max(greatest));
        }
        RangeAnswer {
            mean: sum / record.force().len() as f64,
            least,
            greatest,
        }
    }
}

/// The record of `file` in numbers.
pub fn answer(
    file: &str,
    measured: &SensorRecord,
    treatment: &Treatment,
    treated: &ProcessedRecord,
) -> ForcesAnswer {
    let record = &treated.before;
    let (samples, duration_s) = (record.time().len(), record.end() - record.begin());
    let mut channels = vec!["fx", "fy", "fz"];
    if record.moment().is_some() {
        channels.extend(["mx", "my", "mz"]);
    }
    let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
    ForcesAnswer {
        file: file.to_owned(),
        format: measured.format,
        cycle_of: measured.cycle,
        samples,
        start_s: record.begin(),
        duration_s,
        rate_hz: (samples - 1) as f64 / duration_s,
        channels,
        unused: measured.unused.clone(),
        drift: treated
            .drift
            .as_ref()
            .map(|drift| DriftAnswer::of(drift, &treatment.air)),
        low_pass_hz: treatment.low_pass_hz,
        spindle_rpm: treatment.spindle_rpm,
        warnings: data_check::force_records::warnings(record),
        before: SummaryAnswer::of(record),
        after: SummaryAnswer::of(&treated.after),
        revolutions: treated.turns.as_ref().map(|turns| RevolutionsAnswer {
            count: turns.len(),
            largest_mean_n: largest(&mut turns.iter().map(|turn| turn.mean.norm())),
            largest_n: largest(&mut turns.iter().map(|turn| turn.strongest.norm())),
        }),
    }
}
