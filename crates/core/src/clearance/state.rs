//! The bodies of a cell with the arm in one posture: their distances.

use nalgebra::{IsometryMatrix3, Point3};

use super::bounds::Capsule;
use super::cell::{Cell, Clearance, PlacedCell, Role, Still, matrix};
use super::nearest::Nearest;
use super::shape::Placed;
use crate::frame::Isometry;
use crate::robot::deflected_arm::attachment_frame;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::{Attachment, Robot};

/// The bodies of a cell with the arm in one posture. Made once, used for any number of postures.
#[derive(Clone, Debug)]
pub struct CellState<'a> {
    cell: &'a Cell,
    robot: &'a Robot,
    flange_from_tool: IsometryMatrix3<f64>,
    base_from_part: IsometryMatrix3<f64>,
    part_from_base: IsometryMatrix3<f64>,
    frames: Frames,
    /// The frame of each body of the arm.
    base_from_body: Vec<IsometryMatrix3<f64>>,
    /// The capsule around each body of the arm, base.
    hulls: Vec<Capsule>,
    /// Their middles, base.
    middles: Vec<Point3<f64>>,
    queue: Vec<(f64, Check)>,
}

/// A bound that exceeds the demanded clearance by this is not made exact, m.
const WORTH: f64 = 0.02;

/// By how much a clearance exceeds the demanded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Room {
    /// A lower bound, m; exact where it is not kept.
    pub by: f64,
    /// What does not keep it.
    pub conflict: Option<Check>,
}

/// Limits of lower bounds, m.
#[derive(Clone, Copy, Debug)]
struct FillLimits {
    /// Checks with a larger bound are left out.
    queued: f64,
    /// Bounds are refined until they reach this.
    refined: f64,
}

/// Two bodies, or a body and those that stand still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Check {
    OfArm([usize; 2]),
    Obstacles(usize),
    Part(usize),
    Floor(usize),
}

impl<'a> CellState<'a> {
    /// The cell with the arm in no posture yet: at zero.
    pub fn new(placed: PlacedCell<'a>, robot: &'a Robot, flange_from_tool: &Isometry) -> CellState<'a> {
        let PlacedCell { cell, base_from_part } = placed;
        let mut state = CellState {
            cell,
            robot,
            flange_from_tool: matrix(flange_from_tool),
            base_from_part: IsometryMatrix3::identity(),
            part_from_base: IsometryMatrix3::identity(),
            frames: Frames::for_robot(robot),
            base_from_body: vec![IsometryMatrix3::identity(); cell.arm.len()],
            hulls: cell.hulls.clone(),
            middles: cell.hulls.iter().map(|hull| hull.axis.middle()).collect(),
            queue: Vec::new(),
        };
        state.set_part(base_from_part);
        state.set_joints(&vec![0.0; robot.joints().len()]);
        state
    }

    /// Moves the part.
    pub fn set_part(&mut self, base_from_part: &Isometry) {
        self.base_from_part = matrix(base_from_part);
        self.part_from_base = self.base_from_part.inverse();
    }

    /// Moves the arm to these joint positions, rad (m), in the convention of the robot file.
    pub fn set_joints(&mut self, joints: &[f64]) {
        forward_into(self.robot, joints, &mut self.frames);
        let base_from_tool = self.frames.base_from_flange * self.flange_from_tool;
        for (index, body) in self.cell.arm.iter().enumerate() {
            let frame = attachment_frame(body.attachment, &self.frames, &base_from_tool)
                * self.cell.attachment_from_body[index];
            self.hulls[index] = self.cell.hulls[index].moved(&frame);
            self.middles[index] = self.hulls[index].axis.middle();
            self.base_from_body[index] = frame;
        }
    }

    /// The bodies.
    pub(super) fn cell(&self) -> &'a Cell {
        self.cell
    }

    /// The robot.
    pub(super) fn robot(&self) -> &'a Robot {
        self.robot
    }

    /// Distance of the tool centre point from the flange, m.
    pub(super) fn tool_length(&self) -> f64 {
        self.flange_from_tool.translation.vector.norm()
    }

    /// The capsule around each body of the arm, base.
    pub fn hulls(&self) -> &[Capsule] {
        &self.hulls
    }

    /// The frames of the bodies of the arm in base, in the order of [`Cell::arm`].
    pub fn base_from_body(&self) -> &[IsometryMatrix3<f64>] {
        &self.base_from_body
    }

    /// Shape of a body of the arm where it is, base.
    pub(super) fn placed(&self, body: usize) -> Placed {
        self.cell.arm[body].shape.placed(&self.base_from_body[body])
    }

    /// The nearest points of two bodies of the arm, if they are not farther apart than `limit`.
    pub(super) fn nearest_of_arm(&self, pair: [usize; 2], limit: f64) -> Option<Nearest> {
        let [first, second] = pair.map(|index| self.placed(index));
        first.nearest(&second, limit)
    }

    /// The least distance of all pairs of bodies that are checked; `None` where it is above `limit`, m, or where there is none.
    pub fn clearance(&mut self, limit: f64) -> Option<Clearance> {
        self.measured(limit, 0.0).map(|(found, _)| found)
    }

    /// The two bodies that come nearest to a conflict with the demanded clearance `least`, m, and the clearance that they keep: their
    /// distance, or for a pair that is near by design its distance and `least` unless it touches. `None` where that is above `limit`.
    pub fn demanded_clearance(&mut self, least: f64, limit: f64) -> Option<(Clearance, f64)> {
        self.measured(limit, least)
    }

    /// By how much the clearance exceeds the demanded one, m: a lower bound, at most `enough`. Where it is not kept, that of one of the pairs
    /// that do not; `likely` is the first of these that is looked at.
    pub(super) fn room(&mut self, least: f64, enough: f64, likely: Option<Check>) -> Room {
        if let Some(found) = likely
            .and_then(|check| self.room_of(check, least, 0.0))
            .filter(|room| room.conflict.is_some())
        {
            return found;
        }
        let mut queue = std::mem::take(&mut self.queue);
        queue.clear();
        let limits = FillLimits {
            queued: least + enough,
            refined: least + WORTH.min(enough),
        };
        self.fill(&mut queue, limits, least);
        queue.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut room = Room {
            by: enough,
            conflict: None,
        };
        for (bound, check) in &queue {
            // What follows is at least as far; a bound that is worth more than the exact distance is used as it is.
            if *bound >= least + room.by.min(WORTH) {
                room.by = room.by.min(bound - least);
                break;
            }
            if let Some(found) = self.room_of(*check, least, room.by) {
                room = found;
            }
            if room.conflict.is_some() {
                break;
            }
        }
        self.queue = queue;
        room
    }

    /// By how much the clearance of one check exceeds the demanded one, if that is less than `limit`, m, or it is not kept.
    fn room_of(&self, check: Check, least: f64, limit: f64) -> Option<Room> {
        let more = self.more_of(check, least);
        let distance = self.checked(check, least + limit - more)?.nearest.distance;
        let is_conflict = distance <= 0.0 || distance + more < least;
        // A pair near by design that touches is apart again after the smallest motion.
        let by = match distance > 0.0 {
            true => distance + more - least,
            false => more - least,
        };
        Some(Room {
            by,
            conflict: is_conflict.then_some(check),
        })
    }

    /// The pair with the least kept clearance, and that clearance; pairs that are near by design keep `more` than their distance, m.
    fn measured(&mut self, limit: f64, more: f64) -> Option<(Clearance, f64)> {
        let mut queue = std::mem::take(&mut self.queue);
        queue.clear();
        let limits = FillLimits {
            queued: limit,
            refined: limit,
        };
        self.fill(&mut queue, limits, more);
        queue.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<(Clearance, f64)> = None;
        for (bound, check) in &queue {
            let limit = best.map_or(limit, |(_, kept)| kept);
            if *bound > limit || best.is_some() && *bound >= limit {
                break;
            }
            let more = self.more_of(*check, more);
            let Some(found) = self.checked(*check, limit - more.min(limit)) else {
                continue;
            };
            let distance = found.nearest.distance;
            let kept = if distance > 0.0 { distance + more } else { 0.0 };
            if best.is_none_or(|(_, least)| kept < least) {
                best = Some((found, kept));
            }
            // Nothing is nearer than in contact.
            if kept == 0.0 {
                break;
            }
        }
        self.queue = queue;
        best
    }

    /// `more` for a pair that is near by design, else 0.
    fn more_of(&self, check: Check, more: f64) -> f64 {
        match check {
            Check::OfArm(pair) if more > 0.0 && self.cell.always_near.contains(&pair) => more,
            _ => 0.0,
        }
    }

    /// All checks whose lower bound is not above the limit, with their bounds.
    fn fill(&self, queue: &mut Vec<(f64, Check)>, limits: FillLimits, more: f64) {
        let limit = limits.queued;
        for pair in &self.cell.pairs {
            // Balls around both first, without a root.
            let [from, to] = pair.map(|index| &self.middles[index]);
            let [own, others] = pair.map(|index| self.cell.balls[index]);
            let reach = limit + own + others;
            if (to - from).norm_squared() > reach * reach {
                continue;
            }
            let [first, second] = pair.map(|index| &self.hulls[index]);
            let bound = first.distance(second);
            if bound <= limit {
                // Contact counts as such, whatever a pair may keep.
                let more = self.more_of(Check::OfArm(*pair), more);
                let bound = if bound > 0.0 { bound + more } else { bound };
                queue.push((bound, Check::OfArm(*pair)));
            }
        }
        let joints = self.robot.joints().len();
        for (index, (body, hull)) in self.cell.arm.iter().zip(&self.hulls).enumerate() {
            if body.attachment == Attachment::Base {
                continue;
            }
            let floor = self.cell.floor.as_ref();
            if let Some(floor) = floor.filter(|floor| floor.is_checked(body.attachment, joints)) {
                let bound = floor.height_of(hull);
                if bound <= limit {
                    queue.push((bound, Check::Floor(index)));
                }
            }
            if let Some(still) = &self.cell.obstacles {
                let bound = still.field.bound_of(hull, &still.bodies, limits.refined);
                if bound <= limit {
                    queue.push((bound, Check::Obstacles(index)));
                }
            }
            if let Some(still) = self.cell.part.as_ref().filter(|_| body.role != Role::Cutter) {
                let in_part = hull.moved(&self.part_from_base);
                let bound = still.field.bound_of(&in_part, &still.bodies, limits.refined);
                if bound <= limit {
                    queue.push((bound, Check::Part(index)));
                }
            }
        }
    }

    /// The distance of one check, if it is not above `limit`.
    fn checked(&self, check: Check, limit: f64) -> Option<Clearance> {
        let arm = self.cell.arm.len();
        match check {
            Check::OfArm(bodies) => {
                let nearest = self.nearest_of_arm(bodies, limit)?;
                Some(Clearance { nearest, bodies })
            }
            Check::Obstacles(body) => {
                let is_checked = |other: usize| !self.cell.ridden_on.contains(&[other, body]);
                let obstacles = self.cell.obstacles.as_ref()?;
                let (nearest, other) = obstacles.nearest(&self.placed(body), limit, is_checked)?;
                Some(Clearance {
                    nearest,
                    bodies: [body, arm + other],
                })
            }
            Check::Part(body) => {
                let obstacles = self.cell.obstacles.as_ref().map_or(0, Still::len);
                let frame = self.part_from_base * self.base_from_body[body];
                let own = self.cell.arm[body].shape.placed(&frame);
                let (nearest, other) = self.cell.part.as_ref()?.nearest(&own, limit, |_| true)?;
                Some(Clearance {
                    nearest: nearest.moved(&self.base_from_part),
                    bodies: [body, arm + obstacles + other],
                })
            }
            Check::Floor(body) => {
                let nearest = self.cell.floor.as_ref()?.nearest(&self.placed(body));
                let still = [&self.cell.obstacles, &self.cell.part];
                let before: usize = still.into_iter().flatten().map(Still::len).sum();
                (nearest.distance <= limit).then_some(Clearance {
                    nearest,
                    bodies: [body, arm + before],
                })
            }
        }
    }
}
