//! Cells of the first sheet of an Excel workbook, by rows.

use std::collections::BTreeMap;
use std::io::Cursor;

use calamine::{DataRef, Reader, Xlsx};

use crate::document::{Problem, Problems};

/// Maximum size of a workbook, byte; unpacked it may be eight times as large.
const LARGEST_WORKBOOK: usize = 64 << 20;
/// Maximum number of cells of a sheet.
const MOST_CELLS: usize = 10_000_000;
/// How an Excel workbook begins: a zip archive.
const ZIP: &[u8] = b"PK\x03\x04";
/// Columns beyond this many right of the first one are not part of a table.
const MOST_COLUMNS: u32 = 256;

/// Whether these bytes are a zip archive, as an Excel workbook is.
pub(super) fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(ZIP)
}

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SheetCell<'a> {
    Number(f64),
    Text(&'a str),
    /// A logical value, a date or an error.
    Other,
}

/// Rows by their index, from 0: column and value of each cell, in the order of the file.
pub(super) type SparseRows<T> = BTreeMap<u32, Vec<(u32, T)>>;

/// The cells of the first sheet that are not empty.
///
/// # Errors
/// A workbook that is damaged or too large.
pub(super) fn first_sheet<T>(
    path: &str,
    bytes: &[u8],
    value: impl Fn(SheetCell<'_>) -> T,
) -> Result<SparseRows<T>, Problems> {
    let refused = |message: String, hint: &str| Problems::from(Problem::of_file(path, message, hint));
    if bytes.len() > LARGEST_WORKBOOK {
        let message = format!("the workbook is larger than {} MiB", LARGEST_WORKBOOK >> 20);
        return Err(refused(message, "save the sheet as CSV"));
    }
    let damaged = |error: &dyn std::fmt::Display| {
        refused(
            format!("not a workbook that can be read: {error}"),
            "save the sheet as CSV, or the workbook as .xlsx",
        )
    };
    check_unpacked_size(bytes).map_err(|message| damaged(&message))?;
    let mut workbook: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let Some(name) = workbook.sheet_names().first().cloned() else {
        return Err(damaged(&"it has no sheet"));
    };
    let mut sheet = workbook
        .worksheet_cells_reader(&name)
        .map_err(|error| damaged(&error))?;
    // A cell at the far corner of the sheet must not take the memory of all cells before it.
    let mut sparse: SparseRows<T> = BTreeMap::new();
    let mut count = 0;
    while let Some(cell) = sheet.next_cell().map_err(|error| damaged(&error))? {
        let value = match cell.get_value() {
            DataRef::Empty => continue,
            DataRef::Float(number) => value(SheetCell::Number(*number)),
            DataRef::Int(number) => value(SheetCell::Number(*number as f64)),
            DataRef::String(text) => value(SheetCell::Text(text)),
            DataRef::SharedString(text) => value(SheetCell::Text(text)),
            _ => value(SheetCell::Other),
        };
        count += 1;
        if count > MOST_CELLS {
            let message = format!("the sheet has more than {MOST_CELLS} cells");
            return Err(refused(message, "save the requested columns as CSV"));
        }
        let (row, column) = cell.get_position();
        sparse.entry(row).or_default().push((column, value));
    }
    Ok(sparse)
}

/// The first sheet as a text: a line for each row of the sheet, cells separated by tabs.
///
/// # Errors
/// As of [`first_sheet`].
pub(super) fn first_sheet_as_text(path: &str, bytes: &[u8]) -> Result<String, Problems> {
    let rows = first_sheet(path, bytes, |cell| match cell {
        SheetCell::Number(number) => number.to_string(),
        SheetCell::Text(text) => text.split(char::is_control).collect::<Vec<_>>().join(" "),
        SheetCell::Other => "?".to_owned(),
    })?;
    let left = rows.values().flatten().map(|cell| cell.0).min().unwrap_or(0);
    let width = rows.values().next().map_or(0, |titles| {
        let right = titles
            .iter()
            .map(|cell| cell.0)
            .filter(|column| *column < left.saturating_add(MOST_COLUMNS));
        right.max().map_or(0, |right| right - left + 1)
    });
    let mut text = String::new();
    let mut next = 0;
    for (index, mut row) in rows {
        (next..index).for_each(|_| text.push('\n'));
        next = index + 1;
        row.sort_by_key(|cell| cell.0);
        row.dedup_by_key(|cell| cell.0);
        let mut cells = row.into_iter().peekable();
        let within = left..left + width.max(1);
        for column in within {
            if column > left {
                text.push('\t');
            }
            if let Some(cell) = cells.next_if(|cell| cell.0 == column) {
                text.push_str(&cell.1);
            }
        }
        text.push('\n');
    }
    Ok(text)
}

/// Refuses an archive that would unpack to more than eight times the largest workbook.
fn check_unpacked_size(bytes: &[u8]) -> Result<(), String> {
    let archive = rawzip::ZipArchive::from_slice(bytes).map_err(|error| error.to_string())?;
    let mut size: u64 = 0;
    for entry in archive.entries() {
        let entry = entry.map_err(|error| error.to_string())?;
        size = size.saturating_add(entry.uncompressed_size_hint());
    }
    match size > 8 * LARGEST_WORKBOOK as u64 {
        true => Err(format!("it unpacks to {} MiB", size >> 20)),
        false => Ok(()),
    }
}
