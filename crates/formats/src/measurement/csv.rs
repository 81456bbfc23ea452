//! A force record as a table: one row an instant, the unit of each column in its name or in a row below the names.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `time_s` | the instant; left out where a sampling rate is told | `_s`, `_ms`, `_us` |
//! | `fx_n`, `fy_n`, `fz_n` | force, axes of the sensor | `_n`, `_kn`, `_mN` |
//! | `mx_n_m`, ... | moment about its origin; all three or none | `_n_m`, `_n_mm`, `_n_cm`, `_kn_m` |
//!
//! With units in a row of their own the names are `Time`, `Fx`, ... and the row holds `s`, `N`, ... Columns with other names
//! are passed over and listed. Cells are separated by `;`, tab or `,`; with the first two a decimal comma is read too. Lines
//! that begin with `#` and empty ones are passed over.

use std::io::BufRead;

use armill_core::load::{ActsOn, Record};

use super::columns::{Column, Quantity, Samples, missing, number};
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems, Source};
use crate::table::sheet::{Cell, cells};

/// More problems than this are not looked for.
const MOST_PROBLEMS: usize = 200;

/// What a file of forces does not tell.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// What the force acts on.
    pub acts_on: ActsOn,
    /// Samples a second, of a file without column of time.
    pub rate_hz: Option<f64>,
    /// The columns in order, of a file without header; other names than those of the table above are passed over.
    pub columns: Option<Vec<String>>,
}

/// What a file of forces held.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Force over time, axes of the sensor.
    pub record: Record,
    /// Columns that were passed over.
    pub unused: Vec<String>,
}

/// Reads the record in `reader`; `path` is what problems show.
///
/// # Errors
/// Every problem of the file, at most 200: missing and double columns, units that are missing or unknown, cells that are
/// no numbers, rows of another length, time that does not go on.
pub fn read(path: &str, reader: impl BufRead, wanted: &Wanted) -> Result<Measured, Problems> {
    let mut table = Reader {
        path,
        wanted,
        lines: Lines::new(path, reader),
        separator: ',',
        problems: Vec::new(),
    };
    table.read()
}

struct Reader<'a, R> {
    path: &'a str,
    wanted: &'a Wanted,
    lines: Lines<R>,
    separator: char,
    problems: Vec<Problem>,
}

impl<R: BufRead> Reader<'_, R> {
    fn read(&mut self) -> Result<Measured, Problems> {
        let Some(first) = self.line()? else {
            return Err(self.whole("no record in this file", HEADER_HINT));
        };
        self.separator = [';', '\t']
            .into_iter()
            .find(|c| first.text.contains(*c))
            .unwrap_or(',');
        let heads = cells((0, &first.text), self.separator);
        let mut waiting = None;
        let (names, columns) = match &self.wanted.columns {
            Some(told) => {
                let columns: Vec<Option<Column>> = told.iter().map(|name| named(name)).collect();
                if told.len() != heads.len() {
                    let message = format!(
                        "{} columns were told, but this row has {}",
                        told.len(),
                        heads.len()
                    );
                    return Err(self.at(&first, message, "tell one name for each column"));
                }
                waiting = Some(first.clone());
                (told.clone(), columns)
            }
            None => {
                let mut columns: Vec<Option<Column>> = heads.iter().map(|cell| named(&cell.text)).collect();
                if columns.iter().all(Option::is_none) {
                    waiting = self.units_below(&first, &heads, &mut columns)?;
                }
                (heads.iter().map(|cell| cell.text.clone()).collect(), columns)
            }
        };
        self.complete(&first, &names, &columns)?;
        let step = self.wanted.rate_hz.map(f64::recip);
        let mut samples = Samples::new(columns.clone(), step);
        while self.problems.len() < MOST_PROBLEMS {
            let Some(line) = waiting
                .take()
                .map_or_else(|| self.line(), |line| Ok(Some(line)))?
            else {
                break;
            };
            self.row(&line, &mut samples);
        }
        let unused = names
            .into_iter()
            .zip(&columns)
            .filter(|(_, column)| column.is_none());
        let unused = unused.map(|(name, _)| name).collect();
        let record = samples.record(self.wanted.acts_on);
        // Where rows are wrong, they are what is told.
        if !self.problems.is_empty() {
            return Err(Problems::from(std::mem::take(&mut self.problems)));
        }
        let record = record.map_err(|error| self.whole(&error.to_string(), HEADER_HINT))?;
        Ok(Measured { record, unused })
    }

    /// Takes the line below the names as their units, if any name is one of a channel.
    fn units_below(
        &mut self,
        first: &Line,
        heads: &[Cell],
        columns: &mut [Option<Column>],
    ) -> Result<Option<Line>, Problems> {
        let quantities: Vec<Option<Quantity>> =
            heads.iter().map(|cell| Quantity::of_name(&cell.text)).collect();
        if quantities.iter().all(Option::is_none) {
            return Err(self.at(
                first,
                "no column of this table is a force".to_owned(),
                HEADER_HINT,
            ));
        }
        let Some(below) = self.line()? else {
            return Err(self.whole("no record in this file", HEADER_HINT));
        };
        let units = cells((0, &below.text), self.separator);
        for (index, quantity) in quantities.into_iter().enumerate() {
            let Some(quantity) = quantity else { continue };
            let unit = units.get(index).map_or("", |cell| cell.text.as_str());
            let Some(factor) = quantity.factor(unit) else {
                let shown = &heads[index].text;
                let message = match number(unit, self.separator != ',') {
                    Some(_) => format!("nothing tells the unit of `{shown}`"),
                    None => format!("`{unit}` is no unit of `{shown}`"),
                };
                let hint = format!(
                    "name the columns with their units, such as `time_s,fx_n,fy_n,fz_n`, or put a row of units below: {}",
                    quantity.units()
                );
                let span = units
                    .get(index)
                    .map_or(0..below.text.len(), |cell| cell.span.clone());
                return Err(below.problem(self.path, span, message, &hint).into());
            };
            columns[index] = Some(Column { quantity, factor });
        }
        Ok(None)
    }

    fn complete(&self, first: &Line, names: &[String], columns: &[Option<Column>]) -> Result<(), Problems> {
        for (index, column) in columns.iter().enumerate() {
            let same = |other: &Option<Column>| other.map(|c| c.quantity) == column.map(|c| c.quantity);
            if column.is_some() && columns[..index].iter().any(same) {
                let message = format!("`{}` tells what a column before it tells", names[index]);
                return Err(self.at(first, message, "keep one of the two"));
            }
        }
        if let Some((missing, hint)) = missing(columns) {
            return Err(self.at(first, format!("missing columns: {missing}"), hint));
        }
        let timed = columns
            .iter()
            .flatten()
            .any(|column| column.quantity == Quantity::Time);
        match (timed, self.wanted.rate_hz) {
            (false, None) => {
                let hint = "add `time_s`, or tell the sampling rate (option `rate_hz`)";
                Err(self.at(first, "no column tells the time".to_owned(), hint))
            }
            (true, Some(rate)) => {
                let message = format!("a sampling rate of {rate} Hz was told, but a column tells the time");
                Err(self.at(first, message, "leave the rate out"))
            }
            (false, Some(rate)) if !(rate > 0.0 && rate.is_finite()) => Err(self.at(
                first,
                format!("a sampling rate of {rate} Hz is not above 0"),
                "tell it in samples a second",
            )),
            _ => Ok(()),
        }
    }

    fn row(&mut self, line: &Line, samples: &mut Samples) {
        let found = cells((0, &line.text), self.separator);
        if found.len() != samples.width() {
            let message = format!("{} cells in a table of {} columns", found.len(), samples.width());
            let hint = match self.separator {
                ',' => "decimal commas need `;` or a tab between cells",
                _ => "every row has a cell for each column",
            };
            self.problems
                .push(line.problem(self.path, 0..line.text.len(), message, hint));
            return;
        }
        let mut numbers = Vec::with_capacity(found.len());
        for (cell, _) in found
            .iter()
            .zip(samples.columns())
            .filter(|(_, column)| column.is_some())
        {
            match number(&cell.text, self.separator != ',') {
                Some(number) => numbers.push(number),
                None => {
                    let message = format!("`{}` is not a number", cell.text);
                    let hint = "units stand in the column's name or in the row below the names";
                    self.problems
                        .push(line.problem(self.path, cell.span.clone(), message, hint));
                    return;
                }
            }
        }
        if let Err((message, hint)) = samples.push(&numbers) {
            self.problems
                .push(line.problem(self.path, 0..line.text.len(), message, hint));
        }
    }

    /// The next line that is neither empty nor a remark.
    fn line(&mut self) -> Result<Option<Line>, Problems> {
        loop {
            match self.lines.next()? {
                Some(line) if line.text.trim().is_empty() || line.text.trim_start().starts_with('#') => {}
                other => return Ok(other),
            }
        }
    }

    fn at(&self, line: &Line, message: String, hint: &str) -> Problems {
        line.problem(self.path, 0..line.text.len(), message, hint).into()
    }

    fn whole(&self, message: &str, hint: &str) -> Problems {
        Source::new(self.path, "")
            .problem(0..0, message, Some(hint.to_owned()))
            .into()
    }
}

const HEADER_HINT: &str = "the first line names the columns with their units, such as `time_s,fx_n,fy_n,fz_n`; for a file \
                           without header tell its columns (option `columns`)";

/// The channel of a name that ends in its unit.
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

    fn read_as(text: &str, rate_hz: Option<f64>, columns: Option<&str>) -> Result<Measured, Problems> {
        let wanted = Wanted {
            acts_on: ActsOn::Part,
            rate_hz,
            columns: columns.map(|names| names.split(',').map(str::to_owned).collect()),
        };
        read("force.csv", text.as_bytes(), &wanted)
    }

    fn measured(text: &str) -> Measured {
        read_as(text, None, None).unwrap_or_else(|problems| panic!("{problems}"))
    }

    fn problems(text: &str) -> String {
        read_as(text, None, None).unwrap_err().to_string()
    }

    #[test]
    fn the_same_record_in_other_units_and_separators_is_the_same() {
        let first = measured("time_s,fx_n,fy_n,fz_n\n0,1000,-2,0.003\n0.001,5,6,7\n");
        assert_eq!(first.record.force()[0], Vector3::new(1000.0, -2.0, 0.003));
        assert_eq!(first.record.acts_on(), ActsOn::Part);
        for text in [
            "\u{feff}# remark\r\nTime_ms;Fx_kN;Fy_n;Fz_mN\r\n\r\n0;1;-2;3\r\n1;0,005;6;7000\r\n",
            "Zeit\tFx\tFy\tFz\ns\tkN\tN\tmN\n0\t1\t-2,0\t3\n0,001\t0.005\t6\t7000\n",
            "fz_n,fy_n,fx_n,t_us,Vx_g\n0.003,-2,1000,0,loud\n7,6,5,1000,-\n",
        ] {
            let other = measured(text);
            let apart = other
                .record
                .force()
                .iter()
                .zip(first.record.force())
                .map(|(a, b)| (a - b).norm());
            assert!(apart.fold(0.0, f64::max) < 1e-12, "{text}");
            assert!((other.record.time()[1] - 0.001).abs() < 1e-15, "{text}");
        }
    }

    #[test]
    fn columns_without_meaning_are_listed_and_moments_read() {
        let found = measured(
            "time_s,fx_n,fy_n,fz_n,ae_v,mx_n_mm,my_n_m,mz_n_cm\n0,1,2,3,9,1000,2,300\n1,1,2,3,9,4,5,6\n",
        );
        assert_eq!(found.unused, ["ae_v"]);
        assert!((found.record.moment().unwrap()[0] - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-12);
    }

    #[test]
    fn files_without_header_or_time_are_read_as_told() {
        let text = "1,2,3,0.5\n4,5,6,0.7\n7,8,9,0.9\n";
        let found = read_as(text, Some(50_000.0), Some("fx_n,fy_n,fz_n,vx_g")).unwrap();
        assert_eq!(found.record.force()[2], Vector3::new(7.0, 8.0, 9.0));
        assert!((found.record.step().unwrap() - 2e-5).abs() < 1e-18);
        let told = read_as(text, Some(50_000.0), Some("fx_n,fy_n,fz_n"))
            .unwrap_err()
            .to_string();
        assert!(told.contains("3 columns were told, but this row has 4"), "{told}");
        let told = read_as("fx_n,fy_n,fz_n\n1,2,3\n4,5,6\n", Some(0.0), None)
            .unwrap_err()
            .to_string();
        assert!(told.contains("a sampling rate of 0 Hz is not above 0"), "{told}");
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (text, part) in [
            ("", "no record in this file"),
            ("a,b\n1,2\n", "no column of this table is a force"),
            ("time_s,fx_n,fz_n\n0,1,2\n", "missing columns: `Fy`"),
            (
                "time_s,fx_n,fy_n,fz_n,mx_n_m\n0,1,2,3,4\n",
                "missing columns: `My`, `Mz`",
            ),
            ("fx_n,fy_n,fz_n\n1,2,3\n", "no column tells the time"),
            (
                "time_s,fx_n,fy_n,fz_n,Fx_kN\n0,1,2,3,4\n",
                "`Fx_kN` tells what a column before it tells",
            ),
            (
                "Time,Fx,Fy,Fz\n0,1,2,3\n",
                "2:1: nothing tells the unit of `Time`",
            ),
            ("Time,Fx,Fy,Fz\ns,V,N,N\n0,1,2,3\n", "2:3: `V` is no unit of `Fx`"),
            ("Time,Fx,Fy,Fz\ns,MN,N,N\n0,1,2,3\n", "`MN` is no unit of `Fx`"),
            ("time_s,fx_n,fy_n,fz_n\n0,1,2,x\n", "2:7: `x` is not a number"),
            (
                "time_s,fx_n,fy_n,fz_n\n0,1,2,3\n0,1,2,3\n",
                "3:1: time does not go on: 0 s after 0 s",
            ),
            (
                "time_s,fx_n,fy_n,fz_n\n0,0,1,0,2,0,3,0\n",
                "decimal commas need `;`",
            ),
            ("time_s,fx_n,fy_n,fz_n\n0,1,2,3\n", "a record of 1 instants"),
            (
                "time_s;fx_n;fy_n;fz_n\n0;1.000,5;2;3\n",
                "`1.000,5` is not a number",
            ),
        ] {
            let told = problems(text);
            assert!(told.contains(part), "{text}: {told}");
            assert!(told.contains("help: "), "{told}");
        }
        let told = read_as("time_s,fx_n,fy_n,fz_n\n0,1,2,3\n", Some(10.0), None)
            .unwrap_err()
            .to_string();
        assert!(told.contains("leave the rate out"), "{told}");
    }
}
