//! The deviation at holes in any order, each with a posture of its own.
//!
//! [`table`] the key `holes`; [`resolve`](mod@resolve) their positions, directions and load; [`answer`], [`sentence`]
//! and [`warnings`](mod@warnings); [`columns`](mod@columns), [`pictures`](mod@pictures) and [`report`].

pub mod answer;
pub mod columns;
pub mod pictures;
pub mod report;
pub mod resolve;
pub mod sentence;
pub mod table;
pub mod warnings;

use armill_core::optimize::PostureSearch;
use armill_core::robot::BranchPattern;
use armill_core::units::from_mm;

use self::table::{HoleOrder, HolesTable};
use crate::analysis::path::PathAnalysis;

/// How holes are drilled in a robot program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drilling {
    /// Length from the surface to the end of a hole, m; none if not given.
    pub depth: Option<f64>,
    /// Depth of a peck, m; one stroke if none is given.
    pub peck: Option<f64>,
    /// Distance from the surface at which the drilling feed begins, m.
    pub clearance: f64,
    /// Dwell at the end, s.
    pub dwell: f64,
    /// Order of the holes.
    pub order: HoleOrder,
}

/// Default distance from the surface at which the drilling feed begins, mm.
const CLEARANCE_MM: f64 = 2.0;

impl Drilling {
    fn of(table: &HolesTable) -> Drilling {
        Drilling {
            depth: table.depth_mm.map(from_mm),
            peck: table.peck_mm.map(from_mm),
            clearance: from_mm(table.clearance_mm.unwrap_or(CLEARANCE_MM)),
            dwell: table.dwell_s.unwrap_or(0.0),
            order: table.order.unwrap_or_default(),
        }
    }
}

/// Holes with their load.
#[derive(Clone, Debug)]
pub struct HolesAnalysis {
    /// Their positions as separate points, and the load there.
    pub path: PathAnalysis,
    /// Spins and branches that are tried at each.
    pub search: PostureSearch,
    /// How they are drilled in a robot program.
    pub drilling: Drilling,
}

impl HolesAnalysis {
    /// Permitted branches, in words: `best` if all are.
    pub fn branch(&self) -> String {
        let open = self.search.branches;
        match open == BranchPattern::default() {
            true => "best".to_owned(),
            false => open.to_string(),
        }
    }
}
