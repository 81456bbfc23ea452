//! Postures of closed forms without named branches: spherical wrists, also with one redundant joint fixed.
//!
//! The postures of a closed form are converted and verified eight at once, in `eight`. Damped least squares refine
//! those of a calibrated arm, and those that forward kinematics does not confirm.

use std::f64::consts::PI;

use super::super::super::posture::{PostureName, Sides, Singularity};
use super::super::super::unreachable::Unreachable;
use super::super::fixed_joint::FixedJoint;
use super::super::lines::sense_of;
use super::super::spherical_wrist::SphericalWrist;
use super::super::verify::Requested;
use super::positions::ChainPositions;
use super::six_joints::SixJoints;
use super::{Finder, InverseSolution, InverseTarget, SAME};
use crate::frame::Isometry;
use crate::numbers::{Eight, Lanes};

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
        let kept = requested.near.map(|q| self.six_chain_positions(q));
        let mut all = form.chain_positions(arm_from_flange, kept.as_ref());
        if !form.is_exact() {
            all.retain_mut(|theta| self.is_refined(arm_from_flange, None, theta));
        }
        self.take_each(requested, arm_from_flange, None, &all);
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
        if !self.is_inside_at(&target, 0.0) && !self.leave_home(&target) {
            self.is_inside_at(&target, 0.0);
        }
        self.ordered_or_searched(requested, arm_from_flange, most)
    }

    /// Finds the postures with the fixed joint this far (rad) from home, and whether one of them is within the limits.
    fn is_inside_at(&mut self, target: &FixedJointTarget<'_>, away: f64) -> bool {
        self.discard();
        let index = self.arm.first + target.fixed.joint;
        let joint = &self.robot.joints()[index];
        let angle = self.robot.theta(index, &self.home) + joint.sign.factor() * away;
        // A joint coupled to earlier ones follows them.
        let alone = joint.coupling.is_empty();
        self.fixed = alone.then_some((index, self.home[index] + away));
        if away != 0.0 || !self.take_regular(target, angle) {
            self.take_general(target, angle, away == 0.0);
        }
        self.fixed = None;
        self.found.iter().any(|found| {
            let margin = self.robot.limit_margin(&found.joints);
            margin.is_none_or(|(_, margin)| margin >= 0.0)
        })
    }

    /// The other joints with the fixed one at home, where it has this chain position (rad).
    fn six_at_home(&mut self, fixed: &FixedJoint, angle: f64) -> Option<&SixJoints> {
        let same = self.at_home.take().filter(|(at, _)| *at == angle);
        let (_, six) = self
            .at_home
            .insert(same.unwrap_or_else(|| (angle, SixJoints::of(fixed, angle))));
        six.as_ref()
    }

    /// Takes the postures with the fixed joint at home, at the chain position `angle` (rad), where the other joints are
    /// an ortho-parallel arm away from its singularities; false, and none, elsewhere.
    fn take_regular(&mut self, target: &FixedJointTarget<'_>, angle: f64) -> bool {
        let six = self.six_at_home(target.fixed, angle);
        let Some((theta, reached)) = six.and_then(|six| six.regular(target.arm_from_flange)) else {
            return false;
        };
        if reached.contains(&true) {
            let dependent = self.find_eight(target.requested, &target.fixed.with(Lanes([angle; 8]), &theta));
            for lane in (0..8).filter(|lane| reached[*lane]) {
                if self.eight.verify(lane).is_err() {
                    self.discard();
                    return false;
                }
                // Away from singularities no two postures are one.
                self.push(lane, dependent[lane]);
            }
        }
        true
    }

    /// Takes the postures with the fixed joint at the chain position `angle` (rad), wherever they are.
    fn take_general(&mut self, target: &FixedJointTarget<'_>, angle: f64, at_home: bool) {
        let near = target.requested.near.map(|q| self.chain_positions(q));
        let kept = near.and_then(|theta| target.fixed.without(&theta));
        let solve = |form: &SphericalWrist| form.chain_positions(target.arm_from_flange, kept.as_ref());
        let six = if at_home {
            self.six_at_home(target.fixed, angle).map(|six| solve(&six.wrist))
        } else {
            target.fixed.at(angle).as_ref().map(solve)
        };
        let six = six.unwrap_or_default();
        let still = Some(target.fixed.joint);
        let mut all: Vec<[f64; 7]> = six.iter().map(|six| target.fixed.with(angle, six)).collect();
        if !target.fixed.is_exact() {
            all.retain_mut(|theta| self.is_refined(target.arm_from_flange, still, theta));
        }
        self.take_each(target.requested, target.arm_from_flange, still, &all);
    }

    /// Moves the fixed joint from home, first to the side where it was before, until a posture is within the limits:
    /// finds the postures there. False where there is no such position.
    fn leave_home(&mut self, target: &FixedJointTarget<'_>) -> bool {
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
                if self.is_inside_at(target, side * to) {
                    self.find_first_inside(target, [side * from, side * to]);
                    return true;
                }
            }
            from += STEP;
        }
        false
    }

    /// Between a position of the fixed joint without and one with a posture within the limits: finds the postures at
    /// the first one with.
    fn find_first_inside(&mut self, target: &FixedJointTarget<'_>, [mut without, mut with]: [f64; 2]) {
        let mut are_those_with = true;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (without + with);
            are_those_with = self.is_inside_at(target, middle);
            if are_those_with {
                with = middle;
            } else {
                without = middle;
            }
        }
        if !are_those_with {
            self.is_inside_at(target, with);
        }
    }

    /// Refines chain positions of the arm, with joint `still` fixed if there is one; whether they reach.
    fn is_refined(&mut self, arm_from_flange: &Isometry, still: Option<usize>, theta: &mut [f64]) -> bool {
        let goal = Requested::new(arm_from_flange);
        let (descent, chain) = self.descent();
        let reached = match still {
            Some(still) => descent.reach_with_fixed(chain, &goal, still, theta),
            None => descent.reach(chain, &goal, theta),
        };
        reached.is_ok()
    }

    /// Stores the postures at these chain positions that are new, eight at once; those that forward kinematics does not
    /// confirm are refined, with joint `still` fixed if there is one, or dropped.
    fn take_each<const N: usize>(
        &mut self,
        requested: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        still: Option<usize>,
        all: &[[f64; N]],
    ) {
        for some in all.chunks(8) {
            let mut theta = [Eight::default(); N];
            for (lane, own) in some.iter().enumerate() {
                for (theta, own) in theta.iter_mut().zip(own) {
                    theta.0[lane] = *own;
                }
            }
            let dependent = self.find_eight(requested, &theta);
            for (lane, own) in some.iter().enumerate() {
                let verified = self.eight.verify(lane).is_ok();
                let mut own = *own;
                if !verified && !self.is_refined(arm_from_flange, still, &mut own)
                    || self.is_known(&own, SAME)
                {
                    continue;
                }
                if verified {
                    self.push(lane, dependent[lane]);
                } else {
                    self.keep_searched(requested, &own).ok();
                }
            }
        }
        if self.lanes.len() != self.found.len() {
            self.lanes.clear();
        }
    }

    /// Computes eight postures from their chain positions, and whether their joints are nearly dependent.
    fn find_eight(&mut self, requested: &InverseTarget<'_>, theta: &[Eight]) -> [bool; 8] {
        self.lanes.clear();
        let from = ChainPositions {
            theta,
            rail: &self.home[..self.arm.first],
            near: requested.near,
            fixed: self.fixed,
        };
        let flange = Requested::new(&requested.base_from_flange);
        self.eight.find(self.robot, &from, &flange);
        self.eight.dependent(theta.len())
    }

    /// Stores posture `lane` of the eight.
    fn push(&mut self, lane: usize, dependent: bool) {
        let joints = self.joints_of(lane, self.arm.chain.links().len());
        self.lanes.push(lane);
        self.found.push(InverseSolution {
            name: PostureName::Sides(Sides::of(&joints, &self.middles)),
            joints,
            singularity: dependent.then_some(Singularity::Dependent),
        });
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
        self.sort(requested.near, most);
        None
    }
}

#[cfg(test)]
mod tests;
