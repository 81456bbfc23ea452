//! Points of a path by turns of the tool, thinned out: what a picture shows of a search.

use super::posture::Spins;
use crate::kernel::{SLOTS, Stand};

/// Points of the path by turns of the tool: what each would deviate by, and the chain.
#[derive(Clone, Debug, Default)]
pub struct Lattice {
    /// Which points.
    pub points: Vec<usize>,
    /// Turns, rad.
    pub spins: Vec<f64>,
    /// At each point, turn after turn: the deviation that counts, m, in the posture of the chain where it stands, else in
    /// the best; infinite where none stands.
    pub deviations: Vec<f64>,
    /// Whether that posture stands, and why not.
    pub stands: Vec<Stand>,
    /// Index of the chain's turn at each point.
    pub chain: Vec<Option<usize>>,
}

impl Lattice {
    pub(super) fn of(
        spins: &Spins,
        kept: &[(usize, Vec<f64>, Vec<Stand>)],
        states: &[Option<usize>],
    ) -> Lattice {
        let mut lattice = Lattice {
            spins: (0..spins.count).map(|turn| spins.at(turn)).collect(),
            ..Lattice::default()
        };
        for (index, deviations, stands) in kept {
            let state = states[*index];
            lattice.points.push(*index);
            lattice.chain.push(state.map(|state| state / SLOTS));
            for turn in 0..spins.count {
                let slots = turn * SLOTS..(turn + 1) * SLOTS;
                let best = slots.min_by(|a, b| {
                    deviations[*a]
                        .total_cmp(&deviations[*b])
                        .then(stands[*a].cmp(&stands[*b]))
                });
                let followed = state.map(|state| turn * SLOTS + state % SLOTS);
                let shown = followed.or(best).unwrap_or(turn * SLOTS);
                lattice.deviations.push(deviations[shown]);
                lattice.stands.push(stands[shown]);
            }
        }
        lattice
    }
}
