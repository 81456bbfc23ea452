//! One pass along a path: the chain of postures with the lowest cost through the settings of a window.

use rayon::prelude::*;

use super::chain::{Beginning, Chain, Cheapest, Together, Turns};
use super::clear_of_stock::ClearOfStock;
use super::column_at::{blocked_by, fill};
use super::grid::{AXES, Shift, UNSHIFTED};
use super::links::{Between, FAR, JointRate};
use super::posture_search::{PostureSearch, SearchedPath};
use super::winding::WindingJoints;
use super::window::{Setting, Window};
use crate::kernel::{Column, Columns, PostureStatus, Question, SLOTS};
use crate::load::LeaningForces;
use crate::path::Pace;
use crate::watch::{Cancelled, Watch};

/// Columns computed at once.
const CHUNK: usize = 256;
/// States of the columns computed at once, at most.
const STATES_AT_ONCE: usize = 4_000_000;
/// Points of the lattice that are kept.
const KEPT: usize = 800;
/// Weight of deviations within the tolerance, so that of chains within it the better one is selected.
pub(super) const WITHIN: f64 = 1e-3;

/// Cost of a state from its deviation.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cost {
    /// The deviation; the largest is used.
    Worst,
    /// The deviation; states above this are excluded.
    Within(f64),
    /// The excess over this tolerance.
    Above(f64),
}

impl Cost {
    fn of(self, deviation: f64) -> f64 {
        match self {
            Cost::Worst => deviation,
            Cost::Within(most) if deviation > most => f64::INFINITY,
            Cost::Within(_) => deviation,
            Cost::Above(limit) if deviation.is_finite() => (deviation - limit).max(0.0) + WITHIN * deviation,
            Cost::Above(_) => f64::INFINITY,
        }
    }

    fn together(self) -> Together {
        match self {
            Cost::Worst => Together::Worst,
            Cost::Within(_) | Cost::Above(_) => Together::Sum,
        }
    }
}

/// One pass along the path.
pub(super) struct Walk<'a> {
    question: &'a Question<'a>,
    path: SearchedPath<'a>,
    /// Of its load with the tool leaning.
    pub(super) forces: &'a LeaningForces,
    search: &'a PostureSearch,
    window: &'a Window,
    /// The points of the path that have a column, in ascending order; the first of each cut is one of them.
    points: &'a [usize],
    joints: Vec<JointRate>,
    winding: WindingJoints,
}

/// Observations in addition to the chain.
#[derive(Default)]
pub(super) struct Seen {
    /// Points without a usable posture.
    pub unreachable: Vec<(usize, PostureStatus)>,
    /// Columns of the thinned lattice, with all their slots; of a window of [spins](Window::is_of_spins) alone.
    pub kept: Vec<(usize, Vec<f64>, Vec<PostureStatus>)>,
    /// Whether slots are branches.
    pub named: bool,
}

impl<'a> Walk<'a> {
    /// Along these points of the path, with the settings of this window.
    pub fn new(
        question: &'a Question<'a>,
        (path, forces): (SearchedPath<'a>, &'a LeaningForces),
        search: &'a PostureSearch,
        (window, points): (&'a Window, &'a [usize]),
    ) -> Walk<'a> {
        let joints = JointRate::all(question.arm.robot);
        Walk {
            question,
            path,
            forces,
            search,
            window,
            points,
            winding: WindingJoints::of(question.arm.robot, |joint| joints[joint].wraps()),
            joints,
        }
    }

    /// A calculation of columns for this search.
    pub fn maker(&self) -> Columns<'a> {
        Columns::new(self.question.arm, self.question.home, self.search.wrist)
            .keeping_clear(self.question.clearance_check())
    }

    /// The postures that are near the stock, excluded in the order of the path; `None` without a stock or a demanded
    /// clearance.
    pub fn clear_of_stock(&self) -> Option<ClearOfStock<'a>> {
        let demanded = self.question.clearance?;
        let of_round = self.path.least_of_round.unwrap_or(demanded.least);
        let stock = self.path.stock?;
        Some(ClearOfStock::new(self.question, demanded, stock, of_round))
    }

    /// The best chain, with this price per reversal. Its states are those of the points with a column.
    pub fn chain(
        &self,
        cost: Cost,
        back_price: f64,
        watch: Watch<'_>,
    ) -> Result<(Cheapest, Seen), Cancelled> {
        let maker = || self.maker();
        let worst_alone = matches!(cost, Cost::Worst);
        let grid = self.window.grid();
        let turns = Turns {
            grid,
            kept_slots: self.maker().slots_are_branches(),
            price: if worst_alone { 0.0 } else { self.search.turn_price },
            back_price,
            winds: !self.winding.is_empty(),
        };
        let points = self.points.len();
        let mut chain = Chain::new(turns, cost.together(), (!worst_alone).then_some(points));
        let mut seen = Seen {
            named: turns.kept_slots,
            ..Seen::default()
        };
        let keeps = self.window.is_of_spins();
        let stride = points.div_ceil(KEPT).max(1);
        let at_once = CHUNK.min(STATES_AT_ONCE / (grid.len() * SLOTS)).max(1);
        let mut columns: Vec<Column> = vec![Column::default(); at_once.min(points)];
        let mut clear_of_stock = self.clear_of_stock();
        let mut before = Column::default();
        let mut costs = Vec::new();
        for first in (0..points).step_by(at_once) {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let chunk = &mut columns[..at_once.min(points - first)];
            let filled: Result<(), Cancelled> =
                chunk
                    .par_iter_mut()
                    .enumerate()
                    .try_for_each_init(maker, |maker, (i, column)| {
                        if watch.is_cancelled() {
                            return Err(Cancelled);
                        }
                        let tried = (self.search, self.window);
                        fill(
                            (maker, self.forces),
                            self.path.loaded,
                            self.points[first + i],
                            tried,
                            column,
                        );
                        Ok(())
                    });
            filled?;
            if let Some(stock) = &mut clear_of_stock {
                stock.exclude(&self.points[first..][..chunk.len()], chunk, grid.spins(), watch)?;
            }
            for i in 0..chunk.len() {
                let index = first + i;
                let (done, rest) = chunk.split_at(i);
                let here = &rest[0];
                costs.clear();
                costs.extend(here.deviations.iter().map(|deviation| cost.of(*deviation)));
                let links = Between {
                    before: done.last().unwrap_or(&before),
                    here,
                    joints: &self.joints,
                    winding: &self.winding,
                    time: self.time(index),
                    step_times: self.step_times(index),
                    far: if self.window.is_finest() { FAR } else { 2.0 * FAR },
                };
                chain.take(&costs, (self.beginning(index), self.shift(index)), &links);
                if !worst_alone {
                    seen.note(self.points[index], here, keeps && index % stride == 0);
                }
            }
            if let Some(last) = chunk.last() {
                before.clone_from(last);
            }
            (watch.finished)(chunk.len());
        }
        Ok((chain.cheapest(), seen))
    }

    /// The settings of a chain, at each point with a column.
    pub fn settings(&self, chain: &Cheapest) -> Vec<Option<Setting>> {
        let grid = self.window.grid();
        let states = chain.states.iter().zip(self.points);
        states
            .map(|(state, point)| Some(self.window.setting(grid.indices((*state)? / SLOTS), *point)))
            .collect()
    }

    /// How column number `index` starts.
    fn beginning(&self, index: usize) -> Beginning {
        let path = &self.path.loaded.track.path;
        if path.begins(self.points[index]) {
            return Beginning::Restart;
        }
        let [before, here] = [self.points[index - 1], self.points[index]];
        let steps = |axis: usize| {
            let per_step = self.rate(axis) / self.window.step(axis);
            let so_far = |at: usize| (path.points[at].along * per_step).floor();
            (so_far(here) - so_far(before)).max(0.0) as usize
        };
        Beginning::Follows(std::array::from_fn(steps))
    }

    /// The shift of the settings of column number `index` from those of the column before.
    fn shift(&self, index: usize) -> Shift {
        match index.checked_sub(1) {
            Some(before) => self.window.shift(self.points[before], self.points[index]),
            None => UNSHIFTED,
        }
    }

    /// Largest change along an axis of the grid on the path, rad/m (m/m).
    fn rate(&self, axis: usize) -> f64 {
        match axis {
            0 => self.search.turn_rate,
            1 | 2 => self.search.lean.map_or(0.0, |lean| lean.rate),
            _ => {
                let moving = self.search.axes.get(axis - 3);
                moving
                    .filter(|moving| !moving.still)
                    .map_or(0.0, |moving| moving.rate)
            }
        }
    }

    /// The feed at column number `index`, m/s, where it is known.
    fn feed(&self, index: usize) -> Option<f64> {
        match self.path.loaded.track.path.points[self.points[index]].pace {
            Pace::Feed(speed) if speed > 0.0 => Some(speed),
            _ => None,
        }
    }

    /// Time from the column before to column number `index`, s, where the feed is known.
    fn time(&self, index: usize) -> Option<f64> {
        let speed = self.feed(index)?;
        let along = |column: usize| self.path.loaded.track.path.points[self.points[column]].along;
        Some((along(index) - along(index.checked_sub(1)?)) / speed)
    }

    /// Shortest time for a step along each axis, s, where the feed is known.
    fn step_times(&self, index: usize) -> Option<[f64; AXES]> {
        let speed = self.feed(index)?;
        Some(std::array::from_fn(|axis| {
            self.window.step(axis) / (self.rate(axis) * speed)
        }))
    }
}

impl Seen {
    fn note(&mut self, index: usize, column: &Column, keep: bool) {
        if !column.statuses.contains(&PostureStatus::Usable) {
            self.unreachable.push((index, blocked_by(column)));
        }
        if keep {
            self.kept
                .push((index, column.deviations.clone(), column.statuses.clone()));
        }
    }
}
