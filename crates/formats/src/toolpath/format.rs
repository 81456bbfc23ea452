//! Which format is a tool path file in? By what it holds first, by its name second.
//!
//! | format | known by its content | endings |
//! |---|---|---|
//! | cutter locations | `GOTO/`, `TOOL PATH/`, `UNITS/`, `PARTNO`, ... | `.apt`, `.aptsource`, `.cl`, `.cls`, `.clsf`, `.cldata` |
//! | table | a first line of names with `x`, `y` and `z` | `.csv`, `.tsv` |
//! | G-code | lines of letters with numbers: `N10 G1 X5` | `.nc`, `.ngc`, `.gcode`, `.tap`, `.cnc`, `.mpf`, `.eia`, `.iso`, `.min` |
//!
//! Programs of robots are known and refused.

use std::path::Path;

use crate::document::{Problems, Source};

/// A kind of tool path file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// G-code.
    Gcode,
    /// Cutter locations: APT-CL, CLDATA, CLSF.
    Apt,
    /// A table of points.
    Csv,
}

/// So many lines of a file are looked at; headers of remarks are longer in no file we know.
const MOST_LINES: usize = 2000;

/// The beginnings of lines that only programs of this language have.
const ROBOT_LANGUAGES: &[(&str, &[&str])] = &[
    (
        "KUKA KRL",
        &[
            "&ACCESS", "&REL", "PTP {", "LIN {", "PTP_REL", "LIN_REL", "DEFDAT ", "PTP $", "$VEL.CP",
        ],
    ),
    (
        "ABB RAPID",
        &[
            "%%%",
            "MODULE ",
            "MOVEL ",
            "MOVEJ ",
            "MOVEABSJ ",
            "PERS ",
            "CONST ROBTARGET",
            "CONST JOINTTARGET",
        ],
    ),
    ("FANUC TP", &["/PROG", "/ATTR", "/MN", "/POS"]),
    ("Yaskawa INFORM", &["/JOB", "//NAME", "//POS", "//INST", "///"]),
    (
        "URScript or Staubli VAL3",
        &["MOVEL(", "MOVEJ(", "MOVEP(", "MOVEC(", "SET_TCP("],
    ),
    ("Staubli VAL3", &["<PROGRAM XMLNS", "<PROGRAMS XMLNS"]),
    ("Comau PDL2", &["MOVE LINEAR", "MOVE JOINT", "MOVE TO "]),
];

/// Words that only cutter locations begin a line with, before `/`.
const APT_WORDS: &[&str] = &[
    "CIRCLE",
    "CSYS",
    "CUTTER",
    "CYCLE",
    "FEDRAT",
    "FROM",
    "GOTO",
    "INSERT",
    "LOAD",
    "LOADTL",
    "MSYS",
    "PAINT",
    "PARTNO",
    "PPRINT",
    "RAPID",
    "SPINDL",
    "TLDATA",
    "TOOL PATH",
    "TRNTYP",
    "UNIT",
    "UNITS",
    "COOLNT",
    "MULTAX",
    "CUTCOM",
];

impl Format {
    /// Every format.
    pub const ALL: [Format; 3] = [Format::Gcode, Format::Apt, Format::Csv];

    /// Its name, as options take it.
    pub fn name(self) -> &'static str {
        match self {
            Format::Gcode => "gcode",
            Format::Apt => "apt",
            Format::Csv => "csv",
        }
    }

    /// The format of a file that begins with `text`: its first few thousand bytes, or all of it.
    ///
    /// # Errors
    /// A program of a robot, and a file of which neither content nor name tells what it is.
    pub fn of(path: &Path, text: &str) -> Result<Format, Problems> {
        let refused = |message: String, hint: &str| {
            let source = Source::new(&path.display().to_string(), text);
            Err(Problems::from(source.problem(
                0..0,
                message,
                Some(hint.to_owned()),
            )))
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
        if let Some(language) = lines().find_map(robot_language) {
            let hint = "programs of robots come in a later version: give the path as the CAM system writes it, as cutter \
                        locations (APT, CLSF), G-code or CSV";
            return refused(
                format!("this is a program of a robot ({language}), not a tool path"),
                hint,
            );
        }
        if lines().any(is_apt) {
            return Ok(Format::Apt);
        }
        if lines().find(|line| !line.starts_with('#')).is_some_and(is_header) {
            return Ok(Format::Csv);
        }
        if lines().any(is_gcode) {
            return Ok(Format::Gcode);
        }
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .map(str::to_lowercase);
        match ending.as_deref() {
            Some("apt" | "aptsource" | "cl" | "cls" | "clsf" | "cldata") => Ok(Format::Apt),
            Some("csv" | "tsv") => Ok(Format::Csv),
            Some("nc" | "ngc" | "gcode" | "tap" | "cnc" | "mpf" | "eia" | "iso" | "min") => Ok(Format::Gcode),
            Some("src" | "dat" | "mod" | "prg" | "ls" | "jbi" | "script" | "pgx") => refused(
                "this looks like a program of a robot".to_owned(),
                "programs of robots come in a later version: give cutter locations (APT, CLSF), G-code or CSV",
            ),
            _ => refused(
                "neither content nor name tells what tool path this is".to_owned(),
                "understood are G-code, cutter locations (APT, CLSF) and CSV; or say which with an option",
            ),
        }
    }
}

fn robot_language(line: &str) -> Option<&'static str> {
    let begin: String = line.chars().take(24).collect::<String>().to_uppercase();
    // VAL3 keeps what a move returns: `nTraj=movel(...)`.
    let begin = begin
        .split_once("=MOVE")
        .map_or(begin.clone(), |(_, rest)| format!("MOVE{rest}"));
    let known = ROBOT_LANGUAGES.iter();
    known
        .clone()
        .find(|(_, begins)| begins.iter().any(|known| begin.starts_with(known)))
        .map(|(language, _)| *language)
}

fn is_apt(line: &str) -> bool {
    let upper = line.chars().take(12).collect::<String>().to_uppercase();
    if upper.starts_with("PARTNO")
        || upper.starts_with("PPRINT")
        || upper.starts_with("FINI") && line.len() == 4
    {
        return true;
    }
    upper
        .split_once('/')
        .is_some_and(|(word, _)| APT_WORDS.contains(&word.trim_end()))
}

/// A line of names, three of which are those of a point.
fn is_header(line: &str) -> bool {
    let separator = [';', '\t'].into_iter().find(|c| line.contains(*c)).unwrap_or(',');
    let names: Vec<String> = line
        .split(separator)
        .map(|name| name.trim().trim_matches('"').to_lowercase())
        .collect();
    ["x", "y", "z"].iter().all(|axis| {
        names.iter().any(|name| {
            name.strip_prefix(axis)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['_', ' ', '[', '(']))
        })
    })
}

/// A line that begins with a word of G-code, or the tape mark.
fn is_gcode(line: &str) -> bool {
    if line == "%" {
        return true;
    }
    let mut line = line.trim_start_matches('/').trim_start();
    // Line number.
    if let Some(rest) = line.strip_prefix(['N', 'n']) {
        line = rest
            .trim_start_matches(|c: char| c.is_ascii_digit() || c == '.')
            .trim_start();
    }
    let mut letters = line.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    let next = letters.find(|c| !c.is_whitespace());
    match first {
        Some('G' | 'M' | 'T' | 'S' | 'F' | 'X' | 'Y' | 'Z' | 'A' | 'B' | 'C' | 'O') => {
            next.is_some_and(|c| c.is_ascii_digit() || matches!(c, '-' | '+' | '.' | '[' | '#' | '<'))
        }
        // A parameter that is set.
        Some('#') => next.is_some_and(|c| c.is_ascii_digit() || c == '<'),
        _ => false,
    }
}

#[cfg(test)]
mod tests;
