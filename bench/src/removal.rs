//! Rows of material removal: a ball nose of 10 mm on a wavy surface, in moves of 0.8 mm and rows 0.5 mm apart, on a part of
//! 200 x 200 x 50 mm in cells of 0.2 mm.
//!
//! | work | in | out |
//! |---|---|---|
//! | [`REMOVAL_Z`] | moves | the part as dexels along z, volume of each move |
//! | [`REMOVAL`] | moves | the same along x, y and z |
//!
//! Two threads. Rates count moves.

use std::hint::black_box;

use armill_core::load::EndMillBody;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::removal::{DexelDirections, DexelPart, RotatingTool, StockSolid, ToolMove, ToolSolid};
use armill_core::watch::Watch;
use rayon::ThreadPool;

use crate::clock::Candidate;

/// Removal by dexels along z.
pub const REMOVAL_Z: &str = "removal, dexels along z";
/// Removal by dexels along x, y and z.
pub const REMOVAL: &str = "removal, dexels along x, y, z";

/// Rows of the zigzag, and moves of a row.
const ROWS: usize = 16;
const MOVES: usize = 250;

/// A part, and the moves of a tool on it.
pub struct Cuts {
    tool: ToolSolid,
    moves: Vec<ToolMove>,
    parts: [DexelPart; 2],
}

impl Cuts {
    /// Sixteen rows in the middle of the part.
    pub fn zigzag() -> Cuts {
        let body = EndMillBody::new(10e-3, 5e-3).expect("a ball nose of a catalogue");
        let corners = [Point3::origin(), Point3::new(0.2, 0.2, 0.05)];
        let part = |directions| DexelPart::new(&StockSolid::Box(corners), 0.2e-3, directions).expect("a box");
        let places: Vec<Point3<f64>> = (0..ROWS * MOVES + 1).map(place).collect();
        let moves = places.windows(2).zip(0..);
        Cuts {
            tool: ToolSolid::end_mill(&body, 30e-3).expect("flutes of a catalogue"),
            moves: moves
                .map(|(ends, index)| ToolMove {
                    ends: [ends[0], ends[1]],
                    axes: [Vector3::z_axis(); 2],
                    index,
                    is_rapid: false,
                })
                .collect(),
            parts: [DexelDirections::Z, DexelDirections::All].map(part),
        }
    }
}

/// Point `k` of the zigzag, m.
fn place(k: usize) -> Point3<f64> {
    let (row, along) = (k / MOVES, k % MOVES);
    let along = if row.is_multiple_of(2) {
        along
    } else {
        MOVES - 1 - along
    };
    let (x, y) = (0.8 * along as f64, 90.0 + 0.5 * row as f64);
    Point3::new(x, y, 42.0 + 3.0 * (x / 15.0).sin() * (y / 20.0).cos()) * 1e-3
}

/// Both rows.
pub fn candidates<'a>(cuts: &'a Cuts, two_threads: &'a ThreadPool) -> Vec<Candidate<'a>> {
    let row = |work: &'static str, part: &'a DexelPart| {
        let cut = move || {
            let tool = RotatingTool {
                cutting: &cuts.tool,
                clear: &[],
            };
            let part = part.clone();
            let cut = two_threads.install(|| part.cut(&cuts.moves, &tool, 50e-6, Watch::NONE));
            black_box(cut.expect("moves of numbers")).1.len();
        };
        Candidate::new("armill, material removal", work, cuts.moves.len(), cut)
            .threads(two_threads.current_num_threads())
            .note("200 x 200 x 50 mm, cells of 0.2 mm, ball nose of 10 mm, moves of 0.8 mm")
    };
    let [z, all] = &cuts.parts;
    vec![row(REMOVAL_Z, z), row(REMOVAL, all)]
}
