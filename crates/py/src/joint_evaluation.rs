//! An array of results at many joint positions, for each sample if there are several, written by what the core gives at one.

use std::borrow::Cow;
use std::slice;

use armill_core::frame::Isometry;
use armill_core::kernel::{EvaluateError, evaluate_at_joints};
use armill_core::robot::JointCompliance;
use armill_core::sampling::{SampledArm, SpringSums};
use armill_core::source::{Arm, ArmState, StiffnessModel, Unstable};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{Batch, place_of};
use crate::errors::{exception, refused};
use crate::poses::{Forces, one_pose};
use crate::results::Output;
use crate::robot::Robot;
use crate::springs::{Springs, Varied};
use crate::threads::{Effort, ThreadCount, work};

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Joint positions, and the options that all results have.
pub(crate) struct Request<'a, 'py> {
    /// (..., dof)
    pub joints: &'a Bound<'py, PyAny>,
    /// (4, 4)
    pub tool: Optional<'a, 'py>,
    /// In place of the compliances of the robot.
    pub varied: Varied<'a, 'py>,
    /// The array to write.
    pub out: Optional<'a, 'py>,
    /// All processors if not given.
    pub threads: Option<ThreadCount>,
}

/// Load cases, and the sources of deviation.
pub(crate) struct Loads<'a, 'py> {
    /// (cases, 3) or (cases, 6)
    pub forces: &'a Bound<'py, PyAny>,
    /// Whether each of the joint positions has a load case of its own.
    pub paired: bool,
    /// Whether deviations that no load causes are included.
    pub all_sources: bool,
}

impl Loads<'_, '_> {
    /// The load cases at these joint positions.
    ///
    /// # Errors
    /// As [`Forces::of`].
    pub(crate) fn at(&self, positions: &JointPositions<'_, '_>) -> PyResult<Forces> {
        Forces::of(self.forces, self.paired.then_some(&positions.joints.axes))
    }
}

/// The load cases at a point.
#[derive(Clone, Copy)]
pub(crate) struct AtPoint<'a> {
    /// The load cases.
    pub cases: &'a [Wrench],
    /// Of the deviation under load in this sample: 1 and its model error.
    pub factor: f64,
}

/// For results that depend on no load.
pub(crate) const NO_LOAD: Forces = Forces {
    cases: Vec::new(),
    axes: Vec::new(),
    paired: false,
};

/// An arm and its joint positions.
pub(crate) struct JointPositions<'a, 'py> {
    py: Python<'py>,
    pub(crate) robot: &'a Robot,
    pub(crate) joints: Batch<'py>,
    pub(crate) flange_from_tool: Isometry,
    pub(crate) springs: Springs<'a>,
    out: Option<&'a Bound<'py, PyAny>>,
    threads: Option<ThreadCount>,
}

impl<'a, 'py> JointPositions<'a, 'py> {
    fn of(
        robot: &'a Robot,
        request: &Request<'a, 'py>,
        springs: Springs<'a>,
    ) -> PyResult<JointPositions<'a, 'py>> {
        Ok(JointPositions {
            py: request.joints.py(),
            robot,
            joints: robot.joints(request.joints)?,
            flange_from_tool: one_pose(request.tool, "tool")?,
            springs,
            out: request.out,
            threads: request.threads,
        })
    }

    /// For results that need no compliance.
    pub(crate) fn rigid(robot: &'a Robot, request: &Request<'a, 'py>) -> PyResult<JointPositions<'a, 'py>> {
        const STIFF: JointCompliance = JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        let stiff = Cow::Owned(vec![STIFF; robot.dof()]);
        let springs = Springs::Nominal(stiff, Cow::Borrowed(StiffnessModel::DRIVES));
        JointPositions::of(robot, request, springs)
    }

    /// For results that need the compliance of the arm.
    pub(crate) fn compliant(
        robot: &'a Robot,
        request: &Request<'a, 'py>,
    ) -> PyResult<JointPositions<'a, 'py>> {
        let springs = robot.springs(request.joints.py(), &request.varied)?;
        JointPositions::of(robot, request, springs)
    }

    pub(crate) fn arm<'b>(&'b self, compliance: &'b [JointCompliance], model: &'b StiffnessModel) -> Arm<'b> {
        Arm {
            robot: self.robot.arm(),
            compliance,
            model,
            flange_from_tool: &self.flange_from_tool,
        }
    }

    /// The samples; none for the robot itself.
    pub(crate) fn samples(&self) -> &[SampledArm] {
        match &self.springs {
            Springs::Nominal(..) => &[],
            Springs::Samples { arms, .. } => arms,
        }
    }

    /// Whether there are samples, and each spring deflects in proportion to its torque.
    pub(crate) fn is_proportional(&self) -> bool {
        self.samples()
            .first()
            .is_some_and(|arm| SpringSums::applies(&arm.model))
    }

    /// An array of `item` for each sample and each of the joint positions, written by `write`.
    pub(crate) fn write_samples(
        &self,
        item: &[usize],
        write: impl FnOnce(&Sampled<'_>, &mut [f64], Watch<'_>) -> Result<(), EvaluateError> + Send,
    ) -> Floats<'py> {
        let shape = [self.springs.axes(), &self.joints.axes, item].concat();
        let mut out = Output::of(self.py, self.out, &shape)?;
        let numbers = out.numbers()?;
        let sampled = Sampled {
            tool: &self.flange_from_tool,
            joints: self.joints.given.values(),
            arms: self.samples(),
        };
        let written = work(self.py, self.threads, Effort::Long, |watch| {
            write(&sampled, numbers, watch)
        })?;
        written.map_err(|why| self.failed(why))?;
        out.array(self.py, &shape)
    }

    fn failed(&self, why: EvaluateError) -> PyErr {
        match why {
            EvaluateError::Cancelled(cancelled) => exception(self.py, &cancelled.into()),
            EvaluateError::Unstable { point, why } => {
                let place = place_of(&self.joints.axes, point);
                refused(self.py, format!("joints{place}: {why}"), "check the load")
            }
        }
    }

    /// An array of `item` for each of the joint positions, written by `write` from the load cases there.
    pub(crate) fn evaluate(
        self,
        item: &[usize],
        forces: &Forces,
        write: impl Fn(&mut ArmState<'_>, AtPoint<'_>, &mut [f64]) -> Result<(), Unstable> + Sync,
    ) -> Floats<'py> {
        let shape = [self.springs.axes(), &self.joints.axes, item].concat();
        let mut out = Output::of(self.py, self.out, &shape)?;
        let numbers = out.numbers()?;
        let joints = self.joints.given.values();
        let (tool, width) = (&self.flange_from_tool, item.iter().product());
        let (robot, springs) = (self.robot.arm(), &self.springs);
        let work_of = match (springs, forces.paired) {
            (Springs::Nominal(..), false) => Effort::Points(self.joints.count),
            _ => Effort::Long,
        };
        let points = |arm, factor| Points {
            arm,
            factor,
            joints,
            width,
            forces,
            write: &write,
        };
        let written = work(self.py, self.threads, work_of, |watch| match springs {
            _ if numbers.is_empty() => Ok(()),
            Springs::Nominal(compliance, model) => {
                let arm = Arm {
                    robot,
                    compliance,
                    model,
                    flange_from_tool: tool,
                };
                points(arm, 1.0).write(numbers, watch)
            }
            Springs::Samples { arms, .. } => first_failed(
                numbers
                    .par_chunks_mut(numbers.len() / arms.len())
                    .zip(&**arms)
                    .map(|(numbers, sample)| {
                        points(sample.arm(robot, tool), 1.0 + sample.model_error).write(numbers, watch)
                    }),
            ),
        })?;
        written.map_err(|why| self.failed(why))?;
        out.array(self.py, &shape)
    }
}

/// Samples of an arm, and joint positions.
pub(crate) struct Sampled<'a> {
    pub(crate) tool: &'a Isometry,
    pub(crate) joints: &'a [f64],
    pub(crate) arms: &'a [SampledArm],
}

/// Joint positions of an arm, and what is written at each.
struct Points<'a, W> {
    arm: Arm<'a>,
    factor: f64,
    joints: &'a [f64],
    /// Numbers that are written at each.
    width: usize,
    forces: &'a Forces,
    write: &'a W,
}

impl<W: Fn(&mut ArmState<'_>, AtPoint<'_>, &mut [f64]) -> Result<(), Unstable> + Sync> Points<'_, W> {
    /// Writes all points.
    fn write(&self, out: &mut [f64], watch: Watch<'_>) -> Result<(), EvaluateError> {
        let at = |joints, cases: &[Wrench], out: &mut [f64]| {
            let at = AtPoint {
                cases,
                factor: self.factor,
            };
            let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| (self.write)(arm_state, at, out);
            evaluate_at_joints(&self.arm, joints, out, write, watch)
        };
        if !self.forces.paired {
            return at(self.joints, &self.forces.cases, out);
        }
        let dof = self.arm.compliance.len();
        let points = self
            .joints
            .par_chunks(dof)
            .zip(out.par_chunks_mut(self.width))
            .zip(&self.forces.cases);
        first_failed(points.enumerate().map(|(point, ((joints, out), case))| {
            at(joints, slice::from_ref(case), out).map_err(|why| match why {
                EvaluateError::Unstable { why, .. } => EvaluateError::Unstable { point, why },
                cancelled @ EvaluateError::Cancelled(_) => cancelled,
            })
        }))
    }
}

/// The first failure in the order of the items, whatever the number of threads.
fn first_failed(
    results: impl IndexedParallelIterator<Item = Result<(), EvaluateError>>,
) -> Result<(), EvaluateError> {
    results.find_map_first(Result::err).map_or(Ok(()), Err)
}
