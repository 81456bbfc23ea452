//! The class `Robot`: a robot of the library or of a file, evaluated at many joint positions or poses at once.
//!
//! Results are made in `joint_positions`, `postures` and `evaluation`.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;

use armill_formats::robot::format::Format;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::array;
use crate::errors::refused;
use crate::evaluation::{self, EvaluationOptions, PoseEvaluations};
use crate::export::{self, Word};
use crate::html;
use crate::joint_evaluation::{Loads, Request};
use crate::joint_positions;
use crate::postures::{self, Postures};
use crate::robot::Robot;
use crate::samples::Samples;
use crate::source::{self, GivenCompliance, RobotSource};
use crate::springs::Varied;
use crate::threads::ThreadCount;

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Joint positions with tool, compliances and output.
pub(crate) fn request<'a, 'py>(
    joints: &'a Bound<'py, PyAny>,
    tool: Optional<'a, 'py>,
    varied: Varied<'a, 'py>,
    out: Optional<'a, 'py>,
    threads: Option<ThreadCount>,
) -> Request<'a, 'py> {
    Request {
        joints,
        tool,
        varied,
        out,
        threads,
    }
}

/// Compliances or samples in place of those of the robot.
pub(crate) fn varied<'a, 'py>(
    compliances: Optional<'a, 'py>,
    samples: Option<&'a Bound<'py, Samples>>,
) -> Varied<'a, 'py> {
    Varied { compliances, samples }
}

#[pymethods]
impl Robot {
    /// name or path -> Robot: from the library (`yaskawa/mh12`), or from a robot file of any format (TOML, URDF, xacro, OPW,
    /// Denavit-Hartenberg, chain).
    #[staticmethod]
    fn load(py: Python<'_>, robot: PathBuf) -> PyResult<Robot> {
        Robot::read(py, RobotSource::load(py, &robot)?)
    }

    /// path -> Robot: from a URDF or xacro file; `flange` is the name of a link, by default the end of the longest chain.
    #[staticmethod]
    #[pyo3(signature = (path, flange=None))]
    fn from_urdf(py: Python<'_>, path: PathBuf, flange: Option<String>) -> PyResult<Robot> {
        Robot::read(py, RobotSource::urdf(py, &path, flange)?)
    }

    /// text -> Robot: from the text of a robot file; `format` is `armill`, `urdf`, `opw`, `ur`, `dh` or `chain`.
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
            .map_err(|message: String| refused(py, message, "give the format of the text"))?;
        Robot::read(py, RobotSource::text(format, name, text, flange))
    }

    /// (dof, 4) rows a, alpha, d, theta -> Robot: Denavit-Hartenberg, m and rad, at the controller's zero.
    ///
    /// `convention` is `standard` or `modified` (Craig); `prismatic` lists the joints, from 0, that move along d; `limits`
    /// (dof, 2) in rad or m.
    #[staticmethod]
    #[pyo3(
        signature = (rows, convention, *, prismatic=Vec::new(), limits=None, name="robot"),
        text_signature = "(rows, convention, *, prismatic=(), limits=None, name='robot')"
    )]
    fn from_dh(
        py: Python<'_>,
        rows: &Bound<'_, PyAny>,
        convention: &str,
        prismatic: Vec<usize>,
        limits: Optional<'_, '_>,
        name: &str,
    ) -> PyResult<Robot> {
        let text = source::dh_text(py, rows, convention, &prismatic, limits)?;
        Robot::read(py, RobotSource::text(Format::Dh, name, text, None))
    }

    /// seven lengths in m, (6,) offsets in rad, (6,) signs -> Robot: an ortho-parallel arm with a spherical wrist (OPW), with
    /// the parameters of MoveIt.
    #[staticmethod]
    #[pyo3(
        signature = (*, a1, a2, b, c1, c2, c3, c4, offsets=[0.0; 6], signs=[1; 6], name="robot"),
        text_signature = "(*, a1, a2, b, c1, c2, c3, c4, offsets=(0, 0, 0, 0, 0, 0), signs=(1, 1, 1, 1, 1, 1), name='robot')"
    )]
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

    /// -> str: name in the library, or of its file.
    #[getter]
    fn name(&self) -> &str {
        self.arm().name()
    }

    /// -> str: manufacturer and model.
    #[getter]
    fn title(&self) -> &str {
        &self.description.title
    }

    /// -> int: number of joints.
    #[getter(dof)]
    fn dof_of_class(&self) -> usize {
        self.dof()
    }

    /// -> list of str, one per joint: the names of the manufacturer.
    #[getter(joint_names)]
    fn joint_names_of_class(&self) -> Vec<String> {
        self.joint_names()
    }

    /// -> list of str: names along the axis of `contributions`: the joints, then those of `base`, `flange`, `tool` with springs.
    #[getter(contributors)]
    fn contributors_of_class(&self) -> Vec<String> {
        self.contributor_names()
    }

    /// -> (dof, 2) lower and upper limit, rad (m): minus and plus infinity for a joint without limits.
    #[getter]
    fn limits<'py>(&self, py: Python<'py>) -> Floats<'py> {
        let limits = self.arm().joints().iter().flat_map(|joint| match joint.limits {
            Some(limits) => [limits.lower, limits.upper],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        });
        array(py, &[self.dof(), 2], limits.collect())
    }

    /// -> (dof,) compliance of each joint, rad/(N m) (prismatic: m/N); None if not known.
    #[getter]
    fn joint_compliance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArrayDyn<f64>>>> {
        let known = self.arm().compliance();
        let values = known.map(|all| all.iter().map(|joint| joint.value).collect());
        values.map(|values| array(py, &[self.dof()], values)).transpose()
    }

    /// (dof,) compliances, (dof,) standard uncertainties -> Robot: the same with other joint compliances, rad/(N m) (m/N).
    ///
    /// A covariance (dof, dof) may be given in place of the standard uncertainties. `source` states where the compliances come
    /// from, for `to_toml`; by default "given". Torque curves and covariance of the file are dropped: they belong to the
    /// compliances that are replaced.
    #[pyo3(signature = (compliance, standard_uncertainty=None, *, source=None))]
    fn with_compliance(
        &self,
        py: Python<'_>,
        compliance: &Bound<'_, PyAny>,
        standard_uncertainty: Optional<'_, '_>,
        source: Option<String>,
    ) -> PyResult<Robot> {
        let values = self.one_a_joint(compliance, "compliance")?;
        let (uncertainties, covariance) = match standard_uncertainty {
            Some(given) => self.uncertainty(given, "standard_uncertainty")?,
            None => (vec![0.0; values.len()], None),
        };
        self.with(
            py,
            GivenCompliance {
                values,
                uncertainties,
                covariance,
                source,
            },
        )
    }

    /// -> str: the robot as a robot file of armill, with seven digits of each given compliance.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.source.toml(py)
    }

    /// -> str: the robot as a URDF. `coupling` of coupled joints is `own` (the angle between the links) or `mimic` (a joint follows).
    #[pyo3(signature = (*, coupling=None))]
    fn to_urdf(&self, py: Python<'_>, coupling: Word<'_>) -> PyResult<String> {
        export::rigid(self, py, "urdf", [coupling, None])
    }

    /// -> str: the robot as an SDF model. `stiffness` is `passive` (a spring joint behind each drive) or `joints` (each joint is
    /// a spring at `joints`, (dof,) in rad and m).
    #[pyo3(signature = (*, stiffness=None, joints=None, coupling=None))]
    fn to_sdf(
        &self,
        py: Python<'_>,
        stiffness: Word<'_>,
        joints: Optional<'_, '_>,
        coupling: Word<'_>,
    ) -> PyResult<String> {
        export::elastic(self, py, "sdf", &([stiffness, coupling], joints))
    }

    /// -> str: the robot as a model of MuJoCo (MJCF), with the options of `to_sdf`; `joints` are also its key frame.
    #[pyo3(signature = (*, stiffness=None, joints=None, coupling=None))]
    fn to_mjcf(
        &self,
        py: Python<'_>,
        stiffness: Word<'_>,
        joints: Optional<'_, '_>,
        coupling: Word<'_>,
    ) -> PyResult<String> {
        export::elastic(self, py, "mjcf", &([stiffness, coupling], joints))
    }

    /// -> str: the robot as a Denavit-Hartenberg table (CSV). `convention` is `standard`, `modified` or `hayati`.
    #[pyo3(signature = (convention="standard", *, coupling=None))]
    fn to_dh(&self, py: Python<'_>, convention: &str, coupling: Word<'_>) -> PyResult<String> {
        export::rigid(self, py, "dh", [coupling, Some(convention)])
    }

    /// -> str: the robot as a calibration file of ur_description (YAML).
    fn to_ur(&self, py: Python<'_>) -> PyResult<String> {
        export::rigid(self, py, "ur", [None, None])
    }

    /// (n, dof) joints -> (n, 4, 4) poses, base_from_tool.
    ///
    /// `tool` (4, 4) is flange_from_tool. rad and m. `out` is the array to write.
    #[pyo3(signature = (joints, tool=None, *, out=None, threads=None))]
    fn forward<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, Varied::default(), out, threads);
        joint_positions::forward(self, &request)
    }

    /// (n, dof) joints -> (n, 6, dof) Jacobians: twist of the TCP per unit of joint position, translation first, base axes.
    #[pyo3(signature = (joints, tool=None, *, out=None, threads=None))]
    fn jacobian<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, Varied::default(), out, threads);
        joint_positions::jacobian(self, &request)
    }

    /// (n, dof) joints -> (n, 6, 6) compliances at the TCP, translation first, base axes; m/N, 1/N, rad/(N m).
    ///
    /// All compliances of the robot file are included: drives, springs, torque curves and compensator. `compliances` (dof,)
    /// or samples (s, dof), rad/(N m), are used in place of those of the joints; samples give (s, n, 6, 6). `samples` are those
    /// of `Robot.sample`.
    #[pyo3(signature = (joints, tool=None, *, compliances=None, samples=None, out=None, threads=None))]
    fn compliance<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        compliances: Optional<'_, 'py>,
        samples: Option<&Bound<'py, Samples>>,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, varied(compliances, samples), out, threads);
        joint_positions::compliance(self, &request)
    }

    /// (n, dof) joints, (cases, 3) forces -> (n, cases, 3) deviations of the TCP, m, base axes.
    ///
    /// `forces` are forces (cases, 3) in N or wrenches (cases, 6) in N and N m on the tool at the TCP, base axes; one case
    /// (3,) or (6,) gives (n, 3). With `paired=True` there is one force for each of the joint positions, (n, 3), which gives
    /// (n, 3). `compliances` (dof,) or samples (s, dof), rad/(N m), are used in place of those of the robot; samples give
    /// (s, n, cases, 3). `samples` are those of `Robot.sample`. With `all_sources=True` geometry, learnt residual and backlash
    /// are included, and the scatter of samples; the backlash is in its middle where no torque decides its side. `out` is the
    /// array to write.
    #[pyo3(
        signature = (
            joints, forces, tool=None, *, paired=false, compliances=None, samples=None, all_sources=false, out=None,
            threads=None
        )
    )]
    fn deviation<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        paired: bool,
        compliances: Optional<'_, 'py>,
        samples: Option<&Bound<'py, Samples>>,
        all_sources: bool,
        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, varied(compliances, samples), out, threads);
        let loads = Loads {
            forces,
            paired,
            all_sources,
        };
        joint_positions::deviation(self, &request, &loads)
    }

    /// (n, dof) joints, (cases, 3) forces -> (n, cases, contributors, 3) contributions to the deviation, m, base axes.
    ///
    /// They add up to the deviation. `Robot.contributors` has the names: the joints, then base, flange and tool with springs.
    /// The options are those of `deviation`.
    #[pyo3(
        signature = (
            joints, forces, tool=None, *, paired=false, compliances=None, samples=None, out=None,
            threads=None
        )
    )]
    fn contributions<'py>(
        &self,
        joints: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        tool: Optional<'_, 'py>,
        paired: bool,
        compliances: Optional<'_, 'py>,
        samples: Option<&Bound<'py, Samples>>,

        out: Optional<'_, 'py>,
        threads: Option<ThreadCount>,
    ) -> Floats<'py> {
        let request = request(joints, tool, varied(compliances, samples), out, threads);
        let loads = Loads {
            forces,
            paired,
            all_sources: false,
        };
        joint_positions::contributions(self, &request, &loads)
    }

    /// (n, dof) joints -> list of n str: the branch at each of the joint positions.
    ///
    /// For an arm without named branches, the side of its mid-position of each joint.
    fn branch_of(&self, joints: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
        let names = joint_positions::branches(self, joints)?;
        Ok(names.iter().map(ToString::to_string).collect())
    }

    /// (n, 4, 4) poses -> Postures: all postures at each pose, base_from_tool.
    ///
    /// For an arm without closed form, those that a search finds. `home` (dof,) gives the position of a rail and the
    /// positions that redundant joints prefer.
    #[pyo3(signature = (poses, tool=None, *, home=None, threads=None))]
    fn inverse(
        &self,
        poses: &Bound<'_, PyAny>,
        tool: Optional<'_, '_>,
        home: Optional<'_, '_>,
        threads: Option<ThreadCount>,
    ) -> PyResult<Postures> {
        postures::inverse(self, poses, tool, home, threads)
    }

    /// (n, 4, 4) poses, (cases, 3) forces -> Evaluation: one posture for each pose, and the deviation of the tool there.
    ///
    /// `branch` is the name of a branch (`front elbow-up no-flip`), `nominal`, or `best`: the posture inside the joint limits
    /// with the smallest deviation. `normal` (3,) is the outward normal of the plane into which deviations are split. By
    /// default it is opposite to the tool direction, which must then be the same at all poses. With `paired=True` there is one
    /// force for each pose. `compliances` (dof,) or samples (s, dof) are used in place of those of the robot; arrays then have
    /// the axis of the samples first. `samples` are those of `Robot.sample`, without their model error and scatter. Backlash of
    /// the robot file is included on the side that gives the largest in-plane deviation; `Robot.deviation`, at joint
    /// positions, includes the load only.
    #[pyo3(
        signature = (
            poses, forces, tool=None, *, branch="nominal", normal=None, home=None, paired=false, compliances=None,
            samples=None, threads=None
        )
    )]
    fn evaluate(
        &self,
        poses: &Bound<'_, PyAny>,
        forces: &Bound<'_, PyAny>,
        tool: Optional<'_, '_>,
        branch: &str,
        normal: Optional<'_, '_>,
        home: Optional<'_, '_>,
        paired: bool,
        compliances: Optional<'_, '_>,
        samples: Option<&Bound<'_, Samples>>,
        threads: Option<ThreadCount>,
    ) -> PyResult<PoseEvaluations> {
        let options = EvaluationOptions {
            branch,
            normal,
            home,
            paired,
            varied: varied(compliances, samples),
            threads,
        };
        evaluation::evaluate(self, poses, forces, tool, &options)
    }

    /// Whether the other robot was read from the same text under the same name, with the same given compliances.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Robot>();
        other.is_ok_and(|other| other.get().source.is_same(&self.source))
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.name().hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        format!("<armill.Robot {}: {} joints>", self.name(), self.dof())
    }

    fn _repr_html_(&self) -> String {
        html::robot(self)
    }

    /// How to make it again, from the text that it was read from.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, source::Parts<'py>)> {
        let py = slf.py();
        let again = slf.get_type().getattr("_again")?;
        Ok((again, slf.get().source.parts(py)))
    }

    #[staticmethod]
    fn _again(
        py: Python<'_>,
        file: (PathBuf, String, Bound<'_, PyBytes>),
        format: (String, Option<String>),
        compliance: Option<source::GivenParts>,
    ) -> PyResult<Robot> {
        let robot = Robot::read(py, RobotSource::again(py, file, format)?)?;
        match compliance {
            Some(parts) => robot.with(py, GivenCompliance::of(parts)),
            None => Ok(robot),
        }
    }
}
