//! A program in any format: recognised from its content, otherwise from its name, and read by the reader of that
//! format.
//!
//! | format | known by its content | endings |
//! |---|---|---|
//! | cutter locations | `GOTO/`, `TOOL PATH/`, `UNITS/`, `PARTNO`, ... | `.apt`, `.aptsource`, `.cl`, `.cls`, `.clsf`, `.cldata` |
//! | table | a first line of names with `x`, `y` and `z` | `.csv`, `.tsv` |
//! | G-code | lines of letters with numbers: `N10 G1 X5` | `.nc`, `.ngc`, `.gcode`, `.tap`, `.cnc`, `.mpf`, `.eia`, `.iso`, `.min` |
//! | program of a robot | lines that only its language has | those of its [`Language`] |
//!
//! The path of a robot program depends on its robot: it is only recognised here, and read by the
//! crate `armill-programs`. `known_by`: what lines of a program show.

mod known_by;

use std::io::{BufRead, Cursor, Read};
use std::path::Path;

use armill_core::path::Step;

use self::known_by::{Robots, is_apt, is_gcode, is_header, robot_language};
use super::gcode::{self, Lookup, Rotaries, ToolTable};
use super::{LengthUnit, Summary, apt, csv};
use crate::document::lines::is_remark;
use crate::document::{Problem, Problems};
use crate::language::Language;

/// A kind of tool path file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// G-code.
    Gcode,
    /// Cutter locations: APT-CL, CLDATA, CLSF.
    Apt,
    /// A table of points.
    Csv,
    /// A program of a robot.
    Robot(Language),
}

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

/// Number of bytes used to recognise the format.
pub const HEAD_BYTES: u64 = 256 * 1024;
/// Maximum number of lines that are searched for the format.
const MOST_LINES: usize = 2000;

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

impl Format {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Format::Gcode => "gcode",
            Format::Apt => "apt",
            Format::Csv => "csv",
            Format::Robot(language) => language.name(),
        }
    }

    /// The format of the file `path` that begins with `text`: its first 256 KiB, or all of it.
    ///
    /// Looked for in this order: a line of any robot language, a word of cutter locations, a line of names, a line of
    /// G-code; then the ending.
    ///
    /// # Errors
    /// A robot program in an unsupported language, and a file whose format cannot be recognised from content or name.
    pub fn of(path: &Path, text: &str) -> Result<Format, Problems> {
        let refused = |message: String, hint: &str| {
            let path = path.display().to_string();
            Err(Problems::from(Problem::of_file(&path, message, hint)))
        };
        if text.contains('\0') {
            return refused(
                "this is not text".to_owned(),
                "save it as UTF-8 text; cutter locations in binary are not read",
            );
        }
        let text = text.trim_start_matches('\u{feff}');
        let lines = || {
            text.split(['\n', '\r'])
                .map(str::trim)
                .filter(|line| !line.is_empty())
                .take(MOST_LINES)
        };
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .map(str::to_lowercase)
            .unwrap_or_default();
        let of_ending = Language::of_ending(&ending);
        match lines().find_map(robot_language) {
            // The moves of VAL3 are spelled as those of URScript; the endings of its files are its own.
            Some(Robots::Read(_)) if of_ending == Some(Language::Val3) => {
                return Ok(Format::Robot(Language::Val3));
            }
            Some(Robots::Read(language)) => return Ok(Format::Robot(language)),
            Some(Robots::Other(language)) => {
                let hint = "its language is not supported: give the path as the CAM system writes it, as cutter \
                    locations (APT, \
                    CLSF), G-code or CSV";
                return refused(format!("this is a robot program ({language})"), hint);
            }
            None => {}
        }
        if lines().any(is_apt) {
            return Ok(Format::Apt);
        }
        if lines().find(|line| !is_remark(line)).is_some_and(is_header) {
            return Ok(Format::Csv);
        }
        if lines().any(is_gcode) {
            return Ok(Format::Gcode);
        }
        match (ending.as_str(), of_ending) {
            (_, Some(language)) => Ok(Format::Robot(language)),
            ("apt" | "aptsource" | "cl" | "cls" | "clsf" | "cldata", _) => Ok(Format::Apt),
            ("csv" | "tsv", _) => Ok(Format::Csv),
            ("nc" | "ngc" | "gcode" | "tap" | "cnc" | "mpf" | "eia" | "iso" | "min", _) => Ok(Format::Gcode),
            _ => refused(
                "neither content nor file name identifies the format of this tool path".to_owned(),
                "supported: G-code, cutter locations (APT, CLSF), CSV and robot programs (KRL, RAPID, INFORM, TP, \
                 URScript, VAL3); use the file ending of the format, such as `.nc`, `.apt`, `.csv` or `.src`",
            ),
        }
    }
}

#[cfg(test)]
mod tests;
