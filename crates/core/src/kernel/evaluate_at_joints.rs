//! An arm stood at many joint positions: whoever asks writes down what he wants of each stand.
//!
//! Blocks of points on all threads of the current rayon pool, with one [`ArmState`] a thread; a single block is done
//! where it is asked for, so that one point costs no more than the work. What is written goes by index.

use rayon::prelude::*;

use crate::source::{Arm, ArmState, Unstable};
use crate::watch::{Cancelled, Watch};

/// Points in a block: enough to make the hand-over cheap, few enough to cancel soon.
const AT_ONCE: usize = 256;

/// Why not every stand was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluateError {
    /// The watch said so.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The first point where the arm finds no stable rest.
    #[error("point {point}: {why}")]
    Unstable {
        /// Which, from 0.
        point: usize,
        /// Why.
        why: Unstable,
    },
}

/// Stands `arm` at each of the joint positions `joints` (rad, m; as many a point as joints, one point after the other) and
/// lets `tell` write `width` numbers of it into its part of `out`, which is as long as all points together.
///
/// # Errors
/// [`EvaluateError::Cancelled`] if the watch says so; the first point where `tell` finds no stable rest.
///
/// # Panics
/// If `joints` is no whole number of points, `out` has another length, or there are not as many compliances as joints.
pub fn evaluate_at_joints(
    arm: &Arm<'_>,
    joints: &[f64],
    (out, width): (&mut [f64], usize),
    tell: impl Fn(&mut ArmState<'_>, &mut [f64]) -> Result<(), Unstable> + Sync,
    watch: Watch<'_>,
) -> Result<(), EvaluateError> {
    let dof = arm.robot.joints().len();
    assert_eq!(
        joints.len() % dof,
        0,
        "joint positions for a whole number of points"
    );
    assert_eq!(arm.compliance.len(), dof, "one compliance a joint");
    assert_eq!(out.len(), joints.len() / dof * width, "room for every point");
    if out.is_empty() {
        return Ok(());
    }
    let block = |arm_state: &mut ArmState<'_>, (joints, out): (&[f64], &mut [f64])| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        for (point, (q, out)) in joints.chunks(dof).zip(out.chunks_mut(width)).enumerate() {
            arm_state.set_joints(q);
            if let Err(why) = tell(arm_state, out) {
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
