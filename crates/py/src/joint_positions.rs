//! An arm at many joint positions: poses, Jacobians, compliances, deviations and their contributions.
//!
//! Each function writes the result of the core at each of the joint positions into one array, for each sample of the
//! compliances if several are given.

use std::borrow::Cow;
use std::slice;

use armill_core::dynamics::over_joint_positions;
use armill_core::frame::Isometry;
use armill_core::kernel::{EvaluateError, evaluate_at_joints};
use armill_core::nalgebra::Vector3;
use armill_core::predict::predict;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::jacobian::jacobian as jacobian_of;
use armill_core::robot::{JointCompliance, PostureName};
use armill_core::sampling::deviations::{SampledDeviations, compliance_terms};
use armill_core::sampling::{SampledArm, SpringSums};
use armill_core::source::{Arm, ArmState, Gravity, Links, StiffnessModel, Unstable};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{Batch, place_of};
use crate::errors::{exception, refused};
use crate::poses::{Forces, one_pose};
use crate::results::Output;
use crate::robot::{Robot, Springs, Varied};
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

/// Poses of the tool.
pub(crate) fn forward<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    let positions = JointPositions::rigid(robot, request)?;
    positions.evaluate(&[4, 4], &NO_LOAD, |arm_state, _, out| {
        let pose = arm_state.base_from_tool().to_homogeneous();
        // The transpose of a matrix by columns is the matrix by rows.
        out.copy_from_slice(pose.transpose().as_slice());
        Ok(())
    })
}

/// Jacobians of the tool.
pub(crate) fn jacobian<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    let positions = JointPositions::rigid(robot, request)?;
    let dof = robot.dof();
    positions.evaluate(&[6, dof], &NO_LOAD, |arm_state, _, out| {
        let jacobian = jacobian_of(robot.arm(), &arm_state.screws()[..dof]);
        out.copy_from_slice(jacobian.transpose().as_slice());
        Ok(())
    })
}

/// Compliances at the tool.
pub(crate) fn compliance<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, request)?;
    if positions.is_proportional() {
        let arm = robot.arm();
        return positions.write_samples(&[6, 6], |sampled, out, watch| {
            let samples: Vec<_> = sampled.arms.iter().map(|arm| (arm.compliances(), 1.0)).collect();
            let sums = SpringSums {
                arm: sampled.arms[0].arm(arm, sampled.tool),
                joints: sampled.joints,
                samples: &samples,
                width: 36,
            };
            Ok(sums.write(
                |arm_state, _, slots| compliance_terms(arm_state, slots),
                out,
                watch,
            )?)
        });
    }
    positions.evaluate(&[6, 6], &NO_LOAD, |arm_state, _, out| {
        let compliance = arm_state.compliance().ok_or(Unstable::Buckles)?;
        out.copy_from_slice(compliance.transpose().as_slice());
        Ok(())
    })
}

/// Mass matrices over the joint positions.
pub(crate) fn mass_matrix<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    needs_mass(robot, request, "its mass matrix")?;
    let mut positions = JointPositions::rigid(robot, request)?;
    if let Springs::Nominal(_, model) = &mut positions.springs {
        *model = Cow::Borrowed(&robot.model);
    }
    let dof = robot.dof();
    positions.evaluate(&[dof, dof], &NO_LOAD, |arm_state, _, out| {
        let matrix = over_joint_positions(robot.arm(), &arm_state.mass_matrix());
        out.copy_from_slice(matrix.as_slice());
        Ok(())
    })
}

/// What needs masses and motors is refused for an arm without.
fn needs_mass(robot: &Robot, request: &Request<'_, '_>, what: &str) -> PyResult<()> {
    if robot.model.structure.has_inertia() {
        return Ok(());
    }
    let message = format!(
        "robot `{}` has no masses: {what} cannot be predicted",
        robot.arm().name()
    );
    let hint = "give them in the robot file as [[mass]] and [[motor]]";
    Err(refused(request.joints.py(), message, hint))
}

/// Modes of vibration: frequency, damping ratio and shape at the tool.
pub(crate) fn modes<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    needs_mass(robot, request, "its modes")?;
    let positions = JointPositions::compliant(robot, request)?;
    let most = robot.dof() + robot.model.structure.springs.len();
    positions.evaluate(&[most, 8], &NO_LOAD, |arm_state, _, out| {
        let found = arm_state.modes()?;
        out.fill(0.0);
        for (index, out) in out.chunks_mut(8).enumerate() {
            let Some(mode) = found.modes.get(index) else {
                // A motion without mass, or none.
                out[0] = f64::INFINITY;
                continue;
            };
            out[0] = mode.at_tool.frequency_hz();
            out[1] = mode.at_tool.damping_ratio;
            out[2..].copy_from_slice(mode.at_tool.shape.as_slice());
        }
        Ok(())
    })
}

/// Deviations of the tool under each load case, or under that of its own.
pub(crate) fn deviation<'py>(
    robot: &Robot,
    request: &Request<'_, 'py>,
    loads: &Loads<'_, 'py>,
) -> Floats<'py> {
    let mut positions = JointPositions::compliant(robot, request)?;
    let forces = loads.at(&positions)?;
    let shape = [forces.result_axes(), &[3]].concat();
    if let (Springs::Nominal(compliance, model), true) = (&positions.springs, loads.all_sources) {
        let nominal = SampledArm::nominal(&positions.arm(compliance, model));
        positions.springs = Springs::Samples {
            axes: Vec::new(),
            arms: Cow::Owned(vec![nominal]),
        };
    }
    if matches!(positions.springs, Springs::Nominal(..)) {
        return positions.evaluate(&shape, &forces, |arm_state, at, out| {
            for (wrench, out) in at.cases.iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice(arm_state.elastic(wrench)?.linear.as_slice());
            }
            Ok(())
        });
    }
    let (arm, all_sources) = (robot.arm(), loads.all_sources);
    positions.write_samples(&shape, |sampled, out, watch| {
        let deviations = SampledDeviations {
            robot: arm,
            flange_from_tool: sampled.tool,
            samples: sampled.arms,
            joints: sampled.joints,
            cases: &forces.cases,
            paired: forces.paired,
            all_sources,
        };
        deviations.write(out, watch)
    })
}

/// Covariance of the deviations under each load case.
pub(crate) fn covariance<'py>(
    robot: &Robot,
    request: &Request<'_, 'py>,
    loads: &Loads<'_, 'py>,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, request)?;
    let forces = loads.at(&positions)?;
    let (all_sources, middle) = (loads.all_sources, vec![0.0; robot.dof()]);
    let shape = [forces.result_axes(), &[3, 3]].concat();
    positions.evaluate(&shape, &forces, |arm_state, at, out| {
        for (wrench, out) in at.cases.iter().zip(out.chunks_mut(9)) {
            let covariance = if all_sources {
                predict(arm_state, wrench, &mut Links::KeptByFriction(&middle))?.covariance
            } else {
                arm_state.elastic(wrench)?;
                arm_state.covariance()
            };
            out.copy_from_slice(covariance.as_slice());
        }
        Ok(())
    })
}

/// Screws of the tool by each drive, then each spring.
pub(crate) fn spring_jacobian<'py>(robot: &Robot, request: &Request<'_, 'py>) -> Floats<'py> {
    let mut positions = JointPositions::rigid(robot, request)?;
    if let Springs::Nominal(_, model) = &mut positions.springs {
        *model = Cow::Borrowed(&robot.model);
    }
    let springs = robot.dof() + robot.model.structure.springs.len();
    positions.evaluate(&[6, springs], &NO_LOAD, |arm_state, _, out| {
        for (k, screw) in arm_state.screws().iter().enumerate() {
            for (row, part) in screw.to_vector().iter().enumerate() {
                out[row * springs + k] = *part;
            }
        }
        Ok(())
    })
}

/// Contribution of each joint and spring to the deviations.
pub(crate) fn contributions<'py>(
    robot: &Robot,
    request: &Request<'_, 'py>,
    loads: &Loads<'_, 'py>,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, request)?;
    let forces = loads.at(&positions)?;
    let contributors = robot.model.contributors(robot.dof()).len();
    let shape = [forces.result_axes(), &[contributors, 3]].concat();
    positions.evaluate(&shape, &forces, |arm_state, at, out| {
        for (wrench, out) in at.cases.iter().zip(out.chunks_mut(3 * contributors)) {
            arm_state.elastic(wrench)?;
            for (share, out) in arm_state.shares().iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice((share.linear * at.factor).as_slice());
            }
        }
        Ok(())
    })
}

/// Deviations of the tool by the weight of the arm.
pub(crate) fn gravity<'py>(
    robot: &Robot,
    request: &Request<'_, 'py>,
    reference: Vec<f64>,
    acceleration: Vector3<f64>,
) -> Floats<'py> {
    let py = request.joints.py();
    if robot.model.structure.masses.is_empty() {
        let message = format!(
            "robot `{}` has no masses: the deviation by gravity is not known",
            robot.arm().name()
        );
        return Err(refused(py, message, "give them in the robot file as [[mass]]"));
    }
    if acceleration.iter().any(|part| !part.is_finite()) {
        return Err(refused(
            py,
            "acceleration has a number that is not finite",
            "m/s^2, base axes",
        ));
    }
    let mut positions = JointPositions::compliant(robot, request)?;
    positions.springs.set_gravity(&Gravity {
        acceleration,
        reference,
    });
    positions.evaluate(&[3], &NO_LOAD, |arm_state, _, out| {
        let sag = arm_state
            .gravity()?
            .map_or_else(Vector3::zeros, |twist| twist.linear);
        out.copy_from_slice(sag.as_slice());
        Ok(())
    })
}

/// The name of the posture at each of the joint positions.
pub(crate) fn branches(robot: &Robot, joints: &Bound<'_, PyAny>) -> PyResult<Vec<PostureName>> {
    let (py, positions) = (joints.py(), robot.joints(joints)?);
    let (tool, all) = (Isometry::identity(), positions.given.values());
    let name = |q: &[f64]| posture_at(robot.arm(), q, &tool).name;
    work(
        py,
        Some(ThreadCount::ONE),
        Effort::Points(positions.count),
        |_| all.chunks(robot.dof()).map(name).collect(),
    )
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
    fn at(&self, positions: &JointPositions<'_, '_>) -> PyResult<Forces> {
        Forces::of(self.forces, self.paired.then_some(&positions.joints.axes))
    }
}

/// The load cases at a point.
#[derive(Clone, Copy)]
struct AtPoint<'a> {
    cases: &'a [Wrench],
    /// Of the deviation under load in this sample: 1 and its model error.
    factor: f64,
}

/// For results that depend on no load.
const NO_LOAD: Forces = Forces {
    cases: Vec::new(),
    axes: Vec::new(),
    paired: false,
};

/// An arm and its joint positions.
struct JointPositions<'a, 'py> {
    py: Python<'py>,
    robot: &'a Robot,
    joints: Batch<'py>,
    flange_from_tool: Isometry,
    springs: Springs<'a>,
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
    fn rigid(robot: &'a Robot, request: &Request<'a, 'py>) -> PyResult<JointPositions<'a, 'py>> {
        const STIFF: JointCompliance = JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        let stiff = Cow::Owned(vec![STIFF; robot.dof()]);
        let springs = Springs::Nominal(stiff, Cow::Borrowed(StiffnessModel::DRIVES));
        JointPositions::of(robot, request, springs)
    }

    /// For results that need the compliance of the arm.
    fn compliant(robot: &'a Robot, request: &Request<'a, 'py>) -> PyResult<JointPositions<'a, 'py>> {
        let springs = robot.springs(request.joints.py(), &request.varied)?;
        JointPositions::of(robot, request, springs)
    }

    fn arm<'b>(&'b self, compliance: &'b [JointCompliance], model: &'b StiffnessModel) -> Arm<'b> {
        Arm {
            robot: self.robot.arm(),
            compliance,
            model,
            flange_from_tool: &self.flange_from_tool,
        }
    }

    /// The samples; none for the robot itself.
    fn samples(&self) -> &[SampledArm] {
        match &self.springs {
            Springs::Nominal(..) => &[],
            Springs::Samples { arms, .. } => arms,
        }
    }

    /// Whether there are samples, and each spring deflects in proportion to its torque.
    fn is_proportional(&self) -> bool {
        self.samples()
            .first()
            .is_some_and(|arm| SpringSums::applies(&arm.model))
    }

    /// An array of `item` for each sample and each of the joint positions, written by `write`.
    fn write_samples(
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
    fn evaluate(
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
struct Sampled<'a> {
    tool: &'a Isometry,
    joints: &'a [f64],
    arms: &'a [SampledArm],
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
