//! Placement of a path along which the tool leans or external axes move, by the `posture.search` of the study.
//!
//! ```text
//! Sobol points by a quick score -> more of them around the best -> a search along the path at some points -> at all points of the best
//! ```
//!
//! The quick score takes each point by itself, with coarse settings of spin, lean and axes ([`FreePath`]); the search along the path is that of
//! an analysis of the path there, and its numbers are the result.

use armill_core::clearance::Conflict;
use armill_core::kernel::{PartPlacement, Question};
use armill_core::load::PathLoad;
use armill_core::map::{along_postures, measure_stock_clearances};
use armill_core::optimize::{
    FreePath, Gain, PlacementEvaluation, PlacementObjective, PostureSearch, Score, SearchedPath, on_part,
    postures_in_stock,
};
use armill_core::path::LoadedTrack;
use armill_core::robot::{Robot, Unreachable};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_core::watch::{Cancelled, Watch};
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::answer::search::{component_name, objective_name};
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::placement::{PlaceTable, RankByName};
use armill_study::number::decimals;

use super::answer::{OutcomeAnswer, PlacementAnswer, rank_by_name};
use super::certificate::{CertificateAnswer, GridAnswer};
use super::followed::{Outcome, PathConflicts, PathThere, gain_of_paths, with_room};
use super::freedom::Freedom;
use super::journal::{Fingerprint, Journal};
use super::objective::objective;
use super::rail::{home_at, rail_of};
use super::result::PlacementResult;
use super::rounds::{Best, Site};
use super::search::{Spot, apart, sobol};

/// Placements of the quick score, spread over all that is free.
const SPREAD: usize = 512;
/// Those around each of the best.
const AROUND: usize = 48;
/// Placements with a search along the path.
const FOLLOWED: usize = 4;
/// All of them: the end of the progress.
pub(super) const PLACEMENTS: usize = SPREAD + FOLLOWED * (AROUND + 2);
/// Half the range around a placement, part of the whole range.
const NEAR: f64 = 0.12;
/// Points of the quick score, and of a search along the path that compares placements.
const QUICK_POINTS: usize = 24;
const COMPARED_POINTS: usize = 120;

/// Refuses degrees of freedom and rankings that a search along the path does not have.
pub(super) fn check(
    table: &PlaceTable,
    search: Option<&PostureSearch>,
    robot: &Robot,
) -> Result<(), StudyError> {
    let Some(search) = search else { return Ok(()) };
    let moves = |joint: usize| search.axes.iter().any(|axis| axis.joint == joint);
    if table.spin_deg.is_some() {
        return Err(StudyError::value(
            "`spin_deg` changes the spin at all points alike, but with lean or moving axes each point has its own best spin",
            "posture.search.turns_deg bounds the spin",
        ));
    }
    if table.rail_mm.is_some() && rail_of(robot).is_some_and(moves) {
        return Err(StudyError::value(
            "`rail_mm` places the rail, but `posture.search.axes` moves it along the path",
            "leave out `rail_mm`",
        ));
    }
    if table
        .rank_by
        .is_some_and(|rank_by| rank_by != RankByName::Nominal)
    {
        return Err(StudyError::value(
            "with lean or moving axes placements are ranked by nominal values alone",
            "rank by `nominal`",
        ));
    }
    Ok(())
}

/// A path that is placed with what is free along it.
struct LeaningSearch<'a> {
    free: FreePath<'a>,
    objective: PlacementObjective,
    sites: &'a [Site<'a>],
    seed: u64,
    watch: Watch<'a>,
    given: &'a dyn Fn(&str),
}

/// What is placed, and what may move.
pub(super) struct LeaningRequest<'a> {
    pub robot: &'a Robot,
    /// Index and name of the analysis, and its path.
    pub named: (usize, &'a str, &'a PathAnalysis),
    pub table: &'a PlaceTable,
    pub search: &'a PostureSearch,
    pub sites: &'a [Site<'a>],
    /// The placement of the study.
    pub nominal: &'a Freedom,
    pub seed: u64,
}

impl LeaningRequest<'_> {
    /// The result, without `home_deg` and `forces_stay`, and its placement.
    pub fn result(
        &self,
        journal: &mut Journal<'_>,
        (watch, given): (Watch<'_>, &dyn Fn(&str)),
    ) -> Result<(PlacementResult, PartPlacement), StudyError> {
        let LeaningRequest {
            robot,
            named: (index, name, analysis),
            search,
            sites,
            ..
        } = *self;
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let setting = &analysis.setting;
        let runner = Runner::new(robot, quiet)?;
        let (load, _) = runner.pushed(analysis)?;
        let mut objective = objective(self.table, analysis, Some(search), robot)?;
        if self.table.margin_deg.is_none() {
            objective.margin = search.margin;
        }
        let search = PostureSearch {
            component: objective.component,
            objective: objective.objective,
            branches: objective.branches,
            margin: objective.margin,
            wrist: objective.wrist,
            ..search.clone()
        };
        let track = &analysis.track;
        let question = with_room(runner.question(setting));
        let stock = runner.cut_stock(analysis)?;
        let leaning = LeaningSearch {
            free: FreePath {
                question: &question,
                path: LoadedTrack { track, load: &load },
                search: &search,
                stock: stock.as_ref(),
            },
            objective,
            sites,
            seed: self.seed,
            watch,
            given,
        };
        let freedoms: Vec<&Freedom> = sites.iter().map(|site| &site.freedom).collect();
        let mut print = Fingerprint::new();
        print.take(
            format!("{robot:?}{setting:?}{objective:?}{freedoms:?}{search:?}{track:?}{load:?}").as_bytes(),
        );
        print.take(&self.seed.to_le_bytes());
        journal.take_up(print.value());
        let best = leaning.best(journal)?;
        let Site {
            name: fixture,
            freedom,
        } = &sites[best.site];
        let placement = freedom.part_placement(&best.spot.at);
        let at = |placement: &PartPlacement| outcome(&leaning.free, objective, placement, quiet);
        let nominal = at(&self.nominal.part_placement(&[]))?;
        let recommended = at(&placement)?;
        let [before, after] = [&nominal, &recommended].map(|outcome| outcome.evaluation.score);
        let of_paths = match before.unreachable + after.unreachable {
            0 => gain_of_paths(&question, &load, [&nominal, &recommended], quiet)?,
            _ => None,
        };
        let gain = of_paths.unwrap_or(Gain {
            before: before.cost,
            after: after.cost,
            uncertainty: None,
        });
        let least = &setting.least_gain;
        let place = freedom.answer(&best.spot.at);
        let grid = GridAnswer {
            places: 0,
            pitch_mm: 0.0,
            pitch_deg: 0.0,
            better: 0,
        };
        let answer = PlacementAnswer {
            format: 1,
            analysis: name.to_owned(),
            component: component_name(objective.component),
            objective: objective_name(objective.objective),
            margin_deg: decimals(to_deg(objective.margin), 4),
            rank_by: rank_by_name(objective.rank_by),
            is_improvement: after.unreachable < before.unreachable
                || (after.unreachable == before.unreachable && gain.is_significant(least)),
            nominal: OutcomeAnswer::of(&nominal, setting),
            recommended: OutcomeAnswer::of(&recommended, setting),
            gain_um: to_um(gain.by()),
            gain_u_um: gain.uncertainty.map(to_um),
            least_gain_um: to_um(gain.required(least)),
            fixture: fixture.map(str::to_owned),
            home_deg: None,
            place,
            free: freedom.reported(&best.spot.at),
            certificate: CertificateAnswer {
                near: grid.clone(),
                wide: grid,
            },
            by_margin: Vec::new(),
            forces_stay: false,
            seed: self.seed,
            points: track.len(),
            demanded_clearance_mm: setting.cell.as_ref().map(|cell| decimals(to_mm(cell.least), 4)),
            rounds_taken_up: journal.taken(),
            searched_along: match freedom.count() {
                0 => 1,
                _ => FOLLOWED,
            },
            tool_turns_with_part: false,
        };
        let result = PlacementResult {
            answer,
            pictures: Vec::new(),
            analysis: index,
            is_of_holes: false,
            with_part: None,
        };
        Ok((result, placement))
    }
}

impl LeaningSearch<'_> {
    /// The best placement.
    pub fn best(&self, journal: &mut Journal<'_>) -> Result<Best, StudyError> {
        let mut best: Option<Best> = None;
        for (site, Site { freedom, .. }) in self.sites.iter().enumerate() {
            let dimensions = freedom.count();
            // Without free degrees there is one placement.
            let starts = match dimensions {
                0 => vec![Vec::new()],
                _ => {
                    let flat = journal.round(&format!("site {site} starts"), || {
                        Ok(self.starts(freedom)?.concat())
                    })?;
                    flat.chunks(dimensions).map(<[f64]>::to_vec).collect()
                }
            };
            for (index, at) in starts.into_iter().enumerate() {
                let points = self.every(COMPARED_POINTS);
                let numbers = journal.round(&format!("site {site} followed {index}"), || {
                    let score = self.followed(&freedom.part_placement(&at), &points)?;
                    let lost = score.unreachable as f64 / points.len() as f64;
                    Ok(vec![lost.min(1.0), score.cost.min(1.0)])
                })?;
                let [lost, cost] = numbers[..] else { continue };
                let score = Score {
                    unreachable: (lost * points.len() as f64).round() as usize,
                    cost,
                    branch: None,
                };
                if best.as_ref().is_none_or(|best| score.beats(&best.spot.score)) {
                    (self.given)(&match score.unreachable {
                        0 => format!("best so far {:.2} µm", to_um(cost)),
                        lost => format!("best so far: no posture at {lost} of {} points", points.len()),
                    });
                    let spot = Spot { at, score };
                    best = Some(Best { site, spot });
                }
            }
        }
        best.ok_or_else(|| {
            StudyError::value(
                "there is no placement to evaluate",
                "free a degree, or give fixtures",
            )
        })
    }

    /// The placements for the search along the path, by the quick score.
    fn starts(&self, freedom: &Freedom) -> Result<Vec<Vec<f64>>, Cancelled> {
        let dimensions = freedom.count();
        let spread = self.scored(freedom, sobol(SPREAD, dimensions, self.seed))?;
        let mut starts = Vec::new();
        for spot in separate(spread) {
            let around = sobol(AROUND, dimensions, self.seed.wrapping_add(1)).into_iter();
            let moved = around.map(|parts| {
                let near = spot.at.iter().zip(parts);
                near.map(|(at, part)| (at + NEAR * (2.0 * part - 1.0)).clamp(0.0, 1.0))
                    .collect()
            });
            let mut near = self.scored(freedom, moved.collect())?;
            near.insert(0, spot);
            starts.extend(in_order(near).into_iter().next().map(|spot| spot.at));
        }
        Ok(starts)
    }

    fn scored(&self, freedom: &Freedom, places: Vec<Vec<f64>>) -> Result<Vec<Spot>, Cancelled> {
        let placements: Vec<PartPlacement> = places.iter().map(|at| freedom.part_placement(at)).collect();
        let points = every(self.free.path.track.len(), QUICK_POINTS);
        let scores = self.free.quick_scores(&placements, &points, self.watch)?;
        let both = places.into_iter().zip(scores);
        Ok(both.map(|(at, score)| Spot { at, score }).collect())
    }

    /// The points of a search that compares placements: all where loads are given point by point.
    fn every(&self, most: usize) -> Vec<usize> {
        let LoadedTrack { track, load } = self.free.path;
        match load {
            PathLoad::Cases(_) => every(track.len(), most),
            _ => (0..track.len()).collect(),
        }
    }

    /// The score of a placement by a search along these points.
    fn followed(&self, placement: &PartPlacement, points: &[usize]) -> Result<Score, Cancelled> {
        let some = self.free.path.track.at_points(points);
        let free = FreePath {
            path: LoadedTrack {
                track: if points.len() < self.free.path.track.len() {
                    &some
                } else {
                    self.free.path.track
                },
                ..self.free.path
            },
            ..self.free
        };
        let score = outcome(&free, self.objective, placement, self.quiet())?
            .evaluation
            .score;
        (self.watch.finished)(1);
        Ok(score)
    }

    fn quiet(&self) -> Watch<'_> {
        Watch {
            finished: &|_| (),
            ..self.watch
        }
    }
}

/// Refuses a cut that must be stable: searches along the path do not evaluate its stability.
pub(super) fn check_stability(
    analysis: &PathAnalysis,
    search: Option<&PostureSearch>,
) -> Result<(), StudyError> {
    if search.is_none() || !analysis.setting.must_be_stable() {
        return Ok(());
    }
    Err(StudyError::value(
        "`vibration.must_be_stable` is not evaluated by a search in which the tool leans or external axes move",
        "remove `lean` and `axes` from posture.search, or `must_be_stable` from [vibration]",
    ))
}

/// The result of a placement by a search along the path there.
pub(super) fn outcome(
    free: &FreePath<'_>,
    objective: PlacementObjective,
    placement: &PartPlacement,
    watch: Watch<'_>,
) -> Result<Outcome, Cancelled> {
    let LoadedTrack { track, load } = free.path;
    let home = placement
        .rail
        .map(|rail| home_at(free.question.arm.robot, free.question.home, rail));
    let question = Question {
        home: home.as_deref().or(free.question.home),
        clearance: free.question.clearance_with_part_at(&placement.base_from_part),
        ..*free.question
    };
    let there = track.moved(placement.base_from_part, placement.spin);
    let search: &PostureSearch = free.search;
    let stock = free.stock.map(|stock| stock.placed(&there.placing));
    let path = SearchedPath::new(LoadedTrack { track: &there, load }, stock.as_ref());
    let found = postures_in_stock(&question, path, search, watch)?;
    let turned = found.turned(&there);
    let choices = found.choices();
    let mut along = along_postures(&question, &turned, load.clone(), choices.clone(), watch)?;
    if let Some(stock) = &stock {
        measure_stock_clearances(&question, stock, &mut along, watch)?;
    }
    let is_lost = |index: usize| {
        let by_search = found.unreachable.binary_search_by_key(&index, |(lost, _)| *lost);
        along.answers.points[index].is_err() || by_search.is_ok()
    };
    let lost = (0..track.len()).filter(|index| is_lost(*index)).count();
    let conflicts = along.answers.points.iter().filter_map(|point| match point {
        Err(Unreachable::InCollision { missing, bodies }) => Some(Conflict {
            missing: *missing,
            bodies: *bodies,
        }),
        _ => None,
    });
    let conflicts: Vec<Conflict> = conflicts.collect();
    let largest = (conflicts.iter())
        .copied()
        .reduce(|most, other| if other.missing > most.missing { other } else { most });
    let least = question.clearance.map_or(0.0, |demanded| demanded.least);
    let all: Vec<usize> = (0..track.len()).collect();
    let under_these = LoadedTrack {
        track: &turned,
        load: &along.load,
    };
    let cost = objective
        .objective
        .along(objective.component, &turned, &along.answers);
    Ok(Outcome {
        stability: None,
        path: on_part(under_these, objective.component, &all),
        placement: *placement,
        objective,
        conflicts: largest.map(|largest| PathConflicts {
            points: conflicts.len(),
            bodies: largest.bodies,
            distance: (least - largest.missing).max(0.0),
        }),
        evaluation: PlacementEvaluation {
            score: Score {
                // A stop of the arm within a cut is a point that is lost.
                unreachable: lost + found.breaks.len(),
                cost,
                branch: None,
            },
            uncertainty: None,
        },
        there: Some(PathThere {
            track: turned,
            choices,
            home,
        }),
    })
}

/// At most about so many of these points, the first and the last among them.
fn every(count: usize, most: usize) -> Vec<usize> {
    let stride = count.div_ceil(most).max(1);
    let mut points: Vec<usize> = (0..count).step_by(stride).collect();
    if points.last() != Some(&(count - 1)) {
        points.push(count - 1);
    }
    points
}

/// Best first; of equal ones in the order given.
fn in_order(mut spots: Vec<Spot>) -> Vec<Spot> {
    spots.sort_by(|a, b| {
        let key = |spot: &Spot| (spot.score.unreachable, spot.score.cost);
        key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1))
    });
    spots
}

/// The best that are not near each other.
fn separate(spots: Vec<Spot>) -> Vec<Spot> {
    let mut all: Vec<Spot> = Vec::new();
    for spot in in_order(spots) {
        if all.len() < FOLLOWED && all.iter().all(|other| apart(&other.at, &spot.at) > NEAR) {
            all.push(spot);
        }
    }
    all
}
