//! Every posture of many poses, in flat arrays.
//!
//! Blocks of poses on all threads of the current rayon pool; a single block is computed on the calling thread. Each
//! pose is solved separately, also of a chain without a closed-form solution: the result does not depend on other poses
//! or on the thread.

use rayon::prelude::*;

use super::answer::AT_LIMIT;
use crate::frame::Isometry;
use crate::robot::inverse::{Finder, InverseTarget};
use crate::robot::{PostureName, Robot, Unreachable};
use crate::watch::{Cancelled, Watch};

/// Poses in a block: enough to make the hand-over cheap, few enough to cancel soon.
const AT_ONCE: usize = 128;

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
    let block = |finder: &mut Finder<'_>, first: usize| {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let mut found = PosturesAt::default();
        let last = count.min(first + AT_ONCE);
        for i in first..last {
            finder.forget();
            let requested = InverseTarget {
                base_from_flange: base_from_flange(i),
                near: None,
                home,
            };
            let all = finder.all(&requested);
            found.poses.push(all.map(<[_]>::len));
            let count = all.map_or(0, <[_]>::len);
            found.joints.reserve(count * robot.joints().len());
            found.names.reserve(count);
            found.within_limits.reserve(count);
            for posture in all.unwrap_or_default() {
                let margin = robot.limit_margin(&posture.joints);
                found.joints.extend_from_slice(&posture.joints);
                found.names.push(posture.name);
                found
                    .within_limits
                    .push(margin.is_none_or(|(_, margin)| margin >= -AT_LIMIT));
            }
        }
        (watch.finished)(last - first);
        Ok(found)
    };
    if count <= AT_ONCE {
        return block(&mut Finder::new(robot), 0);
    }
    let blocks: Result<Vec<PosturesAt>, Cancelled> = (0..count.div_ceil(AT_ONCE))
        .into_par_iter()
        .map_init(|| Finder::new(robot), |finder, i| block(finder, i * AT_ONCE))
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

#[cfg(test)]
mod tests;
