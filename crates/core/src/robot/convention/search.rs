//! The simplest set of changes that explains every reading.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Translation3;

use super::change::{Change, joint_changes, positions_of_the_file, visit_sets};
use super::frames::{Free, FreeBase, fit};
use super::{Comparison, PoseDifference};
use crate::frame::Isometry;
use crate::robot::forward::{forward, joint_axis};
use crate::robot::inverse::posture_at;
use crate::watch::{Cancelled, Watch};

/// Greatest complexity that is searched for an arm of up to [`FEW_TURNING`] revolute joints: the signs of three joints,
/// the zeros of two, the flange frame and the base height, as between a maker's pendant and a model in ROS.
const MOST: usize = 7;
/// The same for more joints.
const MOST_OF_MANY: usize = 5;
/// Revolute joints of an arm without external axes.
const FEW_TURNING: usize = 6;
/// Maximum number of revolute joints: the number of sets of changes grows with its fifth power.
pub const MOST_TURNING: usize = 12;

/// A set of changes with which the readings agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The changes of the file; empty if it is right.
    pub changes: Vec<Change>,
    /// Greatest difference of the readings then.
    pub apart: PoseDifference,
}

/// Result of the comparison.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// One explanation is simpler than all others; without changes, the file agrees.
    Explained {
        /// The changes.
        explanation: Explanation,
        /// Single changes that have no effect on these readings, such as the sign of a joint at zero.
        unseen: Vec<Change>,
    },
    /// Several explanations are equally simple: more readings are needed.
    Undecided(Vec<Explanation>),
    /// Nothing in the list explains the readings.
    Unexplained,
}

/// Result of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Difference of each reading from the forward kinematics of the file.
    pub of_the_file: Vec<PoseDifference>,
    /// The verdict.
    pub verdict: Verdict,
}

/// Why readings are not compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotInspected {
    /// More than [`MOST_TURNING`] revolute joints.
    #[error("{turning} revolute joints exceed the maximum of {MOST_TURNING} for this search")]
    TooManyJoints {
        /// Revolute joints of the robot.
        turning: usize,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Compares readings with a file, and searches for the difference. Every set of changes tried is reported to the watch.
///
/// # Errors
/// More joints than can be searched; [`Cancelled`] if the watch says so.
///
/// # Panics
/// If a reading has another number of joints than the robot.
pub fn inspect(comparison: &Comparison<'_>, watch: Watch<'_>) -> Result<Inspection, NotInspected> {
    let robot = comparison.robot;
    let turning = (0..robot.joints().len())
        .filter(|joint| !robot.slides(*joint))
        .count();
    if turning > MOST_TURNING {
        return Err(NotInspected::TooManyJoints { turning });
    }
    let of_the_file = comparison.readings.iter().map(|reading| {
        let found = posture_at(comparison.robot, &reading.joints, comparison.flange_from_tool);
        let read = comparison.base_from_reference * reading.reference_from_tool;
        PoseDifference::between(&found.base_from_tool, &read)
    });
    Ok(Inspection {
        of_the_file: of_the_file.collect(),
        verdict: verdict(comparison, watch)?,
    })
}

fn verdict(comparison: &Comparison<'_>, watch: Watch<'_>) -> Result<Verdict, Cancelled> {
    let listed = joint_changes(comparison.robot);
    let turning = (0..comparison.robot.joints().len())
        .filter(|joint| !comparison.robot.slides(*joint))
        .count();
    let most = match turning <= FEW_TURNING {
        true => MOST,
        false => MOST_OF_MANY,
    };
    for count in 0..=most {
        let mut found = explanations(comparison, &listed, count, watch)?;
        found.sort_by(|a, b| a.apart.metres.total_cmp(&b.apart.metres));
        match found.len() {
            0 => {}
            1 => {
                let explanation = found.remove(0);
                let unseen = unseen(comparison, &listed, &explanation);
                return Ok(Verdict::Explained { explanation, unseen });
            }
            _ => return Ok(Verdict::Undecided(found)),
        }
    }
    Ok(Verdict::Unexplained)
}

/// Every explanation of complexity `count`.
fn explanations(
    comparison: &Comparison<'_>,
    listed: &[Change],
    count: usize,
    watch: Watch<'_>,
) -> Result<Vec<Explanation>, Cancelled> {
    let go_on = || {
        (watch.finished)(1);
        if watch.is_cancelled() {
            Err(Cancelled)
        } else {
            Ok(())
        }
    };
    let mut found = Vec::new();
    for of_frames in 0..=count {
        let free = Free::counting(of_frames);
        if free.is_empty() {
            break;
        }
        visit_sets(listed, count - of_frames, &mut |joints| {
            let by = |free: &Free| explained_by(comparison, joints, *free);
            found.extend(free.iter().filter_map(by));
            go_on()
        })?;
        // A free zero has complexity 2; with a rotated flange the two are not distinguishable.
        if let Some(others) = (count - of_frames).checked_sub(2) {
            visit_sets(listed, others, &mut |joints| {
                for free in free.iter().filter(|free| !free.flange) {
                    found.extend(with_one_zero_free(comparison, joints, *free));
                }
                go_on()
            })?;
        }
    }
    Ok(found)
}

/// These changes of joints with the best of these frames, if all readings then agree.
fn explained_by(comparison: &Comparison<'_>, joints: &[Change], free: Free) -> Option<Explanation> {
    let flanges = flanges(comparison, joints);
    let (frames, apart) = fit(comparison, &flanges, free)?;
    apart.is_within(&comparison.within).then(|| Explanation {
        changes: joints.iter().copied().chain(frames).collect(),
        apart,
    })
}

/// These changes and the zero of one more joint, off by the angle required by the orientation of the first reading.
fn with_one_zero_free(comparison: &Comparison<'_>, joints: &[Change], free: Free) -> Vec<Explanation> {
    let robot = comparison.robot;
    let Some(first) = comparison.readings.first() else {
        return Vec::new();
    };
    let positions = positions_of_the_file(robot, joints, &first.joints);
    let frames = forward(robot, &positions);
    let found = posture_at(robot, &positions, comparison.flange_from_tool);
    let read = comparison.base_from_reference.rotation * first.reference_from_tool.rotation;
    let turned = (read * found.base_from_tool.rotation.inverse()).scaled_axis();
    let zero_of = |joint: usize| {
        let by = turned.dot(&joint_axis(robot, &frames, joint));
        let has_zero = joints
            .iter()
            .any(|change| matches!(change, Change::Zero { joint: other, .. } if *other == joint));
        // An angle below the tolerance is not a change; a quarter turn is in the list.
        let from_quarter = by - (by / FRAC_PI_2).round() * FRAC_PI_2;
        let free = from_quarter.abs() > comparison.within.radians;
        (free && !has_zero && !robot.slides(joint)).then_some(Change::Zero {
            joint,
            by,
            free: true,
        })
    };
    (0..robot.joints().len())
        .filter_map(zero_of)
        .filter_map(|zero| {
            let joints: Vec<Change> = joints.iter().copied().chain([zero]).collect();
            explained_by(comparison, &joints, free)
        })
        .collect()
}

/// Single changes of joints with which every reading is still explained.
fn unseen(comparison: &Comparison<'_>, listed: &[Change], explanation: &Explanation) -> Vec<Change> {
    let (joints, frames): (Vec<Change>, Vec<Change>) =
        explanation.changes.iter().copied().partition(|change| {
            matches!(
                change,
                Change::Sign { .. } | Change::Zero { .. } | Change::Coupling { .. }
            )
        });
    let free = free_of(&frames);
    // The rotation of the flange stays fixed: a new fit would hide any zero of the last joint.
    let turned = frames.iter().find_map(|change| match change {
        Change::FlangeTurn { turn } => Some(Isometry::from_parts(Translation3::identity(), *turn)),
        _ => None,
    });
    let flange_from_tool = turned.unwrap_or_else(Isometry::identity) * comparison.flange_from_tool;
    let comparison = &Comparison {
        flange_from_tool: &flange_from_tool,
        ..*comparison
    };
    let stays = |change: &&Change| {
        let mut more = joints.clone();
        match more.iter().position(|known| known == *change) {
            // Its opposite: the same sign change reversed.
            Some(index) => {
                more.remove(index);
            }
            None => more.push(**change),
        }
        explained_by(comparison, &more, free).is_some()
    };
    listed.iter().filter(stays).copied().collect()
}

/// The base and unit of these changes, to be fitted again.
fn free_of(frames: &[Change]) -> Free {
    let mut free = Free::default();
    for change in frames {
        match change {
            Change::BaseHeight { .. } => free.base = FreeBase::Height,
            Change::BaseShift { .. } => free.base = FreeBase::Shift,
            Change::Inches => free.inches = true,
            _ => {}
        }
    }
    free
}

/// The file's flange at each reading, with the joint positions of the changed joints.
fn flanges(comparison: &Comparison<'_>, joints: &[Change]) -> Vec<Isometry> {
    let at = |read: &[f64]| {
        let positions = positions_of_the_file(comparison.robot, joints, read);
        let flange = forward(comparison.robot, &positions).base_from_flange;
        Isometry::from_parts(flange.translation, flange.rotation.into())
    };
    comparison
        .readings
        .iter()
        .map(|reading| at(&reading.joints))
        .collect()
}
