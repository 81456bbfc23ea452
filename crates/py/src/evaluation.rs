//! The class `Evaluation`: one posture for each of many poses, and the deviation of the tool there.

use std::slice;

use armill_core::kernel::{Answers, BranchChoice, Evaluation, Question, evaluate as evaluate_points};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{Unit, Vector3};
use armill_core::robot::{JointCompliance, PostureName, Singularity, Unreachable};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::{Cancelled, Watch};
use armill_core::workpiece::common_normal;
use armill_study::branch_choice_of;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{Given, wrong_shape};
use crate::containers::containers;
use crate::errors::{exception, refused};
use crate::html;
use crate::poses::{Forces, Poses, one_pose};
use crate::postures::{FirstWrong, effort};
use crate::results::{Stored, Words, item_of};
use crate::robot::Robot;
use crate::springs::{Springs, Varied};
use crate::threads::{Effort, ThreadCount, work};

/// The posture of an arm and the deviation of the tool at each of n poses under each load case.
///
/// Arrays have the leading axes of the poses, after those of `compliances`; lists have one item per pose, in the same
/// order. Poses that the arm cannot reach have NaN in every array of floats, -1 in `worst_case`, False in `within_limits`
/// and an empty text in `branch`; `reachable` is the mask of the others.
#[pyclass(frozen, name = "Evaluation", module = "armill")]
pub(crate) struct PoseEvaluations {
    reachable: Stored<bool>,
    within_limits: Stored<bool>,
    worst_case: Stored<i64>,
    joints: Stored<f64>,
    deviation: Stored<f64>,
    in_plane: Stored<f64>,
    in_plane_uncertainty: Stored<f64>,
    normal_deviation: Stored<f64>,
    magnitude: Stored<f64>,
    contributions: Stored<f64>,
    branch: Words<PostureName>,
    singularity: Words<&'static str>,
    reason: Words<Unreachable>,
    /// Names of joints and contributors, and the unit of each joint.
    names: [Vec<String>; 3],
}

/// The options of an evaluation.
pub(crate) struct EvaluationOptions<'a, 'py> {
    /// The words of a branch.
    pub branch: &'a str,
    /// (3,)
    pub normal: Option<&'a Bound<'py, PyAny>>,
    /// (dof,)
    pub home: Option<&'a Bound<'py, PyAny>>,
    /// Whether each pose has a load case of its own.
    pub paired: bool,
    /// In place of the compliances of the robot.
    pub varied: Varied<'a, 'py>,
    /// All processors if not given.
    pub threads: Option<ThreadCount>,
}

/// Evaluates poses with the kernel.
pub(crate) fn evaluate(
    robot: &Robot,
    poses: &Bound<'_, PyAny>,
    forces: &Bound<'_, PyAny>,
    tool: Option<&Bound<'_, PyAny>>,
    options: &EvaluationOptions<'_, '_>,
) -> PyResult<PoseEvaluations> {
    let py = poses.py();
    let poses = Poses::of(poses, "poses")?;
    let forces = Forces::of(forces, options.paired.then_some(&poses.batch.axes))?;
    let flange_from_tool = one_pose(tool, "tool")?;
    let home = robot.home(options.home)?;
    let springs = robot.springs(py, &options.varied)?;
    let template = Question {
        homes: None,
        arm: Arm {
            robot: robot.arm(),
            compliance: &[],
            model: &robot.model,
            flange_from_tool: &flange_from_tool,
        },
        home: home.as_deref(),
        cases: &[],
        uncertainty: InputUncertainty::NONE,
        normal: match options.normal {
            Some(normal) => direction(normal)?,
            None => against_tool(py, &poses)?,
        },
        choice: choice(py, robot, options.branch)?,
        clearance: None,
    };
    let (matrices, count) = (poses.values(), poses.batch.count);
    let work_of = match (&springs, forces.paired) {
        (Springs::Nominal(..), false) => effort(robot, count),
        _ => Effort::Long,
    };
    let shape = Shape {
        axes: [springs.axes(), &poses.batch.axes].concat(),
        case_axes: forces.result_axes().to_vec(),
        dof: robot.dof(),
        contributors: robot.model.contributors(robot.dof()).len(),
    };
    let names = [
        robot.joint_names(),
        robot.contributor_names(),
        robot.joint_units(),
    ];
    let wrong = FirstWrong::default();
    let found = work(py, options.threads, work_of, |watch| {
        let of = |compliance: &[JointCompliance], model: &StiffnessModel| {
            let arm = Arm {
                compliance,
                model,
                ..template.arm
            };
            let pose = |i| wrong.pose(matrices, i);
            answers(&Question { arm, ..template }, &forces, count, pose, watch)
        };
        let answers = match &springs {
            Springs::Nominal(compliance, model) => of(compliance, model)?,
            Springs::Samples { arms, .. } => {
                let each = arms
                    .par_iter()
                    .map(|sample| of(&sample.compliance, &sample.model));
                let each: Result<Vec<_>, Cancelled> = each.collect();
                each?.into_iter().flatten().collect()
            }
        };
        Ok(PoseEvaluations::of(answers, shape, names))
    })?;
    wrong.check(py, &poses, "poses")?;
    found.map_err(|cancelled: Cancelled| exception(py, &cancelled.into()))
}

/// The answers at `count` poses: all together, or one by one where each has a load case of its own.
fn answers(
    template: &Question<'_>,
    forces: &Forces,
    count: usize,
    pose: impl Fn(usize) -> armill_core::frame::Isometry + Sync,
    watch: Watch<'_>,
) -> Result<Vec<Answers>, Cancelled> {
    let under = |cases: &[Wrench], count, first: usize| {
        let question = Question { cases, ..*template };
        evaluate_points(&question, count, |i| pose(first + i), watch)
    };
    if !forces.paired {
        return Ok(vec![under(&forces.cases, count, 0)?]);
    }
    let cases = forces.cases.par_iter().enumerate();
    cases
        .map(|(i, case)| under(slice::from_ref(case), 1, i))
        .collect()
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

/// The lengths of the axes of an evaluation.
struct Shape {
    axes: Vec<usize>,
    case_axes: Vec<usize>,
    dof: usize,
    contributors: usize,
}

impl PoseEvaluations {
    /// The answers at consecutive poses, with NaN at those that are unreachable.
    fn of(stretches: Vec<Answers>, shape: Shape, names: [Vec<String>; 3]) -> PoseEvaluations {
        let Joined {
            points,
            mut joints,
            mut deviations,
            mut shares,
        } = Joined::of(stretches);
        let missed = points.iter().enumerate().filter(|(_, point)| point.is_err());
        for (i, _) in missed {
            for numbers in [&mut joints, &mut deviations, &mut shares] {
                let width = numbers.len() / points.len();
                numbers[i * width..][..width].fill(f64::NAN);
            }
        }
        let stored = |rest: &[usize], values| Stored::new([&*shape.axes, rest].concat(), values);
        let flags = |of: fn(&Evaluation) -> bool| Stored::new(shape.axes.clone(), each(&points, of, false));
        let numbers = |of: fn(&Evaluation) -> f64| stored(&[], each(&points, of, f64::NAN));
        PoseEvaluations {
            reachable: flags(|_| true),
            within_limits: flags(Evaluation::within_limits),
            worst_case: Stored::new(
                shape.axes.clone(),
                each(&points, |point| point.worst_case as i64, -1),
            ),
            in_plane: numbers(|point| point.in_plane),
            in_plane_uncertainty: numbers(|point| point.in_plane_uncertainty.unwrap_or(f64::NAN)),
            normal_deviation: numbers(|point| point.normal),
            magnitude: numbers(|point| point.full),
            joints: stored(&[shape.dof], joints),
            deviation: stored(&[&*shape.case_axes, &[3]].concat(), deviations),
            contributions: stored(&[shape.contributors], shares),
            branch: Words::Found(each(&points, |point| Some(point.name), None)),
            singularity: Words::Found(each(
                &points,
                |point| point.singularity.map(Singularity::word),
                None,
            )),
            reason: Words::Found(points.into_par_iter().map(Result::err).collect()),
            names,
        }
    }
}

/// The value of each point; `missed` where it is unreachable.
fn each<T: Copy + Send + Sync>(
    points: &[Result<Evaluation, Unreachable>],
    value: impl Fn(&Evaluation) -> T + Sync,
    missed: T,
) -> Vec<T> {
    /// Points of one thread, at least.
    const TOGETHER: usize = 4096;
    let points = points.par_iter().with_min_len(TOGETHER);
    points
        .map(|point| point.as_ref().map_or(missed, &value))
        .collect()
}

/// All answers in one array each, as [`Answers`] has them.
#[derive(Default)]
struct Joined {
    points: Vec<Result<Evaluation, Unreachable>>,
    joints: Vec<f64>,
    deviations: Vec<f64>,
    shares: Vec<f64>,
}

impl Joined {
    /// The first answers are not copied: mostly there are no others.
    fn of(stretches: Vec<Answers>) -> Joined {
        let mut stretches = stretches.into_iter().map(|answers| {
            let deviations: Vec<[f64; 3]> = answers.deviations.into_iter().map(Into::into).collect();
            Joined {
                points: answers.points,
                joints: answers.joints,
                deviations: deviations.into_flattened(),
                shares: answers.shares,
            }
        });
        let mut joined = stretches.next().unwrap_or_default();
        for more in stretches {
            joined.points.extend(more.points);
            joined.joints.extend(more.joints);
            joined.deviations.extend(more.deviations);
            joined.shares.extend(more.shares);
        }
        joined
    }
}

/// The arrays, then the words: branch, singularity, reason.
type Parts<'py> = (
    [PyReadonlyArrayDyn<'py, bool>; 2],
    PyReadonlyArrayDyn<'py, i64>,
    [PyReadonlyArrayDyn<'py, f64>; 7],
    [Vec<Option<String>>; 3],
    [Vec<String>; 3],
);

#[pymethods]
impl PoseEvaluations {
    /// -> (n,) bool: whether the arm reaches each pose; all else is valid only where this is True.
    #[getter]
    fn reachable<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.reachable.array(py)
    }

    /// -> (n, dof) joint positions, rad (m); NaN where unreachable.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.joints.array(py)
    }

    /// -> (n, cases, 3) deviations of the TCP, m, base axes; NaN where unreachable. (n, 3) if paired.
    #[getter]
    fn deviation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.deviation.array(py)
    }

    /// -> (n,) largest in-plane deviation of all load cases, m; NaN where unreachable.
    #[getter]
    fn in_plane<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.in_plane.array(py)
    }

    /// -> (n,) standard uncertainty of the in-plane deviation from the compliances, m; NaN where unknown or unreachable.
    #[getter]
    fn in_plane_uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.in_plane_uncertainty.array(py)
    }

    /// -> (n,) deviation along the outward normal, of the load case where its size is largest, m; NaN where unreachable.
    #[getter]
    fn normal_deviation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.normal_deviation.array(py)
    }

    /// -> (n,) largest length of the deviation vector of all load cases, m; NaN where unreachable.
    #[getter]
    fn magnitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.magnitude.array(py)
    }

    /// -> (n,) int: load case with the largest in-plane deviation, the row of `forces` from 0; -1 where unreachable.
    ///
    /// 0 everywhere if paired. Tables and JSON have the same load case as `worst_case`, numbered from 1.
    #[getter]
    fn worst_case<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        self.worst_case.array(py)
    }

    /// -> (n,) bool: whether every joint is inside its limits.
    #[getter]
    fn within_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        self.within_limits.array(py)
    }

    /// -> (n, contributors) contribution of each joint, then of base, flange and tool with springs, to `in_plane`, m.
    ///
    /// NaN where unreachable. `Robot.contributors` has the names.
    #[getter]
    fn contributions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.contributions.array(py)
    }

    /// -> list of str: names along the last axis of `joints`.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.names[0].clone()
    }

    /// -> list of str: names along the last axis of `contributions`.
    #[getter]
    fn contributors(&self) -> Vec<String> {
        self.names[1].clone()
    }

    /// -> list of str: unit of each joint, `rad` or `m`.
    #[getter]
    fn joint_units(&self) -> Vec<String> {
        self.names[2].clone()
    }

    /// -> list of n str: the branch used at each pose; empty where unreachable.
    #[getter]
    fn branch(&self) -> Vec<String> {
        self.branch.texts()
    }

    /// -> list of n str: the singularity that the arm is near, one word; empty where it is near none.
    #[getter]
    fn singularity(&self) -> Vec<String> {
        self.singularity.texts()
    }

    /// i -> str or None: why the arm does not reach pose i, and by how much; i has an index for each axis if there are several.
    #[pyo3(signature = (i=None))]
    fn reason(&self, i: Option<&Bound<'_, PyAny>>) -> PyResult<Option<String>> {
        let i = i.map_or(Ok(0), |i| item_of(&self.reachable.shape, i))?;
        Ok(self.reason.get(i))
    }

    /// -> int: how many poses were evaluated.
    fn __len__(&self) -> usize {
        self.reachable.values.len()
    }

    fn __repr__(&self) -> String {
        let reachable = self
            .reachable
            .values
            .iter()
            .filter(|reachable| **reachable)
            .count();
        format!(
            "<armill.Evaluation: {reachable} of {} poses reachable>",
            self.reachable.values.len()
        )
    }

    fn _repr_html_(&self) -> String {
        let numbers = [
            ("in_plane", &self.in_plane),
            ("normal_deviation", &self.normal_deviation),
            ("magnitude", &self.magnitude),
        ];
        let rows = numbers.map(|(name, stored)| {
            let known = stored.values.iter().filter(|value| !value.is_nan());
            let (least, greatest) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
            let shown = |value: f64| match value.is_finite() {
                true => format!("{value:.3e}"),
                false => String::new(),
            };
            vec![name.to_owned(), shown(least), shown(greatest)]
        });
        html::table(&self.__repr__(), &["", "least, m", "greatest, m"], rows)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let (py, own) = (slf.py(), slf.get());
        let parts = (
            [own.reachable.array(py)?, own.within_limits.array(py)?],
            own.worst_case.array(py)?,
            [
                own.joints.array(py)?,
                own.deviation.array(py)?,
                own.in_plane.array(py)?,
                own.in_plane_uncertainty.array(py)?,
                own.normal_deviation.array(py)?,
                own.magnitude.array(py)?,
                own.contributions.array(py)?,
            ],
            [own.branch.all(), own.singularity.all(), own.reason.all()],
            own.names.clone(),
        );
        Ok((
            slf.get_type().getattr("_again")?,
            (parts.into_pyobject(py)?.into_any(),),
        ))
    }

    #[staticmethod]
    fn _again(parts: Parts<'_>) -> PoseEvaluations {
        let (flags, worst_case, numbers, [branch, singularity, reason], names) = parts;
        let [reachable, within_limits] = flags.map(|flags| Stored::of(&flags));
        let [
            joints,
            deviation,
            in_plane,
            in_plane_uncertainty,
            normal_deviation,
            magnitude,
            contributions,
        ] = numbers.map(|numbers| Stored::of(&numbers));
        PoseEvaluations {
            reachable,
            within_limits,
            worst_case: Stored::of(&worst_case),
            joints,
            deviation,
            in_plane,
            in_plane_uncertainty,
            normal_deviation,
            magnitude,
            contributions,
            branch: Words::Read(branch),
            singularity: Words::Read(singularity),
            reason: Words::Read(reason),
            names,
        }
    }
}

containers!(PoseEvaluations);
