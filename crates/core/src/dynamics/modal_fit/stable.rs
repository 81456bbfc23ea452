//! Poles that remain over the orders of the denominator: stabilisation.
//!
//! A pole is stable if the next lower order has one within 1 % of its frequency and 5 % of its damping ratio. Poles that follow each other are a chain;
//! chains of several orders are candidates for modes.

use super::denominator::Pole;

/// Greatest damping ratio of a candidate.
pub(super) const LARGEST_DAMPING: f64 = 0.3;
/// Largest relative change of frequency and damping ratio from one order to the next.
const CHANGE: [f64; 2] = [0.01, 0.05];
/// Steps from order to order that a candidate is stable at least.
const STEPS: usize = 4;

/// A candidate for a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// Its pole, at the highest order of its chain.
    pub pole: Pole,
    /// Orders at which it is stable.
    pub orders: usize,
    /// Place of the highest order of its chain.
    last: usize,
}

impl Candidate {
    /// Whether both were found at the same order, so that they are two.
    fn is_next_to(&self, other: &Candidate) -> bool {
        self.last + other.orders >= other.last && other.last + self.orders >= self.last
    }
}

/// Candidates by the number of orders at which they are stable, the most stable first.
pub(super) fn candidates(by_order: &[Vec<Pole>]) -> Vec<Candidate> {
    let mut ended: Vec<Candidate> = Vec::new();
    let mut chains: Vec<Candidate> = Vec::new();
    for (last, poles) in by_order.iter().enumerate() {
        let mut free = chains;
        let mut next = Vec::new();
        for pole in poles.iter().filter(|pole| pole.damping_ratio < LARGEST_DAMPING) {
            let nearest = (0..free.len())
                .filter(|k| is_same(&free[*k].pole, pole))
                .min_by(|a, b| distance(&free[*a].pole, pole).total_cmp(&distance(&free[*b].pole, pole)));
            let orders = nearest.map_or(0, |k| free.swap_remove(k).orders + 1);
            next.push(Candidate {
                pole: *pole,
                orders,
                last,
            });
        }
        ended.extend(free);
        chains = next;
    }
    ended.extend(chains);
    ended.retain(|candidate| candidate.orders >= STEPS);
    ended.sort_by(|a, b| {
        let by_orders = b.orders.cmp(&a.orders);
        by_orders.then(a.pole.angular_frequency.total_cmp(&b.pole.angular_frequency))
    });
    // A chain that was interrupted is found twice.
    let mut distinct: Vec<Candidate> = Vec::new();
    for candidate in ended {
        let is_again =
            |other: &Candidate| is_same(&other.pole, &candidate.pole) && !other.is_next_to(&candidate);
        if !distinct.iter().any(is_again) {
            distinct.push(candidate);
        }
    }
    distinct
}

fn is_same(one: &Pole, other: &Pole) -> bool {
    (one.angular_frequency - other.angular_frequency).abs() <= CHANGE[0] * other.angular_frequency
        && (one.damping_ratio - other.damping_ratio).abs() <= CHANGE[1] * other.damping_ratio
}

fn distance(one: &Pole, other: &Pole) -> f64 {
    let across = one.angular_frequency - other.angular_frequency;
    let decay = one.damping_ratio * one.angular_frequency - other.damping_ratio * other.angular_frequency;
    across.hypot(decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pole(angular_frequency: f64, damping_ratio: f64) -> Pole {
        Pole {
            angular_frequency,
            damping_ratio,
        }
    }

    #[test]
    fn chains_of_stable_poles_are_candidates_and_others_are_not() {
        let orders: Vec<Vec<Pole>> = (0..8)
            .map(|k| {
                let drift = 1.0 + 1e-3 * f64::from(k);
                vec![
                    pole(100.0 * drift, 0.02),
                    // Its damping ratio changes by 10 % from order to order.
                    pole(200.0, 0.01 * 1.1_f64.powi(k)),
                    pole(300.0, 0.5),
                ]
            })
            .collect();
        let found = candidates(&orders);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].orders, 7);
        assert!((found[0].pole.angular_frequency - 100.7).abs() < 1e-9);
    }

    #[test]
    fn two_close_poles_are_two_candidates() {
        let orders = vec![vec![pole(100.0, 0.02), pole(100.4, 0.021)]; 6];
        assert_eq!(candidates(&orders).len(), 2);
    }

    #[test]
    fn an_interrupted_chain_is_one_candidate() {
        let mut orders = vec![vec![pole(100.0, 0.02)]; 16];
        orders[8].clear();
        let found = candidates(&orders);
        assert_eq!(found.len(), 1, "{found:?}");
    }
}
