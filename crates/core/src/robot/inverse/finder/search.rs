//! The search: descents from many starts, or from the postures of the pose before.

use std::f64::consts::PI;

use super::super::super::unreachable::Unreachable;
use super::super::descent::Goal;
use super::super::kind::ENOUGH;
use super::super::starts::spread;
use super::{Finder, InverseTarget, SAME, nearer};
use crate::frame::Isometry;

/// Postures after which a search ends, to take the nearest of them: redundant and singular poses have infinitely many.
const PLENTY: usize = 32;
/// Maximum number of starts of a search.
const MOST_STARTS: usize = 400;
/// [`SAME`] of redundant joints, which converge less accurately.
const SAME_REDUNDANT: f64 = 1e-2;
/// A posture that moved farther than this (rad, m) from the pose before is not its continuation.
const JUMP: f64 = 0.5;

impl Finder<'_> {
    /// Postures by descents, until `barren` starts in a row have found nothing new.
    pub(super) fn search(
        &mut self,
        requested: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        most: usize,
        barren: usize,
    ) -> Option<Unreachable> {
        let goal = Goal::new(arm_from_flange);
        let home = self.chain_positions(&self.home);
        if self.follow(requested, &goal, &home, most) {
            return None;
        }
        let ranges = self.ranges();
        let mut theta = home.clone();
        let mut missed: Option<Unreachable> = None;
        let mut idle = 0;
        for start in 1..=MOST_STARTS {
            if idle == barren || self.found.len() == PLENTY {
                break;
            }
            idle += 1;
            spread(start, &ranges, &mut theta);
            match self.descend(&goal, &home, &mut theta) {
                Ok(()) if self.is_known(&theta, self.same()) => {}
                Ok(()) => match self.keep_searched(requested, &theta) {
                    Ok(()) => idle = 0,
                    Err(miss) => missed = Some(nearer(missed, miss)),
                },
                Err(miss) => missed = Some(nearer(missed, miss)),
            }
        }
        self.order(requested.near, most);
        missed
    }

    /// Takes those postures of the previous pose that have a continuation here; false if none has.
    fn follow(&mut self, requested: &InverseTarget<'_>, goal: &Goal, home: &[f64], most: usize) -> bool {
        if self.before.len() > most {
            return false;
        }
        let mut before = std::mem::take(&mut self.before);
        before.retain_mut(|theta| {
            let from = theta.clone();
            let reached = self.descend(goal, home, theta).is_ok();
            let away = theta.iter().zip(&from).map(|(a, b)| (a - b).abs());
            reached
                && away.fold(0.0, f64::max) < JUMP
                && !self.is_known(theta, self.same())
                && self.keep_searched(requested, theta).is_ok()
        });
        self.before = before;
        !self.before.is_empty()
    }

    fn descend(&mut self, goal: &Goal, home: &[f64], theta: &mut [f64]) -> Result<(), Unreachable> {
        let (descent, chain) = self.descent();
        if theta.len() > ENOUGH {
            descent.reach_near(chain, goal, home, theta)
        } else {
            descent.reach(chain, goal, theta)
        }
    }

    fn same(&self) -> f64 {
        if self.arm.chain.links().len() > ENOUGH {
            SAME_REDUNDANT
        } else {
            SAME
        }
    }

    /// Ranges of the chain positions of the arm; one turn for joints without limits.
    fn ranges(&self) -> Vec<[f64; 2]> {
        let middles = self.chain_positions(&self.robot.middles());
        let range = |(i, middle): (usize, f64)| {
            let joint = self.arm.first + i;
            let half = self.robot.joints()[joint]
                .limits
                .map(|limits| 0.5 * (limits.upper - limits.lower));
            let half = if self.robot.slides(joint) {
                half.unwrap_or(self.arm.chain.length())
            } else {
                half.unwrap_or(PI).min(PI)
            };
            [middle - half, middle + half]
        };
        middles.into_iter().enumerate().map(range).collect()
    }
}
