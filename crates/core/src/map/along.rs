//! Deviation along a path: along the track, across it and along the tool, for loads that may turn with the feed.
//!
//! A path is followed in one posture: the branch is chosen once, from points spread over the path, so the arm does not
//! change its elbow in the middle of a part. A load that is the same everywhere, under a tool that never leans, is answered
//! with shares and uncertainties at every point; any other load point by point without them. Where a tool cuts, force and
//! deviation come to rest at every point ([`crate::load::force_equilibrium`]); the branch is chosen under the forces of the path as
//! drawn.
//!
//! Backlash and geometry come on top of what the load does (`unloaded`); force and depth of a cut do not answer to them.

use std::ops::Range;

use super::turns;
use super::unloaded::{Unloaded, move_unloaded};
use crate::kernel::{Answers, BranchChoice, Question, evaluate_in_order, evaluate_loaded};
use crate::load::{CutsAlong, PathLoad, Rest, ForceEquilibrium, TipCompliance};
use crate::path::Track;
use crate::robot::{Branch, BranchPattern};
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// Points of the path that decide on the branch.
const SPREAD: usize = 400;

/// Answers along a path.
#[derive(Clone, Debug)]
pub struct AlongPath {
    /// The branch it was followed in, each from the point with that index on; the first from point 0.
    pub choices: Vec<(usize, BranchChoice)>,
    /// What came out at each point; in-plane is across the tool, normal along it. Shares and uncertainties where the load
    /// is the same at all points, the tool does not lean, and nothing but load and gravity moves it
    /// ([`Answers::share_count`] is zero otherwise).
    pub answers: Answers,
    /// What pushed: of cuts the forces at rest, with the cuts as drawn.
    pub load: PathLoad,
    /// How force and deviation came to rest; `None` where no tool cuts, or the load changes the arm.
    pub rested: Option<Rested>,
    /// What moved the tool beside the load, which `answers` have too; `None` where nothing does.
    pub unloaded: Option<Unloaded>,
}

/// How force and deviation came to rest along a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rested {
    /// Largest in-plane deviation if the forces did not give way, m.
    pub largest_if_drawn: f64,
    /// Points at which they do not rest: the cut draws the tool in.
    pub unsettled: usize,
    /// Index of the first of them.
    pub first_unsettled: Option<usize>,
}

/// The answers along `track` under `load`. What `question` says of cases and normal is not looked at; of its doubt, where
/// uncertainties are told.
///
/// Of several branches that match (or of all, for the best one) the arm keeps the one in which it reaches most points
/// within its limits, judged at some 400 points spread over the path; of equal ones for [`BranchChoice::Best`] the one with
/// the least of the largest in-plane deviations, otherwise the one with the most room to its limits.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
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
    let choice = chosen(&requested, track, &load, watch)?;
    along_postures(question, (track, load), vec![(0, choice)], watch)
}

/// [`along_path`] in branches that are known: each of `choices` from the point with that index on, in order.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track, or the first choice does not begin at point 0.
pub fn along_postures(
    question: &Question<'_>,
    (track, load): (&Track, PathLoad),
    choices: Vec<(usize, BranchChoice)>,
    watch: Watch<'_>,
) -> Result<AlongPath, Cancelled> {
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(
        choices.first().is_some_and(|(first, _)| *first == 0),
        "a choice from the first point on"
    );
    let mut cases = vec![Wrench::ZERO; load.case_count()];
    let unloaded = question.arm.model.moves_unloaded();
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
    let (mut answers, load, rested) = match load {
        load if steady.is_some() => (runs.steady()?, load, None),
        PathLoad::Cuts(cuts) => {
            let mut resting = Resting::new(track, cuts);
            let answers = runs.loaded(|i, tip, out| resting.load(i, tip, out))?;
            let rested = question.arm.model.is_affine().then_some(resting.rested);
            (answers, PathLoad::Cuts(resting.cuts), rested)
        }
        load => {
            let answers = runs.loaded(|i, _, out| track.wrenches(&load, i, out))?;
            (answers, load, None)
        }
    };
    turns::count_on(question.arm.robot, &mut answers, |i| !track.path.begins(i));
    let unloaded = move_unloaded(&question.arm, (track, &load), &mut answers);
    Ok(AlongPath {
        unloaded,
        choices,
        answers,
        load,
        rested,
    })
}

/// Stretches of a path, each in a branch of its own.
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
            let of_run = |i: usize, tip: Option<&TipCompliance>, out: &mut [Wrench]| load(run.start + i, tip, out);
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
            let requested = Question {
                choice: *choice,
                ..self.question
            };
            answer(&requested, *first..end)
        });
        Ok(Answers::joined(runs.collect::<Result<_, _>>()?))
    }
}

impl AlongPath {
    /// The branch that point `index` was followed in.
    pub fn choice_at(&self, index: usize) -> BranchChoice {
        let from = self.choices.partition_point(|(first, _)| *first <= index);
        self.choices[from.max(1) - 1].1
    }
}

/// Cuts whose forces come to rest point after point.
struct Resting<'a> {
    track: &'a Track,
    cuts: CutsAlong,
    equilibrium: ForceEquilibrium,
    rested: Rested,
}

impl Resting<'_> {
    fn new(track: &Track, cuts: CutsAlong) -> Resting<'_> {
        Resting {
            track,
            equilibrium: ForceEquilibrium::new(cuts.cutters[0], cuts.law),
            cuts,
            rested: Rested::default(),
        }
    }

    /// Brings the force at point `index` to rest, and fills in its wrenches, base.
    fn load(&mut self, index: usize, tip: Option<&TipCompliance>, out: &mut [Wrench]) {
        let base_from_feed = self.track.base_from_feed(index);
        let here = &mut self.cuts.points[index];
        if let Some(tip) = tip {
            let tip = tip.rotated(&base_from_feed.inverse());
            let drawn = [here.mean, here.greatest];
            for force in &drawn[..out.len().min(drawn.len())] {
                // In plane is across the tool.
                let in_plane = tip.under(*force).xy().norm();
                self.rested.largest_if_drawn = self.rested.largest_if_drawn.max(in_plane);
            }
            if let Some(cut) = here.cut {
                self.equilibrium.set_cutter(self.cuts.cutters[here.cutter]);
                match self.equilibrium.rest(&cut, here.mean, &tip) {
                    Rest::Settled(force) => [here.mean, here.greatest] = here.under(force),
                    Rest::PulledIn => {
                        self.rested.unsettled += 1;
                        self.rested.first_unsettled.get_or_insert(index);
                    }
                }
            }
        }
        for (out, force) in out.iter_mut().zip([here.mean, here.greatest]) {
            *out = Wrench::from_force(base_from_feed * force);
        }
    }
}

/// The one branch that the whole path is followed in.
fn chosen(
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
    let mut best: Option<(Score, Branch)> = None;
    for branch in open {
        let requested = Question {
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

/// How good a branch is for a path.
#[derive(Clone, Copy, Debug)]
struct Score {
    within_limits: usize,
    reached: usize,
    /// Larger is better.
    finer: f64,
}

impl Score {
    fn of(answers: &Answers, choice: BranchChoice) -> Score {
        let evaluation = || answers.evaluation().map(|(_, evaluation)| evaluation);
        let margin = evaluation().map(|evaluation| evaluation.limit_margin).fold(f64::INFINITY, f64::min);
        let largest = evaluation().map(|evaluation| evaluation.in_plane).fold(0.0, f64::max);
        Score {
            within_limits: evaluation().filter(|evaluation| evaluation.within_limits()).count(),
            reached: evaluation().count(),
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
