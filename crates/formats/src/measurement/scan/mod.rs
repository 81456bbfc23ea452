//! Points of a real part, from scanners and coordinate measuring machines, with or without normals.
//!
//! | format | module | unit |
//! |---|---|---|
//! | PLY, STL, OBJ, 3MF, DAE; PLY without faces | `surface` | of the file (3MF, DAE), else given, else mm |
//! | XYZ, ASC, PTS, TXT: rows of numbers | `rows` | given, else mm |
//! | CSV, XLSX, TXT: tables with names | `table`, [`columns`](mod@columns) | of the names, else given, else mm |
//! | QIF 2.1 and 3.0: measured points and features | `qif` | of the file |
//! | DMIS: measured points and features | `dmis` | of the file |
//!
//! The format is recognised from the content, of meshes from the ending too. `measured`: what is read, and what is given in
//! addition. All lengths are returned in m, in the axes of the file.

pub mod columns;
mod dmis;
mod measured;
mod qif;
mod rows;
mod surface;
mod table;

use std::io::Read;
use std::path::Path;

use self::measured::EMPTY_HINT;
pub use self::measured::{MeasuredFeature, MeasuredFeatureKind, Scan, ScanFormat, ScanReadOptions};
use super::workbook::{first_sheet_as_text, is_workbook};
use crate::document::lines::Lines;
use crate::document::{Problem, Problems, unreadable};
use crate::mesh::MeshFormat;

/// Largest file, byte.
pub const MOST_BYTES: u64 = 2 << 30;

/// Reads the points of the file at `path`; `shown` is the file name shown in problems, its ending is used for meshes.
///
/// # Errors
/// A file that cannot be read or has more than [`MOST_BYTES`]; those of [`read`].
pub fn read_file(path: &Path, shown: &str, given: &ScanReadOptions) -> Result<Scan, Problems> {
    let unread = |error: std::io::Error| Problems::from(unreadable(shown, &error));
    let mut bytes = Vec::new();
    let file = crate::input::open(path).map_err(unread)?;
    file.take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unread)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("the file is larger than {} MiB", MOST_BYTES >> 20);
        return Err(Problem::of_file(shown, message, "export fewer points: every tenth, for example").into());
    }
    read(shown, &bytes, given)
}

/// The points in `bytes`; `shown` is the file name shown in problems, its ending is used for meshes.
///
/// # Errors
/// All problems of the file, at most 200: a format or unit that is not known, cells that are not numbers, rows of
/// another length, coordinates out of range, no points.
pub fn read(shown: &str, bytes: &[u8], given: &ScanReadOptions) -> Result<Scan, Problems> {
    let ending = Path::new(shown).extension().and_then(|ending| ending.to_str());
    let ending = ending.unwrap_or_default().to_lowercase();
    if MeshFormat::of_path(Path::new(shown)).is_some()
        || bytes.starts_with(b"ply\n")
        || bytes.starts_with(b"ply\r")
    {
        return surface::read(shown, bytes, given);
    }
    if is_workbook(bytes) {
        let text = first_sheet_as_text(shown, bytes)?;
        return of_text(shown, text.as_bytes(), ScanFormat::Workbook, given);
    }
    let start = bytes
        .strip_prefix(b"\xef\xbb\xbf")
        .unwrap_or(bytes)
        .trim_ascii_start();
    if start.starts_with(b"<") {
        return qif::read(shown, bytes, given);
    }
    if dmis::is_dmis(&ending, start) {
        return dmis::read(shown, bytes, given);
    }
    of_text(shown, bytes, ScanFormat::Table, given)
}

/// A table with names, or rows of numbers.
fn of_text(shown: &str, bytes: &[u8], format: ScanFormat, given: &ScanReadOptions) -> Result<Scan, Problems> {
    let mut lines = Lines::new(shown, bytes);
    let mut titles = Vec::new();
    while let Some(line) = lines.next_row()? {
        if rows::is_row(&line.text) {
            return rows::read(line, lines, given);
        }
        if columns::are_names(&line.text) {
            return table::read(&line, lines, format, given);
        }
        if !rows::is_remark(&line.text) {
            titles.push(line);
        }
        if titles.len() > rows::MOST_TITLES {
            break;
        }
    }
    match titles.first() {
        None => Err(Problem::of_file(shown, "the file has no points", EMPTY_HINT).into()),
        Some(line) => {
            let message = "neither numbers nor names of columns such as `x_mm`";
            Err(line
                .problem(shown, 0..line.text.len(), message, EMPTY_HINT)
                .into())
        }
    }
}

#[cfg(test)]
mod tests;
