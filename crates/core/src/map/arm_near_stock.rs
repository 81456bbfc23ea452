//! The bodies of the arm, relative to the stock that is cut along a path.
//!
//! All that may not touch the part may not touch the stock: not a cutter, and not what is under the arm.

use nalgebra::IsometryMatrix3;

use crate::clearance::{ArmBody, CellState, Clearance, DemandedClearance, Nearest};
use crate::kernel::Question;
use crate::path::{BodyNearStock, Placing, RemainingStock};

/// The bodies of the arm in a posture, and the columns that were nearest to them last. Made once, used for any number of
/// postures.
#[derive(Clone, Debug)]
pub(crate) struct ArmNearStock<'a> {
    state: CellState<'a>,
    base_from_path: IsometryMatrix3<f64>,
    path_from_base: IsometryMatrix3<f64>,
    /// The bodies that are checked, the last one of the arm first: the tool is nearest to the stock most often.
    bodies: Vec<usize>,
    likely: Vec<Option<[usize; 2]>>,
}

impl<'a> ArmNearStock<'a> {
    /// For the arm and the cell of `question`, with the path at this place.
    pub fn new(
        question: &Question<'a>,
        demanded: DemandedClearance<'a>,
        placing: &Placing,
    ) -> ArmNearStock<'a> {
        let base_from_path: IsometryMatrix3<f64> = nalgebra::convert(placing.base_from_path);
        let cell = demanded.placed.cell;
        let count = cell.arm().len();
        ArmNearStock {
            state: CellState::new(demanded.placed, question.arm.robot, question.arm.flange_from_tool),
            base_from_path,
            path_from_base: base_from_path.inverse(),
            bodies: (0..count).rev().filter(|body| cell.meets_stock(*body)).collect(),
            likely: vec![None; count],
        }
    }

    /// The bodies that are checked: indices of [`Cell::arm`](crate::clearance::Cell::arm).
    pub fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    /// A body of the arm.
    pub fn body(&self, body: usize) -> &'a ArmBody {
        &self.state.cell().arm()[body]
    }

    /// Moves the arm to these joint positions, rad (m).
    pub fn set_joints(&mut self, joints: &[f64]) {
        self.state.set_joints(joints);
    }

    /// Whether a body is nearer to the stock than `least`, m, or touches it.
    pub fn is_in_conflict(&mut self, body: usize, remaining: &RemainingStock, least: f64) -> bool {
        let Some(extent) = remaining.extent() else {
            return false;
        };
        // Most links are far away.
        let hull = self.state.hulls()[body].moved(&self.path_from_base);
        if hull.bound_to(&extent) > least.max(0.0) {
            return false;
        }
        let own = self.near_stock(body);
        let found = remaining.conflict(&own, least, self.likely[body]);
        self.likely[body] = found.or(self.likely[body]);
        found.is_some()
    }

    /// The least distance of the bodies from the stock, if it is below `limit`, m.
    pub fn nearest(&mut self, remaining: &RemainingStock, limit: f64) -> Option<Clearance> {
        let (mut limit, mut best) = (limit, None);
        for body in self.bodies.iter().copied() {
            let own = self.near_stock(body);
            let Some(found) = remaining.nearest(&own, limit, self.likely[body]) else {
                continue;
            };
            self.likely[body] = Some(found.cell);
            limit = found.nearest.distance;
            best = Some(Clearance {
                nearest: Nearest {
                    points: found.nearest.points.map(|point| self.base_from_path * point),
                    ..found.nearest
                },
                bodies: [body, self.state.cell().stock_index()],
            });
        }
        best
    }

    /// A body, in the frame of the path.
    fn near_stock(&self, body: usize) -> BodyNearStock {
        let path_from_body = self.path_from_base * self.state.base_from_body()[body];
        BodyNearStock::new(&self.body(body).shape, &path_from_body)
    }
}
