//! What all measurements of one arm say of it, and what to measure next.
//!
//! In reading order: `measurements` (the files of a journal), `learning` (the arm after each of them), [`answer`](mod@answer) (numbers for people and
//! programs), `output` (the robot file).
//!
//! Method, formulas and sources: [`armill_core::update`].

pub mod answer;
mod learning;
mod measurements;
mod output;

pub use answer::{JournalAnswer, answer};
pub use learning::{Learning, Planned, Question, learn};
pub use measurements::{Measurements, read};
pub use output::robot_file;
