//! The clearance that postures must keep, and its check.

use super::cell::PlacedCell;
use super::state::CellState;
use crate::frame::Isometry;
use crate::robot::Robot;

/// A clearance that postures must keep.
#[derive(Clone, Copy, Debug)]
pub struct DemandedClearance<'a> {
    /// The bodies.
    pub placed: PlacedCell<'a>,
    /// The least distance, m; with 0 bodies must not touch.
    pub least: f64,
}

/// Two bodies that are nearer than demanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conflict {
    /// How much of the demanded clearance is missing, m.
    pub missing: f64,
    /// The two bodies: indices of [`Cell::name`](super::cell::Cell::name).
    pub bodies: [usize; 2],
}

/// Checks postures for a demanded clearance; one per thread.
#[derive(Clone, Debug)]
pub struct ClearanceCheck<'a> {
    pub(super) state: CellState<'a>,
    pub(super) least: f64,
}

impl<'a> ClearanceCheck<'a> {
    /// For this arm and tool.
    pub fn new(
        demanded: DemandedClearance<'a>,
        robot: &'a Robot,
        flange_from_tool: &Isometry,
    ) -> ClearanceCheck<'a> {
        ClearanceCheck {
            state: CellState::new(demanded.placed, robot, flange_from_tool),
            least: demanded.least,
        }
    }

    /// Moves the part.
    pub fn set_part(&mut self, base_from_part: &Isometry) {
        self.state.set_part(base_from_part);
    }

    /// The two bodies that are nearest to a conflict, if they are nearer than demanded at these joint positions, rad (m).
    pub fn conflict(&mut self, joints: &[f64]) -> Option<Conflict> {
        self.state.set_joints(joints);
        let (found, kept) = self.state.demanded_clearance(self.least, self.least)?;
        (kept < self.least || kept == 0.0).then_some(Conflict {
            missing: self.least - kept,
            bodies: found.bodies,
        })
    }
}
