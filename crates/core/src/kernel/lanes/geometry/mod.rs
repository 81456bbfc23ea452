//! The arm, its question and the tool poses, all in the arm's axes.
//!
//! In reading order: `arm` (geometry, joints, tool), `cosine_limits` (its joint limits as cosines), `prepared` (a
//! question), `aims` (tool poses), `base_axes` (back into base).

mod aims;
mod arm;
mod base_axes;
mod cosine_limits;
mod prepared;

pub(super) use aims::{Aim, Aims, Orientations, Places, Second, aim, aim_still};
pub(super) use arm::{Arm, JointRow, UNLIMITED};
pub(super) use base_axes::BaseAxes;
pub(super) use cosine_limits::CosineLimits;
pub(super) use prepared::Prepared;
