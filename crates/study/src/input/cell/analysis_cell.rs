//! The bodies of an analysis, ready for the core.

use std::sync::Arc;

use armill_core::clearance::{Cell, DemandedClearance, FixedBody, PlacedCell};
use armill_core::frame::Isometry;

/// The bodies of an analysis, and the clearance that it demands.
#[derive(Clone, Debug)]
pub struct AnalysisCell {
    /// The bodies.
    pub cell: Arc<Cell>,
    /// How many of the last bodies of the arm carry it or ride with it, and are not of it.
    pub carried: usize,
    /// Those that stand still.
    pub still: Vec<FixedBody>,
    /// The frame of the part in base.
    pub base_from_part: Isometry,
    /// The frame whose x-y plane is the floor, where the base stands on it.
    pub base_from_floor: Option<Isometry>,
    /// Which body of the arm is the floor, where the base moves.
    pub floor_body: Option<usize>,
    /// The demanded clearance, m.
    pub least: f64,
}

impl AnalysisCell {
    /// The cell with its part in place.
    pub fn placed(&self) -> PlacedCell<'_> {
        PlacedCell {
            cell: &self.cell,
            base_from_part: &self.base_from_part,
        }
    }

    /// The clearance that postures must keep.
    pub fn demanded(&self) -> DemandedClearance<'_> {
        DemandedClearance {
            placed: self.placed(),
            least: self.least,
        }
    }
}
