//! Eight postures of a pose at once: joint positions and verification by forward kinematics.

use super::super::super::forward_of_eight::{ForwardOfEight, JointsOfEight};
use super::super::super::model::Robot;
use super::super::super::unreachable::Unreachable;
use super::super::verify::{Miss, Requested};
use super::positions::find_joints;
use crate::numbers::{Backend, Eight, Real, Work, vector_in_lane};

/// Joint positions and forward kinematics of eight postures, and how far they are from the requested pose.
#[derive(Clone, Debug)]
pub(super) struct EightPostures {
    /// Joint positions of the arm.
    joints: [Eight; 6],
    forward: ForwardOfEight,
    misses: [Eight; 3],
}

/// What eight postures are made from.
pub(super) struct ChainPositions<'a> {
    /// Chain positions of each joint of the arm.
    pub theta: &'a [Eight; 6],
    /// Joint positions of its rail.
    pub rail: &'a [f64],
    /// Joint positions of the pose before.
    pub near: Option<&'a [f64]>,
}

impl EightPostures {
    /// Working memory for an arm on this many joints of a rail.
    pub fn with_rail(joints: usize) -> EightPostures {
        EightPostures {
            joints: [Eight::default(); 6],
            forward: ForwardOfEight::with_rail(joints),
            misses: [Eight::default(); 3],
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

    /// Joint positions of the arm in posture `lane`.
    pub fn joints(&self, lane: usize) -> [f64; 6] {
        self.joints.map(|joint| joint.0[lane])
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
        find_joints::<R>(robot, from.rail, from.theta, from.near, &mut found.joints);
        let joints = JointsOfEight {
            rail: from.rail,
            arm: &found.joints,
        };
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
