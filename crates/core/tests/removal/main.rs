//! Material removal, by the public interface: cuts whose result is known in closed form, a voxel computation that shares no code, and runs that
//! are cancelled, refused or divided among threads.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod cuts;
mod meshes;
mod profiles;
mod run;
mod stocks;
mod turned;
mod voxels;

use armill_core::load::EndMillBody;
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::removal::{
    DexelDirections, DexelPart, MoveRemoval, RotatingTool, StockSolid, ToolMove, ToolSolid,
};
use armill_core::watch::Watch;

/// A millimetre in m.
pub const MM: f64 = 1e-3;

/// A point given in mm.
pub fn at(x: f64, y: f64, z: f64) -> Point3<f64> {
    Point3::new(x, y, z) * MM
}

/// A box of stock from the origin, mm, in cells of this size, mm.
pub fn block(size: [f64; 3], cell: f64, directions: DexelDirections) -> DexelPart {
    let stock = StockSolid::Box([Point3::origin(), at(size[0], size[1], size[2])]);
    DexelPart::new(&stock, cell * MM, directions).unwrap()
}

/// An end mill, mm.
pub fn end_mill(diameter: f64, corner: f64, length: f64) -> ToolSolid {
    ToolSolid::end_mill(
        &EndMillBody::new(diameter * MM, corner * MM).unwrap(),
        length * MM,
    )
    .unwrap()
}

/// Moves through these points with a fixed axis.
pub fn moves(points: &[Point3<f64>], axis: Unit<Vector3<f64>>) -> Vec<ToolMove> {
    let to_move = |(index, pair): (usize, &[Point3<f64>])| ToolMove {
        ends: [pair[0], pair[1]],
        axes: [axis; 2],
        index: index as u32,
        is_rapid: false,
    };
    points.windows(2).enumerate().map(to_move).collect()
}

/// The part after these moves; turns are exact to 10 um.
pub fn cut(part: DexelPart, moves: &[ToolMove], tool: &ToolSolid) -> (DexelPart, Vec<MoveRemoval>) {
    let tool = RotatingTool {
        cutting: tool,
        clear: &[],
    };
    part.cut(moves, &tool, 0.01 * MM, Watch::NONE).unwrap()
}

/// Height of the top of the material over a place, mm; `None` where nothing is left. Coordinates in mm.
pub fn top(part: &DexelPart, x: f64, y: f64) -> Option<f64> {
    let grid = part.grids().last().unwrap();
    let [columns, rows] = grid.cells();
    let [low, high] = part.corners();
    let cell = [
        ((x * MM - low.x) / (high.x - low.x) * columns as f64) as usize,
        ((y * MM - low.y) / (high.y - low.y) * rows as f64) as usize,
    ];
    grid.material(cell).last().map(|span| span.ends[1] / MM)
}
