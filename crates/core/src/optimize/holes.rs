//! How should the arm hold the tool at points that no path joins? Each in the turn and the branch that is best for itself.
//!
//! `d_i = min over turns and postures that stand of the deviation that counts` ([`crate::kernel::Columns`]), backlash and
//! geometry in it; of postures that differ by rounding alone (a flipped wrist and its twin) the one farthest from its joint
//! limits, then the least turn. The points know nothing of each other: any order gives the same.
//!
//! A point where nothing stands is answered without a turn, in the best of the open branches, so that its reason and amount
//! are told.

use rayon::prelude::*;

use super::posture::{PostureSearch, about_z, fill, blocked_by};
use crate::kernel::{Answers, BranchChoice, Column, Columns, Question, SLOTS, Stand, evaluate};
use crate::load::PathLoad;
use crate::path::Track;
use crate::robot::{Branch, BranchPattern, Robot};
use crate::watch::{Cancelled, Watch};

/// Deviations that differ by less than this part are the same.
const SAME: f64 = 1e-9;

/// How each point is held.
#[derive(Clone, Debug)]
pub struct HolesFound {
    /// Turn of the tool beside the one that the placing has, rad; 0 where nothing stands.
    pub spins: Vec<f64>,
    /// `Holds`, or what stands in the way of the most turns and branches.
    pub stands: Vec<Stand>,
    /// What came out, with shares and uncertainties; in-plane is across the tool, normal along it.
    pub answers: Answers,
}

/// The best posture for each point of `track` under `load`, one by one. Of `search` goal, turn rate and turn price are not
/// looked at, of `question` cases, normal and choice.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If `load` does not [cover](PathLoad::covers) the points of the track, or there is no point or no turn.
pub fn holes_held(
    question: &Question<'_>,
    (track, load): (&Track, &PathLoad),
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<HolesFound, Cancelled> {
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "a turn at least");
    let maker = || {
        let columns = Columns::by_themselves(question.arm, question.home, search.wrist);
        (columns, Column::default())
    };
    let each = |(columns, column): &mut (Columns<'_>, Column), index: usize| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        fill(columns, (track, load), (search, index), column);
        let best = best(question.arm.robot, search, column);
        let stand = best.map_or_else(|| blocked_by(column), |_| Stand::Holds);
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
        Ok((spin, stand, answers))
    };
    let all: Vec<(f64, Stand, Answers)> = (0..track.len())
        .into_par_iter()
        .map_init(maker, each)
        .collect::<Result<_, Cancelled>>()?;
    let (mut spins, mut stands, mut answers) = (Vec::new(), Vec::new(), Vec::new());
    for (spin, stand, answer) in all {
        spins.push(spin);
        stands.push(stand);
        answers.push(answer);
    }
    Ok(HolesFound {
        spins,
        stands,
        answers: Answers::joined(answers),
    })
}

/// The slot with the least deviation, if any stands.
fn best(robot: &Robot, search: &PostureSearch, column: &Column) -> Option<usize> {
    let stands = |slot: &usize| column.stands[*slot] == Stand::Holds;
    let all = || (0..column.stands.len()).filter(stands);
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
