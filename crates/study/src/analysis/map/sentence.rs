//! The answer in one sentence.

use armill_core::robot::Robot;

use crate::analysis::map::answer::MapAnswer;
use crate::analysis::vibration::VibrationAnswer;
use crate::analysis::words::{LimitCounts, LostPoints, largest_contributor, micrometres};
use crate::uncertainty_words::u_in_words;

/// Points that are not reached, fraction of a plane, least and largest deviation in it and along its normal, and how
/// many points are outside joint limits.
pub fn sentence(robot: &Robot, map: &MapAnswer) -> String {
    let lost = LostPoints {
        lost: map.counts.unreached(),
        in_collision: map.counts.in_collision,
        of: map.counts.total(),
        nearest: map.nearest.as_ref().zip(map.least_clearance_mm),
    };
    let (Some(worst), Some(best)) = (&map.worst, &map.best) else {
        let subject = format!("{}, branch {}", map.name, map.branch);
        return lost.sentence("point of the plane", &subject);
    };
    let evaluation = match map.fraction_within_and_inside_joint_limits {
        0.0 => format!(
            "no point on the plane is within {} µm",
            micrometres(map.setting.tolerance_um)
        ),
        1.0 => format!(
            "the whole plane is within {} µm",
            micrometres(map.setting.tolerance_um)
        ),
        fraction => format!(
            "{:.1} % of the plane is within {} µm",
            fraction * 100.0,
            micrometres(map.setting.tolerance_um)
        ),
    };
    let limits = LimitCounts {
        outside: map.outside_joint_limits,
        of: map.grid.points,
        fraction_within: map.fraction_within,
    };
    let limits = limits.in_words();
    let along_normal = map.max_normal_um.map_or(String::new(), |um| {
        format!("; along the normal (depth) it is up to {} µm", micrometres(um))
    });
    format!(
        "{}, branch {}: {}{evaluation}{limits}; the in-plane deviation ranges from {} to {} µm ({}) and is largest at ({:.0}, {:.0}, {:.0}) mm{along_normal}; largest contribution: {}.{}",
        map.name,
        map.branch,
        lost.before_others(),
        micrometres(best.in_plane_um),
        micrometres(worst.in_plane_um),
        u_in_words(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        largest_contributor(robot, worst, &map.setting.contributors),
        map.vibration
            .as_ref()
            .map_or_else(String::new, VibrationAnswer::sentence),
    )
}
