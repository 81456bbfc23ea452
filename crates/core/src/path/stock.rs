//! The stock as a height map: the material that is left of a box after the tool has passed.
//!
//! Every cell of a grid across the path's z stores the height of the material at its centre. A step of the tool lowers
//! each cell to the lowest point of the body that passes over it:
//!
//! ```text
//! H <- min(H, bottom of the step)
//! V = sum (H before - H after) dx dy
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `H` | height of the material in a cell, relative to the bottom of the box | m |
//! | `V` | removed volume | m^3 |
//! | `dx`, `dy` | sides of a cell: the pitch, or a little less so that whole cells fill the box | m |
//!
//! The bottom of a step is exact (`sweep`). Errors of the grid: half a pitch for an edge; for a volume at most the area
//! of the side walls times half a pitch, mostly far less. Heights are stored in single precision, to 6e-8 relative:
//! 0.06 um in a metre.
//!
//! Only cells in reach of a step are visited, row after row: 1300 under a cutter of 10 mm in cells of 0.25 mm. Flat
//! cutters are the fastest; a ball and a bull nose take some three times as long, mostly to look ahead
//! ([`engagement`](super::engagement)).
//!
//! Not modelled: undercuts (one height per cell), tilted tools, the arc between two points (a step is its chord), shank
//! and holder (their distance from the stock: [`remaining`](super::remaining)), wear and deflection of the cutter.
//!
//! Source: height maps of stock go back to Van Hook, Real-time shaded NC milling display, Computer Graphics 20(4),
//! 1986, and to the z-map of Anderson, Detecting and eliminating collisions in NC machining, Computer-Aided Design
//! 10(4), 1978 \[recalled\].

use std::ops::Range;

use nalgebra::{Point2, Point3};

use super::sweep::{Row, Sweep};
use crate::clearance::Bounds;
use crate::load::EndMillBody;

/// A box of material from which a tool cuts, in the frame of the path.
#[derive(Clone, Debug)]
pub struct Stock {
    low: Point3<f64>,
    high: Point3<f64>,
    /// Cells along x and y.
    cells: [usize; 2],
    /// Sides of a cell, m.
    sides: [f64; 2],
    /// Heights above the bottom, m; x runs fastest.
    heights: Vec<f32>,
}

/// Material removed by a step.
pub(super) struct Removal {
    /// m^3
    pub(super) volume: f64,
    /// Largest height removed in a cell, m.
    pub(super) depth: f64,
}

/// Why no stock can be created, or no engagement found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StockError {
    /// A number that is not finite.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// A length beyond any workpiece.
    #[error("{what} is at {value:e} m: coordinates must be within {most:.0e} m of zero")]
    TooFar {
        /// The item.
        what: &'static str,
        /// m
        value: f64,
        /// m
        most: f64,
    },
    /// Corners of the box in the wrong order, or no distance between them.
    #[error("the stock reaches from {low} to {high} m along {axis}: the second must be greater")]
    Box {
        /// Axis of the path.
        axis: char,
        /// First corner, m.
        low: f64,
        /// Second corner, m.
        high: f64,
    },
    /// A pitch that is too fine.
    #[error("the pitch of the stock is {pitch} m: it must be at least {least:e} m")]
    Pitch {
        /// m
        pitch: f64,
        /// m
        least: f64,
    },
    /// Too many cells.
    #[error("the stock has {cells:.3e} cells: the maximum is {most:.0e}; use a coarser pitch")]
    TooManyCells {
        /// Requested number.
        cells: f64,
        /// Maximum.
        most: f64,
    },
    /// The tool is tilted: not supported by a height map.
    #[error(
        "the tool is tilted by {angle_deg:.2} deg from the z axis of the path: a stock supports only upright tools"
    )]
    Tilted {
        /// Angle.
        angle_deg: f64,
    },
}

/// Maximum number of cells of a stock: 400 MB of heights.
const MOST_CELLS: f64 = 1e8;

/// Largest coordinate, m: a thousand kilometres, where a double is still accurate to 0.1 nm.
const FARTHEST: f64 = 1e6;

/// Finest pitch and thinnest box, m: a tenth of a micrometre, far below what is milled.
const LEAST_PITCH: f64 = 1e-7;

/// Steps with a horizontal length below this fraction of a pitch go straight down or up.
const VERTICAL: f64 = 1e-3;

impl Stock {
    /// The box between two corners (m, frame of the path), in cells of at most `pitch` (m).
    ///
    /// # Errors
    /// Numbers that are not finite or beyond any workpiece, corners in the wrong order, a pitch that is not above zero,
    /// too many cells.
    pub fn new([low, high]: [Point3<f64>; 2], pitch: f64) -> Result<Stock, StockError> {
        checked_place("a corner of the stock", &low)?;
        checked_place("a corner of the stock", &high)?;
        if !pitch.is_finite() {
            return Err(StockError::NotFinite("the pitch of the stock"));
        }
        if pitch < LEAST_PITCH {
            let least = LEAST_PITCH;
            return Err(StockError::Pitch { pitch, least });
        }
        let size = high - low;
        for (k, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
            if size[k] < LEAST_PITCH {
                let (low, high) = (low[k], high[k]);
                return Err(StockError::Box { axis, low, high });
            }
        }
        // A small tolerance, so that 10 mm in cells of 0.1 mm are 100 and not 101.
        let along = |k: usize| (size[k] / pitch - 1e-9).ceil().max(1.0);
        let cells = along(0) * along(1);
        if cells > MOST_CELLS {
            let most = MOST_CELLS;
            return Err(StockError::TooManyCells { cells, most });
        }
        let (columns, rows) = (along(0) as usize, along(1) as usize);
        Ok(Stock {
            low,
            high,
            cells: [columns, rows],
            sides: [size.x / columns as f64, size.y / rows as f64],
            heights: vec![size.z as f32; columns * rows],
        })
    }

    /// Remaining volume, m^3.
    pub fn volume(&self) -> f64 {
        let heights: f64 = self.heights.iter().map(|&height| f64::from(height)).sum();
        heights * self.sides[0] * self.sides[1]
    }

    /// Two corners of the box, the lower one first; m.
    pub fn corners(&self) -> [Point3<f64>; 2] {
        [self.low, self.high]
    }

    /// The longer side of a cell, m: not above the requested pitch.
    pub fn pitch(&self) -> f64 {
        self.sides[0].max(self.sides[1])
    }

    /// Number of cells along x and along y.
    pub(super) fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Heights of the cells above the bottom of the box, m; x runs fastest.
    pub(super) fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The box over these cells along x and y, from the bottom of the stock to this height above it, m.
    pub(super) fn column(&self, cells: [Range<usize>; 2], height: f32) -> Bounds {
        let corner = |cell: [usize; 2], height: f64| {
            let [x, y] = [0, 1].map(|k| self.low[k] + cell[k] as f64 * self.sides[k]);
            Point3::new(x, y, self.low.z + height)
        };
        let [x, y] = cells;
        Bounds {
            least: corner([x.start, y.start], 0.0),
            greatest: corner([x.end, y.end], f64::from(height)),
        }
    }

    /// Path z of the bottom of the box, m.
    pub(super) fn bottom(&self) -> f64 {
        self.low.z
    }

    /// The centre of the cell over `at`, and the height in it, m; `None` outside the box.
    pub(super) fn cell_at(&self, at: Point2<f64>) -> Option<(Point2<f64>, f32)> {
        let x = (at.x - self.low.x) / self.sides[0];
        let y = (at.y - self.low.y) / self.sides[1];
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        // At most 1e8 cells: 32 bits are enough for their numbers, and convert to a double faster than 64.
        let (column, row) = (x as u32, y as u32);
        let [columns, rows] = self.cells;
        if column as usize >= columns || row as usize >= rows {
            return None;
        }
        let centre = Point2::new(
            self.low.x + (f64::from(column) + 0.5) * self.sides[0],
            self.low.y + (f64::from(row) + 0.5) * self.sides[1],
        );
        Some((centre, self.heights[row as usize * columns + column as usize]))
    }

    /// Path z of the highest material in the square about `at` that reaches `out` (m) to each side.
    pub(super) fn highest_about(&self, at: Point2<f64>, out: f64) -> f64 {
        let columns = self.cells_between(0, at.x - out, at.x + out);
        let mut highest = 0.0_f32;
        for row in self.cells_between(1, at.y - out, at.y + out) {
            let first = row * self.cells[0];
            for &height in &self.heights[first + columns.start..first + columns.end] {
                highest = if height > highest { height } else { highest };
            }
        }
        self.low.z + f64::from(highest)
    }

    /// The cells along axis `k` whose centres may lie between `from` and `to` (m): all of them, clipped to the box.
    pub(super) fn cells_between(&self, k: usize, from: f64, to: f64) -> Range<usize> {
        let count = self.cells[k] as f64;
        let first = ((from - self.low[k]) / self.sides[k] - 0.5)
            .floor()
            .clamp(0.0, count);
        let end = ((to - self.low[k]) / self.sides[k] + 0.5)
            .ceil()
            .clamp(first, count);
        first as usize..end as usize
    }

    /// Lowers every cell that the cutter passes over on a straight step.
    pub(super) fn remove(&mut self, from: Point3<f64>, to: Point3<f64>, cutter: &EndMillBody) -> Removal {
        let sweep = Sweep::of(from, to, cutter, VERTICAL * self.pitch());
        let (mut volume, mut depth) = (0.0, 0.0_f32);
        let mut bottoms = Vec::new();
        let [lower, upper] = sweep.reach_along_y();
        for row in self.cells_between(1, lower, upper) {
            let y = self.low.y + (row as f64 + 0.5) * self.sides[1];
            let [left, right] = sweep.reach_along_x(y);
            let columns = self.cells_between(0, left, right);
            let x = self.low.x + (columns.start as f64 + 0.5) * self.sides[0];
            bottoms.resize(columns.len(), f32::INFINITY);
            sweep.pass(Row {
                first: Point3::new(x, y, self.low.z),
                side: self.sides[0],
                bottoms: &mut bottoms,
            });
            let first = row * self.cells[0];
            let cells = &mut self.heights[first + columns.start..first + columns.end];
            for (height, &bottom) in cells.iter_mut().zip(&bottoms) {
                if bottom < *height {
                    let taken = *height - bottom;
                    volume += f64::from(taken);
                    depth = depth.max(taken);
                    *height = bottom;
                }
            }
        }
        Removal {
            volume: volume * self.sides[0] * self.sides[1],
            depth: f64::from(depth),
        }
    }
}

/// Checks that a coordinate is within the limit.
pub(super) fn checked_place(what: &'static str, at: &Point3<f64>) -> Result<(), StockError> {
    for &value in at.iter() {
        if !value.is_finite() {
            return Err(StockError::NotFinite(what));
        }
        if value.abs() > FARTHEST {
            let most = FARTHEST;
            return Err(StockError::TooFar { what, value, most });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
