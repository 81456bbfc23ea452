//! Analyses that cells have in common: those of the same name and kind.
//!
//! Analyses that only one cell has are left out and reported, so that they are not computed.

use armill_study::analysis::{Analysis, Subject};
use armill_study::error::StudyError;

use super::cells::Cell;

/// Greatest number of analyses listed per study in an error.
const LISTED: usize = 6;

/// Name of the kind of an analysis.
pub(super) fn kind(subject: &Subject) -> &'static str {
    match subject {
        Subject::Map(_) => "map",
        Subject::Sections(_) => "sections",
        Subject::Volume(..) => "volume",
        Subject::Path(_) => "path",
        Subject::Holes(_) => "holes",
    }
}

/// Removes from each study the analyses that no other study has; returns a sentence for each.
///
/// # Errors
/// No analysis is left.
pub(super) fn keep(cells: &mut [Cell]) -> Result<Vec<String>, StudyError> {
    let requested: Vec<Vec<(String, &'static str)>> = cells
        .iter()
        .map(|cell| cell.study.analyses.iter().map(named).collect())
        .collect();
    let others = |cell: usize, analysis: &Analysis| {
        let all = requested.iter().enumerate();
        all.filter(|(other, analyses)| *other != cell && analyses.contains(&named(analysis)))
            .count()
    };
    let mut left_out = Vec::new();
    for (index, cell) in cells.iter_mut().enumerate() {
        let name = cell.name.clone();
        let alone = cell
            .study
            .analyses
            .iter()
            .filter(|analysis| others(index, analysis) == 0);
        left_out.extend(alone.map(|analysis| {
            format!(
                "{} `{}` is left out: only {name} has it.",
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
            format!("{} has {}{more}", cell.name, names.join(", "))
        });
        let of: Vec<String> = of.collect();
        let message = format!("the studies have no analysis in common: {}", of.join("; "));
        let hint = "analyses are matched by name and kind: give the same path the same `name` in each study";
        return Err(StudyError::value(message, hint));
    }
    Ok(left_out)
}

fn named(analysis: &Analysis) -> (String, &'static str) {
    (analysis.name.clone(), kind(&analysis.subject))
}
