//! Everything that a page shows of one analysis after a value has changed: one request, so that a slider costs one
//! round trip to the server, and the text is read and the analysis run once.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::live::arm::{ExtremesAnswer, PoseAtTarget, PoseRequest, extremes_of, pose_at_target, target_of};
use crate::live::outline::{analyses, changed_text};
use crate::live::scene::scene_of;
use crate::live::values::values_of;
use crate::live::{ChangedValue, OutlinedAnalysis, SceneAnswer, StudyText, ValuesAnswer};
use crate::run::run;

/// Everything shown of one analysis.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ViewAnswer {
    /// The text with the changes.
    pub text: String,
    /// Its analyses.
    pub analyses: Vec<OutlinedAnalysis>,
    /// The settings that the analysis resolves to.
    pub values: ValuesAnswer,
    /// What can be drawn in space.
    pub scene: SceneAnswer,
    /// Its answer, as in `armill run --json`.
    pub answer: StudyAnswer,
    /// Its worst and best points: of sections those of each, else of one.
    pub extremes: Vec<ExtremesAnswer>,
    /// The arm at the requested point; `null` if none was requested, and if there is no such point.
    pub arm: Option<PoseAtTarget>,
}

/// Everything shown of this analysis, or of the first, after these changes, and the arm at the requested point.
///
/// # Errors
/// A change that cannot be made; every problem of the changed text that concerns the analysis; no analysis of that
/// name; cancelled by the watch.
pub fn view(
    text: StudyText<'_>,
    analysis: Option<&str>,
    changes: &[ChangedValue],
    request: Option<&PoseRequest>,
    watch: Watch<'_>,
) -> Result<ViewAnswer, StudyError> {
    let new = changed_text(text, analysis, changes)?;
    let text = StudyText {
        bytes: new.as_bytes(),
        ..text
    };
    let edited = text.one_analysis(analysis)?;
    let done = run(&edited.study, watch)?;
    let answer = answer(&edited.study, &done);
    let extremes = extremes_of(&answer, &done);
    let target = request.and_then(|request| target_of(request, &answer, &extremes));
    let arm = match target {
        Some((at, case)) => pose_at_target(&edited, at, case, done.first(), watch)?,
        None => None,
    };
    Ok(ViewAnswer {
        analyses: analyses(&edited.parsed),
        scene: scene_of(&edited, &done)?,
        values: values_of(&edited)?,
        answer,
        extremes,
        arm,
        text: new,
    })
}
