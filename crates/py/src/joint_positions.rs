//! An arm at many joint positions: poses, Jacobians, compliances, deviations and their contributions.
//!
//! Each function writes the result of the core at each of the joint positions into one array, for each sample of the
//! compliances if several are given.

use std::borrow::Cow;

use armill_core::dynamics::over_joint_positions;
use armill_core::frame::Isometry;
use armill_core::nalgebra::Vector3;
use armill_core::predict::predict;
use armill_core::robot::PostureName;
use armill_core::robot::inverse::posture_at;
use armill_core::robot::jacobian::jacobian as jacobian_of;
use armill_core::sampling::deviations::{SampledDeviations, compliance_terms};
use armill_core::sampling::{SampledArm, SpringSums};
use armill_core::source::{Gravity, Links, Unstable};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::errors::refused;
use crate::joint_evaluation::{JointPositions, Loads, NO_LOAD, Request};
use crate::robot::Robot;
use crate::springs::Springs;
use crate::threads::{Effort, ThreadCount, work};

type Floats<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;

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
