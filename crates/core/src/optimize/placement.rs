//! Score of a placement of the part, for placement searches.
//!
//! A placement ([`PartPlacement`]) is the pose of the part in base and a constant additional spin of the tool. The arm
//! uses one branch for the whole path, the best of the open ones; for holes, each point uses its own posture
//! ([`PostureSelection`]). Feasibility has priority: the placement with fewer unreachable points is better; for the
//! same number, the one with the lower cost.
//!
//! | objective | cost, m |
//! |---|---|
//! | [`Objective::Worst`] | largest selected component of the deviation, over all points and load cases |
//! | [`Objective::Mean`] | mean over the points of the largest of the load cases |
//! | [`Objective::Above`] | mean excess over the tolerance, plus a thousandth of the mean |
//!
//! Forces are those of the nominal path, as in [`super::posture`]; the analysis of the placement found recomputes them.

use rayon::prelude::*;

use super::gain::Gain;
use super::posture_search::{Component, Objective};
use super::rank_by::{RankBy, changed_arms};
use super::steps::Steps;
use super::walk::WITHIN;
use crate::kernel::{
    PartPlacement, PathTotals, PathWrenches, PlacedBranch, PlacedPath, PlacedPoint, PlacementClearance,
    PlacementEvaluator, PlacementScreen, PostureMargins, Question, SLOTS, WrenchAxes,
};
use crate::load::{LoadFrame, PathLoad};
use crate::path::LoadedTrack;
use crate::robot::{Branch, BranchPattern};
use crate::source::{Arm, ChangedArm};
use crate::watch::{Cancelled, Watch};

/// Settings of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementObjective {
    /// Component of the deviation.
    pub component: Component,
    /// Objective.
    pub objective: Objective,
    /// Open branches, of an arm with branch names.
    pub branches: BranchPattern,
    /// Smallest distance of every joint from its limits, of the elbow from stretched and of the wrist from straight,
    /// rad.
    pub margin: f64,
    /// Smallest bend of the wrist, rad.
    pub wrist: f64,
    /// Criterion that placements are ranked by.
    pub rank_by: RankBy,
    /// How postures are selected.
    pub selection: PostureSelection,
}

/// How postures are selected along a path or at holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PostureSelection {
    /// One branch for all points, with the spin of the placement: a path.
    ForPath,
    /// The best branch and the best of these spins for each point: holes.
    PerPoint(Steps),
}

/// A path that can be placed.
#[derive(Clone, Copy, Debug)]
pub struct Placeable<'a> {
    /// The arm, and the home positions of its redundant joints; other fields are not used.
    pub question: &'a Question<'a>,
    /// The points relative to the part.
    pub path: &'a PlacedPath,
    /// Settings of the search.
    pub objective: PlacementObjective,
}

/// The score of a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Points that are unreachable in the best branch.
    pub unreachable: usize,
    /// Ranking value over the reachable points: the cost in m, or as in [`RankBy`].
    pub cost: f64,
    /// That branch; `None` for arms without branch names.
    pub branch: Option<Branch>,
}

/// The cost of a placement, and its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementEvaluation {
    /// The score with nominal values: its cost in m.
    pub score: Score,
    /// Standard uncertainty of the cost, m; `None` where it is not known, or points are unreachable.
    pub uncertainty: Option<f64>,
}

/// The points of `path` with these indices, relative to its part, with their wrenches.
///
/// # Panics
/// If the load does not [cover](PathLoad::covers) the points of the track, or there is no index.
pub fn on_part(path: LoadedTrack<'_>, component: Component, indices: &[usize]) -> PlacedPath {
    let LoadedTrack { track, load } = path;
    assert!(load.covers(track.len()), "a load for each point of the track");
    let part_from_base = track.base_from_part.inverse();
    let points = indices.iter().map(|index| {
        let stop = track.stop(*index);
        let along = component.along(track, *index, stop.normal);
        PlacedPoint {
            part_from_tool: part_from_base * stop.base_from_tool,
            along: along.map(|along| part_from_base * along),
        }
    });
    let wrench_axes = match load {
        PathLoad::Cases(load) if load.frame == LoadFrame::Base => WrenchAxes::Base,
        PathLoad::OfEach { frame, .. } if *frame == LoadFrame::Base => WrenchAxes::Base,
        _ => WrenchAxes::Part,
    };
    let cases = load.case_count();
    let at = |index: usize| {
        let mut wrenches = track.loaded_stop(index, load).cases;
        if wrench_axes == WrenchAxes::Part {
            for wrench in &mut wrenches {
                wrench.force = part_from_base * wrench.force;
                wrench.moment = part_from_base * wrench.moment;
            }
        }
        wrenches
    };
    let wrenches = match load.is_steady() {
        true => at(indices[0]),
        false => indices.iter().flat_map(|index| at(*index)).collect(),
    };
    let wrenches_on_path = PathWrenches {
        wrench_axes,
        cases,
        wrenches,
    };
    PlacedPath::new(points.collect(), wrenches_on_path)
}

impl Score {
    /// Without any placement.
    pub const NONE: Score = Score {
        unreachable: usize::MAX,
        cost: f64::INFINITY,
        branch: None,
    };

    /// Whether it is better than `other`.
    pub fn beats(&self, other: &Score) -> bool {
        self.unreachable < other.unreachable
            || (self.unreachable == other.unreachable && self.cost < other.cost)
    }
}

impl PlacementEvaluation {
    /// Probability that the cost is above `tolerance` (m), for a normal distribution with its uncertainty; `None` where
    /// this is not known.
    pub fn probability_above(&self, tolerance: f64) -> Option<f64> {
        let room = tolerance - self.score.cost;
        let u = self.uncertainty.filter(|u| *u > 0.0)?;
        Some(0.5 * libm::erfc(room / (u * std::f64::consts::SQRT_2)))
    }
}

impl Placeable<'_> {
    /// The score of each placement; `None` where it is proven worse than `bar` before all points are evaluated. The
    /// same for any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels; it counts placements.
    pub fn scores(
        &self,
        places: &[PartPlacement],
        bar: Option<&Score>,
        watch: Watch<'_>,
    ) -> Result<Vec<Option<Score>>, Cancelled> {
        let off = self.arms_off();
        let scores = places.par_iter().map_init(
            || self.evaluators(&off),
            |evaluators, placement| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                let score = self.score(evaluators, placement, bar);
                (watch.finished)(1);
                Ok(score)
            },
        );
        scores.collect()
    }

    /// The cost of this placement and its uncertainty, independent of the ranking criterion.
    pub fn evaluated(&self, placement: &PartPlacement) -> PlacementEvaluation {
        let off = changed_arms(&self.question.arm);
        let mut evaluators = self.evaluators(&off);
        let nothing = PlacementEvaluation {
            score: Score::NONE,
            uncertainty: None,
        };
        let score = self.best_branch(&mut evaluators, placement, self.objective.branches, None);
        score.map_or(nothing, |score| PlacementEvaluation {
            score,
            uncertainty: (self.question.arm.has_known_uncertainty() && score.unreachable == 0)
                .then(|| self.uncertainty(&mut evaluators, placement, &score)),
        })
    }

    /// The gain of the cost from a placement to that of `other`, each in the best of its open branches with nominal
    /// values; the arm and the settings are those of the first.
    pub fn gain(
        &self,
        before: (&PartPlacement, BranchPattern),
        other: &Placeable<'_>,
        after: (&PartPlacement, BranchPattern),
    ) -> Gain {
        let off = changed_arms(&self.question.arm);
        let mut evaluators = self.evaluators(&off);
        let ways = [(self, before), (other, after)].map(|(placeable, (placement, open))| {
            let score = placeable.nominal(&mut evaluators.nominal, placement, open, None);
            let score = score.unwrap_or(Score::NONE);
            (
                placeable,
                placement,
                score.branch.map_or(open, BranchPattern::from),
                score,
            )
        });
        let [before, after] = ways.map(|(.., score)| score.cost);
        let mut gain = Gain {
            before,
            after,
            uncertainty: None,
        };
        if !self.question.arm.has_known_uncertainty() {
            return gain;
        }
        let structure = &self.question.arm.model.structure;
        let by_load = gain.by() * self.question.uncertainty.relative;
        let by_model = structure.model_error * gain.before.hypot(gain.after);
        let by_arms = evaluators.off.iter_mut().map(|evaluator| {
            let [before, after] = ways.map(|(placeable, placement, branch, score)| {
                let there = placeable.nominal(evaluator, placement, branch, None);
                there.map_or(0.0, |there| there.cost - score.cost)
            });
            before - after
        });
        gain.uncertainty = Some(by_arms.fold(by_load.hypot(by_model), f64::hypot));
        gain
    }

    /// Arms changed by one standard uncertainty, where the ranking needs the uncertainty of the cost.
    fn arms_off(&self) -> Vec<ChangedArm> {
        match self.objective.rank_by {
            RankBy::Nominal => Vec::new(),
            RankBy::PlusTwoSigma | RankBy::WithinTolerance(_) => changed_arms(&self.question.arm),
        }
    }

    fn evaluators<'s>(&'s self, off: &'s [ChangedArm]) -> Evaluators<'s> {
        let margins = PostureMargins {
            margin: self.objective.margin,
            wrist: self.objective.wrist,
            tolerance: match self.objective.objective {
                Objective::Above(tolerance) => tolerance,
                Objective::Worst | Objective::Mean => 0.0,
            },
        };
        let arm = self.question.arm;
        let home = self.question.home;
        let is_path = self.objective.selection == PostureSelection::ForPath;
        let of_each = || self.question.clearance_check().filter(|_| !is_path);
        let evaluator =
            |arm: Arm<'s>| PlacementEvaluator::new(arm, home, margins).keeping_clear(arm, home, of_each());
        Evaluators {
            screen: PlacementScreen::new(arm, margins).filter(|_| is_path),
            clearance: PlacementClearance::new(self.question, margins).filter(|_| is_path),
            nominal: evaluator(arm),
            off: off
                .iter()
                .map(|changed| evaluator(changed.arm(arm.robot)))
                .collect(),
        }
    }

    fn score(
        &self,
        evaluators: &mut Evaluators<'_>,
        placement: &PartPlacement,
        bar: Option<&Score>,
    ) -> Option<Score> {
        // The cost alone never exceeds cost plus uncertainty. A probability cannot be bounded before all points are
        // evaluated.
        let bar = bar.map(|bar| match self.objective.rank_by {
            RankBy::Nominal | RankBy::PlusTwoSigma => *bar,
            RankBy::WithinTolerance(_) => Score {
                cost: f64::INFINITY,
                ..*bar
            },
        });
        if let (Some(screen), Some(bar)) = (
            &mut evaluators.screen,
            bar.filter(|bar| bar.unreachable < usize::MAX),
        ) {
            let error = (1.0 + WITHIN) * screen.rounding_error(self.path);
            // With unreachable points the screening cost is not valid: points unreachable by limits and otherwise are
            // included twice.
            let keep = |totals: &PathTotals| {
                (totals.unreachable == bar.unreachable && totals.unreachable > 0)
                    || self.can_beat(&bar, error, totals)
            };
            if !screen.may_pass(self.path, placement, self.objective.branches, keep) {
                return None;
            }
        }
        let score = self.best_branch(evaluators, placement, self.objective.branches, bar.as_ref())?;
        let uncertainty = match self.objective.rank_by {
            RankBy::Nominal => 0.0,
            RankBy::PlusTwoSigma | RankBy::WithinTolerance(_) => {
                self.uncertainty(evaluators, placement, &score)
            }
        };
        Some(Score {
            cost: self.objective.rank_by.compared(score.cost, uncertainty),
            ..score
        })
    }

    /// Standard uncertainty of the cost of a placement in its branch, m; zero where points are unreachable.
    fn uncertainty(&self, evaluators: &mut Evaluators<'_>, placement: &PartPlacement, score: &Score) -> f64 {
        if score.unreachable > 0 {
            return 0.0;
        }
        let branch = score.branch.map_or(self.objective.branches, BranchPattern::from);
        let structure = &self.question.arm.model.structure;
        let in_proportion = score.cost * self.question.uncertainty.relative.hypot(structure.model_error);
        let off = evaluators.off.iter_mut().map(|evaluator| {
            let cost = self.nominal(evaluator, placement, branch, None);
            cost.map_or(0.0, |there| there.cost - score.cost)
        });
        off.fold(in_proportion.hypot(structure.repeatability), f64::hypot)
    }

    /// The score of the placement in the best of these branches, with nominal values and the demanded clearance.
    ///
    /// Clearance only increases the number of lost points, and is checked of the branch that is best without it; the next one is
    /// checked if it may be better.
    fn best_branch(
        &self,
        evaluators: &mut Evaluators<'_>,
        placement: &PartPlacement,
        branches: BranchPattern,
        bar: Option<&Score>,
    ) -> Option<Score> {
        let Some(clearance) = &mut evaluators.clearance else {
            return self.nominal(&mut evaluators.nominal, placement, branches, bar);
        };
        let mut left = self.each_branch(&mut evaluators.nominal, placement, branches, bar);
        let mut best: Option<Score> = None;
        let first = |scores: &[Score]| {
            (0..scores.len()).reduce(|best, other| {
                if scores[other].beats(&scores[best]) {
                    other
                } else {
                    best
                }
            })
        };
        while let Some(next) = first(&left) {
            let score = left.remove(next);
            let bars = [best.as_ref(), bar];
            if bars.into_iter().flatten().any(|bar| !score.beats(bar)) {
                break;
            }
            let Some(branch) = score.branch else {
                return Some(score);
            };
            let placed = PlacedBranch {
                path: self.path,
                placement,
                branch,
            };
            let most = bars.into_iter().flatten().map(|bar| bar.unreachable).min();
            let checked = Score {
                unreachable: clearance
                    .lost(placed, most.unwrap_or(usize::MAX))
                    .max(score.unreachable),
                ..score
            };
            if bars.into_iter().flatten().all(|bar| checked.beats(bar)) {
                best = Some(checked);
            }
        }
        best
    }

    /// The score of the placement with this evaluator, with nominal values and without the clearance of a path.
    fn nominal(
        &self,
        evaluator: &mut PlacementEvaluator<'_>,
        placement: &PartPlacement,
        branches: BranchPattern,
        bar: Option<&Score>,
    ) -> Option<Score> {
        let scores = self.each_branch(evaluator, placement, branches, bar);
        scores
            .into_iter()
            .reduce(|best, score| if score.beats(&best) { score } else { best })
    }

    /// The same of each branch that may beat `bar`; of holes, and of arms without named branches, a single one.
    fn each_branch(
        &self,
        evaluator: &mut PlacementEvaluator<'_>,
        placement: &PartPlacement,
        branches: BranchPattern,
        bar: Option<&Score>,
    ) -> Vec<Score> {
        if let PostureSelection::PerPoint(spins) = self.objective.selection {
            let spins: Vec<f64> = (0..spins.count).map(|index| spins.at(index)).collect();
            let totals = evaluator.evaluate_each(self.path, placement, branches, &spins);
            return vec![Score {
                unreachable: totals.unreachable,
                cost: self.cost(&totals),
                branch: None,
            }];
        }
        let named = evaluator.has_branches();
        let keep = |totals: &PathTotals| bar.is_none_or(|bar| self.can_beat(bar, 0.0, totals));
        let totals = evaluator.evaluate(self.path, placement, branches, keep);
        let of_slot = |slot: usize| {
            let totals = totals[slot].as_ref()?;
            Some(Score {
                unreachable: totals.unreachable,
                cost: self.cost(totals),
                branch: named.then_some(Branch::ALL[slot]),
            })
        };
        (0..SLOTS).filter_map(of_slot).collect()
    }

    /// Whether a posture can still beat `bar` if its cost so far is too high by at most `error` (m).
    fn can_beat(&self, bar: &Score, error: f64, totals: &PathTotals) -> bool {
        totals.unreachable < bar.unreachable
            || (totals.unreachable == bar.unreachable && self.cost(totals) - error < bar.cost)
    }

    /// Cost of the points so far, as a part of the total.
    fn cost(&self, totals: &PathTotals) -> f64 {
        let count = self.path.len() as f64;
        match self.objective.objective {
            Objective::Worst => totals.worst,
            Objective::Mean => totals.sum / count,
            Objective::Above(_) => (totals.above + WITHIN * totals.sum) / count,
        }
    }
}

/// One per thread: for the nominal arm, and for arms changed by one standard uncertainty.
struct Evaluators<'a> {
    /// Used first where there is a bar and lanes support the path.
    screen: Option<PlacementScreen>,
    nominal: PlacementEvaluator<'a>,
    /// Of a path, where a clearance is demanded.
    clearance: Option<PlacementClearance<'a>>,
    off: Vec<PlacementEvaluator<'a>>,
}

#[cfg(test)]
mod tests;
