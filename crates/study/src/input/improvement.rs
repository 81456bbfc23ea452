//! `improvement`: the least gain for which a change is proposed.

use armill_core::optimize::LeastGain;
use armill_core::units::from_um;
use schemars::JsonSchema;
use serde::Deserialize;

/// The least improvement for which a change of posture or placement is proposed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImprovementTable {
    /// Multiple of the standard uncertainty of the difference that the improvement must exceed; 2 if left out.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub coverage_factor: Option<f64>,
    /// Improvement that is required in any case; if left out 1 % of the tolerance, or 5 % of it where the uncertainty is
    /// not known.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub least_um: Option<f64>,
}

/// Part of the tolerance that an improvement must exceed: a smaller one is certain where inputs act on both predictions alike,
/// and yet no reason for a new program.
const LEAST_OF_TOLERANCE: f64 = 0.01;
/// The same where the uncertainty of the improvement is not known.
const LEAST_IF_UNKNOWN: f64 = 0.05;

impl ImprovementTable {
    /// As the core knows it, for this tolerance, m.
    pub fn least_gain(&self, tolerance: f64) -> LeastGain {
        let given = self.least_um.map(from_um);
        LeastGain {
            coverage_factor: self.coverage_factor.unwrap_or(2.0),
            amount: given.unwrap_or(LEAST_OF_TOLERANCE * tolerance),
            amount_if_unknown: given.unwrap_or(LEAST_IF_UNKNOWN * tolerance),
        }
    }
}
