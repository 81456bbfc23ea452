//! Processing of a record: drift removal, then the low-pass filter; revolutions of the spindle are of the
//! left.

use std::f64::consts::TAU;

use armill_core::load::record::drift::{self, AirCut, Drift};
use armill_core::load::record::low_pass::low_pass;
use armill_core::load::record::revolutions::{Revolution, revolutions};
use armill_core::load::{Record, RecordError};

/// Intervals without cutting, from which the drift is determined.
#[derive(Clone, Debug, PartialEq)]
pub enum Air {
    /// From when to when, s.
    Given(Vec<[f64; 2]>),
    /// The quietest intervals of both halves.
    Detected,
    /// None: the drift is not removed.
    NotRemoved,
}

/// What is done to a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Treatment {
    /// Where drift is seen.
    pub air: Air,
    /// Slower than this is kept.
    pub low_pass_hz: Option<f64>,
    /// Speed of the spindle, for turns.
    pub spindle_rpm: Option<f64>,
}

/// A record before and after.
#[derive(Clone, Debug)]
pub struct ProcessedRecord {
    /// As it was measured.
    pub before: Record,
    /// Without drift, low-passed.
    pub after: Record,
    /// The drift removed.
    pub drift: Option<Drift>,
    /// The complete revolutions of the spindle, after processing.
    pub turns: Option<Vec<Revolution>>,
}

/// An invalid value, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Key of the value in a study; the option of the command has the same name.
    pub key: &'static str,
    /// The quantity, its value, the limit and the unit.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

impl Refusal {
    /// A value that cannot be, by its key.
    pub fn new(key: &'static str, message: impl Into<String>, hint: impl Into<String>) -> Refusal {
        Refusal {
            key,
            message: message.into(),
            hint: hint.into(),
        }
    }
}

/// What becomes of `record`.
///
/// # Errors
/// Air cuts that are none, a cutoff or spindle speed that the record cannot show.
pub fn treat(record: Record, treatment: &Treatment) -> Result<ProcessedRecord, Refusal> {
    let (without_drift, drift) = match without_drift(&record, &treatment.air)? {
        Some((freed, drift)) => (Some(freed), Some(drift)),
        None => (None, None),
    };
    let smooth = treatment.low_pass_hz.map(|cutoff_hz| {
        low_pass(without_drift.as_ref().unwrap_or(&record), cutoff_hz)
            .map_err(|error| Refusal::new("low_pass_hz", error.to_string(), "below half the sampling rate"))
    });
    let after = match smooth.transpose()? {
        Some(smooth) => smooth,
        None => without_drift.unwrap_or_else(|| record.clone()),
    };
    let turns = treatment.spindle_rpm.map(|rpm| {
        revolutions(&after, rpm * TAU / 60.0).map_err(|error| {
            Refusal::new(
                "spindle_rpm",
                format!("{rpm} rpm: {error}"),
                "the speed of the spindle as it was, or leave it out",
            )
        })
    });
    Ok(ProcessedRecord {
        turns: turns.transpose()?,
        before: record,
        after,
        drift,
    })
}

/// The record without its drift, and the drift; `None` if it is not removed.
fn without_drift(record: &Record, air: &Air) -> Result<Option<(Record, Drift)>, Refusal> {
    let found = match air {
        Air::NotRemoved => return Ok(None),
        Air::Detected => drift::remove(record, AirCut::Found),
        Air::Given(stretches) => {
            if let Some([from, to]) = stretches.iter().find(|[from, to]| from.is_nan() || from >= to) {
                let message = format!("an air cut from {from} to {to} s has no length");
                return Err(Refusal::new("air_s", message, "its begin, then its end"));
            }
            drift::remove(record, AirCut::Given(stretches))
        }
    };
    let within = format!("the record is from {} to {} s", record.begin(), record.end());
    found.map(Some).map_err(|error| match error {
        RecordError::NoSamplesOfAirCut(_) => Refusal::new("air_s", error.to_string(), within),
        error => Refusal::new(
            "air_s",
            error.to_string(),
            "give an interval without cutting, or do not remove the drift",
        ),
    })
}

#[cfg(test)]
mod tests {
    use armill_core::load::ActsOn;
    use armill_core::nalgebra::Vector3;

    use super::*;

    /// 50 N for a second between half seconds without force, all 3 N too high.
    fn record() -> Record {
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        let cut = |t: &f64| if (0.5..1.5).contains(t) { 50.0 } else { 0.0 };
        let force = time
            .iter()
            .map(|t| Vector3::new(3.0 + cut(t), 0.0, 0.0))
            .collect();
        Record::new(time, force, None, ActsOn::Tool).unwrap()
    }

    fn treatment(air: Air) -> Treatment {
        Treatment {
            air,
            low_pass_hz: None,
            spindle_rpm: None,
        }
    }

    #[test]
    fn drift_is_removed_with_given_intervals_and_kept_on_request() {
        let given = treat(record(), &treatment(Air::Given(vec![[0.0, 0.4], [1.6, 2.0]]))).unwrap();
        assert!((given.after.force_at(1.0).x - 50.0).abs() < 1e-9);
        assert_eq!(given.before, record());
        assert!((given.drift.unwrap().offset.x - 3.0).abs() < 1e-9);
        let kept = treat(record(), &treatment(Air::NotRemoved)).unwrap();
        assert_eq!((kept.after, kept.drift), (record(), None));
    }

    #[test]
    fn revolutions_are_of_the_processed_record() {
        let requested = Treatment {
            spindle_rpm: Some(600.0),
            ..treatment(Air::Given(vec![[0.0, 0.4]]))
        };
        let turns = treat(record(), &requested).unwrap().turns.unwrap();
        assert_eq!(turns.len(), 19);
        assert!((turns[10].mean.x - 50.0).abs() < 1e-9);
    }

    #[test]
    fn refuses_invalid_values_under_their_keys() {
        let base = treatment(Air::NotRemoved);
        for (requested, key, word) in [
            (treatment(Air::Given(vec![[5.0, 6.0]])), "air_s", "0 samples"),
            (treatment(Air::Given(vec![[1.0, 1.0]])), "air_s", "no length"),
            (treatment(Air::Given(vec![[0.0, f64::NAN]])), "air_s", "0 samples"),
            (
                Treatment {
                    low_pass_hz: Some(500.0),
                    ..base.clone()
                },
                "low_pass_hz",
                "500 Hz",
            ),
            (
                Treatment {
                    spindle_rpm: Some(60_000.0),
                    ..base.clone()
                },
                "spindle_rpm",
                "60000 rpm",
            ),
        ] {
            let refused = treat(record(), &requested).unwrap_err();
            assert!(
                refused.key == key && refused.message.contains(word),
                "{refused:?}"
            );
        }
    }
}
