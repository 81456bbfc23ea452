//! Learning what the calibrated model leaves of measured positions, and how far that carries to other poses.
//!
//! In reading order: `evidence` (how likely the settings of a Gaussian process are, with the slope), `search` (the most likely
//! ones), [`residual`] (the residual of an arm from its residuals), [`validate`] (errors of poses that were not used:
//! with the nominal, the calibrated and the learnt model).
//!
//! The process itself is [`crate::robot::learnt`]. Theory, sources and limits: `docs/theory/learnt-residual.md`.

mod evidence;
pub mod residual;
mod search;
pub mod validate;

pub use residual::{learn, residuals};
pub use validate::{FewPoses, HeldOut, Models, OtherSetUp, Reduction, held_out, on_other_poses};
