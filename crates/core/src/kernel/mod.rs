//! Many points at once: the same physics as `predict.rs`, over blocks of points.
//!
//! [`evaluate`] is the door. It finds a posture for each tool pose, the deviation of each load case there, the
//! envelope over the cases and what decides it. Ortho-parallel arms with drive springs alone go through [`lanes`], many
//! points in one instruction; where those cannot decide, and for every other model, `general` takes one point after the
//! other. [`evaluate_loaded`] takes a
//! load of its own at every point, [`at_joints`] any chain at joint positions that are known. Blocks run on all
//! threads of the current rayon pool; every point is written by index, so any number of threads gives the same
//! bits.
//!
//! `question` and `answer`: what goes in and comes out; `solver`: a block of points, by lanes and by `general`; `loaded`:
//! points that each have a load of their own.

mod answer;
mod at_joints;
mod general;
// Loops over lanes index many planes at once.
#[allow(clippy::needless_range_loop)]
pub mod lanes;
mod loaded;
mod question;
mod solver;

pub use answer::{AT_LIMIT, Answers, Held};
pub use at_joints::{AtJoints, at_joints};
pub use loaded::evaluate_loaded;
pub use question::{BranchChoice, Question};

use rayon::prelude::*;

use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};
use solver::{BLOCK, Order, Slots, Solver};

/// Answers `question` at `count` tool poses; `base_from_tool(i)` gives the pose of point `i`.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn evaluate(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry + Sync,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::empty(question, count);
    let (joints, cases, shares) = (answers.joint_count, answers.case_count, answers.share_count);
    answers
        .points
        .par_chunks_mut(BLOCK)
        .zip(answers.joints.par_chunks_mut(BLOCK * joints))
        .zip(answers.deviations.par_chunks_mut(BLOCK * cases))
        .zip(answers.shares.par_chunks_mut(BLOCK * shares))
        .enumerate()
        .try_for_each_init(
            || Solver::new(question, Order::Any),
            |solver, (block, (((points, joints), deviations), shares))| {
                let slots = Slots {
                    points,
                    joints,
                    deviations,
                    shares,
                };
                solver.answer(|i| base_from_tool(block * BLOCK + i), slots, watch)
            },
        )?;
    Ok(answers)
}

/// [`evaluate`] along a path: one block after the other, so that joint 4 keeps its place through a wrist
/// singularity.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn evaluate_in_order(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::empty(question, count);
    let (joints, cases, shares) = (answers.joint_count, answers.case_count, answers.share_count);
    let mut solver = Solver::new(question, Order::AlongPath);
    let blocks = answers
        .points
        .chunks_mut(BLOCK)
        .zip(answers.joints.chunks_mut(BLOCK * joints))
        .zip(answers.deviations.chunks_mut(BLOCK * cases))
        .zip(answers.shares.chunks_mut(BLOCK * shares));
    for (block, (((points, joints), deviations), shares)) in blocks.enumerate() {
        let slots = Slots {
            points,
            joints,
            deviations,
            shares,
        };
        solver.answer(|i| base_from_tool(block * BLOCK + i), slots, watch)?;
    }
    Ok(answers)
}
