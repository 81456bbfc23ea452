//! Error budget of a milled circle: its contributions, and how much of the measured error they explain.
//!
//! Every part of the error is a radial deviation over the angle, outwards positive, with its scatter:
//!
//! ```text
//! dr(a) = b(a) +- s(a)        predicted: b = sum of b_i, s^2 = sum of s_i^2        measured: m(a)
//! ```
//!
//! In reading order: [`turn`] (the common angles), [`datum`] (centre and radius, which are not form),
//! [`contribution`] (one part, and their sums: plain and as functions), [`unloaded`](mod@unloaded) (a ball-bar test, in
//! parts), [`agreement`](mod@agreement) (share of the measured error that a curve explains), [`waves`] (amplitude and
//! phase, wave by wave), [`balance`](mod@balance) (the whole budget).
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
pub use waves::{ReportedPair, WavePair, least_amplitude, pairs, turns_as_good};
