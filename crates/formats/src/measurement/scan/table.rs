//! A table of measured points: one row per point, with names of columns.
//!
//! Columns: see [`columns`](super::columns). Others are ignored and listed. Rows without any coordinate were not measured and are
//! counted.

use std::io::BufRead;

use armill_core::nalgebra::{Point3, Vector3};

use super::columns::{Column, Quantity, apart, named, separator, without_mark};
use super::measured::{EMPTY_HINT, LIMIT, Scan, ScanFormat, ScanReadOptions, normal_of, point_of};
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::measurement::profile::LengthUnit;
use crate::table::sheet::{Cell, each_row, named_cells, number};

/// What to do about a cell.
const NUMBER_HINT: &str = "give the unit in the column name; remove rows that were not measured";

/// Reads the table below the names on `header`.
///
/// # Errors
/// All problems of the file, at most 200.
pub(super) fn read(
    header: &Line,
    mut lines: Lines<impl BufRead>,
    format: ScanFormat,
    given: &ScanReadOptions,
) -> Result<Scan, Problems> {
    let path = lines.name().to_owned();
    let mut table = Table::of(&path, header, format, given)?;
    let separator = table.separator;
    each_row(&mut lines, separator, LIMIT, |line| table.row(line))?;
    let mut scan = table.scan;
    if scan.points.is_empty() {
        return Err(Problem::of_file(&path, "the file has no points", EMPTY_HINT).into());
    }
    if table.not_measured > 0 {
        scan.notes
            .push(format!("{} rows without a measured point", table.not_measured));
    }
    Ok(scan.finished())
}

/// A column with the factor from its unit to m, 1 for what is not a length.
#[derive(Clone, Copy)]
struct ScaledColumn {
    quantity: Quantity,
    factor: f64,
}

struct Table<'a> {
    path: &'a str,
    separator: char,
    /// `None` is ignored.
    columns: Vec<Option<ScaledColumn>>,
    scan: Scan,
    not_measured: usize,
}

impl<'a> Table<'a> {
    fn of(
        path: &'a str,
        header: &Line,
        format: ScanFormat,
        given: &ScanReadOptions,
    ) -> Result<Table<'a>, Problems> {
        let text = without_mark(&header.text);
        let separator = separator(text);
        let skipped = header.text.len() - text.len();
        let names: Vec<Cell<'_>> = (apart(text, separator).into_iter())
            .map(|cell| Cell {
                span: cell.span.start + skipped..cell.span.end + skipped,
                ..cell
            })
            .collect();
        let found = named_cells(path, header, names, named, |one: Column, other: Column| {
            one.quantity == other.quantity
        });
        let mut problems = found.problems;
        let whole = 0..header.text.len();
        let columns: Vec<Column> = found.columns.iter().flatten().copied().collect();
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let is_missing = !columns
                .iter()
                .any(|column| column.quantity == Quantity::Measured(axis));
            if is_missing && problems.is_empty() {
                let message = format!("no column `{name}_mm`");
                problems.push(header.problem(path, whole.clone(), message, EMPTY_HINT));
            }
        }
        let lengths = || columns.iter().filter(|column| column.quantity.is_length());
        if let Some(unit) = given.unit
            && lengths().all(|column| column.unit.is_some())
        {
            let message = format!("the unit {unit} was specified, but the columns state their units");
            problems.push(header.problem(path, whole, message, "leave out the unit"));
        }
        Problems::from(problems).into_result()?;
        let mut scan = Scan::empty(format);
        if given.unit.is_none() && lengths().any(|column| column.unit.is_none()) {
            scan.notes.push("columns without a unit: mm assumed".to_owned());
        }
        if !found.unused.is_empty() {
            scan.notes
                .push(format!("columns not used: {}", found.unused.join(", ")));
        }
        let unit = given.unit.unwrap_or(LengthUnit::Millimetre);
        let scaled = |column: Column| ScaledColumn {
            quantity: column.quantity,
            factor: match column.quantity.is_length() {
                true => column.unit.unwrap_or(unit).factor(),
                false => 1.0,
            },
        };
        Ok(Table {
            path,
            separator,
            columns: found
                .columns
                .into_iter()
                .map(|column| column.map(scaled))
                .collect(),
            scan,
            not_measured: 0,
        })
    }

    /// Adds a row; a row with a problem adds nothing.
    fn row(&mut self, line: &Line) -> Result<(), Problems> {
        let found = apart(&line.text, self.separator);
        if found.len() != self.columns.len() {
            let message = format!(
                "{} cells, but the table has {} columns",
                found.len(),
                self.columns.len()
            );
            let hint =
                "every row needs one cell per column; an empty cell is written as two separators in a row";
            return Err(line.problem(self.path, 0..line.text.len(), message, hint).into());
        }
        let mut values = RowValues::default();
        let mut problems = Vec::new();
        for (cell, column) in found.iter().zip(&self.columns) {
            let Some(column) = column else { continue };
            if cell.text.is_empty() {
                continue;
            }
            if column.quantity == Quantity::Name {
                values.name = cell.text.to_string();
                continue;
            }
            match number(&cell.text, self.separator).filter(|number| number.is_finite()) {
                Some(number) => values.take(column, number),
                None => {
                    let message = format!("`{}` is not a number", cell.text);
                    problems.push(line.problem(self.path, cell.span.clone(), message, NUMBER_HINT));
                }
            }
        }
        Problems::from(problems).into_result()?;
        if values.measured.iter().all(Option::is_none) {
            self.not_measured += 1;
            return Ok(());
        }
        let whole = |message: String, hint| line.problem(self.path, 0..line.text.len(), message, hint);
        let [Some(x), Some(y), Some(z)] = values.measured else {
            return Err(whole("a coordinate is missing".to_owned(), NUMBER_HINT).into());
        };
        let unit_hint = "check the unit in the column name";
        let point = point_of([x, y, z]).map_err(|message| whole(message, unit_hint))?;
        let nominal = values
            .nominal()
            .map(point_of)
            .transpose()
            .map_err(|message| whole(message, unit_hint))?;
        self.add(point, nominal, values);
        Ok(())
    }

    fn add(&mut self, point: Point3<f64>, nominal: Option<Point3<f64>>, values: RowValues) {
        self.scan.points.push(point);
        self.scan.nominal.push(nominal);
        self.scan.normals.push(values.normal());
        self.scan.deviations.push(values.deviation);
        self.scan.names.push(values.name);
    }
}

/// The values of a row, m.
#[derive(Default)]
struct RowValues {
    measured: [Option<f64>; 3],
    nominal: [Option<f64>; 3],
    normal: [Option<f64>; 3],
    deviation: Option<f64>,
    name: String,
}

impl RowValues {
    fn take(&mut self, column: &ScaledColumn, number: f64) {
        let value = Some(number * column.factor);
        match column.quantity {
            Quantity::Measured(axis) => self.measured[axis] = value,
            Quantity::Nominal(axis) => self.nominal[axis] = value,
            Quantity::Normal(axis) => self.normal[axis] = value,
            Quantity::Deviation => self.deviation = value,
            Quantity::Name => {}
        }
    }

    fn nominal(&self) -> Option<[f64; 3]> {
        let [Some(x), Some(y), Some(z)] = self.nominal else {
            return None;
        };
        Some([x, y, z])
    }

    fn normal(&self) -> Option<Vector3<f64>> {
        let [Some(x), Some(y), Some(z)] = self.normal else {
            return None;
        };
        normal_of([x, y, z])
    }
}
