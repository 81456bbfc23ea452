//! Displacement and rotation of the tool at the points of a path.
//!
//! The sum of all sources ([`predict`](crate::predict)) in the postures and under the load that were found along the path, with the displacement by the motion. One
//! part comes out, so one load is used: the mean of the load cases, of a cut its mean force. The covariance includes the uncertainties of load and tool, as that of a
//! point does.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::load::{InputUncertainty, PathLoad};
use crate::map::AlongPath;
use crate::path::Track;
use crate::predict::predict;
use crate::removal::EndOrigin;
use crate::robot::forward::forward;
use crate::source::arm_state::LoadedPosture;
use crate::source::{Arm, ArmState, Deviation, Links, MotionDisplacement};
use crate::spatial::{Twist, Wrench};
use crate::watch::{Cancelled, Watch};

/// Where the tool is relative to where it should be, base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipDeviation {
    /// Displacement of the tip (m) and rotation of the tool (rad).
    pub twist: Twist,
    /// Covariance of the displacement, m^2.
    pub covariance: Matrix3<f64>,
}

/// Whether the deviation of the tool is known along all of the move that made a surface: at both of its ends. What no move made is known.
pub fn is_known(deviations: &[Option<TipDeviation>], made_by: EndOrigin) -> bool {
    let at = |index: usize| deviations.get(index).is_none_or(Option::is_some);
    made_by
        .move_index()
        .is_none_or(|index| at(index) && at(index.saturating_sub(1)))
}

/// Points between two reports of progress.
const BLOCK: usize = 256;

/// A path that is followed, with what its deviations need.
#[derive(Clone, Copy)]
pub struct FollowedPath<'a> {
    /// The arm.
    pub arm: Arm<'a>,
    /// Uncertainties of load and tool.
    pub uncertainty: InputUncertainty,
    /// Points and poses.
    pub track: &'a Track,
    /// Postures and load.
    pub along: &'a AlongPath,
    /// The displacement by the motion at a point, if there is one.
    pub motion: &'a (dyn Fn(usize) -> Option<MotionDisplacement> + Sync),
}

impl FollowedPath<'_> {
    /// The deviation at every point; `None` where there is no posture, or no equilibrium under the load.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels.
    pub fn deviations(&self, watch: Watch<'_>) -> Result<Vec<Option<TipDeviation>>, Cancelled> {
        let mut found = vec![None; self.track.len()];
        let blocks = found.par_chunks_mut(BLOCK).enumerate();
        blocks.try_for_each_init(
            || ArmState::new(self.arm),
            |state, (block, out)| {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                for (place, out) in out.iter_mut().enumerate() {
                    *out = self
                        .deviation(state, block * BLOCK + place)
                        .map(|found| TipDeviation {
                            twist: found.twist,
                            covariance: found.covariance,
                        });
                }
                (watch.finished)(out.len());
                Ok(())
            },
        )?;
        Ok(found)
    }

    /// The deviation at one point with its shares: those of the motion are the last ones.
    pub fn deviation_at(&self, index: usize) -> Option<Deviation> {
        self.deviation(&mut ArmState::new(self.arm), index)
    }

    fn deviation(&self, state: &mut ArmState<'_>, index: usize) -> Option<Deviation> {
        let answers = &self.along.answers;
        answers.points.get(index)?.as_ref().ok()?;
        let joints = answers.joints_at(index);
        state.set_joints(joints);
        let mut links = match &self.along.backlash_geometry {
            Some(unloaded) => Links::KeptByFriction(unloaded.link_offsets_at(index, answers.joint_count)),
            None => Links::Neglected,
        };
        let wrench = mean_wrench(self.track, &self.along.load, index);
        let mut found = predict(state, &wrench, &mut links).ok()?;
        if let Some(motion) = (self.motion)(index) {
            found.add_motion(&motion);
        }
        found.covariance += self.covariance_of_inputs(state, joints, &wrench)?;
        Some(found)
    }

    /// Covariance of the displacement by the uncertainties of load and tool, m^2.
    fn covariance_of_inputs(
        &self,
        state: &mut ArmState<'_>,
        joints: &[f64],
        wrench: &Wrench,
    ) -> Option<Matrix3<f64>> {
        let mut covariance = Matrix3::zeros();
        if self.uncertainty.is_none() {
            return Some(covariance);
        }
        let frames = forward(self.arm.robot, joints);
        let tool = *state.base_from_tool();
        let posture = LoadedPosture {
            joints,
            frames: &frames,
            tcp: tool.translation.vector.into(),
            tool_axis: tool.rotation * Vector3::z(),
            wrench,
        };
        let mut by_input: Vec<Vector3<f64>> = Vec::new();
        for axis in 0..3 {
            let mut input = 0;
            let add = |by: f64| {
                if input == by_input.len() {
                    by_input.push(Vector3::zeros());
                }
                by_input[input][axis] = by;
                input += 1;
            };
            let along = Vector3::ith(axis, 1.0);
            state
                .displacements_by_inputs(&self.uncertainty, &posture, &along, add)
                .ok()?;
        }
        for by in by_input {
            covariance += by * by.transpose();
        }
        Some(covariance)
    }
}

/// The mean of the load cases at a point; of a cut its mean force.
fn mean_wrench(track: &Track, load: &PathLoad, index: usize) -> Wrench {
    let mut cases = vec![Wrench::ZERO; load.case_count()];
    track.wrenches(load, index, &mut cases);
    let used = match load {
        PathLoad::Cuts(_) => &cases[..cases.len().min(1)],
        _ => cases.as_slice(),
    };
    let share = 1.0 / used.len().max(1) as f64;
    let mean = |part: fn(&Wrench) -> Vector3<f64>| used.iter().map(part).sum::<Vector3<f64>>() * share;
    Wrench {
        force: mean(|case| case.force),
        moment: mean(|case| case.moment),
    }
}
