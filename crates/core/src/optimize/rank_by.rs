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
//! | `c` | compliances of the joints | rad/(N m), m/N |
//! | `l_k` | column k of the Cholesky factor of their covariance; for independent ones the standard uncertainty of joint k | as `c` |
//! | `u_F` | relative standard uncertainty of the load | 1 |
//!
//! The propagation is that of JCGM 100:2008, 5.1.3 note 2, with differences instead of derivatives. Compliances other
//! than those of the joints, components of the force and the length of the tool are not included.

use crate::robot::JointCompliance;
use crate::source::Arm;

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

/// Compliances of the arm, each changed by one standard uncertainty along one direction of the covariance; none where
/// all uncertainties are zero.
pub(super) fn one_off(arm: &Arm<'_>) -> Vec<Vec<JointCompliance>> {
    let joints = arm.compliance.len();
    let drives = arm.robot.structure().covariance.as_ref();
    let factor = drives.and_then(|all| all.view((0, 0), (joints, joints)).into_owned().cholesky());
    let column = |k: usize| -> Vec<f64> {
        match &factor {
            Some(factor) => factor.l().column(k).iter().copied().collect(),
            None => {
                let own = |i: usize| {
                    if i == k {
                        arm.compliance[i].standard_uncertainty
                    } else {
                        0.0
                    }
                };
                (0..joints).map(own).collect()
            }
        }
    };
    let off = |column: Vec<f64>| {
        let each = arm.compliance.iter().zip(column);
        each.map(|(joint, by)| JointCompliance {
            value: joint.value + by,
            ..*joint
        })
        .collect()
    };
    let columns = (0..joints).map(column);
    columns
        .filter(|column| column.iter().any(|by| *by != 0.0))
        .map(off)
        .collect()
}
