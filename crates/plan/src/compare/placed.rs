//! Each robot at its own best placement of the part.
//!
//! A placement that suits one robot does not suit another: where cells have different robots, the first path or set of
//! holes that they have in common is also evaluated where a search of limited effort places it for each. The search has
//! the bounds of `[place]` of the study, otherwise [`ROOM_MM`] in each direction about the given placement, and keeps a
//! margin of [`MARGIN_DEG`] from the joint limits. A placement that is no significant improvement is not used.

use armill_core::units::to_mm;
use armill_core::watch::Watch;
use armill_study::analysis::Subject;
use armill_study::error::StudyError;
use armill_study::file::placement::PlaceTable;
use armill_study::file::resolve::Study;
use armill_study::run::point_count;

use super::cells::{Cell, ComparableCells};
use crate::place::{Journal, PlacementSearch};

/// Bounds of the search about the given placement, mm.
const ROOM_MM: f64 = 600.0;
/// Distance of every joint from its limits, unless the study gives one, deg: a placement at the limit itself is none.
const MARGIN_DEG: f64 = 2.0;
/// Seed of the searches.
const SEED: u64 = 1;

/// Where the part is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placing {
    /// Where the studies have it.
    Given,
    /// There, and where it is best for each robot.
    BestForEach,
}

/// The first path or set of holes that all cells have.
fn placed_name(of: &ComparableCells, placing: Placing) -> Option<&str> {
    if placing == Placing::Given || !of.has_several_robots() {
        return None;
    }
    let can_move = |cell: &Cell, name: &str| {
        cell.study.analyses.iter().any(|analysis| {
            analysis.name == name && matches!(analysis.subject, Subject::Path(_) | Subject::Holes(_))
        })
    };
    let mut names = of
        .cells
        .first()?
        .study
        .analyses
        .iter()
        .map(|analysis| analysis.name.as_str());
    names.find(|name| of.cells.iter().all(|cell| can_move(cell, name)))
}

/// Number of points of all cells and of placements of all searches, the end of the progress of
/// [`compare`](super::compare).
pub fn progress_count(of: &ComparableCells, placing: Placing) -> usize {
    let points: usize = of.cells.iter().map(|cell| point_count(&cell.study)).sum();
    let Some(name) = placed_name(of, placing) else {
        return points;
    };
    let count = |cell: &Cell| search(&cell.study, name).map_or(0, |search| search.place_count());
    points + of.cells.iter().map(count).sum::<usize>()
}

/// The search for one cell.
fn search<'s>(study: &'s Study, name: &str) -> Result<PlacementSearch<'s>, StudyError> {
    let given = study.place.as_ref();
    let requested = PlaceTable {
        analysis: Some(name.to_owned()),
        margin_deg: given.and_then(|place| place.margin_deg).or(Some(MARGIN_DEG)),
        ..PlaceTable::default()
    };
    let search = PlacementSearch::new(study, requested.clone(), SEED)?;
    if given.is_some_and(PlaceTable::is_free) {
        return Ok(search.brief());
    }
    let [x, y, z, ..] = search.nominal_parameters().part;
    let [x_mm, y_mm, z_mm] = [x, y, z].map(|at| Some([to_mm(at) - ROOM_MM, to_mm(at) + ROOM_MM]));
    let about = PlaceTable {
        x_mm,
        y_mm,
        z_mm,
        ..requested
    };
    Ok(PlacementSearch::new(study, about, SEED)?.brief())
}

/// The studies with each robot at its best placement, in the order of the cells; or why there are none. `note` receives
/// what is done.
///
/// # Errors
/// Cancelled by the watch.
pub(super) fn placed_studies(
    of: &ComparableCells,
    placing: Placing,
    watch: Watch<'_>,
    note: &dyn Fn(&str),
) -> Result<Result<Vec<Study>, String>, StudyError> {
    let Some(name) = placed_name(of, placing) else {
        return Ok(Ok(Vec::new()));
    };
    let mut studies = Vec::new();
    for cell in &of.cells {
        let quiet = |_: &str| ();
        note(&format!("placement for {}", cell.name));
        let found = search(&cell.study, name)
            .and_then(|search| search.search(&mut Journal::none(), watch, &quiet))
            .and_then(|found| found.with_tool(cell.source.read_changed(|study| found.placed(study))?));
        match found {
            Ok(study) => studies.push(study),
            Err(StudyError::Cancelled(cancelled)) => return Err(StudyError::Cancelled(cancelled)),
            Err(error) => {
                return Ok(Err(format!(
                    "No best placement of each robot for `{name}`: {}: {error}.",
                    cell.name
                )));
            }
        }
    }
    Ok(Ok(studies))
}
