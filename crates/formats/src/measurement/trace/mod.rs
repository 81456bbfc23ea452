//! Tip traces: measured points of one or several runs along a path, and the commanded points.
//!
//! | column | meaning | units |
//! |---|---|---|
//! | `x_mm`, `y_mm`, `z_mm` | a point, in any axes | `_mm`, `_um`, `_m`, `_in` |
//! | `run` | name of the run, any text; without it the file is one run | |
//!
//! One row per point, in order of time. Names and units are not case-sensitive. Other columns are ignored and listed.
//! Cells are separated by `;`, tab or `,`. With `;` or tab, decimal commas are read too. Lines that begin with `#` and
//! empty lines are ignored. All lengths are returned in m.
//!
//! A file that begins with `//` is an export of SpatialAnalyzer (`spatial_analyzer`). `runs`: the points of each run.
//!
//! ```text
//! run,x_mm,y_mm,z_mm              x_mm;y_mm;z_mm
//! 1,0.012,-0.003,0.001            12,5013;-3,2;100
//! ```

mod runs;
mod spatial_analyzer;

use std::io::BufRead;

use armill_core::nalgebra::Vector3;

use runs::{FARTHEST, LIMIT};
pub use runs::{Trace, Traces};

use super::profile::LengthUnit;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{each_row, named_columns, number, row_cells, separator_of};

const HINT: &str = "use one row per point, `x_mm,y_mm,z_mm`, and `run` if the file has several runs";

/// Meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// Coordinate x, y, z: 0, 1, 2; and the factor of its unit to m.
    Along(usize, f64),
    Run,
}

/// Reads the points in `reader`. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: missing or duplicate columns, units that are missing or unknown, cells
/// that are not numbers, rows of another length, positions out of range.
pub fn read(path: &str, reader: impl BufRead) -> Result<Traces, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(first) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no points", HINT).into());
    };
    if spatial_analyzer::is_export(&first) {
        return spatial_analyzer::read(path, first, lines);
    }
    let mut found = Traces::default();
    let table = Table::of(path, &first, &mut found.unused)?;
    each_row(&mut lines, table.separator, LIMIT, |line| {
        let (run, point) = table.row(line)?;
        found.take(run, point, line.number);
        Ok(())
    })?;
    match found.runs.is_empty() {
        true => Err(Problem::of_file(path, "the file has no points", HINT).into()),
        false => Ok(found),
    }
}

/// The column of a name; `None` for an unknown name.
fn named(name: &str) -> Result<Option<Column>, (String, String)> {
    let lower = name.trim().to_lowercase();
    let axis = |letter: &str| ["x", "y", "z"].iter().position(|own| *own == letter);
    if lower == "run" {
        return Ok(Some(Column::Run));
    }
    let units = "known units are mm, um, m or in";
    if axis(&lower).is_some() {
        return Err((
            format!("no unit is given for `{name}`"),
            format!("end the name with its unit: {units}"),
        ));
    }
    let Some((plain, unit)) = lower.rsplit_once('_') else {
        return Ok(None);
    };
    let Some(axis) = axis(plain) else {
        return Ok(None);
    };
    match unit.parse::<LengthUnit>() {
        Ok(unit) => Ok(Some(Column::Along(axis, unit.factor()))),
        Err(_) => Err((format!("`{unit}` is not a unit of `{plain}`"), units.to_owned())),
    }
}

/// Meaning of the columns of a file.
struct Table<'a> {
    path: &'a str,
    separator: char,
    /// `None` is ignored.
    columns: Vec<Option<Column>>,
}

impl<'a> Table<'a> {
    /// From the header line; unknown names are added to `unused`.
    fn of(path: &'a str, line: &Line, unused: &mut Vec<String>) -> Result<Table<'a>, Problems> {
        let is_same = |one, other| match (one, other) {
            (Column::Along(own, _), Column::Along(other, _)) => own == other,
            (one, other) => one == other,
        };
        let named = named_columns(path, line, named, is_same);
        unused.extend(named.unused);
        // A name with a problem is also missing.
        Problems::from(named.problems).into_result()?;
        let has = |axis: usize| {
            let mut known = named.columns.iter().flatten();
            known.any(|column| matches!(column, Column::Along(own, _) if *own == axis))
        };
        let missing: Vec<&str> = (0..3)
            .filter(|axis| !has(*axis))
            .map(|axis| ["`x_mm`", "`y_mm`", "`z_mm`"][axis])
            .collect();
        if !missing.is_empty() {
            let message = format!("columns are missing: {}", missing.join(", "));
            return Err(line.problem(path, 0..line.text.len(), message, HINT).into());
        }
        Ok(Table {
            path,
            separator: separator_of(&line.text),
            columns: named.columns,
        })
    }

    /// Run and point of a row.
    fn row(&self, line: &Line) -> Result<(String, Vector3<f64>), Problems> {
        let found = row_cells(self.path, line, self.separator, self.columns.len())?;
        let (mut point, mut run, mut problems) = (Vector3::zeros(), String::new(), Vec::new());
        for (cell, column) in found.iter().zip(&self.columns) {
            let (axis, factor) = match column {
                None => continue,
                Some(Column::Run) => {
                    run = cell.text.to_string();
                    continue;
                }
                Some(Column::Along(axis, factor)) => (*axis, *factor),
            };
            let problem = |message, hint| line.problem(self.path, cell.span.clone(), message, hint);
            match number(&cell.text, self.separator).filter(|number| number.is_finite()) {
                None => problems.push(problem(
                    format!("`{}` is not a number", cell.text),
                    "give the unit in the column name; remove rows that were not measured",
                )),
                Some(number) if (number * factor).abs() > FARTHEST => problems.push(problem(
                    format!("a length of {} m exceeds {FARTHEST} m", number * factor),
                    "check the unit in the column name",
                )),
                Some(number) => point[axis] = number * factor,
            }
        }
        Problems::from(problems).into_result()?;
        Ok((run, point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        read("trace.csv", text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn runs_are_separated_in_the_order_of_the_file_with_any_units() {
        let text = "# tracker\nRun;X_um;y_m;z_in;time\n1;1000;0,5;1;7\n2;2000;0;0;7\n\n1;3000;0;0;8\n";
        let found = read("trace.csv", text.as_bytes()).unwrap();
        assert_eq!(found.unused, ["time"]);
        let [one, two] = &found.runs[..] else {
            panic!("{found:?}")
        };
        assert_eq!((one.run.as_str(), two.run.as_str()), ("1", "2"));
        assert_eq!(one.lines, [3, 6]);
        assert!((one.points[0] - Vector3::new(1e-3, 0.5, 0.0254)).norm() < 1e-15);
        assert!((two.points[0] - Vector3::new(2e-3, 0.0, 0.0)).norm() < 1e-15);
        let alone = read("trace.csv", "x_mm,y_mm,z_mm\n1,2,3\n4,5,6\n".as_bytes()).unwrap();
        assert_eq!((alone.runs.len(), alone.runs[0].points.len()), (1, 2));
    }

    #[test]
    fn all_problems_are_reported_with_their_positions() {
        let text = "x_mm,y_mm,z_mm\n1,a,3\n1,2\n1e9,2,inf\n";
        let problems = refused(text);
        for said in [
            "trace.csv:2:3",
            "`a` is not a number",
            "trace.csv:3:1",
            "2 cells, but the table has 3 columns",
            "trace.csv:4:1",
            "exceeds 10000 m",
            "trace.csv:4:7",
        ] {
            assert!(problems.contains(said), "{said}: {problems}");
        }
        assert!(refused("x_mm,y_mm\n1,2\n").contains("columns are missing: `z_mm`"));
        assert!(refused("x,y_mm,z_mm\n1,2,3\n").contains("no unit is given for `x`"));
        assert!(refused("x_mm,y_ft,z_mm\n1,2,3\n").contains("`ft` is not a unit of `y`"));
        assert!(refused("x_mm,x_um,y_mm,z_mm\n1,2,3,4\n").contains("repeats an earlier column"));
        assert!(refused("").contains("the file has no points"));
        assert!(refused("x_mm,y_mm,z_mm\n").contains("the file has no points"));
    }
}
