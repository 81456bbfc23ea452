//! One joint along the samples of a run: its motion, its levers, and the lag of its link for any backlash.
//!
//! Nothing but the lag depends on the backlash. A fit evaluates many backlashes of the same runs: the rest is computed
//! once.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::super::profile::wrapped;
use super::super::run::Direction;
use super::along::{between, between_numbers, outwards};
use super::circle::Followed;
use crate::robot::{Backlash, BacklashSide};
use crate::source::backlash::{along, link_offset};
use crate::spatial::{Twist, Wrench};

/// Difference for the derivative by the backlash, relative, and at least, rad (m).
const STEP: [f64; 2] = [1e-4, 1e-9];

/// One joint along the samples of a run.
#[derive(Clone, Debug)]
pub(super) struct JointRun {
    /// Motion of the joint to each stop, in the order of motion; to the first one from the last, rad (m).
    moves: Vec<f64>,
    /// The stop of each sample.
    stop: Vec<usize>,
    /// Lever at each sample, axes of the circle, m/rad (m/m).
    lever: Vec<Vector3<f64>>,
    /// Its outward part.
    outward: Vec<f64>,
    /// Torque of gravity on the link at each sample, N m (N).
    torque: Vec<f64>,
    /// What decides on which side of the backlash the link is.
    side: BacklashSide,
}

impl JointRun {
    /// Joint `joint` along these angles (rad, any order) in this direction.
    pub fn of(followed: &Followed, joint: usize, direction: Direction, angles: &[f64]) -> JointRun {
        let on_circle = &followed.joints[joint];
        // Stops: stations, reversals, and the requested angles.
        let count = on_circle.theta.len();
        let stations =
            (0..count).map(|index| (TAU * index as f64 / count as f64, on_circle.theta[index], None));
        let turns = followed
            .reversals
            .iter()
            .filter(|reversal| reversal.joint == joint);
        let turns = turns.map(|reversal| (reversal.angle, on_circle.theta_at(reversal.angle), None));
        let requested = angles.iter().enumerate().map(|(place, angle)| {
            let angle = wrapped(*angle);
            (angle, on_circle.theta_at(angle), Some(place))
        });
        let mut stops: Vec<(f64, f64, Option<usize>)> = stations.chain(turns).chain(requested).collect();
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let seam = match direction {
            Direction::Anticlockwise => on_circle.winding,
            Direction::Clockwise => {
                stops.reverse();
                -on_circle.winding
            }
        };
        let moves = (0..stops.len()).map(|k| match k {
            0 => stops[0].1 + seam - stops[stops.len() - 1].1,
            k => stops[k].1 - stops[k - 1].1,
        });
        let mut stop = vec![0; angles.len()];
        for (index, (.., place)) in stops.iter().enumerate() {
            if let Some(place) = place {
                stop[*place] = index;
            }
        }
        let lever: Vec<Vector3<f64>> = angles.iter().map(|a| between(&on_circle.lever, *a)).collect();
        let outward = angles
            .iter()
            .zip(&lever)
            .map(|(a, lever)| lever.dot(&outwards(*a)));
        JointRun {
            moves: moves.collect(),
            stop,
            outward: outward.collect(),
            torque: angles
                .iter()
                .map(|a| between_numbers(&on_circle.torque, wrapped(*a)))
                .collect(),
            lever,
            side: on_circle.side,
        }
    }

    /// Lever at each sample, axes of the circle, m/rad (m/m).
    pub fn levers(&self) -> &[Vector3<f64>] {
        &self.lever
    }

    /// Link minus motor at each sample with this backlash, rad (m); after a whole turn as run-in.
    pub fn lags(&self, gap: f64) -> Vec<f64> {
        let backlash = Backlash {
            gap: gap.abs(),
            standard_uncertainty: 0.0,
            side: self.side,
        };
        let twice = self.moves.iter().chain(&self.moves).copied();
        let links: Vec<f64> = along(twice, backlash.gap).skip(self.moves.len()).collect();
        let samples = self.stop.iter().zip(&self.torque);
        samples
            .map(|(stop, torque)| {
                link_offset(&backlash, links[*stop], &Twist::ZERO, &Wrench::ZERO, *torque) * gap.signum()
            })
            .collect()
    }

    /// Effect of this backlash (rad, m) on the radius at each sample, m.
    pub fn effect(&self, gap: f64) -> Vec<f64> {
        let lags = self.lags(gap);
        self.outward
            .iter()
            .zip(lags)
            .map(|(lever, lag)| lever * lag)
            .collect()
    }

    /// Derivative of the effect by the backlash, m per rad (m): for zero backlash that of a small one over its size.
    pub fn slope(&self, gap: f64) -> Vec<f64> {
        let step = (STEP[0] * gap.abs()).max(STEP[1]);
        let [more, less] = [gap + step, gap - step].map(|gap| self.effect(gap));
        let pairs = more.iter().zip(&less);
        pairs.map(|(more, less)| (more - less) / (2.0 * step)).collect()
    }
}
