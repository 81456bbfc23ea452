//! The remaining stock as a body: its distance from another one.
//!
//! Every cell of the height map is a column from the bottom of the stock to its height; where no material is left, there
//! is none. Squares of `4 x 4` cells have the greatest height of their columns, squares of these theirs, and so on
//! (a pyramid): a box of that height encloses all columns below it, so that its distance is a lower bound of theirs.
//! Squares whose bound is not below the least distance found so far are not opened (branch and bound).
//!
//! The result is that of all columns, to [`ROUNDING`].

use std::ops::Range;

use nalgebra::{IsometryMatrix3, Point3};

use super::stock::Stock;
use crate::clearance::shape::Placed;
use crate::clearance::{Bounds, Capsule, Nearest, Shape};
use crate::load::EndMillBody;

/// Sides of a square, in squares of the level below.
const SIDE: usize = 4;
/// Squares whose bound is this close to the least distance found, m, are not opened: bounds have rounding.
pub const ROUNDING: f64 = 1e-12;

/// A stock that is cut, with its pyramid of greatest heights.
#[derive(Clone, Debug)]
pub struct RemainingStock {
    stock: Stock,
    /// From the squares of cells to the one square over all.
    levels: Vec<Level>,
}

/// Squares of equal size; x runs fastest.
#[derive(Clone, Debug)]
struct Level {
    squares: [usize; 2],
    greatest: Vec<f32>,
}

/// A body in the frame of the stock.
#[derive(Clone, Debug)]
pub struct BodyNearStock {
    placed: Placed,
    hull: Capsule,
    bounds: Bounds,
}

impl BodyNearStock {
    /// The shape of a body at this place.
    pub fn new(shape: &Shape, path_from_body: &IsometryMatrix3<f64>) -> BodyNearStock {
        let turn = path_from_body.rotation.matrix().abs();
        BodyNearStock {
            placed: shape.placed(path_from_body),
            hull: shape.hull().moved(path_from_body),
            bounds: shape.bounds().moved(path_from_body, &turn),
        }
    }

    /// A lower bound of its distance from what is inside of a box, m; may be negative.
    fn bound_to(&self, around: &Bounds) -> f64 {
        self.hull.bound_to(around).max(self.bounds.distance(around))
    }

    /// The nearest points of the body and a box, if they are nearer than `limit`, m.
    fn nearest(&self, other: &Bounds, limit: f64) -> Option<Nearest> {
        if self.bound_to(other) >= limit - ROUNDING {
            return None;
        }
        let other = Shape::Box(*other).placed(&IsometryMatrix3::identity());
        let found = self.placed.nearest(&other, limit)?;
        (found.distance < limit - ROUNDING).then_some(found)
    }
}

/// The nearest column of a stock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestColumn {
    /// Distance and points, that of the body first; frame of the path, m.
    pub nearest: Nearest,
    /// Number of the cell along x and along y.
    pub cell: [usize; 2],
}

/// A square that is not opened yet.
#[derive(Clone, Copy)]
struct Open {
    bound: f64,
    /// Its level; cells are level 0.
    level: usize,
    at: [usize; 2],
}

impl RemainingStock {
    /// The stock, and its pyramid.
    pub fn new(stock: Stock) -> RemainingStock {
        let mut levels: Vec<Level> = Vec::new();
        let mut below = stock.cells();
        loop {
            let squares = below.map(|count| count.div_ceil(SIDE));
            levels.push(Level {
                squares,
                greatest: vec![0.0; squares[0] * squares[1]],
            });
            if squares == [1, 1] {
                break;
            }
            below = squares;
        }
        let [columns, rows] = stock.cells();
        let mut remaining = RemainingStock { stock, levels };
        remaining.update([0..columns, 0..rows]);
        remaining
    }

    /// The stock.
    pub fn stock(&self) -> &Stock {
        &self.stock
    }

    /// Lowers every cell that the cutter passes over on a straight step.
    pub(super) fn remove(&mut self, [from, to]: [Point3<f64>; 2], cutter: &EndMillBody) {
        if self.stock.remove(from, to, cutter).volume > 0.0 {
            let radius = cutter.radius();
            let changed = [0, 1].map(|k| {
                let (low, high) = (from[k].min(to[k]) - radius, from[k].max(to[k]) + radius);
                self.stock.cells_between(k, low, high)
            });
            self.update(changed);
        }
    }

    /// Computes the squares over these cells.
    fn update(&mut self, cells: [Range<usize>; 2]) {
        let mut changed = cells;
        for level in 0..self.levels.len() {
            changed = changed.map(|range| range.start / SIDE..range.end.div_ceil(SIDE));
            for y in changed[1].clone() {
                for x in changed[0].clone() {
                    let greatest = self.greatest_below(level, [x, y]);
                    let Level {
                        squares,
                        greatest: all,
                    } = &mut self.levels[level];
                    all[y * squares[0] + x] = greatest;
                }
            }
        }
    }

    /// The greatest height of the squares (or cells) in square `at` of a level of the pyramid.
    fn greatest_below(&self, level: usize, at: [usize; 2]) -> f32 {
        let (heights, count) = match level.checked_sub(1) {
            None => (self.stock.heights(), self.stock.cells()),
            Some(below) => (&self.levels[below].greatest[..], self.levels[below].squares),
        };
        let [columns, rows] = [0, 1].map(|k| at[k] * SIDE..((at[k] + 1) * SIDE).min(count[k]));
        let of_row = |row: usize| &heights[row * count[0]..][columns.clone()];
        rows.flat_map(of_row)
            .fold(0.0, |most: f32, height| most.max(*height))
    }

    /// The box around the columns of a square; `None` where no material is left. Level 0 are the cells.
    fn bounds(&self, level: usize, at: [usize; 2]) -> Option<Bounds> {
        let (height, count) = match level.checked_sub(1) {
            None => (self.stock.heights(), self.stock.cells()[0]),
            Some(above) => (&self.levels[above].greatest[..], self.levels[above].squares[0]),
        };
        let height = height[at[1] * count + at[0]];
        (height > 0.0).then(|| {
            let cells = SIDE.pow(level as u32);
            let [x, y] = [0, 1].map(|k| at[k] * cells..((at[k] + 1) * cells).min(self.stock.cells()[k]));
            self.stock.column([x, y], height)
        })
    }

    /// The nearest points of a body and the remaining material, if they are nearer than `limit`, m. The search begins with
    /// the cell `likely`.
    pub fn nearest(
        &self,
        body: &BodyNearStock,
        limit: f64,
        likely: Option<[usize; 2]>,
    ) -> Option<NearestColumn> {
        let mut best: Option<NearestColumn> = None;
        let mut limit = limit;
        let mut take = |cell: [usize; 2], column: &Bounds, limit: &mut f64| {
            if let Some(nearest) = body.nearest(column, *limit) {
                *limit = nearest.distance;
                best = Some(NearestColumn { nearest, cell });
            }
        };
        if let Some(cell) = likely
            && let Some(column) = self.bounds(0, cell)
        {
            take(cell, &column, &mut limit);
        }
        let mut open = vec![Open {
            bound: f64::NEG_INFINITY,
            level: self.levels.len(),
            at: [0, 0],
        }];
        while let Some(square) = open.pop() {
            if square.bound >= limit - ROUNDING {
                continue;
            }
            let level = square.level - 1;
            let count = match level.checked_sub(1) {
                None => self.stock.cells(),
                Some(below) => self.levels[below].squares,
            };
            let first = open.len();
            let [columns, rows] =
                [0, 1].map(|k| square.at[k] * SIDE..((square.at[k] + 1) * SIDE).min(count[k]));
            for at in rows.flat_map(|y| columns.clone().map(move |x| [x, y])) {
                let Some(around) = self.bounds(level, at) else {
                    continue;
                };
                if level == 0 {
                    take(at, &around, &mut limit);
                } else if let Some(found) = body.nearest(&around, limit) {
                    open.push(Open {
                        bound: found.distance,
                        level,
                        at,
                    });
                }
            }
            // The nearest is opened first.
            open[first..].sort_by(|a, b| b.bound.total_cmp(&a.bound));
        }
        best
    }
}

#[cfg(test)]
mod tests;
