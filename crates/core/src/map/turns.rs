//! Whole turns of joints along a program: a joint that can turn past 180 deg continues, it does not turn back.
//!
//! At a single point each joint is in the turn nearest to the middle of its range. Along a cut the joint moves by small
//! steps: of `q + 2 pi k` within its limits, the one nearest to the previous position is used. Whole turns do not
//! change deviations.

use std::f64::consts::TAU;

use crate::kernel::Answers;
use crate::robot::Robot;

/// Continues the turns of every joint from point to point; `follows` states whether a point is cut after the one before
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

/// Whether another joint is coupled to this one.
fn is_coupled(robot: &Robot, joint: usize) -> bool {
    let mut couplings = robot.joints().iter().flat_map(|other| &other.coupling);
    couplings.any(|coupling| coupling.joint == joint)
}
