//! The closed forms: eight branches each, by name.

use super::super::branch::{Branch, BranchPattern};
use super::super::chain::Chain;
use super::super::posture::Singularity;
use super::eight_branches::EightBranches;
use super::ortho_parallel::OrthoParallel;
use super::three_parallel::ThreeParallel;
use crate::frame::Isometry;

/// A geometry with closed-form postures.
#[derive(Clone, Debug)]
pub enum ClosedForm {
    /// Axes 2 and 3 parallel, axes 4 to 6 through one point: most industrial arms.
    OrthoParallel(OrthoParallel),
    /// Axes 2, 3 and 4 parallel: UR and other cobots.
    ThreeParallel(ThreeParallel),
}

/// Greatest deviation (m, rad) of the axes of a calibrated arm from the closed form that names its branches.
pub const CALIBRATED: f64 = 0.01;
/// How far (m) the reach of the calibrated arm may exceed that of the ideal one.
pub(super) const SLACK: f64 = 0.03;

impl ClosedForm {
    /// The closed form of this chain, if it has one.
    pub(super) fn recognise(chain: &Chain) -> Option<ClosedForm> {
        OrthoParallel::recognise(chain)
            .map(ClosedForm::OrthoParallel)
            .or_else(|| ThreeParallel::recognise(chain).map(ClosedForm::ThreeParallel))
    }

    /// The closed form of an ideal arm from which this chain deviates by less than [`CALIBRATED`].
    pub(super) fn next_to(chain: &Chain) -> Option<ClosedForm> {
        OrthoParallel::next_to(chain, CALIBRATED, SLACK)
            .map(ClosedForm::OrthoParallel)
            .or_else(|| ThreeParallel::next_to(chain, CALIBRATED, SLACK).map(ClosedForm::ThreeParallel))
    }

    /// Chain positions of the branches that match `pattern`, modulo whole turns, and the singularity that each is near;
    /// `near` are chain positions, used for the joint that a wrist singularity leaves free.
    pub(super) fn eight_branches(
        &self,
        base_from_flange: &Isometry,
        pattern: BranchPattern,
        near: Option<&[f64; 6]>,
    ) -> EightBranches {
        match self {
            ClosedForm::OrthoParallel(arm) => {
                arm.eight_branches(base_from_flange, near.map(|theta| theta[3]))
            }
            ClosedForm::ThreeParallel(arm) => {
                let kept = near.map(|theta| theta[5]);
                EightBranches::one_by_one(pattern, |branch| {
                    arm.chain_positions(base_from_flange, branch, kept)
                })
            }
        }
    }

    /// Branch of the chain positions `theta`, and the singularity that they are near, if any.
    pub(super) fn name(&self, theta: &[f64]) -> (Branch, Option<Singularity>) {
        match self {
            ClosedForm::OrthoParallel(arm) => arm.name(theta),
            ClosedForm::ThreeParallel(arm) => arm.name(theta),
        }
    }

    /// Whether flip and no-flip have every axis on the same line, and therefore the same compliance.
    pub(super) fn flips_are_alike(&self) -> bool {
        matches!(self, ClosedForm::OrthoParallel(_))
    }
}

#[cfg(test)]
mod tests;
