//! The text export of Kistler's DynoWare.
//!
//! A header of lines `key:,value` (18 of them in version 3.2), a line of channels that begins with `Time` (`Zeit`), a line of
//! units, then the samples. Further cycles follow, each again with its last header lines.
//!
//! The separator is tab, `;` or `,`. With `,` the decimal mark may be a comma too: `0,000010,-0,0435965` for two channels.
//! Such a row is put together again only if every row has exactly two pieces a channel, each first one whole and each
//! second one digits: then every number has its comma, and nothing can be meant otherwise. A row with another count holds
//! a number without fraction, nobody can say which, and the file is refused.
//!
//! Source: exports of version 3.2.5.0 as quoted in public programs that read them.

use std::io::BufRead;

use armill_core::load::{ActsOn, Record};

use super::columns::{Column, Quantity, Samples, missing, number};
use crate::document::lines::{Line, Lines};
use crate::document::{Problems, Source};

/// No header is longer, in lines.
const MOST_HEADER_LINES: usize = 200;
/// No export has more cycles.
const MOST_CYCLES: usize = 10_000;
/// No export has more channels.
const MOST_CHANNELS: usize = 1000;

/// What the three forces are called in a file, and the three moments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channels {
    /// Forces along x, y and z of the sensor.
    pub force: [String; 3],
    /// Moments about them; a file need not have them.
    pub moment: [String; 3],
}

impl Default for Channels {
    fn default() -> Channels {
        let named = |letter: &str| ["x", "y", "z"].map(|axis| format!("{letter}{axis}"));
        Channels {
            force: named("F"),
            moment: named("M"),
        }
    }
}

/// What an export held.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// The lines of the first header, as key and value.
    pub header: Vec<[String; 2]>,
    /// The cycles, in order; axes of the sensor.
    pub cycles: Vec<Record>,
    /// Channels that were passed over.
    pub unused: Vec<String>,
}

/// Reads the export in `reader`; `path` is what problems show, `acts_on` what the forces act on.
///
/// # Errors
/// The first problem of the file: no line of channels, channels that are missing, units that are missing or unknown, rows
/// that can be read in two ways or none, cycles of another length than the header tells.
pub fn read(
    path: &str,
    reader: impl BufRead,
    acts_on: ActsOn,
    channels: &Channels,
) -> Result<Export, Problems> {
    let mut reader = Reader {
        path,
        acts_on,
        channels,
        lines: Lines::new(path, reader),
        wanted_samples: None,
    };
    reader.read()
}

struct Reader<'a, R> {
    path: &'a str,
    acts_on: ActsOn,
    channels: &'a Channels,
    lines: Lines<R>,
    /// Samples of each cycle, as the header tells.
    wanted_samples: Option<usize>,
}

/// How the rows of a file are to be taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// Tab or `;` between cells.
    Separated(char),
    /// Commas between cells; whether they are decimal marks too is seen in the first row.
    Commas(Option<Marks>),
}

/// What commas are between which cells stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Marks {
    /// Decimal points.
    Points,
    /// Decimal commas.
    Commas,
}

/// The lines of channels and units, understood.
struct Table {
    form: Form,
    columns: Vec<Option<Column>>,
    unused: Vec<String>,
    /// Whether rows end in a separator.
    open_end: bool,
}

impl<R: BufRead> Reader<'_, R> {
    fn read(&mut self) -> Result<Export, Problems> {
        let mut export = Export {
            header: Vec::new(),
            cycles: Vec::new(),
            unused: Vec::new(),
        };
        let mut table: Option<Table> = None;
        let mut samples: Option<Samples> = None;
        let mut last: Option<Line> = None;
        let mut header_lines = 0;
        while let Some(line) = self.lines.next()? {
            if line.text.trim().is_empty() {
                continue;
            }
            match &mut table {
                Some(table) if begins_with_number(&line.text) => {
                    let samples = samples.get_or_insert_with(|| Samples::new(table.columns.clone(), None));
                    self.row(&line, table, samples)?;
                    last = Some(line);
                    continue;
                }
                _ => {}
            }
            if let (Some(samples), Some(last)) = (samples.take(), &last) {
                export
                    .cycles
                    .push(self.cycle(samples, last, export.cycles.len())?);
                header_lines = 0;
            }
            header_lines += 1;
            if header_lines > MOST_HEADER_LINES {
                return Err(self.no_channels(&line));
            }
            if is_channels(&line.text) {
                let made = self.table(&line)?;
                if table
                    .as_ref()
                    .is_some_and(|before| before.columns != made.columns)
                {
                    let hint = "all cycles of an export have the same channels in the same units";
                    return Err(self.at(&line, "other channels than those of the cycle before", hint));
                }
                export.unused.clone_from(&made.unused);
                // A comma that was a decimal mark stays one.
                let form = table.as_ref().map_or(made.form, |before| before.form);
                table = Some(Table { form, ..made });
            } else if export.cycles.is_empty() && table.is_none() {
                export.header.push(self.header(&line));
            }
        }
        match (samples, last) {
            (Some(samples), Some(last)) => {
                export
                    .cycles
                    .push(self.cycle(samples, &last, export.cycles.len())?);
            }
            _ if export.cycles.is_empty() => {
                let hint = "a DynoWare export has a line of channels (`Time`, `Fx`, ...), one of units, and samples; other \
                            tables are read as CSV";
                let source = Source::new(self.path, "");
                return Err(source
                    .problem(0..0, "no samples in this file", Some(hint.to_owned()))
                    .into());
            }
            _ => {}
        }
        Ok(export)
    }

    /// A line `key:,value`, with whatever separator.
    fn header(&mut self, line: &Line) -> [String; 2] {
        let text = line.text.trim();
        let (key, value) = text.split_once([':', '\t', ';', ',']).unwrap_or((text, ""));
        let value = value
            .trim_matches(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"'))
            .to_owned();
        let key = key.trim().trim_matches('"').to_owned();
        if key.to_lowercase().starts_with("samples per channel") {
            self.wanted_samples = value.parse().ok();
        }
        [key, value]
    }

    /// The line of channels, and the line of units below it.
    fn table(&mut self, line: &Line) -> Result<Table, Problems> {
        let separator = ['\t', ';']
            .into_iter()
            .find(|c| line.text.contains(*c))
            .unwrap_or(',');
        let mut names: Vec<&str> = parts(&line.text, separator);
        let open_end = names.len() > 1 && names.last().is_some_and(|name| name.is_empty());
        if open_end {
            names.pop();
        }
        if names.len() > MOST_CHANNELS {
            return Err(self.at(line, "more than 1000 channels", "this is no line of channels"));
        }
        let below = loop {
            match self.lines.next()? {
                Some(below) if below.text.trim().is_empty() => {}
                Some(below) => break below,
                None => return Err(self.at(line, "the file ends behind its channels", "export it again")),
            }
        };
        let mut units = parts(&below.text, separator);
        if open_end && units.last().is_some_and(|unit| unit.is_empty()) {
            units.pop();
        }
        if units.len() != names.len() || begins_with_number(&below.text) {
            let message = format!("a line of {} units is wanted below the channels", names.len());
            return Err(self.at(
                &below,
                &message,
                "export with units: nothing else tells whether these are N or kN",
            ));
        }
        let mut columns: Vec<Option<Column>> = Vec::new();
        let mut unused = Vec::new();
        for (index, (name, unit)) in names.iter().zip(&units).enumerate() {
            let quantity = match index {
                0 => Some(Quantity::Time),
                _ => self.quantity(name),
            };
            let Some(quantity) = quantity else {
                unused.push((*name).to_owned());
                columns.push(None);
                continue;
            };
            if columns.iter().flatten().any(|column| column.quantity == quantity) {
                return Err(self.at(
                    line,
                    &format!("two channels are called `{name}`"),
                    "keep one of the two",
                ));
            }
            let Some(factor) = quantity.factor(unit) else {
                let message = format!("`{unit}` is no unit of `{name}`");
                let hint = format!(
                    "export it in {}; volts need the range of the amplifier",
                    quantity.units()
                );
                return Err(self.at(&below, &message, &hint));
            };
            columns.push(Some(Column { quantity, factor }));
        }
        if let Some((missing, _)) = missing(&columns) {
            let message = format!("missing channels: {missing}");
            let hint = format!(
                "this file has {}; tell what the forces are called in it",
                names.join(", ")
            );
            return Err(self.at(line, &message, &hint));
        }
        let form = match separator {
            ',' => Form::Commas(None),
            separator => Form::Separated(separator),
        };
        Ok(Table {
            form,
            columns,
            unused,
            open_end,
        })
    }

    fn quantity(&self, name: &str) -> Option<Quantity> {
        let of = |names: &[String; 3]| names.iter().position(|known| known.eq_ignore_ascii_case(name));
        of(&self.channels.force)
            .map(Quantity::Force)
            .or_else(|| of(&self.channels.moment).map(Quantity::Moment))
    }

    fn row(&self, line: &Line, table: &mut Table, samples: &mut Samples) -> Result<(), Problems> {
        let separator = match table.form {
            Form::Separated(separator) => separator,
            Form::Commas(_) => ',',
        };
        let mut cells = parts(&line.text, separator);
        if table.open_end && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        let width = samples.width();
        let marks = match table.form {
            Form::Separated(_) => None,
            Form::Commas(known) => {
                let seen = match cells.len() {
                    count if count == width => Some(Marks::Points),
                    count if count == 2 * width && all_halves(&cells) => Some(Marks::Commas),
                    _ => None,
                };
                if seen.is_none() || known.is_some_and(|known| Some(known) != seen) {
                    return Err(self.ambiguous(line, cells.len(), width));
                }
                table.form = Form::Commas(seen);
                seen
            }
        };
        if marks != Some(Marks::Commas) && cells.len() != width {
            let message = format!("{} cells below {width} channels", cells.len());
            return Err(self.at(line, &message, "is the file cut short? export it again"));
        }
        let mut numbers = Vec::with_capacity(width);
        for (index, column) in samples.columns().iter().enumerate() {
            if column.is_none() {
                continue;
            }
            let text = match marks {
                Some(Marks::Commas) => format!("{}.{}", cells[2 * index], cells[2 * index + 1]),
                _ => cells[index].to_owned(),
            };
            let Some(number) = number(&text, marks.is_none()) else {
                return Err(self.at(
                    line,
                    &format!("`{text}` is not a number"),
                    "is the file cut short? export it again",
                ));
            };
            numbers.push(number);
        }
        samples
            .push(&numbers)
            .map_err(|(message, hint)| self.at(line, &message, hint))
    }

    fn cycle(&self, samples: Samples, last: &Line, before: usize) -> Result<Record, Problems> {
        if before == MOST_CYCLES {
            return Err(self.at(last, "more than 10000 cycles", "cut the record into pieces"));
        }
        if let Some(wanted) = self.wanted_samples.filter(|wanted| *wanted != samples.count()) {
            let message = format!(
                "cycle {} ends after {} samples, but its header tells {wanted}",
                before + 1,
                samples.count()
            );
            return Err(self.at(last, &message, "is the file cut short? export it again"));
        }
        let record = samples
            .record(self.acts_on)
            .map_err(|error| self.at(last, &error.to_string(), "export it again"))?;
        // A sampled record goes in equal steps: if it does not, its times were not read as they were meant.
        record
            .step()
            .map_err(|error| self.at(last, &error.to_string(), "export with more digits of time"))?;
        Ok(record)
    }

    fn ambiguous(&self, line: &Line, count: usize, width: usize) -> Problems {
        let message = format!(
            "{count} pieces between commas are neither {width} numbers with points nor {width} numbers with commas"
        );
        let hint = "commas separate cells and mark decimals at once, and which is which cannot be told: export with tab or \
                    semicolon between cells";
        self.at(line, &message, hint)
    }

    fn no_channels(&self, line: &Line) -> Problems {
        let message = format!("no line of channels in {MOST_HEADER_LINES} lines");
        self.at(
            line,
            &message,
            "it begins with `Time` or `Zeit`; other tables are read as CSV",
        )
    }

    fn at(&self, line: &Line, message: &str, hint: &str) -> Problems {
        line.problem(self.path, 0..line.text.len(), message, hint).into()
    }
}

/// The cells of a line without blanks and quotes.
fn parts(line: &str, separator: char) -> Vec<&str> {
    line.split(separator)
        .map(|part| part.trim().trim_matches('"').trim())
        .collect()
}

fn begins_with_number(line: &str) -> bool {
    let line = line.trim_start().trim_start_matches('"');
    let line = line.strip_prefix(['-', '+']).unwrap_or(line);
    line.starts_with(|c: char| c.is_ascii_digit() || c == '.')
}

/// Whether a line names the channels: its first cell is the time.
pub(super) fn is_channels(line: &str) -> bool {
    let first = line.split(['\t', ';', ',']).next().unwrap_or_default();
    let first = first.trim().trim_matches('"').to_lowercase();
    // `Time:,12:00` is the hour of the measurement.
    first == "time" || first == "zeit"
}

/// Whether the pieces are halves of numbers: whole, digits, whole, digits.
fn all_halves(pieces: &[&str]) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    pieces.chunks(2).all(|pair| {
        let [whole, fraction] = pair else { return false };
        let fraction = fraction
            .split_once(['e', 'E'])
            .map_or(*fraction, |(fraction, exponent)| {
                let exponent = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
                if digits(exponent) { fraction } else { "" }
            });
        digits(whole.strip_prefix(['-', '+']).unwrap_or(whole)) && digits(fraction)
    })
}

#[cfg(test)]
mod tests;
