//! Measures that bring a path within its tolerance: placement, spin, compensation and cut, as sentences with numbers.
//!
//! ```text
//! nominal -> best placement -> best spin and branches there -> stretches out of tolerance, and why -> compensated -> permitted cut
//! ```
//!
//! A step is used only if it improves the path. The resulting study is run and written as any other.

use armill_core::optimize::Compensation;
use armill_core::units::{to_mm, to_um};
use armill_core::watch::Watch;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::run::PathResult;
use armill_study::analysis::words::{largest_contributor, micrometres};
use armill_study::analysis::{AnalysisData, AnalysisResult};
use armill_study::answer::{LimitsAnswer, PathAnswer, SearchAnswer, StatisticsAnswer};
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::output::Picture;
use armill_study::run::run;
use armill_study::studies::FoundStudy;
use armill_study::uncertainty_words::u_in_words;
use serde::Serialize;

use crate::compensate::{ErrorAnswer, compensate};
use crate::place::{Journal, PlacementAnswer, PlacementSearch};

/// Recommended measures for a path.
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
    pub recommended: StatisticsAnswer,
    /// The search for a place.
    pub placement: PlacementAnswer,
    /// Whether the part should move there.
    pub moves: bool,
    /// Spin of the tool and branches along the path; none if they improve nothing.
    pub turns: Option<SearchAnswer>,
    /// Stretches out of tolerance nevertheless, the worst first.
    pub out_of_tolerance: Vec<StretchAnswer>,
    /// Deviation of the tool from the path there, compensated.
    pub compensated: ErrorAnswer,
    /// Standard uncertainty of the compensated deviation, where it is largest: what remains after compensation; none
    /// where it is not known.
    pub compensated_u_um: Option<f64>,
    /// What keeps the tolerance everywhere, of a program.
    pub limits: Option<LimitsAnswer>,
    /// By how much all forces may grow until the tolerance is used up; below 1 they must shrink.
    pub force_factor: Option<f64>,
    /// Whether the joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
}

/// Consecutive points out of tolerance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StretchAnswer {
    /// Line of the first, of a program.
    pub first_line: u32,
    /// Line of the last.
    pub last_line: u32,
    /// Its start along the path.
    pub from_mm: f64,
    /// Where it ends.
    pub to_mm: f64,
    /// How many points.
    pub points: usize,
    /// Points of them without posture.
    pub unreachable: usize,
    /// Largest in-plane deviation.
    pub max_in_plane_um: f64,
    /// Largest contributor at the worst of them; none if that is not among the worst of the path.
    pub mostly_by: Option<String>,
}

/// The recommendation, and the resulting study.
pub struct Advice {
    /// As numbers and text.
    pub answer: AdviceAnswer,
    /// Pictures of the search for a place.
    pub pictures: Vec<Picture>,
    /// The study with this path only, as recommended.
    pub study: Study,
}

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
    let (study, name) = (placing.study(), placing.name());
    let drawn = alone(study.clone(), name);
    let nominal = statistics(&drawn, &run(&drawn, quiet)?);
    let placed = placing.search(journal, watch, given)?;
    let moves = placed.answer.is_improvement;
    let there = match moves {
        true => placed.study(found)?,
        false => drawn,
    };
    given("turns of the tool");
    let mut turned = there.clone();
    turned.search_postures(None)?;
    let (still, with) = (run(&there, quiet)?, run(&turned, quiet)?);
    let turns = with
        .first()
        .and_then(path_of)
        .and_then(|(_, found)| found.searched.as_ref())
        .is_some_and(|searched| searched.applied);
    let (advised, done) = match turns {
        true => (&turned, with),
        false => (&there, still),
    };
    given("compensation");
    let commanded = compensate(advised, Some(name), Compensation::USUAL, quiet)?;
    let compensated = commanded.first().map(|path| path.given.after);
    let answer = armill_study::answer::answer(advised, &done);
    let path = answer.paths.into_iter().next();
    let of_path = done.first().and_then(path_of);
    let (Some(path), Some((analysis, of_path)), Some(compensated)) = (path, of_path, compensated) else {
        return Err(StudyError::value(
            "the study has no path analysis",
            "[[analysis]] kind = \"path\"",
        ));
    };
    let recommended = StatisticsAnswer::of(analysis, &of_path.along.answers);
    let mut answer = AdviceAnswer {
        format: 1,
        analysis: name.to_owned(),
        advice: Vec::new(),
        tolerance_um: to_um(analysis.setting.tolerance),
        force_factor: recommended
            .max_in_plane_um
            .filter(|um| *um > 0.0 && analysis.setting.model.is_drives_alone())
            .map(|um| to_um(analysis.setting.tolerance) / um),
        nominal,
        recommended,
        placement: placed.answer,
        moves,
        out_of_tolerance: out_of_tolerance(advised, analysis, of_path, &path),
        turns: path.search.filter(|_| turns),
        compensated,
        compensated_u_um: path.worst.and_then(|worst| worst.in_plane_u_um),
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
    };
    done.first()
        .and_then(path_of)
        .map_or(nothing, |(analysis, found)| {
            StatisticsAnswer::of(analysis, &found.along.answers)
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

impl AdviceAnswer {
    /// Recommended measures.
    fn sentences(&self) -> Vec<String> {
        let um = |of: &StatisticsAnswer| {
            of.max_in_plane_um
                .map_or("nothing".to_owned(), |um| format!("{} µm", micrometres(um)))
        };
        let share = |of: &StatisticsAnswer| format!("{:.1} %", 100.0 * of.fraction_within);
        let limit = micrometres(self.tolerance_um);
        let mut steps = Vec::new();
        if self.moves {
            steps.push(format!("place the part at {}", self.placement.place_in_words()));
        }
        if let Some(turns) = &self.turns {
            steps.push(format!(
                "use a tool spin of {} along the path, with {}",
                turns.turn_in_words(),
                turns.gain_in_words()
            ));
        }
        if steps.is_empty() {
            steps.push("keep part and tool; nothing better was found".to_owned());
        }
        let mut lines = vec![format!(
            "{}: {}; {} of the path is then within {limit} µm, largest deviation {} (nominal: {}, {}).",
            self.analysis,
            steps.join(" and "),
            share(&self.recommended),
            um(&self.recommended),
            share(&self.nominal),
            um(&self.nominal),
        )];
        lines.extend(self.out_of_tolerance_text());
        lines.push(format!(
            "Compensated (`armill compensate`), the predicted largest deviation from the path is {} µm ({} from robot and force).",
            micrometres(self.compensated.max_um),
            u_in_words(self.compensated_u_um),
        ));
        lines.extend(self.permitted_text());
        if self.compliance_assumed {
            lines.push(
                "The joint compliances are assumed, not measured: use the ranking, not the absolute numbers."
                    .to_owned(),
            );
        }
        lines
    }

    /// The stretches out of tolerance, and why.
    fn out_of_tolerance_text(&self) -> Option<String> {
        let given: Vec<String> = self
            .out_of_tolerance
            .iter()
            .take(3)
            .map(|stretch| {
                let why = match (stretch.unreachable, &stretch.mostly_by) {
                    (unreachable, _) if unreachable > 0 => format!("no posture at {unreachable} points"),
                    (_, Some(by)) => format!(
                        "up to {} µm, largest contribution: {by}",
                        micrometres(stretch.max_in_plane_um)
                    ),
                    (_, None) => format!("up to {} µm", micrometres(stretch.max_in_plane_um)),
                };
                format!("{:.0} to {:.0} mm ({why})", stretch.from_mm, stretch.to_mm)
            })
            .collect();
        let more = match self.out_of_tolerance.len() {
            0 => return None,
            count if count > given.len() => " and others",
            _ => "",
        };
        Some(format!(
            "The tolerance is not met from {}{more}.",
            given.join(", from ")
        ))
    }

    /// The permitted cut, or the permitted forces.
    fn permitted_text(&self) -> Option<String> {
        let limit = micrometres(self.tolerance_um);
        let cut = self
            .limits
            .as_ref()
            .and_then(|limits| limits.axial_depth.as_ref());
        if let Some(depth) = cut {
            return Some(format!(
                "Without compensation, the depth of cut to be within {limit} µm everywhere is {} {:.2} mm (line {}).",
                depth.verdict, depth.value, depth.line
            ));
        }
        let factor = self.force_factor?;
        Some(match factor < 1.0 {
            true => format!(
                "Without compensation, the path is within {limit} µm everywhere with {factor:.2} times these forces."
            ),
            false => format!("The path is within the tolerance with up to {factor:.1} times these forces."),
        })
    }
}
