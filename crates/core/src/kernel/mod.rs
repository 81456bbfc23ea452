//! Many points at once: the same physics as `predict.rs`, over blocks of points.
//!
//! [`evaluate`] is the door. It finds a posture for each tool pose, the deviation of each load case there, the
//! envelope over the cases and what decides it. Blocks run on all threads of the current rayon pool; every
//! point is written by index, so any number of threads gives the same bits.

mod answer;
mod question;

pub use answer::{AT_LIMIT, Answers, Held};
pub use question::{BranchChoice, Question};

use rayon::prelude::*;

use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};
use answer::Scratch;

/// Points in a block: enough to make the hand-over cheap, few enough to stay in cache and to cancel soon.
const BLOCK: usize = 256;

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
    let (joints, cases) = (question.robot.joints().len(), question.cases.len());
    answers
        .points
        .par_chunks_mut(BLOCK)
        .zip(answers.joints.par_chunks_mut(BLOCK * joints))
        .zip(answers.deviations.par_chunks_mut(BLOCK * cases))
        .zip(answers.shares.par_chunks_mut(BLOCK * joints))
        .enumerate()
        .try_for_each_init(
            || Scratch::new(question),
            |scratch, (block, (((points, q), deviations), shares))| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                for (i, point) in points.iter_mut().enumerate() {
                    let pose = base_from_tool(block * BLOCK + i);
                    *point = scratch.answer(question, &pose, None).inspect(|_| {
                        scratch.write(
                            &mut q[i * joints..(i + 1) * joints],
                            &mut deviations[i * cases..(i + 1) * cases],
                            &mut shares[i * joints..(i + 1) * joints],
                        );
                    });
                }
                (watch.finished)(points.len());
                Ok(())
            },
        )?;
    Ok(answers)
}

/// [`evaluate`] along a path: one point after the other, so that joint 4 keeps its place through a wrist
/// singularity.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn evaluate_in_order(
    question: &Question<'_>,
    base_from_tool: impl ExactSizeIterator<Item = Isometry>,
    watch: Watch<'_>,
) -> Result<Answers, Cancelled> {
    let mut answers = Answers::empty(question, base_from_tool.len());
    let (joints, cases) = (question.robot.joints().len(), question.cases.len());
    let mut scratch = Scratch::new(question);
    let mut near: Option<Vec<f64>> = None;
    for (i, pose) in base_from_tool.enumerate() {
        if i % BLOCK == 0 && watch.is_cancelled() {
            return Err(Cancelled);
        }
        answers.points[i] = scratch.answer(question, &pose, near.as_deref());
        if answers.points[i].is_ok() {
            let q = &mut answers.joints[i * joints..(i + 1) * joints];
            scratch.write(
                q,
                &mut answers.deviations[i * cases..(i + 1) * cases],
                &mut answers.shares[i * joints..(i + 1) * joints],
            );
            near = Some(q.to_vec());
        }
        (watch.finished)(1);
    }
    Ok(answers)
}
