//! An arm that stands in one posture, ready to be loaded: screws of all that yields, gravity, and what a load does.
//!
//! ```text
//! delta = sum_k s_k x_k(w)                     elastic: drives and springs give way to the load
//!       + sum_k s_k x_k(tau_g)  -  the same where the tool was set          gravity
//! ```
//!
//! A drive or spring gives way by `x = c tau`, a joint with a torque curve by `theta(tau_g + tau) - theta(tau_g)`, and
//! one with a compensator as if its stiffness were `k - dM/dtheta`. Under a load-dependent model the elastic part comes
//! from [`super::equilibrium`], and the shares `s_k x_k` add up to it in first order only.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s_k` | screw of drive or spring k at the TCP, base basis | m/rad, rad/rad |
//! | `x_k` | how far it gives way | rad (m) |
//! | `tau_g` | torque of gravity on it, compensator included | N m (N) |
//!
//! Made once, used at any number of postures and loads without allocation. `shares`: who moves the tool by how much;
//! `doubt`: how sure that is, of load and tool; `unloaded`: what moves the tool beside the load.

mod input_uncertainty;
mod shares;
mod backlash_and_geometry;

pub use input_uncertainty::LoadedPosture;
pub use backlash_and_geometry::Links;

use nalgebra::{IsometryMatrix3, Matrix3, Matrix6, Point3, Rotation3, Vector3};

use super::equilibrium::{Equilibrium, Unstable};
use super::gravity::{Carried, carry_into, torque};
use super::stiffness_model::{Arm, Gravity};
use crate::load::TipCompliance;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::tool_on;
use crate::robot::jacobian::screws_into;
use crate::robot::deflected_arm::{attachment_frame, spring_screw};
use crate::robot::{JointCompliance, Attachment};
use crate::spatial::{Twist, Wrench};

/// An arm in one posture.
#[derive(Clone, Debug)]
pub struct ArmState<'a> {
    arm: Arm<'a>,
    compliances: Vec<JointCompliance>,
    attachments: Vec<Attachment>,
    flange_from_tool: Rotation3<f64>,
    /// Whether every drive and spring gives way in proportion to its torque, whatever else stands on the arm.
    in_proportion: bool,
    /// Room for [`ArmState::set_joints`]; taken while it is in use.
    frames: Option<Frames>,
    /// Joint positions where it stands, the controller's counting and the chain's.
    joints: Vec<f64>,
    theta: Vec<f64>,
    base_from_tool: IsometryMatrix3<f64>,
    screws: Vec<Twist>,
    weight: Option<Weight<'a>>,
    /// Torque of gravity on each drive and spring; zeros without gravity.
    before: Vec<f64>,
    /// What the load puts on each, and how far each gives way to it.
    torques: Vec<f64>,
    turns: Vec<f64>,
    equilibrium: Option<Box<Equilibrium>>,
}

/// What gravity does to the arm.
#[derive(Clone, Debug)]
struct Weight<'a> {
    gravity: &'a Gravity,
    carried: Vec<Carried>,
    /// How far each drive and spring gives way to gravity alone; `None` where one does not hold.
    sag: Option<Vec<f64>>,
    /// Where the tool was set: displacement of the tool by each, and the same per unit of compliance.
    at_reference: Option<Vec<(Twist, Vector3<f64>)>>,
}

impl<'a> ArmState<'a> {
    /// Room for this arm. Where gravity counts it has stood at the reference posture already.
    ///
    /// Not checked: that the structure of the model fits the robot ([`crate::robot::Structure::check`]), and that there
    /// are as many compliances, and as many joint positions where the tool was set, as joints.
    pub fn new(arm: Arm<'a>) -> ArmState<'a> {
        let (compliances, attachments) = (arm.compliances(), arm.attachments());
        let (joints, size) = (arm.robot.joints().len(), compliances.len());
        let weight = |gravity| Weight {
            gravity,
            carried: vec![Carried::NOTHING; Attachment::count(joints)],
            sag: Some(vec![0.0; size]),
            at_reference: None,
        };
        let mut arm_state = ArmState {
            arm,
            compliances,
            attachments,
            flange_from_tool: arm.flange_from_tool.rotation.to_rotation_matrix(),
            in_proportion: arm.model.is_affine() && arm.model.structure.compensator.is_none(),
            frames: None,
            joints: vec![0.0; joints],
            theta: vec![0.0; joints],
            base_from_tool: IsometryMatrix3::identity(),
            screws: vec![Twist::ZERO; size],
            weight: arm.model.gravity.as_ref().map(weight),
            before: vec![0.0; size],
            torques: vec![0.0; size],
            turns: vec![0.0; size],
            equilibrium: arm
                .model
                .load_dependent
                .then(|| Box::new(Equilibrium::for_arm(&arm))),
        };
        if let Some(gravity) = &arm.model.gravity {
            arm_state.set_joints(&gravity.reference);
            let there = arm_state.sagging();
            if let Some(weight) = &mut arm_state.weight {
                weight.at_reference = there;
            }
        }
        arm_state
    }

    /// The arm that stands.
    pub fn arm(&self) -> &Arm<'a> {
        &self.arm
    }

    /// Screw of each drive, then each spring, at the TCP, base basis.
    pub fn screws(&self) -> &[Twist] {
        &self.screws
    }

    /// The tool where the arm stands, in base.
    pub fn base_from_tool(&self) -> &IsometryMatrix3<f64> {
        &self.base_from_tool
    }

    /// Torque of gravity on each drive, then each spring, N m (N); zeros where gravity does not count.
    pub fn gravity_torques(&self) -> &[f64] {
        &self.before
    }

    /// Stands the arm at joint positions `q`, rad (m).
    pub fn set_joints(&mut self, q: &[f64]) {
        let room = self.frames.take();
        let mut frames = room.unwrap_or_else(|| Frames::for_robot(self.arm.robot));
        forward_into(self.arm.robot, q, &mut frames);
        // As a posture has it, to the last bit.
        let tcp = tool_on(&frames, self.arm.flange_from_tool).translation.vector;
        self.set_frames(q, &frames, &tcp.into());
        self.frames = Some(frames);
    }

    /// [`ArmState::set_joints`] where the frames at `q` and the TCP (m, base) are known already.
    pub fn set_frames(&mut self, q: &[f64], frames: &Frames, tcp: &Point3<f64>) {
        let Arm { robot, model, .. } = self.arm;
        let structure = &model.structure;
        let joints = self.theta.len();
        screws_into(robot, frames, tcp, &mut self.screws[..joints]);
        let turn = frames.base_from_flange.rotation * self.flange_from_tool;
        let base_from_tool = IsometryMatrix3::from_parts(tcp.coords.into(), turn);
        self.base_from_tool = base_from_tool;
        let frame = |attachment: Attachment| attachment_frame(attachment, frames, &base_from_tool);
        for (screw, spring) in self.screws[joints..].iter_mut().zip(&structure.springs) {
            *screw = spring_screw(&spring.direction, &frame(spring.attachment), tcp.coords);
        }
        self.joints.copy_from_slice(q);
        for (joint, theta) in self.theta.iter_mut().enumerate() {
            *theta = robot.theta(joint, q);
        }
        let Some(mut weight) = self.weight.take() else {
            return;
        };
        carry_into(&structure.masses, frame, tcp.coords, &mut weight.carried);
        for ((before, screw), attachment) in self.before.iter_mut().zip(&self.screws).zip(&self.attachments) {
            let carried = &weight.carried[attachment.rank(joints)];
            *before = torque(screw, carried, &weight.gravity.acceleration);
        }
        if let Some(c) = &structure.compensator {
            self.before[c.joint] += c.torque(self.theta[c.joint]);
        }
        let mut sag = weight.sag.take().unwrap_or_else(|| vec![0.0; self.before.len()]);
        let mut holds = true;
        for (k, sag) in sag.iter_mut().enumerate() {
            let turned = self.turn(k, 0.0, self.before[k]);
            holds &= turned.is_some();
            *sag = turned.unwrap_or_default();
        }
        weight.sag = holds.then_some(sag);
        self.weight = Some(weight);
    }

    /// Displacement of the tool because drives and springs give way to `wrench` (at the TCP, base basis).
    ///
    /// # Errors
    /// [`Unstable`] where the arm finds no stable rest.
    pub fn elastic(&mut self, wrench: &Wrench) -> Result<Twist, Unstable> {
        if let Some(mut equilibrium) = self.equilibrium.take() {
            let at = (&self.theta[..], &self.before[..]);
            let found = equilibrium.find(&self.arm, at, wrench, |k, torque| self.law(k, torque));
            self.turns.copy_from_slice(equilibrium.turns());
            self.torques.copy_from_slice(equilibrium.torques());
            self.equilibrium = Some(equilibrium);
            return found;
        }
        let mut sum = Twist::ZERO;
        if self.in_proportion {
            let each = self.screws.iter().zip(&self.compliances);
            let given_way = self.torques.iter_mut().zip(&mut self.turns);
            for ((screw, compliance), (torque, turn)) in each.zip(given_way) {
                *torque = screw.dot(wrench);
                *turn = compliance.value * *torque;
                sum = sum + *screw * *turn;
            }
            return Ok(sum);
        }
        for (k, screw) in self.screws.iter().enumerate() {
            let torque = screw.dot(wrench);
            let turn = self.turn(k, self.before[k], torque).ok_or(Unstable::Buckles)?;
            (self.torques[k], self.turns[k]) = (torque, turn);
            sum = sum + *screw * turn;
        }
        Ok(sum)
    }

    /// Displacement of the tool by gravity, less that where the tool was set; `None` where gravity does not count.
    ///
    /// # Errors
    /// [`Unstable`] where the compensator of the arm is stiffer than its joint.
    pub fn gravity(&self) -> Result<Option<Twist>, Unstable> {
        let Some(weight) = &self.weight else {
            return Ok(None);
        };
        let (Some(sag), Some(there)) = (&weight.sag, &weight.at_reference) else {
            return Err(Unstable::Buckles);
        };
        let each = self.screws.iter().zip(sag).zip(there);
        Ok(Some(
            each.map(|((screw, sag), (there, _))| *screw * *sag - *there)
                .sum(),
        ))
    }

    /// How the tip yields to a force where the arm stands: its displacement under one newton along each base axis, and by
    /// gravity alone.
    ///
    /// # Errors
    /// [`Unstable`] where the arm finds no stable rest under one of them.
    pub fn tip_compliance(&mut self) -> Result<TipCompliance, Unstable> {
        let mut under = |axis| Ok(self.elastic(&Wrench::from_force(axis))?.linear);
        let columns = [under(Vector3::x())?, under(Vector3::y())?, under(Vector3::z())?];
        Ok(TipCompliance {
            by_force: Matrix3::from_columns(&columns),
            unloaded: self
                .gravity()?
                .map_or_else(Vector3::zeros, |gravity| gravity.linear),
        })
    }

    /// The compliance of the unloaded arm at the TCP: 6 x 6, base, translation first; `None` where it does not hold.
    pub fn compliance(&self) -> Option<Matrix6<f64>> {
        let mut sum = Matrix6::zeros();
        for (k, screw) in self.screws.iter().enumerate() {
            let c = match self.arm.model.structure.curve(k) {
                Some(curve) => curve.slope(self.before[k], 0.0),
                None => self.compliances[k].value,
            };
            let lost = 1.0 - c * self.compensator_slope(k);
            if lost <= 0.0 {
                return None;
            }
            let s = screw.to_vector();
            // A product by one keeps every bit of the simple model.
            sum += s * s.transpose() * (c / lost);
        }
        Some(sum)
    }

    /// The compliance tangent to the last load, under a load-dependent model; 6 x 6 at the yielded TCP.
    pub fn loaded_compliance(&mut self) -> Option<Matrix6<f64>> {
        self.equilibrium.as_mut().and_then(|found| found.tangent())
    }

    /// How far drive or spring `k` turns when the torque `change` comes on top of `before`.
    fn turn(&self, k: usize, before: f64, change: f64) -> Option<f64> {
        let Some(curve) = self.arm.model.structure.curve(k) else {
            let turn = self.compliances[k].value * change;
            return match self.evaluation(k) {
                None => Some(turn),
                Some(evaluation) if evaluation > 0.0 => Some(turn / evaluation),
                Some(_) => None,
            };
        };
        let slope = self.compensator_slope(k);
        let mut turn = curve.turn(before, change);
        if slope == 0.0 {
            return Some(turn);
        }
        // The compensator takes a few per cent of the joint's stiffness: each round leaves as much of the error.
        for _ in 0..MOST_ROUNDS {
            let next = curve.turn(before, change + slope * turn);
            if (next - turn).abs() <= SETTLED * next.abs() {
                return Some(next);
            }
            turn = next;
        }
        None
    }

    /// Turn and slope of drive or spring `k` where the equilibrium itself takes the compensator in.
    fn law(&self, k: usize, torque: f64) -> (f64, f64) {
        match self.arm.model.structure.curve(k) {
            Some(curve) => (
                curve.turn(self.before[k], torque),
                curve.slope(self.before[k], torque),
            ),
            None => (self.compliances[k].value * torque, self.compliances[k].value),
        }
    }

    /// `1 - c dM/dtheta`, where a compensator works on this drive.
    fn evaluation(&self, k: usize) -> Option<f64> {
        let slope = self.compensator_slope(k);
        (slope != 0.0).then(|| 1.0 - self.compliances[k].value * slope)
    }

    fn compensator_slope(&self, k: usize) -> f64 {
        let compensator = self.arm.model.structure.compensator.as_ref();
        let own = compensator.filter(|c| c.joint == k);
        own.map_or(0.0, |c| c.slope(self.theta[k]))
    }

    fn sagged(&self, k: usize) -> Option<(f64, (Twist, Vector3<f64>))> {
        let weight = self.weight.as_ref()?;
        Some((weight.sag.as_ref()?[k], weight.at_reference.as_ref()?[k]))
    }

    /// Displacement by gravity of each drive and spring, and the same per unit of compliance.
    fn sagging(&self) -> Option<Vec<(Twist, Vector3<f64>)>> {
        let sag = self.weight.as_ref()?.sag.as_ref()?;
        let each = |(k, sag): (usize, &f64)| {
            let grown = self.evaluation(k).map_or(1.0, |evaluation| 1.0 / (evaluation * evaluation));
            let per_unit = self.screws[k].linear * (self.before[k] * grown);
            (self.screws[k] * *sag, per_unit)
        };
        Some(sag.iter().enumerate().map(each).collect())
    }
}

/// Rounds of taking the compensator in at a torque curve, at most.
const MOST_ROUNDS: usize = 200;
/// Rounding left after them, relative.
const SETTLED: f64 = 1e-14;

#[cfg(test)]
mod tests;
