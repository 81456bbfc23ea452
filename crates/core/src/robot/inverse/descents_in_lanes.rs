//! A few descents to one pose at once, a lane each, by the rules of `descent`.
//!
//! A lane whose descent has ended takes the next start. Lanes do not depend on each other, and differ from a descent by
//! itself by rounding alone; a descent that leads to a posture that is known ends early.

use nalgebra::Vector6;

use super::super::chain::Chain;
use super::super::unreachable::Unreachable;
use super::descent::outcome;
use super::kind::ENOUGH;
use super::step_in_lanes::{Step, UnderWay, WIDTH};
use super::verify::Requested;
use crate::numbers::{Backend, Eight, Lanes};

/// The descents under way to one pose.
#[derive(Clone, Debug)]
pub(super) struct DescentsInLanes {
    backend: Backend,
    /// Origin of the flange, with the axes of the last joint.
    goal: Requested,
    length: f64,
    lanes: Box<UnderWay>,
    /// Number of the start of each lane; none where it is free.
    starts: [Option<usize>; WIDTH],
    known: KnownPostures,
}

/// Postures that no descent is needed for.
#[derive(Clone, Debug, Default)]
struct KnownPostures {
    count: usize,
    /// Chain positions of eight each; no number where there is none.
    theta: Vec<[Eight; ENOUGH]>,
}

/// A descent that has ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Descended {
    /// The best chain positions; of a chain with fewer joints, the first ones.
    pub theta: [f64; ENOUGH],
    /// Whether they reach the pose, or how far they are from it.
    pub reached: Result<Reached, Unreachable>,
}

/// Where a descent leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reached {
    /// To the pose.
    Pose,
    /// To a posture that is known: it ended before.
    Known,
}

impl DescentsInLanes {
    /// For a chain of at most six joints.
    pub fn new(chain: &Chain) -> DescentsInLanes {
        DescentsInLanes {
            backend: Backend::fastest(),
            goal: Requested::default(),
            length: chain.length(),
            lanes: Box::default(),
            starts: [None; WIDTH],
            known: KnownPostures::default(),
        }
    }

    /// Gives up the descents under way, and goes to another pose.
    pub fn aim_at(&mut self, chain: &Chain, goal: &Requested) {
        self.goal = *goal;
        if let (_, Some(rotation)) = chain.last_joint_from_flange().parts() {
            self.goal.axes *= rotation.transpose();
        }
        self.starts = [None; WIDTH];
        self.known.count = 0;
        self.known.theta.clear();
    }

    /// Ends descents to the posture at these chain positions as soon as they lead there.
    pub fn know(&mut self, theta: &[f64]) {
        let lane = self.known.count % 8;
        if lane == 0 {
            self.known.theta.push([Lanes([f64::NAN; 8]); ENOUGH]);
        }
        self.known.count += 1;
        if let Some(last) = self.known.theta.last_mut() {
            for (joint, all) in last.iter_mut().enumerate() {
                all.0[lane] = theta.get(joint).copied().unwrap_or_default();
            }
        }
    }

    /// A lane without a descent.
    pub fn free_lane(&self) -> Option<usize> {
        self.starts.iter().position(Option::is_none)
    }

    /// Begins at the chain positions `theta`, in a free lane.
    pub fn begin(&mut self, lane: usize, start: usize, theta: &[f64]) {
        self.starts[lane] = Some(start);
        self.lanes.begin(lane, theta);
    }

    /// One step of every lane; `ended` receives the descents that end with it, and the numbers of their starts.
    pub fn step(&mut self, chain: &Chain, mut ended: impl FnMut(usize, Descended)) {
        self.backend.run(Step {
            chain,
            goal: &self.goal,
            known: &self.known.theta,
            length: self.length,
            lanes: &mut self.lanes,
        });
        for lane in 0..WIDTH {
            let Some(start) = self.starts[lane] else { continue };
            let is_known = self.lanes.known.0[lane] == 1.0;
            if is_known || self.lanes.ended.0[lane] == 1.0 {
                self.starts[lane] = None;
                ended(start, self.descended(lane, is_known));
            }
        }
    }

    fn descended(&self, lane: usize, known: bool) -> Descended {
        let mut rows = self.lanes.error.iter().flatten().map(|row| row.0[lane]);
        let error = Vector6::from_fn(|_, _| rows.next().unwrap_or_default());
        Descended {
            theta: self.lanes.theta.map(|joint| joint.0[lane]),
            reached: if known {
                Ok(Reached::Known)
            } else {
                outcome(&error, self.length).map(|()| Reached::Pose)
            },
        }
    }
}

#[cfg(test)]
mod tests;
