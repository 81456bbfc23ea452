//! How much does each joint yield? Found from load tests: push the tool, measure how far it goes.
//!
//! In reading order: [`unknown`] (which springs are asked for), [`load_test`] (what was done and measured),
//! [`effect`] (what each unknown does in a test), `bounded` (least squares without negative springs), [`prior`]
//! (what is known of any arm), [`fit`] (the most likely springs), `spread` (how far they can be trusted),
//! [`outcome`] (all of it, with every test left out once), [`errors`] (of the displacements), [`units`] (are they right?),
//! [`mod@plan`] (which tests tell most).
//!
//! Theory, sources and what was tried: `docs/theory/identification.md`.

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
