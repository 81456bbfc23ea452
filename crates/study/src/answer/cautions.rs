//! Warnings of holes and paths: out of reach, outside joint limits, jumps of the arm, points without force.
//!
//! Each is a sentence that begins with the name of the path; none stops the answer.

use super::holes::HolesAnswer;
use super::path::PathAnswer;

/// Stretches without posture that are told.
const MOST_LOST: usize = 5;

/// Holes that no posture holds, with the reason of the first, and holes that only a posture holds that a search refuses.
pub(super) fn of_holes(holes: &HolesAnswer) -> Vec<String> {
    let (name, count) = (&holes.name, holes.holes);
    let lost = holes.each.iter().find(|hole| hole.reason.is_some());
    let lost = lost.map(|first| {
        let reason = first.reason.as_deref().unwrap_or_default();
        format!(
            "{name}: {} of {count} holes cannot be drilled, hole {} first: {reason}.",
            holes.unreachable, first.hole
        )
    });
    let mut strained = holes
        .each
        .iter()
        .filter_map(|hole| Some((hole.hole, hole.blocked_by?)));
    let strained = strained.next().map(|(first, why)| {
        format!(
            "{name}: for {} of {count} holes every turn and branch is refused, hole {first} first ({}): they are told as they can \
             be held, and count as lost.",
            1 + strained.count(),
            why.replace('_', " ")
        )
    });
    lost.into_iter().chain(strained).collect()
}

/// What a user should know before trusting the result of a path.
///
/// In this order: points out of reach with what may be the reason, points outside joint limits, jumps, points whose
/// deviation is zero only because no force is known there.
pub(super) fn of_path(path: &PathAnswer) -> Vec<String> {
    let name = &path.name;
    let mut warnings = Vec::new();
    if path.unreachable > 0 {
        let hint = match path.program {
            Some(_) => "does the program lie where it should (part_from_path_mm_deg)?",
            None => "are its coordinates in mm, and does the plane lie where it should?",
        };
        warnings.push(format!(
            "{name}: {} of {} points are out of reach; {hint}",
            path.unreachable, path.points
        ));
    }
    if path.outside_joint_limits > 0 {
        warnings.push(format!(
            "{name}: {} of {} points stand outside joint limits in the branch {}.",
            path.outside_joint_limits,
            path.points,
            path.followed_branch.as_ref().unwrap_or(&path.branch)
        ));
    }
    if !path.jumps.is_empty() {
        warnings.push(format!(
            "{name}: the arm cannot follow without a stop: {}.",
            path.jumps.join("; ")
        ));
    }
    if let Some(search) = &path.search {
        warnings.extend(search.lost.iter().take(MOST_LOST).map(|lost| {
            format!(
                "{name}: no turn of the tool and branch stands at {} points from line {} to {} ({}).",
                lost.points,
                lost.first_line,
                lost.last_line,
                lost.reason.replace('_', " ")
            )
        }));
        if let Some(first) = search.breaks.first() {
            warnings.push(format!(
                "{name}: the arm has to stop and take another posture {} times, first in line {first}: no turn of the tool leads on within the joints' speed.",
                search.breaks.len()
            ));
        }
    }
    let without_force = path.cut.as_ref().map_or(0, |cut| cut.points_without_force);
    if without_force > 0 {
        warnings.push(format!(
            "{name}: {without_force} of {} points have no force known (a cutter that plunges or dives steeply cuts with its bottom, a drill that goes sideways does not drill): their deviation is told as zero.",
            path.points
        ));
    }
    warnings
}
