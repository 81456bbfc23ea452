//! Which part of a measured circle comes from what? Scale, squareness, where it lies, steps at reversals, cyclic error.
//!
//! In reading order: [`term`] (what each makes of the radius), [`fit`](mod@fit) (all of them at once, by least squares), `trust`
//! (how sure they are), [`cyclic`] (the period that the residuals repeat with).

pub mod cyclic;
pub mod fit;
pub mod term;
pub(super) mod trust;

pub use cyclic::{periods, strongest_period};
pub use fit::{Asked, Part, Parts, parts};
pub use term::{Axis, Reversal, Step, Term, Wave, of_axes};
