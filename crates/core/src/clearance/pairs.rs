//! How a cell is made: which pairs of bodies are checked.
//!
//! Pairs that touch in every posture do so by design, or by the size of their bodies: they are left out. Pairs that never keep the demanded
//! clearance are near by design: they only must not touch. Both are decided by postures spread over the joint limits.

use super::bounds::Capsule;
use super::cell::{ArmBody, Cell, FixedBody, PlacedCell, Role, Still, matrix};
use super::floor::joints_in_front;
use super::shape::Placed;
use super::state::CellState;
use crate::frame::Isometry;
use crate::robot::{Attachment, Robot};

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
        let hulls: Vec<Capsule> = arm.iter().map(|body| body.shape.hull()).collect();
        let mut cell = Cell {
            attachment_from_body: arm
                .iter()
                .map(|body| matrix(&body.attachment_from_body))
                .collect(),
            balls: hulls
                .iter()
                .map(|hull| hull.axis.half_length() + hull.radius)
                .collect(),
            pieces: arm.iter().map(Still::pieces).collect(),
            own_fields: arm.iter().map(Still::of_mesh).collect(),
            hulls,
            arm,
            pairs,
            always_in_contact: Vec::new(),
            always_near: Vec::new(),
            near_part: Vec::new(),
            apart_from_part: Vec::new(),
            obstacles: Still::of(still.iter().filter(|body| !body.is_part)),
            part: Still::of(still.iter().filter(|body| body.is_part)),
            floor: None,
            ridden_on: Vec::new(),
        };
        cell.leave_out_permanent_contacts(robot, flange_from_tool);
        cell
    }

    fn leave_out_permanent_contacts(&mut self, robot: &Robot, flange_from_tool: &Isometry) {
        let touching = self.always_within(robot, flange_from_tool, 0.0);
        self.pairs.retain(|pair| !touching.contains(pair));
        self.always_in_contact = touching;
        let in_front = joints_in_front(robot);
        let carries =
            |body: &ArmBody| matches!(body.attachment, Attachment::Joint(joint) if joint < in_front);
        let ridden_on = self.touched_obstacles(robot, flange_from_tool, carries);
        self.ridden_on = ridden_on;
    }

    /// The cell for this demanded clearance, m: pairs of bodies of the arm that never keep it are near by design, and only must not
    /// touch. What stands next to an arm that holds the part is not near by design.
    pub fn for_clearance(self, robot: &Robot, flange_from_tool: &Isometry, least: f64) -> Cell {
        let mut always_near = self.always_within(robot, flange_from_tool, least);
        if robot.chain().ground().part_is_in_hand() {
            let is_link = |body: &usize| self.arm[*body].role == Role::Link;
            always_near.retain(|pair| pair.iter().all(is_link));
        }
        Cell { always_near, ..self }
    }

    /// The cell without a check of these bodies of the arm (indices) against the part.
    pub fn apart_from_part(self, bodies: Vec<usize>) -> Cell {
        Cell {
            apart_from_part: bodies,
            ..self
        }
    }

    /// The cell for this demanded clearance, m, of an arm that holds the part there: links that never keep it from the part are near by
    /// design, as those of the wrist, and only must not touch.
    pub fn with_part_in_hand(self, robot: &Robot, base_from_part: &Isometry, least: f64) -> Cell {
        let mut near_part = self.always_near_part(robot, base_from_part, least);
        near_part.retain(|body| self.arm[*body].role == Role::Link);
        Cell { near_part, ..self }
    }

    /// Bodies of the arm that are not farther from the part, which is there, than `limit`, m, in any sampled posture. Only those whose
    /// place does not depend on the tool.
    pub fn always_near_part(&self, robot: &Robot, base_from_part: &Isometry, limit: f64) -> Vec<usize> {
        let Some(part) = &self.part else {
            return Vec::new();
        };
        self.always_near_in(robot, base_from_part, |own| {
            part.nearest(own, limit, |_| true)
                .is_some_and(|(found, _)| found.distance <= limit)
        })
    }

    /// Bodies of the arm, checked against the part, that are near something in this frame in every sampled posture. Only those
    /// whose place does not depend on the tool.
    pub(crate) fn always_near_in(
        &self,
        robot: &Robot,
        base_from_frame: &Isometry,
        is_near: impl Fn(&Placed) -> bool,
    ) -> Vec<usize> {
        let frame_from_base = matrix(&base_from_frame.inverse());
        let checked = |body: &usize| {
            let of_arm = &self.arm[*body];
            !matches!(of_arm.attachment, Attachment::Base | Attachment::Tool)
                && of_arm.role != Role::Cutter
                && !self.apart_from_part.contains(body)
        };
        let bodies = (0..self.arm.len()).filter(checked).collect();
        self.in_every_posture(robot, &Isometry::identity(), bodies, |state, body| {
            let frame = frame_from_base * state.base_from_body()[*body];
            is_near(&self.arm[*body].shape.placed(&frame))
        })
    }

    /// Checked pairs of bodies of the arm that are not farther apart than `limit`, m, in any sampled posture.
    fn always_within(&self, robot: &Robot, flange_from_tool: &Isometry, limit: f64) -> Vec<[usize; 2]> {
        self.in_every_posture(robot, flange_from_tool, self.pairs.clone(), |state, pair| {
            let found = state.nearest_of_arm(*pair, limit);
            found.is_some_and(|found| found.distance <= limit)
        })
    }

    /// Obstacles that touch a body of the arm in every sampled posture, such as one that encloses the robot: index among the obstacles, and the
    /// body of the arm. Not those that what carries the arm rides on.
    pub fn permanent_obstacles(&self, robot: &Robot, flange_from_tool: &Isometry) -> Vec<[usize; 2]> {
        let moving = |body: &ArmBody| body.attachment != Attachment::Base;
        let mut found = self.touched_obstacles(robot, flange_from_tool, moving);
        found.retain(|pair| !self.ridden_on.contains(pair));
        found
    }

    /// Bodies of the arm that touch the floor in every sampled posture.
    pub fn always_on_floor(&self, robot: &Robot, flange_from_tool: &Isometry) -> Vec<usize> {
        let Some(floor) = &self.floor else {
            return Vec::new();
        };
        let joints = robot.joints().len();
        let checked = |body: &usize| floor.is_checked(self.arm[*body].attachment, joints);
        let bodies = (0..self.arm.len()).filter(checked).collect();
        self.in_every_posture(robot, flange_from_tool, bodies, |state, body| {
            floor.nearest(&state.placed(*body)).distance <= 0.0
        })
    }

    /// Obstacles that touch one of these bodies of the arm in every sampled posture: index among the obstacles, and the body of the arm.
    fn touched_obstacles(
        &self,
        robot: &Robot,
        flange_from_tool: &Isometry,
        of_bodies: impl Fn(&ArmBody) -> bool,
    ) -> Vec<[usize; 2]> {
        let Some(still) = &self.obstacles else {
            return Vec::new();
        };
        let bodies = (0..self.arm.len()).filter(|body| of_bodies(&self.arm[*body]));
        let pairs = bodies.flat_map(|body| (0..still.len()).map(move |obstacle| [obstacle, body]));
        self.in_every_posture(
            robot,
            flange_from_tool,
            pairs.collect(),
            |state, [obstacle, body]| {
                let found = state.placed(*body).nearest(&still.bodies[*obstacle], 0.0);
                found.is_some_and(|found| found.distance <= 0.0)
            },
        )
    }

    /// Those of the candidates for which this is so in every sampled posture.
    fn in_every_posture<T>(
        &self,
        robot: &Robot,
        flange_from_tool: &Isometry,
        mut candidates: Vec<T>,
        is_so: impl Fn(&CellState<'_>, &T) -> bool,
    ) -> Vec<T> {
        let placed = PlacedCell {
            cell: self,
            base_from_part: &Isometry::identity(),
        };
        let mut state = CellState::new(placed, robot, flange_from_tool);
        for sample in 1..=SAMPLES {
            if candidates.is_empty() {
                break;
            }
            state.set_joints(&sampled_joints(robot, sample));
            candidates.retain(|candidate| is_so(&state, candidate));
        }
        candidates
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

#[cfg(test)]
mod tests;
