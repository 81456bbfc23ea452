//! The robot behind the class `Robot`: its arm, its compliances, the order of its joints.
//!
//! `source` keeps what is needed to make it again in another process; `robot_class` has its methods.

use std::path::PathBuf;
use std::sync::Arc;

use armill_core::frame::Isometry;
use armill_core::nalgebra::DMatrix;
use armill_core::robot::{JointCompliance, Robot as Arm, Structure};
use armill_core::sampling::InputSpace;
use armill_core::source::{Arm as CoreArm, StiffnessModel, standard_uncertainties};
use armill_formats::robot::RobotDescription;
use numpy::PyUntypedArray;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::arrays::{Batch, Given, wrong_shape};
use crate::errors::{refused, wrong_type};
use crate::source::{GivenCompliance, RobotSource};

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

    /// The same with other joint compliances.
    ///
    /// # Errors
    /// Numbers that are not compliances, uncertainties or covariances.
    pub(crate) fn with(&self, py: Python<'_>, given: GivenCompliance) -> PyResult<Robot> {
        let both = given.values.iter().zip(&given.uncertainties);
        let compliance = both.map(|(value, uncertainty)| JointCompliance {
            value: *value,
            standard_uncertainty: *uncertainty,
        });
        let mut description = self.description.clone();
        let robot = description.robot.with_other_compliance(compliance.collect());
        let mut robot = robot.map_err(|error| refused(py, error.to_string(), COMPLIANCE_HINT))?;
        if let Some(covariance) = &given.covariance {
            let structure = Structure {
                covariance: Some(DMatrix::from_row_slice(self.dof(), self.dof(), covariance)),
                ..robot.structure().clone()
            };
            let with = robot.with_structure(structure);
            robot = with.map_err(|error| {
                refused(
                    py,
                    error.to_string(),
                    "a symmetric matrix without negative variances",
                )
            })?;
        }
        description.robot = robot;
        Ok(Robot::of(self.source.with_compliance(given), description))
    }

    /// Standard uncertainties (dof,), with their covariance if (dof, dof) is given.
    ///
    /// # Errors
    /// Another shape; numbers that are not finite; a negative variance.
    pub(crate) fn uncertainty(
        &self,
        value: &Bound<'_, PyAny>,
        name: &str,
    ) -> PyResult<(Vec<f64>, Option<Vec<f64>>)> {
        let (py, dof) = (value.py(), self.dof());
        let expected = format!("({dof},) or ({dof}, {dof})");
        let given = Given::of(value, name, &expected)?;
        given.finite(py, name)?;
        let values = given.values().to_vec();
        match given.shape() {
            [count] if *count == dof => Ok((values, None)),
            [rows, columns] if *rows == dof && *columns == dof => {
                let variances: Vec<f64> = values.iter().copied().step_by(dof + 1).collect();
                if let Some(variance) = variances.iter().find(|variance| **variance < 0.0) {
                    let message = format!("{name}: the variance {variance} is negative");
                    return Err(refused(py, message, "give a covariance"));
                }
                let covariance = DMatrix::from_row_slice(dof, dof, &values);
                Ok((standard_uncertainties(&covariance), Some(values)))
            }
            shape => Err(wrong_shape(py, name, &expected, shape)),
        }
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

    /// What the deviation is shared out to.
    pub(crate) fn contributor_names(&self) -> Vec<String> {
        self.model.contributor_names(self.arm().joints())
    }

    /// `rad` of a revolute, `m` of a prismatic joint.
    pub(crate) fn joint_units(&self) -> Vec<String> {
        let unit = |index| if self.arm().slides(index) { "m" } else { "rad" };
        (0..self.dof()).map(|index| unit(index).to_owned()).collect()
    }

    /// Its uncertain inputs.
    pub(crate) fn input_space(&self) -> InputSpace {
        InputSpace::of(&CoreArm {
            robot: self.arm(),
            compliance: self.arm().compliance().unwrap_or_default(),
            model: &self.model,
            flange_from_tool: &Isometry::identity(),
        })
    }

    /// Names of its uncertain inputs.
    pub(crate) fn input_names(&self) -> Vec<String> {
        self.input_space().names(self.arm().joints())
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

/// The model of an arm under load only.
pub(crate) fn model_of(arm: &Arm) -> StiffnessModel {
    StiffnessModel {
        structure: arm.structure().clone(),
        gravity: None,
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    }
}
