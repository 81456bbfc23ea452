//! Many points at once: the same physics as `predict.rs`, over blocks of points.
//!
//! [`evaluate`] is the door. It finds a posture for each tool pose, the deviation of each load case there, the
//! envelope over the cases and what decides it. Ortho-parallel arms with drive springs alone go through [`lanes`], many
//! points in one instruction; where those cannot decide, and for every other model, `general` takes one point after the
//! other. [`evaluate_loaded`] takes a load of its own at every point, [`evaluate_on_path`] one point of a path with all that
//! moves the tool beside its load, [`evaluate_at_joints`] any chain at joint positions that are known, for whoever writes down what he
//! wants of it, [`postures_at`] every posture of many poses. Blocks run on all threads of the current rayon pool; every point is written by index, so any number of threads
//! gives the same bits.
//!
//! `question` and `answer`: what goes in and comes out; `solver`: a block of points, by lanes and by `general`; `loaded`:
//! points that each have a load of their own; `column`: every posture of a few poses under a load; `placed`: a path wherever its part lies.

mod answer;
mod column;
mod general;
// Loops over lanes index many planes at once.
#[allow(clippy::needless_range_loop)]
pub mod lanes;
mod loaded;
mod placed;
mod postures_at;
mod question;
mod solver;
mod evaluate_at_joints;

pub use answer::{AT_LIMIT, Answers, Held};
pub use column::{Column, Columns, Push, SLOTS, Stand};
pub use loaded::evaluate_loaded;
pub use placed::{Glance, Judge, Judged, Keeping, PartPlacement, PlacedPath, Pushes, Sighted, ToldIn};
pub use postures_at::{PosturesAt, postures_at};
pub use question::{BranchChoice, Question};
pub use evaluate_at_joints::{EvaluateError, evaluate_at_joints};

use rayon::prelude::*;

use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};
use answer::{Slot, Told};
use general::General;
use solver::{BLOCK, Order, Solver};

/// Answers `question` at one pose of a path, where links were `dragged` to in their gaps, rad (m), one a joint: what moves
/// the tool beside the load is told too, backlash in the shares of its joints, geometry in nobody's.
///
/// # Panics
/// If the question has no load case, or a link is missing.
pub fn evaluate_on_path(question: &Question<'_>, base_from_tool: &Isometry, dragged: &[f64]) -> Answers {
    assert!(!question.cases.is_empty(), "a question has a load case at least");
    assert_eq!(dragged.len(), question.arm.robot.joints().len(), "a link a joint");
    let mut answers = Answers::new(question, 1, Told::Shares);
    let mut general = General::on_path(question, Told::Shares, dragged);
    for mut slots in answers.blocks(1) {
        let Slot {
            point,
            joints,
            deviations,
            shares,
        } = slots.at(0);
        *point = general
            .answer(question, base_from_tool, None)
            .inspect(|_| general.write(joints, deviations, shares));
    }
    answers
}

/// Answers `question` at `count` tool poses; `base_from_tool(i)` gives the pose of point `i`.
///
/// Backlash and geometry count: a torque holds the link of a joint on its flank, or, where friction decides, it lies on the
/// one on which it moves the tool farthest across the normal, for which one it is nobody knows at a pose by itself.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If the question has no load case.
pub fn evaluate(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry + Sync,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::new(question, count, Told::Shares);
    let mut blocks = answers.blocks(BLOCK);
    // One block is done here: a hand-over to the pool would take longer than a point.
    if blocks.len() == 1 {
        let mut solver = Solver::new(question, Order::Any, Told::Shares);
        for slots in blocks.drain(..) {
            solver.answer(&base_from_tool, slots, watch)?;
        }
        drop(blocks);
        return Ok(answers);
    }
    blocks.into_par_iter().enumerate().try_for_each_init(
        || Solver::new(question, Order::Any, Told::Shares),
        |solver, (block, slots)| solver.answer(|i| base_from_tool(block * BLOCK + i), slots, watch),
    )?;
    Ok(answers)
}

/// [`evaluate`] along a path: one block after the other, so that joint 4 keeps its place through a wrist
/// singularity. For arms that nothing moves but load and gravity: where a path drags links is not looked at.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If the question has no load case.
pub fn evaluate_in_order(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::new(question, count, Told::Shares);
    let mut solver = Solver::new(question, Order::AlongPath, Told::Shares);
    for (block, slots) in answers.blocks(BLOCK).into_iter().enumerate() {
        solver.answer(|i| base_from_tool(block * BLOCK + i), slots, watch)?;
    }
    Ok(answers)
}

#[cfg(test)]
mod tests;
