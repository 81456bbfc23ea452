//! Parts of a measured circle: scale, squareness, position, steps at reversals, cyclic error.
//!
//! In reading order: `samples` (what is fitted), [`term`] (effect of each on the radius), [`fit`](mod@fit) (all of them
//! at once, by least squares), `trust` (their uncertainties), [`cyclic`] (the period of the residuals).

pub mod cyclic;
pub mod fit;
pub(super) mod samples;
pub mod term;
pub(super) mod trust;

pub use cyclic::{periods, strongest_period};
pub use fit::{Part, Parts, PartsOptions, parts};
pub use term::{Axis, Reversal, Step, Term, Wave, of_axes};
