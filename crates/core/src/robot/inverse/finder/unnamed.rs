//! Postures of closed forms without named branches: spherical wrists, also with one redundant joint fixed.

use std::f64::consts::PI;

use super::super::super::unreachable::Unreachable;
use super::super::fixed_joint::FixedJoint;
use super::super::lines::sense_of;
use super::super::spherical_wrist::SphericalWrist;
use super::super::verify::Requested;
use super::{Finder, InverseTarget, SAME};
use crate::frame::Isometry;

/// Steps (rad) by which the fixed joint leaves home where no posture is within the limits there: 5 deg.
const STEP: f64 = PI / 36.0;
/// Halvings of the last step: the joint is then within 1e-5 rad of the first valid position.
const HALVINGS: u32 = 13;
/// Starts without a new posture that end a search after a closed form.
const SHORT: usize = 8;

/// A pose for an arm with one fixed joint.
struct FixedJointTarget<'a> {
    fixed: &'a FixedJoint,
    requested: &'a InverseTarget<'a>,
    arm_from_flange: &'a Isometry,
}

impl Finder<'_> {
    /// The postures of an arm with a spherical wrist.
    pub(super) fn with_wrist(
        &mut self,
        form: &SphericalWrist,
        requested: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        let near = requested.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| theta.try_into().ok());
        let goal = Requested::new(arm_from_flange);
        for mut theta in form.chain_positions(arm_from_flange, kept.as_ref()) {
            let (descent, chain) = self.descent();
            if descent.reach(chain, &goal, &mut theta).is_ok() {
                self.take(requested, &theta);
            }
        }
        self.ordered_or_searched(requested, arm_from_flange, most)
    }

    /// The postures of an arm with one redundant joint fixed: at home, or at the position nearest to it with a posture
    /// within the limits.
    pub(super) fn with_fixed_joint(
        &mut self,
        fixed: &FixedJoint,
        requested: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        most: usize,
    ) -> Option<Unreachable> {
        let target = FixedJointTarget {
            fixed,
            requested,
            arm_from_flange,
        };
        let at_home = self.positions_at(&target, 0.0);
        let (away, all) = if self.any_inside(&target, 0.0, &at_home) {
            (0.0, at_home)
        } else {
            self.leave_home(&target).unwrap_or((0.0, at_home))
        };
        self.fixed = self.place(&target, away);
        for theta in all {
            self.take(requested, &theta);
        }
        self.fixed = None;
        self.ordered_or_searched(requested, arm_from_flange, most)
    }

    /// Chain positions with the fixed joint this far (rad) from home.
    fn positions_at(&mut self, target: &FixedJointTarget<'_>, away: f64) -> Vec<[f64; 7]> {
        let joint = self.arm.first + target.fixed.joint;
        let sense = self.robot.joints()[joint].sign.factor();
        let angle = self.robot.theta(joint, &self.home) + sense * away;
        let Some(form) = target.fixed.at(angle) else {
            return Vec::new();
        };
        let near = target.requested.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| target.fixed.without(&theta));
        let goal = Requested::new(target.arm_from_flange);
        let six = form.chain_positions(target.arm_from_flange, kept.as_ref());
        let mut all: Vec<[f64; 7]> = six.iter().map(|six| target.fixed.with(angle, six)).collect();
        let (descent, chain) = self.descent();
        all.retain_mut(|theta| {
            descent
                .reach_with_fixed(chain, &goal, target.fixed.joint, theta)
                .is_ok()
        });
        all
    }

    /// The joint position of the fixed joint this far (rad) from home; a joint coupled to earlier ones follows them.
    fn place(&self, target: &FixedJointTarget<'_>, away: f64) -> Option<(usize, f64)> {
        let joint = self.arm.first + target.fixed.joint;
        let alone = self.robot.joints()[joint].coupling.is_empty();
        alone.then(|| (joint, self.home[joint] + away))
    }

    /// Moves the fixed joint from home, first to the side where it was before, until a posture is within the limits:
    /// its distance (rad), and the chain positions there.
    fn leave_home(&mut self, target: &FixedJointTarget<'_>) -> Option<(f64, Vec<[f64; 7]>)> {
        let joint = self.arm.first + target.fixed.joint;
        let (home, limits) = (self.home[joint], self.robot.joints()[joint].limits);
        let first = sense_of(target.requested.near.map_or(0.0, |near| near[joint] - home));
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
                let all = self.positions_at(target, side * to);
                if self.any_inside(target, side * to, &all) {
                    return Some(self.first_inside(target, [side * from, side * to], all));
                }
            }
            from += STEP;
        }
        None
    }

    /// Between a position of the fixed joint without and one with a posture within the limits: the first one with.
    fn first_inside(
        &mut self,
        target: &FixedJointTarget<'_>,
        [mut without, mut with]: [f64; 2],
        mut all: Vec<[f64; 7]>,
    ) -> (f64, Vec<[f64; 7]>) {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (without + with);
            let found = self.positions_at(target, middle);
            if self.any_inside(target, middle, &found) {
                (with, all) = (middle, found);
            } else {
                without = middle;
            }
        }
        (with, all)
    }

    /// Whether one of these chain positions is within the joint limits, with the fixed joint this far from home.
    fn any_inside(&mut self, target: &FixedJointTarget<'_>, away: f64, all: &[[f64; 7]]) -> bool {
        self.fixed = self.place(target, away);
        let inside = all.iter().any(|theta| {
            let joints = self.joint_positions(theta, target.requested.near);
            let margin = self.robot.limit_margin(&joints);
            margin.is_none_or(|(_, margin)| margin >= 0.0)
        });
        self.fixed = None;
        inside
    }

    /// Stores a posture that is new.
    fn take(&mut self, requested: &InverseTarget<'_>, theta: &[f64]) {
        if !self.is_known(theta, SAME) {
            // A posture that forward kinematics does not confirm is dropped.
            self.keep_searched(requested, theta).ok();
        }
    }

    /// The nearest first; where there is none, what a short search finds.
    fn ordered_or_searched(
        &mut self,
        requested: &InverseTarget<'_>,
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
