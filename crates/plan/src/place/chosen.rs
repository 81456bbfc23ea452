//! The analysis that a search places: a path, or a set of holes.

use armill_core::optimize::PostureSearch;
use armill_study::analysis::Subject;
use armill_study::analysis::path::PathAnalysis;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;

/// A path, or a set of holes with the permitted spins.
pub(super) type Placed<'a> = (&'a PathAnalysis, Option<&'a PostureSearch>);

/// The analysis that is placed: its index, its name, and its path.
pub(super) fn chosen<'a>(
    study: &'a Study,
    requested: Option<&str>,
) -> Result<(usize, (&'a str, Placed<'a>)), StudyError> {
    let all: Vec<(usize, (&str, Placed<'_>))> = study
        .analyses
        .iter()
        .enumerate()
        .filter_map(|(index, analysis)| {
            let about: Placed<'_> = match &analysis.subject {
                Subject::Path(path) => (path, None),
                Subject::Holes(holes) => (&holes.path, Some(&holes.search)),
                _ => return None,
            };
            Some((index, (analysis.name.as_str(), about)))
        })
        .collect();
    let names = || {
        let names = all.iter().map(|(_, (name, _))| format!("`{name}`"));
        names.collect::<Vec<_>>().join(", ")
    };
    match (requested, &all[..]) {
        (None, []) => Err(StudyError::value(
            "the study has no path that could be placed",
            "[[analysis]] kind = \"path\" with a program or a shape, or kind = \"holes\"",
        )),
        (None, [one]) => Ok(*one),
        (None, _) => {
            let message = format!("the study has several paths: {}", names());
            Err(StudyError::value(
                message,
                "select one: --analysis NAME, or `place.analysis`",
            ))
        }
        (Some(requested), _) => all
            .iter()
            .find(|(_, (name, _))| *name == requested)
            .copied()
            .ok_or_else(|| {
                let message = format!("the study has no path called `{requested}`");
                StudyError::value(message, format!("its paths: {}", names()))
            }),
    }
}
