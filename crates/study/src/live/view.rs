//! All that a page shows of one ask after a value has changed: one question, so that a slider costs one way to the server
//! and back, and the text is read and the ask run once.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use super::outline::{analyses, changed_text};
use super::scene::scene_of;
use super::stand::{ExtremesAnswer, Stand, StandsAnswer, extremes_of, stands_of};
use super::values::values_of;
use super::{ChangedValue, OutlinedAnalysis, SceneAnswer, Text, ValuesAnswer};
use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::run::run;

/// What is shown of one ask.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ViewAnswer {
    /// The text with the changes made in it.
    pub text: String,
    /// Its asks.
    pub analyses: Vec<OutlinedAnalysis>,
    /// The settings that the ask resolves to.
    pub values: ValuesAnswer,
    /// What of it can be drawn in space.
    pub scene: SceneAnswer,
    /// As `armill run --json` tells it of that ask.
    pub answer: StudyAnswer,
    /// Where its worst and best points are: of sections those of each, else of one.
    pub extremes: Vec<ExtremesAnswer>,
    /// The arm where it was to stand; `null` where nobody asked, and where there is no such place.
    pub stands: Option<StandsAnswer>,
}

/// What is shown of this ask, or of the first, once these values are changed, and how the arm stands in it.
///
/// # Errors
/// A change that cannot be made; every problem of the changed text that concerns the ask; no ask of that name; cancelled
/// by the watch.
pub fn view(
    text: Text<'_>,
    analysis: Option<&str>,
    (changes, stand): (&[ChangedValue], Option<&Stand>),
    watch: Watch<'_>,
) -> Result<ViewAnswer, StudyError> {
    let new = changed_text(text, analysis, changes)?;
    let text = Text {
        bytes: new.as_bytes(),
        ..text
    };
    let (parsed, name, study) = text.one_ask(analysis)?;
    let done = run(&study, watch)?;
    let answer = answer(&study, &done);
    let extremes = extremes_of(&answer, &done);
    let given = (&answer, extremes.as_slice(), done.as_slice());
    let stands = match stand {
        Some(stand) => stands_of((text, &parsed, &study), given, stand, watch)?,
        None => None,
    };
    Ok(ViewAnswer {
        analyses: analyses(&parsed),
        scene: scene_of(&parsed, &name, (&study, &done))?,
        values: values_of(&parsed, name, &study)?,
        answer,
        extremes,
        stands,
        text: new,
    })
}
