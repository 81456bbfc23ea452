//! The worst points of a path, and why.
//!
//! The points were evaluated once more separately, with shares and uncertainty, on a plane across the tool. Components
//! of the deviation are those of the worst case: `along` forwards on the track, `cross` to its left, `axial` from the
//! part towards the spindle.

use armill_core::kernel::Evaluation;
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::{PathResult, PointDetail};
use crate::analysis::point::{PointAnswer, ReachedPoint};
use crate::analysis::words::motion_in_words;

/// A point with a large deviation, and why.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WorstPoint {
    /// Line of the program, or piece of the shape.
    pub line: u32,
    /// Distance along all cuts.
    pub distance_mm: f64,
    /// Deviation of the worst case along the track.
    pub along_um: f64,
    /// To the left of the track.
    pub cross_um: f64,
    /// Along the tool, from the part towards the spindle.
    pub axial_um: f64,
    /// Why it is large.
    pub cause: String,
    /// The point.
    pub point: PointAnswer,
}

/// A feed that turns by more than this between two points turns sharply, rad.
const SHARP: f64 = 0.5;
/// A joint nearer to its limit than this is reported, rad.
const NEAR_LIMIT: f64 = 0.087;

/// Worst first; a point without a separate evaluation is left out.
pub fn worst_points(robot: &Robot, analysis: &PathAnalysis, found: &PathResult) -> Vec<WorstPoint> {
    let given = |worst: &PointDetail| of_point(robot, analysis, worst);
    found.worst.iter().filter_map(given).collect()
}

/// One point; its in-plane coordinates are on the plane of the robot, not on the one across the tool.
fn of_point(robot: &Robot, analysis: &PathAnalysis, worst: &PointDetail) -> Option<WorstPoint> {
    let evaluation = *worst.answers.points.first()?.as_ref().ok()?;
    let here = &analysis.track.path.points[worst.index];
    let parts = analysis.track.parts(
        worst.index,
        &worst.answers.deviations_at(0)[evaluation.worst_case],
    );
    let tcp = worst.setting.plane.base_from_part.translation.vector.into();
    let reached = ReachedPoint {
        answers: &worst.answers,
        index: 0,
        evaluation: &evaluation,
        tcp,
    };
    let point = PointAnswer {
        in_plane_mm: PointAnswer::in_plane_mm(&analysis.setting.plane, &tcp),
        ..PointAnswer::of(robot, &worst.setting, &reached)
    };
    Some(WorstPoint {
        line: here.line,
        distance_mm: to_mm(here.along),
        along_um: to_um(parts.along),
        cross_um: to_um(parts.cross),
        axial_um: to_um(parts.axial),
        cause: cause(robot, analysis, worst.index, &evaluation, &point),
        point,
    })
}

/// The reasons, in words: the largest contributor, a singularity, a joint near its limit, a feed that turns
/// sharply.
fn cause(
    robot: &Robot,
    analysis: &PathAnalysis,
    index: usize,
    evaluation: &Evaluation,
    point: &PointAnswer,
) -> String {
    let joints = robot.joints();
    let names = analysis.setting.contributor_names(robot);
    let largest = point.mostly_by(&names).and_then(|(name, part)| {
        let name = motion_in_words(name).unwrap_or(name);
        Some(format!("{name} {:.0} %", 100.0 * part?))
    });
    let mut parts: Vec<String> = largest.into_iter().collect();
    if let Some(singularity) = evaluation.singularity {
        parts.push(format!("near the {singularity}"));
    }
    if evaluation.limit_margin < NEAR_LIMIT {
        parts.push(format!(
            "joint {} at its limit",
            joints[evaluation.limit_joint].name
        ));
    }
    let points = &analysis.track.path.points;
    if let Some(before) = index.checked_sub(1).map(|i| &points[i]) {
        let turn = before.direction.angle(&points[index].direction);
        if turn > SHARP {
            parts.push(format!("the feed turns by {:.0} deg here", to_deg(turn)));
        }
    }
    parts.join(", ")
}
