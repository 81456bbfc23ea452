//! All stages for many poses, one block after the other.
//!
//! In reading order: `arrays` (input and output), `posture_signs` (the four postures), `batch` (entry point: a prepared
//! question), `steps` (its stages, each on the current block); `aimed`, `points` and `written` (whole answers), `column` (every
//! posture under one load).

mod aimed;
mod arrays;
mod batch;
mod column;
mod points;
mod posture_signs;
mod steps;
mod written;

pub use arrays::{Arrays, Envelopes, Poses};
pub use batch::Batch;

#[cfg(test)]
pub(super) use aimed::SolvedBlock;
pub(super) use batch::Scratch;
pub(in crate::kernel) use points::{POINTS, Points};
pub(super) use posture_signs::FOUR;
