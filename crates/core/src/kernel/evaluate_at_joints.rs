//! Evaluates an arm at many joint positions; the caller defines the output.
//!
//! Blocks of points on all threads of the current rayon pool, with one [`ArmState`] per thread. A single block is
//! computed on the calling thread, so that one point has no overhead. Results are written by index.

use rayon::prelude::*;

use crate::source::{Arm, ArmState, Unstable};
use crate::watch::{Cancelled, Watch};

/// Points in a block: enough to make the hand-over cheap, few enough to cancel soon.
const AT_ONCE: usize = 256;

/// Why not every point was evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluateError {
    /// Cancelled by the watch.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The first point without a stable equilibrium.
    #[error("point {point}: {why}")]
    Unstable {
        /// Index, from 0.
        point: usize,
        /// Reason.
        why: Unstable,
    },
}

/// Positions `arm` at each of the joint positions `joints` (rad, m; one value per joint, point after point) and lets
/// `write` fill its part of `out`, the same number of values for each point.
///
/// # Errors
/// [`EvaluateError::Cancelled`] if the watch cancels; the first point where `write` finds no stable equilibrium.
///
/// # Panics
/// If `joints` or `out` is not a whole number of points, or the number of compliances differs from
/// that of the joints.
pub fn evaluate_at_joints(
    arm: &Arm<'_>,
    joints: &[f64],
    out: &mut [f64],
    write: impl Fn(&mut ArmState<'_>, &mut [f64]) -> Result<(), Unstable> + Sync,
    watch: Watch<'_>,
) -> Result<(), EvaluateError> {
    let dof = arm.robot.joints().len();
    assert_eq!(
        joints.len() % dof,
        0,
        "joint positions for a whole number of points"
    );
    assert_eq!(arm.compliance.len(), dof, "one compliance per joint");
    let count = joints.len() / dof;
    let width = out.len().checked_div(count).unwrap_or(0);
    assert_eq!(out.len(), count * width, "as much output for each point");
    if out.is_empty() {
        return Ok(());
    }
    let block = |arm_state: &mut ArmState<'_>, (joints, out): (&[f64], &mut [f64])| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        for (point, (q, out)) in joints.chunks(dof).zip(out.chunks_mut(width)).enumerate() {
            arm_state.set_joints(q);
            if let Err(why) = write(arm_state, out) {
                return Ok(Some((point, why)));
            }
        }
        (watch.finished)(joints.len() / dof);
        Ok(None)
    };
    let first_failed = |failed: &[Option<(usize, Unstable)>]| {
        let mut failed = failed.iter().enumerate();
        failed.find_map(|(block, failed)| failed.map(|(point, why)| (block * AT_ONCE + point, why)))
    };
    let failed = if joints.len() <= AT_ONCE * dof {
        first_failed(&[block(&mut ArmState::new(*arm), (joints, out))?])
    } else {
        let blocks = joints
            .par_chunks(AT_ONCE * dof)
            .zip(out.par_chunks_mut(AT_ONCE * width));
        let failed: Result<Vec<_>, Cancelled> = blocks.map_init(|| ArmState::new(*arm), block).collect();
        first_failed(&failed?)
    };
    failed.map_or(Ok(()), |(point, why)| Err(EvaluateError::Unstable { point, why }))
}

#[cfg(test)]
mod tests;
