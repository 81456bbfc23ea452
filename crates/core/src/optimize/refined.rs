//! Passes along a path, each with smaller steps near the chain of the pass before, and what the last one found.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::chain::Cheapest;
use super::column_at::fill;
use super::freedoms::LeanRange;
use super::grid::AXES;
use super::ground_spin::GroundSpin;
use super::lattice::Lattice;
use super::posture_search::{Objective, PostureFound, PostureSearch, SearchedPath};
use super::reversals::reversals;
use super::smooth::without_steps;
use super::walk::{Cost, Seen, Walk};
use super::window::{Setting, Window};
use crate::kernel::{Column, PostureStatus, Question, SLOTS};
use crate::load::LeaningForces;
use crate::map::along_postures;
use crate::path::{Lean, LoadedTrack, Track};
use crate::robot::Branch;
use crate::watch::{Cancelled, Watch};

/// States of a lattice that is searched at once, without refinement.
const MOST_STATES: usize = 8_000_000;
/// Values along each axis of the first lattice, where it is refined.
const COARSE: [usize; AXES] = [36, 5, 5, 7, 5, 5];
/// How often the steps of an external axis are halved for the first lattice, at most.
const MOST_FINER: usize = 4;
/// Points of the path in the passes before the last one, and the ends of all cuts.
const COARSE_POINTS: usize = 120;
/// Points of the lattice for pictures, where it must be computed for them.
const DRAWN: usize = 200;

/// The best postures along `path` for `search`, in passes with smaller and smaller steps.
pub(super) fn refined(
    question: &Question<'_>,
    path: SearchedPath<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    let LoadedTrack { track, load } = path.loaded;
    let all: Vec<usize> = (0..track.len()).collect();
    let keys = key_points(track);
    let forces = LeaningForces::of(load);
    let mut window = Window::all(search);
    if !window.is_of_spins() && window.grid().len() * SLOTS * all.len() > MOST_STATES {
        window = coarse(search, keys.len());
    }
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let mut near = Vec::new();
    while !window.is_finest() {
        let walk = Walk::new(question, (path, &forces), search, (&window, &keys));
        let (chain, seen, _) = best_chain(&walk, search, quiet)?;
        let settings = walk.settings(&chain);
        if settings.iter().all(Option::is_none) {
            return Ok(nothing(track, &seen));
        }
        near = at_every_point(track, &keys, &settings);
        window = window.halved(&near);
    }
    let last = |window: &Window, watch: Watch<'_>| {
        let last = Last {
            walk: Walk::new(question, (path, &forces), search, (window, &all)),
            window,
            question,
            path,
            search,
        };
        last.found(watch)
    };
    let lost = |found: &PostureFound| found.breaks.len() + found.unreachable.len();
    let found = last(&window, watch)?;
    if lost(&found) == 0 || !window.is_near_a_chain() {
        return Ok(found);
    }
    let wider = last(&window.widened(&near), quiet)?;
    Ok(if lost(&wider) < lost(&found) { wider } else { found })
}

/// The window of the first pass at this number of points: external axes in steps as small as the number of states permits.
fn coarse(search: &PostureSearch, points: usize) -> Window {
    let mut most = COARSE;
    let mut window = Window::coarse(search, most);
    for _ in 0..MOST_FINER {
        for axis in 3..AXES {
            let mut more = most;
            more[axis] *= 2;
            let finer = Window::coarse(search, more);
            if finer.grid().len() * SLOTS * points <= MOST_STATES {
                (most, window) = (more, finer);
            }
        }
    }
    window
}

/// The best chain of a pass without a price on reversals, and the cost of its states.
fn best_chain(
    walk: &Walk<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<(Cheapest, Seen, Cost), Cancelled> {
    let cost = match search.objective {
        Objective::Worst => Cost::Within(walk.chain(Cost::Worst, 0.0, watch)?.0.cost),
        Objective::Mean => Cost::Within(f64::INFINITY),
        Objective::Above(limit) => Cost::Above(limit),
    };
    let (mut chain, mut seen) = walk.chain(cost, 0.0, watch)?;
    if !chain.breaks.is_empty() && search.objective == Objective::Worst {
        // The chains within the largest deviation may all end with a joint at its limit.
        let any = walk.chain(Cost::Within(f64::INFINITY), 0.0, watch)?;
        if any.0.breaks.len() < chain.breaks.len() {
            (chain, seen) = any;
        }
    }
    Ok((chain, seen, cost))
}

/// The last pass.
struct Last<'a> {
    walk: Walk<'a>,
    window: &'a Window,
    question: &'a Question<'a>,
    path: SearchedPath<'a>,
    search: &'a PostureSearch,
}

impl Last<'_> {
    fn found(&self, watch: Watch<'_>) -> Result<PostureFound, Cancelled> {
        let LoadedTrack { track, load } = self.path.loaded;
        let (chain, seen, cost) = best_chain(&self.walk, self.search, watch)?;
        let mut found = self.reported(chain, seen, watch)?;
        if self.search.back_price > 0.0 && track.path.length() > 0.0 {
            let price = self.search.back_price / track.path.length();
            let (chain, seen) = self.walk.chain(cost, price * track.len() as f64, watch)?;
            let other = self.reported(chain, seen, watch)?;
            let total = |found: &PostureFound| -> Result<f64, Cancelled> {
                let turned = found.turned(track);
                let load = found.load(load);
                let along = along_postures(self.question, &turned, load, found.choices(), watch)?;
                let backs: usize = reversals(&track.path, &along.answers).iter().sum();
                Ok(found.reached + price * backs as f64)
            };
            // A chain that stops on the way has no reversal there.
            if (other.breaks.len(), total(&other)?) < (found.breaks.len(), total(&found)?) {
                found = other;
            }
        }
        if let (Objective::Worst, Cost::Within(worst)) = (self.search.objective, cost) {
            found.reached = worst;
        }
        Ok(found)
    }

    fn reported(&self, chain: Cheapest, seen: Seen, watch: Watch<'_>) -> Result<PostureFound, Cancelled> {
        let settings = self.walk.settings(&chain);
        let smooth = |axis: usize| {
            let values: Vec<Option<f64>> = settings.iter().map(|setting| Some((*setting)?[axis])).collect();
            let period = (axis == 0).then_some(TAU);
            let step = (self.window.step(axis), period);
            without_steps(&self.path.loaded.track.path, step, &values, &chain.breaks)
        };
        let branch = |state: &Option<usize>| {
            state
                .filter(|_| seen.named)
                .map(|state| Branch::ALL[state % SLOTS])
        };
        let count = chain.states.iter().flatten().count().max(1);
        let leans = self.search.lean.map(|LeanRange { end, .. }| {
            let leans = smooth(1).into_iter().zip(smooth(2));
            let leans: Vec<Lean> = leans.map(|(lead, tilt)| Lean { lead, tilt }).collect();
            (leans, end)
        });
        let robot = self.question.arm.robot;
        let homes = (!self.search.axes.is_empty()).then(|| {
            let mut homes = robot.home(self.question.home).repeat(settings.len());
            for (axis, moving) in self.search.axes.iter().enumerate() {
                let width = robot.joints().len();
                let positions = smooth(3 + axis);
                for (home, position) in homes.chunks_mut(width).zip(positions) {
                    home[moving.joint] = position;
                }
            }
            homes
        });
        let mut spins = smooth(0);
        if let Some(homes) = &homes {
            let track = match &leans {
                Some((leans, end)) => &self.path.loaded.track.leaning(leans, *end),
                None => self.path.loaded.track,
            };
            let ground_spin = GroundSpin::of(robot, track, self.question.home);
            for (index, home) in homes.chunks(robot.joints().len()).enumerate() {
                let axis = track.stop(index).base_from_tool * Vector3::z();
                spins[index] += ground_spin.at(home, &axis);
            }
        }
        Ok(PostureFound {
            spins,
            leans,
            homes,
            branches: chain.states.iter().map(branch).collect(),
            reached: chain.cost / count as f64,
            lattice: self.lattice(&chain, &seen, &settings, watch)?,
            unreachable: seen.unreachable,
            breaks: chain.breaks,
        })
    }

    /// The lattice of spins: that of the search, or with lean and external axes as they were chosen.
    fn lattice(
        &self,
        chain: &Cheapest,
        seen: &Seen,
        settings: &[Option<Setting>],
        watch: Watch<'_>,
    ) -> Result<Lattice, Cancelled> {
        if self.window.is_of_spins() {
            return Ok(Lattice::of(&self.search.spins, &seen.kept, &chain.states));
        }
        let stride = settings.len().div_ceil(DRAWN).max(1);
        let spins = &self.search.spins;
        let mut states = vec![None; settings.len()];
        let mut kept = Vec::new();
        let mut maker = self.walk.maker();
        let mut clear_of_stock = self.walk.clear_of_stock();
        let mut column = Column::default();
        for index in (0..settings.len()).step_by(stride) {
            let Some(setting) = settings[index] else { continue };
            let window = Window::of_spins_at(self.search, &setting);
            fill(
                (&mut maker, self.walk.forces),
                self.path.loaded,
                index,
                (self.search, &window),
                &mut column,
            );
            if let Some(stock) = &mut clear_of_stock {
                let spins = window.grid().spins();
                stock.exclude(&[index], std::slice::from_mut(&mut column), spins, watch)?;
            }
            let turn = (setting[0] - spins.first) / spins.step;
            let turns = spins.count as isize;
            let turn = (turn.round() as isize).rem_euclid(turns) as usize;
            states[index] = chain.states[index].map(|state| turn * SLOTS + state % SLOTS);
            kept.push((index, column.deviations.clone(), column.statuses.clone()));
        }
        Ok(Lattice::of(spins, &kept, &states))
    }
}

/// Points for the passes before the last one: evenly spread, with the ends of all cuts.
fn key_points(track: &Track) -> Vec<usize> {
    let count = track.len();
    let stride = count.div_ceil(COARSE_POINTS).max(1);
    let is_end =
        |index: usize| index + 1 == count || track.path.begins(index) || track.path.begins(index + 1);
    (0..count)
        .filter(|index| index % stride == 0 || is_end(*index))
        .collect()
}

/// The settings at every point of the path, on straight lines between those at `keys`; spins by the shorter way.
fn at_every_point(track: &Track, keys: &[usize], settings: &[Option<Setting>]) -> Vec<Setting> {
    let points = &track.path.points;
    let mut known: Vec<(usize, Setting)> = Vec::with_capacity(keys.len());
    for (key, setting) in keys.iter().zip(settings) {
        let Some(mut setting) = *setting else { continue };
        if let Some((_, before)) = known.last() {
            setting[0] += TAU * ((before[0] - setting[0]) / TAU).round();
        }
        known.push((*key, setting));
    }
    let mut at = Vec::with_capacity(points.len());
    let mut next = 0;
    for index in 0..points.len() {
        while next < known.len() && known[next].0 < index {
            next += 1;
        }
        let after = known.get(next).or(known.last());
        let before = known.get(next.saturating_sub(1)).or(known.last());
        let (Some((from, a)), Some((to, b))) = (before, after) else {
            return at;
        };
        let apart = points[*to].along - points[*from].along;
        let cut = track.path.begins(*to);
        let part = if apart > 0.0 && !cut {
            ((points[index].along - points[*from].along) / apart).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(index >= *to))
        };
        at.push(std::array::from_fn(|axis| a[axis] + part * (b[axis] - a[axis])));
    }
    at
}

/// No posture at any key point.
fn nothing(track: &Track, seen: &Seen) -> PostureFound {
    let reason = |index: usize| {
        let at = seen.unreachable.partition_point(|(key, _)| *key <= index);
        let found = seen.unreachable.get(at.saturating_sub(1));
        found.map_or(PostureStatus::OutOfReach, |(_, status)| *status)
    };
    let count = track.len();
    PostureFound {
        spins: vec![0.0; count],
        leans: None,
        homes: None,
        branches: vec![None; count],
        unreachable: (0..count).map(|index| (index, reason(index))).collect(),
        breaks: Vec::new(),
        reached: 0.0,
        lattice: Lattice::default(),
    }
}

#[cfg(test)]
mod ring;
#[cfg(test)]
mod several_axes;
#[cfg(test)]
mod tests;
