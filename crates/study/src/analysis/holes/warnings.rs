//! Warnings of holes: out of reach, reached only in a rejected posture.

use crate::analysis::holes::answer::HolesAnswer;

/// Holes out of reach, with the reason of the first, and holes reached only in a posture that the search rejects.
pub fn warnings(holes: &HolesAnswer) -> Vec<String> {
    let (name, count) = (&holes.name, holes.holes);
    let unreachable = holes.each.iter().find(|hole| hole.reason.is_some());
    let unreachable = unreachable.map(|first| {
        let reason = first.reason.as_deref().unwrap_or_default();
        format!(
            "{name}: {} of {count} holes cannot be drilled, hole {} first: {reason}.",
            holes.unreachable, first.hole
        )
    });
    let mut rejected = holes
        .each
        .iter()
        .filter_map(|hole| Some((hole.hole, hole.blocked_by?)));
    let rejected = rejected.next().map(|(first, why)| {
        format!(
            "{name}: for {} of {count} holes every turn and branch is rejected, hole {first} first ({}): they are evaluated in a \
             rejected posture and included in the holes that cannot be drilled.",
            1 + rejected.count(),
            why.replace('_', " ")
        )
    });
    unreachable.into_iter().chain(rejected).collect()
}
