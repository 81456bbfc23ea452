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
use super::along::{between, between_numbers};
use super::circle::Followed;
use super::reversal::JointReversal;
use crate::robot::{Backlash, BacklashSide};
use crate::source::backlash::{along, link_offset};
use crate::spatial::{Twist, Wrench};

/// Difference for the derivative by the backlash, relative, and at least, rad (m).
const STEP: [f64; 2] = [1e-4, 1e-9];
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
        let lags = self.lags(joint, gap, direction, angles);
        let lever = |a: f64| between(&self.joints[joint].lever, a).dot(&outwards(a));
        angles.iter().zip(lags).map(|(a, lag)| lever(*a) * lag).collect()
    }

    /// Derivative of the effect by the backlash, m per rad (m): for zero backlash that of a small one over its size.
    pub fn slope(&self, joint: usize, gap: f64, direction: Direction, angles: &[f64]) -> Vec<f64> {
        let step = (STEP[0] * gap.abs()).max(STEP[1]);
        let [more, less] = [gap + step, gap - step].map(|gap| self.effect(joint, gap, direction, angles));
        let pairs = more.iter().zip(&less);
        pairs.map(|(more, less)| (more - less) / (2.0 * step)).collect()
    }

    /// Radial deviations measured by a bar at these angles (rad) in this direction, outwards positive, m: geometry,
    /// gravity and the backlash of all joints (rad, m; one per joint).
    pub fn deviation(&self, gaps: &[f64], direction: Direction, angles: &[f64]) -> Vec<f64> {
        let mut moved: Vec<Vector3<f64>> = angles.iter().map(|a| between(&self.unloaded, *a)).collect();
        for (joint, gap) in gaps.iter().enumerate().filter(|(_, gap)| **gap != 0.0) {
            let lags = self.lags(joint, *gap, direction, angles);
            for ((moved, a), lag) in moved.iter_mut().zip(angles).zip(lags) {
                *moved += between(&self.joints[joint].lever, *a) * lag;
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

    /// Link minus motor at these angles, rad (m).
    fn lags(&self, joint: usize, gap: f64, direction: Direction, angles: &[f64]) -> Vec<f64> {
        let along_joint = &self.joints[joint];
        let backlash = Backlash {
            gap: gap.abs(),
            standard_uncertainty: 0.0,
            side: along_joint.side,
        };
        // Stops in the order of motion: stations, reversals, and the requested angles.
        let count = along_joint.theta.len();
        let stations =
            (0..count).map(|index| (TAU * index as f64 / count as f64, along_joint.theta[index], None));
        let turns = self.reversals.iter().filter(|reversal| reversal.joint == joint);
        let turns = turns.map(|reversal| (reversal.angle, along_joint.theta_at(reversal.angle), None));
        let requested = angles.iter().enumerate().map(|(place, angle)| {
            let angle = wrapped(*angle);
            (angle, along_joint.theta_at(angle), Some(place))
        });
        let mut stops: Vec<(f64, f64, Option<usize>)> = stations.chain(turns).chain(requested).collect();
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let seam = match direction {
            Direction::Anticlockwise => along_joint.winding,
            Direction::Clockwise => {
                stops.reverse();
                -along_joint.winding
            }
        };
        let moves = (0..stops.len()).map(|k| match k {
            0 => stops[0].1 + seam - stops[stops.len() - 1].1,
            k => stops[k].1 - stops[k - 1].1,
        });
        let twice = moves.clone().chain(moves);
        let links = along(twice, backlash.gap).skip(stops.len());
        let mut found = vec![0.0; angles.len()];
        for ((angle, _, place), link) in stops.iter().zip(links) {
            if let Some(place) = place {
                let torque = between_numbers(&along_joint.torque, *angle);
                let offset = link_offset(&backlash, link, &Twist::ZERO, &Wrench::ZERO, torque);
                found[*place] = offset * gap.signum();
            }
        }
        found
    }
}

/// Outwards at an angle, along the axes of the circle.
fn outwards(angle: f64) -> Vector3<f64> {
    Vector3::new(angle.cos(), angle.sin(), 0.0)
}
