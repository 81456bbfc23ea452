//! Cutter locations: APT-CL or CLDATA as SolidWorks CAM writes it, and the CLSF of Siemens NX.
//!
//! Which words are followed, passed over and refused stands in `docs/guide/tool-path-words.md`; `tests/words.rs` tries
//! each.
//!
//! The two dialects differ where a GOTO leaves the tool axis out: SolidWorks means 0,0,1, NX the one before. They are
//! known by `CSYS`, `TRNTYP` and by `TOOL PATH`, `TLDATA`, `MSYS`. The path is in world coordinates (SolidWorks), in
//! those of the first MSYS (NX), in the only ones there are otherwise. Cutter compensation is passed over: the points
//! are taken as they stand.
//!
//! Source: ISO 4343, ISO 3592; how both programs write, read in their files.

mod cycle;
mod modal;
mod motion;
mod statement;
mod words;

use std::collections::BTreeMap;
use std::io::BufRead;

use armill_core::frame::Isometry;
use armill_core::path::Step;

use self::modal::Interpreter;
use self::statement::Statements;
use super::LengthUnit;
use crate::document::Problems;

/// More problems than this are not looked for.
const MOST_PROBLEMS: usize = 200;

/// Whose cutter locations these are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// SolidWorks CAM: a GOTO without axis means 0,0,1.
    SolidWorks,
    /// Siemens NX: a GOTO without axis means the axis before.
    Nx,
}

/// What a user may say of a file where it is silent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// The unit of a file without UNITS line; a file that has one keeps it.
    pub unit: Option<LengthUnit>,
    /// The dialect, whatever the file looks like.
    pub dialect: Option<Dialect>,
}

/// How often something stood in a file, and where first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noted {
    /// Line, from 1.
    pub first_line: u32,
    /// How often.
    pub count: u64,
}

/// What a file held.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Its dialect, where it shows one.
    pub dialect: Option<Dialect>,
    /// Its PARTNO.
    pub part: Option<String>,
    /// Its unit of length, where one was needed.
    pub unit: Option<LengthUnit>,
    /// Where the first MSYS lies: `world_from_path`, m.
    pub msys: Option<Isometry>,
    /// Operations given.
    pub operations: u64,
    /// Moves given, those of cycles included.
    pub moves: u64,
    /// Points named: GOTO, FROM and GOHOME.
    pub points: u64,
    /// Arcs given.
    pub arcs: u64,
    /// Those of whole turns.
    pub full_turns: u64,
    /// Holes of cycles.
    pub holes: u64,
    /// Words that say nothing about the path.
    pub ignored: BTreeMap<String, Noted>,
    /// Words that are not known, and what was assumed, as sentences.
    pub warnings: BTreeMap<String, Noted>,
}

/// Reads the cutter locations in `reader`, and gives `out` their steps one by one; `path` is what problems show.
///
/// With problems the steps given so far are worth nothing.
///
/// # Errors
/// Every problem of the file, at most 200: words whose meaning is not certain, numbers that are none, arcs whose ends
/// have different radii, words that move the tool and are not understood, lengths whose unit nobody told.
pub fn read(
    path: &str,
    reader: impl BufRead,
    wanted: &Wanted,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut statements = Statements::new(path, reader);
    let mut interpreter = Interpreter::new(path, wanted, out);
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
    interpreter.finish()
}

#[cfg(test)]
mod tests;
