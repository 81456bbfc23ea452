//! A path as a table: one row a point, the unit of each column in its name.
//!
//! | column | meaning | endings |
//! |---|---|---|
//! | `x`, `y`, `z` | the tip | `_mm`, `_m`, `_in` |
//! | `i`, `j`, `k` | direction from the tip towards the spindle, of length 1; all three or none | |
//! | `spin` | turn of the tool about its axis | `_deg`, `_rad` |
//! | `feed` | speed towards the point, above 0 | `_mm_per_min`, `_mm_per_s`, `_m_per_s`, `_in_per_min` |
//! | `rapid` | whether the move cuts nothing: `1`, `true`, `yes`, or not | |
//! | `spindle` | its speed, below 0 counterclockwise | `_rpm` |
//! | `axial_depth`, `radial_depth` | how deep the cutter is; both or none | `_mm`, `_m`, `_in` |
//! | `op`, `note` | name of the operation; for people | |
//!
//! A new operation begins if its name, the spindle or a depth changes. The columns are listed in
//! `docs/guide/tool-path-words.md`; `tests/toolpath/words.rs` tries each. The first row says where the tip
//! Cells are separated by `;`, tab or `,`. With `;` or tab, decimal commas are read too. Lines that begin
//! with `#` and empty ones are ignored.

use std::f64::consts::TAU;
use std::io::BufRead;

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::{Course, DepthOfCut, GivenSpin, Move, Operation, Pace, Step};
use armill_core::units::from_deg;

use super::Summary;
use super::direction::{LARGEST, direction};
use super::format::Format;
use crate::document::lines::is_remark;
use crate::document::lines::{Line, Lines};
use crate::document::unit::suggestion;
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::{self, Cell, cells, is_blank_row, row_cells, separator_of};

/// No table has more columns than this.
const MOST_COLUMNS: usize = 100;

/// Meaning of a column; numbers are the axis, then the factor to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// Coordinate of the tip, to m.
    Point(usize, f64),
    /// Part of the tool axis.
    Axis(usize),
    /// To rad.
    Spin(f64),
    /// To m/s.
    Feed(f64),
    Rapid,
    Spindle,
    AxialDepth(f64),
    RadialDepth(f64),
    /// Its name.
    Operation,
    Note,
}

/// Units of lengths by the ending of a name, with their factor to m.
const LENGTHS: [(&str, f64); 3] = [("mm", 1e-3), ("m", 1.0), ("in", 0.0254)];
/// Units of feeds, with their factor to m/s.
const SPEEDS: [(&str, f64); 4] = [
    ("mm_per_min", 1e-3 / 60.0),
    ("mm_per_s", 1e-3),
    ("m_per_s", 1.0),
    ("in_per_min", 0.0254 / 60.0),
];

/// Every name that means something.
fn known() -> Vec<(String, Column)> {
    let mut known: Vec<(String, Column)> = [
        ("i", Column::Axis(0)),
        ("j", Column::Axis(1)),
        ("k", Column::Axis(2)),
        ("rapid", Column::Rapid),
        ("spin_deg", Column::Spin(from_deg(1_f64))),
        ("spin_rad", Column::Spin(1.0)),
        ("spindle_rpm", Column::Spindle),
        ("op", Column::Operation),
        ("note", Column::Note),
    ]
    .map(|(name, column)| (name.to_owned(), column))
    .into();
    for (unit, factor) in LENGTHS {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            known.push((format!("{letter}_{unit}"), Column::Point(axis, factor)));
        }
        known.push((format!("axial_depth_{unit}"), Column::AxialDepth(factor)));
        known.push((format!("radial_depth_{unit}"), Column::RadialDepth(factor)));
    }
    known.extend(SPEEDS.map(|(unit, factor)| (format!("feed_{unit}"), Column::Feed(factor))));
    known
}

impl Column {
    /// Whether both have the same quantity, in any unit.
    fn same(self, other: Column) -> bool {
        match (self, other) {
            (Column::Point(a, _), Column::Point(b, _)) => a == b,
            (Column::Note, Column::Note) => false,
            (a, b) => {
                a == b
                    || std::mem::discriminant(&a) == std::mem::discriminant(&b)
                        && !matches!(a, Column::Axis(_))
            }
        }
    }
}

/// Reads the path in `reader`, and gives `out` its steps one by one; `path` is what problems show.
///
/// If there are problems, the steps given so far are not valid.
///
/// # Errors
/// Every problem of the file, at most 200: unknown, double and missing columns, names without unit, cells that are no
/// numbers, rows of another length than the header, a table without rows.
pub fn read(path: &str, reader: impl BufRead, out: &mut dyn FnMut(Step)) -> Result<Summary, Problems> {
    let mut lines = Lines::new(path, reader);
    let mut table = None;
    let mut problems = Vec::new();
    let mut summary = Summary::new(Format::Csv);
    while problems.len() < MOST_PROBLEMS {
        let line = match lines.next() {
            Ok(Some(line)) => line,
            Ok(None) => break,
            Err(wrong) => {
                problems.extend(wrong);
                break;
            }
        };
        if is_remark(&line.text) {
            continue;
        }
        let Some(table) = &mut table else {
            let (made, mut wrong) = Table::of(path, &line);
            let without_columns = !wrong.is_empty();
            problems.append(&mut wrong);
            if without_columns {
                break;
            }
            table = Some(made);
            continue;
        };
        if is_blank_row(&line.text, table.separator) {
            continue;
        }
        let row = table.row(path, &line).and_then(|row| {
            let point = row.point();
            point
                .map(|point| (row, point))
                .map_err(|(message, hint)| vec![line.problem(path, 0..line.text.len(), message, hint)])
        });
        match row {
            Ok((row, point)) => table.give(&line, row, point, &mut |step| {
                summary.count(&step);
                out(step);
            }),
            Err(wrong) => problems.extend(wrong),
        }
    }
    if problems.is_empty() && summary.moves == 0 {
        let hint = "the first line names the columns, such as `x_mm,y_mm,z_mm`; each line below is a point";
        problems.push(Problem::of_file(path, "the file has no point", hint));
    }
    Problems::from(problems).into_result()?;
    Ok(summary)
}

/// The header, and the data of the previous rows.
struct Table {
    /// As the line of names has it.
    separator: char,
    header: Vec<String>,
    columns: Vec<Column>,
    /// The one that the last row belongs to.
    operation: Option<Operation>,
}

/// What the cells of one row say, in SI.
#[derive(Default)]
struct Row {
    point: [Option<f64>; 3],
    axis: [Option<f64>; 3],
    spin: Option<f64>,
    feed: Option<f64>,
    rapid: bool,
    spindle: Option<f64>,
    depths: [Option<f64>; 2],
    operation: Option<String>,
}

impl Table {
    /// The columns that this line names, and what is wrong with them.
    fn of(path: &str, line: &Line) -> (Table, Vec<Problem>) {
        let separator = separator_of(&line.text);
        let known = known();
        let names: Vec<&str> = known.iter().map(|(name, _)| name.as_str()).collect();
        let mut problems = Vec::new();
        let mut table = Table {
            separator,
            header: Vec::new(),
            columns: Vec::new(),
            operation: None,
        };
        let heads = cells(&line.text, separator);
        for cell in heads.iter().take(MOST_COLUMNS) {
            let name = cell.text.to_lowercase();
            let mut report = |message: String, hint: &str| {
                problems.push(line.problem(path, cell.span.clone(), message, hint));
            };
            let Some((_, column)) = known.iter().find(|(known, _)| *known == name) else {
                let (message, hint) = unknown(&cell.text, &name, &names);
                report(message, &hint);
                continue;
            };
            if let Some(first) = table.columns.iter().position(|before| before.same(*column)) {
                let given = table.header.get(first).map_or("", String::as_str);
                report(
                    format!("`{}` repeats `{given}`", cell.text),
                    "remove one of the two columns",
                );
            }
            table.columns.push(*column);
            table.header.push(cell.text.to_string());
        }
        if problems.is_empty() {
            let whole = 0..line.text.len();
            for (missing, hint) in table.missing() {
                problems.push(line.problem(path, whole.clone(), format!("missing columns: {missing}"), hint));
            }
        }
        (table, problems)
    }

    /// Missing columns that others require, and hints.
    fn missing(&self) -> Vec<(String, &'static str)> {
        let has = |requested: &dyn Fn(Column) -> bool| self.columns.iter().any(|column| requested(*column));
        let absent = |names: [&str; 3], of: &dyn Fn(Column) -> Option<usize>| -> Vec<String> {
            let absent = (0..3).filter(|axis| !has(&|column| of(column) == Some(*axis)));
            absent.map(|axis| format!("`{}`", names[axis])).collect()
        };
        let mut missing = Vec::new();
        let point = absent(["x_mm", "y_mm", "z_mm"], &|column| match column {
            Column::Point(axis, _) => Some(axis),
            _ => None,
        });
        if !point.is_empty() {
            missing.push((
                point.join(", "),
                "every point needs three coordinates, each with its unit in the column name",
            ));
        }
        let axis = absent(["i", "j", "k"], &|column| match column {
            Column::Axis(axis) => Some(axis),
            _ => None,
        });
        if !axis.is_empty() && axis.len() < 3 {
            missing.push((axis.join(", "), "the tool direction needs three numbers"));
        }
        let axial = has(&|column| matches!(column, Column::AxialDepth(_)));
        if axial != has(&|column| matches!(column, Column::RadialDepth(_))) {
            let name = if axial {
                "`radial_depth_mm`"
            } else {
                "`axial_depth_mm`"
            };
            missing.push((name.to_owned(), "the engagement of the cutter needs both depths"));
        }
        missing
    }

    /// What the cells of a line say, or what is wrong with each.
    fn row(&self, path: &str, line: &Line) -> Result<Row, Vec<Problem>> {
        let found = row_cells(path, line, self.separator, self.columns.len())
            .map_err(|wrong| wrong.into_iter().collect::<Vec<_>>())?;
        let mut problems = Vec::new();
        let mut row = Row::default();
        for (cell, column) in found.iter().zip(&self.columns) {
            if let Err((message, hint)) = row.take(cell, *column, self.separator) {
                problems.push(line.problem(path, cell.span.clone(), message, hint));
            }
        }
        match problems.is_empty() {
            true => Ok(row),
            false => Err(problems),
        }
    }

    /// Gives the move of a row, and before it the operation that it begins.
    ///
    /// A row without a name keeps that of the one before; an empty spindle or depth is not known, and so another
    /// operation than one with a given value.
    fn give(&mut self, line: &Line, row: Row, point: Point, out: &mut dyn FnMut(Step)) {
        let Point { end, axis, depths } = point;
        let number = u32::try_from(line.number).unwrap_or(u32::MAX);
        let before = self.operation.as_ref();
        let operation = Operation {
            name: row
                .operation
                .or_else(|| before.and_then(|before| before.name.clone())),
            spindle: row.spindle,
            depths,
            line: before.map_or(number, |before| before.line),
            ..Operation::default()
        };
        if before != Some(&operation) {
            let operation = Operation {
                line: number,
                ..operation
            };
            self.operation = Some(operation.clone());
            out(Step::Operation(operation));
        }
        out(Step::Move(Move {
            end,
            axis,
            spin: row.spin.map(GivenSpin::Angle),
            course: Course::Line,
            pace: match (row.rapid, row.feed) {
                (true, _) => Pace::Rapid,
                (false, Some(speed)) => Pace::Feed(speed),
                (false, None) => Pace::Unknown,
            },
            line: number,
        }));
    }
}

/// A row as a point of the path, SI.
struct Point {
    end: Point3<f64>,
    axis: Option<Unit<Vector3<f64>>>,
    depths: Option<DepthOfCut>,
}

/// What is wrong, and what to do.
type Wrong = (String, &'static str);

impl Row {
    /// Puts what a cell says into the row; an empty cell says nothing.
    fn take(&mut self, cell: &Cell<'_>, column: Column, separator: char) -> Result<(), Wrong> {
        match column {
            Column::Note => {}
            Column::Operation => self.operation = Some(cell.text.to_string()).filter(|name| !name.is_empty()),
            Column::Rapid => {
                self.rapid = match cell.text.to_lowercase().as_str() {
                    "1" | "true" | "yes" => true,
                    "" | "0" | "false" | "no" => false,
                    _ => {
                        return Err((
                            format!("`{}` is neither yes nor no", cell.text),
                            "write 1 for a rapid move, 0 for a cut",
                        ));
                    }
                };
            }
            _ if cell.text.is_empty() => {}
            Column::Point(axis, factor) => self.point[axis] = Some(number(cell, separator)? * factor),
            Column::Axis(axis) => self.axis[axis] = Some(number(cell, separator)?),
            Column::Spin(factor) => self.spin = Some(number(cell, separator)? * factor),
            Column::Spindle => self.spindle = Some(number(cell, separator)? * TAU / 60.0),
            Column::Feed(factor) => self.feed = Some(above_zero(cell, separator)? * factor),
            Column::AxialDepth(factor) => self.depths[0] = Some(zero_or_more(cell, separator)? * factor),
            Column::RadialDepth(factor) => self.depths[1] = Some(zero_or_more(cell, separator)? * factor),
        }
        Ok(())
    }

    /// What the cells say together.
    fn point(&self) -> Result<Point, Wrong> {
        let [Some(x), Some(y), Some(z)] = self.point else {
            return Err((
                "a point without one of its coordinates".to_owned(),
                "fill in all three",
            ));
        };
        let axis = match self.axis {
            [None, None, None] => None,
            [Some(i), Some(j), Some(k)] => {
                let axis = direction([i, j, k]).map_err(|length| {
                    let message = format!("the tool direction has a length of {length:.4}, not 1");
                    (
                        message,
                        "i, j, k must be a direction of length 1, from the tip towards the spindle",
                    )
                })?;
                Some(axis)
            }
            _ => {
                return Err((
                    "a direction of less than three numbers".to_owned(),
                    "fill in i, j and k, or none",
                ));
            }
        };
        let depths = match self.depths {
            [None, None] => None,
            [Some(axial), Some(radial)] => Some(DepthOfCut { axial, radial }),
            _ => {
                return Err((
                    "one depth without the other".to_owned(),
                    "fill in both depths, or none",
                ));
            }
        };
        let end = Point3::new(x, y, z);
        Ok(Point { end, axis, depths })
    }
}

/// What to do with a cell that cannot be filled in.
const NOT_KNOWN: &str = "leave the cell empty if it is not known";

/// A number from -1e9 to 1e9, in the unit of its column.
fn number(cell: &Cell<'_>, separator: char) -> Result<f64, Wrong> {
    match sheet::number(&cell.text, separator) {
        Some(number) if number.abs() <= LARGEST => Ok(number),
        Some(_) => Err((
            format!("`{}` is not a number from -1e9 to 1e9", cell.text),
            NOT_KNOWN,
        )),
        None => Err((
            format!("`{}` is not a number", cell.text),
            "give the unit in the column name",
        )),
    }
}

/// Such a number above 0.
fn above_zero(cell: &Cell<'_>, separator: char) -> Result<f64, Wrong> {
    match number(cell, separator)? {
        // In SI it is smaller, and must still be above 0.
        number if number >= f64::MIN_POSITIVE => Ok(number),
        _ => Err((format!("`{}` is not above 0", cell.text), NOT_KNOWN)),
    }
}

/// Such a number that is not below 0.
fn zero_or_more(cell: &Cell<'_>, separator: char) -> Result<f64, Wrong> {
    match number(cell, separator)? {
        number if number >= 0.0 => Ok(number),
        _ => Err((format!("`{}` is below 0", cell.text), NOT_KNOWN)),
    }
}

/// What to say of a name that means nothing.
fn unknown(shown: &str, name: &str, names: &[&str]) -> (String, String) {
    if name.parse::<f64>().is_ok() {
        let hint = "the first line names the columns, such as `x_mm,y_mm,z_mm,i,j,k,feed_mm_per_min`";
        return (format!("`{shown}` is not a column name"), hint.to_owned());
    }
    let unit = match name {
        "x" | "y" | "z" => Some(("lengths", format!("`{name}_mm`, `{name}_m` or `{name}_in`"))),
        "feed" | "f" => Some((
            "speeds",
            "`feed_mm_per_min`, `feed_mm_per_s`, `feed_m_per_s` or `feed_in_per_min`".to_owned(),
        )),
        "spin" => Some(("angles", "`spin_deg` or `spin_rad`".to_owned())),
        "spindle" | "s" | "rpm" => Some(("speeds", "`spindle_rpm`".to_owned())),
        "axial_depth" | "radial_depth" => Some(("lengths", format!("`{name}_mm`"))),
        _ => None,
    };
    if let Some((quantity, names)) = unit {
        return (
            format!("column `{shown}` without unit"),
            format!("{quantity} carry their unit: write {names}"),
        );
    }
    let hint = suggestion(name, names).map_or_else(
        || {
            format!(
                "remove it, or name it `note`; known columns: {}",
                names.join(", ")
            )
        },
        |(_, advice)| advice,
    );
    (format!("unknown column `{shown}`"), hint)
}

#[cfg(test)]
mod tests;
