//! Check for better placements on grids, near the best placement and over the whole range.
//!
//! Near it every degree of freedom is stepped in both directions. Over the whole range the pitch is as fine as the
//! effort allows, the same in all millimetres and in all degrees. A placement is evaluated until it is known to be no
//! better. For the largest deviation some points of the path may show that first; the others are evaluated completely.

use armill_core::kernel::PartPlacement;
use armill_core::optimize::{Objective, Placeable, RankBy, Score};
use armill_core::units::to_mm;
use armill_core::watch::{Cancelled, Watch};
use schemars::JsonSchema;
use serde::Serialize;

use super::followed::Extent;
use super::freedom::is_angle;
use super::search::{Searched, Spot};

/// Placements on grids, compared with the best.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CertificateAnswer {
    /// Near it.
    pub near: GridAnswer,
    /// Over all that is free.
    pub wide: GridAnswer,
}

/// One grid of places.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct GridAnswer {
    /// How many places.
    pub places: usize,
    /// From one to the next along x, y and z.
    pub pitch_mm: f64,
    /// From one to the next in every angle.
    pub pitch_deg: f64,
    /// Placements that are better than the best of the search.
    pub better: usize,
}

/// Pitch of the grid near a placement, m and rad.
const NEAR: [f64; 2] = [2e-3, 0.5 * PER_DEG];
/// Finest pitch of the grid over all that is free.
const FINEST: [f64; 2] = [5e-3, PER_DEG];
const PER_DEG: f64 = std::f64::consts::PI / 180.0;
/// Factor by which the next grid is coarser.
const COARSER: f64 = 1.05;
/// Places worked on at once.
const CHUNK: usize = 8192;
/// A placement is better if it differs by more than this part of the cost: less is rounding.
const SLACK: f64 = 1e-9;

/// Placements on a grid: this number along each free degree, from the first part of its range with this step.
struct Grid {
    first: Vec<f64>,
    step: Vec<f64>,
    component: Vec<usize>,
    pitch: [f64; 2],
}

impl GridAnswer {
    /// Both grids as one, for other placements.
    pub(super) fn and(self, other: GridAnswer) -> GridAnswer {
        GridAnswer {
            places: self.places + other.places,
            pitch_mm: self.pitch_mm.max(other.pitch_mm),
            pitch_deg: self.pitch_deg.max(other.pitch_deg),
            better: self.better + other.better,
        }
    }
}

impl Searched<'_> {
    /// The grid near `best`, and its best placement if that is better.
    pub(super) fn near_grid(
        &self,
        best: &Spot,
        watch: Watch<'_>,
    ) -> Result<(GridAnswer, Option<Spot>), Cancelled> {
        self.grid(&self.near(&best.at), &best.score, watch)
    }

    /// The grid over the whole range, for a placement with the score `best`, and its best placement if that is better.
    pub(super) fn wide_grid(
        &self,
        best: &Score,
        watch: Watch<'_>,
    ) -> Result<(GridAnswer, Option<Spot>), Cancelled> {
        self.grid(&self.wide(), best, watch)
    }

    /// Greatest number of placements of a grid: fewer if all points must be evaluated.
    fn most(&self) -> usize {
        match self.is_quick() {
            true => self.effort.grid,
            false => (self.effort.grid * self.effort.points / self.all.path.len().max(1))
                .clamp(100, self.effort.grid),
        }
    }

    /// Whether some points show that a placement is no better.
    fn is_quick(&self) -> bool {
        matches!(
            (self.all.objective.objective, self.all.objective.rank_by),
            (Objective::Worst, RankBy::Nominal)
        )
    }

    fn near(&self, at: &[f64]) -> Grid {
        let degrees = at.len() as u32;
        let steps = match () {
            () if 5_usize.pow(degrees) <= self.most() => 2,
            () if 3_usize.pow(degrees) <= self.most() => 1,
            () => 0,
        };
        let mut grid = Grid {
            first: Vec::new(),
            step: Vec::new(),
            component: Vec::new(),
            pitch: NEAR,
        };
        for ((degree, [least, greatest]), at) in self.freedom.free().zip(at) {
            let step = NEAR[usize::from(is_angle(degree))] / (greatest - least);
            // Placements outside the bounds are left out.
            let fits = |part: f64| (part / step + 1e-9).floor().min(f64::from(steps)) as usize;
            let (below, above) = (fits(*at), fits(1.0 - at));
            grid.first.push(at - below as f64 * step);
            grid.step.push(step);
            grid.component.push(below + above + 1);
        }
        grid
    }

    fn wide(&self) -> Grid {
        let mut pitch = FINEST;
        loop {
            let component: Vec<usize> = self
                .freedom
                .free()
                .map(|(degree, [least, greatest])| {
                    ((greatest - least) / pitch[usize::from(is_angle(degree))]).ceil() as usize + 1
                })
                .collect();
            let places: f64 = component.iter().map(|count| *count as f64).product();
            if places <= self.most() as f64 {
                return Grid {
                    first: vec![0.0; component.len()],
                    step: component
                        .iter()
                        .map(|count| 1.0 / (count - 1).max(1) as f64)
                        .collect(),
                    component,
                    pitch,
                };
            }
            pitch = pitch.map(|pitch| pitch * COARSER);
        }
    }

    fn grid(
        &self,
        grid: &Grid,
        best: &Score,
        watch: Watch<'_>,
    ) -> Result<(GridAnswer, Option<Spot>), Cancelled> {
        let bar = Score {
            cost: best.cost - SLACK * best.cost.abs(),
            ..*best
        };
        let places = grid.len();
        let (mut better, mut found) = (0, None::<Spot>);
        for first in (0..places).step_by(CHUNK) {
            let mut left: Vec<Vec<f64>> = (first..places.min(first + CHUNK)).map(|i| grid.at(i)).collect();
            let looked = left.len();
            if self.is_quick() {
                left = self
                    .better(&self.some, left, &bar, watch)?
                    .into_iter()
                    .map(|spot| spot.at)
                    .collect();
            }
            let mut spots = self.better(&self.all, left, &bar, watch)?;
            self.check_each(&mut spots)?;
            for spot in spots.into_iter().filter(|spot| spot.score.beats(&bar)) {
                better += 1;
                if found.as_ref().is_none_or(|found| spot.score.beats(&found.score)) {
                    found = Some(spot);
                }
            }
            (watch.finished)(looked);
        }
        let [metres, radians] = grid.pitch;
        let answer = GridAnswer {
            places,
            pitch_mm: to_mm(metres),
            pitch_deg: radians / PER_DEG,
            better,
        };
        Ok((answer, found))
    }

    /// Checks each of these placements for the turns of the joints along the path.
    fn check_each(&self, spots: &mut [Spot]) -> Result<(), Cancelled> {
        for spot in spots {
            self.check(Extent::All, std::slice::from_mut(spot), &Score::NONE)?;
        }
        Ok(())
    }

    /// Of these places those that are better than `bar` on this path, in their order.
    fn better(
        &self,
        path: &Placeable<'_>,
        places: Vec<Vec<f64>>,
        bar: &Score,
        watch: Watch<'_>,
    ) -> Result<Vec<Spot>, Cancelled> {
        let placements: Vec<PartPlacement> =
            places.iter().map(|at| self.freedom.part_placement(at)).collect();
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let scores = path.scores(&placements, Some(bar), quiet)?;
        let both = places.into_iter().zip(scores);
        let spots = both.filter_map(|(at, score)| Some(Spot { at, score: score? }));
        Ok(spots.filter(|spot| spot.score.beats(bar)).collect())
    }
}

impl Grid {
    fn len(&self) -> usize {
        self.component.iter().product()
    }

    fn at(&self, mut index: usize) -> Vec<f64> {
        let mut at = Vec::with_capacity(self.component.len());
        for ((first, step), count) in self.first.iter().zip(&self.step).zip(&self.component) {
            at.push((first + step * (index % count) as f64).clamp(0.0, 1.0));
            index /= count;
        }
        at
    }
}
