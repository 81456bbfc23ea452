//! Transitions between neighbouring columns of postures: joint speeds within limits and no jumps.

use std::f64::consts::TAU;

use super::chain::Links;
use super::grid::AXES;
use super::heading::Heading;
use super::winding::{Winding, WindingJoints};
use crate::kernel::{Column, PostureStatus};
use crate::robot::{Joint, Limits, Robot};

/// A joint that turns farther than this from one point to the next jumps, rad.
pub(super) const FAR: f64 = 0.5;
/// Rounding of a speed at its limit.
const AT_SPEED: f64 = 1.0 + 1e-9;

/// Speed limit and range of a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointRate {
    /// Largest speed, rad/s (m/s).
    most: Option<f64>,
    /// Whether its position is no result of the inverse kinematics: it cannot jump.
    is_set: bool,
    /// Whether it can also be a whole turn away.
    wraps: bool,
}

/// Joints with at least this range, in turns, wrap.
const WRAPPING: f64 = 1.5;

impl JointRate {
    pub fn all(robot: &Robot) -> Vec<JointRate> {
        let of = |(index, joint): (usize, &Joint)| {
            // The settings of the search give the positions of external axes, and their rate.
            let is_set = robot.slides(index) || robot.is_external(index);
            let enough = |limits: Limits| limits.upper - limits.lower >= WRAPPING * TAU;
            JointRate {
                most: joint.max_speed,
                is_set,
                wraps: !is_set && joint.limits.is_none_or(enough),
            }
        };
        robot.joints().iter().enumerate().map(of).collect()
    }

    /// Whether the joint can be a whole turn away.
    pub fn wraps(&self) -> bool {
        self.wraps
    }

    /// Motion of the joint from one position to the other, the shorter direction where both are possible.
    fn by(&self, from: f64, to: f64) -> f64 {
        let by = to - from;
        if self.wraps {
            by - TAU * (by / TAU).round()
        } else {
            by
        }
    }

    /// Whether the joint can go from one position to the other in this time, s, by less than `far` (rad).
    fn can(&self, from: f64, to: f64, time: Option<f64>, far: f64) -> bool {
        let by = self.by(from, to);
        let in_time = self
            .most
            .zip(time)
            .is_none_or(|(most, time)| by.abs() <= most * time * AT_SPEED);
        in_time && (self.is_set || by.abs() < far)
    }
}

/// Transitions between columns: joint speeds within limits and no jumps.
pub(super) struct Between<'a> {
    pub before: &'a Column,
    pub here: &'a Column,
    pub joints: &'a [JointRate],
    pub winding: &'a WindingJoints,
    /// Time from the column before, s, where the feed is known.
    pub time: Option<f64>,
    /// Shortest time for a step along each axis of the grid, s, where the feed is known.
    pub step_times: Option<[f64; AXES]>,
    /// A joint that turns farther than this jumps, rad.
    pub far: f64,
}

impl<'a> Between<'a> {
    fn can(&self, from: (&'a Column, usize), to: (&'a Column, usize), time: Option<f64>) -> bool {
        let usable = |(column, slot): (&Column, usize)| column.statuses[slot] == PostureStatus::Usable;
        usable(from)
            && usable(to)
            && self
                .positions(from, to)
                .all(|(joint, from, to)| joint.can(from, to, time, self.far))
    }

    /// Whole turns of the joints from one state to the other; `None` where they exceed a limit.
    fn wound(&self, before: &Winding, from: (&'a Column, usize), to: (&'a Column, usize)) -> Option<Winding> {
        let count = self.joints.len();
        let [from, to] = [from, to].map(|(column, slot)| column.joints_of(slot, count));
        let by = |joint: usize| self.joints[joint].by(from[joint], to[joint]);
        self.winding.after(before, by)
    }

    /// Directions of the joints between two states.
    fn heading(&self, from: (&'a Column, usize), to: (&'a Column, usize)) -> Heading {
        Heading::of(
            self.positions(from, to)
                .map(|(joint, from, to)| joint.by(from, to)),
        )
    }

    /// Every joint, with its positions in the two states.
    fn positions(
        &self,
        from: (&'a Column, usize),
        to: (&'a Column, usize),
    ) -> impl Iterator<Item = (&'a JointRate, f64, f64)> {
        let count = self.joints.len();
        let [from, to] = [from, to].map(|(column, slot)| column.joints_of(slot, count));
        let pairs = from.iter().zip(to);
        self.joints
            .iter()
            .zip(pairs)
            .map(|(joint, (from, to))| (joint, *from, *to))
    }
}

impl Links for Between<'_> {
    fn goes_on(&self, [from, to]: [usize; 2]) -> bool {
        self.can((self.before, from), (self.here, to), self.time)
    }

    fn moves_on(&self, [from, to]: [usize; 2]) -> Heading {
        self.heading((self.before, from), (self.here, to))
    }

    fn starts(&self, state: usize) -> Winding {
        self.winding.start(self.here.joints_of(state, self.joints.len()))
    }

    fn winds_on(&self, before: &Winding, [from, to]: [usize; 2]) -> Option<Winding> {
        self.wound(before, (self.before, from), (self.here, to))
    }

    fn winds_by_turn(&self, before: &Winding, [from, to]: [usize; 2]) -> Option<Winding> {
        self.wound(before, (self.here, from), (self.here, to))
    }

    fn turns(&self, axis: usize, [from, to]: [usize; 2]) -> bool {
        let time = self.step_times.map(|times| times[axis]);
        self.can((self.here, from), (self.here, to), time)
    }

    fn moves_by_turn(&self, [from, to]: [usize; 2]) -> Heading {
        self.heading((self.here, from), (self.here, to))
    }
}
