//! The removal along a list of moves.
//!
//! Moves are cut one after the other, as strokes with a fixed axis ([`turning`](super::turning)). Each tile of dexels has the list of the strokes that can
//! reach it, and tiles are cut in parallel.
//!
//! | result | error |
//! |---|---|
//! | an end of material | rounding to single precision; on a corner that is tilted or climbs, the search of `torus` |
//! | with an axis that turns | the given tolerance in addition |
//! | a volume, by z dexels | at most the area of the walls, times half a cell; mostly far less |
//!
//! Not modelled: deflection, wear, chips, burrs; material that is cut free stays where it is.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::cutting::{Change, RotatingTool, TileCutter};
use super::dexel::{STOCK, Tile};
use super::error::RemovalError;
use super::grid::DexelGrid;
use super::near::MovingBox;
use super::part::{DexelPart, checked};
use super::turning::{Stroke, ToolMove};
use crate::watch::{Cancelled, Watch};

/// What a move removed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MoveRemoval {
    /// By the dexels along z, m^3.
    pub volume: f64,
    /// Largest length removed along a dexel of any direction, m. A tool that follows a finished surface may remove
    /// rounding: up to 6e-8 of the length of the dexel.
    pub longest: f64,
    /// Largest length of material along a dexel within shank or holder, m.
    pub contact: f64,
}

impl MoveRemoval {
    /// Whether the move is a rapid and met material.
    pub fn is_rapid_in_material(&self, tool_move: &ToolMove) -> bool {
        tool_move.is_rapid && (self.longest > 0.0 || self.contact > 0.0)
    }
}

/// Strokes that are cut at once, and those of one move more: it limits the memory.
const STROKES_AT_ONCE: usize = 1 << 17;
/// Strokes of a tile between two checks for cancellation.
const BLOCK: usize = 64;
/// Smallest tolerance of a turning axis, and largest, m.
const TOLERANCES: [f64; 2] = [1e-9, 1.0];

impl DexelPart {
    /// The part after these moves, and what each of them removed, in their order. An axis that turns may be off by
    /// `turn_tolerance`, m. Progress counts moves.
    ///
    /// # Errors
    /// A number of a move that is not valid; cancelled: the part is lost then.
    pub fn cut(
        mut self,
        moves: &[ToolMove],
        tool: &RotatingTool,
        turn_tolerance: f64,
        watch: Watch,
    ) -> Result<(DexelPart, Vec<MoveRemoval>), RemovalError> {
        checked("the tolerance of a turning axis", turn_tolerance, TOLERANCES)?;
        check(moves, tool, turn_tolerance)?;
        let mut removals = vec![MoveRemoval::default(); moves.len()];
        let mut first = 0;
        while first < moves.len() {
            let mut strokes = Vec::new();
            let mut end = first;
            while end < moves.len() && strokes.len() < STROKES_AT_ONCE {
                strokes.extend(moves[end].strokes(tool.cutting, turn_tolerance, end as u32));
                end += 1;
            }
            let lists: Vec<TileLists> = self
                .grids
                .iter()
                .map(|grid| TileLists::new(grid, &strokes, tool))
                .collect();
            let progress = Progress {
                moves: end - first,
                entries: lists
                    .iter()
                    .map(|lists| lists.numbers.len())
                    .sum::<usize>()
                    .max(1),
                done: AtomicUsize::new(0),
                watch,
            };
            for (grid, lists) in self.grids.iter_mut().zip(&lists) {
                cut_grid(
                    grid,
                    &Work {
                        strokes: &strokes,
                        lists,
                        tool,
                    },
                    &progress,
                    &mut removals,
                )?;
            }
            progress.add(progress.entries - progress.done.load(Ordering::Relaxed));
            first = end;
        }
        Ok((self, removals))
    }
}

/// Strokes for a grid, and the tool.
struct Work<'a> {
    strokes: &'a [Stroke],
    lists: &'a TileLists,
    tool: &'a RotatingTool<'a>,
}

fn cut_grid(
    grid: &mut DexelGrid,
    work: &Work,
    progress: &Progress,
    removals: &mut [MoveRemoval],
) -> Result<(), Cancelled> {
    let mut tiles = std::mem::take(&mut grid.tiles);
    let cutter = TileCutter {
        grid,
        tool: work.tool,
    };
    let cut = |(number, tile): (usize, &mut Tile)| {
        let mut changes: Vec<Change> = Vec::new();
        for block in work.lists.of(number).chunks(BLOCK) {
            if progress.watch.is_cancelled() {
                return Err(Cancelled);
            }
            for &stroke in block {
                let change = cutter.cut(tile, &work.strokes[stroke as usize]);
                if change.longest > 0.0 || change.contact > 0.0 {
                    changes.push(change);
                }
            }
            progress.add(block.len());
        }
        Ok(changes)
    };
    let changes: Result<Vec<Vec<Change>>, Cancelled> = tiles
        .par_iter_mut()
        .enumerate()
        .with_max_len(1)
        .map(cut)
        .collect();
    grid.tiles = tiles;
    // Added in the order of the tiles, so that sums do not depend on the number of threads.
    let area = if grid.k == 2 {
        grid.sides[0] * grid.sides[1]
    } else {
        0.0
    };
    for change in changes?.into_iter().flatten() {
        let removal = &mut removals[change.place as usize];
        removal.volume += change.removed * area;
        removal.longest = removal.longest.max(change.longest);
        removal.contact = removal.contact.max(change.contact);
    }
    Ok(())
}

/// For each tile of a grid the strokes that can reach it, in their order.
struct TileLists {
    /// Where the list of each tile begins, and the end of the last one.
    starts: Vec<usize>,
    numbers: Vec<u32>,
}

impl TileLists {
    fn new(grid: &DexelGrid, strokes: &[Stroke], tool: &RotatingTool) -> TileLists {
        let reached = |stroke: &Stroke| {
            let solids = std::iter::once(tool.cutting).chain(tool.clear);
            let ranges =
                solids.filter_map(|solid| MovingBox::new(solid, stroke.ends, &stroke.axis).tiles(grid));
            ranges
                .reduce(|one, other| [0, 1].map(|n| [one[n][0].min(other[n][0]), one[n][1].max(other[n][1])]))
        };
        let ranges: Vec<Option<[[usize; 2]; 2]>> = strokes.par_iter().map(reached).collect();
        let tiles = |range: [[usize; 2]; 2]| {
            let [columns, rows] = range;
            (rows[0]..=rows[1]).flat_map(move |row| {
                (columns[0]..=columns[1]).map(move |column| row * grid.tile_counts[0] + column)
            })
        };
        let mut starts = vec![0; grid.tiles.len() + 1];
        for tile in ranges.iter().flatten().copied().flat_map(tiles) {
            starts[tile + 1] += 1;
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut ends = starts.clone();
        let mut numbers = vec![0; starts.last().copied().unwrap_or(0)];
        for (stroke, range) in (0_u32..).zip(&ranges) {
            for tile in range.iter().copied().flat_map(tiles) {
                numbers[ends[tile]] = stroke;
                ends[tile] += 1;
            }
        }
        TileLists { starts, numbers }
    }

    fn of(&self, tile: usize) -> &[u32] {
        &self.numbers[self.starts[tile]..self.starts[tile + 1]]
    }
}

/// Progress in moves: the part of all entries of lists that is done.
struct Progress<'a> {
    moves: usize,
    entries: usize,
    done: AtomicUsize,
    watch: Watch<'a>,
}

impl Progress<'_> {
    fn add(&self, entries: usize) {
        let before = self.done.fetch_add(entries, Ordering::Relaxed);
        let moves = |done: usize| (done as u128 * self.moves as u128 / self.entries as u128) as usize;
        let finished = moves(before + entries) - moves(before);
        if finished > 0 {
            (self.watch.finished)(finished);
        }
    }
}

/// Checks the numbers of moves.
fn check(moves: &[ToolMove], tool: &RotatingTool, turn_tolerance: f64) -> Result<(), RemovalError> {
    for (place, tool_move) in moves.iter().enumerate() {
        let problem = |problem: &'static str| Err(RemovalError::Move { place, problem });
        let coordinates = tool_move.ends.iter().flat_map(|end| end.iter());
        if !coordinates
            .clone()
            .all(|value| value.is_finite() && value.abs() <= FARTHEST)
        {
            return problem("a coordinate of the tip is not a finite number within 1 km of zero");
        }
        if !tool_move.axes.iter().all(|axis| (axis.norm() - 1.0).abs() < 1e-6) {
            return problem("the tool axis is not a unit vector");
        }
        if tool_move.turn() > MOST_TURN {
            return problem("the tool axis turns by more than 179 deg: the plane of the turn is not known");
        }
        if tool_move.pieces(tool.cutting, turn_tolerance) > MOST_PIECES {
            return problem("the turn of its axis needs more than 100000 pieces: use a larger tolerance");
        }
        if tool_move.index >= STOCK {
            return problem("its index must be less than 2147483648");
        }
    }
    Ok(())
}

/// Largest coordinate of a tip, m.
const FARTHEST: f64 = 1e3;
/// Most pieces of a move: it limits the memory.
const MOST_PIECES: usize = 100_000;
/// Largest turn of an axis on a move, rad.
const MOST_TURN: f64 = 179.0 * std::f64::consts::PI / 180.0;
