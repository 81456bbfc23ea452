//! The robot behind the class `Robot`: its arm, its compliances, the order of its joints.
//!
//! `source` keeps what is needed to make it again in another process; `robot_class` has its methods.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use armill_core::robot::{JointCompliance, Robot as Arm};
use armill_core::source::StiffnessModel;
use armill_formats::robot::RobotDescription;
use numpy::PyUntypedArray;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::arrays::{Batch, Given, wrong_shape};
use crate::errors::{refused, wrong_type};
use crate::source::RobotSource;

/// A robot: its kinematic chain, its joints and its compliances. It is immutable.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Robot {
    pub(crate) source: Arc<RobotSource>,
    pub(crate) description: RobotDescription,
    pub(crate) model: StiffnessModel,
}

impl Robot {
    pub(crate) fn of(source: RobotSource, description: RobotDescription) -> Robot {
        Robot {
            source: Arc::new(source),
            model: model_of(&description.robot),
            description,
        }
    }

    /// The robot of a text.
    ///
    /// # Errors
    /// The problems of the text.
    pub(crate) fn read(py: Python<'_>, source: RobotSource) -> PyResult<Robot> {
        let description = source.read(py)?;
        Ok(Robot::of(source, description))
    }

    /// `value` itself if it is a robot; otherwise the robot of this name or path.
    ///
    /// # Errors
    /// Neither a robot nor a path; an unknown robot.
    pub(crate) fn given(value: &Bound<'_, PyAny>) -> PyResult<Py<Robot>> {
        let py = value.py();
        if let Ok(robot) = value.cast::<Robot>() {
            return Ok(robot.clone().unbind());
        }
        let Ok(path) = value.extract::<PathBuf>() else {
            let kind = value.get_type().name()?;
            return Err(wrong_type(format!(
                "robot: expected a Robot, a name of the library or a path, given {kind}"
            )));
        };
        Py::new(py, Robot::read(py, RobotSource::load(py, &path)?)?)
    }

    pub(crate) fn arm(&self) -> &Arm {
        &self.description.robot
    }

    /// Its joint compliances.
    ///
    /// # Errors
    /// A robot whose joint compliances are not known.
    pub(crate) fn compliances(&self, py: Python<'_>) -> PyResult<&[JointCompliance]> {
        self.arm().compliance().ok_or_else(|| {
            let message = format!("robot `{}` has no joint compliance", self.arm().name());
            refused(
                py,
                message,
                "give them: `robot.with_compliance([...])`, rad/(N m), one per joint",
            )
        })
    }

    /// The compliances of its joints, or those given in their place: (dof,) or samples (..., dof).
    ///
    /// # Errors
    /// Joint compliances that are not known; given ones of another shape, or that are not compliances.
    pub(crate) fn springs(&self, py: Python<'_>, given: Option<&Bound<'_, PyAny>>) -> PyResult<Springs<'_>> {
        let Some(given) = given else {
            return Ok(Springs {
                axes: Vec::new(),
                samples: vec![self.compliances(py)?.to_vec()],
                model: Cow::Borrowed(&self.model),
            });
        };
        let batch = Batch::of(given, "compliances", &[self.dof()])?;
        batch.given.finite(py, "compliances")?;
        let mut springs = Springs {
            axes: batch.axes,
            samples: Vec::with_capacity(batch.count),
            model: Cow::Borrowed(&self.model),
        };
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
            if springs.samples.is_empty() {
                springs.model = Cow::Owned(model_of(&arm));
            }
            springs.samples.push(sample);
        }
        Ok(springs)
    }

    /// Joint positions (..., dof), finite; columns of a data frame in the order of the joints.
    ///
    /// # Errors
    /// Another shape, named columns that are not the joints, numbers that are not finite.
    pub(crate) fn joints<'py>(&self, joints: &Bound<'py, PyAny>) -> PyResult<Batch<'py>> {
        let batch = Batch::of(&self.in_joint_order(joints)?, "joints", &[self.dof()])?;
        batch.given.finite(joints.py(), "joints")?;
        Ok(batch)
    }

    /// The joint positions of a rail, and those that redundant joints prefer.
    pub(crate) fn home(&self, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<f64>>> {
        value.map(|value| self.one_a_joint(value, "home")).transpose()
    }

    /// The columns of a data frame in the order of the joints; all else as it is.
    ///
    /// # Errors
    /// Named columns that are not the joints.
    fn in_joint_order<'py>(&self, joints: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if joints.cast::<PyUntypedArray>().is_ok() || !joints.hasattr("columns")? {
            return Ok(joints.clone());
        }
        let columns = joints.getattr("columns")?;
        let columns: Vec<Bound<'py, PyAny>> = columns.try_iter()?.collect::<PyResult<_>>()?;
        // A frame without names numbers its columns.
        if !columns.iter().any(|column| column.cast::<PyString>().is_ok()) {
            return Ok(joints.clone());
        }
        let given: Vec<String> = columns.iter().map(ToString::to_string).collect();
        let names = self.joint_names();
        let sorted = |names: &[String]| {
            let mut names = names.to_vec();
            names.sort();
            names
        };
        if sorted(&given) != sorted(&names) {
            let message = format!(
                "joints: the columns are {}, the joints are {}",
                given.join(", "),
                names.join(", ")
            );
            let hint = "name the columns as the joints, in rad (m), or give an array";
            return Err(refused(joints.py(), message, hint));
        }
        joints.get_item(names)
    }

    /// A number for each joint.
    pub(crate) fn one_a_joint(&self, value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
        let expected = format!("({},)", self.dof());
        let given = Given::of(value, name, &expected)?;
        if given.shape() != [self.dof()] {
            return Err(wrong_shape(value.py(), name, &expected, given.shape()));
        }
        given.finite(value.py(), name)?;
        Ok(given.values().to_vec())
    }

    /// Number of joints.
    pub(crate) fn dof(&self) -> usize {
        self.arm().joints().len()
    }

    /// The names of the manufacturer.
    pub(crate) fn joint_names(&self) -> Vec<String> {
        let joints = self.arm().joints().iter();
        joints.map(|joint| joint.name.clone()).collect()
    }
}

/// What a refused compliance should be.
pub(crate) const COMPLIANCE_HINT: &str = "rad/(N m), one per joint, 0 or more";

/// Joint compliances of one or several samples, and the other parts of the model.
pub(crate) struct Springs<'a> {
    /// The axes of the samples; none for a single one.
    pub axes: Vec<usize>,
    /// Each with one compliance per joint.
    pub samples: Vec<Vec<JointCompliance>>,
    /// Torque curves and covariance are those of the file only for its own compliances.
    pub model: Cow<'a, StiffnessModel>,
}

/// The model of an arm under load only.
fn model_of(arm: &Arm) -> StiffnessModel {
    StiffnessModel {
        structure: arm.structure().clone(),
        gravity: None,
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    }
}
