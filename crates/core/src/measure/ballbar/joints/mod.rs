//! Which joints of an arm turn back where on the circle, and how much play has each? Backlash from circular tests.
//!
//! ```text
//! dr(a, s) = smooth(a) + sum over joints of  n(a) . s_i(a) u_i(a, s; b_i)        s: the way round, u_i: link minus motor
//! ```
//!
//! In reading order: [`circle`] (a circle in the cell, and the arm that follows it), [`reversal`] (where joints turn back),
//! [`effect`] (what a gap makes of the radius), `nuisance` (what of the radius is no backlash), [`fit`](mod@fit) (all gaps at once, from any number
//! of circles, and which of them cannot be told apart), [`plan`] (circles that tell them apart).
//!
//! Theory, and what the numbers leave out: `docs/theory/joint-backlash.md`.

pub mod circle;
pub mod effect;
pub mod fit;
mod nuisance;
pub mod plan;
pub mod reversal;

pub use circle::{Circle, Followed, NotFollowed, follow};
pub use fit::{Asked, Gap, Gaps, Observed, gaps};
pub use plan::{Candidate, Domain, Normal, Plan, PlanAsked, Proposed, propose};
pub use reversal::JointReversal;
