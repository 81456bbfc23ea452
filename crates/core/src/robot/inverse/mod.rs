//! Which joint positions hold this tool pose?
//!
//! [`ortho_parallel`] is the closed form; [`postures`] gives every posture of a pose, each checked by
//! forward kinematics before it leaves. Chains without closed form work in forward direction only.

pub mod ortho_parallel;

pub use ortho_parallel::{OrthoParallel, Solution};

use super::forward::{Frames, forward, forward_into};
use super::jacobian::screws_at;
use super::model::Robot;
use super::posture::{Branch, Posture, Unreachable};
use nalgebra::{UnitQuaternion, Vector3};

use crate::frame::Isometry;

/// How far the forward kinematics of a solution may lie from the pose asked for, m and rad.
///
/// The closed form reaches 1e-15 of the arm's length; a thousand times its worst is a broken geometry.
const VERIFIED: f64 = 1e-9;

/// Every posture that holds the tool at `base_from_tool`; at the wrist singularity joint 4 stays as in
/// `near` (joint positions of the point before), or joints 4 and 6 share the turn evenly.
///
/// Outside joint limits counts as a posture: ask [`Robot::limit_margin`].
///
/// # Errors
/// The reason of the branch that misses by least, if no branch reaches.
pub fn postures(
    robot: &Robot,
    arm: &OrthoParallel,
    base_from_tool: &Isometry,
    tool: ToolAt<'_>,
) -> Result<Vec<Posture>, Unreachable> {
    let base_from_flange = base_from_tool * tool.flange_from_tool.inverse();
    let mut found = Vec::with_capacity(8);
    let mut nearest_miss: Option<Unreachable> = None;
    let mut frames = Frames::for_robot(robot);
    for branch in Branch::ALL {
        let solved = arm.solve(robot, &base_from_flange, branch, tool.near);
        let verified = solved.and_then(|solution| {
            forward_into(robot, &solution.joints, &mut frames);
            holds(&frames, &base_from_flange)?;
            Ok(solution)
        });
        match verified {
            Ok(solution) => found.push(Posture {
                branch: Some(branch),
                joints: solution.joints.to_vec(),
                screws: screws_at(robot, &frames, &base_from_tool.translation.vector.into()),
                base_from_tool: tool_on(&frames, tool.flange_from_tool),
                singularity: solution.singularity,
            }),
            Err(miss) => nearest_miss = Some(nearest_miss.map_or(miss, |other| nearer(other, miss))),
        }
    }
    match nearest_miss {
        Some(miss) if found.is_empty() => Err(miss),
        _ => Ok(found),
    }
}

/// The tool on the flange, and where the arm stood before.
#[derive(Clone, Copy, Debug)]
pub struct ToolAt<'a> {
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
    /// Joint positions of the point before, if there is one.
    pub near: Option<&'a [f64]>,
}

/// Checks that these frames bring the flange to where it was asked to be, within 1e-9 m and rad.
///
/// # Errors
/// [`Unreachable::Unverified`] with the distance missed.
pub fn holds(frames: &Frames, base_from_flange: &Isometry) -> Result<(), Unreachable> {
    let reached = &frames.base_from_flange;
    let away = reached.translation.vector - base_from_flange.translation.vector;
    let (a, b) = (
        reached.rotation.matrix(),
        base_from_flange.rotation.to_rotation_matrix(),
    );
    // Each pair of axes spans the sine of the angle between them; an angle above pi/2 shows in the trace.
    let turned: Vector3<f64> = (0..3)
        .map(|i| a.column(i).cross(&b.matrix().column(i)))
        .sum::<Vector3<f64>>()
        * 0.5;
    if away.norm() < VERIFIED && turned.norm() < VERIFIED && a.dot(b.matrix()) > 1.0 {
        Ok(())
    } else {
        Err(Unreachable::Unverified { by: away.norm() })
    }
}

/// The posture of a robot at these joint positions, whatever its chain.
pub fn posture_at(robot: &Robot, q: &[f64], flange_from_tool: &Isometry) -> Posture {
    let frames = forward(robot, q);
    let base_from_tool = tool_on(&frames, flange_from_tool);
    let screws = screws_at(robot, &frames, &base_from_tool.translation.vector.into());
    let named = robot.ortho_parallel().map(|arm| arm.name(robot, q));
    Posture {
        branch: named.map(|(branch, _)| branch),
        joints: q.to_vec(),
        base_from_tool,
        screws,
        singularity: named.and_then(|(_, singularity)| singularity),
    }
}

/// The tool pose of these frames.
pub fn tool_on(frames: &Frames, flange_from_tool: &Isometry) -> Isometry {
    let flange = &frames.base_from_flange;
    let rotation = UnitQuaternion::from_rotation_matrix(&flange.rotation);
    Isometry::from_parts(flange.translation, rotation) * flange_from_tool
}

/// The miss that is smaller.
fn nearer(a: Unreachable, b: Unreachable) -> Unreachable {
    if amount(b) < amount(a) { b } else { a }
}

fn amount(miss: Unreachable) -> f64 {
    match miss {
        Unreachable::TooFar { by }
        | Unreachable::TooNear { by }
        | Unreachable::InsideLateralOffset { by }
        | Unreachable::Unverified { by }
        | Unreachable::OutsideLimits { by, .. } => by,
        Unreachable::Unstable { .. } => f64::INFINITY,
    }
}
