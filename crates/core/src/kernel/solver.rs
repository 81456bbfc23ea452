//! One block of points: through lanes, and one after the other where lanes cannot be used or cannot decide.
//!
//! A block does not depend on other blocks, except along a path: every thread gives the same bits.

use nalgebra::Vector3;

use super::answer::{AnswerDetail, Slot, Slots};
use super::general::General;
use super::lanes::{Backend, POINTS, Points, WholeModel};
use super::question::{BranchChoice, Question};
use crate::frame::Isometry;
use crate::watch::{Cancelled, Watch};

/// Points in a block: one call of the lanes.
pub(super) const BLOCK: usize = POINTS;

/// Buffers to answer a question, one per thread.
pub(super) struct Solver<'q> {
    question: &'q Question<'q>,
    /// For ortho-parallel arms whose model lanes support.
    lanes: Option<Points<'q>>,
    general: General<'q>,
    poses: Vec<Isometry>,
    order: Order,
    /// Joint positions of the point before, if there is one.
    before: Option<Vec<f64>>,
}

/// Whether points follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Points are independent.
    Any,
    /// Each point starts from the posture of the point before.
    AlongPath,
}

impl<'q> Solver<'q> {
    /// Buffers for blocks of this question.
    ///
    /// # Panics
    /// If it has no load case.
    pub fn new(question: &'q Question<'q>, order: Order, detail: AnswerDetail) -> Solver<'q> {
        assert!(
            !question.cases.is_empty(),
            "a question needs at least one load case"
        );
        let model = question.arm.model;
        let by_load_alone = detail == AnswerDetail::DeviationsAlone || !model.has_unloaded_deviation();
        Solver {
            question,
            order,
            lanes: question.arm.robot.ortho_parallel().and_then(|arm| {
                if model.is_drives_alone() && by_load_alone && question.uncertainty.is_none() {
                    return Some(Points::new(question, arm, None));
                }
                let supported = detail == AnswerDetail::Shares || by_load_alone;
                let whole = WholeModel::of(&question.arm, Backend::fastest()).filter(|_| supported)?;
                Some(Points::new(question, arm, Some(whole)))
            }),
            general: General::new(question, detail),
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
        // Along a path one posture is followed; the best of all must examine all from time to time.
        if self.order == Order::Any || self.question.choice == BranchChoice::Best {
            self.general.forget();
        }
        let decided = match &self.lanes {
            Some(lanes) => lanes.write(&mut slots),
            None => [false; BLOCK],
        };
        for (i, decided) in decided.into_iter().enumerate().take(count) {
            if decided && self.order == Order::Any {
                continue;
            }
            let Slot {
                point,
                joints,
                deviations,
                shares,
            } = slots.at(i);
            if !decided {
                *point = self
                    .general
                    .answer(self.question, &self.poses[i], self.before.as_deref());
                match point {
                    Ok(_) => self.general.write(joints, deviations, shares),
                    Err(_) => {
                        joints.fill(0.0);
                        deviations.fill(Vector3::zeros());
                        shares.fill(0.0);
                    }
                }
            }
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
