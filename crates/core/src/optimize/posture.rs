//! Search for the postures along a path: spin of the tool and branch, point after point, and where permitted the lean of
//! the tool and the positions of external axes.
//!
//! At each point the tool may be turned about its own axis and lean from the programmed one, external axes may move, and
//! each such setting has several postures: a lattice of path x setting x posture. Of all chains that meet the limits, the
//! one with the lowest deviation is used, as specified by [`Objective`] (`chain`). With lean or external axes the lattice
//! is refined step by step near the best chain so far (`refined`).
//!
//! | limit | how it is met |
//! |---|---|
//! | joint range | a posture outside, or nearer to a limit than the margin, is not usable |
//! | singularities | a posture near a stretched arm, or with a wrist bend below the limit, is not usable |
//! | joint speed at the feed | from point to point, and for the turn of the tool |
//! | a jump | no joint turns by half a radian between neighbouring points |
//! | whole turns | a joint that turns more than once stays within its range over a whole cut |
//! | external axis | limited per metre of the path, or still within a cut; its speed limit |
//! | turn and lean of the tool | limited per metre of the path, in steps; then smoothed, at most half a step away. Where a smoothed turn is nearer to a limit than the margin, or a body nearer to another than demanded, the search is repeated with a greater margin or clearance |
//! | clearance | a posture in which two bodies are nearer than demanded is not usable |
//!
//! Where a joint reverses, its backlash leaves a mark on the part. With a price on reversals
//! ([`PostureSearch::back_price`]) a second chain with fewer reversals is computed. The one with the lower sum of
//! lattice cost and price is used. Reversals are counted after the steps of the lattice have been smoothed.
//!
//! The branch changes only between cuts. The chain is the best of the lattice, not of all turns between its steps;
//! forces are those of the nominal path. Both are recomputed when the path is evaluated with the result
//! ([`crate::map::along_postures`]).

use nalgebra::{Unit, Vector3};

use super::freedoms::{LeanRange, MOST_MOVING, MovingAxis};
use super::lattice::Lattice;
use super::refined::refined;
use super::steps::Steps;
use crate::frame::both_across;
use crate::kernel::{AT_LIMIT, BranchChoice, PostureStatus, Question};
use crate::map::along_postures;
use crate::path::{Lean, LoadedTrack, RoundedEnd, Track};
use crate::robot::{Branch, BranchPattern};
use crate::watch::{Cancelled, Watch};

/// Component of the deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// Across the normal of the surface: the tool axis, unless the tool leans.
    InPlane,
    /// Across the tool and the feed: relevant for a wall.
    CrossTrack,
    /// Along the normal: relevant for a floor.
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
#[derive(Clone, Debug, PartialEq)]
pub struct PostureSearch {
    /// Spins that are tried.
    pub spins: Steps,
    /// Lean of the tool, where it is permitted.
    pub lean: Option<LeanRange>,
    /// External axes that move along the path, at most [`MOST_MOVING`].
    pub axes: Vec<MovingAxis>,
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
    /// Lean of the tool at each point, and the end of the tool, if it may lean.
    pub leans: Option<(Vec<Lean>, RoundedEnd)>,
    /// [`Track::homes`] with the positions of the external axes, if any moves.
    pub homes: Option<Vec<f64>>,
    /// The branch at each point; `None` where no posture is usable, and for arms without branch names.
    pub branches: Vec<Option<Branch>>,
    /// Points without a usable posture, each with the most frequent reason.
    pub unreachable: Vec<(usize, PostureStatus)>,
    /// Points that the arm cannot reach without a stop.
    pub breaks: Vec<usize>,
    /// Objective of the chain, m: the largest deviation, or the mean cost of its points.
    pub reached: f64,
    /// The lattice of spins, thinned out; with lean and external axes as they were chosen.
    pub lattice: Lattice,
}

/// Least increase of a clearance that was not kept after smoothing, m.
const LEAST_MORE: f64 = 1e-3;

/// The best postures along `path` for these settings. Cases, normal, uncertainty and choice of `question`
/// are not used.
///
/// Memory: one byte for each point x spin x posture, and a hundred times that for each of about a hundred points; with
/// lean or external axes four bytes.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](crate::load::PathLoad::covers) the points of the track, there is no spin, or more
/// than [`MOST_MOVING`] external axes move.
pub fn postures_along(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    let LoadedTrack { track, load } = path;
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "at least one spin");
    assert!(search.axes.len() <= MOST_MOVING, "too many external axes");
    let mut search = search.clone();
    let margin = search.margin;
    let mut of_lattice = *question;
    let rounds = if question.clearance.is_some() { 5 } else { 3 };
    for round in 1..=rounds {
        let found = refined(&of_lattice, path, &search, watch)?;
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

impl Component {
    /// Directions of the component of the deviation at point `index` of `track` with this normal, base; of length 1, or
    /// 0 where one is enough.
    pub(super) fn along(self, track: &Track, index: usize, normal: Unit<Vector3<f64>>) -> [Vector3<f64>; 2] {
        let normal = normal.into_inner();
        match self {
            Component::InPlane => both_across(&normal),
            Component::CrossTrack => [track.base_from_surface(index) * Vector3::y(), Vector3::zeros()],
            Component::Axial => [normal, Vector3::zeros()],
        }
    }
}

impl PostureFound {
    /// `track` with these postures: the spins found are added to its own, the tool leans, external axes move.
    pub fn turned(&self, track: &Track) -> Track {
        let had = |index: usize| track.spins.as_ref().map_or(0.0, |spins| spins[index]);
        let spins = self.spins.iter().enumerate();
        let leaning = match &self.leans {
            Some((leans, end)) => track.leaning(leans, *end),
            None => track.clone(),
        };
        Track {
            spins: Some(spins.map(|(index, spin)| had(index) + spin).collect()),
            homes: self.homes.clone().or(leaning.homes),
            ..leaning
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

#[cfg(test)]
mod tests;
