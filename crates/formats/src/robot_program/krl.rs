//! KUKA KRL.

use armill_core::frame::Isometry;

use super::draft::{Draft, DraftError, Written};
use super::program::RobotProgram;
use super::text::ProgramText;
use crate::document::{Problem, Problems};

/// Reads a program.
///
/// # Errors
/// Every problem of the files.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    let name = texts.first().map_or("", ProgramText::name);
    Err(Problem::of_file(name, "KUKA KRL is not read yet", "").into())
}

/// Writes a program.
///
/// # Errors
/// What the language or its controllers cannot hold.
pub fn write(_: &Draft) -> Result<Written, DraftError> {
    Err(DraftError::Empty)
}

/// Spells a pose in place of `before`.
pub(super) fn spell(_: &Isometry, _: &str, _: &mut String) {}
