//! The lattice on which dexels cross, and which of its points are in material.
//!
//! The lines of dexels along x, y and z meet at the centres of cells. With a stride `n` only every n-th of them is used. An outer layer is added around: it is on
//! the faces of the box and always empty, so that a surface through the lattice is closed.
//!
//! A point is in material if the dexel along z says so: `low <= z < high` of one of its spans. An edge between two neighbours of which one is in material is crossed
//! by the surface. Material or gaps between two neighbours are not seen.
//!
//! Points of a layer (one `y`) are bits, those of one column (one `x`) one after the other.

use rayon::prelude::*;

use super::error::RemovalError;
use super::part::DexelPart;

/// Every n-th crossing of the dexels of a part, and an outer layer.
pub(super) struct Lattice<'a> {
    pub(super) part: &'a DexelPart,
    /// Cells of the points along x, y and z, without the outer ones.
    picked: [Vec<usize>; 3],
    /// Coordinates along x, y and z with the outer ones, m.
    pub(super) places: [Vec<f64>; 3],
}

/// Which points of a layer are in material.
pub(super) struct Layer {
    /// Words of a column.
    words: usize,
    bits: Vec<u64>,
}

/// Most points of a layer, as many as a part has dexels: it limits the memory.
const MOST_POINTS: f64 = 2e8;
/// Triangles of the two halves of each crossed edge.
const TRIANGLES_OF_EDGE: usize = 2;

impl Lattice<'_> {
    /// Every `stride`-th crossing, centred.
    pub(super) fn new(part: &DexelPart, stride: usize) -> Result<Lattice<'_>, RemovalError> {
        if stride == 0 {
            return Err(RemovalError::NoStride);
        }
        // From the first point, so that as much is left before it as behind the last one.
        let first = part.counts.map(|count| (count - 1) % stride / 2);
        let points = |k: usize| ((part.counts[k] - 1) / stride + 3) as f64;
        let (points, most) = (points(0) * points(2), MOST_POINTS);
        if points > most {
            return Err(RemovalError::LatticeTooLarge { points, most });
        }
        let [low, high] = part.corners();
        let picked = [0, 1, 2].map(|k| (first[k]..part.counts[k]).step_by(stride).collect::<Vec<usize>>());
        let places = [0, 1, 2].map(|k| {
            let side = (high[k] - low[k]) / part.counts[k] as f64;
            let centres = picked[k].iter().map(|cell| low[k] + (*cell as f64 + 0.5) * side);
            std::iter::once(low[k])
                .chain(centres)
                .chain(std::iter::once(high[k]))
                .collect()
        });
        Ok(Lattice { part, picked, places })
    }

    /// Cells of the lattice along x, y and z: one less than its points.
    pub(super) fn cells(&self) -> [usize; 3] {
        [0, 1, 2].map(|k| self.places[k].len() - 1)
    }

    /// The cell of the part at a point along `k`; `None` of the outer ones.
    pub(super) fn cell(&self, k: usize, point: usize) -> Option<usize> {
        self.picked[k].get(point.checked_sub(1)?).copied()
    }

    /// The points of a layer.
    pub(super) fn layer(&self, row: usize) -> Layer {
        let words = self.places[2].len().div_ceil(64);
        let mut bits = vec![0; words * self.places[0].len()];
        for (column, bits) in bits.chunks_exact_mut(words).enumerate() {
            self.fill(column, row, bits);
        }
        Layer { words, bits }
    }

    /// Sets the bits of a column.
    fn fill(&self, column: usize, row: usize, bits: &mut [u64]) {
        let (Some(x), Some(y)) = (self.cell(0, column), self.cell(1, row)) else {
            return;
        };
        let inner = &self.places[2][1..self.places[2].len() - 1];
        let grid = self.part.grids().last();
        for span in grid.into_iter().flat_map(|grid| grid.material([x, y])) {
            let [first, end] = span.ends.map(|end| inner.partition_point(|place| *place < end));
            for point in first + 1..end + 1 {
                bits[point / 64] |= 1 << (point % 64);
            }
        }
    }

    /// Whether a point is in material. Slow: for single points.
    pub(super) fn is_inside(&self, point: [usize; 3]) -> bool {
        let mut bits = vec![0; self.places[2].len().div_ceil(64)];
        self.fill(point[0], point[1], &mut bits);
        bits.get(point[2] / 64)
            .is_some_and(|word| word >> (point[2] % 64) & 1 == 1)
    }

    /// Triangles of the mesh through this lattice.
    pub(super) fn triangles(&self) -> usize {
        let [columns, rows, _] = self.cells();
        let edges = (0..rows).into_par_iter().map(|row| {
            let [layer, next] = [row, row + 1].map(|row| self.layer(row));
            let count = |words: &mut dyn Iterator<Item = u64>| words.map(|w| w.count_ones() as usize).sum();
            let of_column = |column| -> usize {
                let along: usize = count(&mut layer.changes_along(column));
                let to_next: usize = count(&mut layer.changes(column, &layer, column + 1));
                let to_layer: usize = count(&mut layer.changes(column, &next, column));
                along + to_next + to_layer
            };
            (0..columns).map(of_column).sum::<usize>()
        });
        edges.sum::<usize>() * TRIANGLES_OF_EDGE
    }
}

impl Layer {
    fn column(&self, column: usize) -> &[u64] {
        &self.bits[column * self.words..][..self.words]
    }

    /// Whether a point is in material.
    pub(super) fn is_inside(&self, column: usize, point: usize) -> bool {
        self.column(column)[point / 64] >> (point % 64) & 1 == 1
    }

    /// Words of bits: where a column differs from a column of another layer or of the same.
    pub(super) fn changes<'a>(
        &'a self,
        column: usize,
        other: &'a Layer,
        other_column: usize,
    ) -> impl Iterator<Item = u64> + 'a {
        let others = other.column(other_column);
        self.column(column).iter().zip(others).map(|(a, b)| a ^ b)
    }

    /// Words of bits: where a point of a column differs from the next one.
    pub(super) fn changes_along(&self, column: usize) -> impl Iterator<Item = u64> {
        let words = self.column(column);
        (0..words.len()).map(|n| {
            let next = words.get(n + 1).copied().unwrap_or(0);
            words[n] ^ (words[n] >> 1 | next << 63)
        })
    }
}

/// The numbers of the bits that are set.
pub(super) fn set_bits(words: impl Iterator<Item = u64>) -> impl Iterator<Item = usize> {
    words.enumerate().flat_map(|(n, word)| {
        let rest = |word: &u64| Some(word & (word - 1)).filter(|rest| *rest != 0);
        std::iter::successors((word != 0).then_some(word), rest)
            .map(move |word| n * 64 + word.trailing_zeros() as usize)
    })
}
