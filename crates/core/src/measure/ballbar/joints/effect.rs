//! Effect of the backlash of a joint on the radius, with the model of backlash along any path.
//!
//! ```text
//! e_i(a, s; b) = n(a) . l_i(a) u_i(a, s; b)        u by source::backlash, after a whole turn as run-in
//! r(a, s)      = |R n + g + sum l_i u_i|           measured by a bar, about the pivot
//! ```
//!
//! A joint crosses its backlash while it reverses, over some degrees: the effect is therefore not exactly proportional
//! to the backlash. A negative backlash is the opposite of a positive one: an estimate may be negative by noise.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;

use super::super::profile::wrapped;
use super::super::run::Direction;
use super::along::{between, outwards};
use super::circle::Followed;
use super::joint_run::JointRun;
use super::reversal::JointReversal;
use crate::robot::BacklashSide;

/// Range next to a reversal in which its joint is followed, rad.
const ASIDE: f64 = 1e-3;

impl Followed {
    /// Number of joints of the arm.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Effect of the backlash (rad, m) of joint `joint` on the radius, m, at these angles (rad, any order) in this
    /// direction.
    pub fn effect(&self, joint: usize, gap: f64, direction: Direction, angles: &[f64]) -> Vec<f64> {
        JointRun::of(self, joint, direction, angles).effect(gap)
    }

    /// Derivative of the effect by the backlash, m per rad (m): for zero backlash that of a small one over its size.
    pub fn slope(&self, joint: usize, gap: f64, direction: Direction, angles: &[f64]) -> Vec<f64> {
        JointRun::of(self, joint, direction, angles).slope(gap)
    }

    /// Radial deviations measured by a bar at these angles (rad) in this direction, outwards positive, m: geometry,
    /// gravity and the backlash of all joints (rad, m; one per joint).
    pub fn deviation(&self, gaps: &[f64], direction: Direction, angles: &[f64]) -> Vec<f64> {
        let mut moved: Vec<Vector3<f64>> = angles.iter().map(|a| between(&self.unloaded, *a)).collect();
        for (joint, gap) in gaps.iter().enumerate().filter(|(_, gap)| **gap != 0.0) {
            let run = JointRun::of(self, joint, direction, angles);
            for ((moved, lever), lag) in moved.iter_mut().zip(run.levers()).zip(run.lags(*gap)) {
                *moved += lever * lag;
            }
        }
        let radius = |(a, moved): (&f64, &Vector3<f64>)| (outwards(*a) * self.radius + moved).norm();
        let shown = angles.iter().zip(&moved);
        shown.map(|sample| radius(sample) - self.radius).collect()
    }

    /// The part of that without backlash at one angle, m: equal in both directions.
    pub fn unloaded_at(&self, angle: f64) -> f64 {
        let moved = between(&self.unloaded, angle);
        (outwards(angle) * self.radius + moved).norm() - self.radius
    }

    /// Outward step of the radius where a joint reverses, m, in either direction; where a torque decides the
    /// side there is no step.
    pub fn step(&self, reversal: &JointReversal, gap: f64) -> f64 {
        let along = &self.joints[reversal.joint];
        let before = along.theta_at(reversal.angle) - along.theta_at(wrapped(reversal.angle - ASIDE));
        let lever = between(&along.lever, reversal.angle).dot(&outwards(reversal.angle));
        match along.side {
            BacklashSide::Motion => gap * before.signum() * lever,
            BacklashSide::Torque => 0.0,
        }
    }

    /// Where the link of a joint that reverses has crossed its backlash, in this direction, rad; `None` where it
    /// reverses again before, or not within a quarter turn.
    pub fn crossed(&self, reversal: &JointReversal, gap: f64, direction: Direction) -> Option<f64> {
        let along = &self.joints[reversal.joint];
        let turned = along.theta_at(reversal.angle);
        let on = |k: u32| reversal.angle + direction.sign() * f64::from(k) * ASIDE;
        let moved = |k: &u32| {
            let by = along.theta_at(wrapped(on(*k))) - turned;
            let whole = along.winding.abs().max(TAU);
            (by - whole * (by / whole).round()).abs()
        };
        let steps = 1..(FRAC_PI_2 / ASIDE) as u32;
        let mut farthest = 0.0;
        let rising = steps.take_while(|k| {
            let goes_on = moved(k) >= farthest;
            farthest = moved(k);
            goes_on
        });
        let mut passed = rising.skip_while(|k| moved(k) < gap.abs());
        passed.next().map(|k| wrapped(on(k)))
    }
}
