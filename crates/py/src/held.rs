//! The class `Held`: one posture for each of many poses, and how far the tool deviates there.

use armill_core::kernel::{Answers, BranchChoice, Question, evaluate};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::source::Arm;
use armill_core::workpiece::normal_across;
use armill_study::branch_choice_of;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::arrays::{Given, array, array_of, wrong_shape};
use crate::errors::{exception, refused};
use crate::poses::{Forces, Poses, one_pose};
use crate::postures::{FirstWrong, effort, index_of, reason_of};
use crate::robot::Robot;
use crate::threads::work;

/// How an arm holds the tool at each of n poses under each load case; zeros where it does not: see `held`.
#[pyclass(frozen, module = "armill")]
pub(crate) struct Held {
    answers: Answers,
    single: bool,
    single_case: bool,
}

/// Asks the kernel.
pub(crate) fn hold(
    robot: &Robot,
    (poses, forces, tool): (&Bound<'_, PyAny>, &Bound<'_, PyAny>, Option<&Bound<'_, PyAny>>),
    (branch, normal, home): (&str, Option<&Bound<'_, PyAny>>, Option<&Bound<'_, PyAny>>),
    threads: Option<usize>,
) -> PyResult<Held> {
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
        evaluate(&question, count, |i| wrong.pose(matrices, i), watch)
    })?;
    wrong.check(py, &poses, "poses")?;
    Ok(Held {
        answers: answers.map_err(|cancelled| exception(py, &cancelled.into()))?,
        single: poses.batch.single,
        single_case: forces.single,
    })
}

fn choice(py: Python<'_>, robot: &Robot, branch: &str) -> PyResult<BranchChoice> {
    let hint = "words of a branch such as `front elbow-up no-flip`, `nominal`, or `best`";
    branch_choice_of(robot.arm(), branch).map_err(|message| refused(py, format!("branch: {message}"), hint))
}

/// A direction, whatever its length.
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

/// The normal that looks against the tool, where all tools point the same way.
fn against_tool(py: Python<'_>, poses: &Poses<'_>) -> PyResult<Unit<Vector3<f64>>> {
    let wrong = FirstWrong::default();
    let all = (0..poses.batch.count).map(|index| wrong.pose(poses.values(), index));
    let normal = normal_across(all);
    wrong.check(py, poses, "poses")?;
    normal.map_err(|index| {
        let message = format!("poses[{index}] points another way than poses[0]: across which plane?");
        refused(py, message, "give `normal`, that of the workpiece")
    })
}

impl Held {
    /// A number for each pose.
    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(Option<&armill_core::kernel::Held>) -> T,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        let values = self.answers.points.iter().map(|point| of(point.as_ref().ok()));
        array(py, &self.shape(&[]), values.collect())
    }

    fn shape(&self, rest: &[usize]) -> Vec<usize> {
        let first = (!self.single).then_some(self.answers.points.len());
        first.into_iter().chain(rest.iter().copied()).collect()
    }
}

#[pymethods]
impl Held {
    /// -> (n,) bool: whether the arm holds the tool at each pose.
    #[getter]
    fn evaluation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |evaluation| evaluation.is_some())
    }

    /// -> (n, dof) joint positions, rad (m).
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        array_of(py, &self.shape(&[self.answers.joint_count]), &self.answers.joints)
    }

    /// -> (n, cases, 3) deviations of the TCP, m, base axes.
    #[getter]
    fn deviation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let cases = (!self.single_case).then_some(self.answers.case_count);
        let rest: Vec<usize> = cases.into_iter().chain([3]).collect();
        let values = self
            .answers
            .deviations
            .iter()
            .flat_map(|deviation| deviation.data.0[0]);
        array(py, &self.shape(&rest), values.collect())
    }

    /// -> (n,) largest in-plane deviation of all cases, m.
    #[getter]
    fn in_plane<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |evaluation| evaluation.map_or(0.0, |evaluation| evaluation.in_plane))
    }

    /// -> (n,) standard uncertainty of the in-plane deviation from the compliances, m.
    #[getter]
    fn in_plane_uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |evaluation| evaluation.map_or(0.0, |evaluation| evaluation.in_plane_uncertainty))
    }

    /// -> (n,) deviation along the outward normal, of the case where it is largest in size, m.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |evaluation| evaluation.map_or(0.0, |evaluation| evaluation.normal))
    }

    /// -> (n,) largest length of the deviation of all cases, m.
    #[getter]
    fn full<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, |evaluation| evaluation.map_or(0.0, |evaluation| evaluation.full))
    }

    /// -> (n,) index of the case with the largest in-plane deviation.
    #[getter]
    fn deciding_case<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.each(py, |evaluation| evaluation.map_or(0, |evaluation| evaluation.deciding_case as i64))
    }

    /// -> (n,) bool: whether every joint stands inside its limits.
    #[getter]
    fn within_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.each(py, |evaluation| {
            evaluation.is_some_and(armill_core::kernel::Held::within_limits)
        })
    }

    /// -> (n, contributors) share of each joint, then of base, flange and tool where springs sit, in `in_plane`, m.
    #[getter]
    fn shares<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        array_of(py, &self.shape(&[self.answers.share_count]), &self.answers.shares)
    }

    /// -> list of n str: the branch that holds each pose; empty where none does.
    #[getter]
    fn branch(&self) -> Vec<String> {
        let name = |point: &Result<armill_core::kernel::Held, _>| {
            point
                .as_ref()
                .map_or_else(|_| String::new(), |evaluation| evaluation.name.to_string())
        };
        self.answers.points.iter().map(name).collect()
    }

    /// -> list of n str: the singularity that the arm is near, one word; empty where it is near none.
    #[getter]
    fn singularity(&self) -> Vec<&'static str> {
        let word = |point: &Result<armill_core::kernel::Held, _>| {
            let singularity = point.as_ref().ok().and_then(|evaluation| evaluation.singularity);
            singularity.map_or("", |singularity| singularity.word())
        };
        self.answers.points.iter().map(word).collect()
    }

    /// i -> str or None: why the arm does not hold pose i, and by how much it misses.
    #[pyo3(signature = (i=0))]
    fn reason(&self, i: isize) -> PyResult<Option<String>> {
        let i = index_of(i, self.answers.points.len())?;
        Ok(reason_of(&self.answers.points[i]))
    }

    /// -> int: how many poses were asked.
    fn __len__(&self) -> usize {
        self.answers.points.len()
    }

    fn __repr__(&self) -> String {
        let evaluation = self.answers.evaluation().count();
        format!("<armill.Held: {evaluation} of {} poses>", self.answers.points.len())
    }
}
