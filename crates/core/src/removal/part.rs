//! A part in dexels: its size, the stock that it is made from, and its grids.
//!
//! Three grids along x, y and z share the box and its cells (tri-dexel): every piece of surface is met by the dexels of one
//! direction at no more than 54.7 deg from its normal. A part with z dexels alone is the height map of three axes, with undercuts.

use nalgebra::Point3;

use super::dexel::Span;
use super::error::RemovalError;
use super::grid::{DexelGrid, Raster};
use super::stock_solid::StockSolid;

/// Directions of the dexels of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DexelDirections {
    /// Along z only.
    Z,
    /// Along x, y and z.
    All,
}

/// A part, as the material along dexels.
#[derive(Clone, Debug)]
pub struct DexelPart {
    corners: [Point3<f64>; 2],
    /// Cells along x, y and z.
    pub(super) counts: [usize; 3],
    pub(super) grids: Vec<DexelGrid>,
}

/// Number of dexels of a part, and their memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartSize {
    /// Cells along x, y and z.
    pub cells: [f64; 3],
    /// Dexels of all directions.
    pub dexels: f64,
    /// Memory while no dexel has a gap, bytes: 16 for each dexel. A gap adds 20 bytes, and 4 for each dexel of its tile.
    pub bytes: f64,
}

/// Smallest cell, m: a micrometre.
const LEAST_CELL: f64 = 1e-6;
/// Largest coordinate and largest cell, m.
const FARTHEST: f64 = 1e3;
/// Most dexels of a part: 3.2 GB.
const MOST_DEXELS: f64 = 2e8;
/// What has to be in range along x, y and z.
const LENGTHS: [&str; 3] = [
    "the length of the stock along x",
    "the length of the stock along y",
    "the length of the stock along z",
];

/// `value`, if it is within this range, m.
pub(super) fn checked(what: &'static str, value: f64, [least, most]: [f64; 2]) -> Result<f64, RemovalError> {
    if !value.is_finite() {
        return Err(RemovalError::NotFinite(what));
    }
    if value < least || value > most {
        return Err(RemovalError::OutOfRange {
            what,
            value,
            least,
            most,
        });
    }
    Ok(value)
}

impl DexelPart {
    /// Number of dexels and memory of a part in the box between two corners (m), without creating it.
    ///
    /// # Errors
    /// Numbers that are not finite or out of range.
    pub fn size(
        [low, high]: [Point3<f64>; 2],
        cell: f64,
        directions: DexelDirections,
    ) -> Result<PartSize, RemovalError> {
        checked("the cell", cell, [LEAST_CELL, FARTHEST])?;
        let mut cells = [0.0; 3];
        for k in 0..3 {
            for end in [low[k], high[k]] {
                checked("a coordinate of the stock", end, [-FARTHEST, FARTHEST])?;
            }
            let length = checked(LENGTHS[k], high[k] - low[k], [LEAST_CELL, 2.0 * FARTHEST])?;
            // A small tolerance, so that 10 mm in cells of 0.1 mm are 100 and not 101.
            cells[k] = (length / cell - 1e-9).ceil().max(1.0);
        }
        let [x, y, z] = cells;
        let dexels = match directions {
            DexelDirections::Z => x * y,
            DexelDirections::All => x * y + y * z + x * z,
        };
        Ok(PartSize {
            cells,
            dexels,
            bytes: dexels * size_of::<Span>() as f64,
        })
    }

    /// The stock, in cells of at most `cell`, m.
    ///
    /// # Errors
    /// Numbers that are not finite or out of range, too many dexels, a mesh that is open.
    pub fn new(
        stock: &StockSolid,
        cell: f64,
        directions: DexelDirections,
    ) -> Result<DexelPart, RemovalError> {
        DexelPart::of_solid(stock, stock.corners()?, cell, directions)
    }

    /// A solid on the raster of this part, for comparison with it. Beyond the box of this part it has no dexels.
    ///
    /// # Errors
    /// As [`DexelPart::new`].
    pub fn on_same_raster(&self, solid: &StockSolid, cell: f64) -> Result<DexelPart, RemovalError> {
        let directions = match self.grids.len() {
            1 => DexelDirections::Z,
            _ => DexelDirections::All,
        };
        DexelPart::of_solid(solid, self.corners, cell, directions)
    }

    fn of_solid(
        stock: &StockSolid,
        corners: [Point3<f64>; 2],
        cell: f64,
        directions: DexelDirections,
    ) -> Result<DexelPart, RemovalError> {
        let PartSize { cells, dexels, bytes } = DexelPart::size(corners, cell, directions)?;
        if dexels > MOST_DEXELS {
            let most = MOST_DEXELS;
            return Err(RemovalError::TooLarge { dexels, bytes, most });
        }
        let raster = Raster {
            corners,
            counts: cells.map(|count| count as usize),
        };
        let along: &[usize] = match directions {
            DexelDirections::Z => &[2],
            DexelDirections::All => &[0, 1, 2],
        };
        let mut grids = Vec::new();
        for &k in along {
            let mut grid = DexelGrid::new(&raster, k);
            stock.fill(&mut grid)?;
            grids.push(grid);
        }
        Ok(DexelPart {
            corners,
            counts: raster.counts,
            grids,
        })
    }

    /// Two corners of the box around the stock, the lower one first, m.
    pub fn corners(&self) -> [Point3<f64>; 2] {
        self.corners
    }

    /// Its grids in the order of x, y, z; the last one is that of z.
    pub fn grids(&self) -> &[DexelGrid] {
        &self.grids
    }

    /// Volume of the material by the dexels along z, m^3.
    pub fn volume(&self) -> f64 {
        self.grids.last().map_or(0.0, DexelGrid::volume)
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> usize {
        self.grids.iter().map(DexelGrid::bytes).sum()
    }
}
