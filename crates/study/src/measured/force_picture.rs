//! The picture of a record of forces: each component and the size over time, before and after treatment.

use armill_core::load::Record;
use armill_core::nalgebra::Vector3;
use armill_report::{Envelope, ForcePlot, ForceTrace};

use crate::measured::treatment::ProcessedRecord;

/// The picture of a record.
///
/// If revolutions were averaged, the processed traces are their means.
pub fn plot(title: String, subtitle: String, treated: &ProcessedRecord) -> ForcePlot {
    let before = &treated.before;
    let span_s = [before.begin(), before.end()];
    let envelope = |record: &Record, value: fn(&Vector3<f64>) -> f64| {
        let samples = record.time().iter().zip(record.force());
        Envelope::of(span_s, samples.map(|(time, force)| (*time, value(force))))
    };
    // If revolutions were averaged, their means are used.
    let after = |value: fn(&Vector3<f64>) -> f64| match &treated.turns {
        Some(turns) => {
            let means = turns.iter().map(|turn| (turn.middle, value(&turn.mean)));
            Envelope::of(span_s, means)
        }
        None => envelope(&treated.after, value),
    };
    let trace = |name: &str, value: fn(&Vector3<f64>) -> f64| ForceTrace {
        name: name.to_owned(),
        before: envelope(before, value),
        after: after(value),
    };
    ForcePlot {
        title,
        subtitle,
        traces: vec![
            trace("Fx (N)", |force| force.x),
            trace("Fy (N)", |force| force.y),
            trace("Fz (N)", |force| force.z),
            trace("size (N)", Vector3::norm),
        ],
        air_s: treated
            .drift
            .as_ref()
            .map_or_else(Vec::new, |drift| drift.through.clone()),
        marks_s: Vec::new(),
    }
}
