//! Identification of joint compliances from load tests: load the tool, measure its displacement.
//!
//! In reading order: [`unknown`] (the springs to be identified), [`load_test`] (loads and readings),
//! [`effect`] (effect of each unknown in a test), `bounded` (least squares without negative springs), [`prior`]
//! (prior knowledge), [`fit`] (the most likely springs), `spread` (their uncertainties),
//! [`outcome`] (the result, with leave-one-out prediction), [`errors`] (of the displacements), [`units`]
//! (plausibility), [`mod@plan`] (design of tests).
//!
//! Theory, sources and alternatives: `docs/theory/identification.md`.

mod bounded;
pub mod effect;
pub mod errors;
pub mod fit;
pub mod load_test;
pub mod outcome;
pub mod plan;
pub mod prior;
#[cfg(test)]
mod small_arm;
mod spread;
pub mod units;
pub mod unknown;

pub use errors::{Errors, displacement_errors};
pub use fit::{Loss, Method, Points};
pub use load_test::{LoadTest, Measured, Reading};
pub use outcome::{FoundSpring, Identified, Refusal, TestOutcome, identify};
pub use plan::{Floor, PlanQuestion, PlannedTest, plan};
pub use prior::Prior;
pub use spread::Spread;
pub use units::measured_over_typical;
pub use unknown::{Role, Unknown};
