//! Numbers and names in the sentences of an answer.

use armill_core::robot::Robot;

use crate::analysis::point::PointAnswer;

pub use crate::number::micrometres;

/// The largest contributor and its share.
pub fn largest_contributor(robot: &Robot, point: &PointAnswer, contributors: &[String]) -> String {
    point
        .mostly_by(contributors)
        .map_or_else(String::new, |(name, part)| {
            let is_joint = robot.joints().iter().any(|joint| joint.name == name);
            let name = format!("{} {name}", if is_joint { "joint" } else { "the" });
            match part {
                Some(part) => format!("{name} ({:.0} %)", part * 100.0),
                None => name,
            }
        })
}
