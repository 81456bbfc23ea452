//! What each command does: options into a question, the answer of `armill-study` onto stdout, in words or as JSON.
//!
//! A file a command: `run`, `check`, `new`, `robots` (a folder, for its own commands), `materials`, `pose`, `identify`,
//! `forces`, `completions`. `numbers`: what an option that takes numbers refuses. `drawing`: pictures that were asked for.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod forces;
pub(crate) mod identify;
pub(crate) mod materials;
pub(crate) mod new;
pub(crate) mod pose;
pub(crate) mod robots;
pub(crate) mod run;

mod drawing;
mod numbers;
