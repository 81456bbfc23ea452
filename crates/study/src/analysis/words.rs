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
            let name = match motion_in_words(name) {
                Some(words) => words.to_owned(),
                None => format!("{} {name}", if is_joint { "joint" } else { "the" }),
            };
            match part {
                Some(part) => format!("{name} ({})", share_in_words(part)),
                None => name,
            }
        })
}

/// A contributor of the motion in words; `None` for others.
pub fn motion_in_words(contributor: &str) -> Option<&'static str> {
    match contributor {
        "blending" => Some("rounded corners"),
        "servo" => Some("joints that follow late"),
        _ => None,
    }
}

/// Points without a result.
#[derive(Clone, Copy, Debug)]
pub struct LostPoints<'a> {
    /// All of them.
    pub lost: usize,
    /// Those where no posture keeps the demanded clearance.
    pub in_collision: usize,
    /// All points.
    pub of: usize,
    /// The two bodies that are nearest to each other, and their distance, mm.
    pub nearest: Option<(&'a [String; 2], f64)>,
}

impl LostPoints<'_> {
    /// The beginning of a sentence about the others; nothing if there is no lost point.
    pub fn before_others(self) -> String {
        let LostPoints {
            lost,
            in_collision,
            of,
            ..
        } = self;
        let reached = match lost - in_collision {
            0 => String::new(),
            unreached => format!("{unreached} of {of} points cannot be reached; "),
        };
        match in_collision {
            0 => reached,
            count => format!("{reached}{count} of {of} points do not keep the demanded clearance; "),
        }
    }

    /// The sentence where all points are lost; `whole` are the points, such as `point of the path`, and `subject` is the analysis with its
    /// branch.
    pub fn sentence(self, whole: &str, subject: &str) -> String {
        if self.in_collision == 0 {
            return format!("The robot reaches no {whole} ({subject}).");
        }
        let worst = self
            .nearest
            .map_or_else(String::new, |([first, second], distance)| {
                let there = match distance > 0.0 {
                    true => format!("are {distance:.1} mm apart"),
                    false => "touch".to_owned(),
                };
                format!("; at the worst {first} and {second} {there}")
            });
        let count = match self.in_collision == self.of {
            true => format!("at all {}", self.of),
            false => format!("at {} of {}", self.in_collision, self.of),
        };
        format!(
            "The robot can work at no {whole} ({subject}): no posture keeps the demanded clearance {count}{worst}."
        )
    }
}

/// Counts of points relative to joint limits.
#[derive(Clone, Copy, Debug)]
pub struct LimitCounts {
    /// Points with a posture outside the limits.
    pub outside: usize,
    /// All points.
    pub of: usize,
    /// Part of all points within the tolerance, inside the limits or not.
    pub fraction_within: f64,
}

impl LimitCounts {
    /// What to add to a statement about the points within the tolerance and inside joint limits; nothing if all are inside.
    pub fn in_words(self) -> String {
        let LimitCounts { outside, of, .. } = self;
        match outside {
            0 => String::new(),
            _ => format!(
                " and inside joint limits ({:.1} % if the {outside} of {of} points outside them are included)",
                self.fraction_within * 100.0
            ),
        }
    }
}

/// A share of a deviation: above 100 % others act against it; below zero it acts against the deviation itself.
pub fn share_in_words(part: f64) -> String {
    let percent = format!("{:.0} %", part * 100.0);
    match part {
        part if part > WHOLE => format!("{percent}; other contributions act against it"),
        part if part < 0.0 => format!("{percent}; it acts against the deviation"),
        _ => percent,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_more_than_all_or_less_than_nothing_is_explained() {
        assert_eq!(share_in_words(0.55), "55 %");
        assert_eq!(share_in_words(1.0), "100 %");
        assert_eq!(share_in_words(1.05), "105 %; other contributions act against it");
        assert_eq!(share_in_words(-7.11), "-711 %; it acts against the deviation");
    }
}
