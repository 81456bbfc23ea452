//! One block of points: through lanes, and where there are none or they cannot decide one after the other.
//!
//! A block knows nothing of the blocks beside it, but along a path: whatever thread takes it, it gives the same bits.

use super::answer::{Slot, Slots, Told};
use super::general::General;
use super::lanes::{POINTS, Points};
use super::question::{BranchChoice, Question};
use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};

/// Points in a block: what lanes take at once.
pub(super) const BLOCK: usize = POINTS;

/// Room to answer a question, one a thread.
pub(super) struct Solver<'q> {
    question: &'q Question<'q>,
    /// For ortho-parallel arms whose drives alone move the tool.
    lanes: Option<Points<'q>>,
    general: General<'q>,
    poses: Vec<Isometry>,
    order: Order,
    /// Joint positions of the point before, if there is one.
    before: Option<Vec<f64>>,
}

/// Whether points follow on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Each stands for itself.
    Any,
    /// Each starts where the one before left the arm.
    AlongPath,
}

impl<'q> Solver<'q> {
    /// Room for blocks of this question.
    ///
    /// # Panics
    /// If it has no load case.
    pub fn new(question: &'q Question<'q>, order: Order, given: Told) -> Solver<'q> {
        assert!(!question.cases.is_empty(), "a question has a load case at least");
        let model = question.arm.model;
        let by_load_alone = given == Told::DeviationsAlone || !model.moves_unloaded();
        Solver {
            question,
            order,
            lanes: (model.is_drives_alone() && by_load_alone && question.uncertainty.is_none())
                .then(|| question.arm.robot.ortho_parallel())
                .flatten()
                .map(|arm| Points::new(question, arm)),
            general: General::new(question, given),
            poses: Vec::with_capacity(BLOCK),
            before: None,
        }
    }

    /// Answers at the poses that `base_from_tool` gives for each slot.
    pub fn answer(
        &mut self,
        base_from_tool: impl Fn(usize) -> Isometry,
        mut slots: Slots<'_>,
        watch: Watch<'_>,
    ) -> Result<(), Cancelled> {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let count = slots.points.len();
        self.poses.clear();
        self.poses.extend((0..count).map(base_from_tool));
        if let Some(lanes) = &mut self.lanes {
            lanes.solve(&self.poses);
        }
        // Along a path one posture is followed; the best of all must know all from time to time.
        if self.order == Order::Any || self.question.choice == BranchChoice::Best {
            self.general.forget();
        }
        for i in 0..count {
            let Slot {
                point,
                joints,
                deviations,
                shares,
            } = slots.at(i);
            let in_lanes = self
                .lanes
                .as_ref()
                .and_then(|lanes| Some((lanes, lanes.evaluation(i)?)));
            *point = match in_lanes {
                Some((lanes, evaluation)) => {
                    lanes.write(i, joints, deviations, shares);
                    Ok(evaluation)
                }
                None => self
                    .general
                    .answer(self.question, &self.poses[i], self.before.as_deref())
                    .inspect(|_| self.general.write(joints, deviations, shares)),
            };
            if self.order == Order::AlongPath && point.is_ok() {
                match &mut self.before {
                    Some(before) => before.copy_from_slice(joints),
                    None => self.before = Some(joints.to_vec()),
                }
            }
        }
        (watch.finished)(count);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
