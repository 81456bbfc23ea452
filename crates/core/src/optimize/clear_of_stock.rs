//! Postures of a search that do not keep the demanded clearance from the stock, as it is cut along the path.
//!
//! What is left of the stock at a point depends on the path alone, so that one replay of the stock in the order of the path
//! decides all postures of all points. Whether a clearance is kept is decided, not measured:
//!
//! | bodies | decided |
//! |---|---|
//! | of the tool, round about its axis | once for all spins of a lean |
//! | others of the tool | once a spin, for all branches |
//! | links | in each posture; those far away by a capsule around them |
//!
//! Several copies of the replay, each at its own points, share the work; the decisions are the same for any number of them.

use nalgebra::Point3;
use rayon::prelude::*;

use crate::clearance::{ArmBody, DemandedClearance, Shape};
use crate::frame::Isometry;
use crate::kernel::{Column, PostureStatus, Question, SLOTS};
use crate::map::ArmNearStock;
use crate::path::{CutStock, StockReplay};
use crate::robot::Attachment;
use crate::watch::{Cancelled, Watch};

/// Cells of all copies of the stock together, at most, unless there is only one.
const MOST_CELLS: usize = 50_000_000;
/// Distance from the axis of the tool at which the axis of a body is on it, m.
const ON_AXIS: f64 = 1e-9;

/// Excludes postures near the stock, of columns in the order of the path.
pub(super) struct ClearOfStock<'a> {
    copies: Vec<Decisions<'a>>,
}

/// A replay of the stock with the bodies of the arm.
#[derive(Clone)]
struct Decisions<'a> {
    replay: StockReplay<'a>,
    arm: ArmNearStock<'a>,
    joint_count: usize,
    /// The demanded clearance of round bodies, and of all others, m.
    least: [f64; 2],
    /// Bodies of the tool that are the same for all spins.
    round: Vec<usize>,
    /// Other bodies of the tool.
    of_tool: Vec<usize>,
    links: Vec<usize>,
}

impl<'a> ClearOfStock<'a> {
    /// At the first point of the path. Bodies of the tool that are round about its axis keep `least_of_round`, m.
    pub fn new(
        question: &Question<'a>,
        demanded: DemandedClearance<'a>,
        stock: &'a CutStock<'a>,
        least_of_round: f64,
    ) -> ClearOfStock<'a> {
        let arm = ArmNearStock::new(question, demanded, stock);
        let is_of_tool =
            |body: &usize| matches!(arm.body(*body).attachment, Attachment::Flange | Attachment::Tool);
        let (of_tool, links): (Vec<usize>, Vec<usize>) =
            arm.bodies().iter().partition(|body| is_of_tool(body));
        let tool_from_flange = question.arm.flange_from_tool.inverse();
        let is_round = |body: &usize| is_round(arm.body(*body), &tool_from_flange);
        let (round, of_tool) = of_tool.into_iter().partition(is_round);
        let decisions = Decisions {
            replay: stock.replay(),
            joint_count: question.arm.robot.joints().len(),
            least: [least_of_round, demanded.least],
            round,
            of_tool,
            links,
            arm,
        };
        let most = (MOST_CELLS / stock.cell_count().max(1)).max(1);
        ClearOfStock {
            copies: vec![decisions; rayon::current_num_threads().min(most)],
        }
    }

    /// Excludes the postures of these columns, each with its point, that do not keep the clearance. The points are
    /// behind those of the calls before; settings that follow each other in groups of `spins` differ in spin alone.
    ///
    /// # Errors
    /// [`Cancelled`] if the watch cancels.
    pub fn exclude(
        &mut self,
        points: &[usize],
        columns: &mut [Column],
        spins: usize,
        watch: Watch<'_>,
    ) -> Result<(), Cancelled> {
        let share = points.len().div_ceil(self.copies.len()).max(1);
        let shares = points.par_chunks(share).zip(columns.par_chunks_mut(share));
        let decided = (self.copies.par_iter_mut().zip(shares)).map(|(copy, (points, columns))| {
            for (point, column) in points.iter().zip(columns) {
                if watch.is_cancelled() {
                    return Err(Cancelled);
                }
                copy.exclude(*point, column, spins);
            }
            Ok(())
        });
        decided.collect()
    }
}

impl Decisions<'_> {
    /// Excludes postures of one column.
    fn exclude(&mut self, point: usize, column: &mut Column, spins: usize) {
        let Decisions {
            replay,
            arm,
            joint_count,
            least,
            round,
            of_tool,
            links,
        } = self;
        let Some(remaining) = replay.at_point(point) else {
            return;
        };
        let joint_count = *joint_count;
        // Whether one of these bodies is in conflict, in this posture.
        let [of_round, least] = *least;
        let mut conflicts = |bodies: &[usize], joints: &[f64], least: f64| {
            if bodies.is_empty() {
                return false;
            }
            arm.set_joints(joints);
            (bodies.iter()).any(|body| arm.is_in_conflict(*body, remaining, least))
        };
        let settings = column.statuses.len() / SLOTS;
        for first in (0..settings).step_by(spins.max(1)) {
            let group = first * SLOTS..(first + spins.max(1)).min(settings) * SLOTS;
            let Some(any) = column.first_usable(group.clone()) else {
                continue;
            };
            if conflicts(round, column.joints_of(any, joint_count), of_round) {
                column.set_in_collision(group);
                continue;
            }
            for setting in group.step_by(SLOTS) {
                let slots = setting..setting + SLOTS;
                let Some(any) = column.first_usable(slots.clone()) else {
                    continue;
                };
                if conflicts(of_tool, column.joints_of(any, joint_count), least) {
                    column.set_in_collision(slots);
                    continue;
                }
                for slot in slots {
                    let usable = column.statuses[slot] == PostureStatus::Usable;
                    if usable && conflicts(links, column.joints_of(slot, joint_count), least) {
                        column.set_in_collision(slot..slot + 1);
                    }
                }
            }
        }
    }
}

/// Whether a body of the tool is round about the axis of the tool.
fn is_round(body: &ArmBody, tool_from_flange: &Isometry) -> bool {
    let axis = match &body.shape {
        Shape::Capsule(capsule) => capsule.axis,
        Shape::Cylinder(axis, _) => *axis,
        Shape::Box(_) | Shape::Mesh(_) => return false,
    };
    let tool_from_body = match body.attachment {
        Attachment::Flange => tool_from_flange * body.attachment_from_body,
        _ => body.attachment_from_body,
    };
    let is_on_axis = |at: Point3<f64>| {
        let at = tool_from_body * at;
        at.x.hypot(at.y) < ON_AXIS
    };
    is_on_axis(axis.from) && is_on_axis(axis.to)
}

#[cfg(test)]
mod tests;
