//! The cheapest chain of postures through the columns of a path: dynamic programming, column after column.
//!
//! ```text
//! m_i(s, b) = min over b' of v_{i-1}(s, b')                    the tip goes on, the tool keeps its turn
//! v_i(s, b) = n_i(s, b) + min over |s' - s| <= k_i of m_i(s', b') + t |s' - s|     the tool turns
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `s`, `b` | turn of the tool and posture: a state |
//! | `n`, `v` | what a state costs, and the cheapest chain that ends there |
//! | `k_i` | steps that the tool may turn by there |
//! | `t` | price of a step |
//!
//! Where turning back has a price, both minima have that of the joints that turn back on the way besides. How they went is
//! known of the cheapest chain to each state alone, so that a chain that was dearer until there and turns back less later is
//! missed: with that price the chain is a good one, not surely the cheapest, unless the tool keeps its turn. Turning goes by
//! steps there, against which joints turn back that do not once the steps are taken out.
//!
//! Where the goal is the worst point, sums become maxima. A column that nothing leads to begins anew behind the cheapest
//! chain so far, and counts as a break: the arm stops there and takes another posture. A column without any state is
//! passed over.

use super::heading::Heading;
use crate::kernel::SLOTS;

/// How costs along a chain become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Together {
    /// Their sum.
    Sum,
    /// The largest.
    Worst,
}

/// What leads from one column to the next.
pub(super) trait Links {
    /// Whether the tip can go on from posture `from` of the column before to posture `to`, the tool turned by step `turn`
    /// at both.
    fn goes_on(&self, turn: usize, from: usize, to: usize) -> bool;
    /// How the joints move there.
    fn moves_on(&self, turn: usize, from: usize, to: usize) -> Heading;
    /// Whether the tool can turn, in the column, from posture `from` at step `turn` to posture `to` at step `next`.
    fn turns(&self, turn: usize, next: usize, from: usize, to: usize) -> bool;
    /// How the joints move there.
    fn moves_by_turn(&self, turn: usize, next: usize, from: usize, to: usize) -> Heading;
}

/// The turns of a lattice and how they neighbour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    /// How many.
    pub count: usize,
    /// Whether the last neighbours the first.
    pub around: bool,
    /// Whether postures keep their slot from state to state; otherwise any may be that of any.
    pub kept_slots: bool,
    /// Price of a step.
    pub price: f64,
    /// Price of a joint that turns back; nothing is looked at where it is zero.
    pub back_price: f64,
}

/// What a column begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beginning {
    /// It follows on the column before; the tool may turn by so many steps.
    Follows(usize),
    /// A rapid leads there: any posture may follow on any.
    Anew,
}

/// How a column was entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Entry {
    /// By links; see the back pointers.
    Linked,
    /// From this state of the last column that had one, or from nothing.
    From(Option<u32>),
    /// By a break: nothing led there.
    Broken(u32),
    /// It has no state at all.
    Lost,
}

/// More steps than this the tool does not turn by in one column: a back pointer is a byte.
pub(super) const MOST_STEPS: usize = 15;

/// The cheapest chains so far.
pub(super) struct Chain {
    turns: Turns,
    together: Together,
    /// Of each state of each column one more than the way back: steps turned and [`MOST_STEPS`], times [`SLOTS`], and the
    /// slot before; zero where there is none. Empty where nobody asks for the chain.
    back: Option<Vec<u8>>,
    entries: Vec<Entry>,
    /// Costs of the chains to the states of the last column that has any.
    values: Vec<f64>,
    next: Vec<f64>,
    ways: Vec<u8>,
    /// How the joints came to the states of the last column, and how often they turned back until there; empty where that
    /// has no price.
    came: Vec<Came>,
    next_came: Vec<Came>,
}

/// How the joints came along a chain.
#[derive(Clone, Copy, Debug, Default)]
struct Came {
    heading: Heading,
    backs: u32,
}

/// The cheapest chain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cheapest {
    /// Its cost, without the price of turning back.
    pub cost: f64,
    /// State at each column: turn times [`SLOTS`] plus slot; `None` where there is none.
    pub states: Vec<Option<usize>>,
    /// Columns that nothing leads to.
    pub breaks: Vec<usize>,
}

impl Chain {
    /// Before the first column. `traced`: whether the chain itself is asked for, or its cost alone.
    pub fn new(turns: Turns, together: Together, traced: Option<usize>) -> Chain {
        let states = turns.count * SLOTS;
        let headed = if turns.back_price > 0.0 { states } else { 0 };
        Chain {
            turns,
            together,
            back: traced.map(|columns| Vec::with_capacity(columns * states)),
            entries: Vec::new(),
            values: vec![f64::INFINITY; states],
            next: vec![f64::INFINITY; states],
            ways: vec![0; states],
            came: vec![Came::default(); headed],
            next_came: vec![Came::default(); headed],
        }
    }

    /// Takes the next column: what its states cost (infinite where there is none), what it begins with, what leads there.
    pub fn take(&mut self, costs: &[f64], beginning: Beginning, links: &impl Links) {
        if costs.iter().all(|cost| cost.is_infinite()) {
            self.entries.push(Entry::Lost);
            if let Some(back) = &mut self.back {
                back.resize(back.len() + costs.len(), 0);
            }
            return;
        }
        let entry = match beginning {
            Beginning::Follows(steps) if self.values.iter().any(|value| value.is_finite()) => {
                self.link(costs, steps.min(MOST_STEPS), links);
                let leads = self.next.iter().any(|value| value.is_finite());
                let least = least(&self.values).unwrap_or(0) as u32;
                if leads {
                    Entry::Linked
                } else {
                    Entry::Broken(least)
                }
            }
            _ => Entry::From(least(&self.values).map(|state| state as u32)),
        };
        if let Entry::From(Some(state)) | Entry::Broken(state) = entry {
            let backs = self.came.get(state as usize).map_or(0, |came| came.backs);
            self.begin(costs, self.values[state as usize], backs);
        } else if entry == Entry::From(None) {
            self.begin(costs, 0.0, 0);
        }
        self.entries.push(entry);
        if let Some(back) = &mut self.back {
            back.extend_from_slice(&self.ways);
        }
        std::mem::swap(&mut self.values, &mut self.next);
        std::mem::swap(&mut self.came, &mut self.next_came);
    }

    /// Begins anew behind a chain that cost so much and turned back so often.
    fn begin(&mut self, costs: &[f64], before: f64, backs: u32) {
        self.ways.fill(0);
        self.next_came.fill(Came {
            heading: Heading::default(),
            backs,
        });
        for (value, cost) in self.next.iter_mut().zip(costs) {
            *value = self.together.of(before, *cost);
        }
    }

    /// Fills the values of the next column by what leads there.
    fn link(&mut self, costs: &[f64], steps: usize, links: &impl Links) {
        let Turns {
            count, kept_slots, ..
        } = self.turns;
        self.next.fill(f64::INFINITY);
        self.ways.fill(0);
        for turn in 0..count {
            for to in 0..SLOTS {
                let state = turn * SLOTS + to;
                if costs[state].is_infinite() {
                    continue;
                }
                let from = if kept_slots { to..to + 1 } else { 0..SLOTS };
                for slot in from {
                    let origin = turn * SLOTS + slot;
                    let before = self.values[origin];
                    if before >= self.next[state] || !links.goes_on(turn, slot, to) {
                        continue;
                    }
                    let came = self.came.get(origin);
                    let came = came.map(|came| came.then(links.moves_on(turn, slot, to)));
                    let value = before + self.back_price(came);
                    if value < self.next[state] {
                        self.next[state] = value;
                        self.ways[state] = way(0, slot);
                        if let Some((came, _)) = came {
                            self.next_came[state] = came;
                        }
                    }
                }
            }
        }
        // One step more each time, in both directions: what came by fewer steps stays where it is no dearer.
        for _ in 0..steps {
            self.turn_by_a_step(costs, links);
        }
        for (value, cost) in self.next.iter_mut().zip(costs) {
            *value = self.together.of(*value, *cost);
        }
    }

    fn turn_by_a_step(&mut self, costs: &[f64], links: &impl Links) {
        let Turns {
            count,
            around,
            kept_slots,
            price,
            ..
        } = self.turns;
        let before = self.next.clone();
        let ways = self.ways.clone();
        let came = self.next_came.clone();
        for turn in 0..count {
            for (sense, neighbour) in neighbours(turn, count, around) {
                for to in 0..SLOTS {
                    let state = turn * SLOTS + to;
                    if costs[state].is_infinite() {
                        continue;
                    }
                    let from = if kept_slots { to..to + 1 } else { 0..SLOTS };
                    for slot in from {
                        let there = neighbour * SLOTS + slot;
                        let value = before[there] + price;
                        if value >= self.next[state] || !links.turns(neighbour, turn, slot, to) {
                            continue;
                        }
                        let came = came.get(there);
                        let came = came.map(|came| came.then(links.moves_by_turn(neighbour, turn, slot, to)));
                        let value = value + self.back_price(came);
                        if value < self.next[state] {
                            let (by, origin) = steps_and_slot(ways[there]);
                            self.next[state] = value;
                            self.ways[state] = way(by + sense, origin);
                            if let Some((came, _)) = came {
                                self.next_came[state] = came;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Price of what turned back on the last step.
    fn back_price(&self, came: Option<(Came, u32)>) -> f64 {
        came.map_or(0.0, |(_, backs)| self.turns.back_price * f64::from(backs))
    }

    /// The cheapest chain through all columns; its states where they were asked for.
    pub fn cheapest(&self) -> Cheapest {
        let last = least(&self.values);
        let backs = |state: usize| self.came.get(state).map_or(0.0, |came| f64::from(came.backs));
        let cost = last.map_or(0.0, |state| {
            self.values[state] - self.turns.back_price * backs(state)
        });
        let breaks = (0..self.entries.len()).filter(|i| matches!(self.entries[*i], Entry::Broken(_)));
        let breaks = breaks.collect();
        let mut states = vec![None; self.entries.len()];
        let (Some(back), Some(mut state)) = (&self.back, last) else {
            return Cheapest { cost, states, breaks };
        };
        let width = self.values.len();
        for (index, entry) in self.entries.iter().enumerate().rev() {
            if *entry == Entry::Lost {
                continue;
            }
            states[index] = Some(state);
            match entry {
                Entry::Linked => {
                    let (by, slot) = steps_and_slot(back[index * width + state]);
                    let count = self.turns.count as isize;
                    // The tool came from `turn - by`.
                    let turn = (state / SLOTS) as isize - by;
                    state = turn.rem_euclid(count) as usize * SLOTS + slot;
                }
                Entry::From(Some(before)) | Entry::Broken(before) => state = *before as usize,
                Entry::From(None) | Entry::Lost => break,
            }
        }
        Cheapest { cost, states, breaks }
    }
}

impl Came {
    /// After moving on so, and how many joints turned back for it.
    fn then(self, moves: Heading) -> (Came, u32) {
        let backs = self.heading.turned_by(moves);
        let came = Came {
            heading: self.heading.then(moves),
            backs: self.backs + backs,
        };
        (came, backs)
    }
}

impl Together {
    fn of(self, so_far: f64, cost: f64) -> f64 {
        match self {
            Together::Sum => so_far + cost,
            Together::Worst => so_far.max(cost),
        }
    }
}

/// The state with the least value, the first of equal ones; `None` where all are infinite.
fn least(values: &[f64]) -> Option<usize> {
    let mut least: Option<usize> = None;
    for (state, value) in values.iter().enumerate() {
        if value.is_finite() && least.is_none_or(|other| *value < values[other]) {
            least = Some(state);
        }
    }
    least
}

/// The neighbours of a turn, each with the sense in which the tool turns from there.
fn neighbours(turn: usize, count: usize, around: bool) -> impl Iterator<Item = (isize, usize)> {
    let below = match turn {
        0 => (around && count > 2).then(|| count - 1),
        _ => Some(turn - 1),
    };
    let above = match turn + 1 == count {
        true => (around && count > 2).then_some(0),
        false => Some(turn + 1),
    };
    let below = below.map(|other| (1, other));
    below.into_iter().chain(above.map(|other| (-1, other)))
}

/// A way back in a byte.
fn way(steps: isize, slot: usize) -> u8 {
    let most = MOST_STEPS as isize;
    ((steps + most) * SLOTS as isize + slot as isize + 1) as u8
}

/// Steps that the tool turned by, and the slot it came from.
fn steps_and_slot(way: u8) -> (isize, usize) {
    let code = usize::from(way.max(1)) - 1;
    ((code / SLOTS) as isize - MOST_STEPS as isize, code % SLOTS)
}

#[cfg(test)]
mod tests;
