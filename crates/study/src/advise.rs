//! What should be done so that a path holds its tolerance? Place, turn, compensation and cut in a sentence with numbers.
//!
//! ```text
//! as drawn -> best place -> best turns and branches there -> what still does not hold, and why -> compensated -> permitted cut
//! ```
//!
//! Each step is taken only where it makes the path better. The study that comes of them is run and written as any other.

use armill_core::optimize::Compensation;
use armill_core::watch::Watch;
use serde::Serialize;

use crate::answer::{LimitsAnswer, PathAnswer, SearchAnswer, StatisticsAnswer, culprit, micrometres};
use crate::compensate::{ErrorAnswer, compensate};
use crate::error::StudyError;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Study;
use crate::output::Picture;
use crate::place::{Journal, PlacementAnswer, Placing};
use crate::run::{Done, Found, PathFound, run};
use crate::studies::FoundStudy;

/// What to do about a path.
#[derive(Clone, Debug, Serialize)]
pub struct AdviceAnswer {
    /// Version of this format.
    pub format: u32,
    /// The path.
    pub analysis: String,
    /// What to do, in sentences.
    pub advice: Vec<String>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// The path as the study has it.
    pub nominal: StatisticsAnswer,
    /// With all that is advised but compensation.
    pub as_advised: StatisticsAnswer,
    /// The search for a place.
    pub placement: PlacementAnswer,
    /// Whether the part should move there.
    pub moves: bool,
    /// Turns of the tool and branches along the path; none where they make nothing better.
    pub turns: Option<SearchAnswer>,
    /// Stretches that do not hold the tolerance even so, the worst first.
    pub not_held: Vec<StretchAnswer>,
    /// How far the tool goes from the path there, compensated.
    pub compensated: ErrorAnswer,
    /// Standard uncertainty of the deviation that is taken off, where it is largest: what compensation leaves of it.
    pub compensated_u_um: f64,
    /// What keeps the tolerance everywhere, of a program.
    pub limits: Option<LimitsAnswer>,
    /// By how much all forces may grow until the tolerance is used up; below 1 they must shrink.
    pub force_factor: Option<f64>,
    /// Whether the joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
}

/// Points that follow on each other and do not hold the tolerance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StretchAnswer {
    /// Line of the first, of a program.
    pub first_line: u32,
    /// Line of the last.
    pub last_line: u32,
    /// Where it begins along the path.
    pub from_mm: f64,
    /// Where it ends.
    pub to_mm: f64,
    /// How many points.
    pub points: usize,
    /// Points of them without posture.
    pub unreachable: usize,
    /// Largest in-plane deviation.
    pub max_in_plane_um: f64,
    /// What yields most at the worst of them; none where that is not among the worst of the path.
    pub mostly_by: Option<String>,
}

/// What is advised, and the study that comes of it.
pub struct Advice {
    /// In numbers and words.
    pub answer: AdviceAnswer,
    /// Pictures of the search for a place.
    pub pictures: Vec<Picture>,
    /// The path alone, as advised.
    pub study: Study,
}

/// Stretches told at most.
const MOST_STRETCHES: usize = 10;

/// What to do about the path that `placing` is about.
///
/// # Errors
/// As of [`Placing::search`].
pub fn advise(
    (found, study): (&FoundStudy, &Study),
    placing: &Placing<'_>,
    journal: &mut Journal<'_>,
    (watch, given): (Watch<'_>, &dyn Fn(&str)),
) -> Result<Advice, StudyError> {
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    if placing.is_of_holes() {
        let message = "advice is for paths, and this is a set of holes";
        return Err(StudyError::value(
            message,
            "`armill place` finds the best place of holes",
        ));
    }
    let name = placing.name();
    let drawn = alone(study.clone(), name);
    let nominal = statistics(&drawn, &run(&drawn, quiet)?);
    let placed = placing.search(journal, watch, given)?;
    let moves = placed.is_better();
    let there = match moves {
        true => placed.study(found)?,
        false => drawn,
    };
    given("turns of the tool");
    let mut turned = there.clone();
    turned.search_postures(None)?;
    let (still, with) = (run(&there, quiet)?, run(&turned, quiet)?);
    let turns = is_better(&statistics(&turned, &with), &statistics(&there, &still));
    let (advised, done) = match turns {
        true => (&turned, with),
        false => (&there, still),
    };
    given("compensation");
    let commanded = compensate(advised, Some(name), Compensation::USUAL, quiet)?;
    let compensated = commanded.first().map(|path| path.given.after);
    let answer = crate::answer::answer(advised, &done);
    let path = answer.paths.into_iter().next();
    let of_path = done.first().and_then(path_of);
    let (Some(path), Some((analysis, of_path)), Some(compensated)) = (path, of_path, compensated) else {
        return Err(StudyError::value(
            "the study asks for no path",
            "[[analysis]] kind = \"path\"",
        ));
    };
    let as_advised = StatisticsAnswer::of(analysis, &of_path.along.answers);
    let mut answer = AdviceAnswer {
        format: 1,
        analysis: name.to_owned(),
        advice: Vec::new(),
        tolerance_um: analysis.setting.limit * 1e6,
        force_factor: as_advised
            .max_in_plane_um
            .filter(|um| *um > 0.0 && analysis.setting.model.is_drives_alone())
            .map(|um| analysis.setting.limit * 1e6 / um),
        nominal,
        as_advised,
        placement: placed.answer,
        moves,
        not_held: not_held(advised, (analysis, of_path), &path),
        turns: path.search.filter(|_| turns),
        compensated,
        compensated_u_um: path.worst.map_or(0.0, |worst| worst.in_plane_u_um),
        limits: path.limits,
        compliance_assumed: study.compliance_is_assumed(),
    };
    answer.advice = answer.sentences();
    Ok(Advice {
        answer,
        pictures: placed.pictures,
        study: advised.clone(),
    })
}

/// The study with this path alone.
fn alone(mut study: Study, name: &str) -> Study {
    study.analyses.retain(|analysis| analysis.name == name);
    study.statements.clear();
    study
}

fn path_of<'d>(done: &'d Done<'_>) -> Option<(&'d PathAnalysis, &'d PathFound)> {
    match &done.found {
        Found::Path(analysis, found) => Some((analysis, found)),
        _ => None,
    }
}

/// The one path of this study in some numbers.
fn statistics(study: &Study, done: &[Done<'_>]) -> StatisticsAnswer {
    let nothing = StatisticsAnswer {
        max_in_plane_um: None,
        mean_in_plane_um: None,
        fraction_within: 0.0,
        unreachable: study.analyses.len(),
        outside_joint_limits: 0,
        near_singularity: 0,
        reversals: Vec::new(),
    };
    done.first().and_then(path_of).map_or(nothing, |(analysis, found)| {
        StatisticsAnswer::of(analysis, &found.along.answers)
    })
}

/// Whether a path is better so than as the other: reached, inside limits, within the tolerance, least at its worst.
fn is_better(one: &StatisticsAnswer, other: &StatisticsAnswer) -> bool {
    let lost = |of: &StatisticsAnswer| of.unreachable + of.outside_joint_limits;
    let worst = |of: &StatisticsAnswer| of.max_in_plane_um.unwrap_or(f64::INFINITY);
    let by_lost = lost(one).cmp(&lost(other));
    let by_share = other.fraction_within.total_cmp(&one.fraction_within);
    by_lost
        .then(by_share)
        .then(worst(one).total_cmp(&worst(other)))
        .is_lt()
}

/// Stretches of the path that do not hold the tolerance, the worst first.
fn not_held(study: &Study, (analysis, found): (&PathAnalysis, &PathFound), path: &PathAnswer) -> Vec<StretchAnswer> {
    let points = &analysis.track.path.points;
    let answers = &found.along.answers.points;
    let holds = |index: usize| {
        answers[index]
            .as_ref()
            .is_ok_and(|evaluation| evaluation.in_plane <= analysis.setting.limit && evaluation.within_limits())
    };
    let indices: Vec<usize> = (0..points.len()).collect();
    let stretches = indices.chunk_by(|a, b| holds(*a) == holds(*b));
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
            from_mm: points[first].along * 1e3,
            to_mm: points[last].along * 1e3,
            points: stretch.len(),
            unreachable: stretch.iter().filter(|index| answers[**index].is_err()).count(),
            max_in_plane_um: evaluation.map(|evaluation| evaluation.in_plane * 1e6).fold(0.0, f64::max),
            mostly_by: worst.map(|(_, worst)| culprit(study, &worst.point, &path.setting.contributors)),
        })
    };
    let mut all: Vec<StretchAnswer> = stretches
        .filter(|stretch| !holds(stretch[0]))
        .filter_map(given)
        .collect();
    all.sort_by(|a, b| {
        let order = b.unreachable.cmp(&a.unreachable);
        order.then(b.max_in_plane_um.total_cmp(&a.max_in_plane_um))
    });
    all.truncate(MOST_STRETCHES);
    all
}

impl AdviceAnswer {
    /// What to do.
    fn sentences(&self) -> Vec<String> {
        let um = |of: &StatisticsAnswer| {
            of.max_in_plane_um
                .map_or("nothing".to_owned(), |um| format!("{} µm", micrometres(um)))
        };
        let share = |of: &StatisticsAnswer| format!("{:.1} %", 100.0 * of.fraction_within);
        let limit = micrometres(self.tolerance_um);
        let mut steps = Vec::new();
        if self.moves {
            steps.push(format!("lay the part at {}", self.placement.place_in_words()));
        }
        if let Some(turns) = &self.turns {
            let [from, to] = turns.turn_range_deg;
            steps.push(format!(
                "turn the tool by {from:.0} to {to:.0} deg along the path"
            ));
        }
        if steps.is_empty() {
            steps.push("leave part and tool as they are, nothing better was found".to_owned());
        }
        let mut lines = vec![format!(
            "{}: {}; {} of the path then holds {limit} µm, at most {} ({}, {} as drawn).",
            self.analysis,
            steps.join(" and "),
            share(&self.as_advised),
            um(&self.as_advised),
            share(&self.nominal),
            um(&self.nominal),
        )];
        lines.extend(self.weak_in_words());
        lines.push(format!(
            "Compensated (`armill compensate`), the tool is predicted to stay within {} µm of the path, {}.",
            micrometres(self.compensated.max_um),
            match self.compensated_u_um {
                u if u > 0.0 => format!("± {} µm that are not known of arm and force", micrometres(u)),
                _ => "as if arm and force were known".to_owned(),
            }
        ));
        lines.extend(self.permitted_in_words());
        if self.compliance_assumed {
            lines.push(
                "The joint compliances are assumed, not measured: trust the order, not the numbers."
                    .to_owned(),
            );
        }
        lines
    }

    /// What does not hold, and why.
    fn weak_in_words(&self) -> Option<String> {
        let given: Vec<String> = self
            .not_held
            .iter()
            .take(3)
            .map(|stretch| {
                let why = match (stretch.unreachable, &stretch.mostly_by) {
                    (unreachable, _) if unreachable > 0 => format!("no posture at {unreachable} points"),
                    (_, Some(by)) => format!(
                        "up to {} µm, mostly by {by}",
                        micrometres(stretch.max_in_plane_um)
                    ),
                    (_, None) => format!("up to {} µm", micrometres(stretch.max_in_plane_um)),
                };
                format!("{:.0} to {:.0} mm ({why})", stretch.from_mm, stretch.to_mm)
            })
            .collect();
        let more = match self.not_held.len() {
            0 => return None,
            count if count > given.len() => " and others",
            _ => "",
        };
        Some(format!("It does not hold from {}{more}.", given.join(", from ")))
    }

    /// What may be cut, or how strong forces may be.
    fn permitted_in_words(&self) -> Option<String> {
        let limit = micrometres(self.tolerance_um);
        let cut = self
            .limits
            .as_ref()
            .and_then(|limits| limits.axial_depth.as_ref());
        if let Some(depth) = cut {
            return Some(format!(
                "Without compensation cut {} {:.2} mm deep to hold {limit} µm everywhere (line {}).",
                depth.verdict, depth.value, depth.line
            ));
        }
        let factor = self.force_factor?;
        Some(match factor < 1.0 {
            true => format!(
                "Without compensation {limit} µm hold everywhere with {factor:.2} times these forces."
            ),
            false => format!("There is room for {factor:.1} times these forces."),
        })
    }
}
