//! Where do the points of a round profile lie? Points as measuring machines and roundness instruments write them.
//!
//! - [`columns`](mod@columns): what a column is, in which unit, and the point of a row.
//! - [`table`]: tables whose columns name their units.
//! - [`plain`]: points in rows without names, such as those of NIST.
//! - [`qif`]: results of coordinate measuring machines.
//!
//! Which of the three a file is in is seen in its first line that is no remark: `<` begins QIF, a number a file without
//! names. All lengths come out in m.

pub mod columns;
pub mod plain;
pub mod qif;
pub mod table;

use std::io::{BufRead, Cursor, Read};

use armill_core::nalgebra::{Point2, Point3};

pub use self::columns::LengthUnit;
pub use self::qif::ActualCircle;
use crate::document::{Problem, Problems};
use crate::table::sheet::is_remark;

/// A kind of file of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table with named columns.
    Table,
    /// Rows of numbers without names.
    Plain,
    /// Quality Information Framework, XML.
    Qif,
}

impl Format {
    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Format::Table => "table",
            Format::Plain => "rows without names",
            Format::Qif => "QIF",
        }
    }
}

/// What a file does not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// The radius that deviations are told from, mm.
    pub radius_mm: Option<f64>,
    /// The same where deviations are told and nothing else is known, mm.
    pub else_radius_mm: Option<f64>,
    /// The unit of rows without names.
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

/// What a file held.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its format.
    pub format: Format,
    /// The points, in order.
    pub points: Points,
    /// The line that each point stands on, from 1.
    pub lines: Vec<usize>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
}

/// So much of a file is looked at for its format, in bytes.
const HEAD_BYTES: u64 = 1 << 12;
/// A profile has no more points: an hour of an instrument that takes 10 000 a second.
const MOST_POINTS: usize = 20_000_000;

impl Points {
    /// How many.
    pub fn count(&self) -> usize {
        match self {
            Points::Plane(points) => points.len(),
            Points::Space(points) => points.len(),
        }
    }

    /// Takes a point of as many coordinates as the others have.
    fn push(&mut self, [x, y, z]: [f64; 3]) {
        match self {
            Points::Plane(points) => points.push(Point2::new(x, y)),
            Points::Space(points) => points.push(Point3::new(x, y, z)),
        }
    }
}

/// Reads the profile in `reader`; `path` is what problems show.
///
/// # Errors
/// Every problem of the file, at most 200. Of a QIF file: the circles that it holds in place of points, for it tells no
/// points that were measured.
pub fn read(path: &str, mut reader: impl BufRead, wanted: &Wanted) -> Result<Measured, Problems> {
    let mut head = Vec::new();
    let begun = reader.by_ref().take(HEAD_BYTES).read_to_end(&mut head);
    begun.map_err(|error| {
        let message = format!("cannot read it: {error}");
        Problem::of_file(path, message, "is the disk there?")
    })?;
    let format = format_of(&head);
    let whole = Cursor::new(head).chain(reader);
    match format {
        Format::Table => table::read(path, whole, wanted),
        Format::Plain => plain::read(path, whole, wanted),
        Format::Qif => qif::read(path, whole),
    }
}

/// The format of a file that begins so.
pub fn format_of(head: &[u8]) -> Format {
    let text = String::from_utf8_lossy(head);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut lines = text.split(['\n', '\r']);
    let first = lines.find(|line| !is_remark(line)).unwrap_or("").trim_start();
    if first.starts_with('<') {
        return Format::Qif;
    }
    let word = first.split([' ', '\t', ',', ';']).next().unwrap_or("");
    match word.replace(',', ".").parse::<f64>() {
        Ok(_) => Format::Plain,
        Err(_) => Format::Table,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_is_seen_in_the_first_line_that_is_no_remark() {
        for (text, format) in [
            ("x_mm,y_mm\n", Format::Table),
            ("# 1 2 3\n\n\u{20}x_mm;y_mm\n", Format::Table),
            ("", Format::Table),
            ("38\n1 2 3\n", Format::Plain),
            ("\u{feff}# by hand\r\n1,5\t2,5\r\n", Format::Plain),
            ("-1e3;2;3\n", Format::Plain),
            ("<?xml version=\"1.0\"?>\n", Format::Qif),
            ("\u{feff}\n <QIFDocument>", Format::Qif),
        ] {
            assert_eq!(format_of(text.as_bytes()), format, "{text:?}");
        }
    }
}
