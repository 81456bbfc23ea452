//! Warnings of limits that sources disagree about, where the results depend on which of them is right.
//!
//! A joint that leaves the limits of another source may be unable to reach its points; points that are lost at its own
//! limits may be within reach if the other source is right. Otherwise both give the same result, and `armill robots`
//! lists the other limits.

use armill_core::units::to_deg;
use armill_formats::robot::OtherLimits;

use crate::analysis::AnalysisResult;
use crate::analysis::path::answer::joint_ranges;
use crate::answer::by_kind::AnalysisAnswers;
use crate::file::resolve::Study;
use crate::joint_order::joint_order;

/// One sentence for each joint and source that matters, in the order of the joints.
pub(super) fn warnings(study: &Study, done: &[AnalysisResult<'_>], answers: &AnalysisAnswers) -> Vec<String> {
    let notes = &study.robot.joint_notes;
    if notes.iter().all(|note| note.other_limits.is_empty()) {
        return Vec::new();
    }
    let robot = &study.robot.robot;
    let order = joint_order(robot);
    let used = used_ranges(study, done, order.len());
    let lost = points_lost_at_limits(answers);
    let mut warnings = Vec::new();
    for (position, joint) in order.into_iter().enumerate() {
        let others = notes.get(joint).into_iter().flat_map(|note| &note.other_limits);
        for limits in others {
            let OtherLimits {
                limits_deg: [lower, upper],
                source,
                note,
            } = limits;
            let name = &robot.joints()[joint].name;
            let note = note.as_ref().map_or(String::new(), |note| format!(" ({note})"));
            let other = format!("another source ({source}) gives the limits {lower} to {upper} deg{note}");
            let is_wider = robot.joints()[joint]
                .limits
                .is_some_and(|own| *lower < to_deg(own.lower) || *upper > to_deg(own.upper));
            match used[position] {
                Some([low, high]) if low < *lower || high > *upper => warnings.push(format!(
                    "Joint {name} may not reach all points: it is at {low:.1} to {high:.1} deg, and {other}."
                )),
                _ if lost && is_wider => warnings.push(format!(
                    "Points outside the limits of joint {name} may be within reach: {other}."
                )),
                _ => {}
            }
        }
    }
    warnings
}

/// Range of each joint over all analyses, deg (mm), in the order of the robot; none where no point has a posture.
fn used_ranges(study: &Study, done: &[AnalysisResult<'_>], joints: usize) -> Vec<Option<[f64; 2]>> {
    let mut used = vec![None; joints];
    for rows in done.iter().flat_map(AnalysisResult::rows) {
        let ranges = joint_ranges(&study.robot.robot, rows.answers);
        for (all, [low, high]) in used.iter_mut().zip(ranges) {
            let [before_low, before_high]: [f64; 2] = all.unwrap_or([low, high]);
            *all = Some([before_low.min(low), before_high.max(high)]);
        }
    }
    used
}

/// Whether points are outside joint limits, or have no posture inside them.
fn points_lost_at_limits(answers: &AnalysisAnswers) -> bool {
    let maps = answers.maps.iter();
    let volumes = answers.volumes.iter();
    let mut paths = answers.paths.iter();
    let mut holes = answers.holes.iter().flat_map(|holes| &holes.each);
    maps.map(|map| (map.outside_joint_limits, &map.counts))
        .chain(volumes.map(|volume| (volume.outside_joint_limits, &volume.counts)))
        .any(|(outside, counts)| outside + counts.no_posture_inside_limits > 0)
        || paths.any(|path| path.outside_joint_limits + path.unreachable > path.in_collision)
        || holes.any(|hole| hole.blocked_by == Some("outside_joint_limits"))
}
