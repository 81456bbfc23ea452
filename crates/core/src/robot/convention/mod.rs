//! Which sign, zero, coupling, base height or tool frame of a robot file disagrees with its pendant?
//!
//! Joint positions and tool poses read from the pendant are compared with what the file makes of the same joints. If
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
//! A change counts 1, one with a free value of more than one number or of a joint's zero counts 2; the least count
//! wins. Not tried: other lengths of links, other axes, calibrated arms, zeros of several joints off by any value.
//!
//! In reading order: [`change`] (what may differ), [`frames`] (base, flange and unit from the readings), [`search`].

pub mod change;
pub mod frames;
pub mod search;

pub use change::Change;
pub use search::{Explanation, Inspection, NotInspected, Verdict, inspect};

use super::model::Robot;
use crate::frame::Isometry;

/// What a pendant shows: joint positions as it counts them (rad, m) and the tool in the frame it counts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// One a joint.
    pub joints: Vec<f64>,
    /// Pose of the tool.
    pub reference_from_tool: Isometry,
}

/// How far a position (m) and an orientation (rad) lie apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Apart {
    /// Distance, m.
    pub metres: f64,
    /// Angle, rad.
    pub radians: f64,
}

impl Apart {
    /// How far two poses lie apart.
    pub fn between(a: &Isometry, b: &Isometry) -> Apart {
        Apart {
            metres: (a.translation.vector - b.translation.vector).norm(),
            radians: a.rotation.angle_to(&b.rotation),
        }
    }

    fn is_within(&self, bound: &Apart) -> bool {
        self.metres <= bound.metres && self.radians <= bound.radians
    }

    fn or_worse(self, other: Apart) -> Apart {
        Apart {
            metres: self.metres.max(other.metres),
            radians: self.radians.max(other.radians),
        }
    }
}

/// What is compared.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The robot as its file has it.
    pub robot: &'a Robot,
    /// The frame that the pendant is believed to count from, in base.
    pub base_from_reference: &'a Isometry,
    /// Flange to tool centre point of the readings.
    pub flange_from_tool: &'a Isometry,
    /// What the pendant shows; each with as many joints as the robot.
    pub readings: &'a [Reading],
    /// How far a reading may lie from its prediction and still agree.
    pub within: Apart,
}

#[cfg(test)]
mod tests;
