//! The dexels of a tile that a moving tool can reach.
//!
//! The tool is in a box that moves with its tip. A row of dexels is in that box from one time to another; only there are dexels visited, with the range along
//! them in which the tool can be.

use nalgebra::{Point3, Unit, Vector3};

use super::dexel::Tile;
use super::grid::DexelGrid;
use super::swept::across;
use super::tool_solid::ToolSolid;

/// The box around a tool that moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBox {
    ends: [Point3<f64>; 2],
    /// Along x, y and z, relative to the tip, m.
    extents: [[f64; 2]; 3],
}

/// A dexel that the tool can reach.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    /// Its number in the tile.
    pub(super) dexel: usize,
    /// Its coordinates across, m.
    pub(super) at: [f64; 2],
    /// Where the tool can be along the dexel, relative to the box of the part, m.
    pub(super) range: [f32; 2],
}

/// Added to ranges along dexels, m, and per metre of them: more than the rounding of single precision.
const MARGIN: [f32; 2] = [1e-9, 3e-7];

impl MovingBox {
    pub(super) fn new(tool: &ToolSolid, ends: [Point3<f64>; 2], axis: &Unit<Vector3<f64>>) -> MovingBox {
        MovingBox {
            ends,
            extents: [0, 1, 2].map(|k| tool.extent(axis, &Vector3::ith(k, 1.0))),
        }
    }

    /// The least and the greatest coordinate along an axis between two times, m.
    fn range(&self, axis: usize, [first, last]: [f64; 2]) -> [f64; 2] {
        let (from, travel) = (self.ends[0][axis], self.ends[1][axis] - self.ends[0][axis]);
        let (one, other) = (from + first * travel, from + last * travel);
        let [low, high] = self.extents[axis];
        [one.min(other) + low, one.max(other) + high]
    }

    /// From when to when the box is at a coordinate along an axis.
    fn times(&self, axis: usize, at: f64) -> Option<[f64; 2]> {
        let (from, travel) = (self.ends[0][axis], self.ends[1][axis] - self.ends[0][axis]);
        let [low, high] = self.extents[axis];
        let (least, most) = (at - from - high, at - from - low);
        if travel.abs() < f64::MIN_POSITIVE {
            return (least <= 0.0 && most >= 0.0).then_some([0.0, 1.0]);
        }
        let (one, other) = (least / travel, most / travel);
        let times = [one.min(other).max(0.0), one.max(other).min(1.0)];
        (times[0] <= times[1]).then_some(times)
    }

    /// The first and the last tile of a grid along both directions that it can reach; `None` if there is none.
    pub(super) fn tiles(&self, grid: &DexelGrid) -> Option<[[usize; 2]; 2]> {
        let [low, high] = self.range(grid.k, [0.0, 1.0]);
        if high < grid.low[grid.k] || low > grid.low[grid.k] + grid.length {
            return None;
        }
        let [i, j] = across(grid.k);
        let along = |n: usize, axis: usize| {
            let cells = cells_between(grid, n, self.range(axis, [0.0, 1.0]), [0, grid.cells[n]])?;
            Some([cells[0], cells[1] - 1].map(|cell| cell / super::dexel::TILE))
        };
        Some([along(0, i)?, along(1, j)?])
    }

    /// Calls `out` for each dexel of the tile that it can reach.
    pub(super) fn visit(&self, grid: &DexelGrid, tile: &mut Tile, mut out: impl FnMut(&mut Tile, Reached)) {
        let [i, j] = across(grid.k);
        let (low, [first, size]) = (grid.low[grid.k], [tile.first, tile.size]);
        let rows = [first[1], first[1] + size[1]];
        let Some(rows) = cells_between(grid, 1, self.range(j, [0.0, 1.0]), rows) else {
            return;
        };
        for row in rows[0]..rows[1] {
            let y = grid.low[j] + (row as f64 + 0.5) * grid.sides[1];
            let Some(times) = self.times(j, y) else {
                continue;
            };
            let columns = [first[0], first[0] + size[0]];
            let Some(columns) = cells_between(grid, 0, self.range(i, times), columns) else {
                continue;
            };
            let [least, most] = self.range(grid.k, times).map(|end| (end - low) as f32);
            let margin = |end: f32| MARGIN[0] + MARGIN[1] * end.abs();
            let range = [least - margin(least), most + margin(most)];
            let number = (row - first[1]) * size[0];
            for column in columns[0]..columns[1] {
                let x = grid.low[i] + (column as f64 + 0.5) * grid.sides[0];
                let reached = Reached {
                    dexel: number + column - first[0],
                    at: [x, y],
                    range,
                };
                out(tile, reached);
            }
        }
    }
}

/// The cells along one direction of a grid whose centres are between two coordinates, of those from a first to an end; `None`
/// if there is none.
fn cells_between(
    grid: &DexelGrid,
    n: usize,
    [low, high]: [f64; 2],
    [first, end]: [usize; 2],
) -> Option<[usize; 2]> {
    let (origin, side) = (grid.low[across(grid.k)[n]], grid.sides[n]);
    let cell = |at: f64| (at - origin) / side - 0.5;
    let clamped = |cell: f64| cell.clamp(first as f64, end as f64) as usize;
    let cells = [clamped(cell(low).ceil()), clamped(cell(high).floor() + 1.0)];
    (cells[0] < cells[1]).then_some(cells)
}
