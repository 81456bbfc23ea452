//! What `armill run` says of a text, in memory: the same bytes as its files have.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use super::Text;
use crate::answer::answer;
use crate::budget::output::is_of_budget;
use crate::error::StudyError;
use crate::output::{self, Picture};
use crate::run::run;

/// The pictures of an ask.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PicturesAnswer {
    /// In the order of the report.
    pub pictures: Vec<PictureAnswer>,
}

/// One picture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PictureAnswer {
    /// Its file name without extension.
    pub name: String,
    /// What it shows, in a sentence.
    pub title: String,
    /// Whether its numbers are those of the budget of what was measured, not of the table of the ask.
    pub measured: bool,
    /// The picture.
    pub svg: String,
}

/// The answer to this ask, or to all, as `armill run --json` prints it.
///
/// # Errors
/// Every problem of the text that concerns it; no ask of that name; cancelled by the watch.
pub fn answer_json(text: Text<'_>, analysis: Option<&str>, watch: Watch<'_>) -> Result<String, StudyError> {
    let study = text.study(analysis)?;
    let done = run(&study, watch)?;
    output::json(&answer(&study, &done))
}

/// The table of this ask, or of the first, as the CSV that `armill run --csv` writes.
///
/// # Errors
/// As of [`answer_json`].
pub fn table_csv(text: Text<'_>, analysis: Option<&str>, watch: Watch<'_>) -> Result<Vec<u8>, StudyError> {
    let (_, _, study) = text.one_ask(analysis)?;
    let done = run(&study, watch)?;
    output::table_csv(&study, done.first().ok_or_else(no_ask)?)
}

/// The table of the budget of what was measured, as `armill budget --out` writes it.
///
/// # Errors
/// As of [`answer_json`]; a study in which nothing was measured.
pub fn measured_csv(text: Text<'_>, watch: Watch<'_>) -> Result<Vec<u8>, StudyError> {
    let (combined, given) = crate::budget::budget(&text.study(None)?, watch)?;
    crate::budget::output::table_csv(&given, &combined)
}

/// The pictures of this ask, or of all, as `armill run` draws them.
///
/// # Errors
/// As of [`answer_json`].
pub fn pictures(text: Text<'_>, analysis: Option<&str>, watch: Watch<'_>) -> Result<PicturesAnswer, StudyError> {
    let study = text.study(analysis)?;
    let done = run(&study, watch)?;
    let given = |Picture { name, caption, svg }| PictureAnswer {
        measured: study
            .experiment
            .as_ref()
            .is_some_and(|of| is_of_budget(&name, &of.analysis)),
        name,
        title: caption,
        svg,
    };
    let pictures = output::pictures(&study, &done, &answer(&study, &done));
    Ok(PicturesAnswer {
        pictures: pictures.into_iter().map(given).collect(),
    })
}

/// The picture of that name among those of [`pictures`].
///
/// # Errors
/// As of [`answer_json`]; no picture of that name.
pub fn picture_svg(
    text: Text<'_>,
    analysis: Option<&str>,
    name: &str,
    watch: Watch<'_>,
) -> Result<String, StudyError> {
    let pictures = pictures(text, analysis, watch)?.pictures;
    let names: Vec<String> = pictures
        .iter()
        .map(|picture| format!("`{}`", picture.name))
        .collect();
    let found = pictures.into_iter().find(|picture| picture.name == name);
    found.map(|picture| picture.svg).ok_or_else(|| {
        let hint = format!("there are: {}", names.join(", "));
        StudyError::value(format!("no picture is called `{name}`"), hint)
    })
}

/// A study always has an ask, its own or the map that it means.
fn no_ask() -> StudyError {
    StudyError::value("the study asks for nothing", "add an [[analysis]]")
}
