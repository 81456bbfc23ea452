//! The chain of postures with the lowest cost through the columns of a path: dynamic programming, column after column.
//!
//! ```text
//! m_i(s, b) = min over b' of v_{i-1}(s, b')                    the tip goes on, the setting is kept
//! v_i(s, b) = n_i(s, b) + min over |s' - s| <= k_i of m_i(s', b') + t |s' - s|     the setting changes
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `s`, `b` | setting (spin and lean of the tool, external axes: [`Grid`]) and posture: a state |
//! | `n`, `v` | cost of a state, and the lowest cost of a chain that ends there |
//! | `k_i` | largest number of steps along each axis of the grid there, taken one axis after the other |
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

use super::grid::{AXES, Grid, Shift};
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
    /// Whether the tip can go on from a state of the previous column to one of this column, both at one setting.
    fn goes_on(&self, states: [usize; 2]) -> bool;
    /// Directions of the joints on this transition.
    fn moves_on(&self, states: [usize; 2]) -> Heading;
    /// Whether the arm can go, within the column, from one state to another whose setting differs by a step along `axis`.
    fn turns(&self, axis: usize, states: [usize; 2]) -> bool;
    /// Directions of the joints on this transition.
    fn moves_by_turn(&self, states: [usize; 2]) -> Heading;
    /// Whole turns at a state of this column where a cut begins.
    fn starts(&self, state: usize) -> Winding;
    /// Whole turns after the transition of [`Links::goes_on`]; `None` where they exceed a limit.
    fn winds_on(&self, before: &Winding, states: [usize; 2]) -> Option<Winding>;
    /// Whole turns after the transition of [`Links::turns`]; `None` as above.
    fn winds_by_turn(&self, before: &Winding, states: [usize; 2]) -> Option<Winding>;
}

/// The settings of a lattice, and what a change of them costs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    /// The settings.
    pub grid: Grid,
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
    /// It follows the previous column; the setting may change by these numbers of steps along the axes of the grid.
    Follows([usize; AXES]),
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

/// The way back to each state of each column, as codes of the grid; zero where there is none.
#[derive(Clone, Debug)]
enum Ways {
    /// Of spins alone.
    Bytes(Vec<u8>),
    /// Of several axes.
    Words(Vec<u32>),
}

impl Ways {
    fn new(grid: &Grid, columns: usize) -> Ways {
        let states = columns * grid.len() * SLOTS;
        if grid.codes_are_bytes() {
            Ways::Bytes(Vec::with_capacity(states))
        } else {
            Ways::Words(Vec::with_capacity(states))
        }
    }

    fn extend(&mut self, codes: impl Iterator<Item = u32>) {
        match self {
            Ways::Bytes(bytes) => bytes.extend(codes.map(|code| code as u8)),
            Ways::Words(words) => words.extend(codes),
        }
    }

    fn at(&self, index: usize) -> u32 {
        match self {
            Ways::Bytes(bytes) => u32::from(bytes[index]),
            Ways::Words(words) => words[index],
        }
    }
}

/// The best chains so far.
pub(super) struct Chain {
    turns: Turns,
    together: Together,
    /// The way back; `None` where the chain itself is not requested.
    back: Option<Ways>,
    entries: Vec<Entry>,
    shifts: Vec<Shift>,
    /// Costs of the chains to the states of the last column with states.
    values: Vec<f64>,
    next: Vec<f64>,
    ways: Vec<u32>,
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
    /// State at each column: setting times [`SLOTS`] plus slot; `None` where there is none.
    pub states: Vec<Option<usize>>,
    /// Columns that no transition leads to.
    pub breaks: Vec<usize>,
}

impl Chain {
    /// Before the first column. `traced`: whether the chain itself is requested, or only its cost.
    pub fn new(turns: Turns, together: Together, traced: Option<usize>) -> Chain {
        let states = turns.grid.len() * SLOTS;
        let headed = if turns.back_price > 0.0 { states } else { 0 };
        let wound = if turns.winds { states } else { 0 };
        Chain {
            turns,
            together,
            back: traced.map(|columns| Ways::new(&turns.grid, columns)),
            entries: Vec::new(),
            shifts: Vec::new(),
            values: vec![f64::INFINITY; states],
            next: vec![f64::INFINITY; states],
            ways: vec![0; states],
            came: vec![Came::default(); headed],
            next_came: vec![Came::default(); headed],
            windings: vec![Winding::default(); wound],
            next_windings: vec![Winding::default(); wound],
        }
    }

    /// Adds the next column: the cost of its states (infinite where there is none), how it starts, the shift of its settings
    /// from those of the column before, and its transitions.
    pub fn take(&mut self, costs: &[f64], (beginning, shift): (Beginning, Shift), links: &impl Links) {
        self.shifts.push(shift);
        if costs.iter().all(|cost| cost.is_infinite()) {
            self.entries.push(Entry::Lost);
            if let Some(back) = &mut self.back {
                back.extend(costs.iter().map(|_| 0));
            }
            return;
        }
        let entry = match beginning {
            Beginning::Follows(steps) if self.values.iter().any(|value| value.is_finite()) => {
                self.link(costs, (self.turns.grid.steps(steps), &shift), links);
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
            back.extend(self.ways.iter().copied());
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
    fn link(&mut self, costs: &[f64], (steps, shift): ([usize; AXES], &Shift), links: &impl Links) {
        let Turns { grid, kept_slots, .. } = self.turns;
        let still = grid.code(0);
        self.next.fill(f64::INFINITY);
        self.ways.fill(0);
        for setting in 0..grid.len() {
            let Some(same) = grid.shifted(setting, shift) else {
                continue;
            };
            for to in 0..SLOTS {
                let state = setting * SLOTS + to;
                if costs[state].is_infinite() {
                    continue;
                }
                let from = if kept_slots { to..to + 1 } else { 0..SLOTS };
                for slot in from {
                    let origin = same * SLOTS + slot;
                    let before = self.values[origin];
                    if before >= self.next[state] || !links.goes_on([origin, state]) {
                        continue;
                    }
                    let winding = self.windings.get(origin);
                    let winding = winding.map(|before| links.winds_on(before, [origin, state]));
                    if winding == Some(None) {
                        continue;
                    }
                    let came = self.came.get(origin);
                    let came = came.map(|came| came.then(links.moves_on([origin, state])));
                    let value = before + self.back_price(came);
                    if value < self.next[state] {
                        self.next[state] = value;
                        self.ways[state] = still + slot as u32;
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
        for axis in grid.free_axes() {
            for _ in 0..steps[axis] {
                self.turn_by_a_step(axis, costs, links);
            }
        }
        for (value, cost) in self.next.iter_mut().zip(costs) {
            *value = self.together.of(*value, *cost);
        }
    }

    fn turn_by_a_step(&mut self, axis: usize, costs: &[f64], links: &impl Links) {
        let Turns {
            grid,
            kept_slots,
            price,
            ..
        } = self.turns;
        let weight = grid.weight(axis);
        let before = self.next.clone();
        let ways = self.ways.clone();
        let came = self.next_came.clone();
        let windings = self.next_windings.clone();
        for setting in 0..grid.len() {
            for (sense, neighbour) in grid.neighbours(setting, axis) {
                for to in 0..SLOTS {
                    let state = setting * SLOTS + to;
                    if costs[state].is_infinite() {
                        continue;
                    }
                    let from = if kept_slots { to..to + 1 } else { 0..SLOTS };
                    for slot in from {
                        let there = neighbour * SLOTS + slot;
                        let value = before[there] + price;
                        if value >= self.next[state] || !links.turns(axis, [there, state]) {
                            continue;
                        }
                        let winding = windings.get(there);
                        let winding = winding.map(|before| links.winds_by_turn(before, [there, state]));
                        if winding == Some(None) {
                            continue;
                        }
                        let came = came.get(there);
                        let came = came.map(|came| came.then(links.moves_by_turn([there, state])));
                        let value = value + self.back_price(came);
                        if value < self.next[state] {
                            self.next[state] = value;
                            if let Some(winding) = winding.flatten() {
                                self.next_windings[state] = winding;
                            }
                            self.ways[state] = (i64::from(ways[there]) + sense as i64 * weight) as u32;
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
                    let grid = &self.turns.grid;
                    let (steps, slot) = grid.steps_and_slot(back.at(index * width + state));
                    let same = grid.origin(state / SLOTS, &steps);
                    let Some(before) = grid.shifted(same, &self.shifts[index]) else {
                        break;
                    };
                    state = before * SLOTS + slot;
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

#[cfg(test)]
mod tests;
