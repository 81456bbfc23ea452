//! A placement as the arm follows the path there.
//!
//! The score of a placement takes each point by itself, under the forces of the nominal path. Three things are
//! left out there, and are added here:
//!
//! - the clearance of arms without named branches, in the postures in which they follow the path;
//! - the whole turns of the joints along a cut: a joint that would have to turn past its limit, less the margin, loses
//!   the points where it does ([`FollowedPath::checked`]; part of the search itself);
//! - the stability of the cut, if it must be stable: a point where it is not is lost. The search evaluates up to [`STABILITY_POINTS`]
//!   points, the result all of them;
//! - the force-deflection equilibrium of a cut ([`FollowedPath::outcome`]): numbers of the result are those of an
//!   analysis of the path there.
//!
//! Holes are single points; of them the score is the result.

use armill_core::clearance::{Conflict, DemandedClearance};
use armill_core::kernel::{BranchChoice, PartPlacement, PlacedPath, Question, evaluate};
use armill_core::load::PathLoad;
use armill_core::map::{along_postures, turns_along};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::optimize::{
    FollowedTrack, Gain, Placeable, PlacementEvaluation, PlacementObjective, PostureSelection, Score,
    gain_along, on_part,
};
use armill_core::path::{LoadedTrack, Track};
use armill_core::robot::{BranchPattern, Unreachable};
use armill_core::spatial::Wrench;
use armill_core::watch::{Cancelled, Watch};
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::vibration::{cuts, stability};
use armill_study::analysis::vibration::Cuts;
use armill_study::analysis::vibration::points::CutStability;

use super::rail::home_at;

/// Joints that are farther than this from their limits at some points stay within them at all, rad.
const FAR: f64 = 0.5;
/// Between points that are so close, the turn of a joint is known, rad.
const CLOSE: f64 = 1.0;

/// Points of the path at which a search evaluates the stability of the cut.
const STABILITY_POINTS: usize = 32;

/// Places that are rounded as in a result are nearer to bodies by less than this, m: 0.05 µm, and 0.00005 deg at 5 m.
const ROUNDED: f64 = 5e-6;

/// The question with a little more clearance: the placement of a result is rounded.
pub(super) fn with_room(question: Question<'_>) -> Question<'_> {
    Question {
        clearance: question.clearance.map(|demanded| DemandedClearance {
            least: demanded.least + ROUNDED,
            ..demanded
        }),
        ..question
    }
}

/// Which points of the path a search evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    Some,
    All,
}

/// The path of a search.
pub(super) struct FollowedPath<'a> {
    pub question: &'a Question<'a>,
    /// Under the forces of the nominal path.
    pub path: LoadedTrack<'a>,
    /// Some of its points.
    pub some: Track,
    /// Its analysis.
    pub analysis: &'a PathAnalysis,
    pub watch: Watch<'a>,
}

/// A path at a placement, as it is followed.
pub(super) struct PathThere {
    pub track: Track,
    pub choices: Vec<(usize, BranchChoice)>,
    /// Where the redundant joints are, if not at those of the study.
    pub home: Option<Vec<f64>>,
}

/// A placement with its result.
pub(super) struct Outcome {
    /// With the forces at equilibrium there.
    pub path: PlacedPath,
    pub placement: PartPlacement,
    pub objective: PlacementObjective,
    /// The path there; none for holes, and where points are lost.
    pub there: Option<PathThere>,
    /// Points without the demanded clearance, if there are any.
    pub conflicts: Option<PathConflicts>,
    /// Stability of its cuts, if the study asks for the vibration and the path is followed.
    pub stability: Option<CutStability>,
    /// Cost and uncertainty.
    pub evaluation: PlacementEvaluation,
}

/// The points of a path that do not keep the demanded clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathConflicts {
    /// How many.
    pub points: usize,
    /// The two bodies where most of the demanded clearance is missing.
    pub bodies: [usize; 2],
    /// Their distance, m; 0 where they touch.
    pub distance: f64,
}

impl FollowedPath<'_> {
    /// The points of the path at this placement where no permitted posture keeps the demanded clearance; `None` without any.
    fn conflicts(
        &self,
        objective: &PlacementObjective,
        placement: &PartPlacement,
        score: &Score,
    ) -> Result<Option<PathConflicts>, Cancelled> {
        let Some(DemandedClearance { least, .. }) = self.question.clearance else {
            return Ok(None);
        };
        let home = self.home(placement);
        let question = Question {
            cases: &[Wrench::ZERO],
            choice: choice_of(score, objective.branches),
            home: home.as_deref().or(self.question.home),
            clearance: self.question.clearance_with_part_at(&placement.base_from_part),
            ..*self.question
        };
        let track = self.path.track.moved(placement.base_from_part, placement.spin);
        let spins: Vec<f64> = match objective.selection {
            PostureSelection::ForPath => vec![0.0],
            PostureSelection::PerPoint(spins) => (0..spins.count).map(|index| spins.at(index)).collect(),
        };
        // Of each point: the least that is missing over all spins, 0 where one can be used.
        let mut missing: Vec<Option<Conflict>> = vec![None; track.len()];
        let mut usable = vec![false; track.len()];
        for spin in spins {
            let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin);
            let pose = |index: usize| track.stop(index).base_from_tool * about;
            let answers = evaluate(&question, track.len(), pose, self.quiet())?;
            for (index, point) in answers.points.iter().enumerate() {
                match *point {
                    Ok(_) => usable[index] = true,
                    Err(Unreachable::InCollision { missing: by, bodies }) => {
                        let here = Conflict { missing: by, bodies };
                        let so_far = &mut missing[index];
                        if so_far.is_none_or(|so_far| by < so_far.missing) {
                            *so_far = Some(here);
                        }
                    }
                    Err(_) => {}
                }
            }
        }
        let lost = missing.iter().zip(&usable).filter(|(_, usable)| !**usable);
        let conflicts: Vec<Conflict> = lost.filter_map(|(conflict, _)| *conflict).collect();
        let largest = conflicts
            .iter()
            .copied()
            .reduce(|most, other| if other.missing > most.missing { other } else { most });
        Ok(largest.map(|largest| PathConflicts {
            points: conflicts.len(),
            bodies: largest.bodies,
            distance: (least - largest.missing).max(0.0),
        }))
    }

    /// `score` with the points that are lost because joints cannot turn as far as the path requires, or because the cut must be stable and
    /// is not.
    pub fn checked(
        &self,
        objective: &PlacementObjective,
        placement: &PartPlacement,
        score: Score,
        extent: Extent,
    ) -> Result<Score, Cancelled> {
        if objective.selection != PostureSelection::ForPath {
            return Ok(score);
        }
        let score = self.turned(objective, placement, score, extent)?;
        // What is lost already has no posture at which to look.
        if score.unreachable > 0 || !self.analysis.setting.must_be_stable() {
            return Ok(score);
        }
        Ok(Score {
            unreachable: self.unstable(objective, placement, &score)?,
            ..score
        })
    }

    /// Of at most [`STABILITY_POINTS`] points those whose cut is not stable.
    fn unstable(
        &self,
        objective: &PlacementObjective,
        placement: &PartPlacement,
        score: &Score,
    ) -> Result<usize, Cancelled> {
        let home = self.home(placement);
        let question = Question {
            cases: &[Wrench::ZERO],
            choice: choice_of(score, objective.branches),
            home: home.as_deref().or(self.question.home),
            clearance: None,
            ..*self.question
        };
        let track = self.path.track.moved(placement.base_from_part, placement.spin);
        let stride = track.len().div_ceil(STABILITY_POINTS).max(1);
        let count = track.len().div_ceil(stride);
        let pose = |index: usize| track.stop(index * stride).base_from_tool;
        let answers = evaluate(&question, count, pose, self.quiet())?;
        let Some(cuts) = cuts(self.analysis, &track, self.path.load) else {
            return Ok(0);
        };
        let of_some = Cuts {
            at: Box::new(|index| (cuts.at)(index * stride)),
            are_followed: false,
        };
        let found = CutStability::of(
            self.question.arm.robot,
            &self.analysis.setting,
            &answers,
            &of_some,
        );
        Ok(found.map_or(0, |found| found.unstable))
    }

    /// `score` with the points that are lost because joints cannot turn as far as the path requires.
    fn turned(
        &self,
        objective: &PlacementObjective,
        placement: &PartPlacement,
        score: Score,
        extent: Extent,
    ) -> Result<Score, Cancelled> {
        let lost = |track: &Track| {
            let home = self.home(placement);
            let question = Question {
                choice: choice_of(&score, objective.branches),
                home: home.as_deref().or(self.question.home),
                // Scores of named branches have it.
                clearance: self
                    .question
                    .clearance_with_part_at(&placement.base_from_part)
                    .filter(|_| score.branch.is_none()),
                ..*self.question
            };
            let there = track.moved(placement.base_from_part, placement.spin);
            turns_along(&question, &there, objective.margin, self.quiet())
        };
        let quick = lost(&self.some)?;
        let lost = match extent {
            _ if quick.lost == 0 && quick.room > FAR => 0,
            Extent::Some if quick.largest_step < CLOSE => quick.lost,
            _ => lost(self.path.track)?.lost,
        };
        Ok(Score {
            unreachable: score.unreachable.max(lost),
            ..score
        })
    }

    /// The result of a placement in the best of the branches of `objective`.
    pub fn outcome(
        &self,
        objective: PlacementObjective,
        placement: &PartPlacement,
    ) -> Result<Outcome, Cancelled> {
        let LoadedTrack { track, load } = self.path;
        let all: Vec<usize> = (0..track.len()).collect();
        let nominal = on_part(self.path, objective.component, &all);
        let placeable = |path| Placeable {
            question: self.question,
            path,
            objective,
        };
        let first = placeable(&nominal).evaluated(placement);
        let score = self.turned(&objective, placement, first.score, Extent::All)?;
        let is_path = objective.selection == PostureSelection::ForPath;
        if !is_path || score.unreachable > 0 {
            return Ok(Outcome {
                conflicts: match score.unreachable {
                    0 => None,
                    _ => self.conflicts(&objective, placement, &score)?,
                },
                path: nominal,
                placement: *placement,
                objective,
                there: None,
                stability: None,
                evaluation: PlacementEvaluation {
                    score,
                    uncertainty: match score.unreachable {
                        0 => first.uncertainty,
                        _ => None,
                    },
                },
            });
        }
        let choice = choice_of(&score, objective.branches);
        let home = self.home(placement);
        let question = Question {
            home: home.as_deref().or(self.question.home),
            clearance: self.question.clearance_with_part_at(&placement.base_from_part),
            ..*self.question
        };
        let there = track.moved(placement.base_from_part, placement.spin);
        let along = along_postures(&question, &there, load.clone(), vec![(0, choice)], self.quiet())?;
        let followed = LoadedTrack {
            track: &there,
            load: &along.load,
        };
        let stability = stability(self.question.arm.robot, self.analysis, followed, &along.answers);
        // The tool is turned by the spin of the placement already.
        let placement = PartPlacement {
            spin: 0.0,
            ..*placement
        };
        let path = on_part(followed, objective.component, &all);
        let branches = score.branch.map_or(objective.branches, BranchPattern::from);
        let objective = PlacementObjective {
            branches,
            ..objective
        };
        let under_these = Placeable {
            question: self.question,
            path: &path,
            objective,
        };
        let uncertainty = under_these.evaluated(&placement).uncertainty;
        let cost = objective
            .objective
            .along(objective.component, &there, &along.answers);
        // In the search joints are those of lanes: the last word has the analysis of the path there.
        let lost = along.answers.points.iter().filter(|point| point.is_err()).count();
        let unstable = stability
            .filter(|_| self.analysis.setting.must_be_stable())
            .map_or(0, |stability| stability.unstable);
        Ok(Outcome {
            stability,
            conflicts: match lost {
                0 => None,
                _ => self.conflicts(&objective, &placement, &score)?,
            },
            path,
            placement,
            objective,
            there: Some(PathThere {
                track: there,
                choices: vec![(0, choice)],
                home,
            }),
            evaluation: PlacementEvaluation {
                score: Score {
                    cost,
                    unreachable: lost + unstable,
                    ..score
                },
                uncertainty,
            },
        })
    }

    /// The gain from one outcome to another: of a path with all sources of deviation.
    ///
    /// # Errors
    /// Cancelled by the watch.
    pub fn gain(&self, before: &Outcome, after: &Outcome) -> Result<Gain, Cancelled> {
        let followed = gain_of_paths(self.question, self.path.load, [before, after], self.watch)?;
        Ok(followed.unwrap_or_else(|| self.gain_of_scores(before, after)))
    }

    /// The same by the scores of the search, which take each point by itself.
    fn gain_of_scores(&self, before: &Outcome, after: &Outcome) -> Gain {
        let [of_before, of_after] = [before, after].map(|outcome| Placeable {
            question: self.question,
            path: &outcome.path,
            objective: outcome.objective,
        });
        let branches = |outcome: &Outcome| {
            let branch = outcome.evaluation.score.branch;
            branch.map_or(outcome.objective.branches, BranchPattern::from)
        };
        let gain = of_before.gain(
            (&before.placement, branches(before)),
            &of_after,
            (&after.placement, branches(after)),
        );
        Gain {
            before: before.evaluation.score.cost,
            after: after.evaluation.score.cost,
            ..gain
        }
    }

    /// The home positions of the redundant joints at a placement of the rail; `None` where they are those of the study.
    fn home(&self, placement: &PartPlacement) -> Option<Vec<f64>> {
        let Question { arm, home, .. } = self.question;
        placement.rail.map(|rail| home_at(arm.robot, *home, rail))
    }

    fn quiet(&self) -> Watch<'_> {
        Watch {
            finished: &|_| (),
            ..self.watch
        }
    }
}

/// The branch of a score, or those that are open.
fn choice_of(score: &Score, open: BranchPattern) -> BranchChoice {
    BranchChoice::Of(score.branch.map_or(open, BranchPattern::from))
}

/// The gain from one path to another, each as it is followed there; `None` where one of them is not followed.
///
/// # Errors
/// Cancelled by the watch.
pub(super) fn gain_of_paths(
    question: &Question<'_>,
    load: &PathLoad,
    [before, after]: [&Outcome; 2],
    watch: Watch<'_>,
) -> Result<Option<Gain>, Cancelled> {
    let (Some(from), Some(to)) = (&before.there, &after.there) else {
        return Ok(None);
    };
    let PlacementObjective {
        component, objective, ..
    } = after.objective;
    let followed = [from, to].map(|there| FollowedTrack {
        path: LoadedTrack {
            track: &there.track,
            load,
        },
        choices: &there.choices,
        home: there.home.as_deref(),
    });
    // Both keep their clearance, each with the part at its own place.
    let question = Question {
        clearance: None,
        ..*question
    };
    gain_along(&question, followed, (component, objective), watch).map(Some)
}
