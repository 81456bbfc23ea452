//! The strokes of a tool, cut from the dexels of a tile.
//!
//! A tile sees the strokes that can reach it in their order, and tiles do not depend on each other: so any number of threads
//! gives the same part. Ends of intervals are computed only where material can be cut: first the one from which the tool enters
//! less of it, which mostly decides.

use super::apart::Apart;
use super::dexel::Tile;
use super::grid::DexelGrid;
use super::near::{MovingBox, Reached};
use super::swept::{End, SweptTool};
use super::tool_solid::ToolSolid;
use super::turning::Stroke;

/// A tool: what cuts, and what does not.
#[derive(Clone, Copy, Debug)]
pub struct RotatingTool<'a> {
    /// The cutting part.
    pub cutting: &'a ToolSolid,
    /// Shank and holder, in pieces: they remove nothing; their contact with the material is reported.
    pub clear: &'a [ToolSolid],
}

/// What a move did in a tile.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    /// Place of the move in the list.
    pub(super) place: u32,
    /// Sum of the lengths removed, m.
    pub(super) removed: f64,
    /// Largest length removed along a dexel, m.
    pub(super) longest: f64,
    /// Largest length of material along a dexel within shank or holder, m.
    pub(super) contact: f64,
}

/// A grid without its tiles, and the tool that cuts it.
pub(super) struct TileCutter<'a> {
    pub(super) grid: &'a DexelGrid,
    pub(super) tool: &'a RotatingTool<'a>,
}

/// Resolution of single precision: half a unit in the last place, relative.
const RESOLUTION: f64 = 6e-8;

impl TileCutter<'_> {
    /// Cuts one stroke from a tile; what it changed.
    pub(super) fn cut(&self, tile: &mut Tile, stroke: &Stroke) -> Change {
        let mut change = Change {
            place: stroke.place,
            ..Change::default()
        };
        let cutting = MovingSolid::new(self.grid, self.tool.cutting, stroke);
        cutting.visit(tile, |tile, dexel, ends| {
            let removed = tile.remove(dexel, ends, stroke.index);
            change.removed += removed;
            change.longest = change.longest.max(removed);
        });
        for solid in self.tool.clear {
            MovingSolid::new(self.grid, solid, stroke).visit(tile, |tile, dexel, ends| {
                change.contact = change.contact.max(tile.length_within(dexel, ends));
            });
        }
        change
    }
}

/// A solid on a stroke.
struct MovingSolid<'a> {
    grid: &'a DexelGrid,
    around: MovingBox,
    swept: SweptTool<'a>,
    apart: Apart,
}

impl MovingSolid<'_> {
    fn new<'a>(grid: &'a DexelGrid, solid: &'a ToolSolid, stroke: &Stroke) -> MovingSolid<'a> {
        MovingSolid {
            grid,
            around: MovingBox::new(solid, stroke.ends, &stroke.axis),
            swept: SweptTool::new(solid, stroke.ends, &stroke.axis, grid.k),
            apart: Apart::new(solid, stroke, grid.k, RESOLUTION * grid.length),
        }
    }

    /// Calls `out` with each dexel of a tile whose material it may meet, and the interval inside.
    fn visit(&self, tile: &mut Tile, mut out: impl FnMut(&mut Tile, usize, [f32; 2])) {
        self.around.visit(self.grid, tile, |tile, reached| {
            if !tile.is_clear(reached.dexel, reached.range)
                && let Some(ends) = self.within(tile, &reached)
            {
                out(tile, reached.dexel, ends);
            }
        });
    }

    /// The interval of a dexel inside, if it can meet material.
    fn within(&self, tile: &Tile, reached: &Reached) -> Option<[f32; 2]> {
        let hull = tile.hull(reached.dexel);
        let [least, most] = reached.range;
        let (low, at) = (self.grid.low[self.grid.k], reached.at);
        let is_apart =
            |place: f32, end: End| self.apart.is_certain([at[0], at[1], low + f64::from(place)], end);
        let end = |end: End| match self.swept.top() {
            // Beyond the material: the place does not matter.
            Some((top, place)) if top == end && end == End::High && place - low > f64::from(hull.high) => {
                Some(f32::MAX)
            }
            Some((top, place)) if top == end && end == End::Low && place - low < f64::from(hull.low) => {
                Some(f32::MIN)
            }
            _ => Some((self.swept.end(at, end)? - low) as f32),
        };
        if hull.high - least < most - hull.low {
            if is_apart(hull.high, End::Low) {
                return None;
            }
            let low = end(End::Low)?;
            if low >= hull.high {
                return None;
            }
            Some([low, end(End::High)?])
        } else {
            if is_apart(hull.low, End::High) {
                return None;
            }
            let high = end(End::High)?;
            if high <= hull.low {
                return None;
            }
            Some([end(End::Low)?, high])
        }
    }
}
