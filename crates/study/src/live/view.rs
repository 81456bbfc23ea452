//! Everything that a page shows of one analysis after a value has changed: one request, so that a slider costs one
//! round trip to the server, and the text is read and the analysis run once.

use armill_core::watch::Watch;
use armill_formats::input::Inputs;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::AnalysisResult;
use crate::answer::{StudyAnswer, answer};
use crate::error::StudyError;
use crate::live::arm::{ExtremesAnswer, PoseAtTarget, PoseRequest, extremes_of, pose_at_target, target_of};
use crate::live::layer::{LayerAnswer, LayerRequest, layer_of};
use crate::live::outline::{analyses, changed_text};
use crate::live::path_columns::{PathInView, path_in_view};
use crate::live::scale::{checked, levels_of};
use crate::live::scene::scene_of;
use crate::live::values::values_of;
use crate::live::{
    ChangedValue, EditedAnalysis, LinesAnswer, OutlinedAnalysis, PathCache, SceneAnswer, StudyText,
    ValuesAnswer,
};
use crate::run::run_without_parts;

/// What is shown.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewQuestion<'a> {
    /// The analysis; the first if `None`.
    pub analysis: Option<&'a str>,
    /// Changes of the text, made first.
    pub changes: &'a [ChangedValue],
    /// The pose of the arm.
    pub arm: Option<&'a PoseRequest>,
    /// The levels of the colour scale, um, rising; chosen for the deviations if `None`.
    pub levels_um: Option<&'a [f64]>,
    /// Whether maps have lines at these levels, in addition to those at the tolerance.
    pub lines: bool,
    /// The quantity that colours show, if it is not the in-plane deviation.
    pub layer: Option<&'a LayerRequest>,
    /// Where the evaluated path is kept for its columns. The points of a path are then neither in the scene nor in the
    /// layer.
    pub paths: Option<&'a PathCache>,
}

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
    /// The columns of a path, its operations and worst points; `null` of another analysis, and if its points are in the
    /// scene.
    pub path: Option<PathInView>,
    /// Its answer, as in `armill run --json`.
    pub answer: StudyAnswer,
    /// Its worst and best points: of sections those of each, else of one.
    pub extremes: Vec<ExtremesAnswer>,
    /// The levels of its colour scale, from end to end; `null` if no point has a deviation.
    pub levels_um: Option<Vec<f64>>,
    /// Lines of equal deviation, one entry a map.
    pub lines: Vec<LinesAnswer>,
    /// The requested quantity at every point; `null` if none was requested.
    pub layer: Option<LayerAnswer>,
    /// The arm at the requested point; `null` if none was requested, and if there is no such point.
    pub arm: Option<PoseAtTarget>,
}

/// Everything shown of one analysis after the changes, and the arm at the requested point.
///
/// # Errors
/// A change that cannot be made; every problem of the changed text that concerns the analysis; no analysis of that
/// name; levels that are no scale; cancelled by the watch.
pub fn view(
    text: StudyText<'_>,
    question: &ViewQuestion<'_>,
    watch: Watch<'_>,
) -> Result<ViewAnswer, StudyError> {
    let new = changed_text(text, question.analysis, question.changes)?;
    let text = StudyText {
        bytes: new.as_bytes(),
        ..text
    };
    let Some(paths) = question.paths else {
        let edited = text.one_analysis(question.analysis)?;
        let done = run_without_parts(&edited.study, watch)?;
        return shown(question, &new, (&edited, &done), watch);
    };
    let kept = paths.with(text, question.analysis, |edited, done| {
        shown(question, &new, (edited, std::slice::from_ref(done)), watch)
    });
    if let Some(answer) = kept {
        return answer;
    }
    let inputs = Inputs::current();
    let edited = inputs.during(|| text.one_analysis(question.analysis))?;
    let done = run_without_parts(&edited.study, watch)?;
    let answer = shown(question, &new, (&edited, &done), watch)?;
    let found = done.into_iter().next().and_then(AnalysisResult::into_path);
    paths.keep(text, edited, found, inputs);
    Ok(answer)
}

/// What is shown of this analysis and its result; `text`: that of the study.
fn shown(
    question: &ViewQuestion<'_>,
    text: &str,
    (edited, done): (&EditedAnalysis<'_>, &[AnalysisResult<'_>]),
    watch: Watch<'_>,
) -> Result<ViewAnswer, StudyError> {
    let fixed = question.levels_um.map(checked).transpose()?;
    let answer = answer(&edited.study, done);
    let extremes = extremes_of(&answer, done);
    let target = question
        .arm
        .and_then(|request| target_of(request, &answer, &extremes));
    let arm = match target {
        Some((at, case)) => pose_at_target(edited, at, case, done.first(), watch)?,
        None => None,
    };
    let values = values_of(edited)?;
    let robot = &edited.study.robot.robot;
    let path = match (question.paths, done.first()) {
        (Some(_), Some(done)) => path_in_view(edited, done),
        _ => None,
    };
    let mut layer = match (question.layer, done.first()) {
        (Some(request), Some(done)) => Some(layer_of(robot, request, done, &answer, question.lines)?),
        _ => None,
    };
    // The page requests them as columns.
    let drawn = if path.is_some() { &[] } else { done };
    if let (Some(_), Some(layer)) = (&path, &mut layer) {
        layer.values.clear();
    }
    let levels_um = fixed.or_else(|| levels_of(done.first()?, values.tolerance_um));
    let with_lines = levels_um.as_deref().filter(|_| question.lines);
    let lines_of = |map| LinesAnswer::of(map, with_lines.unwrap_or_default());
    Ok(ViewAnswer {
        analyses: analyses(&edited.parsed),
        scene: scene_of(edited, drawn)?,
        values,
        lines: answer.maps.iter().map(lines_of).collect(),
        levels_um,
        answer,
        path,
        extremes,
        layer,
        arm,
        text: text.to_owned(),
    })
}
