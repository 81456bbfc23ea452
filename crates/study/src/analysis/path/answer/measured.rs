//! Measured forces in the answer: the record, its treatment, and the start of the program in it.

use armill_core::load::record::drift::Drift;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::MeasuredForces;
use crate::analysis::path::measured::{ActsOnName, SynchroniseName};
use crate::measured::treatment::Air;

/// The record of the forces.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeasuredAnswer {
    /// Its file, as named in the study.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// What its forces act on: `tool` or `part`.
    pub acts_on: &'static str,
    /// Axes of the sensor.
    pub frame: &'static str,
    /// Rotation of the sensor about z of them.
    pub sensor_turned_deg: f64,
    /// First and last instant of the record.
    pub record_s: [f64; 2],
    /// Time in the record at which the first cut of the program starts.
    pub start_s: f64,
    /// Time in the record at which the last cut ends.
    pub end_s: f64,
    /// How the start was determined: `given`, `threshold` or `predicted`.
    pub synchronised: &'static str,
    /// Correlation with the prediction there, at most 1; none without prediction.
    // unit: 1
    pub likeness: Option<f64>,
    /// From 0 to 1: by how much that correlation exceeds the second best.
    pub confidence: Option<f64>,
    /// The drift that was removed, on the tool, in the axes of `frame`; none if drift removal is off.
    pub drift: Option<DriftAnswer>,
    /// Cut-off of the low-pass filter.
    pub low_pass_hz: Option<f64>,
    /// Spindle speed that defines the revolutions.
    pub spindle_rpm: Option<f64>,
    /// Samples between start and end of the program.
    pub samples_used: usize,
    /// Largest force along the program.
    pub largest_n: f64,
    /// Largest force within a revolution, if that is a load case.
    pub largest_peak_n: Option<f64>,
}

/// The drift removed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DriftAnswer {
    /// Of the force at the first instant.
    pub offset_n: [f64; 3],
    /// Its growth.
    pub rate_n_per_s: [f64; 3],
    /// Intervals without cutting.
    pub air_s: Vec<[f64; 2]>,
    /// Whether these were detected, not given.
    pub air_found: bool,
    /// Samples in them.
    pub samples: usize,
}

impl DriftAnswer {
    /// The drift removed, and whether `air` was detected.
    pub fn of(drift: &Drift, air: &Air) -> DriftAnswer {
        DriftAnswer {
            offset_n: drift.offset.into(),
            rate_n_per_s: drift.rate.into(),
            air_s: drift.through.clone(),
            air_found: *air == Air::Detected,
            samples: drift.samples,
        }
    }
}

impl MeasuredAnswer {
    /// The record as named and treated in the robot, and the interval of it that the program uses.
    pub fn of(measured: &MeasuredForces) -> MeasuredAnswer {
        let (table, treated) = (&measured.table, &measured.treated);
        MeasuredAnswer {
            file: table.file.clone(),
            format: measured.format,
            acts_on: match table.acts_on {
                ActsOnName::Tool => "tool",
                ActsOnName::Part => "part",
            },
            frame: table.frame.word(),
            sensor_turned_deg: table.sensor_turned_deg.unwrap_or(0.0),
            record_s: [treated.before.begin(), treated.before.end()],
            start_s: measured.program[0],
            end_s: measured.program[1],
            synchronised: match table.synchronise {
                None => "given",
                Some(SynchroniseName::Threshold) => "threshold",
                Some(SynchroniseName::Predicted) => "predicted",
            },
            likeness: measured.lag.map(|lag| lag.likeness),
            confidence: measured.lag.map(|lag| lag.confidence()),
            drift: treated
                .drift
                .as_ref()
                .map(|drift| DriftAnswer::of(drift, &measured.air)),
            low_pass_hz: table.low_pass_hz,
            spindle_rpm: table.spindle_rpm,
            samples_used: measured.samples(),
            largest_n: measured.largest[0],
            largest_peak_n: table.peak.then_some(measured.largest[1]),
        }
    }
}

/// Notes on the forces for the user, in sentences.
pub fn notes(measured: &MeasuredForces) -> Vec<String> {
    let mut notes = vec![format!(
        "forces are those of {}, from {:.4} to {:.4} s: {} samples",
        measured.table.file,
        measured.program[0],
        measured.program[1],
        measured.samples()
    )];
    let drift = measured.treated.drift.as_ref().map(|drift| {
        let through = drift
            .through
            .iter()
            .map(|[from, to]| format!("{from:.3} to {to:.3} s"));
        let how = match measured.air {
            Air::Detected => "the quietest intervals",
            _ => "the air cuts",
        };
        format!(
            "drift of the sensor was removed with {how}: {}",
            through.collect::<Vec<_>>().join(", ")
        )
    });
    notes.push(drift.unwrap_or_else(|| "drift of the sensor was not removed".to_owned()));
    if measured.treated.before.moment().is_some() {
        notes.push("measured moments are neglected: they refer to the origin of the sensor".to_owned());
    }
    notes
}
