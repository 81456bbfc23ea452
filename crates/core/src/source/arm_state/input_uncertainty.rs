//! Uncertainty of the displacement by the uncertainties of load and tool.
//!
//! Each input is changed by its standard uncertainty; its contribution is the change of the displacement: the numerical
//! form of the law of propagation (JCGM 100:2008, 5.1.3, note 2). It is valid for every part of the model.

use nalgebra::{Point3, Vector3};

use super::ArmState;
use crate::load::InputUncertainty;
use crate::robot::forward::Frames;
use crate::source::Unstable;
use crate::spatial::Wrench;

/// An arm in one posture under one load.
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
    /// Variance (m^2) of the elastic displacement along the unit vector `along` by `uncertainty`. The posture is
    /// `arm_state` before and after; the last load is a different one afterwards.
    ///
    /// # Errors
    /// [`Unstable`] where the arm has no equilibrium under a changed load.
    pub fn variance_of_inputs(
        &mut self,
        uncertainty: &InputUncertainty,
        arm_state: &LoadedPosture<'_>,
        along: &Vector3<f64>,
    ) -> Result<f64, Unstable> {
        let mut variance = 0.0;
        self.displacements_by_inputs(uncertainty, arm_state, along, |by| variance += by * by)?;
        Ok(variance)
    }

    /// Reports the displacement (m) of the tool along the unit vector `along` by each input changed by its standard
    /// uncertainty: always the same inputs in the same order. The posture is unchanged, the last load is a different
    /// one.
    ///
    /// # Errors
    /// [`Unstable`] where the arm has no equilibrium under a changed load.
    pub fn displacements_by_inputs(
        &mut self,
        uncertainty: &InputUncertainty,
        arm_state: &LoadedPosture<'_>,
        along: &Vector3<f64>,
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
