//! The answer in one sentence.

use armill_core::robot::Robot;

use crate::analysis::vibration::VibrationAnswer;
use crate::analysis::volume::answer::VolumeAnswer;
use crate::analysis::words::{LimitCounts, LostPoints, largest_contributor, micrometres};
use crate::uncertainty_words::u_in_words;

/// Points that are not reached, fraction of a box, and where in it the deviation is largest.
pub fn sentence(robot: &Robot, volume: &VolumeAnswer) -> String {
    let lost = LostPoints {
        lost: volume.counts.unreached(),
        in_collision: volume.counts.in_collision,
        of: volume.counts.total(),
        nearest: volume.nearest.as_ref().zip(volume.least_clearance_mm),
    };
    let Some(worst) = &volume.worst else {
        let subject = format!("{}, branch {}", volume.name, volume.branch);
        return lost.sentence("point of the box", &subject);
    };
    let limits = LimitCounts {
        outside: volume.outside_joint_limits,
        of: volume.counts.total(),
        fraction_within: volume.fraction_within,
    };
    let limits = limits.in_words();
    format!(
        "{}, branch {}: {}{:.1} % of the box is within {} µm{limits}; the in-plane deviation is at most {} µm ({}), at ({:.0}, {:.0}, {:.0}) mm; largest contribution: {}.{}",
        volume.name,
        volume.branch,
        lost.before_others(),
        volume.fraction_within_and_inside_joint_limits * 100.0,
        micrometres(volume.setting.tolerance_um),
        micrometres(worst.in_plane_um),
        u_in_words(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        largest_contributor(robot, worst, &volume.setting.contributors),
        volume
            .vibration
            .as_ref()
            .map_or_else(String::new, VibrationAnswer::sentence),
    )
}
