//! Which sign, zero, coupling, base height or tool frame of a robot file disagrees with its pendant?
//!
//! Joint positions and tool poses read from the pendant are compared with the forward kinematics of the file. If
//! they disagree, a closed list of [`Change`]s is searched for the simplest set that explains every reading:
//!
//! `theta_i = s_i sign_i (q_i + sum_j (k_ij + dk_ij) q_j) + offset_i + d_i`
//!
//! | symbol | meaning | tried |
//! |---|---|---|
//! | `s_i` | sign of joint i against the file | 1, -1 |
//! | `d_i` | zero of joint i against the file, rad | quarter turns; any value for one joint |
//! | `dk_32` | coupling of joint 3 to joint 2 against the file | 0, 1, -1 |
//! | base | height of the pendant's base above the file's; shift of it, m | any |
//! | flange | turn of the flange frame against the file's | quarter turns |
//! | unit | positions read in inches | yes, no |
//!
//! The complexity of a change is 1; with a free value of more than one number or of a joint's zero it is 2. The least
//! total wins. Not tried: other lengths of links, other axes, calibrated arms, free zeros of several joints.
//!
//! In reading order: [`change`] (possible changes), [`frames`] (base, flange and unit from the readings), [`search`].

pub mod change;
pub mod frames;
pub mod search;

pub use change::Change;
pub use search::{Explanation, Inspection, NotInspected, Verdict, inspect};

use super::model::Robot;
use crate::frame::Isometry;

/// A reading of a pendant: joint positions (rad, m) and the tool in the pendant's reference frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// One per joint.
    pub joints: Vec<f64>,
    /// Pose of the tool.
    pub reference_from_tool: Isometry,
}

/// Distance and angle between two poses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseDifference {
    /// Distance, m.
    pub metres: f64,
    /// Angle, rad.
    pub radians: f64,
}

impl PoseDifference {
    /// Distance and angle between two poses.
    pub fn between(a: &Isometry, b: &Isometry) -> PoseDifference {
        PoseDifference {
            metres: (a.translation.vector - b.translation.vector).norm(),
            radians: a.rotation.angle_to(&b.rotation),
        }
    }

    fn is_within(&self, bound: &PoseDifference) -> bool {
        self.metres <= bound.metres && self.radians <= bound.radians
    }

    fn or_worse(self, other: PoseDifference) -> PoseDifference {
        PoseDifference {
            metres: self.metres.max(other.metres),
            radians: self.radians.max(other.radians),
        }
    }
}

/// The data of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The robot of the file.
    pub robot: &'a Robot,
    /// The assumed reference frame of the pendant, in base.
    pub base_from_reference: &'a Isometry,
    /// Flange to tool centre point of the readings.
    pub flange_from_tool: &'a Isometry,
    /// The readings; each with as many joints as the robot.
    pub readings: &'a [Reading],
    /// Tolerance of the agreement between a reading and its prediction.
    pub within: PoseDifference,
}

#[cfg(test)]
mod tests;
