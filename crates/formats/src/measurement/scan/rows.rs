//! Rows of numbers without names: x, y, z, and if the next three are a vector of length 1, a normal.
//!
//! Numbers are separated by blanks, tabs, `;` or `,`; a decimal comma is read where commas do not separate. Lines that begin
//! with `#`, `//`, `%`, `!` or `;` are remarks, lines before the first row titles. A first line with a single whole number is the
//! number of points (PTS). Further columns (colour, intensity) are not used.

use std::io::BufRead;

use super::measured::{LIMIT, Scan, ScanFormat, ScanReadOptions, normal_of, point_of, unit_of};
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::measurement::profile::plain::pieces;
use crate::table::sheet::{each_row, number};

/// Lines before the first row.
pub(super) const MOST_TITLES: usize = 100;
/// What a row is.
const ROWS_HINT: &str = "a row contains x, y and z, with or without the normal nx, ny, nz";
/// Numbers of a row that are read.
const MOST_NUMBERS: usize = 6;

/// Whether a line has no content.
pub(super) fn is_remark(line: &str) -> bool {
    let line = line.trim_start();
    ["//", "%", "!", ";", "#"]
        .iter()
        .any(|mark| line.starts_with(mark))
        || line.is_empty()
}

/// Whether a line is numbers.
pub(super) fn is_row(line: &str) -> bool {
    let mut found = pieces(line).peekable();
    found.peek().is_some()
        && found
            .take(MOST_NUMBERS)
            .all(|piece| number(piece.1, ';').is_some())
}

/// Reads the rows from `first` on.
///
/// # Errors
/// All problems of the file, at most 200.
pub(super) fn read(
    first: Line,
    mut lines: Lines<impl BufRead>,
    given: &ScanReadOptions,
) -> Result<Scan, Problems> {
    let path = lines.name().to_owned();
    let mut scan = Scan::empty(ScanFormat::Rows);
    let factor = unit_of(given, &mut scan);
    let mut rows = Rows {
        path: &path,
        factor,
        has_normals: false,
        scan,
    };
    let count: Option<usize> = first.text.trim().parse().ok();
    let mut problems = Vec::new();
    if count.is_none() {
        rows.has_normals =
            numbers(&path, &first).is_ok_and(|row| normal_of([row[3], row[4], row[5]]).is_some());
        problems.extend(rows.take(&first).err().into_iter().flatten());
    }
    let mut is_second = count.is_some();
    let read = each_row(&mut lines, ' ', LIMIT, |line| {
        if is_remark(&line.text) {
            return Ok(());
        }
        if std::mem::take(&mut is_second) {
            rows.has_normals =
                numbers(&path, line).is_ok_and(|row| normal_of([row[3], row[4], row[5]]).is_some());
        }
        rows.take(line)
    });
    problems.extend(read.err().into_iter().flatten());
    if let Some(count) = count
        && problems.is_empty()
        && count != rows.scan.points.len()
    {
        let message = format!(
            "the first line specifies {count} points, but {} follow",
            rows.scan.points.len()
        );
        let hint = "check whether the file is complete";
        problems.push(first.problem(&path, 0..first.text.len(), message, hint));
    }
    Problems::from(problems).into_result()?;
    if rows.scan.points.is_empty() {
        return Err(Problem::of_file(&path, "the file has no points", ROWS_HINT).into());
    }
    Ok(rows.scan.finished())
}

/// The points so far.
struct Rows<'a> {
    path: &'a str,
    factor: f64,
    has_normals: bool,
    scan: Scan,
}

impl Rows<'_> {
    fn take(&mut self, line: &Line) -> Result<(), Problems> {
        let [x, y, z, normal @ ..] = numbers(self.path, line)?;
        let point = point_of([x, y, z].map(|value| value * self.factor)).map_err(|message| {
            line.problem(
                self.path,
                0..line.text.len(),
                message,
                "check the unit of the file",
            )
        })?;
        self.scan.points.push(point);
        if self.has_normals {
            self.scan.normals.push(normal_of(normal));
        }
        Ok(())
    }
}

/// The first numbers of a row, 0 where it has fewer than six.
fn numbers(path: &str, line: &Line) -> Result<[f64; MOST_NUMBERS], Problems> {
    let mut row = [0.0; MOST_NUMBERS];
    let mut count = 0;
    let mut problems = Vec::new();
    for ((at, piece), value) in pieces(&line.text).zip(&mut row) {
        count += 1;
        match number(piece, ';').filter(|number| number.is_finite()) {
            Some(number) => *value = number,
            None => {
                let message = format!("`{piece}` is not a number");
                problems.push(line.problem(path, at..at + piece.len(), message, ROWS_HINT));
            }
        }
    }
    if count < 3 {
        let message = format!("{count} numbers in a row: at least 3 required");
        problems.push(line.problem(path, 0..line.text.len(), message, ROWS_HINT));
    }
    Problems::from(problems).into_result()?;
    Ok(row)
}
