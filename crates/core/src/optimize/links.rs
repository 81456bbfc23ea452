//! What leads from one column of postures to the next: joints that are fast enough and do not jump.

use std::f64::consts::TAU;

use super::chain::Links;
use crate::kernel::{Column, SLOTS, Stand};
use crate::robot::{Joint, Limits, Robot};

/// A joint that turns farther than this from one point to the next jumps, rad.
const FAR: f64 = 0.5;
/// Rounding of a speed at its limit.
const AT_SPEED: f64 = 1.0 + 1e-9;

/// How fast a joint is, and how it counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointRate {
    /// rad/s (m/s).
    most: Option<f64>,
    slides: bool,
    /// Whether it may stand a whole turn away as well. The chain does not count turns, so of a joint that turns a little
    /// more than once it says no.
    wraps: bool,
}

/// Joints with a range of so many turns wrap.
const WRAPPING: f64 = 1.5;

impl JointRate {
    pub fn all(robot: &Robot) -> Vec<JointRate> {
        let of = |(index, joint): (usize, &Joint)| {
            let slides = robot.slides(index);
            let enough = |limits: Limits| limits.upper - limits.lower >= WRAPPING * TAU;
            JointRate {
                most: joint.max_speed,
                slides,
                wraps: !slides && joint.limits.is_none_or(enough),
            }
        };
        robot.joints().iter().enumerate().map(of).collect()
    }

    /// Whether the joint can go from one position to the other in this time, s.
    fn can(&self, from: f64, to: f64, time: Option<f64>) -> bool {
        let by = to - from;
        let by = if self.wraps {
            by - TAU * (by / TAU).round()
        } else {
            by
        };
        let in_time = self
            .most
            .zip(time)
            .is_none_or(|(most, time)| by.abs() <= most * time * AT_SPEED);
        in_time && (self.slides || by.abs() < FAR)
    }
}

/// What leads from one column to the next: joints that are fast enough and do not jump.
pub(super) struct Between<'a> {
    pub before: &'a Column,
    pub here: &'a Column,
    pub joints: &'a [JointRate],
    pub time: Option<f64>,
    pub turn_time: Option<f64>,
}

impl Between<'_> {
    fn can(&self, from: (&Column, usize), to: (&Column, usize), time: Option<f64>) -> bool {
        let count = self.joints.len();
        let holds = |(column, slot): (&Column, usize)| column.stands[slot] == Stand::Holds;
        let positions = from
            .0
            .joints_of(from.1, count)
            .iter()
            .zip(to.0.joints_of(to.1, count));
        holds(from)
            && holds(to)
            && self
                .joints
                .iter()
                .zip(positions)
                .all(|(joint, (from, to))| joint.can(*from, *to, time))
    }
}

impl Links for Between<'_> {
    fn goes_on(&self, turn: usize, from: usize, to: usize) -> bool {
        let first = turn * SLOTS;
        self.can((self.before, first + from), (self.here, first + to), self.time)
    }

    fn turns(&self, turn: usize, next: usize, from: usize, to: usize) -> bool {
        let (from, to) = (turn * SLOTS + from, next * SLOTS + to);
        self.can((self.here, from), (self.here, to), self.turn_time)
    }
}
