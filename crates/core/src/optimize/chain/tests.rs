use super::*;
use crate::arms::Stream;

/// A small lattice with anything in it.
struct Made {
    turns: Turns,
    costs: Vec<Vec<f64>>,
    beginnings: Vec<Beginning>,
    /// Of each column: what goes on, and what turns, by turn, slots and neighbour.
    seed: u64,
}

struct MadeLinks {
    seed: u64,
    column: usize,
}

impl MadeLinks {
    /// Two of three links are there, the same whenever asked.
    fn holds(&self, numbers: [usize; 5]) -> bool {
        let mixed = numbers.iter().fold(self.seed ^ self.column as u64, |sum, n| {
            sum.wrapping_mul(1_000_003) ^ *n as u64
        });
        Stream(mixed).next() > 0.34
    }
}

impl Links for MadeLinks {
    fn goes_on(&self, turn: usize, from: usize, to: usize) -> bool {
        self.holds([0, turn, from, to, 0])
    }
    fn moves_on(&self, turn: usize, from: usize, to: usize) -> Heading {
        let up = |joint| {
            if self.holds([2, turn, from, to, joint]) {
                1.0
            } else {
                -1.0
            }
        };
        Heading::of((0..3).map(up))
    }
    fn turns(&self, turn: usize, next: usize, from: usize, to: usize) -> bool {
        self.holds([1, turn, next, from, to])
    }
    fn moves_by_turn(&self, _: usize, _: usize, _: usize, _: usize) -> Heading {
        unreachable!("the tool keeps its turn wherever turning back has a price")
    }
}

fn made(seed: u64, kept_slots: bool) -> Made {
    let mut random = Stream(seed);
    let turns = Turns {
        count: 1 + (random.next() * 4.0) as usize,
        around: random.next() < 0.5,
        kept_slots,
        price: 0.1 * random.next(),
        back_price: 0.0,
    };
    let columns = 2 + (random.next() * 4.0) as usize;
    let cost = |random: &mut Stream| {
        // Few states of the eight slots, so that every chain can be tried.
        let sum = random.next();
        if random.next() < 0.5 { f64::INFINITY } else { sum }
    };
    let costs: Vec<Vec<f64>> = (0..columns)
        .map(|_| {
            let lost = random.next() < 0.1;
            (0..turns.count * SLOTS)
                .map(|state| {
                    if lost || state % SLOTS > 1 {
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
            (0, _) => Beginning::Anew,
            (_, part) if part < 0.1 => Beginning::Anew,
            (_, part) => Beginning::Follows((part * 3.0) as usize),
        })
        .collect();
    Made {
        turns,
        costs,
        beginnings,
        seed,
    }
}

fn found(made: &Made, together: Together) -> Cheapest {
    let mut chain = Chain::new(made.turns, together, Some(made.costs.len()));
    for (column, (costs, beginning)) in made.costs.iter().zip(&made.beginnings).enumerate() {
        chain.take(
            costs,
            *beginning,
            &MadeLinks {
                seed: made.seed,
                column,
            },
        );
    }
    chain.cheapest()
}

/// Steps of the cheapest turn in column `column` from one state to another; `None` where none leads there.
fn steps(made: &Made, column: usize, from: usize, to: usize, most: usize) -> Option<usize> {
    let links = MadeLinks {
        seed: made.seed,
        column,
    };
    let costs = &made.costs[column];
    let mut reached = vec![from];
    for by in 0..=most {
        if reached.contains(&to) {
            return Some(by);
        }
        let mut next = reached.clone();
        for state in &reached {
            for (_, turn) in neighbours(state / SLOTS, made.turns.count, made.turns.around) {
                for slot in 0..SLOTS {
                    let there = turn * SLOTS + slot;
                    let same = !made.turns.kept_slots || slot == state % SLOTS;
                    if same
                        && costs[there].is_finite()
                        && links.turns(state / SLOTS, turn, state % SLOTS, slot)
                    {
                        next.push(there);
                    }
                }
            }
        }
        reached = next;
    }
    None
}

/// What it costs to come from a state of the column before to one of this column; `None` where that cannot be.
fn price(made: &Made, column: usize, from: usize, to: usize) -> Option<f64> {
    let Beginning::Follows(most) = made.beginnings[column] else {
        return Some(0.0);
    };
    let links = MadeLinks {
        seed: made.seed,
        column,
    };
    let turn = from / SLOTS;
    (0..SLOTS)
        .filter(|slot| !made.turns.kept_slots || *slot == from % SLOTS)
        .filter(|slot| {
            made.costs[column][turn * SLOTS + slot].is_finite() && links.goes_on(turn, from % SLOTS, *slot)
        })
        .filter_map(|slot| steps(made, column, turn * SLOTS + slot, to, most))
        .min()
        .map(|by| by as f64 * made.turns.price)
}

/// The least of all chains, one after the other: lattices without gaps or breaks alone.
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
fn no_chain_is_cheaper_and_the_chain_told_costs_what_is_told() {
    let mut whole = 0;
    for seed in 0..6000 {
        let mut made = made(seed, seed % 3 != 0);
        let together = [Together::Sum, Together::Worst][(seed / 3 % 2) as usize];
        if together == Together::Worst {
            // A price has no place among maxima.
            made.turns.price = 0.0;
        }
        let cheapest = found(&made, together);
        let lost = made
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
                Some(from) if !cheapest.breaks.contains(&column) && !lost => {
                    price(&made, column, from, state).expect("the chain keeps to the links")
                }
                _ => 0.0,
            };
            sum = together.of(sum + paid, made.costs[column][state]);
            before = Some(state);
        }
        if lost {
            continue;
        }
        assert!(
            (sum - cheapest.cost).abs() < 1e-12,
            "seed {seed}: {sum} and {}",
            cheapest.cost
        );
        let least = least_of_all(&made, together);
        // A break comes where, and only where, no chain leads on.
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

/// Times that joints turn back along the states of `chain`, which begin nowhere but at the first.
fn backs(made: &Made, chain: &[usize]) -> u32 {
    let (mut heading, mut backs) = (Heading::default(), 0);
    for (column, pair) in chain.windows(2).enumerate() {
        let links = MadeLinks {
            seed: made.seed,
            column: column + 1,
        };
        let moves = links.moves_on(pair[0] / SLOTS, pair[0] % SLOTS, pair[1] % SLOTS);
        backs += heading.turned_by(moves);
        heading = heading.then(moves);
    }
    backs
}

#[test]
fn joints_turn_back_less_where_that_has_a_price_and_a_tool_that_keeps_its_turn_has_the_cheapest_chain() {
    let mut fewer = 0;
    for seed in 0..20_000 {
        let mut made = made(seed, true);
        for beginning in &mut made.beginnings[1..] {
            *beginning = Beginning::Follows(0);
        }
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
        // Each turn and slot is a chain of its own.
        let all = (0..made.turns.count * SLOTS).filter_map(|state| {
            let chain = vec![state; made.costs.len()];
            let links = |column| MadeLinks { seed, column };
            let holds = |column: usize| links(column).goes_on(state / SLOTS, state % SLOTS, state % SLOTS);
            let whole = (1..made.costs.len()).all(holds);
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
fn the_tool_may_turn_the_short_way_round_and_no_faster_than_allowed() {
    struct All;
    impl Links for All {
        fn goes_on(&self, _: usize, _: usize, _: usize) -> bool {
            true
        }
        fn moves_on(&self, _: usize, _: usize, _: usize) -> Heading {
            Heading::default()
        }
        fn turns(&self, _: usize, _: usize, _: usize, _: usize) -> bool {
            true
        }
        fn moves_by_turn(&self, _: usize, _: usize, _: usize, _: usize) -> Heading {
            Heading::default()
        }
    }
    let lattice = |around, steps| {
        let turns = Turns {
            count: 72,
            around,
            kept_slots: true,
            price: 0.0,
            back_price: 0.0,
        };
        let mut chain = Chain::new(turns, Together::Sum, Some(3));
        let dear_but = |turn: usize| {
            let mut costs = vec![100.0; 72 * SLOTS];
            costs[turn * SLOTS] = 1.0;
            costs
        };
        let mut first = vec![f64::INFINITY; 72 * SLOTS];
        first[70 * SLOTS] = 1.0;
        chain.take(&first, Beginning::Anew, &All);
        chain.take(&[1.0; 72 * SLOTS], Beginning::Follows(steps), &All);
        chain.take(&dear_but(3), Beginning::Follows(steps), &All);
        let cheapest = chain.cheapest();
        assert_eq!(cheapest.breaks, []);
        cheapest.cost
    };
    // From 70 to 3 are five steps over the end, three and two; the other way round 67.
    assert_eq!(lattice(true, 3), 3.0);
    assert_eq!(lattice(true, 2), 102.0);
    assert_eq!(lattice(false, MOST_STEPS), 102.0);
}

#[test]
fn a_way_back_fits_a_byte() {
    let most = MOST_STEPS as isize;
    for steps in -most..=most {
        for slot in 0..SLOTS {
            assert_eq!(steps_and_slot(way(steps, slot)), (steps, slot));
        }
    }
}
