//! Points of space in the cells of a grid: what is within a distance of a place.
//!
//! Cells are cubes with an edge of that distance, so that 27 of them are looked at. They are sorted, not hashed: the order of
//! visits, and with it every sum, is always the same.

use nalgebra::Point3;

/// A cell by its place in the grid.
type Cell = [i64; 3];

/// Points sorted by cells.
#[derive(Clone, Debug)]
pub(super) struct Neighbours<'a> {
    points: &'a [Point3<f64>],
    /// Edge of a cell, m.
    edge: f64,
    /// Cell and point, sorted.
    cells: Vec<(Cell, u32)>,
}

impl<'a> Neighbours<'a> {
    /// These points in cells with this edge, m.
    ///
    /// Not checked: that coordinates over the edge are below 2^62.
    pub fn new(points: &'a [Point3<f64>], edge: f64) -> Neighbours<'a> {
        let mut cells: Vec<(Cell, u32)> = points
            .iter()
            .enumerate()
            .map(|(k, p)| (cell(p, edge), k as u32))
            .collect();
        cells.sort_unstable();
        Neighbours { points, edge, cells }
    }

    /// Calls `visit` for each point within an edge of `place`, with its squared distance.
    pub fn visit(&self, place: &Point3<f64>, mut visit: impl FnMut(usize, f64)) {
        let [x, y, z] = cell(place, self.edge);
        for dx in -1..=1 {
            for dy in -1..=1 {
                // Along z three cells follow each other.
                let first = [x + dx, y + dy, z - 1];
                let last = [x + dx, y + dy, z + 1];
                let from = self.cells.partition_point(|entry| entry.0 < first);
                for entry in self.cells[from..].iter().take_while(|entry| entry.0 <= last) {
                    let square = (self.points[entry.1 as usize] - place).norm_squared();
                    if square <= self.edge * self.edge {
                        visit(entry.1 as usize, square);
                    }
                }
            }
        }
    }

    /// The points of each cell.
    pub fn groups(&self) -> impl Iterator<Item = &[(Cell, u32)]> {
        self.cells.chunk_by(|one, other| one.0 == other.0)
    }
}

fn cell(point: &Point3<f64>, edge: f64) -> Cell {
    [0, 1, 2].map(|axis| (point[axis] / edge).floor() as i64)
}
