//! Measured forces in the answer: which record, what was taken off, and when the program begins in it.

use schemars::JsonSchema;
use serde::Serialize;

use crate::file::path::MeasuredForces;
use crate::file::path::measured::{ActsOnName, SynchroniseName};
use crate::forces::DriftAnswer;

/// The record that forces come from.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeasuredAnswer {
    /// Its file, as the study calls it.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// What its numbers act on: `tool` or `part`.
    pub acts_on: &'static str,
    /// Axes that the sensor stands along.
    pub frame: &'static str,
    /// By what angle it is turned about z of them.
    pub sensor_turned_deg: f64,
    /// First and last instant of the record.
    pub record_s: [f64; 2],
    /// Time in the record at which the first cut of the program begins.
    pub start_s: f64,
    /// Time in the record at which the last cut ends.
    pub end_s: f64,
    /// How the begin was found: `told`, `threshold` or `predicted`.
    pub synchronised: &'static str,
    /// How like the prediction the record is there, to 1; none without prediction.
    // unit: 1
    pub likeness: Option<f64>,
    /// From 0 to 1: how far that likeness stands out from the second best.
    pub confidence: Option<f64>,
    /// What was taken off, on the tool, in the axes of `frame`; none where the drift was to stay.
    pub drift: Option<DriftAnswer>,
    /// Slower than this was kept.
    pub low_pass_hz: Option<f64>,
    /// Speed of the spindle that turns were counted by.
    pub spindle_rpm: Option<f64>,
    /// Samples between begin and end of the program.
    pub samples_used: usize,
    /// Largest force along the program.
    pub largest_n: f64,
    /// Largest force within a turn, where that is a load case.
    pub largest_peak_n: Option<f64>,
}

impl MeasuredAnswer {
    /// The record as the study names and treats it, and the stretch of it that the program takes.
    pub(super) fn of(measured: &MeasuredForces) -> MeasuredAnswer {
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
                None => "told",
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

/// What a user should know of the forces, in sentences.
pub(super) fn notes(measured: &MeasuredForces) -> Vec<String> {
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
            crate::forces::Air::Found => "the quietest stretches",
            _ => "the air cuts",
        };
        format!(
            "drift of the sensor was taken off through {how}: {}",
            through.collect::<Vec<_>>().join(", ")
        )
    });
    notes.push(drift.unwrap_or_else(|| "drift of the sensor was left in".to_owned()));
    if measured.treated.before.moment().is_some() {
        notes.push("measured moments are left out: they count from the origin of the sensor".to_owned());
    }
    notes
}
