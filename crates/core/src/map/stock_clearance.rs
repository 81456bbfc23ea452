//! Clearance of holder, spindle and links from the stock, as it becomes while it is cut.
//!
//! The stock is cut again in the order of the path. At each point with a posture, the bodies that may not touch the part
//! are measured against the columns that are left there ([`crate::path::remaining`]); a cutter may touch them. A point
//! where they are nearer than demanded, or touch, has no posture that keeps the clearance.
//!
//! Not included: what tilted tools cut, and the way between two points.

use nalgebra::{IsometryMatrix3, Vector3};

use super::along::AlongPath;
use crate::clearance::{Cell, CellState, Clearance, DemandedClearance, Nearest, Role};
use crate::kernel::{Answers, Question};
use crate::path::{BodyNearStock, Cutting, NoForces, RemainingStock, Stock, StockReplay, Track};
use crate::robot::{Attachment, Unreachable};
use crate::watch::Watch;

/// Points between two checks of the watch.
const POINTS_A_LOOK: usize = 256;

/// Measures the clearance at every point with a posture, from the bodies of the cell and from the remaining `stock` that
/// `cutting` cuts along `track`. Points that do not keep the demanded clearance from the stock lose their answers; nothing
/// if `question` demands no clearance.
///
/// # Errors
/// A tool of the program that is not possible, or [`NoForces::Cancelled`] if the watch cancels.
pub fn measure_stock_clearances(
    question: &Question<'_>,
    track: &Track,
    (cutting, stock): (&Cutting, &Stock),
    along: &mut AlongPath,
    watch: Watch<'_>,
) -> Result<(), NoForces> {
    let Some(demanded) = question.clearance else {
        return Ok(());
    };
    let answers = &mut along.answers;
    answers.measure_clearances(question);
    let arm = &question.arm;
    let mut search = Search {
        state: CellState::new(demanded.placed, arm.robot, arm.flange_from_tool),
        base_from_path: nalgebra::convert(track.placing.base_from_path),
        likely: vec![None; demanded.placed.cell.arm().len()],
    };
    let mut replay = StockReplay::new(cutting, (&track.path, &track.placing), stock.clone());
    for index in 0..answers.points.len() {
        if index % POINTS_A_LOOK == 0 {
            if watch.is_cancelled() {
                return Err(NoForces::Cancelled);
            }
            (watch.finished)(POINTS_A_LOOK.min(answers.points.len() - index));
        }
        let Some(remaining) = replay.next_point()? else {
            break;
        };
        if answers.points[index].is_err() {
            continue;
        }
        let of_cell = answers.clearances[index];
        let limit = of_cell.map_or(f64::INFINITY, |found| found.nearest.distance);
        if let Some(found) = search.nearest(remaining, answers.joints_at(index), limit) {
            take(answers, index, found, &demanded);
        }
    }
    Ok(())
}

/// Sets the clearance of a point, and removes its answer if that is less than demanded.
fn take(answers: &mut Answers, index: usize, found: Clearance, demanded: &DemandedClearance<'_>) {
    let distance = found.nearest.distance;
    if distance >= demanded.least && distance > 0.0 {
        answers.clearances[index] = Some(found);
        return;
    }
    answers.clearances[index] = None;
    answers.points[index] = Err(Unreachable::InCollision {
        missing: demanded.least - distance,
        bodies: found.bodies,
    });
    let (joints, cases, shares) = (answers.joint_count, answers.case_count, answers.share_count);
    answers.joints[index * joints..][..joints].fill(0.0);
    answers.deviations[index * cases..][..cases].fill(Vector3::zeros());
    answers.shares[index * shares..][..shares].fill(0.0);
}

/// The bodies of the arm in a posture, and the columns that were nearest to them last.
struct Search<'a> {
    state: CellState<'a>,
    base_from_path: IsometryMatrix3<f64>,
    likely: Vec<Option<[usize; 2]>>,
}

impl Search<'_> {
    /// The least distance of the bodies from the stock at these joint positions, rad (m), if it is below `limit`, m.
    fn nearest(&mut self, remaining: &RemainingStock, joints: &[f64], limit: f64) -> Option<Clearance> {
        self.state.set_joints(joints);
        let cell: &Cell = self.state.cell();
        let path_from_base = self.base_from_path.inverse();
        let (mut limit, mut best) = (limit, None);
        // The tool first: it is nearest to the stock most often.
        for (index, body) in cell.arm().iter().enumerate().rev() {
            if body.role == Role::Cutter || body.attachment == Attachment::Base {
                continue;
            }
            let path_from_body = path_from_base * self.state.base_from_body()[index];
            let own = BodyNearStock::new(&body.shape, &path_from_body);
            let Some(found) = remaining.nearest(&own, limit, self.likely[index]) else {
                continue;
            };
            self.likely[index] = Some(found.cell);
            limit = found.nearest.distance;
            best = Some(Clearance {
                nearest: Nearest {
                    points: found.nearest.points.map(|point| self.base_from_path * point),
                    ..found.nearest
                },
                bodies: [index, cell.stock_index()],
            });
        }
        best
    }
}
