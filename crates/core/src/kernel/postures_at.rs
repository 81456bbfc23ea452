//! Every posture of many poses, in flat arrays.
//!
//! Blocks of poses on all threads of the current rayon pool; a single block is computed on the calling thread. Arms with
//! named branches go through lanes, and what these cannot decide one pose after the other. The postures of a pose do not
//! depend on other poses or on the thread, also of a chain without a closed-form solution.

use rayon::prelude::*;

use super::answer::AT_LIMIT;
use super::lanes::{EveryBranch, POINTS};
use super::question::Question;
use crate::frame::Isometry;
use crate::robot::inverse::{Finder, InverseTarget};
use crate::robot::{PostureName, Robot, Unreachable};
use crate::source::{Arm, StiffnessModel};
use crate::watch::{Cancelled, Watch};

/// Poses in a block: one call of the lanes.
const AT_ONCE: usize = POINTS;

/// The postures of many poses, in the order of the poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PosturesAt {
    /// Number of postures of each pose, or why there is none.
    pub poses: Vec<Result<usize, Unreachable>>,
    /// Joint positions of every posture, rad (m), one value per joint.
    pub joints: Vec<f64>,
    /// Its name.
    pub names: Vec<PostureName>,
    /// Whether every joint is inside its limits.
    pub within_limits: Vec<bool>,
}

/// Every posture that reaches the flange pose at each of `count` poses; `base_from_flange(i)` gives the pose of point
/// `i`. Of a chain without a closed-form solution, the postures that were found. `home`: see [`InverseTarget::home`].
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn postures_at(
    robot: &Robot,
    count: usize,
    base_from_flange: impl Fn(usize) -> Isometry + Sync,
    home: Option<&[f64]>,
    watch: Watch<'_>,
) -> Result<PosturesAt, Cancelled> {
    let arm = Arm {
        robot,
        compliance: &[],
        model: StiffnessModel::DRIVES,
        flange_from_tool: &Isometry::identity(),
    };
    let question = Question::unloaded(arm, home);
    let solver = || Postures {
        robot,
        home,
        lanes: (count > 1).then(|| EveryBranch::of(&question)).flatten(),
        finder: Finder::new(robot),
        poses: Vec::with_capacity(AT_ONCE),
    };
    let block = |solver: &mut Postures<'_>, first: usize| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let last = count.min(first + AT_ONCE);
        let found = solver.of((first..last).map(&base_from_flange));
        (watch.finished)(last - first);
        Ok(found)
    };
    if count <= AT_ONCE {
        return block(&mut solver(), 0);
    }
    let blocks: Result<Vec<PosturesAt>, Cancelled> = (0..count.div_ceil(AT_ONCE))
        .into_par_iter()
        .map_init(solver, |solver, i| block(solver, i * AT_ONCE))
        .collect();
    let mut all = PosturesAt::default();
    for found in blocks? {
        all.poses.extend(found.poses);
        all.joints.extend(found.joints);
        all.names.extend(found.names);
        all.within_limits.extend(found.within_limits);
    }
    Ok(all)
}

/// Solves block after block.
struct Postures<'r> {
    robot: &'r Robot,
    home: Option<&'r [f64]>,
    /// For arms whose branches have names.
    lanes: Option<EveryBranch>,
    finder: Finder<'r>,
    poses: Vec<Isometry>,
}

impl Postures<'_> {
    /// The postures of these flange poses, at most [`AT_ONCE`].
    fn of(&mut self, poses: impl Iterator<Item = Isometry>) -> PosturesAt {
        self.poses.clear();
        self.poses.extend(poses);
        if let Some(lanes) = &mut self.lanes {
            lanes.solve(&self.poses);
        }
        let mut found = PosturesAt::default();
        for (i, pose) in self.poses.iter().enumerate() {
            let before = found.names.len();
            if let Some(lanes) = self.lanes.as_ref().filter(|lanes| lanes.decides(i)) {
                let PosturesAt {
                    joints,
                    names,
                    within_limits,
                    ..
                } = &mut found;
                lanes.take(i, joints, |branch, inside| {
                    names.push(PostureName::Branch(branch));
                    within_limits.push(inside);
                });
                found.poses.push(Ok(found.names.len() - before));
                continue;
            }
            self.finder.forget();
            let requested = InverseTarget {
                base_from_flange: *pose,
                near: None,
                home: self.home,
            };
            let all = self.finder.all(&requested);
            found.poses.push(all.map(<[_]>::len));
            for posture in all.unwrap_or_default() {
                let margin = self.robot.limit_margin(&posture.joints);
                found.joints.extend_from_slice(&posture.joints);
                found.names.push(posture.name);
                found
                    .within_limits
                    .push(margin.is_none_or(|(_, margin)| margin >= -AT_LIMIT));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests;
