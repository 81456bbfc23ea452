//! Names of analyses: valid as file names, unique, and found by the statements that refer to them.
//!
//! The letters and digits of a name become a part of file names (`file_names::slug`). There must be at least one of
//! them and not more than systems take; and no two analyses, nor one analysis and a picture of another, may give the
//! same file.

use armill_formats::document::{Document, Problem};

use crate::analysis::table::{AnalysisKind, AnalysisTable};
use crate::analysis::{Analysis, Subject};
use crate::file::format::StudyFile;
use crate::input::problem_log::ProblemLog;

/// Longest part of a file name that an analysis may give, bytes: systems take 255, sections and pictures add to it.
const LONGEST_SLUG: usize = 160;

/// The name of an analysis; its kind and number if it has none.
pub(super) fn name_of(table: &AnalysisTable, index: usize) -> String {
    table
        .name
        .clone()
        .unwrap_or_else(|| format!("{} {}", table.kind.name(), index + 1))
}

/// Problems of statements that speak of no map, section or path.
///
/// A section is spoken of as `NAME: LABEL`; the labels of an analysis with problems are not known, so names like that
/// pass then.
pub(super) fn check_statements(log: &mut ProblemLog<'_>, file: &StudyFile, analyses: &[Analysis]) {
    let named = |kinds: &[AnalysisKind], name: &str| {
        let of_kind = file
            .analysis
            .iter()
            .enumerate()
            .filter(|(_, analysis)| kinds.contains(&analysis.kind));
        of_kind
            .map(|(index, analysis)| name_of(analysis, index))
            .any(|analysis| analysis == name)
    };
    // Sections are named by their labels; those of an analysis with problems are not known.
    let sections = |analysis: &Analysis| match &analysis.subject {
        Subject::Sections(sections) => sections
            .iter()
            .map(|(label, _)| format!("{}: {label}", analysis.name))
            .collect(),
        _ => Vec::new(),
    };
    let sections: Vec<String> = analyses.iter().flat_map(sections).collect();
    // A study without analyses has one that it does not write.
    let all_analyses_known = analyses.len() == file.analysis.len().max(1);
    for (index, statement) in file.statement.iter().enumerate() {
        for (k, name) in statement.of.iter().enumerate() {
            let known = named(&[AnalysisKind::Map, AnalysisKind::Path], name)
                || sections.contains(name)
                || (file.analysis.is_empty() && name == "map")
                || (!all_analyses_known && name.contains(": "));
            if known {
                continue;
            }
            let (message, hint) = if named(&[AnalysisKind::Sections], name) {
                let first = sections.iter().find(|section| section.starts_with(name.as_str()));
                let hint = format!(
                    "name one section, such as `{}`",
                    first.map_or("name: x = 800 mm", String::as_str)
                );
                (format!("`{name}` is a series of sections"), hint)
            } else if named(&[AnalysisKind::Volume], name) {
                (
                    format!("`{name}` is a volume"),
                    "a statement can refer to maps, sections and paths".to_owned(),
                )
            } else if named(&[AnalysisKind::Holes], name) {
                (
                    format!("`{name}` is a set of holes"),
                    "a statement can refer to maps, sections and paths".to_owned(),
                )
            } else {
                (
                    format!("no analysis is called `{name}`"),
                    "give an analysis this `name`".to_owned(),
                )
            };
            log.problem(&format!("statement[{index}].of[{k}]"), message, &hint);
        }
    }
}

/// Problems of names that give no valid file name, too long a one, or that of an earlier analysis.
pub(super) fn unfit_names(document: &Document, file: &StudyFile) -> Vec<Problem> {
    let names: Vec<String> = file
        .analysis
        .iter()
        .enumerate()
        .map(|(index, analysis)| name_of(analysis, index))
        .collect();
    let slugs: Vec<String> = names.iter().map(|name| crate::file_names::slug(name)).collect();
    let problem = |i: usize| {
        let (message, hint) = if slugs[i].is_empty() {
            (
                format!(
                    "`{}` has no letter and no digit, which file names require",
                    names[i]
                ),
                "such as `plate`",
            )
        } else if slugs[i].len() > LONGEST_SLUG {
            let message = format!(
                "the name gives file names of {} bytes, more than {LONGEST_SLUG}",
                slugs[i].len()
            );
            (
                message,
                "use a shorter name; `title` and `question` may have any length",
            )
        } else if let Some(other) =
            (0..slugs.len()).find(|j| crate::file_names::is_picture_of(&slugs[i], &slugs[*j]))
        {
            let message = format!("`{}` would overwrite a picture of `{}`", names[i], names[other]);
            (
                message,
                "use another name: pictures are named after the analysis and their content",
            )
        } else if let Some(earlier) = (0..i).find(|j| slugs[*j] == slugs[i]) {
            let message = format!(
                "`{}` and `{}` would write the same files",
                names[earlier], names[i]
            );
            (
                message,
                "each analysis needs a unique name; case and punctuation are ignored",
            )
        } else {
            return None;
        };
        Some(document.problem(&format!("analysis[{i}].name"), message, Some(hint)))
    };
    (0..names.len()).filter_map(problem).collect()
}
