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
//! `numbers`: a cell in numbers; `traits`: differences of the cells; `curve`: the deviation along a path; `entry`: all
//! of these of one cell; `answer`: the result; `sentence`: the ranking as text; `output`: files.

mod answer;
mod cells;
mod common_analyses;
mod curve;
mod entry;
mod numbers;
mod other_robot;
mod output;
mod sentence;
mod traits;

pub use answer::{CellAnswer, ComparedAnswer, ComparisonAnswer, ComparisonResult};
pub use cells::{Cell, ComparableCells, cells};
pub use numbers::CellNumbers;
pub use output::write;
pub use traits::TraitAnswer;

use armill_core::watch::Watch;
use armill_study::answer::answer as answer_study;
use armill_study::error::StudyError;
use armill_study::run::run;

use self::entry::{Entry, of_cell};

/// These cells with the analyses that at least two of them have.
///
/// # Errors
/// There are none.
pub fn comparable(mut cells: Vec<Cell>) -> Result<ComparableCells, StudyError> {
    let left_out = common_analyses::keep(&mut cells)?;
    Ok(ComparableCells { cells, left_out })
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
