//! Solids of stock, and their parts along dexels.

use nalgebra::{Point3, Unit, Vector3};
use rayon::prelude::*;

use super::dexel::{STOCK, Span};
use super::error::RemovalError;
use super::grid::DexelGrid;
use super::mesh_crossings::{crossings, spans_of};
use super::swept::across;
use crate::clearance::Triangle;

/// What the part is cut from; frame of the part, m.
#[derive(Clone, Copy, Debug)]
pub enum StockSolid<'a> {
    /// The box between two corners, the lower one first. Its faces: 0 and 1 across x, at low and at high, then across y and z.
    Box([Point3<f64>; 2]),
    /// A cylinder about an axis along z. Its faces: 0 around, 1 below, 2 above.
    Cylinder {
        /// Centre of its lower face.
        base: Point3<f64>,
        /// m
        radius: f64,
        /// m
        height: f64,
    },
    /// The solid that triangles enclose. Its faces are the triangles.
    Mesh(&'a [Triangle]),
}

impl StockSolid<'_> {
    /// The box around it.
    pub fn corners(&self) -> Result<[Point3<f64>; 2], RemovalError> {
        match *self {
            StockSolid::Box(corners) => Ok(corners),
            StockSolid::Cylinder { base, radius, height } => {
                let out = Vector3::new(radius, radius, 0.0);
                Ok([base - out, base + out + Vector3::z() * height])
            }
            StockSolid::Mesh(triangles) => {
                let mut corners = triangles.iter().flat_map(|triangle| triangle.0);
                let first = corners.next().ok_or(RemovalError::NoTriangles)?;
                let start = [first, first];
                Ok(corners.fold(start, |[low, high], corner| [low.inf(&corner), high.sup(&corner)]))
            }
        }
    }

    /// Fills a grid over the box around it.
    pub(super) fn fill(&self, grid: &mut DexelGrid) -> Result<(), RemovalError> {
        if let StockSolid::Mesh(triangles) = self {
            return fill_from_mesh(grid, triangles);
        }
        let (k, low, sides) = (grid.k, grid.low, grid.sides);
        let axes = across(k);
        grid.tiles.par_iter_mut().for_each(|tile| {
            for j in 0..tile.size[1] {
                for i in 0..tile.size[0] {
                    let cell = [tile.first[0] + i, tile.first[1] + j];
                    let at = [0, 1].map(|n| low[axes[n]] + (cell[n] as f64 + 0.5) * sides[n]);
                    if let Some((ends, faces)) = self.along(k, at) {
                        let [first, last] = ends.map(|end| (end - low[k]) as f32);
                        let span = Span {
                            low: first,
                            high: last,
                            low_origin: STOCK + faces[0],
                            high_origin: STOCK + faces[1],
                        };
                        let dexel = tile.number([i, j]);
                        if first < last {
                            tile.fill(dexel, &[span]);
                        }
                    }
                }
            }
        });
        Ok(())
    }

    /// The part along a dexel, and the faces at its ends; not of a mesh.
    fn along(&self, k: usize, at: [f64; 2]) -> Option<([f64; 2], [u32; 2])> {
        match *self {
            StockSolid::Box([low, high]) => {
                let face = 2 * k as u32;
                Some(([low[k], high[k]], [face, face + 1]))
            }
            StockSolid::Cylinder { base, radius, height } => {
                let off = |axis: usize, at: f64| at - base[axis];
                if k == 2 {
                    let distance = off(0, at[0]).hypot(off(1, at[1]));
                    return (distance <= radius).then_some(([base.z, base.z + height], [1, 2]));
                }
                let y = off(1 - k, at[0]);
                let half = ((radius - y) * (radius + y)).max(0.0).sqrt();
                Some(([base[k] - half, base[k] + half], [0, 0]))
            }
            StockSolid::Mesh(_) => None,
        }
    }

    /// Outward normal of a face at a point of it; `None` of a face that it has not, and of a triangle without area.
    pub fn normal(&self, face: u32, at: &Point3<f64>) -> Option<Unit<Vector3<f64>>> {
        let normal = match self {
            StockSolid::Box(_) if face < 6 => {
                let sign = if face.is_multiple_of(2) { -1.0 } else { 1.0 };
                Vector3::ith((face / 2) as usize, sign)
            }
            StockSolid::Cylinder { base, .. } => match face {
                0 => Vector3::new(at.x - base.x, at.y - base.y, 0.0),
                1 => -Vector3::z(),
                2 => Vector3::z(),
                _ => return None,
            },
            StockSolid::Mesh(triangles) => triangles.get(face as usize)?.area_vector(),
            StockSolid::Box(_) => return None,
        };
        Unit::try_new(normal, 0.0)
    }
}

/// Fills a grid with the solid that triangles enclose.
fn fill_from_mesh(grid: &mut DexelGrid, triangles: &[Triangle]) -> Result<(), RemovalError> {
    let crossings = crossings(grid, triangles);
    let mut open = None;
    let mut lines = 0;
    for of_dexel in crossings.chunk_by(|one, next| one.cell == next.cell) {
        let Some(first) = of_dexel.first() else {
            continue;
        };
        let cell = [first.cell % grid.cells[0], first.cell / grid.cells[0]];
        if of_dexel.len() % 2 == 1 {
            lines += 1;
            open.get_or_insert(cell);
            continue;
        }
        let tile = grid.tile_of(cell);
        let tile = &mut grid.tiles[tile];
        let dexel = tile.number([cell[0] - tile.first[0], cell[1] - tile.first[1]]);
        tile.fill(dexel, &spans_of(of_dexel));
    }
    match open {
        None => Ok(()),
        Some(cell) => Err(RemovalError::OpenMesh {
            lines,
            axis: ['x', 'y', 'z'][grid.k],
            at: grid.at(cell),
        }),
    }
}
