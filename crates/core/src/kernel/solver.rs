//! One block of points: through lanes, and one after the other where lanes cannot be used or cannot decide.
//!
//! A block does not depend on other blocks, except along a path: every thread gives the same bits.

use nalgebra::Vector3;

use super::answer::{AnswerDetail, Evaluation, Slot, Slots};
use super::general::General;
use super::lanes::{POINTS, Points, WholePoints};
use super::question::{BranchChoice, Question};
use crate::frame::Isometry;
use crate::robot::inverse::WholeTurns;
use crate::robot::{Branch, Robot};
use crate::watch::{Cancelled, Watch};

/// Points in a block: one call of the lanes.
pub(super) const BLOCK: usize = POINTS;

/// Buffers to answer a question, one per thread.
pub(super) struct Solver<'q> {
    question: &'q Question<'q>,
    lanes: Option<Lanes<'q>>,
    general: General<'q>,
    poses: Vec<Isometry>,
    order: Order,
    /// Whether joint positions follow those of the point before by whole turns.
    follows: bool,
    /// Joint positions of the point before, if there is one.
    before: Option<Vec<f64>>,
    /// Number of points answered.
    answered: usize,
}

/// The lanes of an arm and its model.
enum Lanes<'q> {
    /// An ortho-parallel arm, the drives alone.
    Drives(Box<Points<'q>>),
    /// An arm with named branches, and its whole model.
    Whole(Box<WholePoints<'q>>),
}

impl<'q> Lanes<'q> {
    /// None for arms and models that lanes do not know, and for external axes that move along a path.
    fn of(question: &'q Question<'q>, order: Order, detail: AnswerDetail) -> Option<Lanes<'q>> {
        if question.homes.is_some() {
            return None;
        }
        let (robot, model) = (question.arm.robot, question.arm.model);
        let by_load_alone = detail == AnswerDetail::DeviationsAlone || !model.has_unloaded_deviation();
        if let Some(arm) = robot.ortho_parallel()
            && model.is_drives_alone()
            && by_load_alone
            && question.uncertainty.is_none()
        {
            return Some(Lanes::Drives(Box::new(Points::new(question, arm))));
        }
        let in_turn = order == Order::Any || turns_follow(question);
        in_turn.then(|| Some(Lanes::Whole(Box::new(WholePoints::of(question, detail)?))))?
    }

    fn solve(&mut self, poses: &[Isometry]) {
        match self {
            Lanes::Drives(points) => points.solve(poses),
            Lanes::Whole(points) => points.solve(poses),
        }
    }

    /// Fills the slots of the solved points. Returns for each point whether lanes decide it; slots of the other points
    /// have no evaluation and unspecified numbers.
    fn write(&self, slots: &mut Slots<'_>) -> [bool; BLOCK] {
        match self {
            Lanes::Drives(points) => points.write(slots),
            Lanes::Whole(points) => points.write(slots),
        }
    }
}

/// Whether joint positions on a path may follow those of the point before by whole turns, after the posture was
/// chosen: no other joint depends on them, and no margin chooses the posture.
fn turns_follow(question: &Question<'_>) -> bool {
    let robot = question.arm.robot;
    let chosen_by_margin = match question.choice {
        BranchChoice::Best => false,
        BranchChoice::Of(pattern) => {
            Branch::ALL
                .iter()
                .filter(|branch| pattern.matches(**branch))
                .count()
                > 1
        }
    };
    let coupled = robot.joints().iter().any(|joint| !joint.coupling.is_empty());
    robot.ortho_parallel().is_some() || !(chosen_by_margin || coupled)
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
        Solver {
            question,
            order,
            follows: question.arm.robot.ortho_parallel().is_none(),
            lanes: Lanes::of(question, order, detail),
            general: General::new(question, detail),
            poses: Vec::with_capacity(BLOCK),
            before: None,
            answered: 0,
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
        for (i, mut decided) in decided.into_iter().enumerate().take(count) {
            // Lanes know nothing of bodies: a posture that does not keep the clearance is chosen again, or refused.
            if decided && self.question.clearance.is_some() {
                let Slot { point, joints, .. } = slots.at(i);
                decided = point.is_err() || self.general.conflict(joints).is_none();
            }
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
                let requested = Question {
                    home: self.question.home_at(self.answered + i),
                    ..*self.question
                };
                *point = self
                    .general
                    .answer(&requested, &self.poses[i], self.before.as_deref());
                match point {
                    Ok(_) => self.general.write(joints, deviations, shares),
                    Err(_) => {
                        joints.fill(0.0);
                        deviations.fill(Vector3::zeros());
                        shares.fill(0.0);
                    }
                }
            } else if let (Ok(evaluation), Some(before)) = (&mut *point, self.before.as_deref())
                && self.follows
            {
                follow(self.question.arm.robot, before, joints, evaluation);
            }
            if self.order == Order::AlongPath && point.is_ok() {
                match &mut self.before {
                    Some(before) => before.copy_from_slice(joints),
                    None => self.before = Some(joints.to_vec()),
                }
            }
        }
        self.answered += count;
        (watch.finished)(count);
        Ok(())
    }
}

/// Brings joint positions by whole turns as near as possible to those of the point before.
fn follow(robot: &Robot, before: &[f64], joints: &mut [f64], evaluation: &mut Evaluation) {
    let rail = robot.inverse().rail_joints();
    for (joint, position) in joints.iter_mut().enumerate().skip(rail) {
        *position = WholeTurns::of(robot, joint, Some(before)).applied(*position);
    }
    if let Some((joint, margin)) = robot.limit_margin(joints) {
        (evaluation.limit_joint, evaluation.limit_margin) = (joint, margin);
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod witness;
