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

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A workbook with this sheet.
    pub fn workbook_of(sheet: &str) -> Vec<u8> {
        let files = [
            (
                "[Content_Types].xml",
                r#"<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="xml" ContentType="application/xml"/><Override PartName="/xl/workbook.xml" ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"/></Types>"#,
            ),
            (
                "_rels/.rels",
                r#"<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>"#,
            ),
            (
                "xl/workbook.xml",
                r#"<?xml version="1.0"?><workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets><sheet name="Sheet1" sheetId="1" r:id="r1"/></sheets></workbook>"#,
            ),
            (
                "xl/_rels/workbook.xml.rels",
                r#"<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#,
            ),
            ("xl/worksheets/sheet1.xml", sheet),
        ];
        let mut bytes = Cursor::new(Vec::new());
        let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
        for (name, text) in files {
            use std::io::Write as _;
            let (mut entry, config) = archive.new_file(name).start().unwrap();
            let mut data = config.wrap(&mut entry);
            data.write_all(text.as_bytes()).unwrap();
            let (_, output) = data.finish().unwrap();
            entry.finish(output).unwrap();
        }
        archive.finish().unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_sheet_is_a_text_with_a_line_for_each_row() {
        let cell = |place: &str, value: &str| format!(r#"<c r="{place}"><v>{value}</v></c>"#);
        let text =
            |place: &str, value: &str| format!(r#"<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>"#);
        let sheet = format!(
            r#"<?xml version="1.0"?><worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData><row r="2">{}{}{}</row><row r="4">{}{}{}</row></sheetData></worksheet>"#,
            text("B2", "x_mm"),
            text("C2", "y&#9;mm"),
            text("D2", "z_mm"),
            cell("B4", "1.5"),
            cell("D4", "-3"),
            cell("F4", "7"),
        );
        let read = first_sheet_as_text("a.xlsx", &workbook_of(&sheet)).unwrap();
        assert_eq!(read, "\nx_mm\ty mm\tz_mm\n\n1.5\t\t-3\n");
    }
}
