//! Smooths spin, lean and external axes: removes the steps of the lattice of a search.
//!
//! Straight lines through the middles of the steps, so that every value is within half a step of the chain. A line ends
//! where the arm stops and changes its posture, and at rapids.

use crate::path::SampledPath;

/// The value of a freedom at each point, rad (m), of a chain with these values in steps of `step`, `None` where it has no
/// state; `period`: of a spin, a whole turn. `breaks` as in the chain, in ascending order.
pub(super) fn without_steps(
    path: &SampledPath,
    (step, period): (f64, Option<f64>),
    values: &[Option<f64>],
    breaks: &[usize],
) -> Vec<f64> {
    let begins = |index: usize| path.begins(index) || breaks.binary_search(&index).is_ok();
    let mut turns: Vec<f64> = Vec::with_capacity(values.len());
    let first = values.iter().flatten().next().copied().unwrap_or(0.0);
    for (index, here) in values.iter().enumerate() {
        let before = turns.last().copied();
        turns.push(match (*here, before, period) {
            // The shorter direction from the point before.
            (Some(here), Some(before), Some(period)) if !begins(index) => {
                here + period * ((before - here) / period).round()
            }
            (Some(here), ..) => here,
            (None, before, _) => before.unwrap_or(first),
        });
    }
    let mut smooth = turns.clone();
    let starts: Vec<usize> = (0..values.len()).filter(|index| begins(*index)).collect();
    let ends = starts.iter().skip(1).copied().chain([values.len()]);
    for (start, end) in starts.iter().zip(ends) {
        let along: Vec<f64> = path.points[*start..end].iter().map(|point| point.along).collect();
        straighten(&along, step, &mut smooth[*start..end]);
    }
    smooth
}

/// Replaces the steps of `turns` (at the positions `along`) by straight lines through the middles of the steps.
fn straighten(along: &[f64], step: f64, turns: &mut [f64]) {
    let last = turns.len() - 1;
    // Positions and turns on the lines: the middle of a step. A change of several steps at once takes place between its
    // two points, except for half a step at either end.
    let mut knots: Vec<(f64, f64)> = vec![(along[0], turns[0])];
    for (index, pair) in turns.windows(2).enumerate() {
        let by = pair[1] - pair[0];
        if by == 0.0 {
            continue;
        }
        let half = 0.5 * step * by.signum();
        if by.abs() < 1.5 * step {
            knots.push((0.5 * (along[index] + along[index + 1]), pair[0] + half));
            continue;
        }
        for knot in [(along[index], pair[0] + half), (along[index + 1], pair[1] - half)] {
            match knots.last_mut() {
                // Steps on both sides of a point: the line goes through the middle of both, the turn of the point.
                Some(before) if before.0 == knot.0 && index > 0 => before.1 = 0.5 * (before.1 + knot.1),
                _ => knots.push(knot),
            }
        }
    }
    knots.push((along[last], turns[last]));
    let mut knot = 0;
    for (at, turn) in along.iter().zip(turns) {
        while knot + 2 < knots.len() && knots[knot + 1].0 <= *at {
            knot += 1;
        }
        let [(from, a), (to, b)] = [knots[knot], knots[knot + 1]];
        if to > from {
            *turn = a + (b - a) * ((at - from) / (to - from)).clamp(0.0, 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use nalgebra::Point2;

    use super::*;
    use crate::arms::Stream;
    use crate::optimize::Steps;
    use crate::path::Shape;

    const SPINS: Steps = Steps {
        first: -0.5,
        step: 0.1,
        count: 40,
    };

    fn path(points: usize) -> SampledPath {
        let end = Point2::new(points as f64 - 1.0, 0.0);
        Shape::Polyline(vec![Point2::origin(), end]).sampled(1.0)
    }

    fn smoothed(turns: &[usize], breaks: &[usize]) -> Vec<f64> {
        let values: Vec<_> = turns.iter().map(|turn| Some(SPINS.at(*turn))).collect();
        without_steps(&path(turns.len()), (SPINS.step, Some(TAU)), &values, breaks)
    }

    #[test]
    fn a_staircase_becomes_a_line_and_its_ends_stay() {
        let turns: Vec<usize> = (0..41).map(|i| i / 4).collect();
        let smooth = smoothed(&turns, &[]);
        assert!((smooth[0] - SPINS.at(0)).abs() < 1e-12 && (smooth[40] - SPINS.at(10)).abs() < 1e-12);
        // A step in four points, 0.025 rad each; the last is half a step in half a point, and half of 0.025 before it.
        assert!(
            smooth
                .windows(2)
                .all(|pair| pair[1] >= pair[0] - 1e-12 && pair[1] - pair[0] < 0.0625 + 1e-12)
        );
    }

    #[test]
    fn no_turn_leaves_the_chain_by_more_than_half_a_step_even_at_breaks() {
        let mut random = Stream(3);
        for _ in 0..500 {
            let count = 2 + (random.next() * 60.0) as usize;
            let mut turn = 20_isize;
            let mut breaks = Vec::new();
            let turns: Vec<usize> = (0..count)
                .map(|index| {
                    if index > 0 && random.next() < 0.05 {
                        breaks.push(index);
                        turn = (random.next() * 40.0) as isize;
                    } else if random.next() < 0.4 {
                        turn = (turn + (random.next() * 7.0) as isize - 3).clamp(0, 39);
                    }
                    turn as usize
                })
                .collect();
            let smooth = smoothed(&turns, &breaks);
            for (smooth, turn) in smooth.iter().zip(&turns) {
                // Rounding of turns of a few radians.
                assert!(
                    (smooth - SPINS.at(*turn)).abs() < 0.5 * SPINS.step + 1e-12,
                    "{turns:?} {breaks:?}"
                );
            }
        }
    }
}
