//! The results of `armill run` for a text, in memory: the same bytes as its files.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use crate::answer::answer;
use crate::error::StudyError;
use crate::live::StudyText;
use crate::output::budget::is_of_budget;
use crate::output::{self, Picture, StudyResults};
use crate::run::run;

/// The pictures of an analysis.
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
    /// Whether its numbers are those of the error budget of the measurement, not of the table of the analysis.
    pub measured: bool,
    /// The picture.
    pub svg: String,
}

/// The answer to this analysis, or to all, as `armill run --json` prints it.
///
/// # Errors
/// Every problem of the text that concerns the analysis; no analysis of that name; cancelled by the watch.
pub fn answer_json(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<String, StudyError> {
    let study = text.study(analysis)?;
    let done = run(&study, watch)?;
    output::json(&answer(&study, &done))
}

/// The table of this analysis, or of the first, as the CSV that `armill run --csv` writes.
///
/// # Errors
/// As of [`answer_json`].
pub fn table_csv(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<Vec<u8>, StudyError> {
    let study = text.one_analysis(analysis)?.study;
    let done = run(&study, watch)?;
    output::table_csv(&study, done.first().ok_or_else(no_analysis)?)
}

/// The table of the error budget of the measurement, as `armill budget --out` writes it.
///
/// # Errors
/// As of [`answer_json`]; a study without a measurement.
pub fn measured_csv(text: StudyText<'_>, watch: Watch<'_>) -> Result<Vec<u8>, StudyError> {
    let (combined, given) = crate::budget::budget(&text.study(None)?, watch)?;
    output::budget::table_csv(&given, &combined)
}

/// The pictures of this analysis, or of all, as `armill run` draws them.
///
/// # Errors
/// As of [`answer_json`].
pub fn pictures(
    text: StudyText<'_>,
    analysis: Option<&str>,
    watch: Watch<'_>,
) -> Result<PicturesAnswer, StudyError> {
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
    let pictures = output::pictures(StudyResults {
        study: &study,
        done: &done,
        answer: &answer(&study, &done),
    });
    Ok(PicturesAnswer {
        pictures: pictures.into_iter().map(given).collect(),
    })
}

/// The picture of that name among those of [`pictures`].
///
/// # Errors
/// As of [`answer_json`]; no picture of that name.
pub fn picture_svg(
    text: StudyText<'_>,
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

/// A study always has an analysis, its own or the implied map.
fn no_analysis() -> StudyError {
    StudyError::value("the study has no analysis", "add an [[analysis]]")
}
