//! Robot programs: reading and writing.
//!
//! | module | language | read | write |
//! |---|---|---|---|
//! | [`krl`] | KUKA KRL, `.src` with its `.dat` | yes | yes |
//! | [`rapid`] | ABB RAPID, `.mod`, `.prg` | yes | yes |
//! | [`inform`] | Yaskawa INFORM, `.jbi` | yes | yes |
//! | [`tp`] | FANUC TP, `.ls` | yes | yes |
//! | [`urscript`] | URScript, `.script` | yes | yes |
//! | [`val3`] | Staubli VAL3, a folder of `.pjx`, `.dtx`, `.pgx` | yes | yes |
//!
//! All modules have the same structure: `read` returns a [`RobotProgram`], `write` writes a [`Draft`], `spell` writes a
//! pose as a target of the language. A program can be rewritten with other poses; everything else is kept byte for byte
//! ([`RobotProgram::with_poses`]).
//!
//! In reading order: [`Language`]; `program` the data of a program; `text` files as bytes and as characters; `rewrite`
//! the same program with other poses; `followed` a program as the moves of a path; `draft` programs to write;
//! `posture`, `number` postures and numbers of controllers;
//! `messages` problems and notes; `tokens` tokens of three languages; `spelling` lines, numbers
//! and their replacement; `arc_row` arcs given point by point.

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
mod messages;
mod number;
mod posture;
mod program;
mod rewrite;
mod spelling;
mod text;
mod tokens;
#[cfg(test)]
mod trials;

pub use draft::{Draft, DraftError, DraftPoint, Written};
pub use followed::{Cell, FollowError, Followed, FollowedMove, follow};
pub use language::Language;
pub use program::{Frame, Motion, RobotMove, RobotProgram, Speed, Spelled, Target};
pub use rewrite::{Moved, RewriteError};
pub use text::ProgramText;

use crate::document::Problems;

/// Reads the program in these files, the main file first.
///
/// # Errors
/// An unsupported language; all problems of the files.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    Language::of(&texts)?.read(texts)
}

/// Writes `draft` as a program in this language.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
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
