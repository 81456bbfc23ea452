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
//! In reading order: `statement` splits lines; `modal` stores modal settings; `words` evaluates each word,
//! `systems` and `tool` do so for frames and cutters, `motion` and `cycle` for what moves.
//!
//! Source: ISO 4343, ISO 3592; how both programs write, read in their files.

mod cycle;
mod modal;
mod motion;
mod statement;
mod systems;
mod tool;
mod words;

use std::fmt;
use std::io::BufRead;

use armill_core::path::Step;

use self::modal::Interpreter;
use self::statement::Statements;
use super::format::Format;
use super::{LengthUnit, Summary};
use crate::document::{MOST_PROBLEMS, Problems};

/// Whose cutter locations these are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// SolidWorks CAM: a GOTO without axis means 0,0,1.
    SolidWorks,
    /// Siemens NX: a GOTO without axis means the axis before.
    Nx,
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dialect::SolidWorks => "SolidWorks CAM",
            Dialect::Nx => "Siemens NX",
        })
    }
}

/// Options for a file that does not give these values.
#[derive(Clone, Copy, Debug, Default)]
pub struct AptReadOptions {
    /// The unit of a file without UNITS line; a file that has one keeps it.
    pub unit: Option<LengthUnit>,
    /// The dialect, whatever the file looks like.
    pub dialect: Option<Dialect>,
}

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
