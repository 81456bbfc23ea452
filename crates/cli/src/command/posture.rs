//! `armill posture`: the best spin of the tool and branch along the paths of a study.
//!
//! The study is run with a search on every path, and all results are written as by `armill run`, into `--out`
//! (`posture` next to the study). Stdout has one sentence per path: before and after.

use armill_study::answer::StudyAnswer;
use armill_study::input::posture_search::{ComponentName, ObjectiveName, SearchTable};
use armill_study::{StudyError, studies};

use super::run::{folder, results};
use crate::arguments::PostureArguments;
use crate::arguments::numbers::within;
use crate::outcome::Outcome;

/// Searches along all paths of the study and writes the results.
///
/// # Errors
/// No such study, or its problems; a study without paths; an invalid range of spins; a folder that cannot be written.
pub(crate) fn run(arguments: &PostureArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.run.study)?;
    let mut study = found.read()?;
    study.search_postures(requested(arguments)?.as_ref())?;
    let out = folder("posture", "posture", &found, &arguments.run)?;
    results(&study, &out, &arguments.run, None, summary)
}

/// The settings given by the options; `None` if there are none.
fn requested(arguments: &PostureArguments) -> Result<Option<SearchTable>, StudyError> {
    let bounded = |option: &str, value: Option<f64>, range: [f64; 2]| {
        value.map(|value| within(option, value, range)).transpose()
    };
    let turns: Option<[f64; 2]> = match &arguments.turns_deg {
        Some(turns) => Some(turns.as_slice().try_into().map_err(|_| {
            let message = format!("--turns-deg: {} numbers, 2 are required", turns.len());
            StudyError::value(message, "the first and the last: --turns-deg -90,90")
        })?),
        None => None,
    };
    for turn in turns.into_iter().flatten() {
        within("--turns-deg", turn, [-720.0, 720.0])?;
    }
    let table = SearchTable {
        turns_deg: turns,
        step_deg: bounded("--step-deg", arguments.step_deg, [0.1, 180.0])?,
        component: arguments.component.map(ComponentName::from),
        objective: arguments.objective.map(ObjectiveName::from),
        turn_deg_per_mm: bounded("--turn-deg-per-mm", arguments.turn_deg_per_mm, [1e-6, 1e3])?,
        least_wrist_deg: bounded("--least-wrist-deg", arguments.least_wrist_deg, [0.0, 80.0])?,
        margin_deg: bounded("--margin-deg", arguments.margin_deg, [0.0, 90.0])?,
        reversal_um_mm: bounded("--reversal-um-mm", arguments.reversal_um_mm, [0.0, 1e9])?,
        lean: None,
        axes: Vec::new(),
    };
    Ok((!table.is_empty()).then_some(table))
}

/// One sentence per path.
fn summary(answer: &StudyAnswer) -> String {
    let of_paths = answer.paths.iter().filter_map(|path| {
        let search = path.search.as_ref()?;
        let branch = path
            .followed_branch
            .as_deref()
            .map_or(String::new(), |branch| format!(" in {branch}"));
        Some(format!("{}{branch}: {}.", path.name, search.sentence()))
    });
    of_paths.collect::<Vec<_>>().join("\n")
}
