//! Points of a round profile, as coordinate measuring machines and roundness instruments write them.
//!
//! - [`columns`](mod@columns): quantity and unit of a column, and the point of a row.
//! - `table`: tables whose column names state their units.
//! - `plain`: points in rows without a header, such as those of NIST.
//! - `qif`: results of coordinate measuring machines, which contain no points.
//!
//! The format is recognised from the beginning: `<` begins QIF; otherwise a number in the first line that is not a
//! comment begins a file without a header. All lengths are returned in m.

pub mod columns;
mod plain;
mod qif;
mod table;

use std::io::BufRead;

use armill_core::nalgebra::{Point2, Point3};

use self::columns::COLUMNS_HINT;
pub use self::columns::LengthUnit;
use crate::document::lines::Lines;
use crate::document::{Problem, Problems, unreadable};

/// Format of a file of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table with named columns.
    Table,
    /// Rows of numbers without a header.
    Plain,
}

impl Format {
    /// Its name, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Format::Table => "table",
            Format::Plain => "rows without header",
        }
    }
}

/// Values that the file does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfileReadOptions {
    /// The radius to which deviations refer, mm.
    pub radius_mm: Option<f64>,
    /// The radius to use if the file has deviations and no other radius is known, mm.
    pub else_radius_mm: Option<f64>,
    /// The unit of rows without a header.
    pub unit: Option<LengthUnit>,
}

/// Points, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// In the plane of the profile.
    Plane(Vec<Point2<f64>>),
    /// In space, near a plane.
    Space(Vec<Point3<f64>>),
}

/// Content of a file of points.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredProfile {
    /// Its format.
    pub format: Format,
    /// The points, in order.
    pub points: Points,
    /// Line of each point, from 1.
    pub lines: Vec<usize>,
    /// Ignored columns.
    pub unused: Vec<String>,
}

/// Maximum number of points: an hour of an instrument that takes 10 000 per second.
const MOST_POINTS: usize = 20_000_000;

impl Points {
    /// Number of points.
    pub fn count(&self) -> usize {
        match self {
            Points::Plane(points) => points.len(),
            Points::Space(points) => points.len(),
        }
    }

    /// Adds a point with as many coordinates as the others.
    fn push(&mut self, [x, y, z]: [f64; 3]) {
        match self {
            Points::Plane(points) => points.push(Point2::new(x, y)),
            Points::Space(points) => points.push(Point3::new(x, y, z)),
        }
    }
}

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
