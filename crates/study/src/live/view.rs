//! All that a page shows of one ask after a value has changed: one question, so that a slider costs one way to the server
//! and back, and the text is read and the ask run once.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use super::outline::{asks, changed_text};
use super::scene::scene_of;
use super::values::values_of;
use super::{ChangedValue, OutlinedAsk, SceneAnswer, Text, ValuesAnswer};
use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::run::run;

/// What is shown of one ask.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ViewAnswer {
    /// The text with the changes made in it.
    pub text: String,
    /// Its asks.
    pub asks: Vec<OutlinedAsk>,
    /// The settings that the ask resolves to.
    pub values: ValuesAnswer,
    /// What of it can be drawn in space.
    pub scene: SceneAnswer,
    /// As `armill run --json` tells it of that ask.
    pub answer: StudyAnswer,
}

/// What is shown of this ask, or of the first, once these values are changed.
///
/// # Errors
/// A change that cannot be made; every problem of the changed text that concerns the ask; no ask of that name; cancelled
/// by the watch.
pub fn view(
    text: Text<'_>,
    ask: Option<&str>,
    changes: &[ChangedValue],
    watch: Watch<'_>,
) -> Result<ViewAnswer, StudyError> {
    let new = changed_text(text, ask, changes)?;
    let text = Text {
        bytes: new.as_bytes(),
        ..text
    };
    let (parsed, name, study) = text.one_ask(ask)?;
    let done = run(&study, watch)?;
    Ok(ViewAnswer {
        asks: asks(&parsed),
        scene: scene_of(&parsed, &name, (&study, &done))?,
        values: values_of(&parsed, name, &study)?,
        answer: answer(&study, &done),
        text: new,
    })
}
