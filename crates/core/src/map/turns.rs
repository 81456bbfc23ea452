//! Whole turns of joints along a program: a joint that may turn past 180 deg goes on, it does not turn back.
//!
//! A point alone is answered with each joint in the turn nearest to the middle of its range. Along a cut the joint stands
//! one step from where it stood before, so of `q + 2 pi k` within its limits the one nearest to the position before is
//! taken. Deviations do not change by whole turns.

use std::f64::consts::TAU;

use crate::kernel::Answers;
use crate::robot::Robot;

/// Counts the turns of every joint on from point to point; `follows` says whether a point is cut after the one before
/// without a rapid between them.
pub(super) fn count_on(robot: &Robot, answers: &mut Answers, follows: impl Fn(usize) -> bool) {
    let joints: Vec<usize> = (0..answers.joint_count)
        .filter(|joint| !robot.slides(*joint) && !is_coupled(robot, *joint))
        .collect();
    for index in 1..answers.points.len() {
        if !follows(index) || answers.points[index - 1].is_err() {
            continue;
        }
        let Ok(evaluation) = &mut answers.points[index] else {
            continue;
        };
        let (before, here) = answers.joints.split_at_mut(index * answers.joint_count);
        let before = &before[(index - 1) * answers.joint_count..];
        let here = &mut here[..answers.joint_count];
        let mut turned = false;
        for joint in &joints {
            let (from, q) = (before[*joint], &mut here[*joint]);
            let turns = ((from - *q) / TAU).round();
            let limits = robot.joints()[*joint].limits;
            if turns != 0.0 && limits.is_none_or(|limits| limits.margin(*q + turns * TAU) >= 0.0) {
                *q += turns * TAU;
                turned = true;
            }
        }
        if turned && let Some((joint, margin)) = robot.limit_margin(here) {
            (evaluation.limit_joint, evaluation.limit_margin) = (joint, margin);
        }
    }
}

/// Whether another joint's count follows this one.
fn is_coupled(robot: &Robot, joint: usize) -> bool {
    let mut couplings = robot.joints().iter().flat_map(|other| &other.coupling);
    couplings.any(|coupling| coupling.joint == joint)
}
