//! Postures of closed forms whose branches have no names: spherical wrists, also where one joint to spare stands still.

use std::f64::consts::PI;

use super::super::super::posture::Unreachable;
use super::super::descent::Goal;
use super::super::lines::sense_of;
use super::super::spherical_wrist::SphericalWrist;
use super::super::standing_joint::StandingJoint;
use super::search::{SAME, SHORT};
use super::{Finder, Found, Wanted};
use crate::frame::Isometry;

/// Steps (rad) by which a joint leaves home where no posture lies inside the limits with it there: 5 deg.
const STEP: f64 = PI / 36.0;
/// Halvings of the last step: the joint then stands within 1e-5 rad of the first place that does.
const HALVINGS: u32 = 13;

impl Finder<'_> {
    /// The postures of an arm with a spherical wrist.
    pub(super) fn with_wrist(
        &mut self,
        form: &SphericalWrist,
        wanted: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        let near = wanted.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| theta.try_into().ok());
        let goal = Goal::new(arm_from_flange);
        for mut theta in form.chain_positions(arm_from_flange, kept.as_ref()) {
            if self.descent.reach(self.arm.chain, &goal, &mut theta).is_ok() {
                self.take(wanted, &theta);
            }
        }
        self.ordered_or_searched(wanted, arm_from_flange, most)
    }

    /// The postures of an arm with a joint to spare that stands still: at home, or as near to it as any posture lies
    /// inside the limits.
    pub(super) fn with_one_standing(
        &mut self,
        standing: &StandingJoint,
        wanted: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        self.stand(standing, 0.0, wanted, arm_from_flange);
        if !self.any_within_limits() {
            let at_home = std::mem::take(&mut self.found);
            if !self.leave_home(standing, wanted, arm_from_flange) {
                self.found = at_home;
            }
        }
        self.ordered_or_searched(wanted, arm_from_flange, most)
    }

    /// Finds the postures with the standing joint so far (rad) from home, in place of those found before.
    fn stand(
        &mut self,
        standing: &StandingJoint,
        away: f64,
        wanted: &Wanted<'_>,
        arm_from_flange: &Isometry,
    ) {
        self.found.clear();
        let joint = self.arm.first + standing.joint;
        let sense = self.robot.joints()[joint].sign.factor();
        let angle = self.robot.theta(joint, &self.home) + sense * away;
        // A joint that counts earlier ones along stands where they leave it.
        let alone = self.robot.joints()[joint].coupling.is_empty();
        self.stands = alone.then(|| (joint, self.home[joint] + away));
        let near = wanted.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| standing.without(&theta));
        let goal = Goal::new(arm_from_flange);
        let form = standing.at(angle);
        let found = form.map(|form| form.chain_positions(arm_from_flange, kept.as_ref()));
        for six in found.unwrap_or_default() {
            let mut theta = standing.with(angle, &six);
            let reached = self
                .descent
                .reach_beside(self.arm.chain, &goal, standing.joint, &mut theta);
            if reached.is_ok() {
                self.take(wanted, &theta);
            }
        }
        self.stands = None;
    }

    /// Moves the standing joint from home, to the side where it stood first, until a posture lies inside the limits;
    /// false if none does.
    fn leave_home(
        &mut self,
        standing: &StandingJoint,
        wanted: &Wanted<'_>,
        arm_from_flange: &Isometry,
    ) -> bool {
        let joint = self.arm.first + standing.joint;
        let home = self.home[joint];
        let room = |side: f64| {
            let limits = self.robot.joints()[joint].limits;
            limits.map_or(PI, |limits| {
                if side > 0.0 {
                    limits.upper - home
                } else {
                    home - limits.lower
                }
                .min(PI)
            })
        };
        let first = sense_of(wanted.near.map_or(0.0, |near| near[joint] - home));
        let sides = [first, -first].map(|side| (side, room(side)));
        let mut from = 0.0;
        while from < PI {
            for (side, room) in sides.into_iter().filter(|(_, room)| from < *room) {
                let mut to = (from + STEP).min(room);
                self.stand(standing, side * to, wanted, arm_from_flange);
                if self.any_within_limits() {
                    let mut outside = from;
                    for _ in 0..HALVINGS {
                        let middle = 0.5 * (outside + to);
                        let found = std::mem::take(&mut self.found);
                        self.stand(standing, side * middle, wanted, arm_from_flange);
                        if self.any_within_limits() {
                            to = middle;
                        } else {
                            outside = middle;
                            self.found = found;
                        }
                    }
                    return true;
                }
            }
            from += STEP;
        }
        false
    }

    fn any_within_limits(&self) -> bool {
        let within = |found: &Found| {
            let margin = self.robot.limit_margin(&found.joints);
            margin.is_none_or(|(_, margin)| margin >= 0.0)
        };
        self.found.iter().any(within)
    }

    /// Keeps a posture that is new.
    fn take(&mut self, wanted: &Wanted<'_>, theta: &[f64]) {
        if !self.is_known(theta, SAME) {
            // One that forward kinematics does not confirm is none.
            self.keep_searched(wanted, theta).ok();
        }
    }

    /// The nearest first; where there is none, what a short search finds.
    fn ordered_or_searched(
        &mut self,
        wanted: &Wanted<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        if self.found.is_empty() {
            return self.search(wanted, arm_from_flange, most, SHORT);
        }
        self.order(wanted.near, most);
        None
    }
}
