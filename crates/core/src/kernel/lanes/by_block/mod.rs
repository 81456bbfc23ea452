//! All stages for many poses, one block after the other.
//!
//! In reading order: `arrays` (input and output), `posture_signs` (the four postures), `batch` (entry point: a prepared
//! question), `steps` (its stages, each on the current block), `aimed` (a block looked into). Whole answers: `points`
//! (ortho-parallel arms, the drives alone), `whole_points` (named branches, the whole model), `written` (their output).
//! Searches: `column` and `loaded_branches`, as the two before. Every posture: `every_branch`.

mod aimed;
mod arrays;
mod batch;
mod column;
mod every_branch;
mod loaded_branches;
mod points;
mod posture_signs;
mod steps;
mod whole_points;
mod written;

pub use arrays::{Arrays, Envelopes, Poses};
pub use batch::Batch;

#[cfg(test)]
pub(super) use aimed::SolvedBlock;
pub(super) use batch::Scratch;
pub(in crate::kernel) use every_branch::EveryBranch;
pub(in crate::kernel) use loaded_branches::{BranchMargins, BranchStatus, LoadedBranches, PointLoads};
pub(in crate::kernel) use points::{POINTS, Points};
pub(super) use posture_signs::{FOUR, signs};
pub(in crate::kernel) use whole_points::WholePoints;
