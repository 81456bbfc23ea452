//! The class `Robot`, continued: what depends on its masses.

use armill_core::nalgebra::Vector3;
use armill_core::source::stiffness_model::FREE_FALL;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::joint_positions;
use crate::robot::Robot;
use crate::robot_class::{request, varied};
use crate::samples::Samples;
use crate::springs::Varied;
use crate::threads::ThreadCount;

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

#[pymethods]
impl Robot {
    /// (n, dof) joints -> (n, dof, dof) mass matrices over the joint positions, kg m^2 (kg m, kg).
    ///
    /// From the masses and motors of the robot file, or the inertials of a URDF. Rotors turn with their joints.
    #[pyo3(signature = (joints, *, out=None, threads=None))]
    fn mass_matrix<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, None, Varied::default(), out, threads);
        joint_positions::mass_matrix(self, &request)
    }

    /// (n, dof) joints -> (n, modes, 8) modes of vibration, frequencies rising.
    ///
    /// The last axis is: frequency in Hz, damping ratio, and the shape at the TCP normalised by mass, base axes: translation in
    /// 1/sqrt(kg), then rotation in rad/(m sqrt(kg)). There are as many rows as joints and springs; a motion without mass has
    /// an infinite frequency and shape 0. `compliances` and `samples` as for `compliance`.
    #[pyo3(signature = (joints, tool=None, *, compliances=None, samples=None, out=None, threads=None))]
    fn modes<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        compliances: Optional<'_, 'py>,
        samples: Option<&Bound<'py, Samples>>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, varied(compliances, samples), out, threads);
        joint_positions::modes(self, &request)
    }

    /// (n, dof) joints, (dof,) reference -> (n, 3) deviations of the TCP by the weight of the arm, m, base axes.
    ///
    /// They are relative to the joint positions `reference`, at which the tool was measured. The robot file must give the
    /// masses. `acceleration` (3,) is the acceleration of free fall in base axes, m/s^2; `samples` are those of `Robot.sample`.
    #[pyo3(
        signature = (
            joints, reference, tool=None, *, acceleration=[0.0, 0.0, -FREE_FALL], samples=None, out=None, threads=None
        ),
        text_signature = "($self, joints, reference, tool=None, *, acceleration=(0.0, 0.0, -9.80665), samples=None, out=None, threads=None)"
    )]
    fn gravity<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        reference: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        acceleration: [f64; 3],
        samples: Option<&Bound<'py, Samples>>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let reference = self.one_a_joint(reference, "reference")?;
        let request = request(joints, tool, varied(None, samples), out, threads);
        joint_positions::gravity(self, &request, reference, Vector3::from(acceleration))
    }
}
