//! SensorRecord forces: a dynamometer file, from its text to its numbers, tables and picture.
//!
//! ```text
//! file -> SensorRecord (axes of the sensor) -> treat: drift off, low-pass, turns -> ForcesAnswer, tables, picture
//! ```
//!
//! Reading and treatment are those of a study whose load was measured: [`armill_study::measured`].
//! [`answer`](mod@answer): the values of the result. [`output`]: its tables and pictures.

pub mod answer;
pub mod output;

pub use answer::{ForcesAnswer, RangeAnswer, SummaryAnswer, answer};
