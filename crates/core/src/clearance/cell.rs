//! The cell: bodies that move with the arm, and bodies that stand still.
//!
//! | pair | checked |
//! |---|---|
//! | bodies of the arm on the same or on adjacent links | no: they touch by design |
//! | bodies in contact in every posture, or which the robot file states to be apart in all | no |
//! | all other bodies that move relative to each other | yes |
//! | a cutter and the part | no: it cuts it |
//! | a holder and the part, the arm and anything that stands still | yes |

use nalgebra::IsometryMatrix3;

use super::bounds::{Bounds, Capsule};
use super::field::Field;
use super::nearest::Nearest;
use super::shape::{Placed, Shape};
use crate::frame::Isometry;
use crate::robot::deflected_arm::attachment_frame;
use crate::robot::forward::{Frames, forward_into};
use crate::robot::inverse::tool_on;
use crate::robot::{Attachment, Robot};

/// What a body of the arm is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A link of the robot.
    Link,
    /// Spindle, holder, or another part of the tool that must not touch the part.
    Holder,
    /// The cutter, which may touch the part.
    Cutter,
}

/// A body that moves with the arm, or stands under it.
#[derive(Clone, Debug)]
pub struct ArmBody {
    /// Its name, for people.
    pub name: String,
    /// What it is attached to.
    pub attachment: Attachment,
    /// From the frame of the attachment to that of its shape.
    pub attachment_from_body: Isometry,
    /// Its shape, in its own frame.
    pub shape: Shape,
    /// What it is.
    pub role: Role,
}

/// A body that stands still.
#[derive(Clone, Debug)]
pub struct FixedBody {
    /// Its name, for people.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Its position: in the base of the robot, of the part in the frame of the part.
    pub frame_from_body: Isometry,
    /// Whether it is the part, or its stock.
    pub is_part: bool,
}

/// The bodies of a cell.
#[derive(Clone, Debug)]
pub struct Cell {
    arm: Vec<ArmBody>,
    attachment_from_body: Vec<IsometryMatrix3<f64>>,
    hulls: Vec<Capsule>,
    /// Pairs of bodies of the arm that are checked.
    pairs: Vec<[usize; 2]>,
    /// Pairs of bodies of the arm that are in contact in every posture, and so not checked.
    always_in_contact: Vec<[usize; 2]>,
    obstacles: Option<Still>,
    part: Option<Still>,
}

/// Bodies that stand still relative to each other, in their common frame.
#[derive(Clone, Debug)]
struct Still {
    names: Vec<String>,
    bodies: Vec<Placed>,
    field: Field,
}

impl Still {
    fn of<'a>(bodies: impl Iterator<Item = &'a FixedBody>) -> Option<Still> {
        let (mut names, mut placed, mut around) = (Vec::new(), Vec::new(), Bounds::EMPTY);
        for body in bodies {
            let frame = matrix(&body.frame_from_body);
            names.push(body.name.clone());
            around = around.joined(&body.shape.bounds().moved(&frame, &frame.rotation.matrix().abs()));
            placed.push(body.shape.placed(&frame));
        }
        (!names.is_empty()).then(|| Still {
            names,
            bodies: placed,
            field: Field::around(&around),
        })
    }

    /// The nearest of the bodies to a body in the same frame, with its index.
    fn nearest(&self, own: &Placed, limit: f64) -> Option<(Nearest, usize)> {
        let mut best: Option<(Nearest, usize)> = None;
        for (index, other) in self.bodies.iter().enumerate() {
            let limit = best.map_or(limit, |(best, _)| best.distance);
            if own.hull().bound_of_balls(other.hull()) > limit {
                continue;
            }
            if let Some(nearest) = own.nearest(other, limit)
                && best.is_none_or(|(best, _)| nearest.distance < best.distance)
            {
                best = Some((nearest, index));
            }
        }
        best
    }
}

/// The least distance in a posture, and what it is between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Distance and points, base.
    pub nearest: Nearest,
    /// The two bodies: indices of [`Cell::name`].
    pub bodies: [usize; 2],
}

/// Postures that decide whether two bodies are always in contact.
const SAMPLES: usize = 200;

impl Cell {
    /// The cell of an arm with these bodies of its own, which never meets in the pairs of `apart` (indices of `arm`), and these
    /// that stand still.
    pub fn new(
        robot: &Robot,
        flange_from_tool: &Isometry,
        arm: Vec<ArmBody>,
        apart: &[[usize; 2]],
        still: &[FixedBody],
    ) -> Cell {
        let joints = robot.joints().len();
        let mut pairs = Vec::new();
        for second in 0..arm.len() {
            for first in 0..second {
                let pair = [first, second];
                let bodies = pair.map(|index| &arm[index]);
                if may_meet(bodies, joints) && !apart.contains(&pair) && !apart.contains(&[second, first]) {
                    pairs.push(pair);
                }
            }
        }
        let mut cell = Cell {
            attachment_from_body: arm
                .iter()
                .map(|body| matrix(&body.attachment_from_body))
                .collect(),
            hulls: arm.iter().map(|body| body.shape.hull()).collect(),
            arm,
            pairs,
            always_in_contact: Vec::new(),
            obstacles: Still::of(still.iter().filter(|body| !body.is_part)),
            part: Still::of(still.iter().filter(|body| body.is_part)),
        };
        cell.leave_out_permanent_contacts(robot, flange_from_tool);
        cell
    }

    fn leave_out_permanent_contacts(&mut self, robot: &Robot, flange_from_tool: &Isometry) {
        let mut touching = self.pairs.clone();
        let placed = PlacedCell {
            cell: self,
            base_from_part: &Isometry::identity(),
        };
        let mut state = CellState::new(placed, robot, flange_from_tool);
        for sample in 1..=SAMPLES {
            if touching.is_empty() {
                break;
            }
            state.set_joints(&sampled_joints(robot, sample));
            touching.retain(|pair| {
                state
                    .nearest_of_arm(*pair, 0.0)
                    .is_some_and(|found| found.distance <= 0.0)
            });
        }
        self.pairs.retain(|pair| !touching.contains(pair));
        self.always_in_contact = touching;
    }

    /// Obstacles that touch a body of the arm in every sampled posture, such as one that encloses the robot: index among the obstacles, and the
    /// body of the arm.
    pub fn permanent_obstacles(&self, robot: &Robot, flange_from_tool: &Isometry) -> Vec<[usize; 2]> {
        let Some(still) = &self.obstacles else {
            return Vec::new();
        };
        let moving = |body: &usize| self.arm[*body].attachment != Attachment::Base;
        let bodies = (0..self.arm.len()).filter(moving);
        let mut touching: Vec<[usize; 2]> = bodies
            .flat_map(|body| (0..still.bodies.len()).map(move |obstacle| [obstacle, body]))
            .collect();
        let placed = PlacedCell {
            cell: self,
            base_from_part: &Isometry::identity(),
        };
        let mut state = CellState::new(placed, robot, flange_from_tool);
        for sample in 1..=SAMPLES {
            if touching.is_empty() {
                break;
            }
            state.set_joints(&sampled_joints(robot, sample));
            touching.retain(|[obstacle, body]| {
                let found = state.placed(*body).nearest(&still.bodies[*obstacle], 0.0);
                found.is_some_and(|found| found.distance <= 0.0)
            });
        }
        touching
    }

    /// Name of a body of a [`Clearance`]: those of the arm first, then obstacles, then the part.
    pub fn name(&self, index: usize) -> &str {
        let still = [&self.obstacles, &self.part].into_iter().flatten();
        let arm = self.arm.iter().map(|body| &body.name);
        let mut names = arm.chain(still.flat_map(|still| &still.names));
        names.nth(index).map_or("", String::as_str)
    }

    /// The bodies of the arm.
    pub fn arm(&self) -> &[ArmBody] {
        &self.arm
    }

    /// Largest distance of a body of the arm from the origin of its attachment, m.
    pub(super) fn reach_of_body(&self, body: usize) -> f64 {
        let hull = self.hulls[body].moved(&self.attachment_from_body[body]);
        let ends = [hull.axis.from, hull.axis.to].map(|end| end.coords.norm());
        ends[0].max(ends[1]) + hull.radius
    }

    /// Pairs of bodies of the arm that are in contact in every posture: these are not checked.
    pub fn always_in_contact(&self) -> &[[usize; 2]] {
        &self.always_in_contact
    }

    /// Whether any two bodies are checked at all.
    pub fn has_pairs(&self) -> bool {
        let moving = self.arm.iter().any(|body| body.attachment != Attachment::Base);
        !self.pairs.is_empty() || (moving && (self.obstacles.is_some() || self.part.is_some()))
    }
}

/// Whether two bodies of an arm with this many joints are checked.
fn may_meet(bodies: [&ArmBody; 2], joints: usize) -> bool {
    let link = |body: &ArmBody| body.attachment.rank(joints).min(joints);
    let [first, second] = bodies.map(link);
    let links_apart = first.abs_diff(second);
    match bodies.map(|body| body.role) {
        [Role::Link, Role::Link] => links_apart > 1,
        _ => links_apart > 0,
    }
}

/// Joint positions spread over the limits (rad, m): the sequence of Halton.
fn sampled_joints(robot: &Robot, sample: usize) -> Vec<f64> {
    const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    let joint = |(index, joint): (usize, &crate::robot::Joint)| {
        let [lower, upper] = joint
            .limits
            .map_or([-std::f64::consts::PI, std::f64::consts::PI], |limits| {
                [limits.lower, limits.upper]
            });
        lower + (upper - lower) * radical_inverse(sample, PRIMES[index % PRIMES.len()])
    };
    robot.joints().iter().enumerate().map(joint).collect()
}

/// The digits of a number behind the point, in reverse.
fn radical_inverse(mut number: usize, base: usize) -> f64 {
    let (mut value, mut place) = (0.0, 1.0 / base as f64);
    while number > 0 {
        value += (number % base) as f64 * place;
        number /= base;
        place /= base as f64;
    }
    value
}

fn matrix(isometry: &Isometry) -> IsometryMatrix3<f64> {
    nalgebra::convert(*isometry)
}

/// A cell with its part at a place.
#[derive(Clone, Copy, Debug)]
pub struct PlacedCell<'a> {
    /// The bodies.
    pub cell: &'a Cell,
    /// The frame of the part in base.
    pub base_from_part: &'a Isometry,
}

/// The bodies of a cell with the arm in one posture. Made once, used for any number of postures.
#[derive(Clone, Debug)]
pub struct CellState<'a> {
    cell: &'a Cell,
    robot: &'a Robot,
    flange_from_tool: Isometry,
    base_from_part: IsometryMatrix3<f64>,
    part_from_base: IsometryMatrix3<f64>,
    frames: Frames,
    /// The frame of each body of the arm.
    base_from_body: Vec<IsometryMatrix3<f64>>,
    /// The capsule around each body of the arm, base.
    hulls: Vec<Capsule>,
    queue: Vec<(f64, Check)>,
}

/// Two bodies, or a body and those that stand still.
#[derive(Clone, Copy, Debug)]
enum Check {
    OfArm([usize; 2]),
    Obstacles(usize),
    Part(usize),
}

impl<'a> CellState<'a> {
    /// The cell with the arm in no posture yet: at zero.
    pub fn new(placed: PlacedCell<'a>, robot: &'a Robot, flange_from_tool: &Isometry) -> CellState<'a> {
        let PlacedCell { cell, base_from_part } = placed;
        let mut state = CellState {
            cell,
            robot,
            flange_from_tool: *flange_from_tool,
            base_from_part: IsometryMatrix3::identity(),
            part_from_base: IsometryMatrix3::identity(),
            frames: Frames::for_robot(robot),
            base_from_body: vec![IsometryMatrix3::identity(); cell.arm.len()],
            hulls: cell.hulls.clone(),
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
        let base_from_tool = matrix(&tool_on(&self.frames, &self.flange_from_tool));
        for (index, body) in self.cell.arm.iter().enumerate() {
            let frame = attachment_frame(body.attachment, &self.frames, &base_from_tool)
                * self.cell.attachment_from_body[index];
            self.hulls[index] = self.cell.hulls[index].moved(&frame);
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
    fn placed(&self, body: usize) -> Placed {
        self.cell.arm[body].shape.placed(&self.base_from_body[body])
    }

    /// The nearest points of two bodies of the arm, if they are not farther apart than `limit`.
    fn nearest_of_arm(&self, pair: [usize; 2], limit: f64) -> Option<Nearest> {
        let [first, second] = pair.map(|index| self.placed(index));
        first.nearest(&second, limit)
    }

    /// The least distance of all pairs of bodies that are checked; `None` where it is above `limit`, m, or where there is none.
    pub fn clearance(&mut self, limit: f64) -> Option<Clearance> {
        let mut queue = std::mem::take(&mut self.queue);
        queue.clear();
        self.fill(&mut queue, limit);
        queue.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<Clearance> = None;
        for (bound, check) in &queue {
            let limit = best.map_or(limit, |best| best.nearest.distance);
            if *bound > limit || best.is_some() && *bound >= limit {
                break;
            }
            if let Some(found) = self.checked(*check, limit)
                && best.is_none_or(|best| found.nearest.distance < best.nearest.distance)
            {
                best = Some(found);
            }
        }
        self.queue = queue;
        best
    }

    /// All checks whose lower bound is not above `limit`, with their bounds.
    fn fill(&self, queue: &mut Vec<(f64, Check)>, limit: f64) {
        for pair in &self.cell.pairs {
            let [first, second] = pair.map(|index| &self.hulls[index]);
            if first.bound_of_balls(second) > limit {
                continue;
            }
            let bound = first.distance(second);
            if bound <= limit {
                queue.push((bound, Check::OfArm(*pair)));
            }
        }
        for (index, (body, hull)) in self.cell.arm.iter().zip(&self.hulls).enumerate() {
            if body.attachment == Attachment::Base {
                continue;
            }
            if let Some(still) = &self.cell.obstacles {
                let bound = still.field.bound_of(hull, &still.bodies, limit);
                if bound <= limit {
                    queue.push((bound, Check::Obstacles(index)));
                }
            }
            if let Some(still) = self.cell.part.as_ref().filter(|_| body.role != Role::Cutter) {
                let in_part = hull.moved(&self.part_from_base);
                let bound = still.field.bound_of(&in_part, &still.bodies, limit);
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
                let (nearest, other) = self.cell.obstacles.as_ref()?.nearest(&self.placed(body), limit)?;
                Some(Clearance {
                    nearest,
                    bodies: [body, arm + other],
                })
            }
            Check::Part(body) => {
                let obstacles = self.cell.obstacles.as_ref().map_or(0, |still| still.bodies.len());
                let frame = self.part_from_base * self.base_from_body[body];
                let own = self.cell.arm[body].shape.placed(&frame);
                let (nearest, other) = self.cell.part.as_ref()?.nearest(&own, limit)?;
                Some(Clearance {
                    nearest: nearest.moved(&self.base_from_part),
                    bodies: [body, arm + obstacles + other],
                })
            }
        }
    }
}

#[cfg(test)]
mod tests;
