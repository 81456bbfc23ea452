//! A branch of a block of poses: joint positions, margins, and whether it reaches each pose.

use crate::numbers::{BLOCK, Plane};
use crate::robot::Singularity;

/// What is known of a branch at a point, as a number.
pub(in crate::kernel::lanes) mod state {
    /// It reaches the pose.
    pub const REACHED: f64 = 0.0;
    /// It does not reach the pose.
    pub const UNREACHED: f64 = 1.0;
    /// Lanes cannot decide it: singular, at the end of the reach, or Newton's iteration ends in another branch.
    pub const UNDECIDED: f64 = 2.0;
}

/// One branch of a block of poses.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct BranchPlanes {
    /// Joint positions, rad, one plane per joint.
    pub joints: Vec<Plane<f64>>,
    /// Smallest distance to a joint limit, and the joint, without those of a rail, which do not count either.
    pub margin: Plane<f64>,
    pub nearest: Plane<f64>,
    /// One of [`state`].
    pub state: Plane<f64>,
    /// The singularity that it is near to: see [`singularity`].
    pub singularity: Plane<f64>,
}

impl BranchPlanes {
    /// Memory for this many joints.
    pub fn of(joints: usize) -> BranchPlanes {
        BranchPlanes {
            joints: vec![[0.0; BLOCK]; joints],
            margin: [0.0; BLOCK],
            nearest: [0.0; BLOCK],
            state: [state::UNREACHED; BLOCK],
            singularity: [0.0; BLOCK],
        }
    }

    /// Takes all points of another branch of the same arm.
    pub fn copy_from(&mut self, other: &BranchPlanes) {
        self.joints.copy_from_slice(&other.joints);
        self.margin = other.margin;
        self.nearest = other.nearest;
        self.state = other.state;
        self.singularity = other.singularity;
    }

    /// Takes point `i` of another branch.
    pub fn take(&mut self, other: &BranchPlanes, i: usize) {
        for (joint, from) in self.joints.iter_mut().zip(&other.joints) {
            joint[i] = from[i];
        }
        self.margin[i] = other.margin[i];
        self.nearest[i] = other.nearest[i];
        self.state[i] = other.state[i];
        self.singularity[i] = other.singularity[i];
    }
}

/// The singularity of [`BranchPlanes::singularity`].
pub(in crate::kernel::lanes) fn singularity(number: f64) -> Option<Singularity> {
    match number as u32 {
        1 => Some(Singularity::Wrist),
        2 => Some(Singularity::Elbow),
        3 => Some(Singularity::Shoulder),
        _ => None,
    }
}
