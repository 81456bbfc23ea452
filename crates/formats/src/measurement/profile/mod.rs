//! Points of a round profile, as coordinate measuring machines and roundness instruments write them.
//!
//! - `length_unit`: units of lengths; `measured`: what is read from a file, and what must be given in addition to it.
//! - [`columns`](mod@columns): quantity and unit of a column, and the point of a row.
//! - `table`: tables whose column names state their units.
//! - `plain`: points in rows without a header, such as those of NIST.
//! - `qif`: results of coordinate measuring machines, which contain no points.
//!
//! The format is recognised from the beginning: `<` begins QIF; otherwise a number in the first line that is not a
//! comment begins a file without a header. All lengths are returned in m.

pub mod columns;
mod length_unit;
mod measured;
pub(super) mod plain;
pub(super) mod qif;
mod table;

use std::io::BufRead;

use self::columns::COLUMNS_HINT;
pub use self::length_unit::LengthUnit;
pub use self::measured::{Format, MeasuredProfile, Points, ProfileReadOptions};
use crate::document::lines::Lines;
use crate::document::{Problem, Problems, unreadable};

/// Reads the profile in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200. For a QIF file: the circles that it contains, because it has no measured
/// points.
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    requested: &ProfileReadOptions,
) -> Result<MeasuredProfile, Problems> {
    let head = reader.fill_buf().map_err(|error| unreadable(path, &error))?;
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    if head.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'<') {
        return Err(qif::refusal(path, reader));
    }
    let mut lines = Lines::new(path, reader);
    match lines.next_row()? {
        None => Err(Problem::of_file(path, "the file has no points", COLUMNS_HINT).into()),
        Some(first) if begins_with_number(&first.text) => plain::read(first, lines, requested),
        Some(first) => table::read(first, lines, requested),
    }
}

/// Whether a first line contains numbers, not names.
fn begins_with_number(line: &str) -> bool {
    let word = line.split_whitespace().next().unwrap_or_default();
    let word = word.split([',', ';']).next().unwrap_or_default();
    word.parse::<f64>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_is_recognised_from_the_first_line_that_is_not_a_comment() {
        let requested = ProfileReadOptions {
            unit: Some(LengthUnit::Millimetre),
            ..ProfileReadOptions::default()
        };
        let remarks = "# by hand, with much to say\n".repeat(10_000);
        for (text, format) in [
            ("x_mm,y_mm\n1,2\n", Some(Format::Table)),
            ("# 1 2 3\n\n\u{20}x_mm;y_mm\n1;2\n", Some(Format::Table)),
            ("1\n1 2 3\n", Some(Format::Plain)),
            ("\u{feff}# by hand\r\n1,5\t2,5\r\n", Some(Format::Plain)),
            ("-1e3;2;3\n", Some(Format::Plain)),
            (&format!("{remarks}1 2 3\n"), Some(Format::Plain)),
            ("<?xml version=\"1.0\"?>\n", None),
            ("\u{feff}\n <QIFDocument>", None),
        ] {
            let given = match format {
                Some(Format::Plain) => requested,
                _ => ProfileReadOptions::default(),
            };
            match (read("f", text.as_bytes(), &given), format) {
                (Ok(measured), Some(format)) => assert_eq!(measured.format, format),
                (Err(problems), None) => assert!(problems.to_string().contains("not XML"), "{problems}"),
                (found, _) => panic!("{found:?}"),
            }
        }
        let empty = read("f", "# nothing\n".as_bytes(), &requested).unwrap_err();
        assert!(empty.to_string().contains("the file has no points"));
    }
}
