//! Many points at once: the same physics as `predict.rs`, over blocks of points.
//!
//! [`evaluate`] is the main entry. It finds a posture for each tool pose, the deviation under each load case, the
//! envelope over the load cases and the worst case. Arms with named branches, also on a rail, go through [`lanes`], many
//! points in one instruction, with springs, torque curves, masses, compensator, calibrated geometry, thermal growth and
//! backlash. Where the lanes cannot decide, and for what they do not know, `general` computes one point after the
//! other: arms without named branches, or coupled to their rail; a load-dependent equilibrium; a torque curve on the
//! joint of the compensator; torque curves where each point has a separate load.
//! [`evaluate_loaded`] uses a separate load at every point, [`evaluate_posture`] one posture at given joint positions,
//! [`evaluate_at_joints`] any chain at given joint positions with a user-defined output, [`postures_at`] every posture
//! of many poses. Blocks run on all threads of the current rayon pool. Every point is written by index, so any number
//! of threads gives the same bits.
//!
//! `question` and `answer`: input and output; `solver`: a block of points, by lanes and by `general`; `loaded`: points
//! with a load each; `on_path`: what the way along a path adds; `column`: every posture of a few poses under a load; `path_on_part` and `placed`: a path on a part
//! with a variable placement.

mod answer;
mod column;
mod evaluate_at_joints;
mod general;
// Loops over lanes index many planes at once.
#[allow(clippy::needless_range_loop)]
pub mod lanes;
mod loaded;
mod on_path;
mod path_on_part;
mod placed;
mod postures_at;
mod question;
mod solver;

pub use answer::{AT_LIMIT, Answers, Evaluation};
pub use column::{Column, ColumnLoad, Columns, PostureStatus, SLOTS};
pub use evaluate_at_joints::{EvaluateError, evaluate_at_joints};
pub use loaded::evaluate_loaded;
pub use on_path::OnPath;
pub use path_on_part::{PartPlacement, PathWrenches, PlacedPoint, PostureMargins, WrenchAxes};
pub use placed::{
    PathTotals, PlacedBranch, PlacedPath, PlacementClearance, PlacementEvaluator, PlacementScreen,
};
pub use postures_at::{PosturesAt, postures_at};
pub use question::{BranchChoice, Question};

use rayon::prelude::*;

use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};
use answer::AnswerDetail;
use general::General;
use solver::{BLOCK, Order, Solver};

/// Answers `question` in the posture at `joints`, rad (m), whatever branch it chooses. Backlash, geometry, thermal growth and what `on_path` adds are in
/// deviations, shares and uncertainty.
///
/// # Panics
/// If the question has no load case, or the number of joint positions or link offsets is wrong.
pub fn evaluate_posture(question: &Question<'_>, joints: &[f64], on_path: OnPath<'_>) -> Answers {
    let dof = question.arm.robot.joints().len();
    assert!(
        !question.cases.is_empty(),
        "a question needs at least one load case"
    );
    assert_eq!(joints.len(), dof, "one position per joint");
    let mut general = General::on_path(question, AnswerDetail::Shares, on_path);
    let mut answers = Answers::with_shares(question, 1, general.share_count());
    for mut slots in answers.blocks(1) {
        let slot = slots.at(0);
        *slot.point = general
            .answer_in(question, joints)
            .inspect(|_| general.write(slot.joints, slot.deviations, slot.shares));
    }
    answers
}

/// Answers `question` at `count` tool poses; `base_from_tool(i)` gives the pose of point `i`.
///
/// Backlash and geometry are included. A torque determines the side of the backlash of a joint. Where friction decides,
/// the side is not known at a single pose: the side with the largest in-plane deviation is used.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the question has no load case.
pub fn evaluate(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry + Sync,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    // A single block is computed here: a hand-over to the pool would take longer than a point.
    if count <= BLOCK {
        let mut answers = Answers::new(question, count, AnswerDetail::Shares);
        let mut solver = Solver::new(question, Order::Any, AnswerDetail::Shares);
        for slots in answers.blocks(BLOCK) {
            solver.answer(&base_from_tool, slots, watch)?;
        }
        return Ok(answers);
    }
    let mut answers = Answers::with_capacity(question, count, AnswerDetail::Shares);
    let at_once = AT_ONCE * rayon::current_num_threads();
    for first in (0..count).step_by(at_once) {
        answers.grow(at_once.min(count - first));
        let blocks = answers.blocks_from(first, BLOCK).into_par_iter().enumerate();
        blocks.try_for_each_init(
            || Solver::new(question, Order::Any, AnswerDetail::Shares),
            |solver, (block, slots)| {
                solver.answer(|i| base_from_tool(first + block * BLOCK + i), slots, watch)
            },
        )?;
    }
    Ok(answers)
}

/// Points of each thread that are answered at once: their answers stay in its cache from the first write on.
const AT_ONCE: usize = 100 * BLOCK;

/// [`evaluate`] along a path: one block after the other, so that joint 4 keeps its position through a wrist
/// singularity. Only for arms without backlash and geometry errors: links kept by friction are neglected.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the question has no load case.
pub fn evaluate_in_order(
    question: &Question<'_>,
    count: usize,
    base_from_tool: impl Fn(usize) -> Isometry,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::new(question, count, AnswerDetail::Shares);
    let mut solver = Solver::new(question, Order::AlongPath, AnswerDetail::Shares);
    for (block, slots) in answers.blocks(BLOCK).into_iter().enumerate() {
        solver.answer(|i| base_from_tool(block * BLOCK + i), slots, watch)?;
    }
    Ok(answers)
}

#[cfg(test)]
mod tests;
