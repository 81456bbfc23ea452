//! The search itself: places spread over all that is free, then the valleys under the best of them, then their floors.
//!
//! ```text
//! Sobol points on some points of the path -> CMA-ES from the best separate ones -> CMA-ES with small steps on all points
//! ```
//!
//! Placements that would be the best so far are checked for the turns of the joints along the path ([`FollowedPath`]).
//! For a path of many points some are evaluated first; the local search uses all. With the same seed the result is the
//! same on any number of threads: placements are proposed by one thread, evaluated by all, and reported in order.

use armill_core::kernel::PartPlacement;
use armill_core::optimize::{Placeable, Score};
use armill_core::units::to_um;
use armill_core::watch::{Cancelled, Watch};
use fcmaes_core::{Cmaes, CmaesParams, Fitness};

use super::followed::{Extent, FollowedPath};
use super::freedom::Freedom;

/// How much is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Effort {
    /// Places spread over all that is free.
    pub spread: usize,
    /// Valleys that are gone down.
    pub rounds: usize,
    /// Places looked at in each.
    pub places: usize,
    /// Places looked at on the floor, with all points.
    pub floor: usize,
    /// Points of the path that are looked at until then.
    pub points: usize,
    /// Places of each grid of the certificate, at the most.
    pub grid: usize,
}

impl Effort {
    /// For robots with a vectorised solution, along a path with this number of points.
    pub fn lanes(points: usize) -> Effort {
        let points = points.clamp(1, 240);
        Effort {
            spread: 8192,
            rounds: 6,
            places: 4000,
            floor: 1600,
            points,
            // Vector lanes evaluate eighty points at once.
            grid: 1_500_000 / points.div_ceil(80),
        }
    }

    /// For robots that are evaluated one pose after the other.
    pub const ONE_BY_ONE: Effort = Effort {
        spread: 512,
        rounds: 3,
        places: 900,
        floor: 300,
        points: 40,
        grid: 3000,
    };

    /// Less of the same, if each placement is as much work as this number.
    pub fn shared_by(self, count: usize) -> Effort {
        let share = |of: usize, least: usize| (of / count.max(1)).max(least.min(of));
        Effort {
            grid: share(self.grid, 1000),
            spread: share(self.spread, 512),
            places: share(self.places, 800),
            floor: share(self.floor, 300),
            ..self
        }
    }

    /// Less of the same, where a good start is known.
    pub fn cheaper(self) -> Effort {
        Effort {
            spread: self.spread / 4,
            rounds: 2,
            places: self.places / 2,
            floor: self.floor / 2,
            ..self
        }
    }

    /// Places that a search looks at, at the most.
    pub fn most(&self) -> usize {
        self.spread + self.rounds * self.places + self.floor
    }
}

/// A path with some of its points, and the free degrees.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a> {
    pub some: Placeable<'a>,
    pub all: Placeable<'a>,
    pub followed: &'a FollowedPath<'a>,
    pub freedom: &'a Freedom,
    pub effort: Effort,
    pub seed: u64,
}

/// A placement: parts of the ranges of the free degrees, and its score.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spot {
    pub at: Vec<f64>,
    pub score: Score,
}

/// Placements nearer than this part of the ranges are in one region.
const APART: f64 = 0.15;
/// First steps of the regional and of the local search, parts of the ranges.
const STEP: f64 = 0.15;
const FLOOR_STEP: f64 = 0.01;
/// Most of Sobol's points that there are.
const MOST_SPREAD: usize = 1 << 16;
/// Costs differ by less than this, um, where a valley ends.
const FLAT_UM: f64 = 1e-6;
/// Penalty of a placement with unreachable points, larger than any cost.
const LOST_UM: f64 = 1e9;

impl Searched<'_> {
    /// The best of the placements spread over the range, best first, separate from each other, as many as there are
    /// rounds.
    pub fn starts(&self, watch: Watch<'_>) -> Result<Vec<Spot>, Cancelled> {
        // Without free degrees there is one placement.
        let count = match self.freedom.count() {
            0 => 1,
            _ => self.effort.spread.min(MOST_SPREAD),
        };
        let spread = sobol(count, self.freedom.count(), self.seed);
        let mut spots = self.spots(&self.some, spread, watch)?;
        // A stable sort, so that of equal ones the first stays first.
        spots.sort_by(|a, b| {
            let key = |spot: &Spot| (spot.score.unreachable, spot.score.cost);
            key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1))
        });
        let mut starts: Vec<Spot> = Vec::new();
        for spot in spots {
            if starts.len() < self.effort.rounds
                && starts.iter().all(|other| apart(&other.at, &spot.at) > APART)
            {
                starts.push(spot);
            }
        }
        Ok(starts)
    }

    /// The bottom of the valley around `start`, on some points; round `index` of all.
    pub fn valley(&self, start: &[f64], index: usize, watch: Watch<'_>) -> Result<Spot, Cancelled> {
        // Wider and wider populations see past smaller and smaller hills.
        let population = 16 << (index / 2).min(3);
        let run = Run {
            step: STEP,
            population,
            places: self.effort.places,
            seed: self.seed.wrapping_add(1 + index as u64),
        };
        self.descend(Extent::Some, start, run, watch)
    }

    /// The floor around `start`, on all points.
    pub fn floor(&self, start: &[f64], watch: Watch<'_>) -> Result<Spot, Cancelled> {
        let run = Run {
            step: FLOOR_STEP,
            population: 16,
            places: self.effort.floor,
            seed: self.seed.wrapping_add(1000),
        };
        self.descend(Extent::All, start, run, watch)
    }

    /// The placement at `at`, evaluated at all points.
    pub fn evaluated(&self, at: Vec<f64>) -> Result<Spot, Cancelled> {
        let mut spots = self.spots(&self.all, vec![at], Watch::NONE)?;
        self.check(Extent::All, &mut spots, &Score::NONE)?;
        Ok(spots.into_iter().next().unwrap_or(Spot {
            at: Vec::new(),
            score: Score::NONE,
        }))
    }

    fn spots(
        &self,
        path: &Placeable<'_>,
        places: Vec<Vec<f64>>,
        watch: Watch<'_>,
    ) -> Result<Vec<Spot>, Cancelled> {
        let placements: Vec<PartPlacement> =
            places.iter().map(|at| self.freedom.part_placement(at)).collect();
        let scores = path.scores(&placements, None, watch)?;
        let both = places.into_iter().zip(scores);
        Ok(both
            .map(|(at, score)| Spot {
                at,
                score: score.unwrap_or(Score::NONE),
            })
            .collect())
    }

    /// Checks the placements that beat `bar`, best first, until one of them can be followed: it is better than all
    /// others. The scores of the others before it have the points that are lost.
    pub fn check(&self, extent: Extent, spots: &mut [Spot], bar: &Score) -> Result<(), Cancelled> {
        let mut order: Vec<usize> = (0..spots.len()).collect();
        let key = |index: &usize| (spots[*index].score.unreachable, spots[*index].score.cost);
        order.sort_by(|a, b| key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)));
        for index in order {
            let spot = &mut spots[index];
            if !spot.score.beats(bar) {
                break;
            }
            let placement = self.freedom.part_placement(&spot.at);
            let given = spot.score;
            spot.score = (self.followed).checked(&self.all.objective, &placement, given, extent)?;
            if spot.score == given {
                break;
            }
        }
        Ok(())
    }

    fn descend(&self, extent: Extent, start: &[f64], run: Run, watch: Watch<'_>) -> Result<Spot, Cancelled> {
        let count = start.len();
        let path = match extent {
            Extent::Some => &self.some,
            Extent::All => &self.all,
        };
        let mut first = self.spots(path, vec![start.to_vec()], watch)?;
        self.check(extent, &mut first, &Score::NONE)?;
        let mut best = first.remove(0);
        let mut looked = 1;
        if count > 0 {
            let bounds = Fitness::bounded(count, 1, &vec![0.0; count], &vec![1.0; count]);
            let requested = CmaesParams {
                popsize: run.population,
                max_evaluations: run.places as u64,
                accuracy: FLAT_UM / 1e-12,
                seed: run.seed,
                ..CmaesParams::default()
            };
            let mut strategy = Cmaes::new(bounds, start, &[run.step], &requested);
            while looked < run.places && strategy.stop() == 0 {
                let mut spots = self.spots(path, strategy.ask(), watch)?;
                self.check(extent, &mut spots, &best.score)?;
                looked += spots.len();
                let costs: Vec<f64> = spots.iter().map(|spot| cost_um(&spot.score)).collect();
                strategy.tell(&costs);
                for spot in spots {
                    if spot.score.beats(&best.score) {
                        best = spot;
                    }
                }
            }
        }
        // Work that was not needed counts as finished.
        (watch.finished)(run.places.saturating_sub(looked));
        Ok(best)
    }
}

/// One way down.
struct Run {
    /// First step, part of the ranges.
    step: f64,
    population: i32,
    /// Places looked at, at the most.
    places: usize,
    seed: u64,
}

/// Feasibility first, as one number.
fn cost_um(score: &Score) -> f64 {
    score.unreachable as f64 * LOST_UM + to_um(score.cost)
}

/// The first points of Sobol in a cube of this many dimensions, of edge 1.
pub(super) fn sobol(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let part = |index: usize, dimension: usize| {
        f64::from(sobol_burley::sample(index as u32, dimension as u32, seed as u32))
    };
    let point = |index: usize| (0..dimensions).map(|dimension| part(index, dimension)).collect();
    (0..count).map(point).collect()
}

/// Largest difference of two places in any degree.
pub(super) fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
