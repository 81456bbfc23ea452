//! Which cell holds the tolerance? The same paths asked of several cells, side by side.
//!
//! A cell is a study, or a study with another robot in place of its own. Asks are matched by their names, so that only what
//! two cells ask alike is compared; it is run as `armill run` runs it, and told in the same numbers:
//!
//! | number | of |
//! |---|---|
//! | mean, 95 %, largest in-plane deviation; largest along the normal | the points that are reached |
//! | points within the tolerance, also inside joint limits | all points, reached or not |
//!
//! Cells stand best first: by the part of all points that holds the tolerance inside the joint limits, then by the points
//! that are reached there, then by the largest deviation.
//!
//! `cells`: which cells; `asked_alike`: what is asked of several; `numbers`: a cell in numbers; `traits`: in what cells differ;
//! `curve`: the deviation along a path; `answer`: all of it; `sentence`: which is best, in words; `output`: files.

mod answer;
mod asked_alike;
mod cells;
mod curve;
mod numbers;
mod output;
mod sentence;
mod traits;

pub use answer::{CellAnswer, ComparedAnswer, ComparisonAnswer};
pub use cells::{Cell, cells};
pub use numbers::CellNumbers;
pub use output::write;
pub use traits::TraitAnswer;

use armill_core::watch::Watch;

use crate::answer::{StudyAnswer, answer as answer_study};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::run::{Done, Found, point_count, run};
use curve::Curve;
use numbers::Asked;

/// Cells that ask for something in common, with the rest left out.
#[derive(Clone, Debug)]
pub struct Comparable {
    cells: Vec<Cell>,
    left_out: Vec<String>,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Compared {
    /// In numbers and words.
    pub answer: ComparisonAnswer,
    /// Of each compared path the deviation along it, cell by cell in the order of its numbers.
    curves: Vec<Vec<Curve>>,
}

/// These cells with the asks that at least two of them have.
///
/// # Errors
/// They have none.
pub fn comparable(mut cells: Vec<Cell>) -> Result<Comparable, StudyError> {
    let left_out = asked_alike::keep(&mut cells)?;
    Ok(Comparable { cells, left_out })
}

impl Comparable {
    /// How many points are asked for, the end of the progress of [`compare`].
    pub fn point_count(&self) -> usize {
        self.cells.iter().map(|cell| point_count(&cell.study)).sum()
    }
}

/// What one cell gave to one name.
struct Entry {
    cell: usize,
    requested: Asked,
    traits: Vec<(&'static str, String)>,
    curve: Option<Curve>,
}

/// Runs every cell, one after the other, and puts them side by side.
///
/// # Errors
/// Those of a run; cancelled by the watch.
pub fn compare(of: &Comparable, watch: Watch<'_>) -> Result<Compared, StudyError> {
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

/// What one cell has to say of each name.
fn of_cell(cell: usize, study: &Study, done: &[Done<'_>], answer: &StudyAnswer) -> Vec<Entry> {
    let (mut maps, mut paths) = (answer.maps.iter(), answer.paths.iter());
    let (mut volumes, mut holes) = (answer.volumes.iter(), answer.holes.iter());
    let mut entries = Vec::new();
    let mut add = |requested: Option<Asked>, traits: Vec<(&'static str, String)>, curve| {
        entries.extend(requested.map(|requested| Entry {
            cell,
            requested,
            traits,
            curve,
        }));
    };
    for done in done {
        match &done.found {
            Found::Map(sheet, map) => {
                let requested = maps
                    .next()
                    .map(|given| Asked::map(given, sheet.setting.limit, &map.answers));
                add(requested, traits::of_sheet(study, sheet), None);
            }
            Found::Sections(sections) => {
                for section in sections {
                    let limit = section.sheet.setting.limit;
                    let requested = maps
                        .next()
                        .map(|given| Asked::map(given, limit, &section.map.answers));
                    add(requested, traits::of_sheet(study, section.sheet), None);
                }
            }
            Found::Volume(setting, volume) => {
                let requested = volumes
                    .next()
                    .map(|given| Asked::volume(given, setting.limit, &volume.answers));
                add(requested, traits::of_volume(study, setting, volume), None);
            }
            Found::Path(analysis, found) => {
                let requested = paths
                    .next()
                    .map(|given| Asked::path(given, (analysis, &found.along.answers)));
                let curve = Curve::along(analysis, &found.along.answers);
                add(requested, traits::of_path(study, analysis), Some(curve));
            }
            Found::Holes(analysis, found) => {
                let requested = holes
                    .next()
                    .map(|given| Asked::holes(given, analysis.path.setting.limit, &found.answers));
                add(requested, traits::of_holes(study, analysis), None);
            }
        }
    }
    entries
}
