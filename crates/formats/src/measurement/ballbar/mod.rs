//! Circular tests: radii measured with a ball-bar, or the results of the ball-bar's own software.
//!
//! In reading order: [`csv`] (radii along the circle, one or several runs), `columns` (their meaning), `remarks`
//! (comment lines with `#`), [`b5r`] (results of a Renishaw QC20-W, without radii).
//!
//! [`read`] reads both: a file that begins with `<` is XML.

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

/// Values that the file does not give, or that are given as options.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallbarReadOptions {
    /// Nominal radius, m.
    pub radius: Option<f64>,
    /// Direction of all runs.
    pub direction: Option<Direction>,
    /// Start angle of runs without angles, rad.
    pub start: Option<f64>,
}

/// The runs of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct BallbarRuns {
    /// Nominal radius, m; `None` if the file has only deviations.
    pub radius: Option<f64>,
    /// Speed along the circle, m/s.
    pub feed: Option<f64>,
    /// Name of the plane in the file: `XY`.
    pub plane: Option<String>,
    /// In the order of the file.
    pub runs: Vec<Run>,
    /// Name of each run in the file; empty if it has none.
    pub names: Vec<String>,
    /// Ignored columns.
    pub unused: Vec<String>,
    /// Warnings, one sentence each.
    pub notes: Vec<String>,
}

/// Content of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum BallbarFile {
    /// Radii.
    Runs(BallbarRuns),
    /// Results of other software.
    Results(Results),
}

/// The direction that a word in a file names; `None` for other words.
pub fn direction_of(word: &str) -> Option<Direction> {
    match word.trim().to_lowercase().as_str() {
        "cw" | "clockwise" | "g2" | "g02" => Some(Direction::Clockwise),
        "ccw" | "acw" | "counterclockwise" | "counter-clockwise" | "anticlockwise" | "anti-clockwise"
        | "g3" | "g03" => Some(Direction::Anticlockwise),
        _ => None,
    }
}

/// Reads the file in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// The problems of the file, those of [`csv::read`] or [`b5r::read`].
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    options: &BallbarReadOptions,
) -> Result<BallbarFile, Problems> {
    let head = reader.fill_buf().map_err(|error| unreadable(path, &error))?;
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = head.iter().find(|byte| !byte.is_ascii_whitespace());
    if first != Some(&b'<') {
        return csv::read(path, reader, options).map(BallbarFile::Runs);
    }
    b5r::read(path, &xml::text_of(path, reader)?).map(BallbarFile::Results)
}
