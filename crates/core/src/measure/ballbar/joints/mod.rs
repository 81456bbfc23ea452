//! Reversals of the joints of an arm on a circle, and their backlash from circular tests.
//!
//! ```text
//! dr(a, s) = smooth(a) + sum over joints of  n(a) . s_i(a) u_i(a, s; b_i)        s: direction, u_i: link minus motor
//! ```
//!
//! In reading order: `along` (a joint along a circle), [`reversal`] (angles where joints reverse), [`circle`] (a circle
//! in the cell, and the arm that follows it), `joint_run` (a joint along the samples of a run), [`effect`] (effect of a backlash on the radius), `nuisance` (parts of the
//! radius that are not backlash), [`fit`](mod@fit) (all joints at once, from any number of circles, and which of them
//! are not identifiable), [`plan`] (circles that make them identifiable).
//!
//! Theory, and limits of the method: `docs/theory/joint-backlash.md`.

mod along;
pub mod circle;
pub mod effect;
pub mod fit;
mod joint_run;
mod nuisance;
pub mod plan;
pub mod reversal;

pub use circle::{Circle, Followed, NotFollowed, follow};
pub use fit::{BacklashFit, BacklashOptions, EstimatedBacklash, Observed, fit_backlash};
pub use plan::{Candidate, CirclePlanOptions, Domain, Normal, Plan, Proposed, propose};
pub use reversal::JointReversal;
