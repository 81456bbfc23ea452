//! The cell of an analysis: all bodies, with its tool on the flange and the part on its plane.

use std::sync::Arc;

use armill_core::clearance::{ArmBody, Cell, DemandedClearance};
use armill_core::frame::Isometry;
use armill_core::robot::Robot;

use crate::input::cell::bodies::{CellBodies, NamedShape, fixed};

/// The bodies of an analysis in base.
#[derive(Clone, Debug)]
pub struct PlacedCell {
    /// The bodies.
    pub cell: Arc<Cell>,
    /// The demanded clearance, m.
    pub least: f64,
    part: Option<NamedShape>,
}

/// Where the frames of a study are, and what is on its flange.
#[derive(Clone, Copy, Debug)]
pub struct CellFrames<'a> {
    /// The reference frame of the study.
    pub base_from_reference: &'a Isometry,
    /// The frame of the part.
    pub base_from_part: &'a Isometry,
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
}

impl PlacedCell {
    /// The cell of an arm with this tool.
    pub fn of(robot: &Robot, bodies: &CellBodies, tool: Vec<ArmBody>, frames: CellFrames<'_>) -> PlacedCell {
        let obstacles = bodies
            .obstacles
            .iter()
            .map(|body| fixed(body, frames.base_from_reference, false));
        let part = bodies
            .part
            .iter()
            .map(|body| fixed(body, frames.base_from_part, true));
        let still: Vec<_> = obstacles.chain(part).collect();
        let arm = bodies.links.iter().cloned().chain(tool).collect();
        let cell = Cell::new(robot, frames.flange_from_tool, arm, &bodies.apart, &still);
        PlacedCell {
            cell: Arc::new(cell),
            least: bodies.least,
            part: bodies.part.clone(),
        }
    }

    /// With the part at another place.
    pub fn with_part_at(&self, base_from_part: &Isometry) -> PlacedCell {
        let Some(part) = &self.part else {
            return self.clone();
        };
        PlacedCell {
            cell: Arc::new(self.cell.with_part(&[fixed(part, base_from_part, true)])),
            ..self.clone()
        }
    }

    /// The clearance that postures must keep.
    pub fn demanded(&self) -> DemandedClearance<'_> {
        DemandedClearance {
            cell: &self.cell,
            least: self.least,
        }
    }
}
