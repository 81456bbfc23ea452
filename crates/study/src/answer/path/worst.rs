//! Where a path is worst, and why.
//!
//! The points are those that were asked once more by themselves, with shares and uncertainty, on a plane across the
//! tool. Parts of the deviation are of the deciding case: `along` forwards on the track, `cross` to its left, `axial`
//! from the part towards the spindle.

use armill_core::kernel::Held;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::point::PointAnswer;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Study;
use crate::run::{InFull, PathFound};

/// A point where the deviation is large, and why.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WorstPoint {
    /// Line of the program, or piece of the shape.
    pub line: u32,
    /// Distance along all cuts.
    pub distance_mm: f64,
    /// Deviation of the deciding case along the track.
    pub along_um: f64,
    /// To the left of the track.
    pub cross_um: f64,
    /// Along the tool, from the part towards the spindle.
    pub axial_um: f64,
    /// What makes it large.
    pub cause: String,
    /// The point.
    pub point: PointAnswer,
}

/// A feed that turns by more than this between two points turns sharply, rad.
const SHARP: f64 = 0.5;
/// A joint nearer to its limit than this is told, rad.
const NEAR_LIMIT: f64 = 0.087;

/// Worst first; a point that was not held when asked by itself is left out.
pub(super) fn worst_points(study: &Study, analysis: &PathAnalysis, found: &PathFound) -> Vec<WorstPoint> {
    let given = |worst: &InFull| of_point(study, analysis, worst);
    found.worst.iter().filter_map(given).collect()
}

/// One point; its in-plane coordinates are on the plane of the study, not on the one across the tool.
fn of_point(study: &Study, analysis: &PathAnalysis, worst: &InFull) -> Option<WorstPoint> {
    let evaluation = *worst.answers.points.first()?.as_ref().ok()?;
    let here = &analysis.track.path.points[worst.index];
    let parts = analysis
        .track
        .parts(worst.index, &worst.answers.deviations_at(0)[evaluation.deciding_case]);
    let at = worst.setting.plane.base_from_part.translation.vector.into();
    let point = PointAnswer {
        in_plane_mm: PointAnswer::in_plane_mm(&analysis.setting.plane, &at),
        ..PointAnswer::of(study, &worst.setting, &worst.answers, (0, &evaluation, at))
    };
    Some(WorstPoint {
        line: here.line,
        distance_mm: here.along * 1e3,
        along_um: parts.along * 1e6,
        cross_um: parts.cross * 1e6,
        axial_um: parts.axial * 1e6,
        cause: cause(study, (analysis, worst.index), &evaluation, &point),
        point,
    })
}

/// In words, as far as they hold: whose share is largest, a singularity, a joint near its limit, a feed that turns
/// sharply.
fn cause(study: &Study, (analysis, index): (&PathAnalysis, usize), evaluation: &Held, point: &PointAnswer) -> String {
    let joints = study.robot.robot.joints();
    let names = analysis.setting.model.contributor_names(joints);
    let largest = point
        .mostly_by(&names)
        .and_then(|(name, part)| Some(format!("{name} {:.0} %", 100.0 * part?)));
    let mut parts: Vec<String> = largest.into_iter().collect();
    if let Some(singularity) = evaluation.singularity {
        parts.push(format!("near the {singularity}"));
    }
    if evaluation.limit_margin < NEAR_LIMIT {
        parts.push(format!("joint {} at its limit", joints[evaluation.limit_joint].name));
    }
    let points = &analysis.track.path.points;
    if let Some(before) = index.checked_sub(1).map(|i| &points[i]) {
        let turn = before.direction.angle(&points[index].direction);
        if turn > SHARP {
            parts.push(format!("the feed turns by {:.0} deg here", turn.to_degrees()));
        }
    }
    parts.join(", ")
}
