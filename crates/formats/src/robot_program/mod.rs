//! What does the robot's own controller say? Programs of robots, in and out.
//!
//! | module | language | in | out |
//! |---|---|---|---|
//! | [`krl`] | KUKA KRL, `.src` with its `.dat` | yes | yes |
//! | [`rapid`] | ABB RAPID, `.mod`, `.prg` | yes | yes |
//! | [`inform`] | Yaskawa INFORM, `.jbi` | yes | yes |
//! | [`tp`] | FANUC TP, `.ls` | yes | yes |
//! | [`urscript`] | URScript, `.script` | yes | yes |
//! | [`val3`] | Staubli VAL3, a folder of `.pjx`, `.dtx`, `.pgx` | yes | yes |
//!
//! Each has the same shape: `read` gives a [`RobotProgram`], `write` takes a [`Draft`], `spell` writes a pose as the
//! language writes a target. A program that was read can be written again with other poses: all else stays byte for byte
//! ([`RobotProgram::with_poses`]).
//!
//! In reading order: [`Language`]; `program` what is read; `text` files as bytes and as characters; `rewrite` the same
//! program with other poses; `followed` a program as the moves of a path; `draft` what is written; `posture`, `number` how controllers tell postures and numbers;
//! `told` what is told beside moves; `tokens` what the texts of three languages are made of; `spelling` lines, numbers as
//! they stand, and others in their places; `arc_row` arcs that are told point by point.

pub mod inform;
pub mod krl;
pub mod rapid;
pub mod tp;
pub mod urscript;
pub mod val3;

mod arc_row;
mod draft;
mod followed;
mod language;
mod number;
mod posture;
mod program;
mod rewrite;
mod spelling;
mod text;
mod tokens;
mod given;
#[cfg(test)]
mod trials;

pub use draft::{Draft, DraftError, DraftPoint, Written};
pub use followed::{Cell, FollowError, Followed, FollowedMove, follow};
pub use language::Language;
pub use program::{Frame, Motion, RobotMove, RobotProgram, Speed, Spelled, Target};
pub use rewrite::{Moved, RewriteError};
pub use text::ProgramText;

use crate::document::Problems;

/// Reads the program that these files make, its main file first.
///
/// # Errors
/// A language that nobody here reads; every problem of the files.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    Language::of(&texts)?.read(texts)
}

/// Writes `draft` as a program of this language.
///
/// # Errors
/// What the language or its controllers cannot hold.
pub fn write(language: Language, draft: &Draft) -> Result<Written, DraftError> {
    match language {
        Language::Krl => krl::write(draft),
        Language::Rapid => rapid::write(draft),
        Language::Inform => inform::write(draft),
        Language::Tp => tp::write(draft),
        Language::UrScript => urscript::write(draft),
        Language::Val3 => val3::write(draft),
    }
}
