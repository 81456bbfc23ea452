//! The text export of Kistler's DynoWare.
//!
//! A header of lines `key:,value` (18 of them in version 3.2), a line of channels that begins with `Time` (`Zeit`), a
//! line of units, then the samples. Further cycles follow, each again with its last header lines. Lines that begin with
//! `#` and empty ones are passed over.
//!
//! | line | read as |
//! |---|---|
//! | `Samples per channel:,N` | how many samples each cycle must have |
//! | `Time,Fx,Fy,Fz,...` | the channels: the first is the time |
//! | `s,N,N,N,...` | the unit of each |
//! | begins with a number | a sample; any other line after samples ends their cycle |
//!
//! The separator is tab, `;` or `,`. With `,` the decimal mark may also be a comma: `0,000010,-0,0435965` for two
//! channels. Such a row is accepted only if every row has exactly two pieces per channel, the first a whole number and
//! the second only digits. Then every number has its decimal comma and the row has one meaning. A row with another
//! number of pieces contains a number without a fraction. It is not known which one, so the file is refused.
//!
//! ```text
//! Samples per channel:,3
//! Time,Fx,Fy,Fz
//! s,N,N,N
//! 0.000000,1.25,-0.5,3.0
//! ```
//!
//! Source: exports of version 3.2.5.0 as quoted in public programs that read them.

use std::io::BufRead;

use armill_core::load::{ActsOn, Record};

use super::columns::{Column, Quantity, Samples, doubled, measured, missing, of_names_and_units};
use super::force_records::{ForceReadOptions, ForceRecords, Format};
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::{Cell, cells, separator_of};

/// Maximum number of header lines.
const MOST_HEADER_LINES: usize = 200;
/// Maximum number of cycles.
const MOST_CYCLES: usize = 10_000;
/// Maximum number of channels.
const MOST_CHANNELS: usize = 1000;

/// Reads the export in `reader`. `path` is the file name shown in problems, `acts_on` the body that the forces act on.
/// `requested.rate_hz` and `requested.columns` are not used for exports.
///
/// One record per cycle, in order. All have the same channels in the same units.
///
/// # Errors
/// All problems of the file, at most 200: no line of channels, missing channels, a number of channel names other than
/// three or six, units that are missing or unknown, rows that can be read in two ways or none, cycles whose length
/// differs from the header.
pub fn read(
    path: &str,
    reader: impl BufRead,
    acts_on: ActsOn,
    requested: &ForceReadOptions,
) -> Result<ForceRecords, Problems> {
    let channels = Channels::reported(requested.channels.as_deref()).ok_or_else(|| {
        let names = requested.channels.as_ref().map_or(0, Vec::len);
        let message = format!("{names} names of channels were given");
        Problem::of_file(
            path,
            message,
            "give three forces, or three forces and three moments",
        )
    })?;
    let mut lines = Lines::new(path, reader);
    let mut export = Reader {
        path,
        acts_on,
        channels,
        expected_samples: None,
        header_lines: 0,
        table: None,
        cycle: None,
        cycles: 0,
        records: Vec::new(),
        unused: Vec::new(),
        problems: Vec::new(),
    };
    while export.problems.len() < MOST_PROBLEMS {
        let taken = match lines.next_row() {
            Ok(Some(line)) => export.take(line, &mut lines),
            Ok(None) => break,
            Err(wrong) => Err(wrong),
        };
        if let Err(wrong) = taken {
            // The following lines cannot be evaluated.
            export.problems.extend(wrong);
            break;
        }
    }
    export.finish()
}

/// Names of the three forces in a file, and of the three moments, which may be missing.
struct Channels {
    /// x, y, z of the sensor.
    force: [String; 3],
    /// The same axes; may be missing in the file.
    moment: [String; 3],
}

impl Channels {
    /// The channels with these names; the usual names if none are given; `None` if there are not three or six.
    fn reported(names: Option<&[String]>) -> Option<Channels> {
        let usual = |letter: &str| ["x", "y", "z"].map(|axis| format!("{letter}{axis}"));
        let Some(names) = names else {
            return Some(Channels {
                force: usual("F"),
                moment: usual("M"),
            });
        };
        let three = |names: &[String]| -> Option<[String; 3]> { names.to_vec().try_into().ok() };
        let force = three(names.get(..3)?)?;
        let moment = match names.get(3..)? {
            [] => usual("M"),
            moments => three(moments)?,
        };
        Some(Channels { force, moment })
    }

    /// The quantity of a channel with this name, not case-sensitive. Time is identified by its position, not its name.
    fn quantity(&self, name: &str) -> Option<Quantity> {
        let of = |names: &[String; 3]| names.iter().position(|known| known.eq_ignore_ascii_case(name));
        of(&self.force)
            .map(Quantity::Force)
            .or_else(|| of(&self.moment).map(Quantity::Moment))
    }
}

/// Use of commas in the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Marks {
    /// Decimal points.
    Points,
    /// Decimal commas.
    Commas,
}

/// The lines of channels and units after reading.
struct Table {
    /// Separator in the line of channels.
    separator: char,
    /// If commas separate cells: whether they are decimal marks too, from the first row.
    marks: Option<Marks>,
    /// One entry per channel; `None` is ignored.
    columns: Vec<Option<Column>>,
    /// Whether rows end in a separator.
    open_end: bool,
}

/// Samples since the last header.
struct Cycle {
    /// Samples that could be read.
    samples: Samples,
    /// The last of their lines, for problems of the whole cycle.
    last: Line,
    /// Number of problems of the file before them.
    problems: usize,
}

/// An export as far as it has been read.
struct Reader<'a> {
    path: &'a str,
    acts_on: ActsOn,
    /// Names of forces and moments.
    channels: Channels,
    /// Number of samples per cycle, from the header.
    expected_samples: Option<usize>,
    /// Lines since the last samples.
    header_lines: usize,
    /// Known after the line of channels.
    table: Option<Table>,
    /// Samples of the current cycle.
    cycle: Option<Cycle>,
    /// Number of completed cycles.
    cycles: usize,
    /// One per cycle without problems.
    records: Vec<Record>,
    /// Names of ignored channels.
    unused: Vec<String>,
    problems: Vec<Problem>,
}

impl Reader<'_> {
    /// Reads the next line; after a line of channels, also the line of units.
    ///
    /// # Errors
    /// Problems after which the following lines cannot be evaluated; other problems are collected.
    fn take(&mut self, line: Line, lines: &mut Lines<impl BufRead>) -> Result<(), Problems> {
        if let Some(mut table) = self.table.take_if(|_| begins_with_number(&line.text)) {
            self.sample(line, &mut table);
            self.table = Some(table);
            return Ok(());
        }
        self.end_cycle();
        self.header_lines += 1;
        if self.header_lines > MOST_HEADER_LINES {
            let message = format!("no line of channels in {MOST_HEADER_LINES} lines");
            let hint = "this line begins with `Time` or `Zeit`; other tables are read as CSV";
            return Err(self.at(&line, message, hint));
        }
        if is_channels(&line.text) {
            let made = self.table_of(&line, lines)?;
            // A decimal comma remains a decimal comma.
            let marks = self.table.as_ref().and_then(|before| before.marks);
            if self
                .table
                .as_ref()
                .is_some_and(|before| before.columns != made.columns)
            {
                let hint = "all cycles of an export have the same channels in the same units";
                let message = "the channels differ from those of the previous cycle".to_owned();
                return Err(self.at(&line, message, hint));
            }
            self.table = Some(Table { marks, ..made });
        } else if self.table.is_none() {
            self.header(&line.text);
        }
        Ok(())
    }

    /// A line `key:,value` with any separator.
    ///
    /// Only the number of samples is used. A value that is not a whole number is ignored.
    fn header(&mut self, line: &str) {
        let (key, value) = line.split_once([':', '\t', ';', ',']).unwrap_or((line, ""));
        let no_part = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"');
        if key
            .trim_matches(no_part)
            .to_lowercase()
            .starts_with("samples per channel")
        {
            self.expected_samples = value.trim_matches(no_part).parse().ok();
        }
    }

    /// The line of channels, and the line of units below it.
    ///
    /// # Errors
    /// A file that ends here, an invalid line of units, units that are missing or unknown, and what `check`
    /// refuses.
    fn table_of(&mut self, line: &Line, lines: &mut Lines<impl BufRead>) -> Result<Table, Problems> {
        let separator = separator_of(&line.text);
        let mut names = cells(&line.text, separator);
        let open_end = names.len() > 1 && names.last().is_some_and(|name| name.text.is_empty());
        if open_end {
            names.pop();
        }
        if names.len() > MOST_CHANNELS {
            let message = format!("more than {MOST_CHANNELS} channels");
            return Err(self.at(line, message, "this is not a line of channels"));
        }
        let Some(below) = lines.next_row()? else {
            let message = "the file ends after the line of channels".to_owned();
            return Err(self.at(line, message, "export it again"));
        };
        let mut units = cells(&below.text, separator);
        if open_end && units.last().is_some_and(|unit| unit.text.is_empty()) {
            units.pop();
        }
        if units.len() != names.len() || begins_with_number(&below.text) {
            let message = format!("a line of {} units is required below the channels", names.len());
            let hint = "export with units: otherwise it is not known whether forces are in N or kN";
            return Err(self.at(&below, message, hint));
        }
        let columns = of_names_and_units(&names, &units, |index, name| match index {
            0 => Some(Quantity::Time),
            _ => self.channels.quantity(name),
        });
        let columns = columns.map_err(|unfit| -> Problems {
            let problems = unfit.into_iter().map(|unfit| {
                let span = units[unfit.index].span.clone();
                below.problem(self.path, span, unfit.message, &unfit.hint)
            });
            problems.collect()
        })?;
        self.check(line, &names, &columns)?;
        let unused = names.iter().zip(&columns).filter(|(_, column)| column.is_none());
        self.unused = unused.map(|(name, _)| name.text.to_string()).collect();
        Ok(Table {
            separator,
            marks: None,
            columns,
            open_end,
        })
    }

    /// Checks that these channels make a record.
    ///
    /// # Errors
    /// Two channels of one quantity, missing forces, incomplete moments.
    fn check(&self, line: &Line, names: &[Cell<'_>], columns: &[Option<Column>]) -> Result<(), Problems> {
        if let Some(index) = doubled(columns) {
            let message = format!("two channels are called `{}`", names[index].text);
            return Err(self.at(line, message, "remove one of the two channels"));
        }
        if let Some((missing, _)) = missing(columns) {
            let found: Vec<&str> = names.iter().map(|name| name.text.as_ref()).collect();
            let hint = format!(
                "this file has {}; give the names of the force channels",
                found.join(", ")
            );
            return Err(self.at(line, format!("missing channels: {missing}"), &hint));
        }
        Ok(())
    }

    /// Adds a row as a sample of the cycle; problems are collected.
    fn sample(&mut self, line: Line, table: &mut Table) {
        let mut cycle = self.cycle.take().unwrap_or_else(|| Cycle {
            samples: Samples::new(table.columns.clone(), None),
            last: line.clone(),
            problems: self.problems.len(),
        });
        let numbers = self.numbers(&line, table);
        let pushed = numbers.and_then(|numbers| {
            let pushed = cycle.samples.push(&numbers);
            pushed.map_err(|(message, hint)| self.at(&line, message, hint))
        });
        self.problems.extend(pushed.err().into_iter().flatten());
        self.cycle = Some(Cycle { last: line, ..cycle });
    }

    /// The numbers of a row: one for each known column.
    ///
    /// # Errors
    /// A number of cells that differs from the number of channels, commas that can be read in two ways or differently
    /// from the rows before, a cell that is not a number.
    fn numbers(&self, line: &Line, table: &mut Table) -> Result<Vec<f64>, Problems> {
        let mut cells = cells(&line.text, table.separator);
        if table.open_end && cells.last().is_some_and(|cell| cell.text.is_empty()) {
            cells.pop();
        }
        let width = table.columns.len();
        if table.separator == ',' {
            let seen = match cells.len() {
                count if count == width => Some(Marks::Points),
                count if count == 2 * width && all_halves(&cells) => Some(Marks::Commas),
                _ => None,
            };
            if seen.is_none() || table.marks.is_some_and(|known| Some(known) != seen) {
                return Err(self.ambiguous(line, cells.len(), width));
            }
            table.marks = seen;
        } else if cells.len() != width {
            let message = format!("{} cells, but there are {width} channels", cells.len());
            return Err(self.at(line, message, CUT_SHORT));
        }
        let meant = table
            .columns
            .iter()
            .enumerate()
            .filter(|(_, column)| column.is_some());
        meant
            .map(|(index, _)| {
                let text = match table.marks {
                    Some(Marks::Commas) => {
                        format!("{}.{}", cells[2 * index].text, cells[2 * index + 1].text).into()
                    }
                    _ => cells[index].text.clone(),
                };
                let no_number = || self.at(line, format!("`{text}` is not a number"), CUT_SHORT);
                measured(&text, table.separator).ok_or_else(no_number)
            })
            .collect()
    }

    /// Makes a record of the samples since the last header. A cycle with problems gets no further messages.
    fn end_cycle(&mut self) {
        let Some(cycle) = self.cycle.take() else { return };
        self.header_lines = 0;
        self.cycles += 1;
        if self.problems.len() > cycle.problems {
            return;
        }
        match self.record(cycle) {
            Ok(record) => self.records.push(record),
            Err(problems) => self.problems.extend(problems),
        }
    }

    /// The record of a cycle.
    ///
    /// # Errors
    /// Too many cycles, a number of samples that differs from the header, times that are not equally spaced.
    fn record(&self, Cycle { samples, last, .. }: Cycle) -> Result<Record, Problems> {
        if self.cycles > MOST_CYCLES {
            let message = format!("more than {MOST_CYCLES} cycles");
            return Err(self.at(&last, message, "split the record"));
        }
        if let Some(expected) = self
            .expected_samples
            .filter(|expected| *expected != samples.count())
        {
            let message = format!(
                "cycle {} ends after {} samples, but its header specifies {expected}",
                self.cycles,
                samples.count()
            );
            return Err(self.at(&last, message, CUT_SHORT));
        }
        let record = samples
            .record(self.acts_on)
            .map_err(|error| self.at(&last, error.to_string(), "export it again"))?;
        // A sampled record is equally spaced. If it is not, its times were misread.
        record
            .step()
            .map_err(|error| self.at(&last, error.to_string(), "export with more digits of time"))?;
        Ok(record)
    }

    /// The content of the file, or all its problems.
    fn finish(mut self) -> Result<ForceRecords, Problems> {
        self.end_cycle();
        if self.records.is_empty() && self.problems.is_empty() {
            let hint = "a DynoWare export has a line of channels (`Time`, `Fx`, ...), one of units, and samples; other \
                        tables are read as CSV";
            self.problems
                .push(Problem::of_file(self.path, "the file has no samples", hint));
        }
        Problems::from(self.problems).into_result()?;
        Ok(ForceRecords {
            format: Format::DynoWare,
            records: self.records,
            unused: self.unused,
        })
    }

    /// A row whose commas are ambiguous.
    fn ambiguous(&self, line: &Line, count: usize, width: usize) -> Problems {
        let message = format!(
            "{count} pieces between commas are neither {width} numbers with points nor {width} numbers with commas"
        );
        let hint = "commas both separate cells and mark decimals, and they cannot be distinguished: export with tab or \
                    semicolon between cells";
        self.at(line, message, hint)
    }

    /// A problem of a whole line.
    fn at(&self, line: &Line, message: String, hint: &str) -> Problems {
        line.problem(self.path, 0..line.text.len(), message, hint).into()
    }
}

/// Hint for a row of the wrong length.
const CUT_SHORT: &str = "is the file cut short? export it again";

/// Whether a line is a sample: it begins with a digit or point, possibly after a sign or quote.
fn begins_with_number(line: &str) -> bool {
    let line = line.trim_start().trim_start_matches('"');
    let line = line.strip_prefix(['-', '+']).unwrap_or(line);
    line.starts_with(|c: char| c.is_ascii_digit() || c == '.')
}

/// Whether a line names the channels: its first cell is the time.
pub(super) fn is_channels(line: &str) -> bool {
    let first = line.split(['\t', ';', ',']).next().unwrap_or_default();
    let first = first.trim().trim_matches('"').to_lowercase();
    // `Time:,12:00` is the time of day of the measurement.
    first == "time" || first == "zeit"
}

/// Whether the pieces are halves of numbers: whole part, digits, whole part, digits.
///
/// The whole part may have a sign, the digits an exponent.
fn all_halves(pieces: &[Cell<'_>]) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    pieces.chunks(2).all(|pair| {
        let [whole, fraction] = pair else { return false };
        let (whole, fraction): (&str, &str) = (&whole.text, &fraction.text);
        let fraction = fraction
            .split_once(['e', 'E'])
            .map_or(fraction, |(fraction, exponent)| {
                let exponent = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
                if digits(exponent) { fraction } else { "" }
            });
        digits(whole.strip_prefix(['-', '+']).unwrap_or(whole)) && digits(fraction)
    })
}

#[cfg(test)]
mod tests;
