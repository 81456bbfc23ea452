//! The search: descents from many starts, or from the postures of the pose before. In lanes, unless joints
//! are redundant.

use std::f64::consts::PI;

use super::super::super::unreachable::Unreachable;
use super::super::descents::Descents;
use super::super::descents_in_lanes::Reached;
use super::super::kind::ENOUGH;
use super::super::starts::Starts;
use super::super::verify::Requested;
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

/// What the descents of a search go to.
struct Aim<'a> {
    goal: &'a Requested,
    /// Chain positions to which redundant joints are pulled.
    home: &'a [f64],
}

impl Finder<'_> {
    /// Postures by descents, until `barren` starts in a row have found nothing new.
    pub(super) fn search(
        &mut self,
        requested: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        most: usize,
        barren: usize,
    ) -> Option<Unreachable> {
        let goal = Requested::new(arm_from_flange);
        let home = self.chain_positions(&self.home);
        let aim = Aim {
            goal: &goal,
            home: &home,
        };
        if self.follow(requested, &aim, most) {
            return None;
        }
        self.aim_at(&goal);
        let starts = self
            .starts
            .take()
            .unwrap_or_else(|| Starts::within(&self.ranges()));
        let start = |k: usize, theta: &mut [f64]| starts.point(k + 1, theta);
        let mut theta = home.clone();
        let mut missed: Option<Unreachable> = None;
        let mut idle = 0;
        for k in 0..MOST_STARTS {
            if idle == barren || self.found.len() == PLENTY {
                break;
            }
            idle += 1;
            match self.descend(&aim, [k, MOST_STARTS], start, &mut theta) {
                Ok(reached) if self.is_found(reached, &theta) => {}
                Ok(_) => match self.keep_new(requested, &theta) {
                    Ok(()) => idle = 0,
                    Err(miss) => missed = Some(nearer(missed, miss)),
                },
                Err(miss) => missed = Some(nearer(missed, miss)),
            }
        }
        self.starts = Some(starts);
        self.order(requested.near, most);
        missed
    }

    /// Takes those postures of the previous pose that have a continuation here; false if none has.
    fn follow(&mut self, requested: &InverseTarget<'_>, aim: &Aim<'_>, most: usize) -> bool {
        if self.before.is_empty() || self.before.len() > most {
            return false;
        }
        self.aim_at(aim.goal);
        let before = std::mem::take(&mut self.before);
        let start = |k: usize, theta: &mut [f64]| theta.copy_from_slice(&before[k]);
        for (k, from) in before.iter().enumerate() {
            let mut theta = from.clone();
            let reached = self.descend(aim, [k, before.len()], start, &mut theta);
            let away = theta.iter().zip(from).map(|(a, b)| (a - b).abs());
            if reached.is_ok_and(|reached| !self.is_found(reached, &theta))
                && away.fold(0.0, f64::max) < JUMP
                && self.keep_new(requested, &theta).is_ok()
            {
                self.before.push(theta);
            }
        }
        !self.before.is_empty()
    }

    /// Prepares the descents to another pose.
    fn aim_at(&mut self, goal: &Requested) {
        let chain = self.arm.chain;
        if chain.links().len() <= ENOUGH {
            self.descents
                .get_or_insert_with(|| Descents::new(chain))
                .aim_at(chain, goal);
        }
    }

    /// The descent from start `k` of `count`; `start` fills the chain positions of one.
    fn descend(
        &mut self,
        aim: &Aim<'_>,
        [k, count]: [usize; 2],
        start: impl Fn(usize, &mut [f64]),
        theta: &mut [f64],
    ) -> Result<Reached, Unreachable> {
        let chain = self.arm.chain;
        match &mut self.descents {
            Some(descents) => descents.from(chain, [k, count], start, theta),
            None => {
                start(k, theta);
                let reached = self.descent().0.reach_near(chain, aim.goal, aim.home, theta);
                reached.map(|()| Reached::Pose)
            }
        }
    }

    fn is_found(&self, reached: Reached, theta: &[f64]) -> bool {
        reached == Reached::Known || self.is_known(theta, self.same())
    }

    /// Stores a posture, to which further descents end early.
    fn keep_new(&mut self, requested: &InverseTarget<'_>, theta: &[f64]) -> Result<(), Unreachable> {
        self.keep_searched(requested, theta)?;
        if let Some(descents) = &mut self.descents {
            descents.know(theta);
        }
        Ok(())
    }

    fn same(&self) -> f64 {
        if self.arm.chain.links().len() > ENOUGH {
            SAME_REDUNDANT
        } else {
            SAME
        }
    }

    /// Ranges of the chain positions of the arm; one turn for joints without limits.
    pub(super) fn ranges(&self) -> Vec<[f64; 2]> {
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
