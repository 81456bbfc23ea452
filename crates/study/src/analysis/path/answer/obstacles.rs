//! Obstacles of a path: where the arm cannot follow it at its feed without a stop, each joint and kind once.

use armill_core::kernel::Answers;
use armill_core::map::{Obstacle, ObstacleKind, obstacles};
use armill_core::path::{PathPoint, SampledPath};
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use schemars::JsonSchema;
use serde::Serialize;

use crate::joint_unit::JointUnit;

/// An obstacle of one kind and joint, where it is largest.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ObstacleAnswer {
    /// `unreachable`, `collision`, `joint-limit`, `jump` or `joint-speed`.
    pub kind: &'static str,
    /// The joint; none where no posture exists.
    pub joint: Option<String>,
    /// Number of points with this obstacle.
    pub points: usize,
    /// Line of the first of them.
    pub first_line: u32,
    /// Line of the largest.
    pub line: u32,
    /// Distance from the limit (negative outside), angle of the jump, or required speed at the largest, in `unit`.
    // unit: that of `unit`
    pub value: Option<f64>,
    /// Smallest permitted distance from the limit, or largest speed, in `unit`.
    // unit: that of `unit`
    pub limit: Option<f64>,
    /// deg, mm, deg/s or mm/s.
    pub unit: Option<String>,
    /// As a sentence without its full stop.
    pub message: String,
}

/// The obstacles along `path` in the postures of `answers`, for joints at least `margin` (rad, m) from their limits; in
/// the order of their first points.
pub fn found(robot: &Robot, path: &SampledPath, answers: &Answers, margin: f64) -> Vec<ObstacleAnswer> {
    let mut groups: Vec<Group> = Vec::new();
    for obstacle in obstacles(robot, path, answers, margin) {
        let key = key(&obstacle.kind);
        match groups.iter_mut().find(|group| group.key == key) {
            Some(group) => group.add(obstacle),
            None => groups.push(Group {
                key,
                points: 1,
                first: obstacle.index,
                largest: obstacle,
            }),
        }
    }
    groups
        .iter()
        .map(|group| group.answer(robot, path, margin))
        .collect()
}

/// Where a point is: in a line of its program, or at this length of a shape.
fn place(point: &PathPoint) -> String {
    match point.line {
        0 => format!("at {:.1} mm of the path", to_mm(point.along)),
        line => format!("in line {line}"),
    }
}

/// Kind and joint.
type Key = (&'static str, Option<usize>);

fn key(kind: &ObstacleKind) -> Key {
    match kind {
        ObstacleKind::Unreachable => ("unreachable", None),
        ObstacleKind::InCollision { .. } => ("collision", None),
        ObstacleKind::OutsideLimits { joint, .. } => ("joint-limit", Some(*joint)),
        ObstacleKind::Jump { joint, .. } => ("jump", Some(*joint)),
        ObstacleKind::TooSlow { joint, .. } => ("joint-speed", Some(*joint)),
    }
}

/// Obstacles of one kind and joint.
struct Group {
    key: Key,
    points: usize,
    first: usize,
    largest: Obstacle,
}

impl Group {
    fn add(&mut self, obstacle: Obstacle) {
        self.points += 1;
        let size = |kind: &ObstacleKind| match kind {
            ObstacleKind::Unreachable => 0.0,
            ObstacleKind::InCollision { missing } => *missing,
            ObstacleKind::OutsideLimits { margin, .. } => -margin,
            ObstacleKind::Jump { by, .. } => by.abs(),
            ObstacleKind::TooSlow { required, .. } => *required,
        };
        if size(&obstacle.kind) > size(&self.largest.kind) {
            self.largest = obstacle;
        }
    }

    fn answer(&self, robot: &Robot, path: &SampledPath, margin: f64) -> ObstacleAnswer {
        let (kind, joint) = self.key;
        let unit = joint.map_or(
            if kind == "collision" {
                JointUnit::SLIDING
            } else {
                JointUnit::TURNING
            },
            |joint| JointUnit::of(robot, joint),
        );
        let [first, largest] = [self.first, self.largest.index].map(|index| &path.points[index]);
        let at = place(largest);
        let name = joint.map_or("", |joint| robot.joints()[joint].name.as_str());
        let (value, limit, per, message) = match self.largest.kind {
            ObstacleKind::Unreachable => (None, None, None, format!("no posture reaches the point {at}")),
            ObstacleKind::InCollision { missing } => {
                let missing = to_mm(missing);
                let message = match missing > 0.0 {
                    true => format!("{missing:.1} mm of the demanded clearance are missing {at}"),
                    false => format!("two bodies touch {at}"),
                };
                (Some(missing), Some(0.0), Some(""), message)
            }
            ObstacleKind::OutsideLimits { margin: room, .. } => {
                let (room, least) = (room * unit.scale, margin * unit.scale);
                let message = match room < 0.0 {
                    true => format!(
                        "joint {name} is {:.1} {} outside its limit {at}",
                        -room, unit.name
                    ),
                    false => format!(
                        "joint {name} is {room:.1} {} from its limit {at}, less than the margin of {least:.1} {}",
                        unit.name, unit.name
                    ),
                };
                (Some(room), Some(least), Some(""), message)
            }
            ObstacleKind::Jump { by, .. } => {
                let by = by * unit.scale;
                let message = format!("joint {name} turns by {by:.0} {} at once {at}", unit.name);
                (Some(by), None, Some(""), message)
            }
            ObstacleKind::TooSlow {
                required, maximum, ..
            } => {
                let (required, maximum) = (required * unit.scale, maximum * unit.scale);
                let message = format!(
                    "joint {name} would need {required:.0} {}/s to keep the feed {at}; its maximum is {maximum:.0} {}/s",
                    unit.name, unit.name
                );
                (Some(required), Some(maximum), Some("/s"), message)
            }
        };
        ObstacleAnswer {
            kind,
            joint: joint.map(|_| name.to_owned()),
            points: self.points,
            first_line: first.line,
            line: largest.line,
            value,
            limit,
            unit: per.map(|per| format!("{}{per}", unit.name)),
            message: match self.points {
                1 => message,
                points => format!("{message} ({points} points, the first {})", place(first)),
            },
        }
    }
}
