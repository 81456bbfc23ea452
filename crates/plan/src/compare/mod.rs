//! Comparison of cells: the same paths in several cells.
//!
//! A cell is a study, or a study with another robot. Analyses are matched by their names, so that only those that
//! two cells have in common are compared; they are run as by `armill run`, and reported with the same numbers:
//!
//! | number | of |
//! |---|---|
//! | mean, 95 %, largest in-plane deviation; largest along the normal | the points that are reached |
//! | points within the tolerance, also inside joint limits | all points, reached or not |
//!
//! Cells are ranked by the fraction of all points that is within the tolerance and the joint limits, then by the points
//! that are reached within the joint limits, then by the largest deviation.
//!
//! `cells`: the cells; `other_robot`: a study with another robot; `common_analyses`: the analyses they share;
//! `numbers`: a cell in numbers; `traits`: differences of the cells; `curve`: the deviation along a path; `answer`: the
//! result; `sentence`: the ranking as text; `output`: files.

mod answer;
mod cells;
mod common_analyses;
mod curve;
mod numbers;
mod other_robot;
mod output;
mod sentence;
mod traits;

pub use answer::{CellAnswer, ComparedAnswer, ComparisonAnswer};
pub use cells::{Cell, cells};
pub use numbers::CellNumbers;
pub use output::write;
pub use traits::TraitAnswer;

use armill_core::watch::Watch;
use armill_study::analysis::{AnalysisData, AnalysisResult};
use armill_study::answer::{StudyAnswer, answer as answer_study};
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::run::{point_count, run};

use self::curve::Curve;
use self::numbers::AnalysisNumbers;

/// Cells with analyses in common; the others are left out.
#[derive(Clone, Debug)]
pub struct ComparableCells {
    cells: Vec<Cell>,
    left_out: Vec<String>,
}

/// Result of a comparison.
#[derive(Clone, Debug)]
pub struct ComparisonResult {
    /// As numbers and text.
    pub answer: ComparisonAnswer,
    /// For each compared path the deviation along it, per cell in the order of its numbers.
    curves: Vec<Vec<Curve>>,
}

/// These cells with the analyses that at least two of them have.
///
/// # Errors
/// There are none.
pub fn comparable(mut cells: Vec<Cell>) -> Result<ComparableCells, StudyError> {
    let left_out = common_analyses::keep(&mut cells)?;
    Ok(ComparableCells { cells, left_out })
}

impl ComparableCells {
    /// Number of points, the end of the progress of [`compare`].
    pub fn point_count(&self) -> usize {
        self.cells.iter().map(|cell| point_count(&cell.study)).sum()
    }
}

/// Result of one cell for one name.
struct Entry {
    cell: usize,
    requested: AnalysisNumbers,
    traits: Vec<(&'static str, String)>,
    curve: Option<Curve>,
}

/// Runs all cells, one after the other, and compares them.
///
/// # Errors
/// Those of a run; cancelled by the watch.
pub fn compare(of: &ComparableCells, watch: Watch<'_>) -> Result<ComparisonResult, StudyError> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut given = Vec::new();
    for (cell, here) in of.cells.iter().enumerate() {
        let done = run(&here.study, watch)?;
        let answer = answer_study(&here.study, &done);
        entries.extend(of_cell(cell, &here.study, &done, &answer));
        given.push(CellAnswer::of(here, &answer));
    }
    Ok(answer::put_together(of, entries, given))
}

/// The entries of one cell.
fn of_cell(cell: usize, study: &Study, done: &[AnalysisResult<'_>], answer: &StudyAnswer) -> Vec<Entry> {
    let (mut maps, mut paths) = (answer.maps.iter(), answer.paths.iter());
    let (mut volumes, mut holes) = (answer.volumes.iter(), answer.holes.iter());
    let mut entries = Vec::new();
    let mut add = |requested: Option<AnalysisNumbers>, traits: Vec<(&'static str, String)>, curve| {
        entries.extend(requested.map(|requested| Entry {
            cell,
            requested,
            traits,
            curve,
        }));
    };
    for done in done {
        match &done.found {
            AnalysisData::Map(sheet, map) => {
                let requested = maps
                    .next()
                    .map(|given| AnalysisNumbers::map(given, sheet.setting.tolerance, &map.answers));
                add(requested, traits::of_sheet(study, sheet), None);
            }
            AnalysisData::Sections(sections) => {
                for section in sections {
                    let limit = section.sheet.setting.tolerance;
                    let requested = maps
                        .next()
                        .map(|given| AnalysisNumbers::map(given, limit, &section.map.answers));
                    add(requested, traits::of_sheet(study, section.sheet), None);
                }
            }
            AnalysisData::Volume(setting, volume) => {
                let requested = volumes
                    .next()
                    .map(|given| AnalysisNumbers::volume(given, setting.tolerance, &volume.answers));
                add(requested, traits::of_volume(study, setting, volume), None);
            }
            AnalysisData::Path(analysis, found) => {
                let requested = paths
                    .next()
                    .map(|given| AnalysisNumbers::path(given, analysis, &found.along.answers));
                let curve = Curve::along(analysis, &found.along.answers);
                add(requested, traits::of_path(study, analysis), Some(curve));
            }
            AnalysisData::Holes(analysis, found) => {
                let requested = holes.next().map(|given| {
                    AnalysisNumbers::holes(given, analysis.path.setting.tolerance, &found.answers)
                });
                add(requested, traits::of_holes(study, analysis), None);
            }
        }
    }
    entries
}
