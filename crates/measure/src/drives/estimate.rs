//! An estimate in the units of the result.

use armill_core::torsion::Estimate;
use schemars::JsonSchema;
use serde::Serialize;

/// An estimate; found if it is at least three standard uncertainties from 0.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct EstimateAnswer {
    /// Estimated value.
    // unit: that of the name of its field
    pub value: f64,
    /// Standard uncertainty.
    // unit: that of the name of its field
    pub u: f64,
    /// At least three standard uncertainties from 0.
    pub found: bool,
}

impl EstimateAnswer {
    /// An estimate in other units.
    pub(super) fn of(estimate: Estimate, convert: impl Fn(f64) -> f64) -> EstimateAnswer {
        EstimateAnswer {
            value: convert(estimate.value),
            u: convert(estimate.u),
            found: estimate.is_found(),
        }
    }
}

/// Pairs of values that cannot be distinguished, with their correlation.
pub(super) fn pairs_text<Name: std::fmt::Display>(pairs: &[(Name, Name, f64)]) -> Vec<String> {
    pairs
        .iter()
        .map(|(one, other, correlation)| format!("{one} and {other} (correlation {correlation:.2})"))
        .collect()
}
