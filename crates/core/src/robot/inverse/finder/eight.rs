//! Eight postures of a pose at once: joint positions and verification by forward kinematics.

use super::super::super::eight_frames::FramesOfEight;
use super::super::super::forward::Frames;
use super::super::super::model::Robot;
use super::super::super::unreachable::Unreachable;
use super::super::verify::{Miss, Requested};
use super::positions::find_joints;
use crate::numbers::{Backend, Eight, Real, Work, vector_of_eight};

/// Joint positions and frames of eight postures, and how far they are from the requested pose. Memory is reused.
#[derive(Clone, Debug)]
pub(super) struct EightPostures {
    /// Joint positions, one entry per joint.
    joints: Vec<Eight>,
    frames: FramesOfEight,
    misses: [Eight; 3],
}

/// What eight postures are made from.
pub(super) struct ChainPositions<'a> {
    /// Index of the first joint of `theta`.
    pub first: usize,
    /// Chain positions of each joint from there on.
    pub theta: &'a [Eight],
    /// Joint positions of the joints before `first`, and any of the others.
    pub home: &'a [f64],
    /// Joint positions of the pose before.
    pub near: Option<&'a [f64]>,
}

impl EightPostures {
    /// Working memory for this robot.
    pub fn for_robot(robot: &Robot) -> EightPostures {
        let count = robot.joints().len();
        EightPostures {
            joints: vec![Eight::default(); count],
            frames: FramesOfEight::for_joints(count),
            misses: [Eight::default(); 3],
        }
    }

    /// The joint positions at these chain positions, and their frames.
    pub fn find(&mut self, robot: &Robot, from: &ChainPositions<'_>, requested: &Requested) {
        for (joint, home) in self.joints.iter_mut().zip(&from.home[..from.first]) {
            *joint = Eight([*home; 8]);
        }
        Backend::fastest().run(FindPostures {
            robot,
            from,
            requested,
            found: self,
        });
    }

    /// Joint positions of posture `lane`.
    pub fn joints(&self, lane: usize) -> impl Iterator<Item = f64> {
        self.joints.iter().map(move |joint| joint.0[lane])
    }

    /// Frames of posture `lane`.
    pub fn frames(&self, lane: usize, frames: &mut Frames) {
        self.frames.get(lane, frames);
    }

    /// Verifies posture `lane`.
    pub fn verify(&self, lane: usize) -> Result<(), Unreachable> {
        let [away, sine, cosine] = self.misses.map(|miss| miss.0[lane]);
        Miss { away, sine, cosine }.verify()
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
        find_joints::<R>(robot, from.first, from.theta, from.near, &mut found.joints);
        found.frames.find::<R>(robot, &found.joints);
        let [x, y, z, origin] = found.frames.flange();
        let [away, sine, cosine] = &mut found.misses;
        let requested = requested.in_lanes::<R>();
        for i in 0..8 {
            R::step();
            let reached = [
                vector_of_eight(x, i),
                vector_of_eight(y, i),
                vector_of_eight(z, i),
                vector_of_eight(origin, i),
            ];
            let miss = Miss::between(reached, requested);
            away.set(i, miss.away);
            sine.set(i, miss.sine);
            cosine.set(i, miss.cosine);
        }
    }
}
