//! Thinned lattice of path points and tool turns, for pictures of a search.

use super::steps::Steps;
use crate::kernel::{PostureStatus, SLOTS};

/// Path points by turns of the tool: the deviations, and the chain.
#[derive(Clone, Debug, Default)]
pub struct Lattice {
    /// Indices of the points.
    pub points: Vec<usize>,
    /// Turns, rad.
    pub spins: Vec<f64>,
    /// Selected component of the deviation, m, point after point, turn after turn: in the posture of the chain where it
    /// can be used, otherwise in the best one; infinite where none can be used.
    pub deviations: Vec<f64>,
    /// Status of that posture.
    pub statuses: Vec<PostureStatus>,
    /// Index of the chain's turn at each point.
    pub chain: Vec<Option<usize>>,
}

impl Lattice {
    pub(super) fn of(
        spins: &Steps,
        kept: &[(usize, Vec<f64>, Vec<PostureStatus>)],
        states: &[Option<usize>],
    ) -> Lattice {
        let mut lattice = Lattice {
            spins: (0..spins.count).map(|turn| spins.at(turn)).collect(),
            ..Lattice::default()
        };
        for (index, deviations, statuses) in kept {
            let state = states[*index];
            lattice.points.push(*index);
            lattice.chain.push(state.map(|state| state / SLOTS));
            for turn in 0..spins.count {
                let slots = turn * SLOTS..(turn + 1) * SLOTS;
                let best = slots.min_by(|a, b| {
                    deviations[*a]
                        .total_cmp(&deviations[*b])
                        .then(statuses[*a].cmp(&statuses[*b]))
                });
                let followed = state.map(|state| turn * SLOTS + state % SLOTS);
                let shown = followed.or(best).unwrap_or(turn * SLOTS);
                lattice.deviations.push(deviations[shown]);
                lattice.statuses.push(statuses[shown]);
            }
        }
        lattice
    }
}
