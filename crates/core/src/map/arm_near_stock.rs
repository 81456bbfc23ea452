//! The bodies of the arm, relative to the stock that is cut along a path.
//!
//! All that may not touch the part may not touch the stock: not a cutter, and not what is under the arm. If the arm holds the stock,
//! these are the tool and the obstacles, which do not move, and links that are not near it by design.

use nalgebra::IsometryMatrix3;

use crate::clearance::shape::Placed;
use crate::clearance::{ArmBody, CellState, Clearance, DemandedClearance, Nearest, Role, Shape};
use crate::kernel::Question;
use crate::path::{BodyNearStock, CutStock, RemainingStock};

/// The bodies of the arm in a posture, and the columns that were nearest to them last. Made once, used for any number of
/// postures.
#[derive(Clone, Debug)]
pub(crate) struct ArmNearStock<'a> {
    state: CellState<'a>,
    base_from_path: IsometryMatrix3<f64>,
    path_from_base: IsometryMatrix3<f64>,
    /// The bodies that are checked, the last one of the arm first: the tool is nearest to the stock most often.
    bodies: Vec<usize>,
    /// Whether a body is nearer than demanded to a stock in the hand in every posture: only contact is a conflict.
    is_near_by_design: Vec<bool>,
    likely: Vec<Option<[usize; 2]>>,
}

impl<'a> ArmNearStock<'a> {
    /// For the arm and the cell of `question`, with the path of this stock at its place.
    pub fn new(
        question: &Question<'a>,
        demanded: DemandedClearance<'a>,
        stock: &CutStock<'_>,
    ) -> ArmNearStock<'a> {
        let placing = stock.placing();
        let base_from_path: IsometryMatrix3<f64> = nalgebra::convert(placing.base_from_path);
        let cell = demanded.placed.cell;
        let count = cell.arm().len();
        let mut is_near_by_design = vec![false; count];
        if question.arm.robot.chain().ground().part_is_in_hand() {
            let uncut = Shape::Box(stock.extent()).placed(&IsometryMatrix3::identity());
            let is_near = |own: &Placed| {
                own.nearest(&uncut, demanded.least)
                    .is_some_and(|found| found.distance < demanded.least)
            };
            for body in cell.always_near_in(question.arm.robot, &placing.base_from_path, is_near) {
                is_near_by_design[body] = cell.arm()[body].role == Role::Link;
            }
        }
        ArmNearStock {
            state: CellState::new(demanded.placed, question.arm.robot, question.arm.flange_from_tool),
            base_from_path,
            path_from_base: base_from_path.inverse(),
            bodies: (0..count).rev().filter(|body| cell.meets_stock(*body)).collect(),
            is_near_by_design,
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

    /// Whether a body is nearer to the stock than `least`, m, or touches it; one that is near by design only if it touches.
    pub fn is_in_conflict(&mut self, body: usize, remaining: &RemainingStock, least: f64) -> bool {
        let Some(extent) = remaining.extent() else {
            return false;
        };
        let least = if self.is_near_by_design[body] { 0.0 } else { least };
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

    /// The least distance from the stock, if it is below `limit`, m: of the bodies that are near it by design, or of the others.
    pub fn nearest(
        &mut self,
        remaining: &RemainingStock,
        limit: f64,
        is_near_by_design: bool,
    ) -> Option<Clearance> {
        let (mut limit, mut best) = (limit, None);
        for body in self.bodies.iter().copied() {
            if self.is_near_by_design[body] != is_near_by_design {
                continue;
            }
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

#[cfg(test)]
mod tests;
