//! A joint move: whether the clearance is kept on the whole way, not at samples alone.
//!
//! Joints move in proportion. No point of a body moves farther than
//!
//! ```text
//! sum over the joints k before it of  |dtheta_k| D_k        (a prismatic joint: |dtheta_k|)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `dtheta_k` | motion of joint k over the part of the move | rad (m) |
//! | `D_k` | largest distance of the body from the origin of joint k in any posture: the lengths of all links between, and its own size | m |
//!
//! Where the clearance is `c` and `least` is demanded, the arm may go on until this sum is `c - least`, and is measured again there
//! (conservative advancement). Steps are at least [`RESOLUTION`], which the clearance may be less in between.
//! Source: Mirtich 1996, *Impulse-based dynamic simulation of rigid body systems*.

use super::cell::Clearance;
use super::state::CellState;
use crate::robot::{Attachment, Joint, Robot};

/// A clearance may be less than demanded by this between two places that were measured, m.
pub const RESOLUTION: f64 = 1e-4;
/// Rounding of a clearance, m.
const ROUNDING: f64 = 1e-9;

impl CellState<'_> {
    /// The first place on the joint move between these positions, rad (m), where two bodies are nearer than `least`, m; `None` if there is
    /// none. The arm is left where it was measured last.
    pub fn conflict_on_move(&mut self, from: &[f64], to: &[f64], least: f64) -> Option<Clearance> {
        let length = self.longest_way(from, to);
        let mut part = 0.0;
        loop {
            let q: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + (b - a) * part).collect();
            self.set_joints(&q);
            // Farther bodies cannot come nearer than demanded on the rest of the way.
            let rest = length * (1.0 - part);
            let found = self.demanded_clearance(least, least + rest);
            let room = found.map_or(rest, |(_, kept)| kept - least);
            if let Some((found, kept)) = found
                && (room < -ROUNDING || kept == 0.0)
            {
                return Some(found);
            }
            if room >= rest || part >= 1.0 {
                return None;
            }
            part = (part + room.max(RESOLUTION) / length).min(1.0);
        }
    }

    /// An upper bound of the way of any point of a body on the move, m.
    fn longest_way(&self, from: &[f64], to: &[f64]) -> f64 {
        let robot = self.robot();
        let ways = (0..self.cell().arm().len()).map(|body| {
            let moved = self.joints_before(body);
            let of_joint = |joint: usize| {
                let by = (robot.theta(joint, to) - robot.theta(joint, from)).abs();
                match robot.slides(joint) {
                    true => by,
                    false => by * self.farthest(body, joint, [from, to]),
                }
            };
            (0..moved).map(of_joint).sum::<f64>()
        });
        ways.fold(0.0, f64::max)
    }

    /// Of each joint the largest distance of a body that it moves from its origin in any posture inside the limits, m; of a prismatic joint 1.
    /// No point of the arm moves farther than the sum of these by the motions of the joints, rad (m).
    pub(super) fn reach_of_joints(&self) -> Vec<f64> {
        let robot = self.robot();
        let joints = robot.joints();
        let at_limit = |lower: bool| -> Vec<f64> {
            let limit = |joint: &Joint| match joint.limits {
                Some(limits) if lower => limits.lower,
                Some(limits) => limits.upper,
                None => f64::INFINITY,
            };
            joints.iter().map(limit).collect()
        };
        let limits = [at_limit(true), at_limit(false)];
        let of_joint = |joint: usize| {
            if robot.slides(joint) {
                return 1.0;
            }
            let moved = (0..self.cell().arm().len()).filter(|body| self.joints_before(*body) > joint);
            let reach = |body: usize| self.farthest(body, joint, [&limits[0], &limits[1]]);
            moved.map(reach).fold(0.0, f64::max)
        };
        (0..joints.len()).map(of_joint).collect()
    }

    /// Number of joints that move a body.
    fn joints_before(&self, body: usize) -> usize {
        let joints = self.robot().joints().len();
        self.cell().arm()[body].attachment.rank(joints).min(joints)
    }

    /// Largest distance of a body from the origin of a joint, for prismatic joints up to these positions, m.
    fn farthest(&self, body: usize, joint: usize, positions: [&[f64]; 2]) -> f64 {
        let robot = self.robot();
        let links = robot.chain().links();
        let link = |index: usize| {
            let travel = |q: &&[f64]| robot.theta(index, q).abs();
            let slid = match robot.slides(index) {
                true => positions.iter().map(travel).fold(0.0, f64::max),
                false => 0.0,
            };
            links[index].before.parts().0.norm() + slid
        };
        let between: f64 = (joint + 1..self.joints_before(body)).map(link).sum();
        between + self.beyond_last_joint(robot, body)
    }

    /// Largest distance of a body from the origin of the joint that it is on, m.
    fn beyond_last_joint(&self, robot: &Robot, body: usize) -> f64 {
        let flange = || robot.chain().last_joint_from_flange().parts().0.norm();
        let to_attachment = match self.cell().arm()[body].attachment {
            Attachment::Base | Attachment::Joint(_) => 0.0,
            Attachment::Flange => flange(),
            Attachment::Tool => flange() + self.tool_length(),
        };
        to_attachment + self.cell().reach_of_body(body)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::arms::{self, Stream};
    use crate::clearance::{ArmBody, Bounds, Capsule, Cell, FixedBody, PlacedCell, Role, Segment, Shape};
    use crate::frame::Isometry;

    fn cell(robot: &Robot) -> Cell {
        let rod = |name: &str, attachment: Attachment, to: [f64; 3]| ArmBody {
            name: name.to_owned(),
            attachment,
            attachment_from_body: Isometry::identity(),
            shape: Shape::Capsule(Capsule {
                axis: Segment {
                    from: Point3::origin(),
                    to: to.into(),
                },
                radius: 0.05,
            }),
            role: Role::Link,
        };
        let post = FixedBody {
            name: "post".to_owned(),
            shape: Shape::Box(Bounds::of([
                Point3::new(0.5, 0.3, 0.0),
                Point3::new(0.6, 0.4, 1.2),
            ])),
            frame_from_body: Isometry::identity(),
            is_part: false,
        };
        let arm = vec![
            rod("upper arm", Attachment::Joint(1), [0.0, 0.0, 0.614]),
            rod("forearm", Attachment::Joint(3), [0.6, 0.0, 0.0]),
            rod("tool", Attachment::Flange, [0.0, 0.0, 0.2]),
        ];
        Cell::new(robot, &Isometry::identity(), arm, &[], &[post])
    }

    #[test]
    fn a_move_is_clear_if_a_thousand_samples_are_and_the_bound_of_the_way_holds() {
        let robot = arms::mh12();
        let cell = cell(&robot);
        let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &Isometry::identity());
        let mut stream = Stream(61);
        let (mut clear, mut blocked) = (0, 0);
        for _ in 0..150 {
            let (from, to) = (stream.joints(&robot), stream.joints(&robot));
            let least = 0.01;
            let mut sampled = f64::INFINITY;
            let mut before: Option<Vec<Capsule>> = None;
            let length = state.longest_way(&from, &to);
            for i in 0..=1000 {
                let part = f64::from(i) / 1000.0;
                let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
                state.set_joints(&q);
                if let Some(found) = state.clearance(0.2) {
                    sampled = sampled.min(found.nearest.distance);
                }
                let hulls: Vec<Capsule> = state.hulls().to_vec();
                for (hull, before) in hulls.iter().zip(before.iter().flatten()) {
                    let moved = (hull.axis.from - before.axis.from)
                        .norm()
                        .max((hull.axis.to - before.axis.to).norm());
                    assert!(moved <= length / 1000.0 + 1e-12);
                }
                before = Some(hulls);
            }
            match state.conflict_on_move(&from, &to, least) {
                Some(found) => {
                    blocked += 1;
                    assert!(found.nearest.distance < least);
                }
                None => {
                    clear += 1;
                    assert!(sampled >= least - RESOLUTION, "{sampled}");
                }
            }
            // A sample that is too near is never overlooked.
            assert!(sampled >= least - RESOLUTION || state.conflict_on_move(&from, &to, least).is_some());
        }
        assert!(clear > 15 && blocked > 15, "{clear} {blocked}");
    }

    #[test]
    fn a_move_that_does_not_move_is_measured_once() {
        let robot = arms::mh12();
        let cell = cell(&robot);
        let mut state = CellState::new(PlacedCell::at_base(&cell), &robot, &Isometry::identity());
        let q = [0.0; 6];
        assert!(state.conflict_on_move(&q, &q, 0.0).is_none());
        assert!(state.conflict_on_move(&q, &q, 1.0).is_some());
    }
}
