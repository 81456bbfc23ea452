//! The bodies of a cell with the arm in one posture: their distances.

use nalgebra::{IsometryMatrix3, Point3};

use super::bounds::Capsule;
use super::cell::{ArmBody, Cell, Clearance, PlacedCell, Still, matrix};
use super::decided::{BodyAmong, Excess};
use super::field::Thresholds;
use super::floor::Floor;
use super::nearest::Nearest;
use super::shape::{Placed, Shape};
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

/// By how much a clearance exceeds the demanded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Room {
    /// A lower bound, m, where it is kept, else an upper bound: no smaller motion changes the decision.
    pub by: f64,
    /// What does not keep it.
    pub conflict: Option<Check>,
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
    pub fn cell(&self) -> &'a Cell {
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

    /// By how much the clearance exceeds the demanded one, m: at most `enough`. Where it is not kept, that of one of the pairs
    /// that do not; `likely` is the first that is checked.
    pub(super) fn room(&self, least: f64, enough: f64, likely: Option<Check>) -> Room {
        let mut room = Room {
            by: enough,
            conflict: None,
        };
        let pairs = self.cell.pairs.iter().map(|pair| Check::OfArm(*pair));
        // The tool first: it is what is in the way most often.
        let still = (0..self.cell.arm.len())
            .rev()
            .flat_map(|body| [Check::Part(body), Check::Obstacles(body), Check::Floor(body)]);
        for check in likely.into_iter().chain(still).chain(pairs) {
            let Some(excess) = self.excess(check, least, room.by) else {
                continue;
            };
            if !excess.is_kept {
                return Room {
                    by: excess.by,
                    conflict: Some(check),
                };
            }
            room.by = room.by.min(excess.by);
        }
        room
    }

    /// By how much the clearance of one check exceeds the demanded one; `None` where that is known to be above `enough`, or it is not checked.
    fn excess(&self, check: Check, least: f64, enough: f64) -> Option<Excess> {
        let least = if self.is_near_by_design(check) { 0.0 } else { least };
        let thresholds = Thresholds {
            least,
            enough: least + enough,
        };
        let (still, body, others_from_body) = match check {
            Check::OfArm(pair) => return self.excess_of_pair(pair, thresholds),
            Check::Floor(body) => return self.excess_over_floor(body, thresholds),
            Check::Obstacles(body) if self.rides(body) => return self.measured_excess(check, thresholds),
            Check::Obstacles(body) => (self.cell.obstacles.as_ref()?, body, self.base_from_body[body]),
            Check::Part(body) => (
                self.cell.part.as_ref()?,
                body,
                self.part_from_base * self.base_from_body[body],
            ),
        };
        let ArmBody {
            attachment, shape, ..
        } = &self.cell.arm[body];
        let is_apart = matches!(check, Check::Part(_)) && !self.cell.meets_part(body);
        if *attachment == Attachment::Base || is_apart {
            return None;
        }
        let hull = match check {
            Check::Part(_) => self.hulls[body].moved(&self.part_from_base),
            _ => self.hulls[body],
        };
        Some(still.excess(
            &BodyAmong {
                shape,
                pieces: self.cell.pieces[body].as_ref(),
                others_from_body,
                hull,
            },
            thresholds,
        ))
    }

    /// Whether a body rides on an obstacle, which the field of distances contains.
    fn rides(&self, body: usize) -> bool {
        self.cell.ridden_on.iter().any(|[_, rider]| *rider == body)
    }

    /// The same of a check, measured.
    fn measured_excess(&self, check: Check, thresholds: Thresholds) -> Option<Excess> {
        let found = self.checked(check, thresholds.enough)?;
        Some(Excess::measured(found.nearest.distance, thresholds.least))
    }

    /// The same of a body of the arm above the floor.
    fn excess_over_floor(&self, body: usize, thresholds: Thresholds) -> Option<Excess> {
        let floor = self.floor_of(body)?;
        let bound = floor.height_of(&self.hulls[body]);
        if bound > thresholds.enough {
            return None;
        }
        match Excess::kept(bound, thresholds.least) {
            Some(kept) => Some(kept),
            None => self.measured_excess(Check::Floor(body), thresholds),
        }
    }

    /// The floor, if this body is checked against it.
    fn floor_of(&self, body: usize) -> Option<&'a Floor> {
        let attachment = self.cell.arm[body].attachment;
        let floor = self.cell.floor.as_ref()?;
        floor
            .is_checked(attachment, self.robot.joints().len())
            .then_some(floor)
    }

    /// The same of two bodies of the arm.
    fn excess_of_pair(&self, pair: [usize; 2], thresholds: Thresholds) -> Option<Excess> {
        let least = thresholds.least;
        let bound = self.bound_of_pair(pair, thresholds.enough)?;
        let shapes = pair.map(|body| &self.cell.arm[body].shape);
        let is_capsule = |shape: &&Shape| matches!(shape, Shape::Capsule(_));
        if (bound >= least && bound > 0.0) || shapes.iter().all(is_capsule) {
            return Some(Excess::measured(bound, least));
        }
        // The mesh of more triangles has the field.
        let triangles = |shape: &Shape| match shape {
            Shape::Mesh(mesh) => mesh.triangles().len(),
            _ => 0,
        };
        let [still, moving] = match shapes.map(triangles) {
            [first, second] if first >= second => pair,
            _ => [pair[1], pair[0]],
        };
        let Some(field) = &self.cell.own_fields[still] else {
            return self.measured_excess(Check::OfArm(pair), thresholds);
        };
        let still_from_base = self.base_from_body[still].inverse();
        Some(field.excess(
            &BodyAmong {
                shape: &self.cell.arm[moving].shape,
                pieces: self.cell.pieces[moving].as_ref(),
                others_from_body: still_from_base * self.base_from_body[moving],
                hull: self.hulls[moving].moved(&still_from_base),
            },
            thresholds,
        ))
    }

    /// Distance of the capsules around two bodies of the arm, m, negative where they overlap, if it is not above `limit`.
    fn bound_of_pair(&self, pair: [usize; 2], limit: f64) -> Option<f64> {
        // Balls around both first, without a root.
        let [from, to] = pair.map(|index| &self.middles[index]);
        let [own, others] = pair.map(|index| self.cell.balls[index]);
        let reach = limit + own + others;
        if (to - from).norm_squared() > reach * reach {
            return None;
        }
        let [first, second] = pair.map(|index| &self.hulls[index]);
        Some(first.distance(second)).filter(|bound| *bound <= limit)
    }

    /// The pair with the least kept clearance, and that clearance; pairs that are near by design keep `more` than their distance, m.
    fn measured(&mut self, limit: f64, more: f64) -> Option<(Clearance, f64)> {
        let mut queue = std::mem::take(&mut self.queue);
        queue.clear();
        self.fill(&mut queue, limit, more);
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
        if self.is_near_by_design(check) { more } else { 0.0 }
    }

    fn is_near_by_design(&self, check: Check) -> bool {
        match check {
            Check::OfArm(pair) => self.cell.always_near.contains(&pair),
            Check::Part(body) => self.cell.near_part.contains(&body),
            Check::Obstacles(_) | Check::Floor(_) => false,
        }
    }

    /// All checks whose lower bound is not above the limit, with their bounds.
    fn fill(&self, queue: &mut Vec<(f64, Check)>, limit: f64, more: f64) {
        for pair in &self.cell.pairs {
            if let Some(bound) = self.bound_of_pair(*pair, limit) {
                // Contact counts as such, whatever a pair may keep.
                let more = self.more_of(Check::OfArm(*pair), more);
                let bound = if bound > 0.0 { bound + more } else { bound };
                queue.push((bound, Check::OfArm(*pair)));
            }
        }
        for (index, (body, hull)) in self.cell.arm.iter().zip(&self.hulls).enumerate() {
            if body.attachment == Attachment::Base {
                continue;
            }
            if let Some(floor) = self.floor_of(index) {
                let bound = floor.height_of(hull);
                if bound <= limit {
                    queue.push((bound, Check::Floor(index)));
                }
            }
            if let Some(still) = &self.cell.obstacles {
                let bound = still.field.bound_of(hull, &still.bodies, limit);
                if bound <= limit {
                    queue.push((bound, Check::Obstacles(index)));
                }
            }
            let meets_part = self.cell.meets_part(index);
            if let Some(still) = self.cell.part.as_ref().filter(|_| meets_part) {
                let in_part = hull.moved(&self.part_from_base);
                let bound = still.field.bound_of(&in_part, &still.bodies, limit);
                let more = self.more_of(Check::Part(index), more);
                let bound = if bound > 0.0 { bound + more } else { bound };
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
