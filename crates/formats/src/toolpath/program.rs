//! A program in any format: known by what it holds, read by its own reader.

use std::io::{BufRead, Cursor, Read};
use std::path::Path;

use armill_core::path::Step;

use super::format::Format;
use super::gcode::options::Lookup;
use super::gcode::{self, Rotaries, ToolTable};
use super::{LengthUnit, apt, csv};
use crate::document::Problems;

/// What a user may say of a program where it is silent.
#[derive(Clone, Default)]
pub struct Wanted<'a> {
    /// The unit of lengths.
    pub unit: Option<LengthUnit>,
    /// Cutter locations: whose they are, where they do not show it.
    pub dialect: Option<apt::Dialect>,
    /// G-code: how rotary axes turn tool and part.
    pub rotaries: Option<Rotaries>,
    /// G-code: the tools of the machine.
    pub tools: Option<ToolTable>,
    /// G-code: subroutines that are not in the program.
    pub subroutines: Option<Lookup<'a>>,
    /// G-code: most lines of loops and subroutines; see [`gcode::Options`].
    pub most_repeated_lines: Option<usize>,
}

/// What a program held beside its steps.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// The format it is in.
    pub format: &'static str,
    /// Words that were not followed, and what was taken for granted: sentences with their counts and first lines.
    pub notes: Vec<String>,
}

/// So much of a file tells its format, bytes.
const HEAD: u64 = 256 * 1024;

/// Reads the program in `reader`, and gives `out` its steps one by one; `path` is what problems show.
///
/// With problems the steps given so far are worth nothing.
///
/// # Errors
/// A format that nobody here reads; every problem of the file.
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    wanted: &Wanted<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut head = Vec::new();
    // What cannot be read here cannot be read by the readers either, and they say so.
    let _ = reader.by_ref().take(HEAD).read_to_end(&mut head);
    let format = Format::of(Path::new(path), &String::from_utf8_lossy(&head))?;
    let whole = Cursor::new(head).chain(reader);
    let notes = match format {
        Format::Apt => of_apt(path, whole, wanted, out)?,
        Format::Csv => {
            csv::read(path, whole, out)?;
            Vec::new()
        }
        Format::Gcode => of_gcode(path, whole, wanted, out)?,
    };
    Ok(Summary {
        format: format.name(),
        notes,
    })
}

fn of_apt(
    path: &str,
    reader: impl BufRead,
    wanted: &Wanted<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Vec<String>, Problems> {
    let wanted = apt::Wanted {
        unit: wanted.unit,
        dialect: wanted.dialect,
    };
    let summary = apt::read(path, reader, &wanted, out)?;
    let ignored = summary.ignored.iter().map(|(word, noted)| {
        let (count, line) = (noted.count, noted.first_line);
        format!("{word} was passed over {}, first in line {line}", times(count))
    });
    let warnings = summary.warnings.iter().map(|(sentence, noted)| {
        let (count, line) = (noted.count, noted.first_line);
        format!("{sentence} ({}, first in line {line})", times(count))
    });
    Ok(warnings.chain(ignored).collect())
}

fn of_gcode(
    path: &str,
    mut reader: impl BufRead,
    wanted: &Wanted<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Vec<String>, Problems> {
    let options = gcode::Options {
        unit: wanted.unit.unwrap_or_default(),
        rotaries: wanted.rotaries.clone(),
        tools: wanted.tools.clone(),
        subroutines: wanted.subroutines,
        most_repeated_lines: wanted.most_repeated_lines,
        ..gcode::Options::default()
    };
    let summary = gcode::read(path, &mut reader, &options, out)?;
    let note = |(warning, count, line): (gcode::Warning, u64, u32)| {
        let meaning = warning.meaning();
        format!("{meaning} ({}, first in line {line})", times(count))
    };
    Ok(summary.warnings.iter().map(note).collect())
}

fn times(count: u64) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        more => format!("{more} times"),
    }
}
