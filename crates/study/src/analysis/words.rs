//! Numbers and names in the sentences of an answer.

use armill_core::robot::Robot;

use crate::analysis::point::PointAnswer;

pub use crate::number::micrometres;

/// A part of a deviation that is shown as more than all of it.
const WHOLE: f64 = 1.005;

/// The largest contributor and its share.
pub fn largest_contributor(robot: &Robot, point: &PointAnswer, contributors: &[String]) -> String {
    point
        .mostly_by(contributors)
        .map_or_else(String::new, |(name, part)| {
            let is_joint = robot.joints().iter().any(|joint| joint.name == name);
            let name = format!("{} {name}", if is_joint { "joint" } else { "the" });
            match part {
                Some(part) if part > WHOLE => {
                    format!(
                        "{name} ({:.0} %; other contributions act against it)",
                        part * 100.0
                    )
                }
                Some(part) => format!("{name} ({:.0} %)", part * 100.0),
                None => name,
            }
        })
}

/// Points that cannot be reached, as the beginning of a sentence; nothing if all can.
pub fn unreached(lost: usize, of: usize) -> String {
    match lost {
        0 => String::new(),
        lost => format!("{lost} of {of} points cannot be reached; "),
    }
}
