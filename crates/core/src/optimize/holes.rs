//! Postures for single points (holes): each uses its best spin and branch.
//!
//! `d_i` is the minimum, over all spins and usable postures, of the selected component of the deviation
//! ([`crate::kernel::Columns`]), with backlash and geometry. Of postures that differ by rounding only (a flipped wrist
//! and its twin), the one farthest from its joint limits is used, then the smallest spin. The points are independent:
//! any order gives the same result.
//!
//! A point without a usable posture is answered without additional spin, in the best of the open branches, so that the
//! reason and the amount are reported.

use rayon::prelude::*;

use super::posture::{PostureSearch, about_z, blocked_by, fill};
use crate::kernel::{Answers, BranchChoice, Column, Columns, PostureStatus, Question, SLOTS, evaluate};
use crate::path::LoadedTrack;
use crate::robot::{Branch, BranchPattern, Robot};
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

/// The best posture for each point of `path`. Objective, turn rate and turn price of `search` are not
/// used, nor cases, normal and choice of `question`.
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
    watch: Watch<'_>,
) -> Result<HolesFound, Cancelled> {
    let LoadedTrack { track, load } = path;
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "at least one spin");
    let maker = || {
        let columns = Columns::at_single_points(question.arm, question.home, search.wrist);
        (columns, Column::default())
    };
    let each = |(columns, column): &mut (Columns<'_>, Column), index: usize| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        fill(columns, path, index, search, column);
        let best = best(question.arm.robot, search, column);
        let status = best.map_or_else(|| blocked_by(column), |_| PostureStatus::Usable);
        let spin = best.map_or(0.0, |slot| search.spins.at(slot / SLOTS));
        let choice = match best.filter(|_| columns.slots_are_branches()) {
            Some(slot) => BranchChoice::Of(Branch::ALL[slot % SLOTS].into()),
            None if search.branches == BranchPattern::default() => BranchChoice::Best,
            None => BranchChoice::Of(search.branches),
        };
        let joint_count = question.arm.robot.joints().len();
        let home = best.map(|slot| column.joints_of(slot, joint_count));
        let here = track.loaded_stop(index, load);
        let requested = Question {
            cases: &here.cases,
            normal: here.stop.normal,
            choice,
            home: home.or(question.home),
            ..*question
        };
        let pose = here.stop.base_from_tool * about_z(spin);
        let answers = evaluate(&requested, 1, |_| pose, Watch::NONE)?;
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
