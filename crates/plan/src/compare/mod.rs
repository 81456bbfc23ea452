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
//! Where the robots differ, a path or set of holes is also evaluated where the part is best placed for each of them.
//!
//! Cells are ordered by the fraction of all points that is within the tolerance and the joint limits, then by the points
//! that are reached within the joint limits, then by the largest deviation. This order is a ranking only where the
//! largest deviation of the first differs from the others by more than the uncertainty of the difference, and the
//! compliances of the first are not assumed.
//!
//! `cells`: the cells; `other_robot`: a study with another robot; `common_analyses`: the analyses they share;
//! `placed`: the best placement of each robot; `numbers`: a cell in numbers; `verdict`: whether cells are ranked; `traits`: differences of the cells; `curve`: the deviation along a path; `entry`: all
//! of these of one cell; `answer`: the result; `sentence`: the ranking as text; `output`: files.

mod answer;
mod cells;
mod common_analyses;
mod curve;
mod entry;
mod numbers;
mod other_robot;
mod output;
mod placed;
mod sentence;
mod traits;
mod verdict;

pub use answer::{CellAnswer, ComparedAnswer, ComparisonAnswer, ComparisonResult};
pub use cells::{Cell, ComparableCells, cells};
pub use numbers::CellNumbers;
pub use output::write;
pub use placed::{Placing, progress_count};
pub use traits::TraitAnswer;

use armill_core::watch::Watch;
use armill_study::answer::answer as answer_study;
use armill_study::error::StudyError;
use armill_study::output::StudyResults;
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

/// Runs all cells, one after the other, and compares them; `note` receives what is done.
///
/// # Errors
/// Those of a run; cancelled by the watch.
pub fn compare(
    of: &ComparableCells,
    placing: Placing,
    watch: Watch<'_>,
    note: &dyn Fn(&str),
) -> Result<ComparisonResult, StudyError> {
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let (mut entries, mut given) = (Vec::new(), Vec::new());
    for (cell, here) in of.cells.iter().enumerate() {
        note(&here.name);
        let done = run(&here.study, watch)?;
        let answer = answer_study(&here.study, &done);
        let results = StudyResults {
            study: &here.study,
            done: &done,
            answer: &answer,
        };
        entries.extend(of_cell(cell, results, quiet)?);
        given.push(CellAnswer::of(here, &answer));
    }
    let mut left_out = of.left_out.clone();
    let placed = placed::placed_studies(of, placing, watch, note)?.unwrap_or_else(|reason| {
        left_out.push(reason);
        Vec::new()
    });
    for (cell, study) in placed.iter().enumerate() {
        let done = run(study, quiet)?;
        let answer = answer_study(study, &done);
        let results = StudyResults {
            study,
            done: &done,
            answer: &answer,
        };
        let of_placed = of_cell(cell, results, quiet)?;
        // The best placements come first: there each robot is judged for itself.
        entries.splice(cell..cell, of_placed.into_iter().map(Entry::at_best_placement));
    }
    Ok(answer::put_together(of, left_out, entries, given))
}
