//! An arm in one posture, ready to be loaded: screws of all compliant parts, gravity, and the effect of a load.
//!
//! ```text
//! delta = sum_k s_k x_k(w)                     elastic: drives and springs deflect under the load
//!       + sum_k s_k x_k(tau_g)  -  the same at tool setting                 gravity
//! ```
//!
//! A drive or spring deflects by `x = c tau`, a joint with a torque curve by `theta(tau_g + tau) - theta(tau_g)`, and
//! one with a compensator as if its stiffness were `k - dM/dtheta`. Under a load-dependent model the elastic part comes
//! from [`super::equilibrium`], and the shares `s_k x_k` add up to it in first order only.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s_k` | screw of drive or spring k at the TCP, base basis | m/rad, rad/rad |
//! | `x_k` | its deflection | rad (m) |
//! | `tau_g` | torque of gravity on it, compensator included | N m (N) |
//!
//! Made once, used for any number of postures and loads without allocation. `shares`: contribution of each part;
//! `input_uncertainty`: uncertainty by load and tool; `backlash_and_geometry`: deviations that no load causes; `uncertain_masses`: uncertainty by masses; `vibration`: mass matrix and modes.

mod backlash_and_geometry;
mod input_uncertainty;
mod shares;
mod uncertain_masses;
mod vibration;

pub use backlash_and_geometry::Links;
pub use input_uncertainty::LoadedPosture;
use uncertain_masses::{UncertainMasses, Weighed};

use nalgebra::{IsometryMatrix3, Matrix3, Matrix6, Point3, Rotation3, Vector3};

use super::equilibrium::{AtRest, Equilibrium, Unstable};
use super::gravity::{Carried, carry_into, torque_by};
use super::stiffness_model::{Arm, Gravity};
use crate::load::TipCompliance;
use crate::robot::deflected_arm::{attachment_frame, spring_screw};
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::tool_on;
use crate::robot::jacobian::screws_into;
use crate::robot::{Attachment, JointCompliance, MovedBy};
use crate::spatial::{Twist, Wrench};

/// An arm in one posture.
#[derive(Clone, Debug)]
pub struct ArmState<'a> {
    arm: Arm<'a>,
    compliances: Vec<JointCompliance>,
    attachments: Vec<Attachment>,
    /// What each drive, then each spring, moves.
    moved: Vec<MovedBy>,
    flange_from_tool: Rotation3<f64>,
    /// Whether the deflection of every drive and spring is proportional to its torque, whatever the other loads on the
    /// arm.
    in_proportion: bool,
    /// Working memory of [`ArmState::set_joints`]; taken while it is in use.
    frames: Option<Frames>,
    /// Joint positions, in the coordinates of the controller and of the chain.
    joints: Vec<f64>,
    theta: Vec<f64>,
    base_from_tool: IsometryMatrix3<f64>,
    base_from_ground: IsometryMatrix3<f64>,
    screws: Vec<Twist>,
    weight: Option<Weight<'a>>,
    /// Torque of gravity on each drive and spring; zeros without gravity.
    before: Vec<f64>,
    /// Torque of the load on each, and the deflection of each by it.
    torques: Vec<f64>,
    turns: Vec<f64>,
    equilibrium: Option<Box<Equilibrium>>,
}

/// Effect of gravity on the arm.
#[derive(Clone, Debug)]
struct Weight<'a> {
    gravity: &'a Gravity,
    carried: Vec<Carried>,
    /// Deflection of each drive and spring by gravity alone; `None` where one is unstable.
    sag: Option<Vec<f64>>,
    /// At tool setting: displacement of the tool by each, and the same per unit of compliance, in the axes of the ground.
    at_reference: Option<Vec<(Twist, Vector3<f64>)>>,
    uncertain: UncertainMasses,
}

impl<'a> ArmState<'a> {
    /// Working memory for this arm. With gravity, the state at the reference posture is evaluated first.
    ///
    /// Not checked: that the structure of the model fits the robot ([`crate::robot::Structure::check`]), and that there
    /// are as many compliances, and as many joint positions at tool setting, as joints.
    pub fn new(arm: Arm<'a>) -> ArmState<'a> {
        let (compliances, attachments) = (arm.compliances(), arm.attachments());
        let (joints, size) = (arm.robot.joints().len(), compliances.len());
        let weight = |gravity| Weight {
            gravity,
            carried: vec![Carried::NOTHING; Attachment::count(joints)],
            sag: Some(vec![0.0; size]),
            at_reference: None,
            uncertain: UncertainMasses::of(&arm.model.structure, joints),
        };
        let mut arm_state = ArmState {
            arm,
            compliances,
            attachments,
            moved: arm.moved_by(),
            flange_from_tool: arm.flange_from_tool.rotation.to_rotation_matrix(),
            in_proportion: arm.model.is_affine() && arm.model.structure.compensator.is_none(),
            frames: None,
            joints: vec![0.0; joints],
            theta: vec![0.0; joints],
            base_from_tool: IsometryMatrix3::identity(),
            base_from_ground: IsometryMatrix3::identity(),
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
            let ground_from_base = arm_state.base_from_ground.rotation.inverse();
            let there = arm_state.sagging().map(|there| {
                let each = there.into_iter();
                each.map(|(moved, per_unit)| (moved.turned(&ground_from_base), ground_from_base * per_unit))
                    .collect()
            });
            if let Some(weight) = &mut arm_state.weight {
                weight.at_reference = there;
                weight.uncertain.set_reference(&ground_from_base);
            }
        }
        arm_state
    }

    /// The arm.
    pub fn arm(&self) -> &Arm<'a> {
        &self.arm
    }

    /// Screw of each drive, then each spring, at the TCP, base basis.
    pub fn screws(&self) -> &[Twist] {
        &self.screws
    }

    /// The tool at the current posture, in base.
    pub fn base_from_tool(&self) -> &IsometryMatrix3<f64> {
        &self.base_from_tool
    }

    /// Torque of gravity on each drive, then each spring, N m (N); zeros where gravity is neglected.
    pub fn gravity_torques(&self) -> &[f64] {
        &self.before
    }

    /// Sets the joint positions to `q`, rad (m).
    pub fn set_joints(&mut self, q: &[f64]) {
        let room = self.frames.take();
        let mut frames = room.unwrap_or_else(|| Frames::for_robot(self.arm.robot));
        forward_into(self.arm.robot, q, &mut frames);
        // Identical to that of a posture, to the last bit.
        let tcp = tool_on(&frames, self.arm.flange_from_tool).translation.vector;
        self.set_frames(q, &frames, &tcp.into());
        self.frames = Some(frames);
    }

    /// [`ArmState::set_joints`] where the frames at `q` and the TCP (m, base) are already known.
    pub fn set_frames(&mut self, q: &[f64], frames: &Frames, tcp: &Point3<f64>) {
        let Arm { robot, model, .. } = self.arm;
        let structure = &model.structure;
        let joints = self.theta.len();
        screws_into(robot, frames, tcp, &mut self.screws[..joints]);
        let turn = frames.base_from_flange.rotation * self.flange_from_tool;
        let base_from_tool = IsometryMatrix3::from_parts(tcp.coords.into(), turn);
        self.base_from_tool = base_from_tool;
        let ground = robot.chain().ground();
        self.base_from_ground = ground.in_base(&frames.base_from_joint);
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
        let g = self.base_from_ground.rotation * weight.gravity.acceleration;
        for (k, (before, screw)) in self.before.iter_mut().zip(&self.screws).enumerate() {
            *before = torque_by(screw, &weight.carried, self.moved[k], &g);
        }
        if let Some(c) = &structure.compensator {
            self.before[c.joint] += c.torque(self.theta[c.joint]);
        }
        let mut sag = weight.sag.take().unwrap_or_else(|| vec![0.0; self.before.len()]);
        let mut stable = true;
        for (k, sag) in sag.iter_mut().enumerate() {
            let turned = self.turn(k, 0.0, self.before[k]);
            stable &= turned.is_some();
            *sag = turned.unwrap_or_default();
        }
        weight.sag = stable.then_some(sag);
        let weighed = Weighed {
            screws: &self.screws,
            moved: &self.moved,
            g,
            tcp: tcp.coords,
        };
        let slope = |k: usize| self.tangent_compliance(k).unwrap_or_default();
        weight.uncertain.set(&weighed, frame, slope);
        self.weight = Some(weight);
    }

    /// Displacement of the tool by the deflection of drives and springs under `wrench` (at the TCP, base basis).
    ///
    /// # Errors
    /// [`Unstable`] where the arm has no stable equilibrium.
    pub fn elastic(&mut self, wrench: &Wrench) -> Result<Twist, Unstable> {
        if let Some(mut equilibrium) = self.equilibrium.take() {
            let at_rest = AtRest {
                theta: &self.theta,
                torques: &self.before,
            };
            let found = equilibrium.find(&self.arm, at_rest, wrench, |k, torque| self.law(k, torque));
            self.turns.copy_from_slice(equilibrium.turns());
            self.torques.copy_from_slice(equilibrium.torques());
            self.equilibrium = Some(equilibrium);
            return found;
        }
        let mut sum = Twist::ZERO;
        if self.in_proportion {
            let each = self.screws.iter().zip(&self.compliances);
            let deflections = self.torques.iter_mut().zip(&mut self.turns);
            for ((screw, compliance), (torque, turn)) in each.zip(deflections) {
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

    /// Displacement of the tool by gravity, relative to tool setting; `None` where gravity is neglected.
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
        let turn = &self.base_from_ground.rotation;
        let each = self.screws.iter().zip(sag).zip(there);
        Ok(Some(
            each.map(|((screw, sag), (there, _))| *screw * *sag - there.turned(turn))
                .sum(),
        ))
    }

    /// Compliance of the tip at the current posture: its displacement under one newton along each base axis, and by
    /// gravity alone.
    ///
    /// # Errors
    /// [`Unstable`] where the arm has no stable equilibrium under one of them.
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

    /// The compliance of the unloaded arm at the TCP: 6 x 6, base, translation first; `None` where the arm is unstable.
    pub fn compliance(&self) -> Option<Matrix6<f64>> {
        let mut sum = Matrix6::zeros();
        for (k, screw) in self.screws.iter().enumerate() {
            let s = screw.to_vector();
            sum += s * s.transpose() * self.tangent_compliance(k)?;
        }
        Some(sum)
    }

    /// Compliance of drive or spring `k` of the unloaded arm, with the slope of its torque curve and of the compensator; `None` where
    /// the arm is unstable.
    fn tangent_compliance(&self, k: usize) -> Option<f64> {
        let c = match self.arm.model.structure.curve(k) {
            Some(curve) => curve.slope(self.before[k], 0.0),
            None => self.compliances[k].value,
        };
        let lost = 1.0 - c * self.compensator_slope(k);
        // A quotient by one keeps the bits of the simple model.
        (lost > 0.0).then(|| c / lost)
    }

    /// The tangent compliance under the last load, with a load-dependent model; 6 x 6 at the deflected TCP.
    pub fn loaded_compliance(&mut self) -> Option<Matrix6<f64>> {
        self.equilibrium.as_mut().and_then(|found| found.tangent())
    }

    /// Deflection of drive or spring `k` when the torque `change` is added to `before`.
    fn turn(&self, k: usize, before: f64, change: f64) -> Option<f64> {
        let Some(curve) = self.arm.model.structure.curve(k) else {
            let turn = self.compliances[k].value * change;
            return match self.stiffness_factor(k) {
                None => Some(turn),
                Some(factor) if factor > 0.0 => Some(turn / factor),
                Some(_) => None,
            };
        };
        let slope = self.compensator_slope(k);
        let mut turn = curve.turn(before, change);
        if slope == 0.0 {
            return Some(turn);
        }
        // The compensator is a few per cent of the joint's stiffness: each round reduces the error by this factor.
        for _ in 0..MOST_ROUNDS {
            let next = curve.turn(before, change + slope * turn);
            if (next - turn).abs() <= SETTLED * next.abs() {
                return Some(next);
            }
            turn = next;
        }
        None
    }

    /// Deflection and slope of drive or spring `k` where the equilibrium includes the compensator.
    fn law(&self, k: usize, torque: f64) -> (f64, f64) {
        match self.arm.model.structure.curve(k) {
            Some(curve) => (
                curve.turn(self.before[k], torque),
                curve.slope(self.before[k], torque),
            ),
            None => (self.compliances[k].value * torque, self.compliances[k].value),
        }
    }

    /// `1 - c dM/dtheta`, where a compensator acts on this drive.
    fn stiffness_factor(&self, k: usize) -> Option<f64> {
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
        let turn = &self.base_from_ground.rotation;
        let (there, per_unit) = weight.at_reference.as_ref()?[k];
        Some((weight.sag.as_ref()?[k], (there.turned(turn), turn * per_unit)))
    }

    /// Displacement by gravity of each drive and spring, and the same per unit of compliance, m; none without gravity, or
    /// where the arm has no equilibrium.
    pub(crate) fn sagging(&self) -> Option<Vec<(Twist, Vector3<f64>)>> {
        let sag = self.weight.as_ref()?.sag.as_ref()?;
        let each = |(k, sag): (usize, &f64)| {
            let grown = self
                .stiffness_factor(k)
                .map_or(1.0, |factor| 1.0 / (factor * factor));
            let per_unit = self.screws[k].linear * (self.before[k] * grown);
            (self.screws[k] * *sag, per_unit)
        };
        Some(sag.iter().enumerate().map(each).collect())
    }
}

/// Maximum number of rounds for the compensator at a torque curve.
const MOST_ROUNDS: usize = 200;
/// Rounding left after them, relative.
const SETTLED: f64 = 1e-14;

#[cfg(test)]
mod tests;
