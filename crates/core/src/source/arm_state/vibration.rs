//! Vibration of the arm in its posture: mass matrix and modes.
//!
//! The compliances are those of [`ArmState::compliance`]: small motions about the unloaded arm, with the slope of torque curves and of the
//! compensator. The stiffness of gravity and of the load on the deflected arm is neglected: a few per mille of the drives.

use nalgebra::{DMatrix, DVector};

use super::ArmState;
use crate::dynamics::{ArmMode, ArmModes, CarriedInertia, mass_matrix, modes_of};
use crate::robot::deflected_arm::attachment_frame;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::{Mass, Motor};
use crate::source::equilibrium::Unstable;

impl ArmState<'_> {
    /// Mass matrix of drives, then springs, at the current posture: kg m^2 (kg m, kg), symmetric. Bodies and motors are those of the
    /// structure of the model.
    pub fn mass_matrix(&mut self) -> DMatrix<f64> {
        let structure = &self.arm.model.structure;
        self.mass_matrix_of(&structure.masses, &structure.motors)
    }

    /// Mass matrix of these bodies and motors alone.
    fn mass_matrix_of(&mut self, masses: &[Mass], motors: &[Motor]) -> DMatrix<f64> {
        let robot = self.arm.robot;
        let mut frames = self.frames.take().unwrap_or_else(|| Frames::for_robot(robot));
        forward_into(robot, &self.joints, &mut frames);
        let mut carried = CarriedInertia::for_joints(self.joints.len());
        let frame = |attachment| attachment_frame(attachment, &frames, &self.base_from_tool);
        carried.set(masses, frame, &self.base_from_tool.translation.vector);
        let matrix = mass_matrix(&self.screws, &self.moved, &carried, motors);
        self.frames = Some(frames);
        matrix
    }

    /// Relative standard uncertainty of the frequency of each of these modes of the current posture by the uncertainties `u_j` of the masses,
    /// which are taken as independent: `d ln omega = -1/2 x^T M_j x d ln m_j`, with the mass matrix `M_j` of mass `j` alone.
    pub fn frequency_uncertainties_by_masses(&mut self, modes: &[ArmMode]) -> Vec<f64> {
        let masses = &self.arm.model.structure.masses;
        let mut variances = vec![0.0; modes.len()];
        for mass in masses.iter().filter(|mass| mass.relative_uncertainty > 0.0) {
            let own = self.mass_matrix_of(std::slice::from_ref(mass), &[]);
            for (variance, mode) in variances.iter_mut().zip(modes) {
                let x = DVector::from_column_slice(&mode.deflections);
                *variance += (0.5 * x.dot(&(&own * &x)) * mass.relative_uncertainty).powi(2);
            }
        }
        variances.into_iter().map(f64::sqrt).collect()
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
