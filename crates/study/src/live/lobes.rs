//! The stability of the cut at a target, in a posture of the arm: limits, lobes and vibration, as `armill stability` gives them.
//!
//! | analysis | cut |
//! |---|---|
//! | path | that of the point: with its engagement in the stock, its spindle speed and its direction of feed |
//! | map, volume | that of the study, with the direction of feed on the plane |

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::vibration::cuts;
use crate::analysis::vibration::arm_modes::named_at_tip;
use crate::analysis::{AnalysisResult, Subject};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::vibration::CutAtPoint;
use crate::joint_order::joint_positions;
use crate::live::along::followed;
use crate::live::posture::{PoseTarget, existing_point};
use crate::live::{EditedAnalysis, StudyText};
use crate::stability::answer::{StabilityAnswer, answer};
use crate::stability::evaluate::evaluate;
use crate::stability::question::Question;

/// A query for one target and posture.
#[derive(Clone, Debug)]
pub struct LobesQuestion<'a> {
    /// The analysis; the first if left out.
    pub analysis: Option<&'a str>,
    /// The target.
    pub at: PoseTarget,
    /// The posture of the arm: joint positions in the convention of the robot file, deg (mm).
    pub joints_deg: Vec<f64>,
}

/// Stability of the cut at a target.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LobesAnswer {
    /// Limits, lobes and vibration; `null` where nothing is known.
    pub stability: Option<StabilityAnswer>,
    /// Why there is none; `null` if the study does not ask for the vibration.
    pub missing: Option<&'static str>,
}

/// Stability of the cut at a target of this analysis.
///
/// # Errors
/// Every problem of the text that concerns the analysis; a wrong number of joints; a cut that the cutter cannot make.
pub fn lobes(
    text: StudyText<'_>,
    question: &LobesQuestion<'_>,
    watch: Watch<'_>,
) -> Result<LobesAnswer, StudyError> {
    let edited = text.one_analysis(question.analysis)?;
    lobes_of(&edited, question, None, watch)
}

/// [`lobes`] of a text that has been read; the analysis may have been evaluated.
pub(super) fn lobes_of(
    edited: &EditedAnalysis<'_>,
    question: &LobesQuestion<'_>,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<LobesAnswer, StudyError> {
    let none = |missing| LobesAnswer {
        stability: None,
        missing,
    };
    let study = &edited.study;
    let robot = &study.robot.robot;
    let setting = edited.setting(question.at.section.unwrap_or(0))?;
    let Some(vibration) = &setting.vibration else {
        return Ok(none(None));
    };
    let subject = study.analyses.first().map(|analysis| &analysis.subject);
    let cut = match (subject, question.at.point) {
        (Some(Subject::Path(path)), Some(index)) => on_path(study, path, index, done, watch)?,
        _ => vibration.on_plane,
    };
    let Some(cut) = cut else {
        return Ok(none(Some("nothing is cut here")));
    };
    let q = joint_positions(robot, &question.joints_deg)?;
    let modes = named_at_tip(robot, setting, &q, &cut.base_from_feed).unwrap_or_default();
    if modes.is_empty() {
        return Ok(none(Some("no modes of arm or tool are known")));
    }
    let from_tool = vibration.tool_modes_from.clone();
    let from_arm =
        (modes.len() > vibration.tool_modes.len()).then(|| format!("{} in this posture", robot.name()));
    let from: Vec<String> = from_arm.into_iter().chain(from_tool).collect();
    let question = Question::at_point(&edited.name, &cut, modes, from.join(", "));
    Ok(LobesAnswer {
        stability: Some(answer(&question, &evaluate(&question)?)),
        missing: None,
    })
}

/// The cut at point `index` of a path; none where nothing is cut.
fn on_path(
    study: &Study,
    path: &PathAnalysis,
    index: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<Option<CutAtPoint>, StudyError> {
    existing_point(index, path.track.len())?;
    followed(study, path, done, watch, |found, track| {
        cuts(path, track, &found.along.load).and_then(|cuts| (cuts.at)(index))
    })
}
