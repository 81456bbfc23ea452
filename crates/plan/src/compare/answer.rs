//! The comparison as one JSON value.
//!
//! `cells[]` are the compared cells, in the order given; `analyses[]` the analyses they have in common, paths first,
//! each with its cells best first.

use armill_core::optimize::SharedInputs;
use armill_core::units::to_mm;
use std::cmp::Ordering;

use armill_formats::sources::Source;
use armill_study::analysis::Subject;
use armill_study::analysis::path::PathAnalysis;
use armill_study::answer::StudyAnswer;
use serde::Serialize;

use super::cells::{Cell, ComparableCells};
use super::curve::Curve;
use super::entry::Entry;
use super::numbers::CellNumbers;
use super::sentence;
use super::traits::TraitAnswer;
use super::verdict::{Candidate, Verdict, verdict};

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct ComparisonAnswer {
    /// Version of this format.
    pub format: u32,
    /// Version of armill that gave it.
    pub armill: &'static str,
    /// The main result of the first analysis in one sentence.
    pub answer: String,
    /// What was compared.
    pub cells: Vec<CellAnswer>,
    /// Analyses that at least two cells have.
    pub analyses: Vec<ComparedAnswer>,
    /// What was not compared, a sentence each.
    pub left_out: Vec<String>,
    /// Warnings, with the cell to which they apply.
    pub warnings: Vec<String>,
    /// Sources of the numbers, of all cells.
    pub sources: Vec<Source>,
}

/// Result of a comparison.
#[derive(Clone, Debug)]
pub struct ComparisonResult {
    /// As numbers and text.
    pub answer: ComparisonAnswer,
    /// For each compared path the deviation along it, per cell in the order of its numbers.
    pub(super) curves: Vec<Vec<Curve>>,
}

/// One cell.
#[derive(Clone, Debug, Serialize)]
pub struct CellAnswer {
    /// Its name.
    pub name: String,
    /// File of its study.
    pub study: String,
    /// Title of its study.
    pub title: String,
    /// Its robot.
    pub robot: String,
    /// Maker and type of that.
    pub robot_title: String,
    /// Whether its joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
    /// What to know before trusting its numbers.
    #[serde(skip)]
    pub(super) warnings: Vec<String>,
    #[serde(skip)]
    pub(super) sources: Vec<Source>,
}

/// One analysis in all cells that have it.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedAnswer {
    /// Its name; of a section with the label.
    pub name: String,
    /// `path`, `holes`, `map` or `volume`.
    pub kind: &'static str,
    /// Which cell is best, or that there is no ranking, in a sentence.
    pub answer: String,
    /// Whether the first cell is better than all others: by more than the uncertainty of the difference, and not by
    /// assumed compliances.
    pub is_ranked: bool,
    /// The cells in the order of their nominal numbers, best first.
    pub cells: Vec<CellNumbers>,
    /// What the cells are, in the same order.
    pub traits: Vec<TraitAnswer>,
    /// What to know of this comparison.
    pub notes: Vec<String>,
}

impl CellAnswer {
    /// A cell after its run.
    pub(super) fn of(cell: &Cell, answer: &StudyAnswer) -> CellAnswer {
        CellAnswer {
            name: cell.name.clone(),
            study: cell.shown.clone(),
            title: answer.title.clone(),
            robot: answer.robot.name.clone(),
            robot_title: answer.robot.title.clone(),
            compliance_assumed: answer.robot.compliance_assumed,
            warnings: answer.warnings.clone(),
            sources: answer.sources.clone(),
        }
    }
}

/// All entries by name, paths first, then holes, maps and volumes, each kind in the order given.
pub(super) fn put_together(
    of: &ComparableCells,
    mut left_out: Vec<String>,
    entries: Vec<Entry>,
    cells: Vec<CellAnswer>,
) -> ComparisonResult {
    let mut groups: Vec<Vec<Entry>> = Vec::new();
    for entry in entries {
        let same = |group: &&mut Vec<Entry>| {
            let first = group
                .first()
                .map(|first| (&first.requested.name, first.requested.kind));
            first == Some((&entry.requested.name, entry.requested.kind))
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(entry),
            None => groups.push(vec![entry]),
        }
    }
    let place = |group: &Vec<Entry>| {
        let kind = group.first().map(|first| first.requested.kind);
        ["path", "holes", "map", "volume"]
            .into_iter()
            .position(|one| Some(one) == kind)
    };
    groups.sort_by_key(place);
    let (mut analyses, mut curves) = (Vec::new(), Vec::new());
    for group in groups {
        if let [alone] = &group[..] {
            let name = &cells[alone.cell].name;
            left_out.push(format!(
                "only {name} has the analysis `{}`.",
                alone.requested.name
            ));
            continue;
        }
        let (given, drawn) = compared(of, group, &cells);
        analyses.push(given);
        curves.push(drawn);
    }
    let answer = ComparisonAnswer {
        format: 1,
        armill: env!("CARGO_PKG_VERSION"),
        answer: analyses.first().map_or_else(String::new, in_a_sentence),
        analyses,
        left_out,
        warnings: warnings(&cells),
        sources: sources(&cells),
        cells,
    };
    ComparisonResult { answer, curves }
}

/// Which cell is best, and which have assumed compliances.
fn in_a_sentence(first: &ComparedAnswer) -> String {
    match sentence::assumed(first.cells.iter()) {
        Some(assumed) => format!("{} {assumed}", first.answer),
        None => first.answer.clone(),
    }
}

/// One analysis, its cells best first.
fn compared(
    of: &ComparableCells,
    mut group: Vec<Entry>,
    cells: &[CellAnswer],
) -> (ComparedAnswer, Vec<Curve>) {
    let first = group
        .first()
        .map(|entry| (entry.requested.name.clone(), entry.requested.kind));
    let (name, kind) = first.unwrap_or_default();
    let mut notes = unlike_paths(of, &group, &name);
    group.sort_by(|a, b| better(&a.requested.numbers, &b.requested.numbers));
    let traits = traits(&group);
    let (mut numbers, mut curves) = (Vec::new(), Vec::new());
    let (mut sensitivities, mut least) = (Vec::new(), Vec::new());
    for entry in group {
        let cell = &cells[entry.cell];
        sensitivities.push(entry.sensitivity);
        least.push(entry.least);
        numbers.push(CellNumbers {
            cell: cell.name.clone(),
            robot: cell.robot.clone(),
            compliance_assumed: cell.compliance_assumed,
            ..entry.requested.numbers
        });
        curves.extend(entry.curve);
    }
    let of_arm = |one: &&TraitAnswer| ["robot", "compliance"].contains(&one.what);
    let shared = |a: usize, b: usize| {
        let mut arms = traits.iter().filter(of_arm);
        match arms.all(|one| one.of[a] == one.of[b]) {
            true => SharedInputs::OneRobot,
            false => SharedInputs::LoadAndTool,
        }
    };
    let candidates = numbers.iter().zip(&sensitivities).zip(&least);
    let candidates: Vec<Candidate<'_>> = candidates
        .map(|((numbers, sensitivity), least)| Candidate {
            numbers,
            sensitivity: sensitivity.as_ref(),
            least,
        })
        .collect();
    let verdict = verdict(&candidates, |index| shared(0, index));
    notes.extend(sentence::uncertainties(&candidates, shared));
    let given = ComparedAnswer {
        answer: sentence::ranking(&name, kind, &numbers, &verdict),
        is_ranked: verdict == Verdict::First,
        name,
        kind,
        cells: numbers,
        traits,
        notes,
    };
    (given, curves)
}

/// Which of two cells is better: `Less` where `a` is.
fn better(a: &CellNumbers, b: &CellNumbers) -> Ordering {
    let within = |of: &CellNumbers| of.fraction_within_and_inside_joint_limits;
    let reaches = |of: &CellNumbers| of.inside_joint_limits as f64 / of.points.max(1) as f64;
    let largest = |of: &CellNumbers| of.max_in_plane_um.unwrap_or(f64::INFINITY);
    let by = within(b).total_cmp(&within(a));
    by.then(reaches(b).total_cmp(&reaches(a)))
        .then(largest(a).total_cmp(&largest(b)))
}

/// Properties of the cells: one row each, whether they differ or not.
fn traits(group: &[Entry]) -> Vec<TraitAnswer> {
    let rows = group.first().map_or(0, |entry| entry.traits.len());
    (0..rows)
        .map(|row| {
            let of: Vec<String> = group.iter().map(|entry| entry.traits[row].1.clone()).collect();
            TraitAnswer {
                what: group[0].traits[row].0,
                differs: of.iter().any(|one| *one != of[0]),
                of,
            }
        })
        .collect()
}

/// Points of two paths nearer than this are the same, m: the error of reading a coordinate.
const SAME: f64 = 1e-6;

/// Paths of one name that are not the same path, relative to the first; each in its own frame.
fn unlike_paths(of: &ComparableCells, group: &[Entry], name: &str) -> Vec<String> {
    let path = |entry: &Entry| {
        let analyses = &of.cells[entry.cell].study.analyses;
        analyses.iter().find_map(|analysis| match &analysis.subject {
            Subject::Path(path) if analysis.name == name => Some(&**path),
            Subject::Holes(holes) if analysis.name == name => Some(&holes.path),
            _ => None,
        })
    };
    let Some((first, reference)) = group.first().and_then(|entry| Some((entry, path(entry)?))) else {
        return Vec::new();
    };
    let unlike = |entry: &Entry| {
        let other = path(entry)?;
        let [here, there] = [first, entry].map(|entry| &of.cells[entry.cell].name);
        let pairs = reference.track.path.points.iter().zip(&other.track.path.points);
        let apart = pairs.map(|(a, b)| (a.at - b.at).norm()).fold(0.0, f64::max);
        if reference.track.len() == other.track.len() && apart <= SAME {
            return None;
        }
        let size =
            |path: &PathAnalysis| format!("{} points over {:.1} mm", path.track.len(), to_mm(path.length()));
        let how = match reference.track.len() == other.track.len() {
            true => format!("points differ by up to {:.3} mm", to_mm(apart)),
            false => format!("{} against {}", size(reference), size(other)),
        };
        Some(format!(
            "The paths `{name}` of {here} and {there} are not the same: {how}."
        ))
    };
    group.iter().skip(1).filter_map(unlike).collect()
}

/// Warnings of the cells: once if all have it, otherwise with the name of the cell.
fn warnings(cells: &[CellAnswer]) -> Vec<String> {
    let mut given = Vec::new();
    for cell in cells {
        for warning in &cell.warnings {
            let all = cells.iter().all(|other| other.warnings.contains(warning));
            let said = if all {
                warning.clone()
            } else {
                format!("{}: {warning}", cell.name)
            };
            if !given.contains(&said) {
                given.push(said);
            }
        }
    }
    given
}

/// Sources of all cells, each once.
fn sources(cells: &[CellAnswer]) -> Vec<Source> {
    let mut given: Vec<Source> = Vec::new();
    for source in cells.iter().flat_map(|cell| &cell.sources) {
        if !given.contains(source) {
            given.push(source.clone());
        }
    }
    given
}
