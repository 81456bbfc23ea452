//! A profile as a table: one row per point. The name of each column states its unit.
//!
//! Columns: see [`columns`](super::columns). Others are ignored and listed. Cells are separated by `;`, tab or `,`.
//! With `;` or tab, decimal commas are read too. Lines that begin with `#` and empty lines are ignored.
//!
//! ```text
//! angle_deg,radius_mm             # bore 3            x_mm;y_mm;z_mm
//! 0,25.0012                       angle_deg;deviation_um    12,5013;-3,2;100
//! 0.1,25.0013                     0;1,2
//! ```

use std::io::BufRead;

use super::columns::{COLUMNS_HINT, Column, Layout, Quantity, named};
use super::measured::{Format, LIMIT, MeasuredProfile, Points, ProfileReadOptions};
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{each_row, named_columns, number, row_cells, separator_of};

/// Reads the table below the header line `first`.
///
/// # Errors
/// All problems of the file, at most 200: columns that give no points, duplicate columns, units that are missing or
/// unknown, cells that are not numbers, rows of another length, points out of range.
pub(super) fn read(
    first: Line,
    mut lines: Lines<impl BufRead>,
    requested: &ProfileReadOptions,
) -> Result<MeasuredProfile, Problems> {
    let path = &lines.name().to_owned();
    let table = Table::of(path, &first, requested)?;
    let mut measured = MeasuredProfile {
        format: Format::Table,
        points: match table.layout.is_space() {
            true => Points::Space(Vec::new()),
            false => Points::Plane(Vec::new()),
        },
        lines: Vec::new(),
        unused: table.unused.clone(),
    };
    each_row(&mut lines, table.separator, LIMIT, |line| {
        let point = table.point(line)?;
        measured.points.push(point);
        measured.lines.push(line.number);
        Ok(())
    })?;
    if measured.points.count() == 0 {
        return Err(Problem::of_file(path, "the file has no points", COLUMNS_HINT).into());
    }
    Ok(measured)
}

/// Meaning of the columns of a file.
struct Table<'a> {
    path: &'a str,
    separator: char,
    /// `None` is ignored.
    columns: Vec<Option<Column>>,
    layout: Layout,
    unused: Vec<String>,
}

impl<'a> Table<'a> {
    /// From the header line.
    fn of(path: &'a str, line: &Line, requested: &ProfileReadOptions) -> Result<Table<'a>, Problems> {
        let whole = 0..line.text.len();
        let named = named_columns(path, line, named, |one, other| one.quantity == other.quantity);
        let mut problems = named.problems;
        if let Some(unit) = requested.unit {
            let message = format!("the unit {unit} was specified, but the columns state their units");
            problems.push(line.problem(path, whole.clone(), message, "leave out the unit"));
        }
        // A name with a problem also makes the layout wrong.
        Problems::from(problems).into_result()?;
        let quantities: Vec<Quantity> = named.columns.iter().flatten().map(|c| c.quantity).collect();
        let layout = Layout::of(&quantities, requested)
            .map_err(|(message, hint)| line.problem(path, whole, message, hint))?;
        Ok(Table {
            path,
            separator: separator_of(&line.text),
            columns: named.columns,
            layout,
            unused: named.unused,
        })
    }

    /// The point of a row.
    fn point(&self, line: &Line) -> Result<[f64; 3], Problems> {
        let found = row_cells(self.path, line, self.separator, self.columns.len())?;
        let mut values = [(Quantity::Angle, 0.0); 6];
        let mut problems = Vec::new();
        let meant = found
            .iter()
            .zip(&self.columns)
            .filter_map(|(cell, column)| Some((cell, (*column)?)));
        for ((cell, column), value) in meant.clone().zip(&mut values) {
            match number(&cell.text, self.separator).filter(|number| number.is_finite()) {
                Some(number) => *value = (column.quantity, number * column.factor),
                None => {
                    let message = format!("`{}` is not a number", cell.text);
                    let hint = "give the unit in the column name; remove rows that were not measured";
                    problems.push(line.problem(self.path, cell.span.clone(), message, hint));
                }
            }
        }
        Problems::from(problems).into_result()?;
        let value = |requested: Quantity| {
            let found = values.iter().find(|(quantity, _)| *quantity == requested);
            found.map_or(0.0, |(_, value)| *value)
        };
        self.layout.point(value).map_err(|(quantity, message)| {
            let cell = meant.clone().find(|(_, column)| column.quantity == quantity);
            let span = cell.map_or(0..line.text.len(), |(cell, _)| cell.span.clone());
            line.problem(self.path, span, message, "check the unit in the column name")
                .into()
        })
    }
}

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::{Point2, Point3};

    use super::*;

    fn read_with(text: &str, radius_mm: Option<f64>) -> Result<MeasuredProfile, String> {
        let requested = ProfileReadOptions {
            radius_mm,
            else_radius_mm: None,
            unit: None,
        };
        super::super::read("bore.csv", text.as_bytes(), &requested).map_err(|problems| problems.to_string())
    }

    fn plane(text: &str) -> Vec<Point2<f64>> {
        match read_with(text, None).unwrap().points {
            Points::Plane(points) => points,
            Points::Space(_) => panic!("points in space"),
        }
    }

    #[test]
    fn the_same_points_in_other_units_separators_and_coordinates_are_the_same() {
        let first = plane("x_mm,y_mm\n25,0\n0,25.001\n-25,0\n");
        assert!((first[1] - Point2::new(0.0, 0.025_001)).norm() < 1e-17);
        for text in [
            "\u{feff}# bore 3\r\nX_um;note;Y_mm\r\n\r\n25000;a;0\r\n0;b;25,001\r\n;;\r\n-25000;;0,0\r\n",
            "y_in\tx_m\n0\t0.025\n0.984291338582677\t0\n0,0\t-0,025\n",
            "angle_deg,radius_mm\n0,25\n90,25.001\n-180,25\n",
            "Theta_rad;r_um\n0;25000\n1,5707963267948966;25001\n3,141592653589793;25000\n",
        ] {
            let other = plane(text);
            for (a, b) in first.iter().zip(&other) {
                assert!((a - b).norm() < 1e-15, "{text}: {b}");
            }
            assert_eq!(other.len(), 3, "{text}");
        }
        let by_deviation = read_with("angle_deg,deviation_um\n0,0\n90,1\n180,0\n", Some(25.0)).unwrap();
        let Points::Plane(points) = by_deviation.points else {
            panic!("points in space")
        };
        assert!((points[1] - first[1]).norm() < 1e-15);
    }

    #[test]
    fn points_in_space_lines_and_unknown_columns_are_returned() {
        let found = read_with("x_mm,y_mm,z_mm,probe\n1,2,3,a\n# b\n4,5,6,c\n", None).unwrap();
        assert_eq!(
            found.points,
            Points::Space(vec![Point3::new(1e-3, 2e-3, 3e-3), Point3::new(4e-3, 5e-3, 6e-3)])
        );
        assert_eq!(
            (found.lines, found.unused),
            (vec![2, 4], vec!["probe".to_owned()])
        );
    }

    #[test]
    fn problems_are_reported_with_their_positions() {
        for (text, radius_mm, part) in [
            ("", None, "the file has no points"),
            ("x_mm,y_mm\n", None, "the file has no points"),
            ("a,b\n1,2\n", None, "these columns do not give points"),
            ("x_mm,radius_mm\n1,2\n", None, "these columns do not give points"),
            (
                "x_mm,y_mm,angle_deg,radius_mm\n1,2,3,4\n",
                None,
                "these columns do not give points",
            ),
            ("x,y_mm\n1,2\n", None, "1:1: no unit is given for `x`"),
            ("x_mm,y_kg\n1,2\n", None, "1:6: `kg` is not a unit of `y`"),
            (
                "angle_mm,radius_mm\n1,2\n",
                None,
                "1:1: `mm` is not a unit of `angle`",
            ),
            (
                "x_mm,y_mm,X_um\n1,2,3\n",
                None,
                "1:11: `X_um` repeats an earlier column",
            ),
            (
                "x_mm,y_mm\n1,2\n3\n",
                None,
                "3:1: 1 cells, but the table has 2 columns",
            ),
            ("x_mm,y_mm\n1,5,2,5\n", None, "separate cells with `;`"),
            ("x_mm,y_mm\n1,two\n", None, "2:3: `two` is not a number"),
            ("x_mm,y_mm\n1,nan\n", None, "2:3: `nan` is not a number"),
            ("x_mm,y_mm\n1,1e300\n", None, "2:3: a coordinate of 1"),
            (
                "angle_deg,radius_mm\n1,-2\n",
                None,
                "2:3: a radius of -2 mm is not above 0 mm",
            ),
            ("angle_deg,radius_mm\n1e9,2\n", None, "exceeds 1000 turns"),
            (
                "angle_deg,deviation_um\n1,2\n",
                None,
                "deviations need the radius",
            ),
            (
                "angle_deg,deviation_um\n1,2\n",
                Some(0.0),
                "a radius of 0 mm is not above 0 mm",
            ),
            (
                "angle_deg,deviation_mm\n1,-7\n",
                Some(5.0),
                "2:3: a radius of -2 mm",
            ),
            (
                "x_mm,y_mm\n1,2\n",
                Some(5.0),
                "no column contains deviations from it",
            ),
        ] {
            let given = read_with(text, radius_mm).unwrap_err();
            assert!(
                given.contains(part) && given.contains("help: "),
                "{text}: {given}"
            );
        }
        let unit = ProfileReadOptions {
            radius_mm: None,
            else_radius_mm: None,
            unit: Some(super::super::LengthUnit::Inch),
        };
        let given = super::super::read("f", "x_mm,y_mm\n1,2\n".as_bytes(), &unit)
            .unwrap_err()
            .to_string();
        assert!(given.contains("the unit in was specified"), "{given}");
    }

    #[test]
    fn all_problems_are_reported_together() {
        let given = read_with("x_mm,y_mm\na,b\n1,2\n3\n4,c\n", None).unwrap_err();
        for place in ["2:1", "2:3", "4:1", "5:3"] {
            assert!(given.contains(&format!("bore.csv:{place}:")), "{given}");
        }
    }
}
