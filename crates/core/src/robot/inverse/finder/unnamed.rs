//! Postures of closed forms whose branches have no names: spherical wrists, also where one joint to spare stands still.

use std::f64::consts::PI;

use super::super::super::unreachable::Unreachable;
use super::super::descent::Goal;
use super::super::lines::sense_of;
use super::super::spherical_wrist::SphericalWrist;
use super::super::fixed_joint::FixedJoint;
use super::search::{SAME, SHORT};
use super::{Finder, Wanted};
use crate::frame::Isometry;

/// Steps (rad) by which a joint leaves home where no posture lies inside the limits with it there: 5 deg.
const STEP: f64 = PI / 36.0;
/// Halvings of the last step: the joint then stands within 1e-5 rad of the first place that does.
const HALVINGS: u32 = 13;

/// What a standing joint is asked.
struct Held<'a> {
    arm_state: &'a FixedJoint,
    requested: &'a Wanted<'a>,
    arm_from_flange: &'a Isometry,
}

impl Finder<'_> {
    /// The postures of an arm with a spherical wrist.
    pub(super) fn with_wrist(
        &mut self,
        form: &SphericalWrist,
        requested: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        let near = requested.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| theta.try_into().ok());
        let goal = Goal::new(arm_from_flange);
        for mut theta in form.chain_positions(arm_from_flange, kept.as_ref()) {
            if self.descent.reach(self.arm.chain, &goal, &mut theta).is_ok() {
                self.take(requested, &theta);
            }
        }
        self.ordered_or_searched(requested, arm_from_flange, most)
    }

    /// The postures of an arm with a joint to spare that stands still: at home, or as near to it as any posture lies
    /// inside the limits.
    pub(super) fn with_one_arm_state(
        &mut self,
        arm_state: &FixedJoint,
        requested: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        let evaluation = Held {
            arm_state,
            requested,
            arm_from_flange,
        };
        let at_home = self.arm_state_at(&evaluation, 0.0);
        let (away, all) = if self.any_inside(&evaluation, 0.0, &at_home) {
            (0.0, at_home)
        } else {
            self.leave_home(&evaluation).unwrap_or((0.0, at_home))
        };
        self.stands = self.place(&evaluation, away);
        for theta in all {
            self.take(requested, &theta);
        }
        self.stands = None;
        self.ordered_or_searched(requested, arm_from_flange, most)
    }

    /// Chain positions with the standing joint so far (rad) from home.
    fn arm_state_at(&mut self, evaluation: &Held<'_>, away: f64) -> Vec<[f64; 7]> {
        let joint = self.arm.first + evaluation.arm_state.joint;
        let sense = self.robot.joints()[joint].sign.factor();
        let angle = self.robot.theta(joint, &self.home) + sense * away;
        let Some(form) = evaluation.arm_state.at(angle) else {
            return Vec::new();
        };
        let near = evaluation.requested.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| evaluation.arm_state.without(&theta));
        let goal = Goal::new(evaluation.arm_from_flange);
        let six = form.chain_positions(evaluation.arm_from_flange, kept.as_ref());
        let mut all: Vec<[f64; 7]> = six.iter().map(|six| evaluation.arm_state.with(angle, six)).collect();
        all.retain_mut(|theta| {
            let reached = self
                .descent
                .reach_beside(self.arm.chain, &goal, evaluation.arm_state.joint, theta);
            reached.is_ok()
        });
        all
    }

    /// The count of the standing joint so far (rad) from home; one that counts earlier joints along stands where they
    /// leave it.
    fn place(&self, evaluation: &Held<'_>, away: f64) -> Option<(usize, f64)> {
        let joint = self.arm.first + evaluation.arm_state.joint;
        let alone = self.robot.joints()[joint].coupling.is_empty();
        alone.then(|| (joint, self.home[joint] + away))
    }

    /// Moves the standing joint from home, to the side where it stood first, until a posture lies inside the limits:
    /// how far (rad), and the chain positions there.
    fn leave_home(&mut self, evaluation: &Held<'_>) -> Option<(f64, Vec<[f64; 7]>)> {
        let joint = self.arm.first + evaluation.arm_state.joint;
        let (home, limits) = (self.home[joint], self.robot.joints()[joint].limits);
        let first = sense_of(evaluation.requested.near.map_or(0.0, |near| near[joint] - home));
        let sides = [first, -first].map(|side| {
            let room = limits.map_or(PI, |limits| {
                if side > 0.0 {
                    limits.upper - home
                } else {
                    home - limits.lower
                }
            });
            (side, room.min(PI))
        });
        let mut from = 0.0;
        while from < PI {
            for (side, room) in sides.into_iter().filter(|(_, room)| from < *room) {
                let to = (from + STEP).min(room);
                let all = self.arm_state_at(evaluation, side * to);
                if self.any_inside(evaluation, side * to, &all) {
                    return Some(self.first_inside(evaluation, [side * from, side * to], all));
                }
            }
            from += STEP;
        }
        None
    }

    /// Between a place of the standing joint without and one with a posture inside the limits the first with one.
    fn first_inside(
        &mut self,
        evaluation: &Held<'_>,
        [mut without, mut with]: [f64; 2],
        mut all: Vec<[f64; 7]>,
    ) -> (f64, Vec<[f64; 7]>) {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (without + with);
            let found = self.arm_state_at(evaluation, middle);
            if self.any_inside(evaluation, middle, &found) {
                (with, all) = (middle, found);
            } else {
                without = middle;
            }
        }
        (with, all)
    }

    /// Whether one of these chain positions lies inside the joint limits, with the standing joint so far from home.
    fn any_inside(&mut self, evaluation: &Held<'_>, away: f64, all: &[[f64; 7]]) -> bool {
        self.stands = self.place(evaluation, away);
        let inside = all.iter().any(|theta| {
            let joints = self.counted(theta, evaluation.requested.near);
            let margin = self.robot.limit_margin(&joints);
            margin.is_none_or(|(_, margin)| margin >= 0.0)
        });
        self.stands = None;
        inside
    }

    /// Keeps a posture that is new.
    fn take(&mut self, requested: &Wanted<'_>, theta: &[f64]) {
        if !self.is_known(theta, SAME) {
            // One that forward kinematics does not confirm is none.
            self.keep_searched(requested, theta).ok();
        }
    }

    /// The nearest first; where there is none, what a short search finds.
    fn ordered_or_searched(
        &mut self,
        requested: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        if self.found.is_empty() {
            return self.search(requested, arm_from_flange, most, SHORT);
        }
        self.order(requested.near, most);
        None
    }
}
