//! Whole turns of joints along a program: a joint that can turn past 180 deg continues, it does not turn back.
//!
//! At a single point each joint is in the turn nearest to the middle of its range. Along a cut the joint moves by small
//! steps, so that its turn follows from that at the start: of all whole numbers of turns there that keep the joint within
//! its limits over the whole cut, the one nearest to the end of the cut before is used, at the first cut the one nearest
//! to the middle of its range: between cuts a joint does not turn back without need. Where there is none, of
//! `q + 2 pi k` within its limits the position nearest to the previous one is used from point to point, and the joint
//! must turn back on the way. Whole turns do not change deviations.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::kernel::Answers;
use crate::path::SampledPath;
use crate::robot::{Limits, Robot};

/// Rounding of a position at its limit, rad.
const AT_LIMIT: f64 = 1e-9;

/// Continues the turns of every joint along each cut of `path`; an unreachable point ends a cut.
pub(super) fn continue_turns(robot: &Robot, path: &SampledPath, answers: &mut Answers) {
    let turning = |joint: &usize| !robot.slides(*joint) && !is_coupled(robot, *joint);
    let joints: Vec<usize> = (0..answers.joint_count).filter(turning).collect();
    let mut ends: Vec<Option<f64>> = vec![None; answers.joint_count];
    for stretch in path.stretches() {
        for cut in reached(answers, stretch) {
            let mut turned = vec![false; cut.len()];
            for joint in &joints {
                let limits = robot.joints()[*joint].limits;
                let before: Vec<f64> = (cut.clone().map(|i| answers.joints_at(i)[*joint])).collect();
                let after = continued(&before, limits, ends[*joint]);
                ends[*joint] = after.last().copied();
                for ((i, q), turned) in cut.clone().zip(after).zip(&mut turned) {
                    let position = &mut answers.joints[i * answers.joint_count + joint];
                    *turned |= q != *position;
                    *position = q;
                }
            }
            for i in cut.clone().filter(|i| turned[i - cut.start]) {
                let margin = robot.limit_margin(answers.joints_at(i));
                if let (Ok(evaluation), Some((joint, margin))) = (&mut answers.points[i], margin) {
                    (evaluation.limit_joint, evaluation.limit_margin) = (joint, margin);
                }
            }
        }
    }
}

/// The parts of a stretch without unreachable points.
fn reached(answers: &Answers, stretch: Range<usize>) -> Vec<Range<usize>> {
    let indices: Vec<usize> = stretch.filter(|i| answers.points[*i].is_ok()).collect();
    let parts = indices.chunk_by(|a, b| a + 1 == *b);
    parts.map(|part| part[0]..part[0] + part.len()).collect()
}

/// The positions of a joint, whole turns away from `positions` (rad), along a cut; `end` is the position at the end of the
/// cut before.
fn continued(positions: &[f64], limits: Option<Limits>, end: Option<f64>) -> Vec<f64> {
    let mut all = positions.to_vec();
    for i in 1..all.len() {
        all[i] += TAU * ((all[i - 1] - all[i]) / TAU).round();
    }
    let nearest = end
        .zip(all.first())
        .map_or(0.0, |(end, first)| ((end - first) / TAU).round());
    let Some(limits) = limits else {
        all.iter_mut().for_each(|q| *q += nearest * TAU);
        return all;
    };
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = ((limits.lower - AT_LIMIT - low) / TAU).ceil();
    let most = ((limits.upper + AT_LIMIT - high) / TAU).floor();
    if least <= most {
        let turns = nearest.clamp(least, most);
        all.iter_mut().for_each(|q| *q += turns * TAU);
        return all;
    }
    // The positions change by whole turns where the limit is met.
    let mut all = positions.to_vec();
    for i in 1..all.len() {
        let near = all[i] + TAU * ((all[i - 1] - all[i]) / TAU).round();
        if limits.margin(near) >= 0.0 {
            all[i] = near;
        }
    }
    all
}

/// Whether another joint is coupled to this one.
fn is_coupled(robot: &Robot, joint: usize) -> bool {
    let mut couplings = robot.joints().iter().flat_map(|other| &other.coupling);
    couplings.any(|coupling| coupling.joint == joint)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(half_deg: f64) -> Option<Limits> {
        Some(Limits {
            lower: -half_deg.to_radians(),
            upper: half_deg.to_radians(),
        })
    }

    /// Positions of a joint that turns from `from` by `step` degrees, as single points have them: within 180 deg.
    fn turning(from: f64, step: f64, count: i32) -> Vec<f64> {
        let position = |i: i32| {
            let deg = from + step * f64::from(i);
            (deg - 360.0 * (deg / 360.0).round()).to_radians()
        };
        (0..count).map(position).collect()
    }

    fn degrees(all: Vec<f64>) -> Vec<f64> {
        all.into_iter().map(f64::to_degrees).collect()
    }

    fn largest_step(all: &[f64]) -> f64 {
        all.windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_cut_starts_in_the_turn_that_keeps_all_of_it_within_the_limits() {
        // 540 deg from 10 deg on: within -350 and 350 deg only from -350 deg on.
        let all = degrees(continued(&turning(10.0, 20.0, 28), limits(350.0), None));
        assert!(
            (all[0] + 350.0).abs() < 1e-9 && (all[27] - 190.0).abs() < 1e-9,
            "{all:?}"
        );
        assert!(largest_step(&all) < 20.0 + 1e-9);
        // A cut that fits where it is stays there.
        let all = degrees(continued(&turning(10.0, 20.0, 10), limits(350.0), None));
        assert!((all[0] - 10.0).abs() < 1e-9 && (all[9] - 190.0).abs() < 1e-9);
        // Without limits it goes on and on.
        let all = degrees(continued(&turning(0.0, 30.0, 100), None, None));
        assert!((all[99] - 2970.0).abs() < 1e-6);
    }

    #[test]
    fn a_cut_starts_next_to_the_end_of_the_one_before_where_its_limits_allow() {
        let end = Some((-175f64).to_radians());
        let all = degrees(continued(&turning(178.0, 1.0, 2), limits(350.0), end));
        assert!(
            (all[0] + 182.0).abs() < 1e-9 && (all[1] + 181.0).abs() < 1e-9,
            "{all:?}"
        );
        let all = degrees(continued(&turning(178.0, 1.0, 2), limits(180.0), end));
        assert!((all[0] - 178.0).abs() < 1e-9, "{all:?}");
        let all = degrees(continued(&turning(178.0, 1.0, 2), None, end));
        assert!((all[0] + 182.0).abs() < 1e-9, "{all:?}");
    }

    #[test]
    fn a_cut_that_turns_farther_than_the_range_turns_back_on_the_way() {
        let all = degrees(continued(&turning(0.0, 20.0, 50), limits(350.0), None));
        assert!(all.iter().all(|deg| deg.abs() <= 350.0), "{all:?}");
        assert!(largest_step(&all) > 300.0);
    }
}
