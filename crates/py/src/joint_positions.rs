//! An arm at many joint positions: poses, Jacobians, compliances, deviations and their contributions.
//!
//! Each function takes joints, a tool and a number of threads, and writes the result of the core at each of the joint
//! positions into one array.

use armill_core::frame::Isometry;
use armill_core::kernel::{EvaluateError, evaluate_at_joints};
use armill_core::nalgebra::Vector3;
use armill_core::robot::JointCompliance;
use armill_core::robot::jacobian::jacobian as jacobian_of;
use armill_core::source::{Arm, ArmState, Gravity, StiffnessModel, Unstable};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::arrays::{Batch, array};
use crate::errors::{exception, refused};
use crate::poses::{Forces, one_pose};
use crate::robot::Robot;
use crate::threads::{Effort, ThreadCount, work};

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
type Tool<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Poses of the tool.
pub(crate) fn forward<'py>(
    robot: &Robot,
    joints: &Bound<'py, PyAny>,
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let positions = JointPositions::rigid(robot, joints, tool)?;
    positions.evaluate(threads, &[4, 4], |arm_state, out| {
        let pose = arm_state.base_from_tool().to_homogeneous();
        // The transpose of a matrix by columns is the matrix by rows.
        out.copy_from_slice(pose.transpose().as_slice());
        Ok(())
    })
}

/// Jacobians of the tool.
pub(crate) fn jacobian<'py>(
    robot: &Robot,
    joints: &Bound<'py, PyAny>,
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let positions = JointPositions::rigid(robot, joints, tool)?;
    let dof = robot.dof();
    positions.evaluate(threads, &[6, dof], |arm_state, out| {
        let jacobian = jacobian_of(robot.arm(), &arm_state.screws()[..dof]);
        out.copy_from_slice(jacobian.transpose().as_slice());
        Ok(())
    })
}

/// Compliances at the tool.
pub(crate) fn compliance<'py>(
    robot: &Robot,
    joints: &Bound<'py, PyAny>,
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, joints, tool)?;
    positions.evaluate(threads, &[6, 6], |arm_state, out| {
        let compliance = arm_state.compliance().ok_or(Unstable::Buckles)?;
        out.copy_from_slice(compliance.transpose().as_slice());
        Ok(())
    })
}

/// Deviations of the tool under each load case.
pub(crate) fn deviation<'py>(
    robot: &Robot,
    (joints, forces): (&Bound<'py, PyAny>, &Bound<'py, PyAny>),
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, joints, tool)?;
    let forces = Forces::of(forces)?;
    let shape: Vec<usize> = forces.axis().into_iter().chain([3]).collect();
    positions.evaluate(threads, &shape, |arm_state, out| {
        for (wrench, out) in forces.cases.iter().zip(out.chunks_mut(3)) {
            out.copy_from_slice(arm_state.elastic(wrench)?.linear.as_slice());
        }
        Ok(())
    })
}

/// Contribution of each joint and spring to the deviations.
pub(crate) fn contributions<'py>(
    robot: &Robot,
    (joints, forces): (&Bound<'py, PyAny>, &Bound<'py, PyAny>),
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let positions = JointPositions::compliant(robot, joints, tool)?;
    let forces = Forces::of(forces)?;
    let contributors = robot.model.contributors(robot.dof()).len();
    let shape: Vec<usize> = forces.axis().into_iter().chain([contributors, 3]).collect();
    positions.evaluate(threads, &shape, |arm_state, out| {
        for (wrench, out) in forces.cases.iter().zip(out.chunks_mut(3 * contributors)) {
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
    (joints, reference, acceleration): (&Bound<'py, PyAny>, Vec<f64>, Vector3<f64>),
    tool: Tool<'_, 'py>,
    threads: Option<ThreadCount>,
) -> Floats<'py> {
    let py = joints.py();
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
    let model = StiffnessModel {
        gravity: Some(Gravity {
            acceleration,
            reference,
        }),
        ..robot.model.clone()
    };
    let positions = JointPositions {
        model: &model,
        ..JointPositions::compliant(robot, joints, tool)?
    };
    positions.evaluate(threads, &[3], |arm_state, out| {
        let sag = arm_state
            .gravity()?
            .map_or_else(Vector3::zeros, |twist| twist.linear);
        out.copy_from_slice(sag.as_slice());
        Ok(())
    })
}

/// An arm and its joint positions.
struct JointPositions<'a, 'py> {
    py: Python<'py>,
    robot: &'a Robot,
    joints: Batch<'py>,
    flange_from_tool: Isometry,
    compliance: Vec<JointCompliance>,
    model: &'a StiffnessModel,
}

impl<'a, 'py> JointPositions<'a, 'py> {
    /// For results that need no compliance.
    fn rigid(
        robot: &'a Robot,
        joints: &Bound<'py, PyAny>,
        tool: Tool<'_, 'py>,
    ) -> PyResult<JointPositions<'a, 'py>> {
        let py = joints.py();
        let joints = Batch::of(&robot.in_joint_order(joints)?, "joints", &[robot.dof()])?;
        joints.given.finite(py, "joints")?;
        const STIFF: JointCompliance = JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        Ok(JointPositions {
            py,
            robot,
            joints,
            flange_from_tool: one_pose(tool, "tool")?,
            compliance: vec![STIFF; robot.dof()],
            model: StiffnessModel::DRIVES,
        })
    }

    /// For results that need the compliance of the arm.
    fn compliant(
        robot: &'a Robot,
        joints: &Bound<'py, PyAny>,
        tool: Tool<'_, 'py>,
    ) -> PyResult<JointPositions<'a, 'py>> {
        Ok(JointPositions {
            compliance: robot.compliances(joints.py())?.to_vec(),
            model: &robot.model,
            ..JointPositions::rigid(robot, joints, tool)?
        })
    }

    /// An array of `item` for each of the joint positions, written by `write`.
    fn evaluate(
        &self,
        threads: Option<ThreadCount>,
        item: &[usize],
        write: impl Fn(&mut ArmState<'_>, &mut [f64]) -> Result<(), Unstable> + Sync,
    ) -> Floats<'py> {
        let arm = Arm {
            robot: self.robot.arm(),
            compliance: &self.compliance,
            model: self.model,
            flange_from_tool: &self.flange_from_tool,
        };
        let (joints, count) = (self.joints.given.values(), self.joints.count);
        let width = item.iter().product();
        let write = &write;
        let written = work(self.py, threads, Effort::Points(count), move |watch| {
            let mut out = vec![0.0; count * width];
            evaluate_at_joints(&arm, joints, (&mut out, width), write, watch).map(|()| out)
        })?;
        let out = written.map_err(|why| match why {
            EvaluateError::Cancelled(cancelled) => exception(self.py, &cancelled.into()),
            EvaluateError::Unstable { point, why } => {
                refused(self.py, format!("joints[{point}]: {why}"), "check the load")
            }
        })?;
        array(self.py, &self.joints.shape(item), out)
    }
}
