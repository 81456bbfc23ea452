//! What a line is known by: the words that only one format begins its lines with.
//!
//! Lines come without blanks round them; capitals do not count. Many lines of a program are known by none of the tests;
//! one line that is known decides.

use crate::language::Language;
use crate::table::sheet::{cells, separator_of};

/// Line beginnings of robot languages that are not supported.
const OTHER_ROBOTS: &[(&str, &[&str])] = &[("Comau PDL2", &["MOVE LINEAR", "MOVE JOINT", "MOVE TO "])];

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

/// A language of robots.
pub(super) enum Robots {
    /// One that is read.
    Read(Language),
    /// One that is not, by its name.
    Other(&'static str),
}

/// The language of robots that a line belongs to.
///
/// By its first 24 characters.
pub(super) fn robot_language(line: &str) -> Option<Robots> {
    // VAL3 keeps what a move returns: `nTraj=movel(...)`.
    let line = line
        .split_once('=')
        .map_or(line, |(name, rest)| if is_name(name) { rest } else { line });
    let known = Language::of_line(line);
    known.map(Robots::Read).or_else(|| {
        let begin: String = line.chars().take(24).collect::<String>().to_uppercase();
        let begins = |(_, words): &&(&str, &[&str])| words.iter().any(|word| begin.starts_with(word));
        let other = OTHER_ROBOTS.iter().find(begins);
        other.map(|(language, _)| Robots::Other(language))
    })
}

/// Letters, digits and underscores, nothing else.
fn is_name(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// A line that begins with a word of cutter locations.
///
/// `GOTO/1,2,3`, `PARTNO ...`, or `FINI` alone.
pub(super) fn is_apt(line: &str) -> bool {
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
///
/// `x`, `x_mm`, `x [mm]` and `x(mm)` are all x.
pub(super) fn is_header(line: &str) -> bool {
    let cells = cells(line, separator_of(line)).into_iter();
    let names: Vec<String> = cells.map(|cell| cell.text.to_lowercase()).collect();
    ["x", "y", "z"].iter().all(|axis| {
        names.iter().any(|name| {
            name.strip_prefix(axis)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['_', ' ', '[', '(']))
        })
    })
}

/// A line that begins with a word of G-code, or the tape mark.
///
/// Behind a slash for an optional block and a line number: `G1`, `X-5`, `#1=2`, `O<name>`. A line of a number alone, or
/// of words, is none.
pub(super) fn is_gcode(line: &str) -> bool {
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
