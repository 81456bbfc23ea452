//! Points in rows without a header: two or three coordinates per row; the unit is an option.
//!
//! The first line may give the number of points, as in the files of NIST's Algorithm Testing System. Numbers are
//! separated by blanks, tabs, `;` or `,`. A decimal comma is read if the numbers of a row are not separated by commas.
//!
//! ```text
//! 5
//! -0.26182    0.71022    -0.53523
//! 0.44656    -0.01363    -0.53523
//! ```

use std::io::BufRead;

use super::columns::Layout;
use super::length_unit::LengthUnit;
use super::measured::{Format, LIMIT, MeasuredProfile, Points, ProfileReadOptions};
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::number;

/// Reads the rows from `line` on.
///
/// # Errors
/// All problems of the file, at most 200: no unit given, cells that are not numbers, rows of another length, a number
/// of rows that differs from the first line, coordinates out of range.
pub(super) fn read(
    mut line: Line,
    mut lines: Lines<impl BufRead>,
    requested: &ProfileReadOptions,
) -> Result<MeasuredProfile, Problems> {
    let path = &lines.name().to_owned();
    let mut problems = Vec::new();
    let factor = requested.unit.map_or(1.0, LengthUnit::factor);
    if requested.unit.is_none() {
        let message = "the unit of these numbers is not given";
        problems.push(line.problem(path, 0..line.text.len(), message, UNIT_HINT));
    }
    if let Some(radius_mm) = requested.radius_mm {
        let message = format!("a radius of {radius_mm} mm was specified, but these are coordinates");
        problems.push(line.problem(path, 0..line.text.len(), message, "leave out the radius"));
    }
    let count: Option<(usize, Line)> = match line.text.trim().parse() {
        Ok(count) => Some((count, line.clone())),
        Err(_) => None,
    };
    if count.is_some() {
        let Some(second) = lines.next_row()? else {
            return Err(Problem::of_file(path, "the file has no points", ROWS_HINT).into());
        };
        line = second;
    }
    let width = pieces(&line.text).count();
    let layout = match width {
        2 => Layout::Plane,
        3 => Layout::Space,
        _ => {
            let message = format!("{width} numbers in a row, but points have 2 or 3 coordinates");
            problems.push(line.problem(path, 0..line.text.len(), message, ROWS_HINT));
            return Err(problems.into());
        }
    };
    let mut measured = MeasuredProfile {
        format: Format::Plain,
        points: match layout.is_space() {
            true => Points::Space(Vec::new()),
            false => Points::Plane(Vec::new()),
        },
        lines: Vec::new(),
        unused: Vec::new(),
    };
    let mut rows = 0;
    let mut row = Some(line);
    while let Some(line) = row.take()
        && problems.len() < MOST_PROBLEMS
    {
        rows += 1;
        if rows > LIMIT.most {
            problems.push(LIMIT.exceeded(path, &line));
            break;
        }
        match point(path, &line, layout, factor) {
            Ok(point) => {
                measured.points.push(point);
                measured.lines.push(line.number);
            }
            Err(wrong) => problems.extend(wrong),
        }
        row = lines.next_row().unwrap_or_else(|wrong| {
            problems.extend(wrong);
            None
        });
    }
    if let Some((count, line)) = count
        && count != rows
        && problems.len() < MOST_PROBLEMS
    {
        let message = format!("the first line specifies {count} points, but {rows} follow");
        problems.push(line.problem(
            path,
            0..line.text.len(),
            message,
            "check whether the file is complete",
        ));
    }
    Problems::from(problems).into_result()?;
    Ok(measured)
}

/// The numbers of a row with their positions.
pub(in crate::measurement) fn pieces(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // Commas separate numbers only if blanks and semicolons do not.
    let is_parted = text.trim().contains([' ', '\t', ';']);
    let parts = move |c: char| c.is_whitespace() || c == ';' || (c == ',' && !is_parted);
    text.split(parts)
        .filter(|piece| !piece.is_empty())
        .map(move |piece| {
            let at = piece.as_ptr() as usize - text.as_ptr() as usize;
            (at, piece.trim_end_matches(','))
        })
        .filter(|(_, piece)| !piece.is_empty())
}

/// The point of a row, m.
fn point(path: &str, line: &Line, layout: Layout, factor: f64) -> Result<[f64; 3], Problems> {
    let width = if layout.is_space() { 3 } else { 2 };
    let found: Vec<(usize, &str)> = pieces(&line.text).collect();
    let whole = || 0..line.text.len();
    if found.len() != width {
        let message = format!("{} numbers in a row, but {width} in the first row", found.len());
        return Err(line
            .problem(
                path,
                whole(),
                message,
                "all rows need the same number of coordinates",
            )
            .into());
    }
    let mut values = [0.0; 3];
    let mut problems = Vec::new();
    for ((at, piece), value) in found.iter().zip(&mut values) {
        match number(piece, ';').filter(|number| number.is_finite()) {
            Some(number) => *value = number * factor,
            None => {
                let message = format!("`{piece}` is not a number");
                problems.push(line.problem(path, *at..at + piece.len(), message, ROWS_HINT));
            }
        }
    }
    Problems::from(problems).into_result()?;
    let value = |quantity| match quantity {
        super::columns::Quantity::Coordinate(axis) => values[axis],
        _ => 0.0,
    };
    layout
        .point(value)
        .map_err(|(_, message)| line.problem(path, whole(), message, "check the unit").into())
}

const UNIT_HINT: &str = "give it (option `unit`: mm, um, m or in), or name the columns, such as `x_mm,y_mm`";
const ROWS_HINT: &str =
    "a row contains x and y, or x, y and z; the first line may contain the number of points";

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::{Point2, Point3};

    use super::*;

    fn read_in(unit: Option<LengthUnit>, text: &str) -> Result<MeasuredProfile, String> {
        let requested = ProfileReadOptions {
            radius_mm: None,
            else_radius_mm: None,
            unit,
        };
        super::super::read("cir.ds", text.as_bytes(), &requested).map_err(|problems| problems.to_string())
    }

    #[test]
    fn rows_with_and_without_a_number_of_points_are_read() {
        let three = [Point3::new(1e-3, 2e-3, 3e-3), Point3::new(4.5e-3, -5e-3, 6e-3)];
        for text in [
            "2\n1\t2\t3\n4.5 -5  6\n",
            "\u{feff}# NIST\r\n 2 \r\n  1 2 3\r\n\r\n4,5 -5,0 6\r\n",
            "1,2,3\n4.5,-5,6\n",
            "1;2;3\n4,5;-5;6\n",
            "1, 2, 3\n4.5, -5, 6\n",
        ] {
            let found = read_in(Some(LengthUnit::Millimetre), text).unwrap();
            let Points::Space(points) = found.points else {
                panic!("{text}")
            };
            for (a, b) in points.iter().zip(&three) {
                assert!((a - b).norm() < 1e-18, "{text}: {a}");
            }
            assert_eq!(points.len(), 2);
        }
        let inches = read_in(Some(LengthUnit::Inch), "1 2\n3 4\n").unwrap();
        assert_eq!(
            inches.points,
            Points::Plane(vec![
                Point2::new(0.0254, 0.0508),
                Point2::new(3.0 * 0.0254, 0.1016)
            ])
        );
    }

    #[test]
    fn problems_are_reported_with_their_positions() {
        let mm = Some(LengthUnit::Millimetre);
        for (unit, text, part) in [
            (
                None,
                "2\n1 2 3\n4 5 6\n",
                "1:1: the unit of these numbers is not given",
            ),
            (
                mm,
                "3\n1 2 3\n4 5 6\n",
                "1:1: the first line specifies 3 points, but 2 follow",
            ),
            (mm, "3\n", "the file has no points"),
            (mm, "1 2 3 4\n", "4 numbers in a row"),
            (
                mm,
                "1 2 3\n1 2\n",
                "2:1: 2 numbers in a row, but 3 in the first row",
            ),
            (mm, "1 2 3\n1 x 3\n", "2:3: `x` is not a number"),
            (mm, "1 2 3\n1 2 inf\n", "2:5: `inf` is not a number"),
            (mm, "1 2 3\n1 2 1e300\n", "2:1: a coordinate of"),
        ] {
            let given = read_in(unit, text).unwrap_err();
            assert!(
                given.contains(part) && given.contains("help: "),
                "{text}: {given}"
            );
        }
        let given = read_in(None, "9\n1 2 3\n1 x 3\n1 2\n").unwrap_err();
        for part in [
            "the unit of these numbers is not given",
            "the first line specifies 9 points, but 3",
            "3:3",
            "4:1",
        ] {
            assert!(given.contains(part), "{part}: {given}");
        }
    }
}
