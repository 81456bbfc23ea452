//! Circular tests: the radii that a ball-bar measured, or what its own program made of them.
//!
//! In reading order: [`csv`] (radii along the circle, of one run or several), `columns` (what its columns hold), `remarks`
//! (what its lines with `#` tell), [`b5r`] (results of a Renishaw QC20-W: no radii).
//!
//! [`read`] takes either: a file that begins with `<` is XML.

pub mod b5r;
mod columns;
pub mod csv;
mod remarks;
#[cfg(test)]
mod tests;

use std::io::BufRead;

use armill_core::measure::ballbar::{Direction, Run};

use crate::document::{Problems, unreadable};
use crate::xml;

pub use b5r::{Feature, Results};

/// What a file does not tell, or what is told beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallbarReadOptions {
    /// Nominal radius, m.
    pub radius: Option<f64>,
    /// Which way all runs went.
    pub direction: Option<Direction>,
    /// Where a run without angles begins, rad.
    pub start: Option<f64>,
}

/// Runs that a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct BallbarRuns {
    /// Nominal radius, m; none where only deviations are told.
    pub radius: Option<f64>,
    /// Speed along the circle, m/s.
    pub feed: Option<f64>,
    /// The plane as the file calls it: `XY`.
    pub plane: Option<String>,
    /// In the order of the file.
    pub runs: Vec<Run>,
    /// What the file calls each run; empty where it does not.
    pub names: Vec<String>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// What a user must know, each a sentence.
    pub notes: Vec<String>,
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum BallbarFile {
    /// Radii.
    Runs(BallbarRuns),
    /// Results of another program.
    Results(Results),
}

/// A direction by its name in a file; `None` for another word.
pub fn direction_of(word: &str) -> Option<Direction> {
    match word.trim().to_lowercase().as_str() {
        "cw" | "clockwise" | "g2" | "g02" => Some(Direction::Clockwise),
        "ccw" | "acw" | "counterclockwise" | "counter-clockwise" | "anticlockwise" | "anti-clockwise"
        | "g3" | "g03" => Some(Direction::Anticlockwise),
        _ => None,
    }
}

/// Reads what `reader` holds; `path` is what problems show.
///
/// # Errors
/// The problems of the file, those of [`csv::read`] or [`b5r::read`].
pub fn read(path: &str, mut reader: impl BufRead, given: &BallbarReadOptions) -> Result<BallbarFile, Problems> {
    let head = reader.fill_buf().map_err(|error| unreadable(path, &error))?;
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = head.iter().find(|byte| !byte.is_ascii_whitespace());
    if first != Some(&b'<') {
        return csv::read(path, reader, given).map(BallbarFile::Runs);
    }
    b5r::read(path, &xml::text_of(path, reader)?).map(BallbarFile::Results)
}
