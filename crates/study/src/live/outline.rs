//! The contents and the problems of a text.

use armill_formats::document::Problem;
use armill_formats::document::edit::{self, Change};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::StudyError;
use crate::file::resolve::Parsed;
use crate::live::StudyText;

/// The contents of a text; an invalid text has problems, and as much of the contents as can be read.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct OutlineAnswer {
    /// Title of the study.
    pub title: Option<String>,
    /// The robot, as the study names it.
    pub robot: Option<String>,
    /// Its analyses, in order; one map if it has none.
    pub analyses: Vec<OutlinedAnalysis>,
    /// All problems, as in `armill check --json`.
    pub problems: Vec<Problem>,
}

/// One analysis.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OutlinedAnalysis {
    /// Its name.
    pub name: String,
    /// `map`, `sections`, `volume`, `path` or `holes`.
    pub kind: &'static str,
    /// The paths of the values that it gives itself, such as `plane.step_mm`; all others come from the study.
    pub keys: Vec<String>,
}

/// A changed text and its contents.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ChangedAnswer {
    /// The text.
    pub text: String,
    /// Its analyses.
    pub analyses: Vec<OutlinedAnalysis>,
    /// All its problems.
    pub problems: Vec<Problem>,
}

/// A new value of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChangedValue {
    /// The key: `plane.centre_mm`, `program.feature[1]`.
    pub key: String,
    /// The new value; `null` removes the key. The index after the last of a list adds an entry.
    pub value: serde_json::Value,
    /// Whether the key is one of the study, even if an analysis is named.
    #[serde(default)]
    pub whole: bool,
}

/// The contents of this text.
pub fn outline(text: StudyText<'_>) -> OutlineAnswer {
    let parsed = match Parsed::in_folder(text.shown, text.folder, text.bytes) {
        Ok(parsed) => parsed,
        Err(error) => {
            return OutlineAnswer {
                problems: problems(error),
                ..OutlineAnswer::default()
            };
        }
    };
    let resolved = parsed.resolve(text.folder, None);
    OutlineAnswer {
        title: match &resolved {
            Ok(study) => Some(study.title.clone()),
            Err(_) => parsed.file.title.clone(),
        },
        robot: Some(parsed.file.robot.clone()),
        analyses: analyses(&parsed),
        problems: resolved.err().map_or_else(Vec::new, problems),
    }
}

/// The text with these values changed in the analysis of that name, or in the study if none is named; comments and
/// order are kept.
///
/// # Errors
/// A text that is not TOML; no analysis of that name; a change that cannot be made.
pub fn changed(
    text: StudyText<'_>,
    analysis: Option<&str>,
    changes: &[ChangedValue],
) -> Result<ChangedAnswer, StudyError> {
    let new = changed_text(text, analysis, changes)?;
    let OutlineAnswer {
        analyses, problems, ..
    } = outline(StudyText {
        bytes: new.as_bytes(),
        ..text
    });
    Ok(ChangedAnswer {
        text: new,
        analyses,
        problems,
    })
}

/// The text alone of [`changed`].
pub(super) fn changed_text(
    text: StudyText<'_>,
    analysis: Option<&str>,
    changes: &[ChangedValue],
) -> Result<String, StudyError> {
    let below = match analysis {
        Some(name) if changes.iter().any(|change| !change.whole) => {
            let parsed = Parsed::of(text.shown, text.bytes)?;
            // The map that a study without analyses implies is in the study itself.
            match (parsed.index_of(name)?, parsed.file.analysis.is_empty()) {
                (_, true) => String::new(),
                (index, false) => format!("analysis[{index}]."),
            }
        }
        _ => String::new(),
    };
    let changes = changes.iter().map(|change| Change {
        path: format!("{}{}", if change.whole { "" } else { &below }, change.key),
        value: change.value.clone(),
    });
    let old = armill_formats::document::Document::text_of(text.shown, text.bytes)?;
    Ok(edit::changed(text.shown, old, &changes.collect::<Vec<_>>())?)
}

pub(super) fn analyses(parsed: &Parsed) -> Vec<OutlinedAnalysis> {
    let tables = parsed.analysis_tables();
    let names = parsed.analysis_names();
    let one = |(index, (table, name)): (usize, (_, String))| {
        let table: &crate::analysis::table::AnalysisTable = table;
        OutlinedAnalysis {
            name,
            kind: table.kind.name(),
            keys: parsed.keys(&format!("analysis[{index}]")),
        }
    };
    tables.iter().zip(names).enumerate().map(one).collect()
}

/// All problems, one by one; one without a position in a file is at the start of the study.
fn problems(error: StudyError) -> Vec<Problem> {
    match error {
        StudyError::Problems(problems) => problems.as_slice().to_vec(),
        StudyError::Value { message, hint } => vec![Problem::of_file("study", message, &hint)],
        other => vec![Problem::of_file("study", other.to_string(), "")],
    }
}
