//! The chain of postures with the lowest cost through the columns of a path: dynamic programming, column after column.
//!
//! ```text
//! m_i(s, b) = min over b' of v_{i-1}(s, b')                    the tip goes on, the tool keeps its turn
//! v_i(s, b) = n_i(s, b) + min over |s' - s| <= k_i of m_i(s', b') + t |s' - s|     the tool turns
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `s`, `b` | turn of the tool and posture: a state |
//! | `n`, `v` | cost of a state, and the lowest cost of a chain that ends there |
//! | `k_i` | largest number of steps that the tool may turn by there |
//! | `t` | price of a step |
//!
//! Where a reversal has a price, both minima include that of the joints that reverse. The directions of the joints are
//! known only for the best chain to each state. A chain with a higher cost so far and fewer reversals later is
//! therefore missed: with this price the chain is good, but not proven to be the best, unless the tool keeps its turn.
//! The tool turns in steps; a joint may reverse there that no longer reverses once the steps are smoothed.
//!
//! Whole turns of joints are counted in the same way, of the best chain to each state: a transition that would wind a
//! joint beyond its limit is not used. The chain can therefore be driven, and may be missed where a chain with a higher
//! cost so far would have been less wound.
//!
//! For the objective `worst`, sums become maxima. A column that cannot be reached restarts after the best chain so far
//! and counts as a break: the arm stops there and changes its posture. A column without any state is skipped.

use super::heading::Heading;
use super::winding::Winding;
use crate::kernel::SLOTS;

/// How the costs along a chain are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Together {
    /// Their sum.
    Sum,
    /// The largest.
    Worst,
}

/// Transitions from one column to the next.
pub(super) trait Links {
    /// Whether the tip can go from posture `from` of the previous column to posture `to`, both at tool turn `turn`.
    fn goes_on(&self, turn: usize, from: usize, to: usize) -> bool;
    /// Directions of the joints on this transition.
    fn moves_on(&self, turn: usize, from: usize, to: usize) -> Heading;
    /// Whether the tool can turn, within the column, from posture `from` at step `turn` to posture `to` at step `next`.
    fn turns(&self, turn: usize, next: usize, from: usize, to: usize) -> bool;
    /// Directions of the joints on this transition.
    fn moves_by_turn(&self, turn: usize, next: usize, from: usize, to: usize) -> Heading;
    /// Whole turns at a state of this column where a cut begins.
    fn starts(&self, state: usize) -> Winding;
    /// Whole turns after the transition of [`Links::goes_on`]; `None` where they exceed a limit.
    fn winds_on(&self, before: &Winding, turn: usize, from: usize, to: usize) -> Option<Winding>;
    /// Whole turns after the tool has turned within the column from one state to the other; `None` as above.
    fn winds_by_turn(&self, before: &Winding, states: [usize; 2]) -> Option<Winding>;
}

/// The turns of a lattice, and which are neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    /// Number of turns.
    pub count: usize,
    /// Whether the last turn is a neighbour of the first.
    pub around: bool,
    /// Whether a posture keeps its slot from state to state; otherwise every slot may follow every slot.
    pub kept_slots: bool,
    /// Price of a step.
    pub price: f64,
    /// Price of a reversal of a joint; zero: reversals are neglected.
    pub back_price: f64,
    /// Whether whole turns of joints are counted.
    pub winds: bool,
}

/// How a column starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beginning {
    /// It follows the previous column; the tool may turn by this number of steps.
    Follows(usize),
    /// After a rapid: any posture may follow any posture.
    Restart,
}

/// How a column was entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Entry {
    /// By a transition; see the back pointers.
    Linked,
    /// From this state of the last column that had one, or from no state.
    From(Option<u32>),
    /// By a break: no transition leads there.
    Broken(u32),
    /// It has no state.
    Lost,
}

/// Largest number of steps that the tool turns by in one column: a back pointer is one byte.
pub(super) const MOST_STEPS: usize = 15;

/// The best chains so far.
pub(super) struct Chain {
    turns: Turns,
    together: Together,
    /// One more than the way back, for each state of each column: steps turned and [`MOST_STEPS`], times [`SLOTS`], and
    /// the previous slot; zero where there is none. Empty where the chain itself is not requested.
    back: Option<Vec<u8>>,
    entries: Vec<Entry>,
    /// Costs of the chains to the states of the last column with states.
    values: Vec<f64>,
    next: Vec<f64>,
    ways: Vec<u8>,
    /// Directions of the joints at the states of the last column, and the number of reversals so far; empty where
    /// reversals have no price.
    came: Vec<Came>,
    next_came: Vec<Came>,
    /// Whole turns at the states of the last column with states; empty where they are not counted.
    windings: Vec<Winding>,
    next_windings: Vec<Winding>,
}

/// Directions and reversals along a chain.
#[derive(Clone, Copy, Debug, Default)]
struct Came {
    heading: Heading,
    backs: u32,
}

/// The best chain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cheapest {
    /// Its cost, without the price of reversals.
    pub cost: f64,
    /// State at each column: turn times [`SLOTS`] plus slot; `None` where there is none.
    pub states: Vec<Option<usize>>,
    /// Columns that no transition leads to.
    pub breaks: Vec<usize>,
}

impl Chain {
    /// Before the first column. `traced`: whether the chain itself is requested, or only its cost.
    pub fn new(turns: Turns, together: Together, traced: Option<usize>) -> Chain {
        let states = turns.count * SLOTS;
        let headed = if turns.back_price > 0.0 { states } else { 0 };
        let wound = if turns.winds { states } else { 0 };
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
            windings: vec![Winding::default(); wound],
            next_windings: vec![Winding::default(); wound],
        }
    }

    /// Adds the next column: the cost of its states (infinite where there is none), how it starts, and its transitions.
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
        if entry != Entry::Linked {
            for (state, winding) in self.next_windings.iter_mut().enumerate() {
                if costs[state].is_finite() {
                    *winding = links.starts(state);
                }
            }
        }
        self.entries.push(entry);
        if let Some(back) = &mut self.back {
            back.extend_from_slice(&self.ways);
        }
        std::mem::swap(&mut self.values, &mut self.next);
        std::mem::swap(&mut self.came, &mut self.next_came);
        std::mem::swap(&mut self.windings, &mut self.next_windings);
    }

    /// Restarts after a chain of this cost with this number of reversals.
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

    /// Computes the values of the next column from its transitions.
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
                    let winding = self.windings.get(origin);
                    let winding = winding.map(|before| links.winds_on(before, turn, slot, to));
                    if winding == Some(None) {
                        continue;
                    }
                    let came = self.came.get(origin);
                    let came = came.map(|came| came.then(links.moves_on(turn, slot, to)));
                    let value = before + self.back_price(came);
                    if value < self.next[state] {
                        self.next[state] = value;
                        self.ways[state] = way(0, slot);
                        if let Some(winding) = winding.flatten() {
                            self.next_windings[state] = winding;
                        }
                        if let Some((came, _)) = came {
                            self.next_came[state] = came;
                        }
                    }
                }
            }
        }
        // One more step each time, in both directions: a state keeps its chain with fewer steps unless the other costs
        // less.
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
        let windings = self.next_windings.clone();
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
                        let winding = windings.get(there);
                        let winding = winding.map(|before| links.winds_by_turn(before, [there, state]));
                        if winding == Some(None) {
                            continue;
                        }
                        let came = came.get(there);
                        let came = came.map(|came| came.then(links.moves_by_turn(neighbour, turn, slot, to)));
                        let value = value + self.back_price(came);
                        if value < self.next[state] {
                            let (by, origin) = steps_and_slot(ways[there]);
                            self.next[state] = value;
                            if let Some(winding) = winding.flatten() {
                                self.next_windings[state] = winding;
                            }
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

    /// Price of the reversals on the last step.
    fn back_price(&self, came: Option<(Came, u32)>) -> f64 {
        came.map_or(0.0, |(_, backs)| self.turns.back_price * f64::from(backs))
    }

    /// The best chain through all columns; its states if they are requested.
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
                    // The tool was at `turn - by` before.
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
    /// Directions after this transition, and the number of joints that reverse on it.
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

/// The state with the lowest value, the first of equal ones; `None` where all are infinite.
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

/// A back pointer in one byte.
fn way(steps: isize, slot: usize) -> u8 {
    let most = MOST_STEPS as isize;
    ((steps + most) * SLOTS as isize + slot as isize + 1) as u8
}

/// Steps that the tool turned by, and the previous slot.
fn steps_and_slot(way: u8) -> (isize, usize) {
    let code = usize::from(way.max(1)) - 1;
    ((code / SLOTS) as isize - MOST_STEPS as isize, code % SLOTS)
}

#[cfg(test)]
mod tests;
