//! Every posture of many poses, in flat arrays.
//!
//! Blocks of poses on all threads of the current rayon pool; a single block is done where it is asked for. Each pose is
//! looked at by itself: of a searched chain too, what comes out depends on no pose before it and on no thread.

use rayon::prelude::*;

use super::answer::AT_LIMIT;
use crate::frame::Isometry;
use crate::robot::inverse::{Finder, Wanted};
use crate::robot::{PostureName, Robot, Unreachable};
use crate::watch::{Cancelled, Watch};

/// Poses in a block: enough to make the hand-over cheap, few enough to cancel soon.
const AT_ONCE: usize = 128;

/// The postures of many poses, those of one pose behind those of the pose before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PosturesAt {
    /// Of each pose how many postures hold it, or why none does.
    pub poses: Vec<Result<usize, Unreachable>>,
    /// Joint positions of every posture, rad (m), as many a posture as joints.
    pub joints: Vec<f64>,
    /// Its name.
    pub names: Vec<PostureName>,
    /// Whether every joint stands inside its limits.
    pub within_limits: Vec<bool>,
}

/// Every posture that holds the flange at each of `count` poses; `base_from_flange(i)` gives the pose of point `i`. Of a
/// searched chain those that were found. `home`: see [`Wanted::home`].
///
/// # Errors
/// [`Cancelled`] if the watch says so.
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
            let requested = Wanted {
                base_from_flange: base_from_flange(i),
                near: None,
                home,
            };
            let all = finder.all(&requested);
            found.poses.push(all.map(<[_]>::len));
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
