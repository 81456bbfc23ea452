//! The class `Samples`: samples of the uncertain inputs of a robot.

use std::sync::Arc;

use armill_core::frame::Isometry;
use armill_core::sampling::{InputSpace, SampledArm};
use armill_core::source::Arm;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PySlice;
use rayon::prelude::*;

use crate::arrays::{Given, array, wrong_shape};
use crate::containers::containers;
use crate::html;
use crate::robot::Robot;
use crate::source::RobotSource;

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;

/// n samples of the uncertain inputs of a robot: `samples=` of `Robot.deviation`, `compliance`, `evaluate`, ...
///
/// Each input is a standard normal number `z`; the values of the robot are those of its file plus `z` times the standard
/// uncertainty, along the axes of the covariance where inputs are correlated. `samples[10:20]` are samples again.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Samples {
    robot: Py<Robot>,
    source: Arc<RobotSource>,
    inputs: usize,
    z: Vec<f64>,
    arms: Vec<SampledArm>,
}

impl Samples {
    /// The arms of these standard normal numbers, one row of inputs each.
    pub(crate) fn of(robot: &Bound<'_, Robot>, z: Vec<f64>) -> PyResult<Samples> {
        let own = robot.get();
        let arm = Arm {
            robot: own.arm(),
            compliance: own.compliances(robot.py())?,
            model: &own.model,
            flange_from_tool: &Isometry::identity(),
        };
        let space = InputSpace::of(&arm);
        let inputs = space.inputs().len();
        let arms = robot.py().detach(|| match inputs {
            0 => Vec::new(),
            _ => z.par_chunks(inputs).map(|z| space.sampled(&arm, z)).collect(),
        });
        Ok(Samples {
            source: Arc::clone(&own.source),
            robot: robot.clone().unbind(),
            inputs,
            z,
            arms,
        })
    }

    /// The robot that they are of.
    pub(crate) fn robot_source(&self) -> &RobotSource {
        &self.source
    }

    /// The robot with each sample.
    pub(crate) fn arms(&self) -> &[SampledArm] {
        &self.arms
    }

    fn table<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        row: impl Fn(&SampledArm, &mut [f64]),
    ) -> Floats<'py> {
        let mut values = vec![0.0; self.arms.len() * columns];
        if columns > 0 {
            for (arm, values) in self.arms.iter().zip(values.chunks_mut(columns)) {
                row(arm, values);
            }
        }
        array(py, &[self.arms.len(), columns], values)
    }
}

#[pymethods]
impl Samples {
    /// -> Robot: the robot that they are of.
    #[getter]
    fn robot(&self, py: Python<'_>) -> Py<Robot> {
        self.robot.clone_ref(py)
    }

    /// -> (n, inputs) standard normal number of each input; `Robot.uncertain_inputs` has their names.
    #[getter]
    fn z<'py>(&self, py: Python<'py>) -> Floats<'py> {
        array(py, &[self.arms.len(), self.inputs], self.z.clone())
    }

    /// -> (n, dof) compliance of each joint, rad/(N m) (m/N).
    #[getter]
    fn compliances<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.table(py, self.robot.get().dof(), |arm, row| {
            for (value, compliance) in row.iter_mut().zip(&arm.compliance) {
                *value = compliance.value;
            }
        })
    }

    /// -> (n, springs) compliance of each spring in addition to the joints, rad/(N m) (m/N).
    #[getter]
    fn spring_compliances<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let springs = self.robot.get().model.structure.springs.len();
        self.table(py, springs, |arm, row| {
            for (value, spring) in row.iter_mut().zip(&arm.model.structure.springs) {
                *value = spring.compliance.value;
            }
        })
    }

    /// -> (n, dof) backlash of each joint, rad (m); 0 for a joint without backlash.
    #[getter]
    fn backlash<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.table(py, self.robot.get().dof(), |arm, row| {
            for (joint, backlash) in arm.model.structure.joints_with_backlash() {
                row[joint] = backlash.gap;
            }
        })
    }

    /// -> (n, dof) side of the backlash where no torque decides it: -1 or 1; 0 for all other joints.
    #[getter]
    fn backlash_side<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.table(py, self.robot.get().dof(), |arm, row| {
            row.copy_from_slice(&arm.side);
        })
    }

    /// -> (n, masses) masses of the robot file, kg.
    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let masses = self.robot.get().model.structure.masses.len();
        self.table(py, masses, |arm, row| {
            for (value, mass) in row.iter_mut().zip(&arm.model.structure.masses) {
                *value = mass.mass;
            }
        })
    }

    /// -> (n, motions) small motions of the geometry, m and rad; `Robot.geometry_motions` has their names.
    #[getter]
    fn geometry<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let known = self.robot.get().model.structure.geometry.as_ref();
        let motions = known.map_or(0, |geometry| geometry.motions().len());
        self.table(py, motions, |arm, row| {
            if let Some(geometry) = &arm.model.structure.geometry {
                row.copy_from_slice(geometry.shift_of_motions().as_slice());
            }
        })
    }

    /// -> (n,) relative error of the deviation under load that no compliance explains.
    #[getter]
    fn model_error<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let errors = self.arms.iter().map(|arm| arm.model_error);
        array(py, &[self.arms.len()], errors.collect())
    }

    /// -> (n, 3) displacement of the TCP by scatter between repetitions, m, base axes.
    #[getter]
    fn scatter<'py>(&self, py: Python<'py>) -> Floats<'py> {
        self.table(py, 3, |arm, row| row.copy_from_slice(arm.scatter.as_slice()))
    }

    /// -> (n,) int: number of compliances, backlashes and masses that are 0 because the sample would be negative.
    #[getter]
    fn cut<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let counts = self.arms.iter().map(|arm| arm.cut as i64);
        array(py, &[self.arms.len()], counts.collect())
    }

    fn __len__(&self) -> usize {
        self.arms.len()
    }

    fn __getitem__(&self, py: Python<'_>, part: &Bound<'_, PySlice>) -> PyResult<Samples> {
        let indices = part.indices(self.arms.len() as isize)?;
        let mut z = Vec::with_capacity(indices.slicelength * self.inputs);
        for place in 0..indices.slicelength as isize {
            let row = (indices.start + place * indices.step) as usize;
            z.extend_from_slice(&self.z[row * self.inputs..][..self.inputs]);
        }
        Samples::of(self.robot.bind(py), z)
    }

    fn __repr__(&self) -> String {
        format!(
            "<armill.Samples of {}: {} samples of {} inputs>",
            self.source.name(),
            self.arms.len(),
            self.inputs
        )
    }

    fn _repr_html_(&self) -> String {
        /// Samples that a notebook shows.
        const SHOWN: usize = 10;
        let caption = format!("{}: {} samples", self.source.name(), self.arms.len());
        let rows = self.z.chunks(self.inputs.max(1)).take(SHOWN);
        let cells = rows.map(|row| row.iter().map(|z| format!("{z:.3}")).collect());
        html::table(&caption, &self.robot.get().input_names(), cells)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts<'py>)> {
        let py = slf.py();
        let again = slf.get_type().getattr("_again")?;
        let samples = slf.get();
        Ok((again, (samples.robot.clone_ref(py), samples.z(py)?.into_any())))
    }

    #[staticmethod]
    fn _again(robot: &Bound<'_, Robot>, z: PyReadonlyArrayDyn<'_, f64>) -> PyResult<Samples> {
        Samples::of(robot, z.as_array().iter().copied().collect())
    }
}

containers!(Samples);

/// The parts that a pickle keeps: the robot, and the standard normal numbers.
type Parts<'py> = (Py<Robot>, Bound<'py, PyAny>);

/// Standard normal numbers (n, inputs).
///
/// # Errors
/// Another shape, numbers that are not finite.
pub(crate) fn standard_normal(robot: &Robot, z: &Bound<'_, PyAny>, inputs: usize) -> PyResult<Vec<f64>> {
    let expected = format!("(n, {inputs})");
    let given = Given::of(z, "z", &expected)?;
    if given.shape().len() != 2 || given.shape()[1] != inputs {
        let names = robot.input_names().join(", ");
        return Err(wrong_shape(
            z.py(),
            "z",
            &format!("{expected}, for {names}"),
            given.shape(),
        ));
    }
    given.finite(z.py(), "z")?;
    Ok(given.values().to_vec())
}
