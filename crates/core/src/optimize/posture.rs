//! Search for the postures along a path: spin of the tool and branch, point after point.
//!
//! At each point the tool may be turned about its own axis, and each turn has several postures: a lattice of path x
//! turn x posture. Of all chains that meet the limits, the one with the lowest deviation is used, as specified by
//! [`Objective`] (`chain`).
//!
//! | limit | how it is met |
//! |---|---|
//! | joint range | a posture outside, or nearer to a limit than the margin, is not usable |
//! | singularities | a posture near a stretched arm, or with a wrist bend below the limit, is not usable |
//! | joint speed at the feed | from point to point, and for the turn of the tool |
//! | a jump | no joint turns by half a radian between neighbouring points |
//! | whole turns | a joint that turns more than once stays within its range over a whole cut |
//! | turn of the tool | limited per metre of the path, in steps; then smoothed, at most half a step away. Where a smoothed turn is nearer to a limit than the margin, or a body nearer to another than demanded, the search is repeated with a greater margin or clearance |
//! | clearance | a posture in which two bodies are nearer than demanded is not usable |
//!
//! Where a joint reverses, its backlash leaves a mark on the part. With a price on reversals
//! ([`PostureSearch::back_price`]) a second chain with fewer reversals is computed. The one with the lower sum of
//! lattice cost and price is used. Reversals are counted after the steps of the lattice have been smoothed.
//!
//! The branch changes only between cuts. The chain is the best of the lattice, not of all turns between its steps;
//! forces are those of the nominal path. Both are recomputed when the path is evaluated with the result
//! ([`crate::map::along_postures`]).

use std::f64::consts::TAU;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use rayon::prelude::*;

use super::chain::{Beginning, Chain, Cheapest, MOST_STEPS, Together, Turns};
use super::lattice::Lattice;
use super::links::{Between, JointRate};
use super::reversals::reversals;
use super::smooth::without_steps;
use super::spins::Spins;
use super::winding::WindingJoints;
use crate::frame::{Isometry, both_across};
use crate::kernel::{AT_LIMIT, BranchChoice, Column, ColumnLoad, Columns, PostureStatus, Question, SLOTS};
use crate::map::along_postures;
use crate::path::{LoadedStop, LoadedTrack, Pace, Track};
use crate::robot::{Branch, BranchPattern};
use crate::watch::{Cancelled, Watch};

/// Component of the deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// Across the tool.
    InPlane,
    /// Across the tool and the feed: relevant for a wall.
    CrossTrack,
    /// Along the tool: relevant for a floor.
    Axial,
}

/// Objective along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Objective {
    /// The largest deviation, and with this the smallest mean.
    Worst,
    /// The mean over the points.
    Mean,
    /// The mean excess over this tolerance (m).
    Above(f64),
}

/// Settings of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PostureSearch {
    /// Spins that are tried.
    pub spins: Spins,
    /// Component of the deviation.
    pub component: Component,
    /// Objective.
    pub objective: Objective,
    /// Open branches, of an arm with branch names.
    pub branches: BranchPattern,
    /// Largest turn of the tool along the path, rad/m.
    pub turn_rate: f64,
    /// Smallest improvement that justifies a step of turning, m.
    pub turn_price: f64,
    /// Price of a reversal: the mean deviation may grow by this over the length of the path for each, m m.
    pub back_price: f64,
    /// Smallest bend of the wrist, rad.
    pub wrist: f64,
    /// Smallest distance of every joint from its limits, rad (m).
    pub margin: f64,
}

/// Postures along a path.
#[derive(Clone, Debug)]
pub struct PostureFound {
    /// Spin of the tool at each point in addition to that of the placing, rad; where no posture is usable, that of the
    /// point before.
    pub spins: Vec<f64>,
    /// The branch at each point; `None` where no posture is usable, and for arms without branch names.
    pub branches: Vec<Option<Branch>>,
    /// Points without a usable posture, each with the most frequent reason.
    pub unreachable: Vec<(usize, PostureStatus)>,
    /// Points that the arm cannot reach without a stop.
    pub breaks: Vec<usize>,
    /// Objective of the chain, m: the largest deviation, or the mean cost of its points.
    pub reached: f64,
    /// The lattice, thinned out.
    pub lattice: Lattice,
}

/// Columns computed at once.
const CHUNK: usize = 256;
/// Points of the lattice that are kept.
const KEPT: usize = 800;
/// Least increase of a clearance that was not kept after smoothing, m.
const LEAST_MORE: f64 = 1e-3;
/// Weight of deviations within the tolerance, so that of chains within it the better one is selected.
pub(super) const WITHIN: f64 = 1e-3;

/// The best postures along `path` for these settings. Cases, normal, uncertainty and choice of `question`
/// are not used.
///
/// Memory: one byte for each point x turn x posture, and a hundred times that for each of about a hundred points.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](crate::load::PathLoad::covers) the points of the track, or there is no spin.
pub fn postures_along(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    let LoadedTrack { track, load } = path;
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "at least one spin");
    let mut search = *search;
    let margin = search.margin;
    let mut of_lattice = *question;
    let rounds = if question.clearance.is_some() { 5 } else { 3 };
    for round in 1..=rounds {
        let found = searched(&of_lattice, path, &search, watch)?;
        let turned = found.turned(track);
        let along = along_postures(question, &turned, load.clone(), found.choices(), watch)?;
        let rooms = along
            .answers
            .evaluations()
            .map(|(index, here)| (index, here.limit_margin));
        let usable = |index: usize| {
            found
                .unreachable
                .binary_search_by_key(&index, |(lost, _)| *lost)
                .is_err()
        };
        let least = rooms
            .filter(|(index, _)| usable(*index))
            .map(|(_, room)| room)
            .fold(f64::INFINITY, f64::min);
        let missing = along.answers.missing_clearance(usable);
        if round == rounds || (least >= margin - AT_LIMIT && missing.is_none()) {
            return Ok(found);
        }
        // By smoothing a joint is this much nearer to a limit, and a body to another, than in the lattice.
        search.margin += 1.5 * (margin - least).max(0.0);
        if let (Some(demanded), Some(missing)) = (&mut of_lattice.clearance, missing) {
            demanded.least += 1.5 * missing + LEAST_MORE;
        }
    }
    unreachable!("the last round returns")
}

/// One search with the margin of `search` for the lattice.
fn searched(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    let LoadedTrack { track, load } = path;
    let joints = JointRate::all(question.arm.robot);
    let walk = Walk {
        question,
        path,
        search,
        winding: WindingJoints::of(question.arm.robot, |joint| joints[joint].wraps()),
        joints,
    };
    let cost = match search.objective {
        Objective::Worst => Cost::Within(walk.chain(Cost::Worst, 0.0, watch)?.0.cost),
        Objective::Mean => Cost::Within(f64::INFINITY),
        Objective::Above(limit) => Cost::Above(limit),
    };
    let mut found = walk.best(cost, 0.0, watch)?;
    if !found.breaks.is_empty() && search.objective == Objective::Worst {
        // The chains within the largest deviation may all end with a joint at its limit.
        let any = walk.best(Cost::Within(f64::INFINITY), 0.0, watch)?;
        if any.breaks.len() < found.breaks.len() {
            found = any;
        }
    }
    if search.back_price > 0.0 && track.path.length() > 0.0 {
        let price = search.back_price / track.path.length();
        let other = walk.best(cost, price * track.len() as f64, watch)?;
        let total = |found: &PostureFound| -> Result<f64, Cancelled> {
            let turned = found.turned(track);
            let along = along_postures(question, &turned, load.clone(), found.choices(), watch)?;
            let backs: usize = reversals(&track.path, &along.answers).iter().sum();
            Ok(found.reached + price * backs as f64)
        };
        // A chain that stops on the way has no reversal there.
        if (other.breaks.len(), total(&other)?) < (found.breaks.len(), total(&found)?) {
            found = other;
        }
    }
    if let (Objective::Worst, Cost::Within(worst)) = (search.objective, cost) {
        found.reached = worst;
    }
    Ok(found)
}

/// Cost of a state from its deviation.
#[derive(Clone, Copy, Debug)]
enum Cost {
    /// The deviation; the largest is used.
    Worst,
    /// The deviation; states above this are excluded.
    Within(f64),
    /// The excess over this tolerance.
    Above(f64),
}

impl Cost {
    fn of(self, deviation: f64) -> f64 {
        match self {
            Cost::Worst => deviation,
            Cost::Within(most) if deviation > most => f64::INFINITY,
            Cost::Within(_) => deviation,
            Cost::Above(limit) if deviation.is_finite() => (deviation - limit).max(0.0) + WITHIN * deviation,
            Cost::Above(_) => f64::INFINITY,
        }
    }

    fn together(self) -> Together {
        match self {
            Cost::Worst => Together::Worst,
            Cost::Within(_) | Cost::Above(_) => Together::Sum,
        }
    }
}

/// One pass along the path.
struct Walk<'a> {
    question: &'a Question<'a>,
    path: LoadedTrack<'a>,
    search: &'a PostureSearch,
    joints: Vec<JointRate>,
    winding: WindingJoints,
}

/// Observations in addition to the chain.
#[derive(Default)]
struct Seen {
    /// Points without a usable posture.
    unreachable: Vec<(usize, PostureStatus)>,
    /// Columns of the thinned lattice, with all their slots.
    kept: Vec<(usize, Vec<f64>, Vec<PostureStatus>)>,
    /// Whether slots are branches.
    named: bool,
}

impl Walk<'_> {
    /// The postures of the best chain, with this price per reversal.
    fn best(&self, cost: Cost, back_price: f64, watch: Watch<'_>) -> Result<PostureFound, Cancelled> {
        let (cheapest, seen) = self.chain(cost, back_price, watch)?;
        Ok(self.reported(cheapest, seen))
    }

    /// The best chain, with this price per reversal.
    fn chain(&self, cost: Cost, back_price: f64, watch: Watch<'_>) -> Result<(Cheapest, Seen), Cancelled> {
        let Spins { step, count, .. } = self.search.spins;
        let (arm, home) = (self.question.arm, self.question.home);
        let maker =
            || Columns::new(arm, home, self.search.wrist).keeping_clear(self.question.clearance_check());
        let worst_alone = matches!(cost, Cost::Worst);
        let turns = Turns {
            count,
            around: (step * count as f64 - TAU).abs() < 1e-9,
            kept_slots: maker().slots_are_branches(),
            price: if worst_alone { 0.0 } else { self.search.turn_price },
            back_price,
            winds: !self.winding.is_empty(),
        };
        let points = self.path.track.len();
        let mut chain = Chain::new(turns, cost.together(), (!worst_alone).then_some(points));
        let mut seen = Seen {
            named: turns.kept_slots,
            ..Seen::default()
        };
        let stride = points.div_ceil(KEPT).max(1);
        let mut columns: Vec<Column> = vec![Column::default(); CHUNK.min(points)];
        let mut before = Column::default();
        let mut costs = Vec::new();
        for first in (0..points).step_by(CHUNK) {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let chunk = &mut columns[..CHUNK.min(points - first)];
            chunk
                .par_iter_mut()
                .enumerate()
                .for_each_init(maker, |maker, (i, column)| {
                    fill(maker, self.path, first + i, self.search, column);
                });
            for i in 0..chunk.len() {
                let index = first + i;
                let (done, rest) = chunk.split_at(i);
                let here = &rest[0];
                costs.clear();
                costs.extend(here.deviations.iter().map(|deviation| cost.of(*deviation)));
                let links = Between {
                    before: done.last().unwrap_or(&before),
                    here,
                    joints: &self.joints,
                    winding: &self.winding,
                    time: self.time(index),
                    turn_time: self.turn_time(index),
                };
                chain.take(&costs, self.beginning(index), &links);
                if !worst_alone {
                    seen.note(index, here, index % stride == 0);
                }
            }
            if let Some(last) = chunk.last() {
                before.clone_from(last);
            }
            (watch.finished)(chunk.len());
        }
        Ok((chain.cheapest(), seen))
    }

    /// How the column of point `index` starts.
    fn beginning(&self, index: usize) -> Beginning {
        if self.path.track.path.begins(index) {
            return Beginning::Restart;
        }
        let points = &self.path.track.path.points;
        let per_step = self.search.turn_rate / self.search.spins.step;
        let steps = |at: usize| (points[at].along * per_step).floor();
        Beginning::Follows((steps(index) - steps(index - 1)).clamp(0.0, MOST_STEPS as f64) as usize)
    }

    /// Time from the point before to point `index`, s, where the feed is known.
    fn time(&self, index: usize) -> Option<f64> {
        let points = &self.path.track.path.points;
        let Pace::Feed(speed) = points[index].pace else {
            return None;
        };
        let before = points[index.checked_sub(1)?].along;
        (speed > 0.0).then(|| (points[index].along - before) / speed)
    }

    /// Shortest time for a step of turning, s, where the feed is known.
    fn turn_time(&self, index: usize) -> Option<f64> {
        let Pace::Feed(speed) = self.path.track.path.points[index].pace else {
            return None;
        };
        (speed > 0.0).then(|| self.search.spins.step / (self.search.turn_rate * speed))
    }

    fn reported(&self, cheapest: Cheapest, seen: Seen) -> PostureFound {
        let spins = without_steps(
            &self.path.track.path,
            &self.search.spins,
            &cheapest.states,
            &cheapest.breaks,
        );
        let branch = |state: &Option<usize>| {
            state
                .filter(|_| seen.named)
                .map(|state| Branch::ALL[state % SLOTS])
        };
        let count = cheapest.states.iter().flatten().count().max(1);
        PostureFound {
            lattice: Lattice::of(&self.search.spins, &seen.kept, &cheapest.states),
            branches: cheapest.states.iter().map(branch).collect(),
            reached: cheapest.cost / count as f64,
            spins,
            unreachable: seen.unreachable,
            breaks: cheapest.breaks,
        }
    }
}

impl Component {
    /// Directions of the component of the deviation at point `index` of `track` with this normal, base; of length 1, or
    /// 0 where one is enough.
    pub(super) fn along(self, track: &Track, index: usize, normal: Unit<Vector3<f64>>) -> [Vector3<f64>; 2] {
        let normal = normal.into_inner();
        match self {
            Component::InPlane => both_across(&normal),
            Component::CrossTrack => [track.base_from_feed(index) * Vector3::y(), Vector3::zeros()],
            Component::Axial => [normal, Vector3::zeros()],
        }
    }
}

impl PostureFound {
    /// `track` with these postures: the spins found are added to its own.
    pub fn turned(&self, track: &Track) -> Track {
        let had = |index: usize| track.spins.as_ref().map_or(0.0, |spins| spins[index]);
        let spins = self.spins.iter().enumerate();
        Track {
            spins: Some(spins.map(|(index, spin)| had(index) + spin).collect()),
            ..track.clone()
        }
    }

    /// The branches of the path, each with its first point, for [`crate::map::along_postures`].
    pub fn choices(&self) -> Vec<(usize, BranchChoice)> {
        let mut choices: Vec<(usize, BranchChoice)> = Vec::new();
        for (index, branch) in self.branches.iter().enumerate() {
            let Some(branch) = branch else { continue };
            let choice = BranchChoice::Of((*branch).into());
            if choices.last().is_none_or(|(_, before)| *before != choice) {
                // Points before the first posture use its branch too.
                choices.push((if choices.is_empty() { 0 } else { index }, choice));
            }
        }
        if choices.is_empty() {
            choices.push((0, BranchChoice::Of(BranchPattern::default())));
        }
        choices
    }
}

impl Seen {
    fn note(&mut self, index: usize, column: &Column, keep: bool) {
        if !column.statuses.contains(&PostureStatus::Usable) {
            self.unreachable.push((index, blocked_by(column)));
        }
        if keep {
            self.kept
                .push((index, column.deviations.clone(), column.statuses.clone()));
        }
    }
}

/// The most frequent reason in a column without a usable posture; out of reach only where there is no other.
pub(super) fn blocked_by(column: &Column) -> PostureStatus {
    let count = |status: PostureStatus| column.statuses.iter().filter(|other| **other == status).count();
    let most = PostureStatus::ALL[1..5]
        .iter()
        .copied()
        .max_by_key(|status| count(*status));
    let most = most.filter(|status| count(*status) > 0);
    most.unwrap_or(PostureStatus::OutOfReach)
}

/// Fills `column` with the postures of point `index` of `path`, at every spin that `search` tries.
pub(super) fn fill(
    maker: &mut Columns<'_>,
    path: LoadedTrack<'_>,
    index: usize,
    search: &PostureSearch,
    column: &mut Column,
) {
    let LoadedStop { stop, cases } = path.track.loaded_stop(index, path.load);
    let poses: Vec<Isometry> = (0..search.spins.count)
        .map(|turn| stop.base_from_tool * about_z(search.spins.at(turn)))
        .collect();
    let along = search.component.along(path.track, index, stop.normal);
    let push = ColumnLoad { cases: &cases, along };
    maker.fill(&poses, &push, column);
    if search.margin > 0.0 {
        column.keep_margin(maker.robot(), search.margin);
    }
    if maker.slots_are_branches() && search.branches != BranchPattern::default() {
        for (slot, branch) in Branch::ALL.into_iter().enumerate() {
            if !search.branches.matches(branch) {
                column.forbid(slot);
            }
        }
    }
}

pub(super) fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
}

#[cfg(test)]
mod tests;
