//! Clearance of holder, spindle and links from the stock, as it becomes while it is cut.
//!
//! The stock is cut again in the order of the path. At each point with a posture, the bodies that may not touch the part
//! are measured against the columns that are left there ([`crate::path::remaining`]); a cutter may touch them. A point
//! where they are nearer than demanded, or touch, has no posture that keeps the clearance.
//!
//! Not included: what tilted tools cut, and the way between two points.

use nalgebra::Vector3;

use super::along::AlongPath;
use super::arm_near_stock::ArmNearStock;
use crate::kernel::{Answers, Question};
use crate::path::CutStock;
use crate::robot::Unreachable;
use crate::watch::{Cancelled, Watch};

/// Points between two checks of the watch.
const POINTS_A_LOOK: usize = 256;
/// Distances up to this above the demanded one are measured where only those below it matter, m: contact has none.
const BEYOND: f64 = 1e-9;

/// Measures the clearance at every point with a posture, from the bodies of the cell and from what is left of the `stock`
/// there. Points that do not keep the demanded clearance from the stock lose their answers; nothing if `question`
/// demands no clearance.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn measure_stock_clearances(
    question: &Question<'_>,
    stock: &CutStock<'_>,
    along: &mut AlongPath,
    watch: Watch<'_>,
) -> Result<(), Cancelled> {
    along.answers.measure_clearances(question);
    keep_clear(question, stock, &mut along.answers, watch)
}

/// [`measure_stock_clearances`] without the clearances of the points that keep what is demanded.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub(crate) fn exclude_points_near_stock(
    question: &Question<'_>,
    stock: &CutStock<'_>,
    along: &mut AlongPath,
    watch: Watch<'_>,
) -> Result<(), Cancelled> {
    keep_clear(question, stock, &mut along.answers, watch)
}

/// Excludes points near the stock, and where clearances have been measured in the cell, measures them from the stock too.
fn keep_clear(
    question: &Question<'_>,
    stock: &CutStock<'_>,
    answers: &mut Answers,
    watch: Watch<'_>,
) -> Result<(), Cancelled> {
    let Some(demanded) = question.clearance else {
        return Ok(());
    };
    let farthest = match answers.clearances.is_empty() {
        true => demanded.least + BEYOND,
        false => f64::INFINITY,
    };
    let mut arm = ArmNearStock::new(question, demanded, stock);
    let mut replay = stock.replay();
    for index in 0..answers.points.len() {
        if index % POINTS_A_LOOK == 0 {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            (watch.finished)(POINTS_A_LOOK.min(answers.points.len() - index));
        }
        let Some(remaining) = replay.next_point() else {
            break;
        };
        if answers.points[index].is_err() {
            continue;
        }
        arm.set_joints(answers.joints_at(index));
        for (is_near_by_design, least) in [(false, demanded.least), (true, 0.0)] {
            let so_far = answers.clearances.get(index).copied().flatten();
            let limit = so_far.map_or(farthest, |found| found.nearest.distance.min(farthest));
            let found = arm.nearest(remaining, limit, is_near_by_design);
            let Some(found) = found.filter(|_| answers.points[index].is_ok()) else {
                continue;
            };
            let distance = found.nearest.distance;
            if distance < least || distance == 0.0 {
                lose(answers, index, found.bodies, demanded.least - distance);
            } else if let Some(measured) = answers.clearances.get_mut(index) {
                *measured = Some(found);
            }
        }
    }
    Ok(())
}

/// Removes the answer of a point where this much of the clearance of two bodies is missing, m.
fn lose(answers: &mut Answers, index: usize, bodies: [usize; 2], missing: f64) {
    if let Some(measured) = answers.clearances.get_mut(index) {
        *measured = None;
    }
    answers.points[index] = Err(Unreachable::InCollision { missing, bodies });
    let (joints, cases, shares) = (answers.joint_count, answers.case_count, answers.share_count);
    answers.joints[index * joints..][..joints].fill(0.0);
    answers.deviations[index * cases..][..cases].fill(Vector3::zeros());
    answers.shares[index * shares..][..shares].fill(0.0);
}
