//! The distance of a point from the surface of a part.
//!
//! All ends of dexels within a distance are compared: of a smooth surface the nearest end is no farther from its foot than half the diagonal of a cell.

use nalgebra::Point3;

use crate::removal::{DexelGrid, DexelPart, SurfacePoint};

/// An end of material near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NearEnd {
    pub(super) point: SurfacePoint,
    /// From that point, m.
    pub(super) distance: f64,
}

/// The end nearest to `point` that is less than `within` (m) from it; of equal ones the first.
pub(super) fn nearest_end(part: &DexelPart, point: &Point3<f64>, within: f64) -> Option<NearEnd> {
    let mut nearest: Option<NearEnd> = None;
    for grid in part.grids() {
        let limit = nearest.map_or(within, |found| found.distance);
        each_end(grid, point, limit, |end| {
            if end.distance < nearest.map_or(within, |found| found.distance) {
                nearest = Some(end);
            }
        });
    }
    nearest
}

/// All ends that are at most `within` (m) from `point`.
pub(super) fn ends_within(part: &DexelPart, point: &Point3<f64>, within: f64) -> Vec<NearEnd> {
    let mut all = Vec::new();
    for grid in part.grids() {
        each_end(grid, point, within, |end| all.push(end));
    }
    all
}

fn each_end(grid: &DexelGrid, point: &Point3<f64>, within: f64, mut out: impl FnMut(NearEnd)) {
    let k = grid.direction();
    let across = [0, 1, 2].into_iter().filter(|axis| *axis != k);
    let at: Vec<f64> = across.map(|axis| point[axis]).collect();
    let [columns, rows] = [0, 1].map(|n| grid.cells_within(n, [at[n] - within, at[n] + within]));
    for row in rows {
        for column in columns.clone() {
            for near in grid.surface_at([column, row]) {
                let distance = (near.position - point).norm();
                if distance <= within {
                    out(NearEnd {
                        point: near,
                        distance,
                    });
                }
            }
        }
    }
}
