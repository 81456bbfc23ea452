//! The answer in one sentence.

use armill_core::robot::Robot;

use crate::analysis::path::answer::{CutAnswer, MotionAnswer, PathAnswer};
use crate::analysis::path::machined_part;
use crate::analysis::vibration::VibrationAnswer;
use crate::analysis::words::{LimitCounts, LostPoints, largest_contributor, micrometres};
use crate::uncertainty_words::u_in_words;

/// Largest deviation along a path with its line, roundness of a circle, and the fraction within the tolerance.
pub fn sentence(robot: &Robot, path: &PathAnswer) -> String {
    let lost = LostPoints {
        lost: path.unreachable,
        in_collision: path.in_collision,
        of: path.points,
        nearest: path.nearest.as_ref().zip(path.least_clearance_mm),
    };
    let Some(worst) = &path.worst else {
        let subject = format!("{}, branch {}", path.name, path.branch);
        return lost.sentence("point of the path", &subject);
    };
    let (where_to, circle, line) = match &path.program {
        None => ("in the plane", "the circle", String::new()),
        Some(_) => {
            let line = path.worst_points.first().map(|worst| worst.line);
            let line = line.map_or(String::new(), |line| format!(" (line {line})"));
            ("across its axis", "a circle", line)
        }
    };
    let roundness = path.roundness_um.map_or(String::new(), |r| {
        format!("; the roundness deviation of {circle} is {} µm", micrometres(r))
    });
    let limits = LimitCounts {
        outside: path.outside_joint_limits,
        of: path.points,
        fraction_within: path.fraction_within,
    };
    let limits = limits.in_words();
    let process = path.cut.as_ref().map_or(String::new(), process);
    let clearance = clearance(path);
    let vibration = path
        .vibration
        .as_ref()
        .map_or_else(String::new, VibrationAnswer::sentence);
    let part = path
        .machined_part
        .as_ref()
        .map_or_else(String::new, machined_part::report::sentence);
    let motion = path.motion.as_ref().map_or(String::new(), motion);
    format!(
        "{}, branch {}: {}the tool deviates by up to {} µm ({}) {where_to}{line}{roundness}; largest contribution: {}; {:.1} % of the path is within {} µm{limits}.{clearance}{process}{vibration}{motion}{part}",
        path.name,
        path.followed_branch.as_ref().unwrap_or(&path.branch),
        lost.before_others(),
        micrometres(worst.in_plane_um),
        u_in_words(worst.in_plane_u_um),
        largest_contributor(robot, worst, &path.setting.contributors),
        path.fraction_within_and_inside_joint_limits * 100.0,
        micrometres(path.setting.tolerance_um),
    )
}

/// The least clearance, as a further sentence; empty without bodies.
fn clearance(path: &PathAnswer) -> String {
    let Some((least, [first, second])) = path.least_clearance_mm.zip(path.nearest.as_ref()) else {
        return String::new();
    };
    match least > 0.0 {
        true => format!(" The least clearance is {least:.1} mm, of {first} and {second}."),
        false => format!(" {first} and {second} touch."),
    }
}

/// Time and largest errors of the motion, as a further sentence.
fn motion(motion: &MotionAnswer) -> String {
    let lost = motion.cutting_time_s - motion.programmed_time_s;
    let cause = match motion.lost_time.first() {
        Some(cause) if lost > 0.01 * motion.programmed_time_s => format!(", mostly by {}", cause.limited_by),
        _ => String::new(),
    };
    format!(
        " The program takes {:.1} s; its cuts take {:.1} s, {lost:+.1} s from the time at the programmed feed{cause}. Rounded corners are up to {} µm from the \
         programmed path, and the tip up to {} µm from the commanded one, because joints follow late.",
        motion.cycle_time_s,
        motion.cutting_time_s,
        micrometres(motion.largest_blending_um),
        micrometres(motion.largest_servo_um)
    )
}

/// Force, torque, chip thickness and removal rate of a cut, as a further sentence.
fn process(cut: &CutAnswer) -> String {
    let force = format!(
        " The cutting force is up to {:.1} N averaged over a revolution and {:.1} N within one",
        cut.largest_mean_n, cut.largest_peak_n
    );
    let torque = (cut.largest_mean_torque_n_m.zip(cut.largest_torque_n_m))
        .map(|(mean, largest)| format!(", the torque {mean:.2} and {largest:.2} N m"));
    let chip = cut
        .largest_chip_um
        .map(|um| format!("; chips are up to {um:.1} µm thick"));
    let removal = (cut.largest_removal_mm3_per_s.filter(|rate| *rate > 0.0))
        .map(|rate| format!(", {rate:.0} mm³/s are removed"));
    let more: String = [torque, chip, removal].into_iter().flatten().collect();
    format!("{force}{more}.")
}
