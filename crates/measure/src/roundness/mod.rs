//! Roundness: points of a profile, from their file to the four circles of the standard.
//!
//! ```text
//! file -> MeasuredProfile -> evaluate: plane, circles, filter, harmonics, outliers -> RoundnessAnswer, table, picture
//! ```
//!
//! [`evaluate`](mod@evaluate): the circles of a profile, and its other quantities. [`answer`](mod@answer): the values
//! of the numbers. [`output`]: table and picture of it.

pub mod answer;
pub mod evaluate;
pub mod output;

pub use answer::{CircleAnswer, RoundnessAnswer, ZoneAnswer, answer};
pub use evaluate::{Question, RoundnessEvaluation, evaluate};
