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
/// Where a distance is compared with a demanded one, squares up to this above it are opened, m: far above the rounding of
/// bounds, so that the distances of columns alone decide.
const SLACK: f64 = 1e-9;

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

    /// Distance of a point from the axis of the capsule around it, m.
    fn distance_of_axis(&self, point: &Point3<f64>) -> f64 {
        (self.hull.axis.nearest_to_point(point) - point).norm()
    }

    /// A lower bound of its distance from what is inside of a box, m; may be negative.
    fn bound_to(&self, around: &Bounds) -> f64 {
        self.hull.bound_to(around).max(self.bounds.distance(around))
    }

    /// Distance from what is inside of a box, m, if it is below `limit`.
    fn distance(&self, other: &Bounds, limit: f64) -> Option<f64> {
        if self.bound_to(other) >= limit {
            return None;
        }
        let other = Shape::Box(*other).placed(&IsometryMatrix3::identity());
        let found = self.placed.nearest(&other, limit)?;
        (found.distance < limit).then_some(found.distance)
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
    /// A lower bound of its distance, m; or what it is opened in the order of.
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

    /// The box around all that is left; `None` where nothing is.
    pub fn extent(&self) -> Option<Bounds> {
        self.bounds(self.levels.len(), [0, 0])
    }

    /// A cell whose column is nearer to a body than `least`, m, or touches it; `None` if there is none. The search begins
    /// with the cell `likely`, which changes which cell is found, but not whether there is one.
    pub fn conflict(
        &self,
        body: &BodyNearStock,
        least: f64,
        likely: Option<[usize; 2]>,
    ) -> Option<[usize; 2]> {
        let limit = least.max(0.0) + SLACK;
        let conflicts = |cell: [usize; 2]| {
            let column = self.bounds(0, cell)?;
            let distance = body.distance(&column, limit)?;
            (distance < least || distance == 0.0).then_some(cell)
        };
        if let Some(cell) = likely.and_then(conflicts) {
            return Some(cell);
        }
        let mut open = vec![Open {
            bound: 0.0,
            level: self.levels.len(),
            at: [0, 0],
        }];
        while let Some(Open { level, at, .. }) = open.pop() {
            let Some(below) = level.checked_sub(1) else {
                if let Some(cell) = conflicts(at) {
                    return Some(cell);
                }
                continue;
            };
            // The square itself is measured when it is the next one: its own bound is less than that.
            let is_near = |around: Bounds| body.distance(&around, limit).is_some();
            if !self.bounds(level, at).is_some_and(is_near) {
                continue;
            }
            let count = match below.checked_sub(1) {
                None => self.stock.cells(),
                Some(level) => self.levels[level].squares,
            };
            let first = open.len();
            let [columns, rows] = [0, 1].map(|k| at[k] * SIDE..((at[k] + 1) * SIDE).min(count[k]));
            for at in rows.flat_map(|y| columns.clone().map(move |x| [x, y])) {
                if let Some(around) = self.bounds(below, at)
                    && body.bound_to(&around) < limit
                {
                    let bound = body.distance_of_axis(&around.centre());
                    open.push(Open {
                        bound,
                        level: below,
                        at,
                    });
                }
            }
            open[first..].sort_by(|a, b| b.bound.total_cmp(&a.bound));
        }
        None
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
