//! Data checks: would measurements agree much better with a sign, an order of columns, a zero or a unit changed?
//!
//! `armill robots check` searches such changes for displayed poses; this does it for measurements. Each command tries
//! the changes of its kind one by one and compares the residual with that of the data as given. A change that reduces
//! it far more than chance is named as the likely slip, with both numbers.
//!
//! [`axes`] and [`joints`] are the changes; [`load_tests`], [`poses`], [`circles`] and [`force_records`] try them.
//!
//! ```text
//! slip is likely where   r(change) < b r(as given)      b: BETTER, or that of the kind of measurement
//! ```

pub mod axes;
pub mod circles;
pub mod force_records;
pub mod joints;
pub mod load_tests;
pub mod poses;

use armill_core::units::to_um;
use armill_study::number::micrometres;
use schemars::JsonSchema;
use serde::Serialize;

/// A residual below this fraction of the one as given is not by chance.
pub const BETTER: f64 = 0.5;
/// Changes whose residuals are within this factor of the best explain the data as well.
const EQUAL: f64 = 1.05;
/// Number of changes named that explain the data equally well.
const MOST_NAMED: usize = 3;

/// A change that was tried, with the residual of the data then.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// What was changed: `displacements with z negated`.
    pub change: String,
    /// Residual, m; infinite where nothing fits.
    pub residual: f64,
}

/// The likely slip of measurements.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SlipAnswer {
    /// Changes that explain the data equally well, the simplest first.
    pub changes: Vec<String>,
    /// Residual of the data with the first change.
    pub residual_um: f64,
    /// Residual of the data as given; none if nothing fits.
    pub as_given_um: Option<f64>,
}

impl SlipAnswer {
    /// The slip in a sentence, after the consequence for the numbers.
    pub fn sentence(&self) -> String {
        let as_given = match self.as_given_um {
            Some(um) => format!("in place of {} um", micrometres(um)),
            None => "where nothing fits as given".to_owned(),
        };
        format!(
            "with {} the residual is {} um {as_given}",
            self.changes.join(", or "),
            micrometres(self.residual_um)
        )
    }
}

/// The likely slip among `trials`, in the order of their simplicity, where the data as given have the residual
/// `as_given` (m, infinite where nothing fits); none if no change is better than `better` times it.
pub fn likely_slip(as_given: f64, better: f64, trials: &[Trial]) -> Option<SlipAnswer> {
    let least = trials
        .iter()
        .map(|trial| trial.residual)
        .fold(f64::INFINITY, f64::min);
    // Data without any residual have no slip.
    if !least.is_finite() || least >= better * as_given {
        return None;
    }
    // Rounding of perfect data, a nanometre, does not order changes.
    let equal = (least * EQUAL).max(least + 1e-9);
    let changes = trials.iter().filter(|trial| trial.residual <= equal);
    Some(SlipAnswer {
        changes: changes
            .take(MOST_NAMED)
            .map(|trial| trial.change.clone())
            .collect(),
        residual_um: to_um(least),
        as_given_um: as_given.is_finite().then(|| to_um(as_given)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trials(residuals: &[(&str, f64)]) -> Vec<Trial> {
        let trial = |(change, residual): &(&str, f64)| Trial {
            change: (*change).to_owned(),
            residual: residual * 1e-6,
        };
        residuals.iter().map(trial).collect()
    }

    #[test]
    fn a_much_better_change_is_named_with_both_residuals() {
        let slip = likely_slip(
            480e-6,
            BETTER,
            &trials(&[("x negated", 300.0), ("y negated", 12.0)]),
        );
        assert_eq!(
            slip.unwrap().sentence(),
            "with y negated the residual is 12 um in place of 480 um"
        );
    }

    #[test]
    fn a_little_better_is_chance_and_equally_good_changes_are_all_named() {
        assert_eq!(likely_slip(20e-6, BETTER, &trials(&[("x negated", 11.0)])), None);
        assert_eq!(likely_slip(0.0, BETTER, &trials(&[("x negated", 0.0)])), None);
        assert_eq!(likely_slip(1e-6, BETTER, &trials(&[])), None);
        let both = likely_slip(
            f64::INFINITY,
            BETTER,
            &trials(&[("a", 12.0), ("b", 90.0), ("c", 12.1)]),
        );
        assert_eq!(
            both.unwrap().sentence(),
            "with a, or c the residual is 12 um where nothing fits as given"
        );
    }
}
