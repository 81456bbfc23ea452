//! What cells ask alike: asks of the same name and kind.
//!
//! Everything that one cell alone asks is left out and told, so that nothing is run for nothing.

use super::cells::Cell;
use crate::error::StudyError;
use crate::file::resolve::{Ask, Subject};

/// Names of asks that an error lists of each study at most.
const LISTED: usize = 6;

/// The word for what an ask is about.
pub(super) fn kind(subject: &Subject) -> &'static str {
    match subject {
        Subject::Map(_) => "map",
        Subject::Sections(_) => "sections",
        Subject::Volume(..) => "volume",
        Subject::Path(_) => "path",
        Subject::Holes(_) => "holes",
    }
}

/// Takes out of each study what no other study asks; tells what that is, a sentence each.
///
/// # Errors
/// Nothing is left.
pub(super) fn keep(cells: &mut [Cell]) -> Result<Vec<String>, StudyError> {
    let requested: Vec<Vec<(String, &'static str)>> = cells
        .iter()
        .map(|cell| cell.study.analyses.iter().map(named).collect())
        .collect();
    let others = |cell: usize, analysis: &Ask| {
        let all = requested.iter().enumerate();
        all.filter(|(other, analyses)| *other != cell && analyses.contains(&named(analysis)))
            .count()
    };
    let mut left_out = Vec::new();
    for (index, cell) in cells.iter_mut().enumerate() {
        let name = cell.name.clone();
        let alone = cell.study.analyses.iter().filter(|analysis| others(index, analysis) == 0);
        left_out.extend(alone.map(|analysis| {
            format!(
                "{} `{}` is asked of {name} alone and left out.",
                kind(&analysis.subject),
                analysis.name
            )
        }));
        cell.study.analyses.retain(|analysis| others(index, analysis) > 0);
    }
    if cells.iter().all(|cell| cell.study.analyses.is_empty()) {
        let of = cells.iter().zip(&requested).map(|(cell, analyses)| {
            let names: Vec<String> = analyses
                .iter()
                .take(LISTED)
                .map(|(name, kind)| format!("{kind} `{name}`"))
                .collect();
            let more = if analyses.len() > LISTED { ", ..." } else { "" };
            format!("{} asks for {}{more}", cell.name, names.join(", "))
        });
        let of: Vec<String> = of.collect();
        let message = format!("the studies ask for nothing in common: {}", of.join("; "));
        let hint = "asks are matched by name and kind: give the same path the same `name` in each study";
        return Err(StudyError::value(message, hint));
    }
    Ok(left_out)
}

fn named(analysis: &Ask) -> (String, &'static str) {
    (analysis.name.clone(), kind(&analysis.subject))
}
