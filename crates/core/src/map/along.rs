//! Deviation along a path: along the feed, across it and along the tool, for loads that may turn with the feed.
//!
//! A path is followed in one posture: the branch is selected once, from points spread over the path, so the elbow does
//! not change within a part. For a constant load and a tool of constant direction, shares and uncertainties are
//! computed at every point; for any other load they are not. Where a tool cuts, the force-deflection equilibrium is
//! computed at every point ([`crate::load::force_equilibrium`]); the branch is selected under the forces of the nominal
//! path. Where the tool leans, the cut is that of the leaning tool ([`Track::leaning_load`]).
//!
//! Backlash and geometry are added to the effect of the load (`backlash_geometry`); they do not change force and depth
//! of a cut.

use std::ops::Range;

use nalgebra::Vector3;

use super::backlash_geometry::{BacklashGeometry, add_backlash_and_geometry};
use super::turns;
use crate::kernel::{Answers, BranchChoice, Question, evaluate_in_order, evaluate_loaded};
use crate::load::{CutsAlong, ForceEquilibrium, PathLoad, Rest, TipCompliance};
use crate::motion::Motion;
use crate::path::{LoadedTrack, Track};
use crate::robot::{Branch, BranchPattern};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Number of points for the selection of the branch.
const SPREAD: usize = 400;

/// Answers along a path.
#[derive(Clone, Debug)]
pub struct AlongPath {
    /// The branches used, each from the point with that index on; the first from point 0.
    pub choices: Vec<(usize, BranchChoice)>,
    /// Results at each point; in-plane is across the tool, normal along it. Shares and uncertainties only for a
    /// constant load, a tool of constant direction, and without backlash, geometry and motion ([`Answers::share_count`]
    /// is zero otherwise).
    pub answers: Answers,
    /// The load: for cuts the forces at equilibrium, with the nominal cuts.
    pub load: PathLoad,
    /// The force-deflection equilibrium; `None` where no tool cuts, or the load changes the arm.
    pub equilibrium: Option<EquilibriumSummary>,
    /// Effect of backlash and geometry, included in `answers`; `None` without them.
    pub backlash_geometry: Option<BacklashGeometry>,
}

/// Force-deflection equilibrium along a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EquilibriumSummary {
    /// Largest in-plane deviation with constant forces, m.
    pub largest_nominal: f64,
    /// Points without equilibrium: the cut pulls the tool in.
    pub unsettled: usize,
    /// Index of the first of them.
    pub first_unsettled: Option<usize>,
}

/// The answers along `track` under `load`. Cases and normal of `question` are not used; its uncertainty only where
/// uncertainties are computed.
///
/// Of several branches that match (or of all, for the best one) the arm keeps the one that reaches most points within
/// its limits, evaluated at some 400 points spread over the path. Of equal ones, [`BranchChoice::Best`] selects the one
/// with the smallest largest in-plane deviation, otherwise the one with the largest margin to its limits is used.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If `load` does not [cover](PathLoad::covers) the points of the track.
pub fn along_path(
    question: &Question<'_>,
    track: &Track,
    load: PathLoad,
    watch: Watch<'_>,
) -> Result<AlongPath, Cancelled> {
    let cases = vec![Wrench::ZERO; load.case_count()];
    let requested = Question {
        cases: &cases,
        ..*question
    };
    assert!(load.covers(track.len()), "a load for each point of the track");
    let choice = one_branch(&requested, track, &load, watch)?;
    along_postures(question, track, load, vec![(0, choice)], watch)
}

/// [`along_path`] in given branches: each of `choices` from the point with that index on, in order.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track, or the first choice does not begin at point
/// 0.
pub fn along_postures(
    question: &Question<'_>,
    track: &Track,
    load: PathLoad,
    choices: Vec<(usize, BranchChoice)>,
    watch: Watch<'_>,
) -> Result<AlongPath, Cancelled> {
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(
        choices.first().is_some_and(|(first, _)| *first == 0),
        "the first choice must begin at point 0"
    );
    let load = track.leaning_load(load);
    let mut cases = vec![Wrench::ZERO; load.case_count()];
    let unloaded = question.arm.model.has_unloaded_deviation();
    let steady = track.steady_normal().filter(|_| load.is_steady() && !unloaded);
    if steady.is_some() {
        track.wrenches(&load, 0, &mut cases);
    }
    let requested = Question {
        cases: &cases,
        normal: steady.unwrap_or(question.normal),
        ..*question
    };
    let runs = Runs {
        question: requested,
        track,
        choices: &choices,
        watch,
    };
    let (mut answers, load, equilibrium) = match load {
        load if steady.is_some() => (runs.steady()?, load, None),
        PathLoad::Cuts(cuts) => {
            let mut forces = EquilibriumForces::new(track, cuts);
            let answers = runs.loaded(|i, tip, out| forces.load(i, tip, out))?;
            let equilibrium = question.arm.model.is_affine().then_some(forces.summary);
            (answers, PathLoad::Cuts(forces.cuts), equilibrium)
        }
        load => {
            let answers = runs.loaded(|i, _, out| track.wrenches(&load, i, out))?;
            (answers, load, None)
        }
    };
    turns::continue_turns(question.arm.robot, &track.path, &mut answers);
    let path = LoadedTrack { track, load: &load };
    let backlash_geometry = add_backlash_and_geometry(&question.arm, path, &mut answers);
    Ok(AlongPath {
        backlash_geometry,
        choices,
        answers,
        load,
        equilibrium,
    })
}

/// Stretches of a path, each in a separate branch.
struct Runs<'a> {
    question: Question<'a>,
    track: &'a Track,
    choices: &'a [(usize, BranchChoice)],
    watch: Watch<'a>,
}

impl Runs<'_> {
    /// The answers under the cases of the question.
    fn steady(&self) -> Result<Answers, Cancelled> {
        self.each(|requested, run| {
            let pose = |i| self.track.stop(run.start + i).base_from_tool;
            evaluate_in_order(requested, run.len(), pose, self.watch)
        })
    }

    /// The answers under the wrenches that `load` fills in at each point.
    fn loaded(
        &self,
        mut load: impl FnMut(usize, Option<&TipCompliance>, &mut [Wrench]),
    ) -> Result<Answers, Cancelled> {
        self.each(|requested, run| {
            let stop = |i| self.track.stop(run.start + i);
            let of_run =
                |i: usize, tip: Option<&TipCompliance>, out: &mut [Wrench]| load(run.start + i, tip, out);
            evaluate_loaded(requested, run.len(), stop, of_run, self.watch)
        })
    }

    fn each(
        &self,
        mut answer: impl FnMut(&Question<'_>, Range<usize>) -> Result<Answers, Cancelled>,
    ) -> Result<Answers, Cancelled> {
        let ends = self.choices.iter().skip(1).map(|(first, _)| *first);
        let ends = ends.chain([self.track.len()]);
        let runs = self.choices.iter().zip(ends).map(|((first, choice), end)| {
            let homes = self.track.homes_at(*first..end);
            let requested = Question {
                choice: *choice,
                homes: homes.as_deref(),
                ..self.question
            };
            answer(&requested, *first..end)
        });
        Ok(Answers::joined(runs.collect::<Result<_, _>>()?))
    }
}

impl AlongPath {
    /// Adds the displacement by `motion` at each point: rounded corners and joints that follow late. Shares and uncertainties of the points are removed;
    /// [`crate::kernel::evaluate_posture`] has them.
    ///
    /// # Panics
    /// If `motion` has fewer points.
    pub fn add_motion(&mut self, track: &Track, motion: &Motion) {
        self.answers.remove_shares();
        let mut by = vec![Vector3::zeros(); self.answers.case_count];
        for index in 0..self.answers.points.len() {
            by.fill(motion.displacement_at(index, 0.0).total());
            self.answers
                .add_displacement(index, &by, track.stop(index).normal);
        }
    }

    /// The branch used at point `index`.
    pub fn choice_at(&self, index: usize) -> BranchChoice {
        let from = self.choices.partition_point(|(first, _)| *first <= index);
        self.choices[from.max(1) - 1].1
    }
}

/// Cuts whose force-deflection equilibrium is computed point after point.
struct EquilibriumForces<'a> {
    track: &'a Track,
    cuts: CutsAlong,
    equilibrium: ForceEquilibrium,
    summary: EquilibriumSummary,
}

impl EquilibriumForces<'_> {
    fn new(track: &Track, cuts: CutsAlong) -> EquilibriumForces<'_> {
        EquilibriumForces {
            track,
            equilibrium: ForceEquilibrium::new(cuts.cutters[0], cuts.law),
            cuts,
            summary: EquilibriumSummary::default(),
        }
    }

    /// Computes the equilibrium at point `index`, and fills in its wrenches, base.
    fn load(&mut self, index: usize, tip: Option<&TipCompliance>, out: &mut [Wrench]) {
        let base_from_feed = self.track.base_from_feed(index);
        let here = &mut self.cuts.points[index];
        if let Some(tip) = tip {
            let tip = tip.rotated(&base_from_feed.inverse());
            let nominal = [here.mean, here.greatest];
            for force in &nominal[..out.len().min(nominal.len())] {
                // In plane is across the normal of the surface: across the tool, unless it leans.
                let deviation = tip.under(*force);
                let in_plane = here
                    .cut
                    .map_or_else(|| deviation.xy().norm(), |cut| cut.in_plane(&deviation));
                self.summary.largest_nominal = self.summary.largest_nominal.max(in_plane);
            }
            if let Some(cut) = here.cut {
                self.equilibrium.set_cutter(self.cuts.cutters[here.cutter]);
                match self.equilibrium.rest(&cut, here.mean, &tip) {
                    Rest::Settled(force) => [here.mean, here.greatest] = here.under(force),
                    Rest::PulledIn => {
                        self.summary.unsettled += 1;
                        self.summary.first_unsettled.get_or_insert(index);
                    }
                }
            }
        }
        for (out, force) in out.iter_mut().zip([here.mean, here.greatest]) {
            *out = Wrench::from_force(base_from_feed * force);
        }
    }
}

/// The one branch for the whole path, as in [`along_path`]. The cases of `question` are as many as those of `load`.
pub(crate) fn one_branch(
    question: &Question<'_>,
    track: &Track,
    load: &PathLoad,
    watch: Watch<'_>,
) -> Result<BranchChoice, Cancelled> {
    let pattern = match question.choice {
        BranchChoice::Of(pattern) => pattern,
        BranchChoice::Best => BranchPattern::default(),
    };
    let open: Vec<Branch> = Branch::ALL
        .into_iter()
        .filter(|branch| pattern.matches(*branch))
        .collect();
    if !question.arm.robot.inverse().has_branches() || open.len() < 2 {
        return Ok(BranchChoice::Of(pattern));
    }
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let stride = track.len().div_ceil(SPREAD).max(1);
    let count = track.len().div_ceil(stride);
    let homes = track.homes_at((0..count).map(|index| index * stride));
    let mut best: Option<(Score, Branch)> = None;
    for branch in open {
        let requested = Question {
            homes: homes.as_deref(),
            choice: BranchChoice::Of(branch.into()),
            ..*question
        };
        let answers = evaluate_loaded(
            &requested,
            count,
            |i| track.stop(i * stride),
            |i, _, out| track.wrenches(load, i * stride, out),
            quiet,
        )?;
        let score = Score::of(&answers, question.choice);
        if best.is_none_or(|(before, _)| score.beats(&before)) {
            best = Some((score, branch));
        }
    }
    let branch = best.map_or(pattern, |(_, branch)| branch.into());
    Ok(BranchChoice::Of(branch))
}

/// Quality of a branch for a path.
#[derive(Clone, Copy, Debug)]
struct Score {
    within_limits: usize,
    reached: usize,
    /// Larger is better.
    finer: f64,
}

impl Score {
    fn of(answers: &Answers, choice: BranchChoice) -> Score {
        let evaluations = || answers.evaluations().map(|(_, evaluation)| evaluation);
        let margin = evaluations()
            .map(|evaluation| evaluation.limit_margin)
            .fold(f64::INFINITY, f64::min);
        let largest = evaluations()
            .map(|evaluation| evaluation.in_plane)
            .fold(0.0, f64::max);
        Score {
            within_limits: evaluations()
                .filter(|evaluation| evaluation.within_limits())
                .count(),
            reached: evaluations().count(),
            finer: if choice == BranchChoice::Best {
                -largest
            } else {
                margin
            },
        }
    }

    fn beats(&self, other: &Score) -> bool {
        let count = |score: &Score| (score.within_limits, score.reached);
        count(self) > count(other) || (count(self) == count(other) && self.finer > other.finer)
    }
}
