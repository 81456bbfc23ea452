//! Ranking of placements, with the standard uncertainty of the cost from arms that are changed by one standard
//! uncertainty.
//!
//! ```text
//! u^2 = sum_k (J(c + l_k) - J(c))^2 + (J u_F)^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J` | cost of a placement in its branch | m |
//! | `c` | compliances of drives and springs | rad/(N m), m/N |
//! | `l_k` | their change by one standard uncertainty of an independent input ([`UncertainInput`]) | as `c` |
//! | `u_F` | relative standard uncertainty of the load | 1 |
//!
//! Components of the force and the length of the tool are not included.

use crate::load::InputUncertainty;
use crate::source::{Arm, ChangedArm, UncertainInput};

/// The criterion that placements are ranked by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RankBy {
    /// The cost with nominal values.
    Nominal,
    /// The cost plus two standard uncertainties.
    PlusTwoSigma,
    /// The probability that the cost is within this tolerance (m), as the number of standard uncertainties above it;
    /// negative inside.
    WithinTolerance(f64),
}

impl RankBy {
    /// The value of the criterion for this cost (m) and its standard uncertainty (m).
    pub(super) fn compared(self, cost: f64, uncertainty: f64) -> f64 {
        match self {
            RankBy::Nominal => cost,
            RankBy::PlusTwoSigma => cost + 2.0 * uncertainty,
            // With a very small uncertainty the value is the distance from the tolerance in nanometres: only sign and
            // order matter.
            RankBy::WithinTolerance(limit) => (cost - limit) / uncertainty.max(SMALLEST),
        }
    }
}

/// Smaller uncertainties are replaced by this, m.
const SMALLEST: f64 = 1e-9;

/// The arm with its compliances changed by one standard uncertainty of each independent input.
pub(super) fn changed_arms(arm: &Arm<'_>) -> Vec<ChangedArm> {
    let inputs = UncertainInput::all(arm, &InputUncertainty::NONE).into_iter();
    inputs
        .filter(|input| matches!(input, UncertainInput::Compliances(_)))
        .map(|input| input.changed(arm))
        .collect()
}
