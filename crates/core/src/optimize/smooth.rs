//! Turns of the tool without the steps of the lattice that they were found on.

use std::f64::consts::TAU;

use super::posture::Spins;
use crate::kernel::SLOTS;
use crate::path::SampledPath;

/// Turns of the chain without their steps: on each stretch straight lines through the middles of the steps, half a
/// step from the chain at the most.
pub(super) fn without_steps(path: &SampledPath, spins: &Spins, states: &[Option<usize>]) -> Vec<f64> {
    let points = &path.points;
    let mut turns: Vec<f64> = Vec::with_capacity(states.len());
    for (index, state) in states.iter().enumerate() {
        let here = state.map(|state| spins.at(state / SLOTS));
        let before = turns.last().copied().filter(|_| !path.begins(index));
        turns.push(match (here, before) {
            // The shorter way round from the point before.
            (Some(here), Some(before)) => here + TAU * ((before - here) / TAU).round(),
            (Some(here), None) => here,
            (None, before) => before.unwrap_or(0.0),
        });
    }
    let mut smooth = turns.clone();
    for stretch in path.stretches() {
        let last = stretch.end - 1;
        let along = |index: usize| points[index].along;
        // Where the line is, and its turn there: at the middle of each step, and at the ends.
        let steps = (stretch.start..last).filter(|index| turns[*index] != turns[index + 1]);
        let middles = steps.map(|index| {
            let middle = |a: f64, b: f64| 0.5 * (a + b);
            (
                middle(along(index), along(index + 1)),
                middle(turns[index], turns[index + 1]),
            )
        });
        let begin = (along(stretch.start), turns[stretch.start]);
        let knots: Vec<(f64, f64)> = std::iter::once(begin)
            .chain(middles)
            .chain([(along(last), turns[last])])
            .collect();
        let mut knot = 0;
        for index in stretch {
            while knot + 2 < knots.len() && knots[knot + 1].0 <= along(index) {
                knot += 1;
            }
            let [(from, a), (to, b)] = [knots[knot], knots[knot + 1]];
            if to > from {
                smooth[index] = a + (b - a) * ((along(index) - from) / (to - from)).clamp(0.0, 1.0);
            }
        }
    }
    smooth
}
