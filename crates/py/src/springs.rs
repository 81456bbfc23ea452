//! Compliances in place of those of a robot: given ones, or samples of all uncertain inputs.

use std::borrow::Cow;

use armill_core::frame::Isometry;
use armill_core::robot::JointCompliance;
use armill_core::sampling::SampledArm;
use armill_core::source::{Arm, Gravity, StiffnessModel};
use pyo3::prelude::*;

use crate::arrays::Batch;
use crate::errors::refused;
use crate::robot::{COMPLIANCE_HINT, Robot, model_of};
use crate::samples::Samples;

/// What is given in place of the compliances of a robot.
#[derive(Clone, Copy, Default)]
pub(crate) struct Varied<'a, 'py> {
    /// (..., dof)
    pub compliances: Option<&'a Bound<'py, PyAny>>,
    /// Of all uncertain inputs.
    pub samples: Option<&'a Bound<'py, Samples>>,
}

/// Joint compliances and other parts of the model: those of the robot, or of one or several samples.
// There is one for each call.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Springs<'a> {
    /// Those of the robot, with their uncertainties.
    Nominal(Cow<'a, [JointCompliance]>, Cow<'a, StiffnessModel>),
    /// Of each sample.
    Samples {
        /// The axes of the samples; none for a single one.
        axes: Vec<usize>,
        /// Each with its compliances.
        arms: Cow<'a, [SampledArm]>,
    },
}

impl Springs<'_> {
    /// The axes of the samples; none for the robot itself.
    pub(crate) fn axes(&self) -> &[usize] {
        match self {
            Springs::Nominal(..) => &[],
            Springs::Samples { axes, .. } => axes,
        }
    }

    /// With the weight of the arm.
    pub(crate) fn set_gravity(&mut self, gravity: &Gravity) {
        match self {
            Springs::Nominal(_, model) => model.to_mut().gravity = Some(gravity.clone()),
            Springs::Samples { arms, .. } => {
                for arm in arms.to_mut() {
                    arm.model.gravity = Some(gravity.clone());
                }
            }
        }
    }
}

impl Robot {
    /// The compliances of its joints, those given in their place, (dof,) or samples (..., dof), or samples of all inputs.
    ///
    /// # Errors
    /// Joint compliances that are not known; given ones of another shape, or that are not compliances; samples of another robot;
    /// compliances and samples together.
    pub(crate) fn springs<'a>(&'a self, py: Python<'_>, varied: &Varied<'_, '_>) -> PyResult<Springs<'a>> {
        match (varied.compliances, varied.samples) {
            (None, None) => Ok(Springs::Nominal(
                Cow::Borrowed(self.compliances(py)?),
                Cow::Borrowed(&self.model),
            )),
            (Some(given), None) => self.given_springs(py, given),
            (None, Some(samples)) => {
                let samples = samples.get();
                if !samples.robot_source().is_same(&self.source) {
                    let message = format!("the samples are of robot `{}`", samples.robot_source().name());
                    return Err(refused(
                        py,
                        message,
                        "give samples of this robot: `robot.sample(...)`",
                    ));
                }
                Ok(Springs::Samples {
                    axes: vec![samples.arms().len()],
                    arms: Cow::Owned(samples.arms().to_vec()),
                })
            }
            (Some(_), Some(_)) => {
                let message = "compliances and samples are given";
                Err(refused(py, message, "give one of them: samples have compliances"))
            }
        }
    }

    /// The robot with each of the given compliances: (dof,) or (..., dof).
    fn given_springs(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<Springs<'_>> {
        let batch = Batch::of(given, "compliances", &[self.dof()])?;
        batch.given.finite(py, "compliances")?;
        let mut model = None;
        let mut arms = Vec::with_capacity(batch.count);
        for values in batch.given.values().chunks(self.dof()) {
            let sample: Vec<JointCompliance> = values
                .iter()
                .map(|value| JointCompliance {
                    value: *value,
                    standard_uncertainty: 0.0,
                })
                .collect();
            let arm = self.arm().clone().with_other_compliance(sample.clone());
            let arm = arm.map_err(|error| refused(py, error.to_string(), COMPLIANCE_HINT))?;
            arms.push(SampledArm::nominal(&Arm {
                robot: self.arm(),
                compliance: &sample,
                model: model.get_or_insert_with(|| model_of(&arm)),
                flange_from_tool: &Isometry::identity(),
            }));
        }
        Ok(Springs::Samples {
            axes: batch.axes,
            arms: Cow::Owned(arms),
        })
    }
}
