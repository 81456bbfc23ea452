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
use armill_core::robot::inverse::posture_at;
use armill_core::robot::jacobian::jacobian as jacobian_of;
use armill_core::robot::{JointCompliance, PostureName};
use armill_core::source::{Arm, ArmState, Gravity, StiffnessModel, Unstable};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{Batch, place_of};
use crate::errors::{exception, refused};
use crate::poses::{Forces, one_pose};
use crate::results::Output;
use crate::robot::{Robot, Springs};
use crate::threads::{Effort, ThreadCount, work};

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Optional<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Joint positions, and the options that all results have.
pub(crate) struct Request<'a, 'py> {
    /// (..., dof)
    pub joints: &'a Bound<'py, PyAny>,
    /// (4, 4)
    pub tool: Optional<'a, 'py>,
    /// (..., dof), in place of those of the robot.
    pub compliances: Optional<'a, 'py>,
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
    positions.springs.model = Cow::Borrowed(&robot.model);
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
    forces: &Bound<'py, PyAny>,
    paired: bool,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, request)?;
    let forces = Forces::of(forces, paired.then_some(&positions.joints.axes))?;
    let shape = [forces.result_axes(), &[3]].concat();
    positions.evaluate(&shape, &forces, |arm_state, cases, out| {
        for (wrench, out) in cases.iter().zip(out.chunks_mut(3)) {
            out.copy_from_slice(arm_state.elastic(wrench)?.linear.as_slice());
        }
        Ok(())
    })
}

/// Contribution of each joint and spring to the deviations.
pub(crate) fn contributions<'py>(
    robot: &Robot,
    request: &Request<'_, 'py>,
    forces: &Bound<'py, PyAny>,
    paired: bool,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, request)?;
    let forces = Forces::of(forces, paired.then_some(&positions.joints.axes))?;
    let contributors = robot.model.contributors(robot.dof()).len();
    let shape = [forces.result_axes(), &[contributors, 3]].concat();
    positions.evaluate(&shape, &forces, |arm_state, cases, out| {
        for (wrench, out) in cases.iter().zip(out.chunks_mut(3 * contributors)) {
            arm_state.elastic(wrench)?;
            for (share, out) in arm_state.shares().iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice(share.linear.as_slice());
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
    positions.springs.model.to_mut().gravity = Some(Gravity {
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
        let springs = Springs {
            axes: Vec::new(),
            samples: vec![vec![STIFF; robot.dof()]],
            model: Cow::Borrowed(StiffnessModel::DRIVES),
        };
        JointPositions::of(robot, request, springs)
    }

    /// For results that need the compliance of the arm.
    fn compliant(robot: &'a Robot, request: &Request<'a, 'py>) -> PyResult<JointPositions<'a, 'py>> {
        let springs = robot.springs(request.joints.py(), request.compliances)?;
        JointPositions::of(robot, request, springs)
    }

    /// An array of `item` for each of the joint positions, written by `write` from the load cases there.
    fn evaluate(
        self,
        item: &[usize],
        forces: &Forces,
        write: impl Fn(&mut ArmState<'_>, &[Wrench], &mut [f64]) -> Result<(), Unstable> + Sync,
    ) -> Floats<'py> {
        let shape = [&self.springs.axes, &self.joints.axes, item].concat();
        let mut out = Output::of(self.py, self.out, &shape)?;
        let numbers = out.numbers()?;
        let (joints, samples) = (self.joints.given.values(), &*self.springs.samples);
        let work_of = match (samples, forces.paired) {
            ([_], false) => Effort::Points(self.joints.count),
            _ => Effort::Long,
        };
        let points = Points {
            arm: Arm {
                robot: self.robot.arm(),
                compliance: &[],
                model: &self.springs.model,
                flange_from_tool: &self.flange_from_tool,
            },
            joints,
            width: item.iter().product(),
            forces,
            write: &write,
        };
        let stretch = numbers.len() / samples.len().max(1);
        let written = work(self.py, self.threads, work_of, |watch| match samples {
            _ if numbers.is_empty() => Ok(()),
            [compliance] => points.write(compliance, numbers, watch),
            _ => first_failed(
                numbers
                    .par_chunks_mut(stretch)
                    .zip(samples)
                    .map(|(numbers, compliance)| points.write(compliance, numbers, watch)),
            ),
        })?;
        written.map_err(|why| match why {
            EvaluateError::Cancelled(cancelled) => exception(self.py, &cancelled.into()),
            EvaluateError::Unstable { point, why } => {
                let place = place_of(&self.joints.axes, point);
                refused(self.py, format!("joints{place}: {why}"), "check the load")
            }
        })?;
        out.array(self.py, &shape)
    }
}

/// Joint positions of an arm, and what is written at each.
struct Points<'a, W> {
    arm: Arm<'a>,
    joints: &'a [f64],
    /// Numbers that are written at each.
    width: usize,
    forces: &'a Forces,
    write: &'a W,
}

impl<W: Fn(&mut ArmState<'_>, &[Wrench], &mut [f64]) -> Result<(), Unstable> + Sync> Points<'_, W> {
    /// Writes all points for one sample of the compliances.
    fn write(
        &self,
        compliance: &[JointCompliance],
        out: &mut [f64],
        watch: Watch<'_>,
    ) -> Result<(), EvaluateError> {
        let arm = Arm {
            compliance,
            ..self.arm
        };
        let at = |joints, cases: &[Wrench], out: &mut [f64]| {
            let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| (self.write)(arm_state, cases, out);
            evaluate_at_joints(&arm, joints, out, write, watch)
        };
        if !self.forces.paired {
            return at(self.joints, &self.forces.cases, out);
        }
        let dof = compliance.len();
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
