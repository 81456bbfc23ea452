//! Circular tests: radii measured with a ball-bar, or the results of the ball-bar's own software.
//!
//! In reading order: `runs` (what a file of radii gives), [`csv`] (radii along the circle, one or several runs),
//! `columns` (their meaning), `remarks` (comment lines with `#`), [`b5r`] (results of a Renishaw QC20-W), `readings` (its radii, if the file has them).
//!
//! [`read`] reads both: a file that begins with `<` is XML.

pub mod b5r;
mod columns;
pub mod csv;
mod readings;
mod remarks;
mod runs;
#[cfg(test)]
mod tests;

use std::io::BufRead;

use crate::document::{Problems, unreadable};
use crate::xml;

pub use b5r::{Feature, Results};
pub use runs::{BallbarReadOptions, BallbarRuns, direction_of};

/// Content of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum BallbarFile {
    /// Radii.
    Runs(BallbarRuns),
    /// Results of other software, and the radii if the file has them.
    Results(Results, Option<BallbarRuns>),
}

/// Reads the file in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// The problems of the file, those of [`csv::read`] or [`b5r::read`]; readings of a `.b5r` file without direction, radius or start angle.
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
    let text = xml::text_of(path, reader)?;
    let results = b5r::read(path, &text)?;
    let runs = readings::read(path, &text, options, &results)?;
    Ok(BallbarFile::Results(results, runs))
}
