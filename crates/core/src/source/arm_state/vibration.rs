//! Vibration of the arm in its posture: mass matrix and modes.
//!
//! The compliances are those of [`ArmState::compliance`]: small motions about the unloaded arm, with the slope of torque curves and of the
//! compensator. The stiffness of gravity and of the load on the deflected arm is neglected: a few per mille of the drives.

use nalgebra::DMatrix;

use super::ArmState;
use crate::dynamics::{ArmModes, CarriedInertia, mass_matrix, modes_of};
use crate::robot::deflected_arm::attachment_frame;
use crate::robot::forward::{Frames, forward_into};
use crate::source::equilibrium::Unstable;

impl ArmState<'_> {
    /// Mass matrix of drives, then springs, at the current posture: kg m^2 (kg m, kg), symmetric. Bodies and motors are those of the
    /// structure of the model.
    pub fn mass_matrix(&mut self) -> DMatrix<f64> {
        let robot = self.arm.robot;
        let mut frames = self.frames.take().unwrap_or_else(|| Frames::for_robot(robot));
        forward_into(robot, &self.joints, &mut frames);
        let structure = &self.arm.model.structure;
        let mut carried = CarriedInertia::for_joints(self.joints.len());
        let frame = |attachment| attachment_frame(attachment, &frames, &self.base_from_tool);
        carried.set(&structure.masses, frame, &self.base_from_tool.translation.vector);
        let matrix = mass_matrix(&self.screws, &self.moved, &carried, &structure.motors);
        self.frames = Some(frames);
        matrix
    }

    /// Modes of vibration at the current posture, frequencies rising; none where nothing that deflects has mass.
    ///
    /// # Errors
    /// [`Unstable`] where the compensator of the arm is stiffer than its joint.
    pub fn modes(&mut self) -> Result<ArmModes, Unstable> {
        let compliances = self.tangent_compliances()?;
        let damping = self.arm.model.structure.damping.as_ref();
        let mass = self.mass_matrix();
        Ok(modes_of(&mass, &self.screws, &compliances, damping))
    }

    /// Compliance of each drive, then each spring, for small motions about the unloaded arm.
    ///
    /// # Errors
    /// See [`ArmState::modes`].
    pub fn tangent_compliances(&self) -> Result<Vec<f64>, Unstable> {
        let each = (0..self.screws.len()).map(|k| self.tangent_compliance(k));
        each.collect::<Option<_>>().ok_or(Unstable::Buckles)
    }
}
