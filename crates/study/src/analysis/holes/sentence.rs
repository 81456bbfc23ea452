//! The answer in one sentence.

use armill_core::robot::Robot;

use crate::analysis::holes::answer::{HoleAnswer, HolesAnswer};
use crate::analysis::words::{LostPoints, largest_contributor, micrometres};
use crate::uncertainty_words::u_in_words;

/// How many holes are within the tolerance, the largest deviation with its hole, and what is out of reach.
pub fn sentence(robot: &Robot, holes: &HolesAnswer) -> String {
    let Some(worst) = holes.worst_holes.first() else {
        if holes.counts.in_collision == 0 {
            return format!(
                "The robot reaches none of the {} holes ({}, branch {}).",
                holes.holes, holes.name, holes.branch
            );
        }
        let lost = LostPoints {
            lost: holes.unreachable,
            in_collision: holes.counts.in_collision,
            of: holes.holes,
            nearest: holes.nearest.as_ref().zip(holes.least_clearance_mm),
        };
        return lost.sentence("hole", &format!("{}, branch {}", holes.name, holes.branch));
    };
    let good = (holes.fraction_within * holes.holes as f64).round();
    let (within, lost) = match holes.unreachable + holes.refused {
        0 => (
            format!("{good} of {} holes are within", holes.holes),
            String::new(),
        ),
        n => (
            format!(
                "{} of {} holes can be drilled, {good} of them within",
                holes.holes - n,
                holes.holes
            ),
            format!("; {} cannot be drilled", lost_holes(holes)),
        ),
    };
    format!(
        "{}: {within} {} µm; hole {} deviates by {} µm ({}) from its position; largest contribution: {}; holes are up to {} µm too deep or too shallow{lost}.",
        holes.name,
        micrometres(holes.setting.tolerance_um),
        worst.hole,
        micrometres(worst.point.in_plane_um),
        u_in_words(worst.point.in_plane_u_um),
        largest_contributor(robot, &worst.point, &holes.setting.contributors),
        micrometres(holes.max_depth_um.unwrap_or(0.0)),
    )
}

/// More holes than these are counted, not named.
const NAMED: usize = 6;

/// The holes without a usable posture.
fn lost_holes(holes: &HolesAnswer) -> String {
    let lost = |hole: &&HoleAnswer| hole.blocked_by.is_some() || hole.branch.is_none();
    let mut numbers: Vec<usize> = holes.each.iter().filter(lost).map(|hole| hole.hole).collect();
    numbers.sort_unstable();
    let words = |numbers: &[usize]| {
        let words: Vec<String> = numbers.iter().map(usize::to_string).collect();
        words.join(", ")
    };
    match numbers.as_slice() {
        [one] => format!("hole {one}"),
        [first @ .., last] if numbers.len() <= NAMED => format!("holes {} and {last}", words(first)),
        many => format!("{} holes", many.len()),
    }
}
