//! What is the error of a cut circle made of, and how much of it do we understand?
//!
//! Every part of the error is a radial deviation over the angle, outwards positive, with a scatter beside it:
//!
//! ```text
//! dr(a) = b(a) +- s(a)        predicted: b = sum of b_i, s^2 = sum of s_i^2        measured: m(a)
//! ```
//!
//! In reading order: [`turn`] (the angles at which all is told), [`datum`] (centre and radius, which are no form),
//! [`contribution`] (one part, and their sums: plain and as functions), [`unloaded`](mod@unloaded) (what a ball-bar saw, in parts),
//! [`agreement`](mod@agreement) (how much of the measured error a curve explains), [`waves`] (amplitude and phase, wave by wave),
//! [`balance`](mod@balance) (all of it together).
//!
//! Theory: `docs/theory/budget.md`.

pub mod agreement;
pub mod balance;
pub mod contribution;
pub mod datum;
pub mod turn;
pub mod unloaded;
pub mod waves;

pub use agreement::{Agreement, agreement};
pub use balance::{Balance, Comparison, Share, balance};
pub use contribution::{Contribution, Origin, Sums};
pub use datum::{Datum, Removed};
pub use turn::{Turn, TurnError};
pub use unloaded::{Unloaded, unloaded};
pub use waves::{ToldPair, WavePair, least_amplitude, pairs, turns_as_good};
