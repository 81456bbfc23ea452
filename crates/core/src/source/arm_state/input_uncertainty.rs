//! What is not known of load and tool, told as a displacement.
//!
//! Each unknown is taken off by its standard uncertainty, and the change of the displacement is its part: the numerical
//! form of the law of propagation (JCGM 100:2008, 5.1.3, note 2). It holds for every part of the model.

use nalgebra::{Point3, Vector3};

use super::ArmState;
use crate::load::InputUncertainty;
use crate::robot::forward::Frames;
use crate::source::Unstable;
use crate::spatial::Wrench;

/// Where an arm stands, and what it is loaded with there.
#[derive(Clone, Copy, Debug)]
pub struct LoadedPosture<'a> {
    /// Joint positions, rad (m).
    pub joints: &'a [f64],
    /// Its frames there.
    pub frames: &'a Frames,
    /// Tool centre point, m, base.
    pub tcp: Point3<f64>,
    /// Tool axis, unit, base.
    pub tool_axis: Vector3<f64>,
    /// On the tool at the TCP, base basis.
    pub wrench: &'a Wrench,
}

impl ArmState<'_> {
    /// Variance (m^2) of the elastic displacement along the unit vector `along` that `doubt` makes. The arm stands as
    /// `standing` says, before and after; its last load is another one afterwards.
    ///
    /// # Errors
    /// [`Unstable`] where the arm finds no rest under a load that is off.
    pub fn variance_of_inputs(
        &mut self,
        uncertainty: &InputUncertainty,
        arm_state: &LoadedPosture<'_>,
        along: &Vector3<f64>,
    ) -> Result<f64, Unstable> {
        let mut variance = 0.0;
        self.moves_of_inputs(uncertainty, (arm_state, along), |by| variance += by * by)?;
        Ok(variance)
    }

    /// Tells how far (m) each unknown of `doubt`, off by its standard uncertainty, moves the tool along the unit vector
    /// `along`: always the same unknowns in the same order. The arm stands as before, its last load is another one.
    ///
    /// # Errors
    /// [`Unstable`] where the arm finds no rest under a load that is off.
    pub fn moves_of_inputs(
        &mut self,
        uncertainty: &InputUncertainty,
        (arm_state, along): (&LoadedPosture<'_>, &Vector3<f64>),
        mut given: impl FnMut(f64),
    ) -> Result<(), Unstable> {
        let Wrench { force, moment } = *arm_state.wrench;
        let as_is = self.elastic(arm_state.wrench)?.linear.dot(along);
        if uncertainty.relative > 0.0 {
            let off = *arm_state.wrench * (1.0 + uncertainty.relative);
            given(self.elastic(&off)?.linear.dot(along) - as_is);
        }
        for u in uncertainty.forces.iter().filter(|u| **u != Vector3::zeros()) {
            let off = Wrench {
                force: force + u,
                moment,
            };
            given(self.elastic(&off)?.linear.dot(along) - as_is);
        }
        if uncertainty.tool_length > 0.0 {
            let off = arm_state.tcp + arm_state.tool_axis * uncertainty.tool_length;
            self.set_frames(arm_state.joints, arm_state.frames, &off);
            let elsewhere = self.elastic(arm_state.wrench);
            self.set_frames(arm_state.joints, arm_state.frames, &arm_state.tcp);
            given(elsewhere?.linear.dot(along) - as_is);
        }
        Ok(())
    }
}
