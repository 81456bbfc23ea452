//! What is the error of a measured circle made of, and how much of it is predicted?
//!
//! ```text
//! study with [measured] -> run the circle -> its parts -> combine: Combined (SI) -> BudgetAnswer, table, pictures
//! ```
//!
//! [`parts`](mod@parts): what the load does, and what there is without it. [`combine`](mod@combine): predicted and measured curves at common angles. [`answer`](mod@answer): what came of it, in numbers.
//! [`output`]: its table and pictures.

pub mod answer;
pub mod combine;
pub mod output;
pub mod parts;

pub use answer::{BudgetAnswer, answer};
pub use combine::{Combined, combine};

use armill_core::watch::Watch;

use crate::error::StudyError;
use crate::file::experiment::Experiment;
use crate::file::path::PathAnalysis;
use crate::file::resolve::{Study, Subject};
use crate::run::{Done, Found, passes, runner};

/// What was measured, and the path that it was measured on.
fn circle(study: &Study) -> Result<(&Experiment, &PathAnalysis), StudyError> {
    let nothing = || {
        StudyError::value(
            "the study names nothing that was measured",
            "[measured] with part = \"cmm.csv\" and ballbar = [\"first.csv\", \"second.csv\"]",
        )
    };
    let experiment = study.experiment.as_ref().ok_or_else(nothing)?;
    let path = study.analyses.iter().find_map(|analysis| match &analysis.subject {
        Subject::Path(path) if analysis.name == experiment.analysis => Some(&**path),
        _ => None,
    });
    Ok((experiment, path.ok_or_else(nothing)?))
}

/// The points that the progress of [`budget`] ends at.
///
/// # Errors
/// A study in which nothing was measured.
pub fn point_count(study: &Study) -> Result<usize, StudyError> {
    let (_, path) = circle(study)?;
    Ok(path.track.len() * passes(path))
}

/// The budget of the circle that was measured; of all that the study asks for that circle alone is run.
///
/// # Errors
/// A study in which nothing was measured; those of running the path; curves that have too few angles in common.
pub fn budget(study: &Study, watch: Watch<'_>) -> Result<(Combined, BudgetAnswer), StudyError> {
    let (experiment, path) = circle(study)?;
    let found = runner(study, watch)?.path(path)?;
    let combined = combine((study, experiment), (path, &found), watch)?;
    let given = answer(experiment, path, &combined);
    Ok((combined, given))
}

/// The budget beside all that was run; `None` where nothing was measured, a sentence where it cannot be told.
pub(crate) fn beside(study: &Study, done: &[Done<'_>]) -> Option<Result<(Combined, BudgetAnswer), String>> {
    let experiment = study.experiment.as_ref()?;
    let found = done.iter().find(|done| done.name == experiment.analysis)?;
    let Found::Path(path, found) = &found.found else {
        return None;
    };
    let combined = combine((study, experiment), (path, found), Watch::NONE).map(|combined| {
        let given = answer(experiment, path, &combined);
        (combined, given)
    });
    Some(combined.map_err(|error| match error {
        StudyError::Value { message, .. } => message,
        other => other.to_string(),
    }))
}
