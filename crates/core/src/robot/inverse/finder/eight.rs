//! Eight postures of a pose at once: joint positions and verification by forward kinematics.

use super::super::super::forward_of_eight::{ForwardOfEight, JointsOfEight, MOST_JOINTS};
use super::super::super::model::Robot;
use super::super::super::unreachable::Unreachable;
use super::super::verify::{Miss, Requested};
use super::dependence::{FindDependence, is_dependent};
use super::positions::{ChainPositions, find_joints};
use crate::numbers::{Backend, Eight, Real, Work, vector_in_lane};

/// Joint positions and forward kinematics of eight postures, and how far they are from the requested pose.
#[derive(Clone, Debug)]
pub(super) struct EightPostures {
    /// Joint positions of the arm; those of one with fewer joints come first.
    joints: [Eight; MOST_JOINTS],
    forward: ForwardOfEight,
    misses: [Eight; 3],
    /// A length of the arm, m.
    length: f64,
}

impl EightPostures {
    /// Working memory for an arm of this length (m) on this many joints of a rail.
    pub fn new(joints: usize, length: f64) -> EightPostures {
        EightPostures {
            joints: [Eight::default(); MOST_JOINTS],
            forward: ForwardOfEight::with_rail(joints),
            misses: [Eight::default(); 3],
            length,
        }
    }

    /// The joint positions at these chain positions, and their forward kinematics.
    pub fn find(&mut self, robot: &Robot, from: &ChainPositions<'_>, requested: &Requested) {
        Backend::fastest().run(FindPostures {
            robot,
            from,
            requested,
            found: self,
        });
    }

    /// Whether the `joints` revolute joints of the arm are nearly dependent in each posture.
    pub fn dependent(&self, joints: usize) -> [bool; 8] {
        let mut dependence = Eight::default();
        Backend::fastest().run(FindDependence {
            axes: self.forward.axes_of_arm(joints),
            flange: &self.forward.flange()[3],
            length: self.length,
            found: &mut dependence,
        });
        dependence.0.map(is_dependent)
    }

    /// Joint positions of the arm, which has `joints` of them, in posture `lane`.
    pub fn joints(&self, joints: usize, lane: usize) -> impl Iterator<Item = f64> + '_ {
        self.joints[..joints].iter().map(move |joint| joint.0[lane])
    }

    /// Forward kinematics from the joint positions.
    pub fn forward(&self) -> &ForwardOfEight {
        &self.forward
    }

    /// Verifies posture `lane`.
    pub fn verify(&self, lane: usize) -> Result<(), Unreachable> {
        let [away, sine, cosine] = &self.misses;
        Miss {
            away: away.0[lane],
            sine: sine.0[lane],
            cosine: cosine.0[lane],
        }
        .verify()
    }
}

struct FindPostures<'a> {
    robot: &'a Robot,
    from: &'a ChainPositions<'a>,
    requested: &'a Requested,
    found: &'a mut EightPostures,
}

impl Work<f64> for FindPostures<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let FindPostures {
            robot,
            from,
            requested,
            found,
        } = self;
        let arm = &mut found.joints[..from.theta.len()];
        find_joints::<R>(robot, from, arm);
        let joints = JointsOfEight { rail: from.rail, arm };
        found.forward.find::<R>(robot, joints);
        let [x, y, z, origin] = found.forward.flange();
        let [away, sine, cosine] = &mut found.misses;
        let requested = requested.in_lanes::<R>();
        for i in 0..8 {
            R::step();
            let reached = [
                vector_in_lane(x, i),
                vector_in_lane(y, i),
                vector_in_lane(z, i),
                vector_in_lane(origin, i),
            ];
            let miss = Miss::between(reached, requested);
            away.set(i, miss.away);
            sine.set(i, miss.sine);
            cosine.set(i, miss.cosine);
        }
    }
}
