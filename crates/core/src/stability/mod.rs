//! Stability of milling, and the vibration under the teeth.
//!
//! Read in this order: [`named_mode`] (modes at the tip), [`cut_of_any_depth`] (the cut at any depth), `loop_gain` with `cubic` (displacement by
//! the force that a displacement makes), `branches` (that over the frequency), [`zeroth_order`] (boundary from mean directional
//! factors), [`lobes`] (boundary over the spindle speed), [`multi_frequency`] (with harmonics of the directional factors),
//! [`discretisation`] with `modal_step` and `arnoldi` (multipliers of one period of the teeth), [`probability`] (uncertainty of the boundary),
//! [`forced`] (vibration under the force of the teeth, error of the surface).
//!
//! Modes are given at the tip, in the feed frame: x along the feed, y to its left, z from part to spindle. SI units; angular
//! frequencies and spindle speeds in rad/s. Theory: `docs/theory/stability.md`.

mod arnoldi;
mod branches;
mod cubic;
pub mod cut_of_any_depth;
pub mod discretisation;
pub mod forced;
pub mod lobes;
mod loop_gain;
mod modal_step;
pub mod multi_frequency;
pub mod named_mode;
pub mod probability;
pub mod zeroth_order;

pub use cut_of_any_depth::CutOfAnyDepth;
pub use discretisation::{Floquet, Instability, PeriodSteps};
pub use forced::{Forced, SurfaceError, ToothForces, WallSide};
pub use lobes::{Lobe, StabilityLobes};
pub use named_mode::{ModeUncertainty, NamedMode};
pub use probability::BoundaryUncertainty;
pub use zeroth_order::{Boundary, ZerothOrder};

/// Cuts of published examples, for the tests.
#[cfg(test)]
mod examples;
