use super::super::grid::UNSHIFTED;
use super::*;
use crate::arms::Stream;

/// A small random lattice.
struct Made {
    turns: Turns,
    costs: Vec<Vec<f64>>,
    beginnings: Vec<Beginning>,
    shifts: Vec<Shift>,
    /// For each column: the transitions on, and the turns, by turn, slots and neighbour.
    seed: u64,
}

struct MadeLinks {
    seed: u64,
    column: usize,
}

impl MadeLinks {
    /// Two of three transitions exist, the same for every call.
    fn exists(&self, numbers: [usize; 5]) -> bool {
        let mixed = numbers.iter().fold(self.seed ^ self.column as u64, |sum, n| {
            sum.wrapping_mul(1_000_003) ^ *n as u64
        });
        Stream(mixed).next() > 0.34
    }
}

impl Links for MadeLinks {
    fn goes_on(&self, [from, to]: [usize; 2]) -> bool {
        self.exists([0, from, to, 0, 0])
    }
    fn moves_on(&self, [from, to]: [usize; 2]) -> Heading {
        let up = |joint| {
            if self.exists([2, from, to, joint, 0]) {
                1.0
            } else {
                -1.0
            }
        };
        Heading::of((0..3).map(up))
    }
    fn turns(&self, axis: usize, [from, to]: [usize; 2]) -> bool {
        self.exists([1, axis, from, to, 0])
    }
    fn moves_by_turn(&self, _: [usize; 2]) -> Heading {
        unreachable!("the tool keeps its turn wherever reversals have a price")
    }
    fn starts(&self, _: usize) -> Winding {
        Winding::default()
    }
    fn winds_on(&self, before: &Winding, _: [usize; 2]) -> Option<Winding> {
        Some(*before)
    }
    fn winds_by_turn(&self, before: &Winding, _: [usize; 2]) -> Option<Winding> {
        Some(*before)
    }
}

fn made(seed: u64, kept_slots: bool) -> Made {
    let mut random = Stream(seed);
    let mut up_to = |most: f64| 1 + (random.next() * most) as usize;
    let counts = [up_to(4.0), up_to(3.0), 1, up_to(1.5), 1, 1];
    let turns = Turns {
        grid: Grid::new(counts, seed.is_multiple_of(2) && random.next() < 0.5),
        kept_slots,
        price: 0.1 * random.next(),
        back_price: 0.0,
        winds: true,
    };
    let columns = 2 + (random.next() * 4.0) as usize;
    let cost = |random: &mut Stream| {
        // Few states of the eight slots, so that every chain can be tried.
        let sum = random.next();
        if random.next() < 0.5 { f64::INFINITY } else { sum }
    };
    let costs: Vec<Vec<f64>> = (0..columns)
        .map(|_| {
            let unreachable = random.next() < 0.1;
            (0..turns.grid.len() * SLOTS)
                .map(|state| {
                    if unreachable || state % SLOTS > 1 {
                        f64::INFINITY
                    } else {
                        cost(&mut random)
                    }
                })
                .collect()
        })
        .collect();
    let beginnings = (0..columns)
        .map(|i| match (i, random.next()) {
            (0, _) => Beginning::Restart,
            (_, part) if part < 0.1 => Beginning::Restart,
            (_, part) => {
                let steps = (part * 3.0) as usize;
                Beginning::Follows([steps, 2 - steps, 0, 1, 0, 0])
            }
        })
        .collect();
    // Of every second lattice the settings of a column are not those of the column before.
    let shift = |random: &mut Stream| {
        let step = (random.next() * 3.0) as isize - 1;
        [step, -step, 0, 0, 0, 0]
    };
    let shifts = (0..columns).map(|_| {
        if seed.is_multiple_of(2) {
            UNSHIFTED
        } else {
            shift(&mut random)
        }
    });
    Made {
        turns,
        costs,
        beginnings,
        shifts: shifts.collect(),
        seed,
    }
}

fn found(made: &Made, together: Together) -> Cheapest {
    let mut chain = Chain::new(made.turns, together, Some(made.costs.len()));
    for (column, (costs, beginning)) in made.costs.iter().zip(&made.beginnings).enumerate() {
        chain.take(
            costs,
            (*beginning, made.shifts[column]),
            &MadeLinks {
                seed: made.seed,
                column,
            },
        );
    }
    chain.cheapest()
}

/// Fewest steps in column `column` from one state to another, at most `most` along each axis, one axis after the other;
/// `None` where there is no way.
fn steps(made: &Made, column: usize, from: usize, to: usize, most: [usize; AXES]) -> Option<usize> {
    let links = MadeLinks {
        seed: made.seed,
        column,
    };
    let (costs, grid) = (&made.costs[column], made.turns.grid);
    let mut reached = std::collections::BTreeMap::from([(from, 0)]);
    for axis in grid.free_axes() {
        for _ in 0..most[axis] {
            for (state, by) in reached.clone() {
                for (_, turn) in grid.neighbours(state / SLOTS, axis) {
                    for slot in 0..SLOTS {
                        let there = turn * SLOTS + slot;
                        let same = !made.turns.kept_slots || slot == state % SLOTS;
                        if same && costs[there].is_finite() && links.turns(axis, [state, there]) {
                            let fewest = reached.entry(there).or_insert(by + 1);
                            *fewest = (*fewest).min(by + 1);
                        }
                    }
                }
            }
        }
    }
    reached.get(&to).copied()
}

/// Cost from a state of the column before to one of this column; `None` where there is no transition.
fn price(made: &Made, column: usize, from: usize, to: usize) -> Option<f64> {
    let Beginning::Follows(most) = made.beginnings[column] else {
        return Some(0.0);
    };
    let links = MadeLinks {
        seed: made.seed,
        column,
    };
    let back = made.shifts[column].map(|by| -by);
    let turn = made.turns.grid.shifted(from / SLOTS, &back)?;
    (0..SLOTS)
        .filter(|slot| !made.turns.kept_slots || *slot == from % SLOTS)
        .filter(|slot| {
            made.costs[column][turn * SLOTS + slot].is_finite() && links.goes_on([from, turn * SLOTS + slot])
        })
        .filter_map(|slot| steps(made, column, turn * SLOTS + slot, to, most))
        .min()
        .map(|by| by as f64 * made.turns.price)
}

/// The smallest of all chains, one after the other: only lattices without gaps or breaks.
fn least_of_all(made: &Made, together: Together) -> f64 {
    let mut values = made.costs[0].clone();
    for column in 1..made.costs.len() {
        let mut next = vec![f64::INFINITY; values.len()];
        for (to, value) in next.iter_mut().enumerate() {
            let cost = made.costs[column][to];
            for (from, before) in values.iter().enumerate() {
                if let Some(price) =
                    price(made, column, from, to).filter(|_| cost.is_finite() && before.is_finite())
                {
                    *value = value.min(together.of(before + price, cost));
                }
            }
        }
        values = next;
    }
    values.into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn no_chain_is_cheaper_and_the_chain_has_the_reported_cost() {
    let mut whole = 0;
    for seed in 0..6000 {
        let mut made = made(seed, seed % 3 != 0);
        let together = [Together::Sum, Together::Worst][(seed / 3 % 2) as usize];
        if together == Together::Worst {
            // For maxima no price is defined.
            made.turns.price = 0.0;
        }
        let cheapest = found(&made, together);
        let unreachable = made
            .costs
            .iter()
            .any(|costs| costs.iter().all(|cost| cost.is_infinite()));
        let mut sum = 0.0;
        let mut before: Option<usize> = None;
        for (column, state) in cheapest.states.iter().enumerate() {
            let Some(state) = *state else {
                assert!(
                    made.costs[column].iter().all(|cost| cost.is_infinite()),
                    "seed {seed}"
                );
                continue;
            };
            let paid = match before {
                Some(from) if !cheapest.breaks.contains(&column) && !unreachable => {
                    price(&made, column, from, state).expect("the chain uses the transitions")
                }
                _ => 0.0,
            };
            sum = together.of(sum + paid, made.costs[column][state]);
            before = Some(state);
        }
        if unreachable {
            continue;
        }
        assert!(
            (sum - cheapest.cost).abs() < 1e-12,
            "seed {seed}: {sum} and {}",
            cheapest.cost
        );
        let least = least_of_all(&made, together);
        // A break occurs where, and only where, no chain continues.
        assert_eq!(least.is_infinite(), !cheapest.breaks.is_empty(), "seed {seed}");
        if least.is_finite() {
            whole += 1;
            assert!(
                (least - cheapest.cost).abs() < 1e-12,
                "seed {seed}: {least} and {}",
                cheapest.cost
            );
        }
    }
    assert!(whole > 1500, "{whole} lattices have a chain");
}

/// Number of reversals of the joints along the states of `chain`, which starts only at the first.
fn backs(made: &Made, chain: &[usize]) -> u32 {
    let (mut heading, mut backs) = (Heading::default(), 0);
    for (column, pair) in chain.windows(2).enumerate() {
        let links = MadeLinks {
            seed: made.seed,
            column: column + 1,
        };
        let moves = links.moves_on([pair[0], pair[1]]);
        backs += heading.turned_by(moves);
        heading = heading.then(moves);
    }
    backs
}

#[test]
fn a_price_reduces_reversals_and_with_a_fixed_turn_the_chain_is_the_cheapest() {
    let mut fewer = 0;
    for seed in 0..20_000 {
        let mut made = made(seed, true);
        for beginning in &mut made.beginnings[1..] {
            *beginning = Beginning::Follows([0; AXES]);
        }
        made.shifts.fill(UNSHIFTED);
        let without = found(&made, Together::Sum);
        made.turns.back_price = 0.4;
        let with = found(&made, Together::Sum);
        if !without.breaks.is_empty() || without.states.contains(&None) {
            continue;
        }
        let states = |of: &Cheapest| of.states.iter().flatten().copied().collect::<Vec<_>>();
        let given = |of: &Cheapest| of.cost + 0.4 * f64::from(backs(&made, &states(of)));
        let sum: f64 = states(&with)
            .iter()
            .zip(&made.costs)
            .map(|(state, costs)| costs[*state])
            .sum();
        assert!(
            (sum - with.cost).abs() < 1e-12,
            "seed {seed}: {sum} and {}",
            with.cost
        );
        assert!(given(&with) <= given(&without) + 1e-12, "seed {seed}");
        // Each turn and slot is a separate chain.
        let all = (0..made.turns.grid.len() * SLOTS).filter_map(|state| {
            let chain = vec![state; made.costs.len()];
            let links = |column| MadeLinks { seed, column };
            let goes_on = |column: usize| links(column).goes_on([state, state]);
            let whole = (1..made.costs.len()).all(goes_on);
            let cost: f64 = made.costs.iter().map(|costs| costs[state]).sum();
            (whole && cost.is_finite()).then(|| cost + 0.4 * f64::from(backs(&made, &chain)))
        });
        let least = all.fold(f64::INFINITY, f64::min);
        assert!(
            (given(&with) - least).abs() < 1e-12,
            "seed {seed}: {} {least}",
            given(&with)
        );
        fewer += usize::from(backs(&made, &states(&with)) < backs(&made, &states(&without)));
    }
    assert!(fewer > 10, "{fewer}");
}

#[test]
fn the_tool_turns_in_the_shorter_direction_and_no_faster_than_allowed() {
    struct All;
    impl Links for All {
        fn goes_on(&self, _: [usize; 2]) -> bool {
            true
        }
        fn moves_on(&self, _: [usize; 2]) -> Heading {
            Heading::default()
        }
        fn turns(&self, _: usize, _: [usize; 2]) -> bool {
            true
        }
        fn moves_by_turn(&self, _: [usize; 2]) -> Heading {
            Heading::default()
        }
        fn starts(&self, _: usize) -> Winding {
            Winding::default()
        }
        fn winds_on(&self, before: &Winding, _: [usize; 2]) -> Option<Winding> {
            Some(*before)
        }
        fn winds_by_turn(&self, before: &Winding, _: [usize; 2]) -> Option<Winding> {
            Some(*before)
        }
    }
    let lattice = |around, steps| {
        let turns = Turns {
            grid: Grid::of_spins(72, around),
            kept_slots: true,
            price: 0.0,
            back_price: 0.0,
            winds: true,
        };
        let mut chain = Chain::new(turns, Together::Sum, Some(3));
        let dear_but = |turn: usize| {
            let mut costs = vec![100.0; 72 * SLOTS];
            costs[turn * SLOTS] = 1.0;
            costs
        };
        let mut first = vec![f64::INFINITY; 72 * SLOTS];
        first[70 * SLOTS] = 1.0;
        chain.take(&first, (Beginning::Restart, UNSHIFTED), &All);
        let follows = (Beginning::Follows([steps, 0, 0, 0, 0, 0]), UNSHIFTED);
        chain.take(&[1.0; 72 * SLOTS], follows, &All);
        chain.take(&dear_but(3), follows, &All);
        let cheapest = chain.cheapest();
        assert_eq!(cheapest.breaks, []);
        cheapest.cost
    };
    // From 70 to 3 are five steps over the end, three and two; in the other direction 67.
    assert_eq!(lattice(true, 3), 3.0);
    assert_eq!(lattice(true, 2), 102.0);
    assert_eq!(lattice(false, usize::MAX), 102.0);
}
