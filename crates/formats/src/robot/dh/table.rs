//! The lines of a table: settings, header, cells; each with its place.
//!
//! Cells are separated by the first of `;`, `,` and tab that the header contains, else by blanks; with `;` a comma is a
//! decimal sign. Quotes round a cell are taken off. Settings may be anywhere, also below the header.

use std::ops::Range;

use crate::document::{Problem, Problems, Source};

/// What a row means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Convention {
    /// `Rz(theta) Tz(d) Tx(a) Rx(alpha)`
    Standard,
    /// `Rx(alpha) Tx(a) Rz(theta) Tz(d)`
    Modified,
    /// `Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)`
    Hayati,
}

/// A piece of the text and its position.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// Without blanks and quotes around it.
    pub text: String,
    pub place: Range<usize>,
}

/// The file as a table.
#[derive(Debug)]
pub(super) struct Table {
    /// What `convention = ` says; never assumed.
    pub convention: Convention,
    /// What the table calls the arm.
    pub name: Option<String>,
    /// Names of the columns.
    pub header: Vec<Cell>,
    /// As many cells each as the header has.
    pub rows: Vec<Vec<Cell>>,
    /// A comma is a decimal sign here, because `;` separates.
    pub decimal_comma: bool,
}

/// What to write where the convention is not known.
const CONVENTIONS: &str = "write `convention = standard` (a row is Rz(theta) Tz(d) Tx(a) Rx(alpha): a and alpha lead to the \
     next axis) or `convention = modified` (Craig: Rx(alpha) Tx(a) Rz(theta) Tz(d): a and alpha lead from the axis before); `convention = hayati` is standard with Ry(beta) \
     behind it";

/// The table of this text: `#` starts a comment, `key = value` is a setting, the first other line is the header.
///
/// # Errors
/// No convention, an unknown setting, no header, no row, a row of another length than the header.
pub(super) fn read(file: &Source) -> Result<Table, Problems> {
    let mut problems = Vec::new();
    let mut convention = None;
    let mut name = None;
    let mut lines = Vec::new();
    for line in lines_of(file.text()) {
        match line.text.split_once('=') {
            Some((key, value)) => {
                let value = value.trim().trim_matches('"');
                match key.trim().to_lowercase().as_str() {
                    "convention" => match convention_of(value) {
                        Some(known) => convention = Some(known),
                        None => {
                            let message = format!(
                                "convention `{value}` is none of `standard`, `modified` and `hayati`"
                            );
                            problems.push(file.problem(line.place, message, Some(CONVENTIONS.to_owned())));
                            // Already reported: not missing as well.
                            convention = Some(Convention::Standard);
                        }
                    },
                    "name" => name = Some(value.to_owned()),
                    other => {
                        let message = format!("unknown setting `{other}`");
                        let hint = "settings are `convention` and `name`".to_owned();
                        problems.push(file.problem(line.place, message, Some(hint)));
                    }
                }
            }
            None => lines.push(line),
        }
    }
    if convention.is_none() {
        let message = "the table does not say which convention it follows: the same numbers are another arm in the other";
        problems.push(file.problem(0..0, message, Some(CONVENTIONS.to_owned())));
    }
    let mut lines = lines.into_iter();
    let Some(first) = lines.next() else {
        let hint = "such as `joint, alpha_deg, a_mm, theta_deg, d_mm`".to_owned();
        problems.push(file.problem(0..0, "the table has no header", Some(hint)));
        return Err(problems.into());
    };
    let separator = separator(&first.text);
    let header = cells(&first, separator);
    let mut rows = Vec::new();
    for line in lines {
        let cells = cells(&line, separator);
        match cells.len() == header.len() {
            true => rows.push(cells),
            false => problems.push(uneven(file, &line, cells.len(), header.len())),
        }
    }
    if rows.is_empty() && problems.is_empty() {
        let hint = "a row for every joint, base to flange".to_owned();
        problems.push(file.problem(first.place, "the table has no row", Some(hint)));
    }
    match convention {
        Some(convention) if problems.is_empty() => Ok(Table {
            convention,
            name,
            header,
            rows,
            decimal_comma: separator == Separator::Char(';'),
        }),
        _ => Err(problems.into()),
    }
}

/// A row with more or fewer cells than the header.
fn uneven(file: &Source, line: &Cell, found: usize, expected: usize) -> Problem {
    let message = format!("the row has {found} cells where the header has {expected}");
    let hint = "write 0 where nothing is; with decimal commas separate cells by `;`".to_owned();
    file.problem(line.place.clone(), message, Some(hint))
}

/// The convention that a word names, capitals aside.
fn convention_of(word: &str) -> Option<Convention> {
    match word.to_lowercase().as_str() {
        "standard" => Some(Convention::Standard),
        "modified" => Some(Convention::Modified),
        "hayati" => Some(Convention::Hayati),
        _ => None,
    }
}

/// The lines with content, without comments.
fn lines_of(text: &str) -> Vec<Cell> {
    let mut start = 0;
    let mut lines = Vec::new();
    for line in text.split_inclusive('\n') {
        let content = line.split('#').next().unwrap_or_default();
        let trimmed = content.trim();
        let at = start + content.len() - content.trim_start().len();
        if !trimmed.is_empty() {
            lines.push(Cell {
                text: trimmed.to_owned(),
                place: at..at + trimmed.len(),
            });
        }
        start += line.len();
    }
    lines
}

/// What is between cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Char(char),
    Blanks,
}

/// The first of `;`, `,` and tab that the header contains, else blanks.
fn separator(header: &str) -> Separator {
    match [';', ',', '\t'].into_iter().find(|c| header.contains(*c)) {
        Some(c) => Separator::Char(c),
        None => Separator::Blanks,
    }
}

/// The cells of a line; of one that ends with a separator the last is empty.
fn cells(line: &Cell, separator: Separator) -> Vec<Cell> {
    let pieces: Vec<&str> = match separator {
        Separator::Char(c) => line.text.split_inclusive(c).collect(),
        Separator::Blanks => line.text.split_inclusive(char::is_whitespace).collect(),
    };
    let mut at = line.place.start;
    let mut cells = Vec::new();
    for piece in pieces {
        let content = match separator {
            Separator::Char(c) => piece.strip_suffix(c).unwrap_or(piece),
            Separator::Blanks => piece,
        };
        let text = content.trim();
        let start = at + content.len() - content.trim_start().len();
        at += piece.len();
        if !(separator == Separator::Blanks && text.is_empty()) {
            cells.push(Cell {
                text: text.trim_matches('"').to_owned(),
                place: start..start + text.len(),
            });
        }
    }
    // An empty last cell has no separator behind it.
    if let Separator::Char(c) = separator
        && line.text.ends_with(c)
    {
        cells.push(Cell {
            text: String::new(),
            place: at..at,
        });
    }
    cells
}
