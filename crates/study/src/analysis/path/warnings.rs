//! Warnings of a path: out of reach, outside joint limits, jumps and speeds of joints, motions that leave the tolerance, points without
//! force, thick chips.

use crate::analysis::path::answer::{CutAnswer, MotionAnswer, PathAnswer};
use crate::analysis::path::machined_part;
use crate::analysis::words::micrometres;

/// Stretches without posture that are reported at most.
const MOST_STRETCHES: usize = 5;

/// Warnings of a path that a user should know before relying on it.
///
/// In this order: points without the demanded clearance, points out of reach with what may be the reason, points outside joint limits, jumps and speeds of
/// joints, points whose deviation is zero only because no force is known there, chips that are too thick.
pub fn warnings(path: &PathAnswer) -> Vec<String> {
    let name = &path.name;
    let mut warnings = Vec::new();
    if path.in_collision > 0 {
        let collisions = path
            .obstacles
            .iter()
            .find(|obstacle| obstacle.kind == "collision");
        let worst = collisions.map_or_else(String::new, |found| format!(": {}", found.message));
        let between = (path.nearest.as_ref()).map_or_else(String::new, |[first, second]| {
            format!("; nearest are {first} and {second}")
        });
        warnings.push(format!(
            "{name}: no posture keeps the demanded clearance at {} of {} points{worst}{between}.",
            path.in_collision, path.points
        ));
    }
    if path.unreachable > path.in_collision {
        let hint = match path.program {
            Some(_) => "check the placement of the program (part_from_path_mm_deg)",
            None => "check that its coordinates are in mm, and the placement of the plane",
        };
        warnings.push(format!(
            "{name}: {} of {} points are out of reach; {hint}.",
            path.unreachable - path.in_collision,
            path.points
        ));
    }
    if path.outside_joint_limits > 0 {
        warnings.push(format!(
            "{name}: {} of {} points are outside joint limits in the branch {}.",
            path.outside_joint_limits,
            path.points,
            path.followed_branch.as_ref().unwrap_or(&path.branch)
        ));
    }
    let stops = path.obstacles.iter();
    let stops: Vec<&str> = stops
        .filter(|obstacle| matches!(obstacle.kind, "jump" | "joint-speed"))
        .map(|obstacle| obstacle.message.as_str())
        .collect();
    if !stops.is_empty() {
        warnings.push(format!(
            "{name}: the arm cannot follow at the feed without a stop: {}.",
            stops.join("; ")
        ));
    }
    warnings.extend(path.motion.as_ref().and_then(|motion| off_the_path(path, motion)));
    if let Some(search) = &path.search {
        warnings.extend(search.unreachable_stretches.iter().take(MOST_STRETCHES).map(|stretch| {
            format!(
                "{name}: no spin of the tool and branch is usable at {} points from line {} to {} ({}).",
                stretch.points,
                stretch.first_line,
                stretch.last_line,
                stretch.reason.replace('_', " ")
            )
        }));
        if let Some(first) = search.breaks.first() {
            warnings.push(format!(
                "{name}: the arm has to stop and change its posture {} times, first in line {first}: no spin of the tool continues within the speed of the joints.",
                search.breaks.len()
            ));
        }
    }
    let without_force = path.cut.as_ref().map_or(0, |cut| cut.points_without_force);
    if without_force > 0 {
        warnings.push(format!(
            "{name}: the deviation is reported as zero at {without_force} of {} points without a known force (a cutter that plunges or ramps steeply cuts with its bottom, a drill that moves sideways does not drill).",
            path.points
        ));
    }
    warnings.extend(path.cut.as_ref().and_then(|cut| thick_chips(name, cut)));
    warnings.extend(machined_part::report::warnings(path));
    warnings
}

/// Chips so thick that feed or spindle speed are hardly meant so.
fn thick_chips(name: &str, cut: &CutAnswer) -> Option<String> {
    let (line, largest) = (cut.first_thick_chip_line?, cut.largest_chip_um?);
    Some(format!(
        "{name}: chips are thicker than a fifth of the radius of the cutter at {} points, the first in line {line} (up to {} µm): check the \
         units of feed and spindle speed; the coefficients of the material are extrapolated there.",
        cut.points_with_thick_chips,
        micrometres(largest)
    ))
}

/// Rounded corners, or joints that follow late, that exceed the tolerance without any load.
fn off_the_path(path: &PathAnswer, motion: &MotionAnswer) -> Option<String> {
    let causes = [
        (
            "rounded corners",
            motion.largest_blending_um,
            motion.largest_blending_line,
        ),
        (
            "joints that follow late",
            motion.largest_servo_um,
            motion.largest_servo_line,
        ),
    ];
    let (cause, largest, line) = causes.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (largest > path.setting.tolerance_um).then(|| {
        format!(
            "{}: {cause} alone move the tool by up to {} µm (line {line}), more than the tolerance.",
            path.name,
            micrometres(largest)
        )
    })
}
