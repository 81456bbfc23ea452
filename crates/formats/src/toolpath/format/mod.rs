//! A program in any format: recognised from its content, otherwise from its name, and read by the reader of that
//! format.
//!
//! | format | known by its content | endings |
//! |---|---|---|
//! | cutter locations | `GOTO/`, `TOOL PATH/`, `UNITS/`, `PARTNO`, ... | `.apt`, `.aptsource`, `.cl`, `.cls`, `.clsf`, `.cldata` |
//! | table | a first line of names with `x`, `y` and `z` | `.csv`, `.tsv` |
//! | G-code | lines of letters with numbers: `N10 G1 X5` | `.nc`, `.ngc`, `.gcode`, `.tap`, `.cnc`, `.mpf`, `.eia`, `.iso`, `.min` |
//! | program of a robot | lines that only its language has | those of its [`Language`](crate::language::Language) |
//!
//! The path of a robot program depends on its robot: it is only recognised here, and read by the
//! crate `armill-programs`. `kind`: the formats, and how that of a file is recognised; `known_by`: what lines of a
//! program show.

mod kind;
mod known_by;

use std::io::{BufRead, Cursor, Read};
use std::path::Path;

use armill_core::path::Step;

pub use self::kind::{Format, HEAD_BYTES};
use super::gcode::{self, Lookup, Rotaries, ToolTable};
use super::{LengthUnit, Summary, apt, csv};
use crate::document::{Problem, Problems};

/// Options for a program that does not give these values.
#[derive(Clone, Default)]
pub struct ToolpathReadOptions<'a> {
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
    /// G-code: most lines of loops and subroutines; see [`gcode::GcodeReadOptions`].
    pub most_repeated_lines: Option<usize>,
}

/// Reads the program in `reader`, and gives `out` its steps one by one; `path` is what problems show.
///
/// If there are problems, the steps given so far are not valid.
///
/// # Errors
/// An unsupported format, or a robot program, which needs its robot; all problems of the file.
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    requested: &ToolpathReadOptions<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut head = Vec::new();
    // What cannot be read here cannot be read by the readers either, and they say so.
    let _ = reader.by_ref().take(HEAD_BYTES).read_to_end(&mut head);
    let format = Format::of(Path::new(path), &String::from_utf8_lossy(&head))?;
    let whole = Cursor::new(head).chain(reader);
    match format {
        Format::Apt => {
            let requested = apt::AptReadOptions {
                unit: requested.unit,
                dialect: requested.dialect,
            };
            apt::read(path, whole, &requested, out)
        }
        Format::Csv => csv::read(path, whole, out),
        Format::Gcode => {
            let requested = gcode::GcodeReadOptions {
                unit: requested.unit.unwrap_or_default(),
                rotaries: requested.rotaries.clone(),
                tools: requested.tools.clone(),
                subroutines: requested.subroutines,
                most_repeated_lines: requested.most_repeated_lines,
                ..gcode::GcodeReadOptions::default()
            };
            gcode::read(path, whole, &requested, out)
        }
        Format::Robot(language) => Err(Problem::of_file(
            path,
            format!("this is a robot program ({})", language.title()),
            "a robot program gives a path only with its robot: use `armill_programs::read`, then `follow`",
        )
        .into()),
    }
}

#[cfg(test)]
mod tests;
