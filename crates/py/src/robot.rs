//! The class `Robot`: a robot of the library or of a file, and what it answers about many poses at once.
//!
//! `source` tells how it is made again in another process; what is computed stands in `stands`, `postures` and `held`.

use std::path::PathBuf;
use std::sync::Arc;

use armill_core::nalgebra::Vector3;
use armill_core::robot::{JointCompliance, Robot as Arm};
use armill_core::source::StiffnessModel;
use armill_core::source::stiffness_model::FREE_FALL;
use armill_formats::robot::RobotDescription;
use armill_formats::robot::format::Format;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::{Given, array, wrong_shape};
use crate::errors::refused;
use crate::evaluation::{self, Held};
use crate::postures::{self, Postures};
use crate::source::{self, RobotSource};
use crate::stands;

/// A robot: its chain, its joints, what yields in it. It never changes.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Robot {
    source: Arc<RobotSource>,
    pub(crate) description: RobotDescription,
    pub(crate) model: StiffnessModel,
}

impl Robot {
    fn of(source: RobotSource, description: RobotDescription) -> Robot {
        let model = StiffnessModel {
            structure: description.robot.structure().clone(),
            gravity: None,
            load_dependent: false,
            actual: None,
        };
        Robot {
            source: Arc::new(source),
            description,
            model,
        }
    }

    fn read(py: Python<'_>, source: RobotSource) -> PyResult<Robot> {
        let description = source.read(py)?;
        Ok(Robot::of(source, description))
    }

    pub(crate) fn arm(&self) -> &Arm {
        &self.description.robot
    }

    /// What its joints yield.
    ///
    /// # Errors
    /// A robot of which that is not known.
    pub(crate) fn compliances(&self, py: Python<'_>) -> PyResult<&[JointCompliance]> {
        self.arm().compliance().ok_or_else(|| {
            let message = format!("robot `{}` has no joint compliance", self.arm().name());
            refused(
                py,
                message,
                "give it some: `robot.with_compliance([...])`, rad/(N m), one a joint",
            )
        })
    }

    /// Joint positions where a rail stands and what joints to spare are drawn to.
    pub(crate) fn home(&self, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<f64>>> {
        value.map(|value| self.one_a_joint(value, "home")).transpose()
    }

    /// A number for each joint.
    fn one_a_joint(&self, value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
        let requested = format!("({},)", self.dof());
        let given = Given::of(value, name, &requested)?;
        if given.shape() != [self.dof()] {
            return Err(wrong_shape(value.py(), name, &requested, given.shape()));
        }
        given.finite(value.py(), name)?;
        Ok(given.values().to_vec())
    }
}

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

#[pymethods]
impl Robot {
    /// name or path -> Robot: of the library (`yaskawa/mh12`), or of a robot file of any format (TOML, URDF, xacro, OPW,
    /// Denavit-Hartenberg, chain).
    #[staticmethod]
    fn load(py: Python<'_>, robot: PathBuf) -> PyResult<Robot> {
        Robot::read(py, RobotSource::load(py, &robot)?)
    }

    /// path -> Robot: of a URDF (or xacro) file; the flange is the link of that name, else the one at the end of the longest
    /// chain.
    #[staticmethod]
    #[pyo3(signature = (path, flange=None))]
    fn from_urdf(py: Python<'_>, path: PathBuf, flange: Option<String>) -> PyResult<Robot> {
        Robot::read(py, RobotSource::urdf(py, &path, flange)?)
    }

    /// text -> Robot: of the text of a robot file; `format` is `armill`, `urdf`, `opw`, `dh` or `chain`.
    #[staticmethod]
    #[pyo3(signature = (text, format, name="robot", flange=None))]
    fn from_text(
        py: Python<'_>,
        text: String,
        format: &str,
        name: &str,
        flange: Option<String>,
    ) -> PyResult<Robot> {
        let format: Format = format
            .parse()
            .map_err(|message: String| refused(py, message, "name the format of the text"))?;
        Robot::read(py, RobotSource::text(format, name, text, flange))
    }

    /// (dof, 4) rows a, alpha, d, theta -> Robot: Denavit-Hartenberg, m and rad, at the controller's zero.
    ///
    /// `convention` is `standard` or `modified` (Craig); `sliding` names the joints, from 0, that slide along d; `limits`
    /// (dof, 2) in rad or m.
    #[staticmethod]
    #[pyo3(signature = (rows, convention, *, sliding=Vec::new(), limits=None, name="robot"))]
    fn from_dh(
        py: Python<'_>,
        rows: &Bound<'_, PyAny>,
        convention: &str,
        sliding: Vec<usize>,
        limits: Optional<'_, '_>,
        name: &str,
    ) -> PyResult<Robot> {
        let text = source::dh_text(py, (rows, convention), &sliding, limits)?;
        Robot::read(py, RobotSource::text(Format::Dh, name, text, None))
    }

    /// seven lengths in m, (6,) offsets in rad, (6,) signs -> Robot: an ortho-parallel arm with spherical wrist, as MoveIt
    /// keeps it.
    #[staticmethod]
    #[pyo3(signature = (*, a1, a2, b, c1, c2, c3, c4, offsets=[0.0; 6], signs=[1; 6], name="robot"))]
    fn from_opw(
        py: Python<'_>,
        a1: f64,
        a2: f64,
        b: f64,
        c1: f64,
        c2: f64,
        c3: f64,
        c4: f64,
        offsets: [f64; 6],
        signs: [i64; 6],
        name: &str,
    ) -> PyResult<Robot> {
        let text = source::opw_text([a1, a2, b, c1, c2, c3, c4], offsets, signs);
        Robot::read(py, RobotSource::text(Format::Opw, name, text, None))
    }

    /// -> str: its name in the library, or of its file.
    #[getter]
    fn name(&self) -> &str {
        self.arm().name()
    }

    /// -> str: maker and type.
    #[getter]
    fn title(&self) -> &str {
        &self.description.title
    }

    /// -> int: how many joints it has.
    #[getter]
    pub(crate) fn dof(&self) -> usize {
        self.arm().joints().len()
    }

    /// -> list of str, one a joint: as the maker calls them.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.arm()
            .joints()
            .iter()
            .map(|joint| joint.name.clone())
            .collect()
    }

    /// -> list of str: whom shares are told for: the joints, then `base`, `flange`, `tool` where springs sit.
    #[getter]
    fn contributors(&self) -> Vec<String> {
        self.model.contributor_names(self.arm().joints())
    }

    /// -> (dof, 2) least and greatest position, rad (m): minus and plus infinity where a joint has no limits.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let limits = self.arm().joints().iter().flat_map(|joint| match joint.limits {
            Some(limits) => [limits.lower, limits.upper],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        });
        array(py, &[self.dof(), 2], limits.collect())
    }

    /// -> (dof,) what each joint yields, rad/(N m) (m/N of a sliding one); None where that is not known.
    #[getter]
    fn joint_compliance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        let known = self.arm().compliance();
        let values = known.map(|all| all.iter().map(|joint| joint.value).collect());
        values.map(|values| array(py, &[self.dof()], values)).transpose()
    }

    /// (dof,) compliances, (dof,) standard uncertainties -> Robot: the same with other joint compliances, rad/(N m) (m/N).
    ///
    /// Torque curves and covariance of the file go, since they were of the compliances that these replace.
    #[pyo3(signature = (compliance, standard_uncertainty=None))]
    fn with_compliance(
        &self,
        py: Python<'_>,
        compliance: &Bound<'_, PyAny>,
        standard_uncertainty: Optional<'_, '_>,
    ) -> PyResult<Robot> {
        let values = self.one_a_joint(compliance, "compliance")?;
        let uncertainties = match standard_uncertainty {
            Some(uncertainties) => self.one_a_joint(uncertainties, "standard_uncertainty")?,
            None => vec![0.0; values.len()],
        };
        let given = values.iter().zip(&uncertainties).map(|(value, uncertainty)| JointCompliance {
            value: *value,
            standard_uncertainty: *uncertainty,
        });
        let mut description = self.description.clone();
        let robot = description.robot.with_other_compliance(given.collect());
        description.robot =
            robot.map_err(|error| refused(py, error.to_string(), "rad/(N m), one a joint, 0 or more"))?;
        let source = self.source.with_compliance(values, uncertainties);
        Ok(Robot::of(source, description))
    }

    /// -> str: the robot as a robot file of armill, seven digits of each compliance that was given.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.source.toml(py)
    }

    /// (n, dof) joints -> (n, 4, 4) poses, base_from_tool.
    ///
    /// `tool` (4, 4) is flange_from_tool. rad and m.
    #[pyo3(signature = (joints, tool=None, *, threads=None))]
    fn forward<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        threads: Option<usize>,
    ) -> Floats<'py> {
        stands::forward(self, joints, tool, threads)
    }

    /// (n, dof) joints -> (n, 6, dof) Jacobians: twist of the TCP per unit of joint position, translation first, base axes.
    #[pyo3(signature = (joints, tool=None, *, threads=None))]
    fn jacobian<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        threads: Option<usize>,
    ) -> Floats<'py> {
        stands::jacobian(self, joints, tool, threads)
    }

    /// (n, dof) joints -> (n, 6, 6) compliances at the TCP, translation first, base axes; m/N, 1/N, rad/(N m).
    ///
    /// Everything that yields is in it: drives, springs, torque curves and compensator of the robot file.
    #[pyo3(signature = (joints, tool=None, *, threads=None))]
    fn compliance<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        threads: Option<usize>,
    ) -> Floats<'py> {
        stands::compliance(self, joints, tool, threads)
    }

    /// (n, dof) joints, (cases, 3) forces -> (n, cases, 3) deviations of the TCP, m, base axes.
    ///
    /// `forces` are forces (cases, 3) in N or wrenches (cases, 6) in N and N m on the tool at the TCP, base axes; one case
    /// (3,) or (6,) gives (n, 3).
    #[pyo3(signature = (joints, forces, tool=None, *, threads=None))]
    fn deviation<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        threads: Option<usize>,
    ) -> Floats<'py> {
        stands::deviation(self, (joints, forces), tool, threads)
    }

    /// (n, dof) joints, (cases, 3) forces -> (n, cases, contributors, 3) shares of the deviation, m, base axes.
    ///
    /// They add up to the deviation. `Robot.contributors` names them: the joints, then base, flange and tool where springs sit.
    #[pyo3(signature = (joints, forces, tool=None, *, threads=None))]
    fn shares<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        threads: Option<usize>,
    ) -> Floats<'py> {
        stands::shares(self, (joints, forces), tool, threads)
    }

    /// (n, dof) joints, (dof,) reference -> (n, 3) deviations of the TCP by the weight of the arm, m, base axes.
    ///
    /// Less that at the joint positions `reference`, where the tool was set. The robot file must hold masses.
    /// `acceleration` (3,) is that of free fall in base axes, m/s^2.
    #[pyo3(signature = (joints, reference, tool=None, *, acceleration=[0.0, 0.0, -FREE_FALL], threads=None))]
    fn gravity<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        reference: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        acceleration: [f64; 3],
        threads: Option<usize>,
    ) -> Floats<'py> {
        let reference = self.one_a_joint(reference, "reference")?;
        stands::gravity(
            self,
            (joints, reference, Vector3::from(acceleration)),
            tool,
            threads,
        )
    }

    /// (n, 4, 4) poses -> Postures: every way to hold the tool at each pose, base_from_tool.
    ///
    /// Of an arm without closed form those that a search found. `home` (dof,) says where a rail stands and what joints to
    /// spare are drawn to.
    #[pyo3(signature = (poses, tool=None, *, home=None, threads=None))]
    fn inverse(
        &self,
        poses: &Bound<'_, PyAny>,
        tool: Optional<'_, '_>,
        home: Optional<'_, '_>,
        threads: Option<usize>,
    ) -> PyResult<Postures> {
        postures::inverse(self, (poses, tool), home, threads)
    }

    /// (n, 4, 4) poses, (cases, 3) forces -> Held: one posture for each pose, and how far the tool deviates there.
    ///
    /// `branch` is words of a branch (`front elbow-up no-flip`), `nominal`, or `best`: the posture inside the joint limits
    /// with the least deviation. `normal` (3,) is the outward normal of the plane that deviations are split on; without,
    /// the plane across the tool, which must then point the same way everywhere. Play of a robot file counts where it moves
    /// the tool farthest across that normal; in `deviation`, at joint positions, the load alone does.
    #[pyo3(signature = (poses, forces, tool=None, *, branch="nominal", normal=None, home=None, threads=None))]
    fn hold(
        &self,
        poses: &Bound<'_, PyAny>,
        forces: &Bound<'_, PyAny>,
        tool: Optional<'_, '_>,
        branch: &str,
        normal: Optional<'_, '_>,
        home: Optional<'_, '_>,
        threads: Option<usize>,
    ) -> PyResult<Held> {
        evaluation::hold(self, (poses, forces, tool), (branch, normal, home), threads)
    }

    fn __repr__(&self) -> String {
        format!("<armill.Robot {}: {} joints>", self.name(), self.dof())
    }

    /// How it is made again, from the very text that it was read from.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, source::Parts<'py>)> {
        let py = slf.py();
        let again = slf.get_type().getattr("_again")?;
        Ok((again, slf.get().source.parts(py)))
    }

    #[staticmethod]
    fn _again(
        py: Python<'_>,
        file: (PathBuf, String, Bound<'_, PyBytes>),
        requested: (String, Option<String>),
        compliance: Option<(Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Robot> {
        let robot = Robot::read(py, RobotSource::again(py, file, requested)?)?;
        let Some((values, uncertainties)) = compliance else {
            return Ok(robot);
        };
        let count = [values.len()];
        let values = array(py, &count, values)?;
        let uncertainties = array(py, &count, uncertainties)?;
        robot.with_compliance(py, values.as_any(), Some(uncertainties.as_any()))
    }
}
