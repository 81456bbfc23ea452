//! The six joints of a redundant arm with one joint fixed: a spherical wrist, perhaps of an ortho-parallel arm.

use super::super::super::branch::Branch;
use super::super::super::unreachable::Unreachable;
use super::super::fixed_joint::FixedJoint;
use super::super::ortho_parallel::OrthoParallel;
use super::super::spherical_wrist::SphericalWrist;
use crate::frame::Isometry;
use crate::numbers::Eight;

/// Misses (m) of the reach below this are left to the spherical wrist, whose reach includes rounding.
const AT_REACH: f64 = 1e-6;
/// Sines of a bend below this are left to it as well: it decides which joint is free, and which postures are one.
const SINGULAR: f64 = 1e-3;

/// The six joints that remain with one fixed.
#[derive(Debug)]
pub(super) struct SixJoints {
    /// At any pose.
    pub wrist: SphericalWrist,
    ortho_parallel: Option<OrthoParallel>,
}

impl SixJoints {
    /// Those with the fixed joint at the chain position `angle` (rad).
    pub fn of(fixed: &FixedJoint, angle: f64) -> Option<SixJoints> {
        Some(SixJoints {
            wrist: fixed.at(angle)?,
            ortho_parallel: fixed.ortho_parallel_at(angle),
        })
    }

    /// Chain positions of an ortho-parallel arm, and which lanes reach, if none is at a singularity.
    pub fn regular(&self, arm_from_flange: &Isometry) -> Option<([Eight; 6], [bool; 8])> {
        let arm = self.ortho_parallel.as_ref()?;
        let branches = arm.eight_branches(arm_from_flange, None);
        let is_regular = |branch: Branch| match branches.get(branch) {
            Ok((theta, near)) => near.is_none() || arm.nearness(&theta) > SINGULAR,
            Err(
                Unreachable::TooFar { by }
                | Unreachable::TooNear { by }
                | Unreachable::InsideLateralOffset { by },
            ) => by > AT_REACH,
            Err(_) => false,
        };
        let reached = branches.outcomes.map(|outcome| outcome.is_ok());
        Branch::ALL
            .into_iter()
            .all(is_regular)
            .then_some((branches.theta, reached))
    }
}
