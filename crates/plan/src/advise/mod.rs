//! Measures that bring a path within its tolerance: placement, spin, compensation and cut, as sentences with numbers.
//!
//! ```text
//! nominal -> best placement -> best spin and branches there -> stretches out of tolerance, and why -> compensated -> permitted cut
//! ```
//!
//! A step is used only if it improves the path by more than its uncertainty. The resulting study is run and written as
//! any other; its file, the path to command and the numbers of the steps are left for use ([`AdvisedFiles`]).
//!
//! `answer`: values and sentences; `stability`: speed and depth of a cut that chatters; `measures`: those that can be applied one by one; `advised`: the files.

mod advised;
mod answer;
mod measures;
mod stability;

pub use advised::AdvisedFiles;
pub use answer::{AdviceAnswer, StepAnswer, StretchAnswer};
pub use measures::search_of_postures;
pub use stability::{SpeedAdvice, StabilityAdvice};

use std::sync::atomic::{AtomicUsize, Ordering};

use armill_core::optimize::Compensation;
use armill_core::units::{to_mm, to_um};
use armill_core::watch::Watch;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::run::PathResult;
use armill_study::analysis::words::largest_contributor;
use armill_study::analysis::{AnalysisData, AnalysisResult};
use armill_study::answer::{PathAnswer, SearchAnswer, StatisticsAnswer};
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::live::{StudyText, process_values};
use armill_study::output::Picture;
use armill_study::run::run;
use armill_study::studies::FoundStudy;

use crate::compensate::{ErrorAnswer, compensate};
use crate::measure::Measure;
use crate::place::{Journal, PlacementAnswer, PlacementSearch};

/// The recommendation, and the resulting study.
pub struct Advice {
    /// As numbers and text.
    pub answer: AdviceAnswer,
    /// What can be applied by itself.
    pub measures: Vec<Measure>,
    /// Pictures of the search for a place.
    pub pictures: Vec<Picture>,
    /// The study with this path only, as recommended.
    pub study: Study,
    /// Its file, the path to command, and the numbers of the steps.
    pub files: AdvisedFiles,
}

/// Points of a run that are one unit of progress, as a placement is.
const POINTS_PER_UNIT: usize = 1000;

/// The end of the progress of [`advise`].
pub fn progress_count(placing: &PlacementSearch<'_>) -> usize {
    let points: usize = placing
        .study()
        .paths(Some(placing.name()))
        .map(|(_, path)| path.track.len())
        .sum();
    placing.place_count() + RUNS * points / POINTS_PER_UNIT
}

/// About how often points are evaluated apart from the search for a placement: by two runs, the search of spins and the
/// compensation.
const RUNS: usize = 12;

/// Greatest number of stretches reported.
const MOST_STRETCHES: usize = 10;

/// Recommended measures for the path of `placing`, whose study was read from `found`.
///
/// # Errors
/// As of [`PlacementSearch::search`].
pub fn advise(
    found: &FoundStudy,
    placing: &PlacementSearch<'_>,
    journal: &mut Journal<'_>,
    watch: Watch<'_>,
    given: &dyn Fn(&str),
) -> Result<Advice, StudyError> {
    if placing.is_of_holes() {
        let message = "advice is for paths, and this is a set of holes";
        return Err(StudyError::value(
            message,
            "`armill place` finds the best place of holes",
        ));
    }
    let (study, name) = (placing.study(), placing.name());
    let counted = AtomicUsize::new(0);
    let in_units = |points: usize| {
        let before = counted.fetch_add(points, Ordering::Relaxed);
        let units = (before + points) / POINTS_PER_UNIT - before / POINTS_PER_UNIT;
        if units > 0 {
            (watch.finished)(units);
        }
    };
    let by_points = Watch {
        finished: &in_units,
        ..watch
    };
    let drawn = alone(study.clone(), name);
    let placed = placing.search(journal, watch, given)?;
    let moves = placed.answer.is_improvement;
    let file = placed.placed(found)?;
    given("deviation at the placement");
    let there = match moves {
        true => placed.with_tool(file.read()?)?,
        false => drawn.clone(),
    };
    let still = run(&there, by_points)?;
    let at_place = statistics(&there, &still);
    let nominal = match moves {
        true => statistics(&drawn, &run(&drawn, by_points)?),
        false => at_place.clone(),
    };
    given("spin of the tool");
    let mut turned = there.clone();
    turned.search_postures(None)?;
    let with = run(&turned, by_points)?;
    let searched = with
        .first()
        .and_then(path_of)
        .and_then(|(analysis, found)| SearchAnswer::of(&turned.robot.robot, analysis, found));
    let turns = searched.as_ref().is_some_and(|searched| searched.applied);
    let (advised, done) = match turns {
        true => (&turned, with),
        false => (&there, still),
    };
    given("compensation");
    let commanded = compensate(advised, Some(name), Compensation::USUAL, by_points)?;
    let answer = armill_study::answer::answer(advised, &done);
    let path = answer.paths.into_iter().next();
    let of_path = done.first().and_then(path_of);
    let commanded = commanded.into_iter().next();
    let (Some(path), Some((analysis, of_path)), Some(commanded)) = (path, of_path, commanded) else {
        return Err(StudyError::value(
            "the study has no path analysis",
            "[[analysis]] kind = \"path\"",
        ));
    };
    let recommended = StatisticsAnswer::of(analysis, &of_path.along.answers, of_path.motion.as_ref());
    let compensated = commanded.given.after;
    let steps = steps(
        &placed.answer,
        &nominal,
        &at_place,
        searched.as_ref(),
        &compensated,
    );
    let mut answer = AdviceAnswer {
        format: 1,
        analysis: name.to_owned(),
        advice: Vec::new(),
        steps,
        tolerance_um: to_um(analysis.setting.tolerance),
        force_factor: recommended
            .max_in_plane_um
            .filter(|um| *um > 0.0 && analysis.setting.model.is_drives_alone())
            .map(|um| to_um(analysis.setting.tolerance) / um),
        nominal,
        recommended,
        placement: placed.answer.clone(),
        moves,
        out_of_tolerance: out_of_tolerance(advised, analysis, of_path, &path),
        turns: searched.filter(|_| turns),
        compensated,
        compensated_u_um: path.worst.and_then(|worst| worst.in_plane_u_um),
        stability: StabilityAdvice::of(
            &advised.robot.robot,
            analysis,
            of_path,
            done.first().and_then(|done| done.vibration.first()),
            path.vibration.as_ref(),
        ),
        limits_are_stable: analysis.setting.vibration.is_some(),
        limits: path.limits,
        compliance_assumed: study.compliance_is_assumed(),
    };
    answer.advice = answer.sentences();
    let searches = study
        .paths(Some(name))
        .any(|(_, path)| path.setting.search.is_some());
    let process = process_values(text_of(found), Some(name))?;
    let files = AdvisedFiles::of(&file, &placed, turns, &answer.steps, commanded)?;
    Ok(Advice {
        measures: measures::measures(&answer, placed.changes(found)?, process.as_ref(), searches),
        answer,
        pictures: placed.pictures,
        study: advised.clone(),
        files,
    })
}

fn text_of(found: &FoundStudy) -> StudyText<'_> {
    StudyText {
        shown: &found.shown,
        folder: &found.folder,
        bytes: &found.bytes,
    }
}

/// The steps with their results.
fn steps(
    placement: &PlacementAnswer,
    nominal: &StatisticsAnswer,
    at_place: &StatisticsAnswer,
    searched: Option<&SearchAnswer>,
    compensated: &ErrorAnswer,
) -> Vec<StepAnswer> {
    let step = |step: &'static str, of: &StatisticsAnswer, costs: &'static str| StepAnswer {
        step,
        is_advised: true,
        largest_um: of.max_in_plane_um,
        mean_um: of.mean_in_plane_um,
        fraction_within: Some(of.fraction_within),
        gain_um: None,
        gain_u_um: None,
        costs,
    };
    let comparable = placement.nominal.unreachable_points == placement.recommended.unreachable_points;
    let mut steps = vec![
        step("nominal", nominal, "nothing"),
        StepAnswer {
            is_advised: placement.is_improvement,
            // Over other points than the nominal path has, there is no gain.
            gain_um: comparable.then_some(placement.gain_um),
            gain_u_um: placement.gain_u_um.filter(|_| comparable),
            ..step("placement", at_place, "a new set-up of the part and its frame")
        },
    ];
    if let Some(placed) = steps.last_mut().filter(|placed| !placed.is_advised) {
        // The path was not evaluated there, apart from the objective.
        let is_worst = placement.objective == "worst" && placement.component == "in-plane";
        placed.largest_um = is_worst.then_some(placement.recommended.cost_um);
        (placed.mean_um, placed.fraction_within) = (None, None);
    }
    steps.extend(searched.map(|searched| StepAnswer {
        is_advised: searched.applied,
        gain_um: Some(searched.gain_um),
        gain_u_um: searched.gain_u_um,
        ..step("spin", &searched.with, "a new program with other joint motions")
    }));
    steps.push(StepAnswer {
        step: "compensation",
        is_advised: true,
        largest_um: Some(compensated.max_um),
        mean_um: None,
        fraction_within: None,
        gain_um: None,
        gain_u_um: None,
        costs: "a new program",
    });
    steps
}

/// The study with this path only.
fn alone(mut study: Study, name: &str) -> Study {
    study.analyses.retain(|analysis| analysis.name == name);
    study.statements.clear();
    study
}

fn path_of<'d>(done: &'d AnalysisResult<'_>) -> Option<(&'d PathAnalysis, &'d PathResult)> {
    match &done.found {
        AnalysisData::Path(analysis, found) => Some((analysis, found)),
        _ => None,
    }
}

/// The one path of this study in some numbers.
fn statistics(study: &Study, done: &[AnalysisResult<'_>]) -> StatisticsAnswer {
    let nothing = StatisticsAnswer {
        max_in_plane_um: None,
        mean_in_plane_um: None,
        fraction_within: 0.0,
        unreachable: study.analyses.len(),
        outside_joint_limits: 0,
        near_singularity: 0,
        reversals: Vec::new(),
        cycle_time_s: None,
    };
    done.first()
        .and_then(path_of)
        .map_or(nothing, |(analysis, found)| {
            StatisticsAnswer::of(analysis, &found.along.answers, found.motion.as_ref())
        })
}

/// Stretches of the path out of tolerance, the worst first.
fn out_of_tolerance(
    study: &Study,
    analysis: &PathAnalysis,
    found: &PathResult,
    path: &PathAnswer,
) -> Vec<StretchAnswer> {
    let points = &analysis.track.path.points;
    let answers = &found.along.answers.points;
    let within = |index: usize| {
        answers[index].as_ref().is_ok_and(|evaluation| {
            evaluation.in_plane <= analysis.setting.tolerance && evaluation.within_limits()
        })
    };
    let indices: Vec<usize> = (0..points.len()).collect();
    let stretches = indices.chunk_by(|a, b| within(*a) == within(*b));
    let given = |stretch: &[usize]| {
        let (first, last) = (*stretch.first()?, *stretch.last()?);
        let evaluation = stretch.iter().filter_map(|index| answers[*index].as_ref().ok());
        let inside = |index: usize| (first..=last).contains(&index);
        let worst = found
            .worst
            .iter()
            .zip(&path.worst_points)
            .find(|(full, _)| inside(full.index));
        Some(StretchAnswer {
            first_line: points[first].line,
            last_line: points[last].line,
            from_mm: to_mm(points[first].along),
            to_mm: to_mm(points[last].along),
            points: stretch.len(),
            unreachable: stretch.iter().filter(|index| answers[**index].is_err()).count(),
            max_in_plane_um: evaluation
                .map(|evaluation| to_um(evaluation.in_plane))
                .fold(0.0, f64::max),
            mostly_by: worst.map(|(_, worst)| {
                largest_contributor(&study.robot.robot, &worst.point, &path.setting.contributors)
            }),
        })
    };
    let mut all: Vec<StretchAnswer> = stretches
        .filter(|stretch| !within(stretch[0]))
        .filter_map(given)
        .collect();
    all.sort_by(|a, b| {
        let order = b.unreachable.cmp(&a.unreachable);
        order.then(b.max_in_plane_um.total_cmp(&a.max_in_plane_um))
    });
    all.truncate(MOST_STRETCHES);
    all
}
