//! Where should the part lie? What a place is worth, for a search to go by.
//!
//! A place ([`PartPlacement`]) is where the part lies in base and how far the tool is turned about its axis, the same all along. The
//! arm takes one branch for the whole path, the best of those left open; holes are held each for itself ([`Holding`]). Feasibility comes first: of two places that with
//! fewer points lost is better, and of two that lose none that with the lesser cost.
//!
//! | goal | cost, m |
//! |---|---|
//! | [`Goal::Worst`] | largest deviation that counts, over all points and load cases |
//! | [`Goal::Mean`] | mean over the points of the largest of the cases |
//! | [`Goal::Above`] | mean of what is above the limit, and a thousandth of the mean |
//!
//! Forces are those of the path as drawn, as in [`super::posture`]; the answer at the place that was found looks at them again.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use rayon::prelude::*;

use super::posture::{Component, Objective, Spins, WITHIN};
use super::sureness::{RankBy, one_off};
use crate::frame::{Isometry, tool_orientation};
use crate::kernel::{
    Glance, Judge, Judged, Keeping, PartPlacement, PlacedPath, Pushes, Question, SLOTS, Sighted, ToldIn,
};
use crate::load::{LoadFrame, PathLoad};
use crate::path::{Spin, ToldSpin, Track};
use crate::robot::{Branch, BranchPattern, JointCompliance};
use crate::source::Arm;
use crate::watch::{Cancelled, Watch};

/// What is searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementObjective {
    /// Which part of the deviation counts.
    pub component: Component,
    /// What shall be least.
    pub objective: Objective,
    /// Branches that may be taken, of an arm whose branches have names.
    pub branches: BranchPattern,
    /// How far every joint stays from its limits, the elbow from stretched and the wrist from straight, rad.
    pub margin: f64,
    /// Least bend of the wrist, rad.
    pub wrist: f64,
    /// What places are compared by.
    pub rank_by: RankBy,
    /// How the points are held.
    pub holding: Holding,
}

/// How the points are held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Holding {
    /// All in one branch, with the turn of the tool that the place has: a path.
    InOneBranch,
    /// Each in the best of the branches and of these turns of the tool: holes.
    EachForItself(Spins),
}

/// A path that may be placed.
#[derive(Clone, Copy, Debug)]
pub struct Placeable<'a> {
    /// The arm, and where its spare joints are drawn to; what else it says is not looked at.
    pub question: &'a Question<'a>,
    /// The points as they are on the part.
    pub path: &'a PlacedPath,
    /// What is searched for.
    pub objective: PlacementObjective,
}

/// What a place is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Points that the best branch does not hold.
    pub lost: usize,
    /// What it is compared by, of the points that it holds: the cost in m, or as [`RankBy`] says.
    pub cost: f64,
    /// That branch; `None` for arms without names of branches.
    pub branch: Option<Branch>,
}

/// The cost of a place, and how sure it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementEvaluation {
    /// What the place is worth, as if all were known: its cost in m.
    pub score: Score,
    /// Standard uncertainty of the cost, m; zero where points are lost.
    pub uncertainty: f64,
}

/// The points of `track` with these indices, as they are on its part, with what pushes there.
///
/// # Panics
/// If `load` does not [cover](PathLoad::covers) the points of the track, or there is no index.
pub fn on_part((track, load): (&Track, &PathLoad), component: Component, indices: &[usize]) -> PlacedPath {
    assert!(load.covers(track.len()), "a load for each point of the track");
    let part_from_base = track.base_from_part.inverse();
    let points = indices.iter().map(|index| {
        let stop = track.stop(*index);
        let along = component.along((track, *index), stop.normal);
        Sighted {
            part_from_tool: part_from_base * stop.base_from_tool,
            along: along.map(|along| part_from_base * along),
        }
    });
    let told_in = match load {
        PathLoad::Cases(load) if load.frame == LoadFrame::Base => ToldIn::Base,
        PathLoad::OfEach { frame, .. } if *frame == LoadFrame::Base => ToldIn::Base,
        _ => ToldIn::Part,
    };
    let cases = load.case_count();
    let at = |index: usize| {
        let mut wrenches = track.loaded_stop(index, load).cases;
        if told_in == ToldIn::Part {
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
    let pushes = Pushes {
        told_in,
        cases,
        wrenches,
    };
    PlacedPath::new(points.collect(), pushes)
}

/// How a tool is turned about its axis where its part is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolTurn {
    /// As the part is: along the feed, where whole orientations are told, and where no axis is that of all points.
    WithPart,
    /// As [`tool_orientation`] has it in base, and by this angle (rad) more.
    InBase {
        /// The tool as it is judged on the part.
        part_from_tool: UnitQuaternion<f64>,
        /// That angle.
        spin: f64,
    },
}

impl ToolTurn {
    /// That of the tool along `track`.
    pub fn of(track: &Track) -> ToolTurn {
        let first = track
            .path
            .points
            .first()
            .filter(|_| track.steady_normal().is_some());
        // Under one axis all points turn alike: what holds of the first holds of all.
        let spin = first.and_then(|first| match track.placing.spin {
            Spin::Fixed(angle) => Some(angle),
            Spin::Given(angle) => match first.spin {
                Some(ToldSpin::Angle(given)) => Some(angle + given),
                // A whole orientation is told on the part.
                Some(ToldSpin::Orientation(_)) => None,
                None => Some(angle),
            },
            Spin::AlongFeed(_) => None,
        });
        match spin {
            Some(spin) => ToolTurn::InBase {
                part_from_tool: (track.base_from_part.inverse() * track.stop(0).base_from_tool).rotation,
                spin: spin + track.spins.as_ref().map_or(0.0, |spins| spins[0]),
            },
            None => ToolTurn::WithPart,
        }
    }

    /// The place where a part lies so, with the tool turned by `spin` (rad) beside the turn it has there.
    pub fn placement(&self, base_from_part: Isometry, spin: f64) -> PartPlacement {
        let more = match self {
            ToolTurn::WithPart => 0.0,
            ToolTurn::InBase { part_from_tool, spin } => {
                let judged = base_from_part.rotation * part_from_tool;
                let axis = Unit::new_normalize(judged * Vector3::z());
                let turn = judged.inverse() * tool_orientation(axis, *spin);
                2.0 * turn.k.atan2(turn.w)
            }
        };
        PartPlacement {
            base_from_part,
            spin: spin + more,
            rail: None,
        }
    }
}

impl Score {
    /// Of no place at all.
    pub const NONE: Score = Score {
        lost: usize::MAX,
        cost: f64::INFINITY,
        branch: None,
    };

    /// Whether it is better than `other`.
    pub fn beats(&self, other: &Score) -> bool {
        self.lost < other.lost || (self.lost == other.lost && self.cost < other.cost)
    }
}

impl PlacementEvaluation {
    /// How probably the cost is above `limit` (m), normally distributed with its uncertainty; `None` where it is sure.
    pub fn probability_above(&self, limit: f64) -> Option<f64> {
        let room = limit - self.score.cost;
        let scaled = room / (self.uncertainty * std::f64::consts::SQRT_2);
        (self.uncertainty > 0.0).then(|| 0.5 * libm::erfc(scaled))
    }
}

impl Placeable<'_> {
    /// What each of these places is worth; `None` where it proved to be worth less than `bar` before all points were looked
    /// at. The same on any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch says so; it hears of places.
    pub fn scores(
        &self,
        places: &[PartPlacement],
        bar: Option<&Score>,
        watch: Watch<'_>,
    ) -> Result<Vec<Option<Score>>, Cancelled> {
        let off = self.arms_off();
        let judged = places.par_iter().map_init(
            || self.judges(&off),
            |judges, placement| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                let score = self.score(judges, placement, bar);
                (watch.finished)(1);
                Ok(score)
            },
        );
        judged.collect()
    }

    /// The cost of this place and how sure it is, whatever places are compared by.
    pub fn appraised(&self, placement: &PartPlacement) -> PlacementEvaluation {
        let off = one_off(&self.question.arm);
        let mut judges = self.judges(&off);
        let nothing = PlacementEvaluation {
            score: Score::NONE,
            uncertainty: 0.0,
        };
        let score = self.nominal(&mut judges.nominal, (placement, self.objective.branches), None);
        score.map_or(nothing, |score| PlacementEvaluation {
            score,
            uncertainty: self.uncertainty(&mut judges, placement, &score),
        })
    }

    /// Arms that are one standard uncertainty off, where it matters how sure a cost is.
    fn arms_off(&self) -> Vec<Vec<JointCompliance>> {
        match self.objective.rank_by {
            RankBy::Nominal => Vec::new(),
            RankBy::PlusTwoSigma | RankBy::WithinLimit(_) => one_off(&self.question.arm),
        }
    }

    fn judges<'s>(&'s self, off: &'s [Vec<JointCompliance>]) -> Judges<'s> {
        let keeping = Keeping {
            margin: self.objective.margin,
            wrist: self.objective.wrist,
            limit: match self.objective.objective {
                Objective::Above(limit) => limit,
                Objective::Worst | Objective::Mean => 0.0,
            },
        };
        let arm = self.question.arm;
        let home = self.question.home;
        let judge = |compliance| Judge::new(Arm { compliance, ..arm }, home, keeping);
        Judges {
            glance: Glance::new(arm, keeping).filter(|_| self.objective.holding == Holding::InOneBranch),
            nominal: judge(arm.compliance),
            off: off
                .iter()
                .map(|compliance| judge(compliance.as_slice()))
                .collect(),
        }
    }

    fn score(&self, judges: &mut Judges<'_>, placement: &PartPlacement, bar: Option<&Score>) -> Option<Score> {
        // The cost alone is never above cost and uncertainty; of a probability it says nothing before all points are in.
        let bar = bar.map(|bar| match self.objective.rank_by {
            RankBy::Nominal | RankBy::PlusTwoSigma => *bar,
            RankBy::WithinLimit(_) => Score {
                cost: f64::INFINITY,
                ..*bar
            },
        });
        if let (Some(glance), Some(bar)) = (&mut judges.glance, bar.filter(|bar| bar.lost < usize::MAX)) {
            let strays = (1.0 + WITHIN) * glance.strays(self.path);
            // Where points are lost it does not tell the cost: it counts points that are lost twice, by limits and otherwise.
            let worth = |judged: &Judged| {
                (judged.lost == bar.lost && judged.lost > 0) || self.worth(&bar, strays, judged)
            };
            if !glance.may_be_worth(self.path, placement, self.objective.branches, worth) {
                return None;
            }
        }
        let score = self.nominal(&mut judges.nominal, (placement, self.objective.branches), bar.as_ref())?;
        let uncertainty = match self.objective.rank_by {
            RankBy::Nominal => 0.0,
            RankBy::PlusTwoSigma | RankBy::WithinLimit(_) => self.uncertainty(judges, placement, &score),
        };
        Some(Score {
            cost: self.objective.rank_by.compared(score.cost, uncertainty),
            ..score
        })
    }

    /// Standard uncertainty of the cost of a place in its branch, m; zero where points are lost.
    fn uncertainty(&self, judges: &mut Judges<'_>, placement: &PartPlacement, score: &Score) -> f64 {
        if score.lost > 0 {
            return 0.0;
        }
        let branch = score.branch.map_or(self.objective.branches, BranchPattern::from);
        let structure = &self.question.arm.model.structure;
        let in_proportion = score.cost * self.question.uncertainty.relative.hypot(structure.model_error);
        let off = judges.off.iter_mut().map(|judge| {
            let cost = self.nominal(judge, (placement, branch), None);
            cost.map_or(0.0, |there| there.cost - score.cost)
        });
        off.fold(in_proportion.hypot(structure.repeatability), f64::hypot)
    }

    /// What the place is worth to this judge, as if all were known.
    fn nominal(
        &self,
        judge: &mut Judge<'_>,
        (placement, branches): (&PartPlacement, BranchPattern),
        bar: Option<&Score>,
    ) -> Option<Score> {
        if let Holding::EachForItself(spins) = self.objective.holding {
            let spins: Vec<f64> = (0..spins.count).map(|index| spins.at(index)).collect();
            let judged = judge.judge_each(self.path, placement, branches, &spins);
            return Some(Score {
                lost: judged.lost,
                cost: self.cost(&judged),
                branch: None,
            });
        }
        let named = judge.tells_branches();
        let worth = |judged: &Judged| bar.is_none_or(|bar| self.worth(bar, 0.0, judged));
        let judged = judge.judge(self.path, placement, branches, worth);
        let mut best: Option<Score> = None;
        for slot in 0..SLOTS {
            let Some(judged) = &judged[slot] else { continue };
            let score = Score {
                lost: judged.lost,
                cost: self.cost(judged),
                branch: named.then_some(Branch::ALL[slot]),
            };
            if best.is_none_or(|best| score.beats(&best)) {
                best = Some(score);
            }
        }
        best
    }

    /// Whether a posture may still beat `bar` if its cost so far is `strays` (m) above the true one.
    fn worth(&self, bar: &Score, strays: f64, judged: &Judged) -> bool {
        judged.lost < bar.lost || (judged.lost == bar.lost && self.cost(judged) - strays < bar.cost)
    }

    /// Cost of the points so far, as a part of all.
    fn cost(&self, judged: &Judged) -> f64 {
        let count = self.path.len() as f64;
        match self.objective.objective {
            Objective::Worst => judged.worst,
            Objective::Mean => judged.sum / count,
            Objective::Above(_) => (judged.above + WITHIN * judged.sum) / count,
        }
    }
}

/// One a thread: of the arm as it is, and of arms one standard uncertainty off.
struct Judges<'a> {
    /// Looks first where there is a bar and lanes answer for the path.
    glance: Option<Glance>,
    nominal: Judge<'a>,
    off: Vec<Judge<'a>>,
}

#[cfg(test)]
mod tests;
