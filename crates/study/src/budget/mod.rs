//! Error budget of a measured circle: its contributions, and how much of it is predicted.
//!
//! ```text
//! study with [measured] -> run the circle -> its parts -> combine: CombinedCurves (SI) -> BudgetAnswer, table, pictures
//! ```
//!
//! [`parts`](mod@parts): the effect of the load, and the path without it. [`combine`](mod@combine): predicted and
//! measured curves at common angles. [`answer`](mod@answer): the values of the result. Table and pictures:
//! [`crate::output::budget`].

pub mod answer;
pub mod combine;
pub mod parts;

pub use answer::{BudgetAnswer, answer};
pub use combine::{CombinedCurves, combine};

use armill_core::watch::Watch;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::passes;
use crate::analysis::runner::Runner;
use crate::analysis::{AnalysisData, AnalysisResult, Subject};
use crate::error::StudyError;
use crate::file::experiment::Experiment;
use crate::file::resolve::Study;

/// The measurements, and the path on which they were made.
fn circle(study: &Study) -> Result<(&Experiment, &PathAnalysis), StudyError> {
    let has_scan = study.analyses.iter().any(|analysis| match &analysis.subject {
        Subject::Path(path) => path
            .machined_part
            .as_ref()
            .is_some_and(|part| part.scan.is_some()),
        _ => false,
    });
    let nothing = || match has_scan {
        true => StudyError::value(
            "the study has no measured circle: its scan of the part is evaluated with the path",
            "armill run: report and result.json have the contributions to the deviation of the scan",
        ),
        false => StudyError::value(
            "the study has no measurements",
            "[measured] with part = \"cmm.csv\" and ballbar = [\"first.csv\", \"second.csv\"]",
        ),
    };
    let experiment = study.experiment.as_ref().ok_or_else(nothing)?;
    let path = study
        .analyses
        .iter()
        .find_map(|analysis| match &analysis.subject {
            Subject::Path(path) if analysis.name == experiment.analysis => Some(&**path),
            _ => None,
        });
    Ok((experiment, path.ok_or_else(nothing)?))
}

/// The points that the progress of [`budget`] ends at.
///
/// # Errors
/// A study without measurements.
pub fn point_count(study: &Study) -> Result<usize, StudyError> {
    let (_, path) = circle(study)?;
    Ok(path.track.len() * passes(path))
}

/// The budget of the measured circle; only this path of the study is computed.
///
/// # Errors
/// A study without measurements; errors of the path; curves that have too few angles in common.
pub fn budget(study: &Study, watch: Watch<'_>) -> Result<(CombinedCurves, BudgetAnswer), StudyError> {
    let (experiment, path) = circle(study)?;
    let found = Runner::new(&study.robot.robot, watch)?.path(path)?;
    let combined = combine(study, experiment, path, &found, watch)?;
    let given = answer(experiment, path, &combined);
    Ok((combined, given))
}

/// The budget for results already computed; `None` without measurements, a sentence if it cannot be computed.
pub(crate) fn of_results(
    study: &Study,
    done: &[AnalysisResult<'_>],
) -> Option<Result<(CombinedCurves, BudgetAnswer), String>> {
    let experiment = study.experiment.as_ref()?;
    let found = done.iter().find(|done| done.name == experiment.analysis)?;
    let AnalysisData::Path(path, found) = &found.found else {
        return None;
    };
    let combined = combine(study, experiment, path, found, Watch::NONE).map(|combined| {
        let given = answer(experiment, path, &combined);
        (combined, given)
    });
    Some(combined.map_err(|error| match error {
        StudyError::Value { message, .. } => message,
        other => other.to_string(),
    }))
}
