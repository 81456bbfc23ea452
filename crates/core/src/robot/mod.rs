//! Which arm is it, and where does it stand?
//!
//! In reading order: [`chain`] (elementary motions and their inner form), [`joint`] (limits, signs, zeros,
//! compliance), [`model`] (the robot as one value), [`forward`] (joint positions to frames), [`jacobian`]
//! (screws at the tool), [`posture`] (branches and why a point may be out of reach), [`inverse`] (tool pose
//! to every posture).

pub mod chain;
pub mod forward;
pub mod inverse;
pub mod jacobian;
pub mod joint;
pub mod model;
pub mod posture;

pub use chain::{Amount, Axis, Chain, Motion};
pub use joint::{Joint, JointCompliance, Limits};
pub use model::{Robot, RobotError};
pub use posture::{Branch, BranchPattern, Posture, PostureName, Sides, Singularity, Unreachable};
