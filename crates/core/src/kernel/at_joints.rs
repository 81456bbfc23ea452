//! The general path: any serial chain at many joint positions.
//!
//! Blocks of points on all threads of the current rayon pool, with scratch that is made once a thread; what comes
//! out is written by index. An arm whose poses have postures in closed form goes through [`super::evaluate`].

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::frame::Isometry;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::tool_on;
use crate::robot::jacobian::screws_into;
use crate::robot::{JointCompliance, Robot};
use crate::source::elastic;
use crate::spatial::{Twist, Wrench};
use crate::watch::{Cancelled, Watch};

/// Points in a block: enough to make the hand-over cheap, few enough to cancel soon.
const BLOCK: usize = 256;

/// A robot that holds a tool under load.
#[derive(Clone, Copy, Debug)]
pub struct Loaded<'a> {
    /// The robot; any chain.
    pub robot: &'a Robot,
    /// Compliance of each of its joints.
    pub compliance: &'a [JointCompliance],
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
    /// Load cases on the tool at the TCP, base basis; at least one.
    pub cases: &'a [Wrench],
}

/// What comes out at each joint position.
#[derive(Clone, Debug)]
pub struct AtJoints {
    /// Where the tool is.
    pub base_from_tool: Vec<Isometry>,
    /// Screws of the joints at the TCP, base basis, per unit of chain position; as many a point as joints.
    pub screws: Vec<Twist>,
    /// Deviation (m, base) under each load case; as many a point as cases.
    pub deviations: Vec<Vector3<f64>>,
}

/// Tool, screws and deviations at the joint positions `joints` (rad, m; as many a point as joints, one point after the
/// other).
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If `joints` is no whole number of points, or there are not as many compliances as joints.
pub fn at_joints(loaded: &Loaded<'_>, joints: &[f64], watch: Watch<'_>) -> Result<AtJoints, Cancelled> {
    let (dof, cases) = (loaded.robot.joints().len(), loaded.cases.len());
    assert_eq!(
        joints.len() % dof,
        0,
        "joint positions for a whole number of points"
    );
    assert_eq!(loaded.compliance.len(), dof, "one compliance a joint");
    let count = joints.len() / dof;
    let mut out = AtJoints {
        base_from_tool: vec![Isometry::identity(); count],
        screws: vec![Twist::ZERO; count * dof],
        deviations: vec![Vector3::zeros(); count * cases],
    };
    joints
        .par_chunks(BLOCK * dof)
        .zip(out.base_from_tool.par_chunks_mut(BLOCK))
        .zip(out.screws.par_chunks_mut(BLOCK * dof))
        .zip(out.deviations.par_chunks_mut(BLOCK * cases))
        .try_for_each_init(
            || Frames::for_robot(loaded.robot),
            |frames, (((joints, tools), screws), deviations)| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                let points = joints
                    .chunks(dof)
                    .zip(tools.iter_mut())
                    .zip(screws.chunks_mut(dof))
                    .zip(deviations.chunks_mut(cases));
                for (((q, tool), screws), deviations) in points {
                    forward_into(loaded.robot, q, frames);
                    *tool = tool_on(frames, loaded.flange_from_tool);
                    screws_into(loaded.robot, frames, &tool.translation.vector.into(), screws);
                    for (deviation, wrench) in deviations.iter_mut().zip(loaded.cases) {
                        *deviation = elastic::displacement(screws, loaded.compliance, wrench);
                    }
                }
                (watch.finished)(joints.len() / dof);
                Ok(())
            },
        )?;
    Ok(out)
}
