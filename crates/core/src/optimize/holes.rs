//! Postures for single points (holes): the nominal one, or the best of all spins and branches where that is a
//! significant improvement.
//!
//! `d_i` is the minimum, over all spins and usable postures, of the selected component of the deviation
//! ([`crate::kernel::Columns`]), with backlash and geometry. Of postures that differ by rounding only (a flipped wrist
//! and its twin), the one farthest from its joint limits is used, then the smallest spin. The points are independent:
//! any order gives the same result.
//!
//! The nominal posture has no additional spin and the branch that suits most points, as along a path
//! ([`along_path`](crate::map::along_path)), so that the arm need not change it between them. It is kept at every point
//! where it is usable and the gain of the best posture is not significant ([`LeastGain`]).
//!
//! A point without a usable posture is answered without additional spin, in the best of the open branches, so that the
//! reason and the amount are reported.

use rayon::prelude::*;

use super::column_at::{about_z, blocked_by, fill};
use super::gain::{LeastGain, gain};
use super::posture_search::{Component, PostureSearch};
use super::window::Window;
use crate::kernel::{
    AT_LIMIT, Answers, BranchChoice, Column, Columns, PostureStatus, Question, SLOTS, evaluate,
};
use crate::load::LeaningForces;
use crate::map::one_branch;
use crate::path::LoadedTrack;
use crate::robot::{Branch, BranchPattern, Robot};
use crate::source::UncertainInput;
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Deviations with a smaller relative difference are equal.
const SAME: f64 = 1e-9;

/// Posture of each point.
#[derive(Clone, Debug)]
pub struct HolesFound {
    /// Spin of the tool in addition to that of the placing, rad; 0 where no posture can be used.
    pub spins: Vec<f64>,
    /// `Usable`, or the most frequent reason among all spins and branches.
    pub statuses: Vec<PostureStatus>,
    /// Results, with shares and uncertainties; in-plane is across the tool, normal along it.
    pub answers: Answers,
}

/// The posture for each point of `path`. Objective, turn rate and turn price of `search` are not used, nor cases and
/// normal of `question`.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](crate::load::PathLoad::covers) the points of the track, or there is no point or no
/// spin.
pub fn hole_postures(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    search: &PostureSearch,
    least: &LeastGain,
    watch: Watch<'_>,
) -> Result<HolesFound, Cancelled> {
    let LoadedTrack { track, load } = path;
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "at least one spin");
    let cases = vec![Wrench::ZERO; load.case_count()];
    let open = Question {
        cases: &cases,
        choice: match question.choice {
            BranchChoice::Of(_) => BranchChoice::Of(search.branches),
            BranchChoice::Best => BranchChoice::Best,
        },
        ..*question
    };
    let nominal = one_branch(&open, track, load, watch)?;
    let window = Window::all(search);
    let maker = || {
        let columns = Columns::at_single_points(question.arm, question.home, search.wrist)
            .keeping_clear(question.clearance_check());
        (columns, Column::default())
    };
    let each = |(columns, column): &mut (Columns<'_>, Column), index: usize| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let forces = LeaningForces::default();
        fill((columns, &forces), path, index, (search, &window), column);
        let best = best(question.arm.robot, search, column);
        let status = best.map_or_else(|| blocked_by(column), |_| PostureStatus::Usable);
        let home = best.map(|slot| column.joints_of(slot, question.arm.robot.joints().len()));
        let searched = HolePosture {
            spin: best.map_or(0.0, |slot| search.spins.at(slot / SLOTS)),
            choice: match best.filter(|_| columns.slots_are_branches()) {
                Some(slot) => BranchChoice::Of(Branch::ALL[slot % SLOTS].into()),
                None if search.branches == BranchPattern::default() => BranchChoice::Best,
                None => BranchChoice::Of(search.branches),
            },
            home: home.or(question.home),
        };
        let here = HoleGain {
            question,
            path,
            index,
            component: search.component,
        };
        let kept = HolePosture {
            spin: 0.0,
            choice: nominal,
            home: question.home,
        };
        let answers = match best {
            Some(_) => here.kept(&kept, &searched, search.margin, least)?,
            None => None,
        };
        let (spin, answers) = match answers {
            Some(answers) => (0.0, answers),
            None => (searched.spin, here.answers(&searched, None, question)?),
        };
        (watch.finished)(1);
        Ok((spin, status, answers))
    };
    let all: Vec<(f64, PostureStatus, Answers)> = (0..track.len())
        .into_par_iter()
        .map_init(maker, each)
        .collect::<Result<_, Cancelled>>()?;
    let (mut spins, mut statuses, mut answers) = (Vec::new(), Vec::new(), Vec::new());
    for (spin, status, answer) in all {
        spins.push(spin);
        statuses.push(status);
        answers.push(answer);
    }
    Ok(HolesFound {
        spins,
        statuses,
        answers: Answers::joined(answers),
    })
}

/// A posture at a hole.
#[derive(Clone, Copy, Debug)]
struct HolePosture<'a> {
    /// Spin in addition to that of the placing, rad.
    spin: f64,
    choice: BranchChoice,
    home: Option<&'a [f64]>,
}

/// One hole, and the component of its deviation.
struct HoleGain<'a> {
    question: &'a Question<'a>,
    path: LoadedTrack<'a>,
    index: usize,
    component: Component,
}

impl HoleGain<'_> {
    /// The answers in this posture for the arm of `question`, with one input changed.
    fn answers(
        &self,
        posture: &HolePosture<'_>,
        input: Option<&UncertainInput>,
        question: &Question<'_>,
    ) -> Result<Answers, Cancelled> {
        let mut here = self.path.track.loaded_stop(self.index, self.path.load);
        for case in &mut here.cases {
            match input {
                Some(UncertainInput::LoadSize(by)) => *case = *case * (1.0 + by),
                Some(UncertainInput::Force(by)) => case.force += by,
                _ => {}
            }
        }
        let requested = Question {
            cases: &here.cases,
            normal: here.stop.normal,
            choice: posture.choice,
            home: posture.home,
            ..*question
        };
        let pose = here.stop.base_from_tool * about_z(posture.spin);
        evaluate(&requested, 1, |_| pose, Watch::NONE)
    }

    /// The answers in the nominal posture `kept`, where it is usable and `searched` is no significant gain.
    fn kept(
        &self,
        kept: &HolePosture<'_>,
        searched: &HolePosture<'_>,
        margin: f64,
        least: &LeastGain,
    ) -> Result<Option<Answers>, Cancelled> {
        let answers = self.answers(kept, None, self.question)?;
        let usable = answers.points[0]
            .as_ref()
            .is_ok_and(|point| point.singularity.is_none() && point.limit_margin >= margin - AT_LIMIT);
        if !usable {
            return Ok(None);
        }
        let found = gain(self.question, |question, input| {
            let mut values = [f64::INFINITY; 2];
            for (value, posture) in values.iter_mut().zip([kept, searched]) {
                let answers = self.answers(posture, input, question)?;
                if answers.points[0].is_ok() {
                    let deviations = answers.deviations_at(0);
                    *value = self.component.largest(self.path.track, self.index, deviations);
                }
            }
            Ok(values)
        })?;
        Ok((!found.is_significant(least)).then_some(answers))
    }
}

/// The usable slot with the smallest deviation.
fn best(robot: &Robot, search: &PostureSearch, column: &Column) -> Option<usize> {
    let usable = |slot: &usize| column.statuses[*slot] == PostureStatus::Usable;
    let all = || (0..column.statuses.len()).filter(usable);
    let least = all().map(|slot| column.deviations[slot]).min_by(f64::total_cmp)?;
    let margin = |slot: usize| {
        let joints = column.joints_of(slot, robot.joints().len());
        robot
            .limit_margin(joints)
            .map_or(f64::INFINITY, |(_, margin)| margin)
    };
    let turn = |slot: usize| search.spins.at(slot / SLOTS).abs();
    all()
        .filter(|slot| column.deviations[*slot] <= least * (1.0 + SAME))
        .max_by(|a, b| {
            let by_margin = margin(*a).total_cmp(&margin(*b));
            by_margin.then(turn(*b).total_cmp(&turn(*a)))
        })
}

#[cfg(test)]
mod tests;
