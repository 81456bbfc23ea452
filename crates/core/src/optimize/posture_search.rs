//! What a search along a path is to find, and what it has found.

use nalgebra::{Unit, Vector3};

use super::freedoms::{LeanRange, MovingAxis};
use super::lattice::Lattice;
use super::steps::Steps;
use crate::frame::both_across;
use crate::kernel::{BranchChoice, PostureStatus};
use crate::load::PathLoad;
use crate::path::{CutStock, Lean, LoadedTrack, RoundedEnd, Track};
use crate::robot::{Branch, BranchPattern};

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
    /// External axes that move along the path, at most [`MOST_MOVING`](super::MOST_MOVING).
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

impl PostureSearch {
    /// Whether the tool keeps its axis and no external axis moves.
    pub fn is_of_spins(&self) -> bool {
        self.lean.is_none() && self.axes.is_empty()
    }

    /// The same with half the rates of spin, lean and external axes.
    #[must_use]
    pub(super) fn calmer(mut self) -> PostureSearch {
        self.turn_rate *= 0.5;
        if let Some(lean) = &mut self.lean {
            lean.rate *= 0.5;
        }
        for axis in &mut self.axes {
            axis.rate *= 0.5;
        }
        self
    }

    /// The same in half the steps of lean and external axes.
    #[must_use]
    pub(super) fn finer(mut self) -> PostureSearch {
        if let Some(lean) = &mut self.lean {
            (lean.leads, lean.tilts) = (lean.leads.halved(), lean.tilts.halved());
        }
        for axis in &mut self.axes {
            axis.positions = axis.positions.halved();
        }
        self
    }
}

/// The path that a search follows.
#[derive(Clone, Copy, Debug)]
pub struct SearchedPath<'a> {
    /// The path under its load.
    pub(super) loaded: LoadedTrack<'a>,
    pub(super) stock: Option<&'a CutStock<'a>>,
    /// Clearance of bodies of the tool that are round about its axis from the stock, m, where it is less than that of the others.
    pub(super) least_of_round: Option<f64>,
}

impl<'a> SearchedPath<'a> {
    /// A path under its load, with the stock that it cuts, if the demanded clearance is to be kept from it.
    pub fn new(loaded: LoadedTrack<'a>, stock: Option<&'a CutStock<'a>>) -> SearchedPath<'a> {
        SearchedPath {
            loaded,
            stock,
            least_of_round: None,
        }
    }
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

    /// `load` with the tool leaning as found.
    pub fn load(&self, load: &PathLoad) -> PathLoad {
        match &self.leans {
            Some((leans, _)) => load.leaning(leans),
            None => load.clone(),
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
