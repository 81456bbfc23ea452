//! Measured frequency response functions (FRFs), as receptance: displacement by force.
//!
//! - `measured`: what is read; `quantity`: what an FRF is of, and its receptance.
//! - `unit`: units of labels.
//! - `function`: one function of a universal file (dataset 58); `layout`: how its data are arranged; `binary`: its data in dataset 58b; `universal`: the datasets of a universal file.
//! - `table`: a table with a column for each part.
//!
//! A file that begins with a line `-1` is a universal file, any other a table. Frequencies are returned in rad/s, receptance in m/N.

mod binary;
mod function;
mod layout;
mod measured;
mod quantity;
mod table;
mod unit;
mod universal;

use std::io::BufRead;

pub use self::measured::MeasuredFrfs;
use crate::document::{Problems, unreadable};

/// Reads the FRFs in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200.
pub fn read(path: &str, mut reader: impl BufRead) -> Result<MeasuredFrfs, Problems> {
    let head = reader.fill_buf().map_err(|error| unreadable(path, &error))?;
    let head = head
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(head)
        .trim_ascii_start();
    match head.strip_prefix(b"-1") {
        Some(rest) if rest.first().is_none_or(u8::is_ascii_whitespace) => universal::read(path, reader),
        _ => table::read(path, reader),
    }
}

#[cfg(test)]
mod tests;
