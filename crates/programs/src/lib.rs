//! Programs of robot controllers: reading and writing.
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
//! All these modules have the same structure: `read` returns a [`RobotProgram`], `write` writes a [`Draft`], `spell`
//! writes a pose as a target of the language. A program can be rewritten with other poses; everything else is kept byte
//! for byte ([`RobotProgram::with_poses`]).
//!
//! `[recalled]` marks facts of a language that are not in a sample, standard or manual that was read.
//!
//! In reading order: `languages` (each [`Language`] with its reader and writer), `program` (the data of a program),
//! `text` (files as bytes and as characters), `rewrite` (the same program with other poses), `followed` (a program as
//! the moves of a path), `controller` (how a cell writes its programs), `draft` (programs to write), `draft_check`
//! (their limits in each language), `posture` and `number` (postures and numbers of controllers),
//! `messages` (problems and notes), `tokens` (tokens of KRL, RAPID and URScript), `spelling` (lines and numbers of the
//! other languages, and their replacement), `arc_row` (arcs given point by point).

pub mod inform;
pub mod krl;
pub mod rapid;
pub mod tp;
pub mod urscript;
pub mod val3;

mod arc_row;
mod controller;
mod draft;
mod draft_check;
mod followed;
mod languages;
mod messages;
mod number;
mod posture;
mod program;
mod rewrite;
mod spelling;
mod text;
mod tokens;

pub use armill_formats::language::Language;
pub use controller::{Controller, FrameData};
pub use draft::{Draft, DraftPoint, DraftStep, FrameOn, Written};
pub use draft_check::DraftError;
pub use followed::{Cell, FollowError, Followed, FollowedMove, follow};
pub use languages::{language_of, read, read_as, write};
pub use program::{Frame, Motion, RobotMove, RobotProgram, Speed, Spelled, Target};
pub use rewrite::{Moved, RewriteError};
pub use text::ProgramText;
