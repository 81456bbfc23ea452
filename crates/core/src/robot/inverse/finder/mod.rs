//! The postures of one robot at one pose after the other, with reused memory.
//!
//! Closed forms give the eight branches at once, verified in `eight`; a calibrated arm takes them as starts; those
//! without names for their branches are in `unnamed` (`six_joints` of a redundant arm), their singularities in
//! `dependence`, their order in `order`. Other chains are searched from starts spread over the ranges of their joints,
//! or from the postures of the pose before, in `search`. Those of an arm that holds
//! the part are in `in_hand`. All work in chain positions; `positions` converts them to
//! joint positions.

mod dependence;
mod eight;
mod in_hand;
mod order;
mod positions;
mod search;
mod six_joints;
mod unnamed;

use std::f64::consts::TAU;

use nalgebra::Point3;

use super::super::branch::{Branch, BranchPattern};
use super::super::chain::{Chain, Motion};
use super::super::forward::{Frames, forward_into, tool_at};
use super::super::hand::in_opposite_order;
use super::super::jacobian::screws_at;
use super::super::model::Robot;
use super::super::posture::{Posture, PostureName, Sides, Singularity};
use super::super::unreachable::Unreachable;
use super::closed_form::ClosedForm;
use super::descent::Descent;
use super::descents::Descents;
use super::kind::{Inverse, end_of};
use super::starts::Starts;
use super::verify::{Requested, verify};
use crate::frame::Isometry;
use eight::EightPostures;
use positions::ChainPositions;
pub(crate) use positions::WholeTurns;
use six_joints::SixJoints;

/// Maximum number of postures of one pose: a general arm of six revolute joints has up to 16.
const MOST: usize = 16;
/// Starts without a new posture that end a search.
const THOROUGH: usize = 48;
/// Two postures nearer than this (rad, m) are one.
const SAME: f64 = 1e-4;

/// The requested flange pose, with the joint positions before it and at home.
#[derive(Clone, Copy, Debug)]
pub struct InverseTarget<'a> {
    /// The flange, in base.
    pub base_from_flange: Isometry,
    /// Joint positions of the point before, if there is one.
    pub near: Option<&'a [f64]>,
    /// Joint positions at which a rail or a fixed redundant joint is kept, and to which other redundant joints are
    /// pulled; by default the middle of their ranges, or zero where they have none.
    pub home: Option<&'a [f64]>,
}

/// A posture of the requested flange pose.
#[derive(Clone, Debug)]
pub struct InverseSolution {
    /// Its name.
    pub name: PostureName,
    /// Joint positions `q`, rad (m).
    pub joints: Vec<f64>,
    /// The singularity that it is near, if any.
    pub singularity: Option<Singularity>,
}

/// A posture with its distance, and its lane if it has one.
type Distant = (f64, Option<usize>, InverseSolution);

/// Finds postures; one per thread.
#[derive(Debug)]
pub struct Finder<'r> {
    robot: &'r Robot,
    arm: Arm<'r>,
    frames: Frames,
    /// Set by the first descent.
    descent: Option<Descent>,
    /// Set by the first search of a chain without redundant joints.
    descents: Option<Descents>,
    /// Set by the first search.
    starts: Option<Starts>,
    eight: EightPostures,
    found: Vec<InverseSolution>,
    /// Of each posture found its lane of `eight`; empty where they are not lanes of it.
    lanes: Vec<usize>,
    /// Memory for joint and chain positions.
    spare: Vec<Vec<f64>>,
    /// Memory for the order of postures.
    ordered: Vec<Distant>,
    /// Of each posture found: chain positions of the arm, kept for the pose that follows.
    before: Vec<Vec<f64>>,
    /// Whether those of the postures sorted last are kept: a pose that is forgotten does not need them.
    is_remembered: bool,
    home: Vec<f64>,
    /// The middle of each joint's range.
    middles: Vec<f64>,
    /// The fixed joint, and its position.
    fixed: Option<(usize, f64)>,
    /// The other six joints with the fixed one at home, and its chain position there.
    at_home: Option<(f64, Option<SixJoints>)>,
    /// Finds the postures of the arm that holds the part, if there is one.
    holding: Option<Box<Finder<'r>>>,
}

/// The chain of the inverse: the robot's own, or that of the arm on its rail.
#[derive(Clone, Copy, Debug)]
struct Arm<'r> {
    chain: &'r Chain,
    inverse: &'r Inverse,
    rail: &'r [Motion],
    /// Index of its first joint.
    first: usize,
}

impl<'r> Arm<'r> {
    fn of(robot: &'r Robot) -> Arm<'r> {
        match robot.inverse() {
            Inverse::OnRail(rail) => Arm {
                chain: &rail.chain,
                inverse: &rail.inverse,
                rail: &rail.motions,
                first: rail.joints,
            },
            inverse => Arm {
                chain: robot.chain(),
                inverse,
                rail: &[],
                first: 0,
            },
        }
    }
}

impl<'r> Finder<'r> {
    /// Working memory for the postures of `robot`.
    pub fn new(robot: &'r Robot) -> Finder<'r> {
        let arm = Arm::of(robot);
        Finder {
            robot,
            arm,
            frames: Frames::for_robot(robot),
            descent: None,
            descents: None,
            starts: None,
            eight: EightPostures::new(arm.first, arm.chain.length()),
            found: Vec::with_capacity(8),
            lanes: Vec::with_capacity(8),
            spare: Vec::new(),
            ordered: Vec::new(),
            before: Vec::new(),
            is_remembered: true,
            home: vec![0.0; robot.joints().len()],
            middles: robot.middles(),
            fixed: None,
            at_home: None,
            holding: robot.hand().map(|hand| Box::new(Finder::new(&hand.arm))),
        }
    }

    /// Forgets the postures of the previous pose: the next search starts without them.
    pub fn forget(&mut self) {
        self.spare.append(&mut self.before);
        self.is_remembered = true;
        self.holding.iter_mut().for_each(|holding| holding.forget());
    }

    /// Every posture; of a searched chain those that are found. Those without names come nearest to `near` first, or to
    /// the posture before, or to `home`.
    ///
    /// # Errors
    /// The reason of the branch that misses by least, or how near a search came.
    pub fn all(&mut self, expected: &InverseTarget<'_>) -> Result<&[InverseSolution], Unreachable> {
        self.find(expected, BranchPattern::default(), MOST)
    }

    /// The postures whose branch matches; of a chain without named branches the one nearest to `near`, or to the
    /// posture before, or to `home`.
    ///
    /// # Errors
    /// Those of [`Finder::all`].
    pub fn matching(
        &mut self,
        expected: &InverseTarget<'_>,
        pattern: BranchPattern,
    ) -> Result<&[InverseSolution], Unreachable> {
        self.find(expected, pattern, 1)
    }

    fn find(
        &mut self,
        expected: &InverseTarget<'_>,
        pattern: BranchPattern,
        most: usize,
    ) -> Result<&[InverseSolution], Unreachable> {
        if self.holding.is_some() {
            return self.in_hand(expected, pattern, most);
        }
        self.remember();
        self.discard();
        self.settle_home(expected);
        let arm_from_flange = self.base_from_arm().inv_mul(&expected.base_from_flange);
        let missed = match self.arm.inverse {
            Inverse::Closed(form) => self.branches(form, expected, &arm_from_flange, pattern),
            Inverse::Polished(form) => self.polished(form, expected, &arm_from_flange, pattern),
            Inverse::SphericalWrist(form) => self.with_wrist(form, expected, &arm_from_flange, most),
            Inverse::OneFixed(fixed) => self.with_fixed_joint(fixed, expected, &arm_from_flange, most),
            Inverse::Searched | Inverse::OnRail(_) | Inverse::InHand(_) => {
                self.search(expected, &arm_from_flange, most, THOROUGH)
            }
        };
        if self.found.is_empty() {
            return Err(missed.unwrap_or(Unreachable::OtherBranch));
        }
        Ok(&self.found)
    }

    /// Removes the postures found.
    fn discard(&mut self) {
        self.spare.extend(self.found.drain(..).map(|found| found.joints));
        self.lanes.clear();
    }

    /// Sets every joint of home.
    fn settle_home(&mut self, expected: &InverseTarget<'_>) {
        match expected.home.or(self.robot.rest()) {
            Some(home) => self.home.copy_from_slice(home),
            None => self.home.copy_from_slice(&self.middles),
        }
    }

    /// Frame of the rail's end.
    fn base_from_arm(&self) -> Isometry {
        end_of(self.arm.rail, |joint| self.robot.theta(joint, &self.home))
    }

    /// Chain positions of the arm for joint positions of the robot.
    fn chain_positions(&self, q: &[f64]) -> Vec<f64> {
        (self.arm.first..q.len())
            .map(|i| self.robot.theta(i, q))
            .collect()
    }

    /// [`Finder::chain_positions`] of an arm with six joints.
    fn six_chain_positions(&self, q: &[f64]) -> [f64; 6] {
        std::array::from_fn(|i| self.robot.theta(self.arm.first + i, q))
    }

    /// All properties of the posture found at `index`, which is left without its joint positions; the screws are those
    /// at `tcp` (m, base).
    pub(super) fn take_posture(
        &mut self,
        index: usize,
        tcp: &Point3<f64>,
        flange_from_tool: &Isometry,
    ) -> Posture {
        self.remember();
        let found = &mut self.found[index];
        let (flange, screws) = match self.lanes.get(index) {
            Some(&lane) => {
                let forward = self.eight.forward();
                let screws = forward.screws(self.robot.chain(), lane, tcp);
                (forward.flange_of(lane), screws)
            }
            None => {
                forward_into(self.robot, &found.joints, &mut self.frames);
                let screws = screws_at(self.robot, &self.frames, tcp);
                (self.frames.base_from_flange, screws)
            }
        };
        Posture {
            name: found.name,
            joints: std::mem::take(&mut found.joints),
            base_from_tool: tool_at(&flange, flange_from_tool),
            screws,
            singularity: found.singularity,
        }
    }

    /// The branches of a closed form: all at once, one lane each.
    fn branches(
        &mut self,
        form: &ClosedForm,
        expected: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        pattern: BranchPattern,
    ) -> Option<Unreachable> {
        let near = expected.near.map(|q| self.six_chain_positions(q));
        let branches = form.eight_branches(arm_from_flange, pattern, near.as_ref());
        if branches.outcomes.iter().any(Result::is_ok) {
            let from = ChainPositions {
                theta: &branches.theta,
                rail: &self.home[..self.arm.first],
                near: expected.near,
                fixed: None,
            };
            self.eight
                .find(self.robot, &from, &Requested::new(&expected.base_from_flange));
        }
        let mut missed: Option<Unreachable> = None;
        for branch in Branch::ALL.into_iter().filter(|branch| pattern.matches(*branch)) {
            let lane = branch.index();
            let reached = branches.outcomes[lane];
            match reached.and_then(|singularity| self.eight.verify(lane).map(|()| singularity)) {
                Ok(singularity) => {
                    let joints = self.joints_of(lane, branches.theta.len());
                    self.lanes.push(lane);
                    self.found.push(InverseSolution {
                        name: PostureName::Branch(branch),
                        joints,
                        singularity,
                    });
                }
                Err(miss) => missed = Some(nearer(missed, miss)),
            }
        }
        missed
    }

    /// Joint positions of posture `lane`, of an arm with so many joints.
    fn joints_of(&mut self, lane: usize, joints: usize) -> Vec<f64> {
        let mut positions = self.spare.pop().unwrap_or_default();
        positions.clear();
        positions.extend_from_slice(&self.home[..self.arm.first]);
        positions.extend(self.eight.joints(joints, lane));
        positions
    }

    /// The branches of a calibrated arm, from those of the ideal one. The ideal arm also names them: near a straight
    /// posture a descent may end in another branch than that of its start.
    fn polished(
        &mut self,
        form: &ClosedForm,
        expected: &InverseTarget<'_>,
        arm_from_flange: &Isometry,
        pattern: BranchPattern,
    ) -> Option<Unreachable> {
        let near = expected.near.map(|q| self.six_chain_positions(q));
        let any = BranchPattern::default();
        let branches = form.eight_branches(arm_from_flange, any, near.as_ref());
        let goal = Requested::new(arm_from_flange);
        let mut missed: Option<Unreachable> = None;
        // Requested branches first: usually they make the others unnecessary.
        let (requested, others): (Vec<Branch>, Vec<Branch>) = Branch::ALL
            .into_iter()
            .partition(|branch| pattern.matches(*branch));
        let mut renamed = false;
        for branch in requested.iter().chain(&others) {
            if !pattern.matches(*branch) && !renamed {
                break;
            }
            let kept = branches.get(*branch).and_then(|(mut theta, _)| {
                let (descent, chain) = self.descent();
                descent.reach(chain, &goal, &mut theta)?;
                let (own, singularity) = form.name(&theta);
                renamed |= own != *branch;
                if self.is_known(&theta, SAME) {
                    return Ok(());
                }
                // Near a singularity the ideal arm may give two postures one name: the second keeps that of its start.
                let taken = self
                    .found
                    .iter()
                    .any(|found| found.name == PostureName::Branch(own));
                let name = if taken { *branch } else { own };
                self.keep(expected, &theta, PostureName::Branch(name), singularity)
            });
            if let Err(miss) = kept {
                missed = Some(nearer(missed, miss));
            }
        }
        if self.found.is_empty() && matches!(missed, Some(Unreachable::NotFound { .. })) {
            missed = self.search(expected, arm_from_flange, MOST, THOROUGH);
        }
        self.found
            .retain(|found| found.name.branch().is_some_and(|branch| pattern.matches(branch)));
        missed
    }

    /// The searches of the arm, and its chain.
    fn descent(&mut self) -> (&mut Descent, &'r Chain) {
        let chain = self.arm.chain;
        (self.descent.get_or_insert_with(|| Descent::new(chain)), chain)
    }

    /// Whether these chain positions, whole turns apart, have been found already.
    fn is_known(&self, theta: &[f64], same: f64) -> bool {
        let is = |found: &InverseSolution| {
            (0..theta.len()).all(|i| self.between(i, theta[i], &found.joints).abs() < same)
        };
        self.found.iter().any(is)
    }

    /// From the joint positions `q` to the chain position `theta` of joint `i` of the arm, the shorter way round.
    fn between(&self, i: usize, theta: f64, q: &[f64]) -> f64 {
        let joint = self.arm.first + i;
        let away = theta - self.robot.theta(joint, q);
        if self.robot.slides(joint) {
            away
        } else {
            away - TAU * (away / TAU).round()
        }
    }

    fn keep_searched(&mut self, expected: &InverseTarget<'_>, theta: &[f64]) -> Result<(), Unreachable> {
        let (name, singularity) = match self.arm.inverse.names() {
            Some(form) => {
                let (branch, singularity) = form.name(theta);
                (PostureName::Branch(branch), singularity)
            }
            None => {
                let (descent, chain) = self.descent();
                let dependent = descent.dependent(chain, theta);
                (
                    PostureName::Sides(Sides::default()),
                    dependent.then_some(Singularity::Dependent),
                )
            }
        };
        self.keep(expected, theta, name, singularity)
    }

    /// Converts a posture to joint positions, verifies it and stores it; sides are derived from the joint positions.
    fn keep(
        &mut self,
        expected: &InverseTarget<'_>,
        theta: &[f64],
        name: PostureName,
        singularity: Option<Singularity>,
    ) -> Result<(), Unreachable> {
        let joints = self.joint_positions(theta, expected.near);
        forward_into(self.robot, &joints, &mut self.frames);
        verify(&self.frames, &expected.base_from_flange)?;
        self.found.push(InverseSolution {
            name: match name {
                PostureName::Branch(_) => name,
                PostureName::Sides(_) => PostureName::Sides(Sides::of(&joints, &self.middles)),
            },
            joints,
            singularity,
        });
        Ok(())
    }

    /// Joint positions of the robot at chain positions of the arm, its rail at home.
    fn joint_positions(&mut self, theta: &[f64], near: Option<&[f64]>) -> Vec<f64> {
        let mut joints = self.spare.pop().unwrap_or_default();
        joints.clone_from(&self.home);
        for (i, theta) in theta.iter().enumerate() {
            let joint = self.arm.first + i;
            if let Some((_, place)) = self.fixed.filter(|(fixed, _)| *fixed == joint) {
                joints[joint] = place;
                continue;
            }
            let position = self.robot.joint_position(joint, *theta, &joints);
            joints[joint] = if self.robot.slides(joint) {
                position
            } else {
                WholeTurns::of(self.robot, joint, near).applied(position)
            };
        }
        joints
    }
}

/// Name of the posture at the joint positions `q`, and the singularity that it is near, if any.
pub(crate) fn name(robot: &Robot, q: &[f64]) -> (PostureName, Option<Singularity>) {
    if let Some(hand) = robot.hand() {
        return name(&hand.arm, &in_opposite_order(q));
    }
    let arm = Arm::of(robot);
    let theta: Vec<f64> = (arm.first..q.len()).map(|i| robot.theta(i, q)).collect();
    match arm.inverse.names() {
        Some(form) => {
            let (branch, singularity) = form.name(&theta);
            (PostureName::Branch(branch), singularity)
        }
        None => {
            let dependent = Descent::new(arm.chain).dependent(arm.chain, &theta);
            let sides = Sides::of(q, &robot.middles());
            (
                PostureName::Sides(sides),
                dependent.then_some(Singularity::Dependent),
            )
        }
    }
}

/// The smaller miss.
fn nearer(known: Option<Unreachable>, miss: Unreachable) -> Unreachable {
    known.filter(|known| !miss.is_nearer_than(known)).unwrap_or(miss)
}

#[cfg(test)]
mod tests;
