//! Files of a laser tracker and of a controller as one table of measured poses.
//!
//! In reading order: `files` (what is read), `together` (one pose for each row; reflectors of the base), [`answer`](mod@answer) (numbers for people and programs),
//! `table` (the poses as CSV, for `calibrate`, `learn` and `pose-accuracy`).
//!
//! Method of three reflectors: [`armill_core::measure::reflectors`].

pub mod answer;
mod files;
mod table;
mod together;

pub use answer::{TrackerAnswer, answer};
pub use files::{Files, JointUnit};
pub use table::table;
pub use together::{Together, together};
