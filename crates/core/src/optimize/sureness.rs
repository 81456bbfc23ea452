//! How sure is a cost? Its standard uncertainty, from arms that are one standard uncertainty off.
//!
//! ```text
//! u^2 = sum_k (J(c + l_k) - J(c))^2 + (J u_F)^2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J` | cost of a place in its branch | m |
//! | `c` | compliances of the joints | rad/(N m), m/N |
//! | `l_k` | column k of the Cholesky factor of their covariance; of independent ones the standard uncertainty of joint k | as `c` |
//! | `u_F` | relative standard uncertainty of the load | 1 |
//!
//! The propagation is that of JCGM 100:2008, 5.1.3 note 2: with differences in place of derivatives. Springs beside the joints,
//! components of the force and the length of the tool are not in it.

use crate::robot::JointCompliance;
use crate::source::Arm;

/// What a place is compared by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RankBy {
    /// Its cost, as if all were known.
    Nominal,
    /// Its cost and two standard uncertainties.
    PlusTwoSigma,
    /// How probably its cost is within this limit (m), told as standard uncertainties that it is above it, below zero inside.
    WithinLimit(f64),
}

impl RankBy {
    /// What a place is compared by that costs `cost` (m) with this standard uncertainty (m).
    pub(super) fn compared(self, cost: f64, uncertainty: f64) -> f64 {
        match self {
            RankBy::Nominal => cost,
            RankBy::PlusTwoSigma => cost + 2.0 * uncertainty,
            // What is quite sure is as far from the limit as it is near in nanometres: its sign and order count.
            RankBy::WithinLimit(limit) => (cost - limit) / uncertainty.max(SURE),
        }
    }
}

/// A smaller uncertainty counts as this, m.
const SURE: f64 = 1e-9;

/// Compliances of the arm, each set one standard uncertainty off along one direction of the covariance; none where all are
/// sure.
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
