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
use crate::source::{Arm, Standing, StiffnessModel, Unstable, elastic};
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
    /// What else yields and weighs; [`StiffnessModel::DRIVES`] for nothing.
    pub model: &'a StiffnessModel,
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
    /// Screws of the joints, then of the springs, at the TCP, base basis, per unit of chain position.
    pub screws: Vec<Twist>,
    /// Deviation (m, base) under each load case; as many a point as cases.
    pub deviations: Vec<Vector3<f64>>,
    /// Whether the arm found a stable rest under every load case; deviations are zero where it did not.
    pub rests: Vec<bool>,
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
    let yields = dof + loaded.model.structure.springs.len();
    let mut out = AtJoints {
        base_from_tool: vec![Isometry::identity(); count],
        screws: vec![Twist::ZERO; count * yields],
        deviations: vec![Vector3::zeros(); count * cases],
        rests: vec![true; count],
    };
    joints
        .par_chunks(BLOCK * dof)
        .zip(out.base_from_tool.par_chunks_mut(BLOCK))
        .zip(out.screws.par_chunks_mut(BLOCK * yields))
        .zip(out.deviations.par_chunks_mut(BLOCK * cases))
        .zip(out.rests.par_chunks_mut(BLOCK))
        .try_for_each_init(
            || Room::new(loaded),
            |room, ((((joints, tools), screws), deviations), rests)| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                let points = joints
                    .chunks(dof)
                    .zip(tools.iter_mut())
                    .zip(screws.chunks_mut(yields))
                    .zip(deviations.chunks_mut(cases))
                    .zip(rests.iter_mut());
                for ((((q, tool), screws), deviations), rests) in points {
                    forward_into(loaded.robot, q, &mut room.frames);
                    *tool = tool_on(&room.frames, loaded.flange_from_tool);
                    *rests = room.deviate(loaded, (q, tool), screws, deviations).is_ok();
                }
                (watch.finished)(joints.len() / dof);
                Ok(())
            },
        )?;
    Ok(out)
}

/// Room for one point, one a thread.
struct Room<'a> {
    frames: Frames,
    /// Where more than drives yields.
    standing: Option<Standing<'a>>,
}

impl<'a> Room<'a> {
    fn new(loaded: &Loaded<'a>) -> Room<'a> {
        let arm = Arm {
            robot: loaded.robot,
            compliance: loaded.compliance,
            model: loaded.model,
            flange_from_tool: loaded.flange_from_tool,
        };
        Room {
            frames: Frames::for_robot(loaded.robot),
            standing: (!loaded.model.is_drives_alone()).then(|| Standing::new(arm)),
        }
    }

    /// Screws and deviations in the frames that stand here.
    fn deviate(
        &mut self,
        loaded: &Loaded<'_>,
        (q, tool): (&[f64], &Isometry),
        screws: &mut [Twist],
        deviations: &mut [Vector3<f64>],
    ) -> Result<(), Unstable> {
        let tcp = tool.translation.vector.into();
        let Some(standing) = &mut self.standing else {
            screws_into(loaded.robot, &self.frames, &tcp, screws);
            for (deviation, wrench) in deviations.iter_mut().zip(loaded.cases) {
                *deviation = elastic::displacement(screws, loaded.compliance, wrench);
            }
            return Ok(());
        };
        standing.stand_in(q, &self.frames, &tcp);
        screws.copy_from_slice(standing.screws());
        let loads = deviations.iter_mut().zip(loaded.cases);
        let found = loads.map(|(deviation, wrench)| {
            let elastic = standing.elastic(wrench)?.linear;
            let gravity = standing.gravity()?;
            *deviation = gravity.map_or(elastic, |gravity| elastic + gravity.linear);
            Ok(())
        });
        let all: Result<(), Unstable> = found.collect();
        if all.is_err() {
            deviations.fill(Vector3::zeros());
        }
        all
    }
}
