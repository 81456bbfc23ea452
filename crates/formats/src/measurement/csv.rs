//! A force record as a table: one row per instant. The unit is in the column name or in a row below the names.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `time_s` | time; omit it if a sampling rate is given | `_s`, `_ms`, `_us` |
//! | `fx_n`, `fy_n`, `fz_n` | force, axes of the sensor | `_n`, `_kn`, `_mN` |
//! | `mx_n_m`, ... | moment about the sensor's origin; all three or none | `_n_m`, `_n_mm`, `_n_cm`, `_kn_m` |
//!
//! If the units have their own row, the names are `Time`, `Fx`, ... and that row contains `s`, `N`, ... Columns with
//! other names are ignored and listed. Cells are separated by `;`, tab or `,`. With `;` or tab, decimal commas are read
//! too. Lines that begin with `#` and empty lines are ignored.
//!
//! A file without a header is read with given names in the order of its columns: its first line is a row of numbers.
//!
//! ```text
//! time_s,fx_n,fy_n,fz_n             Time;Fx;Fy;Fz
//! 0.0000,0.12,-0.03,4.51            s;N;N;kN
//! 0.0001,0.15,-0.02,4.62            0,0000;0,12;-0,03;0,00451
//! ```

use std::io::BufRead;

use armill_core::load::ActsOn;

use super::columns::{Column, Quantity, Samples, doubled, measured, missing, of_names_and_units};
use super::force_records::{ForceReadOptions, ForceRecords, Format};
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::{Cell, cells, is_blank_row, row_cells, separator_of};

/// Reads the record in `reader`. `path` is the file name shown in problems, `acts_on` the body that the forces act on.
/// `requested.channels` is not used for tables.
///
/// # Errors
/// All problems of the file, at most 200: missing and duplicate columns, units that are missing or unknown, cells that
/// are not numbers, rows of another length, time that does not increase.
pub fn read(
    path: &str,
    reader: impl BufRead,
    acts_on: ActsOn,
    requested: &ForceReadOptions,
) -> Result<ForceRecords, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(first) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no record", HEADER_HINT).into());
    };
    let mut table = Table {
        path,
        requested,
        separator: separator_of(&first.text),
        names: Vec::new(),
        columns: Vec::new(),
    };
    // With given names, the first line is a row of numbers.
    let mut waiting = None;
    match &requested.columns {
        Some(names) => {
            table.take_given(names, &first)?;
            waiting = Some(first.clone());
        }
        None => table.take_header(&first, &mut lines)?,
    }
    table.check(&first)?;
    let mut samples = Samples::new(table.columns.clone(), requested.rate_hz.map(f64::recip));
    let mut problems = Vec::new();
    while problems.len() < MOST_PROBLEMS {
        let line = match waiting.take() {
            Some(line) => line,
            None => match lines.next_row() {
                Ok(Some(line)) => line,
                Ok(None) => break,
                Err(wrong) => {
                    problems.extend(wrong);
                    break;
                }
            },
        };
        if !is_blank_row(&line.text, table.separator) {
            let wrong = table.row(&line, &mut samples).err();
            problems.extend(wrong.into_iter().flatten());
        }
    }
    // Problems of rows take precedence.
    Problems::from(problems).into_result()?;
    let record = samples
        .record(acts_on)
        .map_err(|error| Problem::of_file(path, error.to_string(), HEADER_HINT))?;
    let unused = table.names.into_iter().zip(&table.columns);
    Ok(ForceRecords {
        format: Format::Csv,
        records: vec![record],
        unused: unused
            .filter(|(_, column)| column.is_none())
            .map(|(name, _)| name)
            .collect(),
    })
}

/// Meaning of the columns of a file.
struct Table<'a> {
    /// File name shown in problems.
    path: &'a str,
    /// Options of the user.
    requested: &'a ForceReadOptions,
    /// Separator in the first line.
    separator: char,
    /// Names in the file, or given as an option.
    names: Vec<String>,
    /// Meaning of each; `None` is ignored.
    columns: Vec<Option<Column>>,
}

impl Table<'_> {
    /// Uses the names given by the user for the cells of this row.
    ///
    /// # Errors
    /// A number of names that differs from the number of cells. Unknown names are ignored, with any unit.
    fn take_given(&mut self, names: &[String], first: &Line) -> Result<(), Problems> {
        let width = cells(&first.text, self.separator).len();
        if names.len() != width {
            let message = format!("{} columns were specified, but this row has {width}", names.len());
            return Err(self.at(first, message, "give one name per column"));
        }
        self.names = names.to_vec();
        self.columns = names.iter().map(|name| named(name)).collect();
        Ok(())
    }

    /// Reads names with units, or names and the line of units below.
    ///
    /// If one name ends in its unit, all must. The line below is read only if none does.
    ///
    /// # Errors
    /// No channel among the names; units that are missing or unknown; a file that ends here.
    fn take_header(&mut self, first: &Line, lines: &mut Lines<impl BufRead>) -> Result<(), Problems> {
        let heads = cells(&first.text, self.separator);
        self.names = heads.iter().map(|cell| cell.text.to_string()).collect();
        self.columns = heads.iter().map(|cell| named(&cell.text)).collect();
        if self.columns.iter().any(Option::is_some) {
            return Ok(());
        }
        if heads.iter().all(|cell| Quantity::of_name(&cell.text).is_none()) {
            let message = "no column of this table is a force".to_owned();
            return Err(self.at(first, message, HEADER_HINT));
        }
        let Some(below) = lines.next_row()? else {
            return Err(Problem::of_file(self.path, "the file has no record", HEADER_HINT).into());
        };
        let units = cells(&below.text, self.separator);
        let columns = of_names_and_units(&heads, &units, |_, name| Quantity::of_name(name));
        self.columns = columns.map_err(|unfit| -> Problems {
            let whole = || 0..below.text.len();
            let given = unfit.into_iter().map(|unfit| {
                let span = units
                    .get(unfit.index)
                    .map_or_else(whole, |cell| cell.span.clone());
                below.problem(self.path, span, unfit.message, &unfit.hint)
            });
            given.collect()
        })?;
        Ok(())
    }

    /// Checks that these columns make a record.
    ///
    /// # Errors
    /// Duplicate or missing columns; neither time nor rate, or both; a rate that is not above 0.
    fn check(&self, first: &Line) -> Result<(), Problems> {
        if let Some(index) = doubled(&self.columns) {
            let message = format!("`{}` repeats an earlier column", self.names[index]);
            return Err(self.at(first, message, "remove one of the two columns"));
        }
        if let Some((missing, hint)) = missing(&self.columns) {
            return Err(self.at(first, format!("missing columns: {missing}"), hint));
        }
        let columns = self.columns.iter().flatten();
        let timed = columns.clone().any(|column| column.quantity == Quantity::Time);
        match (timed, self.requested.rate_hz) {
            (false, None) => {
                let hint = "add `time_s`, or give the sampling rate (option `rate_hz`)";
                Err(self.at(first, "no column gives the time".to_owned(), hint))
            }
            (true, Some(rate)) => {
                let message =
                    format!("a sampling rate of {rate} Hz was specified, but a column gives the time");
                Err(self.at(first, message, "leave out the rate"))
            }
            (false, Some(rate)) if !(rate > 0.0 && rate.is_finite()) => Err(self.at(
                first,
                format!("a sampling rate of {rate} Hz is not above 0"),
                "give it in samples per second",
            )),
            _ => Ok(()),
        }
    }

    /// Adds a row as a sample.
    ///
    /// # Errors
    /// A number of cells that differs from the header, a cell that is not a number, a time that does not increase.
    fn row(&self, line: &Line, samples: &mut Samples) -> Result<(), Problems> {
        let found = row_cells(self.path, line, self.separator, samples.width())?;
        let meant = found.iter().zip(&self.columns);
        let numbers: Result<Vec<f64>, Problems> = meant
            .filter(|(_, column)| column.is_some())
            .map(|(cell, _)| measured(&cell.text, self.separator).ok_or_else(|| self.no_number(line, cell)))
            .collect();
        let pushed = samples.push(&numbers?);
        pushed.map_err(|(message, hint)| self.at(line, message, hint))
    }

    /// A problem of a cell.
    fn no_number(&self, line: &Line, cell: &Cell<'_>) -> Problems {
        let message = format!("`{}` is not a number", cell.text);
        let hint = "give the unit in the column name or in the row below the names";
        line.problem(self.path, cell.span.clone(), message, hint).into()
    }

    /// A problem of a whole line.
    fn at(&self, line: &Line, message: String, hint: &str) -> Problems {
        line.problem(self.path, 0..line.text.len(), message, hint).into()
    }
}

/// Form of the header.
const HEADER_HINT: &str = "the first line names the columns with their units, such as `time_s,fx_n,fy_n,fz_n`; for a file \
    without header give the names of its columns (option `columns`)";

/// The channel of a name that ends in its unit.
///
/// Name and unit are separated at the first `_`: `mx_n_m` is `mx` in `n_m`.
fn named(name: &str) -> Option<Column> {
    let (plain, unit) = name.trim().split_once('_')?;
    let quantity = Quantity::of_name(plain)?;
    let factor = quantity.factor(unit)?;
    Some(Column { quantity, factor })
}

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::Vector3;

    use super::*;

    fn read_as(text: &str, rate_hz: Option<f64>, columns: Option<&str>) -> Result<ForceRecords, Problems> {
        let requested = ForceReadOptions {
            rate_hz,
            columns: columns.map(|names| names.split(',').map(str::to_owned).collect()),
            channels: None,
        };
        read("force.csv", text.as_bytes(), ActsOn::Part, &requested)
    }

    fn measured(text: &str) -> ForceRecords {
        read_as(text, None, None).unwrap_or_else(|problems| panic!("{problems}"))
    }

    fn problems(text: &str) -> String {
        read_as(text, None, None).unwrap_err().to_string()
    }

    #[test]
    fn the_same_record_in_other_units_and_separators_is_the_same() {
        let first = measured("time_s,fx_n,fy_n,fz_n\n0,1000,-2,0.003\n0.001,5,6,7\n");
        assert_eq!(first.records[0].force()[0], Vector3::new(1000.0, -2.0, 0.003));
        assert_eq!(first.records[0].acts_on(), ActsOn::Part);
        for text in [
            "\u{feff}# remark\r\nTime_ms;Fx_kN;Fy_n;Fz_mN\r\n\r\n0;1;-2;3\r\n1;0,005;6;7000\r\n",
            "Zeit\tFx\tFy\tFz\ns\tkN\tN\tmN\n0\t1\t-2,0\t3\n0,001\t0.005\t6\t7000\n",
            "fz_n,fy_n,fx_n,t_us,Vx_g\n0.003,-2,1000,0,loud\n7,6,5,1000,-\n",
        ] {
            let other = measured(text);
            let apart = other.records[0]
                .force()
                .iter()
                .zip(first.records[0].force())
                .map(|(a, b)| (a - b).norm());
            assert!(apart.fold(0.0, f64::max) < 1e-12, "{text}");
            assert!((other.records[0].time()[1] - 0.001).abs() < 1e-15, "{text}");
        }
    }

    #[test]
    fn unknown_columns_are_listed_and_moments_are_read() {
        let found = measured(
            "time_s,fx_n,fy_n,fz_n,ae_v,mx_n_mm,my_n_m,mz_n_cm\n0,1,2,3,9,1000,2,300\n1,1,2,3,9,4,5,6\n",
        );
        assert_eq!(found.unused, ["ae_v"]);
        assert!((found.records[0].moment().unwrap()[0] - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-12);
    }

    #[test]
    fn files_without_header_or_time_are_read_with_the_given_columns_and_rate() {
        let text = "1,2,3,0.5\n4,5,6,0.7\n7,8,9,0.9\n";
        let found = read_as(text, Some(50_000.0), Some("fx_n,fy_n,fz_n,vx_g")).unwrap();
        assert_eq!(found.records[0].force()[2], Vector3::new(7.0, 8.0, 9.0));
        assert!((found.records[0].step().unwrap() - 2e-5).abs() < 1e-18);
        let given = read_as(text, Some(50_000.0), Some("fx_n,fy_n,fz_n"))
            .unwrap_err()
            .to_string();
        assert!(
            given.contains("3 columns were specified, but this row has 4"),
            "{given}"
        );
        let given = read_as("fx_n,fy_n,fz_n\n1,2,3\n4,5,6\n", Some(0.0), None)
            .unwrap_err()
            .to_string();
        assert!(
            given.contains("a sampling rate of 0 Hz is not above 0"),
            "{given}"
        );
    }

    #[test]
    fn problems_are_reported_with_their_positions() {
        for (text, part) in [
            ("", "the file has no record"),
            ("a,b\n1,2\n", "no column of this table is a force"),
            ("time_s,fx_n,fz_n\n0,1,2\n", "missing columns: `Fy`"),
            (
                "time_s,fx_n,fy_n,fz_n,mx_n_m\n0,1,2,3,4\n",
                "missing columns: `My`, `Mz`",
            ),
            ("fx_n,fy_n,fz_n\n1,2,3\n", "no column gives the time"),
            (
                "time_s,fx_n,fy_n,fz_n,Fx_kN\n0,1,2,3,4\n",
                "`Fx_kN` repeats an earlier column",
            ),
            ("Time,Fx,Fy,Fz\n0,1,2,3\n", "2:1: no unit is given for `Time`"),
            (
                "Time,Fx,Fy,Fz\ns,V,N,N\n0,1,2,3\n",
                "2:3: `V` is not a unit of `Fx`",
            ),
            ("Time,Fx,Fy,Fz\ns,MN,N,N\n0,1,2,3\n", "`MN` is not a unit of `Fx`"),
            ("time_s,fx_n,fy_n,fz_n\n0,1,2,x\n", "2:7: `x` is not a number"),
            (
                "time_s,fx_n,fy_n,fz_n\n0,1,2,3\n0,1,2,3\n",
                "3:1: time does not increase: 0 s after 0 s",
            ),
            (
                "time_s,fx_n,fy_n,fz_n\n0,0,1,0,2,0,3,0\n",
                "separate cells with `;`",
            ),
            ("time_s,fx_n,fy_n,fz_n\n0,1,2,3\n", "a record of 1 instants"),
            (
                "time_s;fx_n;fy_n;fz_n\n0;1.000,5;2;3\n",
                "`1.000,5` is not a number",
            ),
        ] {
            let given = problems(text);
            assert!(given.contains(part), "{text}: {given}");
            assert!(given.contains("help: "), "{given}");
        }
        let given = read_as("time_s,fx_n,fy_n,fz_n\n0,1,2,3\n", Some(10.0), None)
            .unwrap_err()
            .to_string();
        assert!(given.contains("leave out the rate"), "{given}");
    }
}
