//! The class `Evaluation`: one posture for each of many poses, and the deviation of the tool there.

use armill_core::kernel::{Answers, BranchChoice, Question, evaluate as evaluate_points};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::source::Arm;
use armill_core::workpiece::common_normal;
use armill_study::branch_choice_of;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::arrays::{Given, array, wrong_shape};
use crate::errors::{exception, refused};
use crate::poses::{Forces, Poses, one_pose};
use crate::postures::{FirstWrong, effort, index_of, reason_of};
use crate::robot::Robot;
use crate::threads::{ThreadCount, work};

/// The posture of an arm and the deviation of the tool at each of n poses under each load case.
///
/// Poses that the arm cannot reach have NaN in every array of floats, -1 in `worst_case`, False in `within_limits` and an
/// empty text in `branch`; `reachable` is the mask of the others.
#[pyclass(frozen, name = "Evaluation", module = "armill")]
pub(crate) struct PoseEvaluations {
    answers: Answers,
    single: bool,
    single_case: bool,
}

/// Evaluates poses with the kernel.
pub(crate) fn evaluate(
    robot: &Robot,
    (poses, forces, tool): (&Bound<'_, PyAny>, &Bound<'_, PyAny>, Option<&Bound<'_, PyAny>>),
    (branch, normal, home): (&str, Option<&Bound<'_, PyAny>>, Option<&Bound<'_, PyAny>>),
    threads: Option<ThreadCount>,
) -> PyResult<PoseEvaluations> {
    let py = poses.py();
    let poses = Poses::of(poses, "poses")?;
    let forces = Forces::of(forces)?;
    let flange_from_tool = one_pose(tool, "tool")?;
    let home = robot.home(home)?;
    let arm = Arm {
        robot: robot.arm(),
        compliance: robot.compliances(py)?,
        model: &robot.model,
        flange_from_tool: &flange_from_tool,
    };
    let question = Question {
        arm,
        home: home.as_deref(),
        cases: &forces.cases,
        uncertainty: InputUncertainty::NONE,
        normal: match normal {
            Some(normal) => direction(normal)?,
            None => against_tool(py, &poses)?,
        },
        choice: choice(py, robot, branch)?,
    };
    let (matrices, count) = (poses.values(), poses.batch.count);
    let wrong = FirstWrong::default();
    let answers = work(py, threads, effort(robot, count), |watch| {
        evaluate_points(&question, count, |i| wrong.pose(matrices, i), watch)
    })?;
    wrong.check(py, &poses, "poses")?;
    Ok(PoseEvaluations {
        answers: answers.map_err(|cancelled| exception(py, &cancelled.into()))?,
        single: poses.batch.single,
        single_case: forces.single,
    })
}

fn choice(py: Python<'_>, robot: &Robot, branch: &str) -> PyResult<BranchChoice> {
    let hint = "the name of a branch such as `front elbow-up no-flip`, `nominal`, or `best`";
    branch_choice_of(robot.arm(), branch).map_err(|message| refused(py, format!("branch: {message}"), hint))
}

/// A direction; its length is ignored.
fn direction(value: &Bound<'_, PyAny>) -> PyResult<Unit<Vector3<f64>>> {
    let py = value.py();
    let given = Given::of(value, "normal", &"(3,)")?;
    if given.shape() != [3] {
        return Err(wrong_shape(py, "normal", &"(3,)", given.shape()));
    }
    given.finite(py, "normal")?;
    let normal = Unit::try_new(Vector3::from_column_slice(given.values()), 0.0);
    normal.ok_or_else(|| refused(py, "normal has no direction", "the outward normal of the plane"))
}

/// The normal opposite to the tool direction, where all tools point the same way.
fn against_tool(py: Python<'_>, poses: &Poses<'_>) -> PyResult<Unit<Vector3<f64>>> {
    let wrong = FirstWrong::default();
    let all = (0..poses.batch.count).map(|index| wrong.pose(poses.values(), index));
    let normal = common_normal(all);
    wrong.check(py, poses, "poses")?;
    normal.map_err(|index| {
        let message =
            format!("poses[{index}] and poses[0] have different tool directions: the plane is not defined");
        refused(py, message, "give `normal`, the outward normal of the workpiece")
    })
}

impl PoseEvaluations {
    /// A number for each pose.
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(Option<&armill_core::kernel::Evaluation>) -> T,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        let values = self.answers.points.iter().map(|point| of(point.as_ref().ok()));
        array(py, &self.shape(&[]), values.collect())
    }

    /// A number for each pose, NaN where it is unreachable.
    fn each_reachable<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&armill_core::kernel::Evaluation) -> f64,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |point| point.map_or(f64::NAN, &of))
    }

    /// `values` with `width` numbers for each pose, NaN where it is unreachable.
    fn nan_where_unreachable<'py>(
        &self,
        py: Python<'py>,
        (rest, width): (&[usize], usize),
        values: impl Iterator<Item = f64>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let mut values: Vec<f64> = values.collect();
        for (index, point) in self.answers.points.iter().enumerate() {
            if point.is_err() {
                values[index * width..][..width].fill(f64::NAN);
            }
        }
        array(py, &self.shape(rest), values)
    }

    fn shape(&self, rest: &[usize]) -> Vec<usize> {
        let first = (!self.single).then_some(self.answers.points.len());
        first.into_iter().chain(rest.iter().copied()).collect()
    }
}

#[pymethods]
impl PoseEvaluations {
    /// -> (n,) bool: whether the arm reaches each pose; all else is valid only where this is True.
    #[getter]
    fn reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |point| point.is_some())
    }

    /// -> (n, dof) joint positions, rad (m); NaN where unreachable.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let dof = self.answers.joint_count;
        self.nan_where_unreachable(py, (&[dof], dof), self.answers.joints.iter().copied())
    }

    /// -> (n, cases, 3) deviations of the TCP, m, base axes; NaN where unreachable.
    #[getter]
    fn deviation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let cases = (!self.single_case).then_some(self.answers.case_count);
        let rest: Vec<usize> = cases.into_iter().chain([3]).collect();
        let deviations = self.answers.deviations.iter();
        let values = deviations.flat_map(|deviation| deviation.data.0[0]);
        self.nan_where_unreachable(py, (&rest, 3 * self.answers.case_count), values)
    }

    /// -> (n,) largest in-plane deviation of all load cases, m; NaN where unreachable.
    #[getter]
    fn in_plane<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each_reachable(py, |point| point.in_plane)
    }

    /// -> (n,) standard uncertainty of the in-plane deviation from the compliances, m; NaN where unreachable.
    #[getter]
    fn in_plane_uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each_reachable(py, |point| point.in_plane_uncertainty)
    }

    /// -> (n,) deviation along the outward normal, of the load case where its size is largest, m; NaN where unreachable.
    #[getter]
    fn normal_deviation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each_reachable(py, |point| point.normal)
    }

    /// -> (n,) largest length of the deviation vector of all load cases, m; NaN where unreachable.
    #[getter]
    fn magnitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each_reachable(py, |point| point.full)
    }

    /// -> (n,) int: load case with the largest in-plane deviation, the row of `forces` from 0; -1 where unreachable.
    ///
    /// Tables and JSON have the same load case as `worst_case`, numbered from 1.
    #[getter]
    fn worst_case<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.each(py, |point| point.map_or(-1, |point| point.worst_case as i64))
    }

    /// -> (n,) bool: whether every joint is inside its limits.
    #[getter]
    fn within_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |point| {
            point.is_some_and(armill_core::kernel::Evaluation::within_limits)
        })
    }

    /// -> (n, contributors) contribution of each joint, then of base, flange and tool with springs, to `in_plane`, m.
    ///
    /// NaN where unreachable. `Robot.contributors` has the names.
    #[getter]
    fn contributions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let count = self.answers.share_count;
        self.nan_where_unreachable(py, (&[count], count), self.answers.shares.iter().copied())
    }

    /// -> list of n str: the branch used at each pose; empty where unreachable.
    #[getter]
    fn branch(&self) -> Vec<String> {
        let name = |point: &Result<armill_core::kernel::Evaluation, _>| {
            point
                .as_ref()
                .map_or_else(|_| String::new(), |point| point.name.to_string())
        };
        self.answers.points.iter().map(name).collect()
    }

    /// -> list of n str: the singularity that the arm is near, one word; empty where it is near none.
    #[getter]
    fn singularity(&self) -> Vec<&'static str> {
        let word = |point: &Result<armill_core::kernel::Evaluation, _>| {
            let singularity = point.as_ref().ok().and_then(|point| point.singularity);
            singularity.map_or("", |singularity| singularity.word())
        };
        self.answers.points.iter().map(word).collect()
    }

    /// i -> str or None: why the arm does not reach pose i, and by how much.
    #[pyo3(signature = (i=0))]
    fn reason(&self, i: isize) -> PyResult<Option<String>> {
        let i = index_of(i, self.answers.points.len())?;
        Ok(reason_of(&self.answers.points[i]))
    }

    /// -> int: how many poses were evaluated.
    fn __len__(&self) -> usize {
        self.answers.points.len()
    }

    fn __repr__(&self) -> String {
        let reachable = self.answers.points.iter().filter(|point| point.is_ok()).count();
        format!(
            "<armill.Evaluation: {reachable} of {} poses reachable>",
            self.answers.points.len()
        )
    }
}
