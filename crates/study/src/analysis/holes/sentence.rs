//! The answer in one sentence.

use armill_core::robot::Robot;

use crate::analysis::holes::answer::HolesAnswer;
use crate::analysis::words::{largest_contributor, micrometres};
use crate::uncertainty_words::u_in_words;

/// How many holes are within the tolerance, the largest deviation with its hole, and what is out of reach.
pub fn sentence(robot: &Robot, holes: &HolesAnswer) -> String {
    let Some(worst) = holes.worst_holes.first() else {
        return format!(
            "The robot reaches none of the {} holes ({}, branch {}).",
            holes.holes, holes.name, holes.branch
        );
    };
    let lost = match holes.unreachable + holes.refused {
        0 => String::new(),
        n => format!("; {n} cannot be drilled"),
    };
    let good = (holes.fraction_within * holes.holes as f64).round();
    format!(
        "{}: {} of {} holes are within {} µm; hole {} deviates by {} µm ({}) from its position; largest contribution: {}; holes are up to {} µm too deep or too shallow{lost}.",
        holes.name,
        good,
        holes.holes,
        micrometres(holes.setting.tolerance_um),
        worst.hole,
        micrometres(worst.point.in_plane_um),
        u_in_words(worst.point.in_plane_u_um),
        largest_contributor(robot, &worst.point, &holes.setting.contributors),
        micrometres(holes.max_depth_um.unwrap_or(0.0)),
    )
}
