//! The general path: any serial chain at many joint positions.
//!
//! Blocks of points on all threads of the current rayon pool, with scratch that is made once a thread; what comes
//! out is written by index. An arm whose poses have postures in closed form goes through [`super::evaluate`].

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::frame::Isometry;
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::tool_on;
use crate::robot::jacobian::screws_into;
use crate::source::{Arm, Standing, Unstable, elastic};
use crate::spatial::{Twist, Wrench};
use crate::watch::{Cancelled, Watch};

/// Points in a block: enough to make the hand-over cheap, few enough to cancel soon.
const AT_ONCE: usize = 256;

/// What comes out at each joint position.
#[derive(Clone, Debug)]
pub struct AtJoints {
    /// Where the tool is.
    pub base_from_tool: Vec<Isometry>,
    /// Screws of the joints, then of the springs, at the TCP, base basis, per unit of chain position.
    pub screws: Vec<Twist>,
    /// Deviation (m, base) under each load case; as many a point as cases.
    pub deviations: Vec<Vector3<f64>>,
    /// Whether the arm found a stable rest under every load case; deviations are zero where it did not.
    pub rests: Vec<bool>,
}

/// Tool, screws and deviations of `arm`, any chain, at the joint positions `joints` (rad, m; as many a point as joints,
/// one point after the other) under each of `cases`, wrenches on the tool at the TCP, base basis.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
///
/// # Panics
/// If `joints` is no whole number of points, or there are not as many compliances as joints.
pub fn at_joints(
    arm: &Arm<'_>,
    cases: &[Wrench],
    joints: &[f64],
    watch: Watch<'_>,
) -> Result<AtJoints, Cancelled> {
    let (dof, case_count) = (arm.robot.joints().len(), cases.len());
    assert_eq!(
        joints.len() % dof,
        0,
        "joint positions for a whole number of points"
    );
    assert_eq!(arm.compliance.len(), dof, "one compliance a joint");
    let count = joints.len() / dof;
    let yields = dof + arm.model.structure.springs.len();
    let mut out = AtJoints {
        base_from_tool: vec![Isometry::identity(); count],
        screws: vec![Twist::ZERO; count * yields],
        deviations: vec![Vector3::zeros(); count * case_count],
        rests: vec![true; count],
    };
    joints
        .par_chunks(AT_ONCE * dof)
        .zip(out.base_from_tool.par_chunks_mut(AT_ONCE))
        .zip(out.screws.par_chunks_mut(AT_ONCE * yields))
        .zip(out.deviations.par_chunks_mut(AT_ONCE * case_count))
        .zip(out.rests.par_chunks_mut(AT_ONCE))
        .try_for_each_init(
            || Room::new(arm),
            |room, ((((joints, tools), screws), deviations), rests)| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                let points = joints
                    .chunks(dof)
                    .zip(tools.iter_mut())
                    .zip(screws.chunks_mut(yields))
                    .zip(deviations.chunks_mut(case_count))
                    .zip(rests.iter_mut());
                for ((((q, tool), screws), deviations), rests) in points {
                    forward_into(arm.robot, q, &mut room.frames);
                    *tool = tool_on(&room.frames, arm.flange_from_tool);
                    *rests = room.deviate((q, tool), cases, screws, deviations).is_ok();
                }
                (watch.finished)(joints.len() / dof);
                Ok(())
            },
        )?;
    Ok(out)
}

/// Room for one point, one a thread.
struct Room<'a> {
    arm: Arm<'a>,
    frames: Frames,
    /// Where more than drives yields.
    standing: Option<Standing<'a>>,
}

impl<'a> Room<'a> {
    fn new(arm: &Arm<'a>) -> Room<'a> {
        Room {
            arm: *arm,
            frames: Frames::for_robot(arm.robot),
            standing: (!arm.model.is_drives_alone()).then(|| Standing::new(*arm)),
        }
    }

    /// Screws and deviations in the frames that stand here.
    fn deviate(
        &mut self,
        (q, tool): (&[f64], &Isometry),
        cases: &[Wrench],
        screws: &mut [Twist],
        deviations: &mut [Vector3<f64>],
    ) -> Result<(), Unstable> {
        let tcp = tool.translation.vector.into();
        let Some(standing) = &mut self.standing else {
            screws_into(self.arm.robot, &self.frames, &tcp, screws);
            for (deviation, wrench) in deviations.iter_mut().zip(cases) {
                *deviation = elastic::displacement(screws, self.arm.compliance, wrench);
            }
            return Ok(());
        };
        standing.stand_in(q, &self.frames, &tcp);
        screws.copy_from_slice(standing.screws());
        for (i, wrench) in cases.iter().enumerate() {
            match deviation_of(standing, wrench) {
                Ok(deviation) => deviations[i] = deviation.linear,
                Err(unstable) => {
                    deviations.fill(Vector3::zeros());
                    return Err(unstable);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
