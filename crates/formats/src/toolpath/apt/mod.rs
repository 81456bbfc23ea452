//! Cutter locations: APT-CL or CLDATA as SolidWorks CAM writes it, and the CLSF of Siemens NX.
//!
//! The words that are followed, ignored and refused are listed in `docs/guide/tool-path-words.md`;
//! `tests/toolpath/words.rs` tries each.
//!
//! The two dialects differ where a GOTO leaves the tool axis out: SolidWorks means 0,0,1, NX the one before. They are
//! known by `CSYS`, `TRNTYP` and by `TOOL PATH`, `TLDATA`, `MSYS`. The path is in world coordinates (SolidWorks), in
//! those of the first MSYS (NX), in the only ones there are otherwise. Cutter compensation is ignored: the points
//! are used unchanged.
//!
//! In reading order: `options` says what may be given in addition to a file; `statement` splits lines; `modal` stores
//! modal settings (`settings`: those of several values); `words` evaluates each word, `systems` and `tool` do so for frames and cutters, `motion` and `cycle` for what moves.
//!
//! Source: ISO 4343, ISO 3592; how both programs write, read in their files.

mod cycle;
mod modal;
mod motion;
mod options;
mod settings;
mod statement;
mod systems;
mod tool;
mod words;

use std::io::BufRead;

use armill_core::path::Step;

use self::modal::Interpreter;
pub use self::options::{AptReadOptions, Dialect};
use self::statement::Statements;
use super::Summary;
use super::format::Format;
use crate::document::{MOST_PROBLEMS, Problems};

/// Reads the cutter locations in `reader`, and gives `out` their steps one by one; `path` is what problems show.
///
/// If there are problems, the steps given so far are not valid.
///
/// # Errors
/// Every problem of the file, at most 200: words whose meaning is not certain, numbers that are none, arcs whose ends
/// have different radii, unsupported words that move the tool, lengths without a unit.
pub fn read(
    path: &str,
    reader: impl BufRead,
    requested: &AptReadOptions,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut statements = Statements::new(path, reader);
    let mut summary = Summary::new(Format::Apt);
    let mut counted = |step: Step| {
        summary.count(&step);
        out(step);
    };
    let mut interpreter = Interpreter::new(path, requested, &mut counted);
    while interpreter.problems.len() < MOST_PROBLEMS {
        match statements.next() {
            Ok(Some(statement)) => interpreter.take(&statement),
            Ok(None) => break,
            Err(wrong) => {
                interpreter.problems.extend(wrong);
                break;
            }
        }
    }
    summary.notes = interpreter.finish()?;
    Ok(summary)
}

#[cfg(test)]
mod tests;
