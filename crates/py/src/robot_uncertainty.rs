//! The class `Robot`, continued: its uncertain inputs, samples of them, covariances, springs.

use armill_core::frame::Isometry;
use armill_core::nalgebra::DMatrix;
use armill_core::robot::SmallMotion;
use armill_core::sampling::{Draws, MOST_DIMENSIONS, Method, SampledInput};
use armill_core::source::{Arm, Contributor, standard_uncertainties};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::errors::refused;
use crate::joint_evaluation::Loads;
use crate::joint_positions;
use crate::robot::Robot;
use crate::robot_class::request;
use crate::samples::{Samples, standard_normal};
use crate::springs::Varied;
use crate::threads::ThreadCount;

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Points of a Sobol sequence.
const MOST_POINTS: u64 = 1 << 32;

#[pymethods]
impl Robot {
    /// -> (dof,) standard uncertainty of each joint compliance, rad/(N m) (m/N); None if the compliances are not known.
    #[getter]
    fn standard_uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        if self.arm().compliance().is_none() {
            return Ok(None);
        }
        let mut u = standard_uncertainties(&self.covariance_of_springs());
        u.truncate(self.dof());
        array(py, &[self.dof()], u).map(Some)
    }

    /// -> list of str: names of all springs, the joints first, as in `spring_jacobian` and `spring_compliance`.
    #[getter]
    fn spring_names(&self) -> Vec<String> {
        let mut names = self.joint_names();
        let mut counts = std::collections::BTreeMap::new();
        for spring in &self.model.structure.springs {
            let at = Contributor::At(spring.attachment).name(self.arm().joints());
            let count = counts.entry(at.clone()).or_insert(0);
            *count += 1;
            names.push(format!("{at} spring {count}"));
        }
        names
    }

    /// -> (springs,) compliance of each joint, then of each further spring, rad/(N m) (m/N); None if not known.
    #[getter]
    fn spring_compliance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        let Some(known) = self.arm().compliance() else {
            return Ok(None);
        };
        let springs = &self.model.structure.springs;
        let springs = springs.iter().map(|spring| spring.compliance.value);
        let values: Vec<f64> = known.iter().map(|joint| joint.value).chain(springs).collect();
        array(py, &[values.len()], values).map(Some)
    }

    /// -> (springs, springs) covariance of `spring_compliance`, rad^2/(N m)^2; None if the compliances are not known.
    #[getter]
    fn compliance_covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        if self.arm().compliance().is_none() {
            return Ok(None);
        }
        let covariance = self.covariance_of_springs();
        let size = covariance.nrows();
        array(py, &[size, size], covariance.as_slice().to_vec()).map(Some)
    }

    /// -> list of str: names of the uncertain small motions of the geometry; none if their covariance is not known.
    #[getter]
    fn geometry_motions(&self) -> Vec<String> {
        let known = self.model.structure.geometry.as_ref();
        let motions = known.map_or(&[] as &[_], |geometry| geometry.motions());
        let name = |motion: &SmallMotion| {
            let joint = &self.arm().joints()[motion.after].name;
            let way = if motion.component < 3 { "along" } else { "about" };
            format!("{joint} {way} {}", ["x", "y", "z"][motion.component % 3])
        };
        motions.iter().map(name).collect()
    }

    /// -> (motions, motions) covariance of `geometry_motions`, m and rad.
    #[getter]
    fn geometry_covariance<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let known = self.model.structure.geometry.as_ref();
        let covariance = known.map_or_else(|| DMatrix::zeros(0, 0), |geometry| geometry.covariance());
        let size = covariance.nrows();
        array(py, &[size, size], covariance.as_slice().to_vec())
    }

    /// -> list of dict: the independent uncertain inputs, in the order of `Samples.z`.
    ///
    /// `name`; `source`: `compliance`, `backlash`, `backlash side`, `mass`, `geometry`, `learnt`, `model error` or `repeatability`;
    /// `contributors`: the joints, `base`, `flange`, `tool`, `geometry` or `learnt` that it changes. Inputs of correlated
    /// compliances are the axes of their covariance.
    #[getter]
    fn uncertain_inputs<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let (space, joints) = (self.input_space(), self.arm().joints());
        let names = space.names(joints).into_iter();
        let entry = |(name, input): (String, &SampledInput)| {
            let entry = PyDict::new(py);
            entry.set_item("name", name)?;
            entry.set_item("source", input.source.name())?;
            let contributors = input.contributors.iter();
            let contributors: Vec<String> =
                contributors.map(|contributor| contributor.name(joints)).collect();
            entry.set_item("contributors", contributors)?;
            Ok(entry)
        };
        names.zip(space.inputs()).map(entry).collect()
    }

    /// n -> Samples: n samples of all uncertain inputs of the robot file.
    ///
    /// `method` is `sobol`, a scrambled Sobol sequence (best with a power of two), or `random`. Sample i depends on
    /// `seed` and i alone: `first` is the index of the first one, for samples in parts. Inputs have normal distributions
    /// with the standard uncertainties and covariances of the file; negative compliances, backlashes and masses become 0.
    #[pyo3(signature = (n, method="sobol", *, seed=0, first=0))]
    fn sample(slf: &Bound<'_, Self>, n: usize, method: &str, seed: u64, first: u64) -> PyResult<Samples> {
        let (py, robot) = (slf.py(), slf.get());
        let inputs = robot.sampled_inputs(py)?;
        let draws = draws(py, n, (method, inputs), seed, first)?;
        Samples::of(slf, py.detach(|| draws.normal(first, n)))
    }

    /// (n, inputs) standard normal numbers -> Samples: the values of the robot for numbers of your own.
    ///
    /// One column for each of `uncertain_inputs`: 1 is one standard uncertainty above the value of the file.
    fn samples_at(slf: &Bound<'_, Self>, z: &Bound<'_, PyAny>) -> PyResult<Samples> {
        let inputs = slf.get().sampled_inputs(slf.py())?;
        Samples::of(slf, standard_normal(slf.get(), z, inputs)?)
    }

    /// (n, dof) joints, (cases, 3) forces -> (n, cases, 3, 3) covariance of the deviation, m^2, base axes.
    ///
    /// By the law of propagation of uncertainty, from all inputs that have one. `forces`, `paired` and `all_sources` are those
    /// of `deviation`: without `all_sources` the compliances and their model error alone.
    #[pyo3(signature = (joints, forces, tool=None, *, paired=false, all_sources=false, out=None, threads=None))]
    fn deviation_covariance<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        paired: bool,
        all_sources: bool,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, Varied::default(), out, threads);
        let loads = Loads {
            forces,
            paired,
            all_sources,
        };
        joint_positions::covariance(self, &request, &loads)
    }

    /// (n, dof) joints -> (n, 6, springs) Jacobians: twist of the TCP per unit of deflection of each spring, base axes.
    ///
    /// Translation first; `spring_names` has the columns. Joints deflect in the chain: of coupled arms the columns differ from
    /// those of `jacobian`. Without torque curves and compensator, `compliance` is `J @ diag(spring_compliance) @ J.T`.
    #[pyo3(signature = (joints, tool=None, *, out=None, threads=None))]
    fn spring_jacobian<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, Varied::default(), out, threads);
        joint_positions::spring_jacobian(self, &request)
    }
}

/// n, inputs -> (n, inputs) independent standard normal numbers.
///
/// `method` is `sobol`, a scrambled Sobol sequence (best with a power of two), or `random`. A number depends on `seed`,
/// row and column alone; `first` is the index of the first row. `Robot.samples_at` gives the samples of a robot for them.
#[pyfunction]
#[pyo3(signature = (n, inputs, method="sobol", *, seed=0, first=0))]
pub(crate) fn normal_draws<'py>(
    py: Python<'py>,
    n: usize,
    inputs: usize,
    method: &str,
    seed: u64,
    first: u64,
) -> Floats<'py> {
    let draws = draws(py, n, (method, inputs), seed, first)?;
    array(py, &[n, inputs], py.detach(|| draws.normal(first, n)))
}

/// Random or Sobol numbers, for `n` samples from index `first`.
fn draws(
    py: Python<'_>,
    n: usize,
    (method, inputs): (&str, usize),
    seed: u64,
    first: u64,
) -> PyResult<Draws> {
    let method = match method {
        "random" => Method::Random,
        "sobol" => Method::Sobol,
        other => {
            let message = format!("method: `{other}` is not a valid method");
            return Err(refused(py, message, "`sobol` or `random`"));
        }
    };
    if method == Method::Sobol && inputs > MOST_DIMENSIONS {
        let message = format!("a Sobol sequence has at most {MOST_DIMENSIONS} inputs, given {inputs}");
        return Err(refused(py, message, "method=\"random\""));
    }
    let last = first.checked_add(n as u64);
    if last.is_none_or(|last| method == Method::Sobol && last > MOST_POINTS) {
        let message = format!("samples {first} to {first} + {n} are more than a sequence has");
        return Err(refused(py, message, "method=\"random\", or a smaller index"));
    }
    Ok(Draws { method, seed, inputs })
}

impl Robot {
    /// Number of its uncertain inputs.
    ///
    /// # Errors
    /// None: there is nothing to sample.
    fn sampled_inputs(&self, py: Python<'_>) -> PyResult<usize> {
        self.compliances(py)?;
        match self.input_space().inputs().len() {
            0 => {
                let message = format!("robot `{}` has no uncertainties", self.arm().name());
                let hint =
                    "give them: `robot.with_compliance(values, standard_uncertainty)`, or in the robot file";
                Err(refused(py, message, hint))
            }
            inputs => Ok(inputs),
        }
    }

    /// Covariance of the compliances of drives, then springs.
    fn covariance_of_springs(&self) -> DMatrix<f64> {
        let arm = Arm {
            robot: self.arm(),
            compliance: self.arm().compliance().unwrap_or_default(),
            model: &self.model,
            flange_from_tool: &Isometry::identity(),
        };
        arm.compliance_covariance()
    }
}
