//! The arm that is shown: at the worst or best point of an answer, or at a target chosen by the user.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{AnalysisData, AnalysisResult};
use crate::answer::{PointAnswer, StudyAnswer};
use crate::error::{ErrorKind, StudyError};
use crate::live::EditedAnalysis;
use crate::live::posture::{PoseTarget, PosturesAnswer, postures_of};

/// The pose of the arm to show.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseRequest {
    /// The point that the arm follows.
    pub follow: Follow,
    /// The target, for `place`.
    pub at: Option<PoseTarget>,
    /// Of sections the one whose worst or best point is used, from 0.
    #[serde(default)]
    pub section: usize,
    /// Load case, from 1; if left out the worst case at the worst or best point, and the first at a target.
    pub case: Option<usize>,
}

/// What the arm follows while values change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Follow {
    /// Where the deviation is largest.
    Worst,
    /// Where it is least.
    Best,
    /// The given target.
    Place,
}

/// The worst and the best point; none if no point is reached, no best along a path and of holes.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct ExtremesAnswer {
    /// Where the deviation is largest.
    pub worst: Option<PoseTarget>,
    /// Where it is least.
    pub best: Option<PoseTarget>,
}

/// The arm at its target.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PoseAtTarget {
    /// The target.
    pub at: PoseTarget,
    /// The load case, from 1.
    pub case: usize,
    /// Every posture there, as `/api/pose` answers.
    pub pose: PosturesAnswer,
}

/// The extremes of this analysis: of sections those of each, else of one.
pub(super) fn extremes_of(answer: &StudyAnswer, done: &[AnalysisResult<'_>]) -> Vec<ExtremesAnswer> {
    let several = answer.maps.len() > 1;
    let on_map = |section: usize| {
        let [worst, best] = extreme_points(answer, section).map(|point| {
            point.map(|point| PoseTarget {
                y_mm: Some(point.in_plane_mm[0]),
                z_mm: Some(point.in_plane_mm[1]),
                section: several.then_some(section),
                ..PoseTarget::default()
            })
        });
        ExtremesAnswer { worst, best }
    };
    let of_points = |[worst, best]: [Option<usize>; 2]| {
        let [worst, best] = [worst, best].map(|index| {
            index.map(|index| PoseTarget {
                point: Some(index),
                ..PoseTarget::default()
            })
        });
        vec![ExtremesAnswer { worst, best }]
    };
    match done.first().map(|done| &done.found) {
        Some(AnalysisData::Map(..) | AnalysisData::Sections(_)) => {
            (0..answer.maps.len()).map(on_map).collect()
        }
        Some(AnalysisData::Volume(_, volume)) => {
            let answers = &volume.answers;
            of_points([answers.worst(), answers.best()].map(|found| found.map(|(index, _)| index)))
        }
        Some(AnalysisData::Path(_, path)) => of_points([path.worst.first().map(|worst| worst.index), None]),
        Some(AnalysisData::Holes(..)) => {
            let holes = answer.holes.first();
            let worst = holes.and_then(|holes| holes.worst_holes.first());
            of_points([worst.map(|worst| worst.hole - 1), None])
        }
        None => Vec::new(),
    }
}

/// The worst and the best point of what is shown.
fn extreme_points(answer: &StudyAnswer, section: usize) -> [Option<&PointAnswer>; 2] {
    if let Some(map) = answer.maps.get(section).or(answer.maps.first()) {
        return [map.worst.as_ref(), map.best.as_ref()];
    }
    if let Some(path) = answer.paths.first() {
        return [path.worst.as_ref(), None];
    }
    if let Some(volume) = answer.volumes.first() {
        return [volume.worst.as_ref(), volume.best.as_ref()];
    }
    let holes = answer.holes.first().and_then(|holes| holes.worst_holes.first());
    [holes.map(|worst| &worst.point), None]
}

/// The requested target and load case, from 1, in the answer to one analysis; none if there is no such point.
pub(super) fn target_of(
    request: &PoseRequest,
    answer: &StudyAnswer,
    extremes: &[ExtremesAnswer],
) -> Option<(PoseTarget, usize)> {
    let places = extremes.get(request.section).or(extremes.first());
    let [worst, best] = extreme_points(answer, request.section);
    let (at, point) = match request.follow {
        Follow::Worst => (places.and_then(|places| places.worst.clone()), worst),
        Follow::Best => (places.and_then(|places| places.best.clone()), best),
        Follow::Place => (request.at.clone(), None),
    };
    Some((
        at?,
        request.case.or(point.map(|point| point.worst_case)).unwrap_or(1),
    ))
}

/// The arm at this target under this load case (from 1) of an analysis, which may have been evaluated; none if the
/// target exists no longer.
///
/// # Errors
/// Cancelled by the watch; a fault.
pub(super) fn pose_at_target(
    edited: &EditedAnalysis<'_>,
    at: PoseTarget,
    case: usize,
    done: Option<&AnalysisResult<'_>>,
    watch: Watch<'_>,
) -> Result<Option<PoseAtTarget>, StudyError> {
    match postures_of(edited, &at, case, done, watch) {
        Ok(pose) => Ok(Some(PoseAtTarget { at, case, pose })),
        // A former point on a path that is shorter now: a separate request for it reports why.
        Err(error) if error.kind() == ErrorKind::InvalidInput => Ok(None),
        Err(error) => Err(error),
    }
}
