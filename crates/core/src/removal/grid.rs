//! A grid of parallel dexels over a box, in tiles.

use std::ops::Range;

use nalgebra::Point3;
use rayon::prelude::*;

use super::dexel::{EndOrigin, TILE, Tile};
use super::swept::across;

/// Dexels along one axis of the part, one over the centre of each cell.
#[derive(Clone, Debug)]
pub struct DexelGrid {
    /// Direction of the dexels: 0, 1, 2 for x, y, z.
    pub(super) k: usize,
    /// Lower corner of the box.
    pub(super) low: Point3<f64>,
    /// Length of the box along the dexels, m.
    pub(super) length: f64,
    /// Cells along both directions across.
    pub(super) cells: [usize; 2],
    /// Sides of a cell, m.
    pub(super) sides: [f64; 2],
    /// Tiles along both directions.
    pub(super) tile_counts: [usize; 2],
    pub(super) tiles: Vec<Tile>,
}

/// Material along a dexel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialSpan {
    /// Coordinates of both ends in the frame of the part, m.
    pub ends: [f64; 2],
    /// What made them.
    pub origins: [EndOrigin; 2],
}

/// The box of a part and its cells along x, y and z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raster {
    pub(super) corners: [Point3<f64>; 2],
    pub(super) counts: [usize; 3],
}

impl DexelGrid {
    /// Without material.
    pub(super) fn new(raster: &Raster, k: usize) -> DexelGrid {
        let [low, high] = raster.corners;
        let cells = across(k).map(|axis| raster.counts[axis]);
        let sides = across(k).map(|axis| (high[axis] - low[axis]) / raster.counts[axis] as f64);
        let tile_counts = cells.map(|count| count.div_ceil(TILE));
        let tiles = (0..tile_counts[0] * tile_counts[1])
            .into_par_iter()
            .map(|tile| {
                let first = [tile % tile_counts[0] * TILE, tile / tile_counts[0] * TILE];
                let size = [0, 1].map(|n| (cells[n] - first[n]).min(TILE));
                Tile::new(first, size)
            })
            .collect();
        DexelGrid {
            k,
            low,
            length: high[k] - low[k],
            cells,
            sides,
            tile_counts,
            tiles,
        }
    }

    /// Direction of the dexels: 0, 1, 2 for x, y, z.
    pub fn direction(&self) -> usize {
        self.k
    }

    /// Cells along the two other directions, in the order of x, y, z.
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Coordinates of the dexel of a cell along the two other directions, m.
    pub fn at(&self, cell: [usize; 2]) -> [f64; 2] {
        let axes = across(self.k);
        [0, 1].map(|n| self.low[axes[n]] + (cell[n] as f64 + 0.5) * self.sides[n])
    }

    /// The cells along direction 0 or 1 across the dexels whose dexels are between two coordinates, m.
    pub fn cells_within(&self, n: usize, [from, to]: [f64; 2]) -> Range<usize> {
        let (low, count) = (self.low[across(self.k)[n]], self.cells[n] as f64);
        let place = |coordinate: f64| (coordinate - low) / self.sides[n] - 0.5;
        let first = place(from).ceil().clamp(0.0, count);
        let end = (place(to).floor() + 1.0).clamp(first, count);
        first as usize..end as usize
    }

    /// The cell whose dexel is nearest to a point; `None` beyond the box.
    pub fn cell_at(&self, point: &Point3<f64>) -> Option<[usize; 2]> {
        let axes = across(self.k);
        let place = |n: usize| {
            let place = (point[axes[n]] - self.low[axes[n]]) / self.sides[n];
            (place >= 0.0 && place < self.cells[n] as f64).then_some(place as usize)
        };
        Some([place(0)?, place(1)?])
    }

    /// Area of a cell, m^2.
    pub fn cell_area(&self) -> f64 {
        self.sides[0] * self.sides[1]
    }

    /// The point of the dexel of a cell at this coordinate along it, m.
    pub fn position(&self, cell: [usize; 2], along: f64) -> Point3<f64> {
        let ([first, second], [i, j]) = (self.at(cell), across(self.k));
        let mut position = Point3::origin();
        (position[i], position[j], position[self.k]) = (first, second, along);
        position
    }

    /// Material of the dexel of a cell, from low to high; none outside of the grid.
    pub fn material(&self, cell: [usize; 2]) -> impl Iterator<Item = MaterialSpan> {
        let inside = cell[0] < self.cells[0] && cell[1] < self.cells[1];
        let tile = self.tiles.get(self.tile_of(cell)).filter(|_| inside);
        let low = self.low[self.k];
        tile.into_iter().flat_map(move |tile| {
            let dexel = tile.number([cell[0] - tile.first[0], cell[1] - tile.first[1]]);
            tile.material(dexel).map(move |span| MaterialSpan {
                ends: [span.low, span.high].map(|end| low + f64::from(end)),
                origins: [span.low_origin, span.high_origin].map(EndOrigin::of_code),
            })
        })
    }

    /// Number of the tile with this cell.
    pub(super) fn tile_of(&self, cell: [usize; 2]) -> usize {
        cell[1] / TILE * self.tile_counts[0] + cell[0] / TILE
    }

    /// Length of all material times the area of a cell, m^3.
    pub fn volume(&self) -> f64 {
        let whole = [0.0, self.length as f32 * 2.0];
        let lengths = self.tiles.par_iter().map(|tile| {
            let dexels = 0..tile.size[0] * tile.size[1];
            dexels.map(|dexel| tile.length_within(dexel, whole)).sum::<f64>()
        });
        let lengths: Vec<f64> = lengths.collect();
        lengths.iter().sum::<f64>() * self.sides[0] * self.sides[1]
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> usize {
        self.tiles.iter().map(Tile::bytes).sum()
    }
}
