//! Channel and unit of each column, and the samples of the rows.
//!
//! | quantity | names, in any case | units, with their factor to SI |
//! |---|---|---|
//! | time | `t`, `time`, `zeit` | s 1, ms 1e-3, us 1e-6 |
//! | force | `fx`, `fy`, `fz` | N 1, kN 1e3, mN 1e-3 |
//! | moment | `mx`, `my`, `mz` | N m 1, kN m 1e3, N cm 1e-2, N mm 1e-3 |
//!
//! Brackets, dots, blanks and `_` in a unit are ignored: `[N.m]`, `N m` and `n_m` are the same. Newtons may be written
//! in lower case, except for `mN`.

use armill_core::load::{ActsOn, Record, RecordError};
use armill_core::nalgebra::Vector3;

use crate::table::sheet::{Cell, number};

/// Maximum absolute value of a measured number, in its own unit.
const LARGEST: f64 = 1e12;
/// Maximum number of samples: some minutes of all channels at 100 kHz.
const MOST_SAMPLES: usize = 50_000_000;

/// What a channel measures; numbers are axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Time.
    Time,
    /// Force along an axis of the sensor: 0, 1, 2 for x, y, z.
    Force(usize),
    /// Moment about this axis of the sensor.
    Moment(usize),
}

/// A channel and the factor from its unit to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    /// Measured quantity.
    pub quantity: Quantity,
    /// Value of one unit in s, N or N m.
    pub factor: f64,
}

impl Quantity {
    /// Known units, for messages.
    pub fn units(self) -> &'static str {
        match self {
            Quantity::Time => "s, ms or us",
            Quantity::Force(_) => "N, kN or mN",
            Quantity::Moment(_) => "N m, kN m, N cm or N mm",
        }
    }

    /// The factor to SI of a unit, with or without brackets; `None` if it is not a unit of this quantity.
    pub fn factor(self, unit: &str) -> Option<f64> {
        let plain: String = unit
            .chars()
            .filter(|c| !matches!(c, '[' | ']' | '(' | ')' | '.' | '*' | '\u{b7}' | ' ' | '_'))
            .collect();
        match (self, plain.as_str()) {
            (Quantity::Time, "s" | "sec")
            | (Quantity::Force(_), "N" | "n")
            | (Quantity::Moment(_), "Nm" | "nm") => Some(1.0),
            (Quantity::Time, "ms") | (Quantity::Force(_), "mN") | (Quantity::Moment(_), "Nmm" | "nmm") => {
                Some(1e-3)
            }
            (Quantity::Time, "us" | "\u{b5}s" | "\u{3bc}s") => Some(1e-6),
            (Quantity::Force(_), "kN" | "kn") | (Quantity::Moment(_), "kNm" | "knm") => Some(1e3),
            (Quantity::Moment(_), "Ncm" | "ncm") => Some(1e-2),
            _ => None,
        }
    }

    /// The quantity of a plain name such as `Fx`; not case-sensitive.
    pub fn of_name(name: &str) -> Option<Quantity> {
        let name = name.to_lowercase();
        if ["time", "zeit", "t"].contains(&name.as_str()) {
            return Some(Quantity::Time);
        }
        let mut letters = name.chars();
        let axis = |letter: Option<char>| "xyz".find(letter?);
        match (letters.next(), axis(letters.next()), letters.next()) {
            (Some('f'), Some(axis), None) => Some(Quantity::Force(axis)),
            (Some('m'), Some(axis), None) => Some(Quantity::Moment(axis)),
            _ => None,
        }
    }
}

/// Missing columns and a hint; `None` if the columns make a record.
///
/// All three forces are required, and either no moment or all three. The readers check the time.
pub(super) fn missing(columns: &[Option<Column>]) -> Option<(String, &'static str)> {
    let has = |quantity: Quantity| columns.iter().flatten().any(|column| column.quantity == quantity);
    let absent = |of: fn(usize) -> Quantity, letter: char| -> Vec<String> {
        let absent = (0..3).filter(|axis| !has(of(*axis)));
        absent
            .map(|axis| format!("`{letter}{}`", ["x", "y", "z"][axis]))
            .collect()
    };
    let forces = absent(Quantity::Force, 'F');
    if !forces.is_empty() {
        return Some((
            forces.join(", "),
            "a record needs all three forces; use a column of zeros for one that was not measured",
        ));
    }
    let moments = absent(Quantity::Moment, 'M');
    (!moments.is_empty() && moments.len() < 3)
        .then(|| (moments.join(", "), "a record needs all three moments or none"))
}

/// A column that cannot be used, with its position and a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unfit {
    /// Index, from 0.
    pub index: usize,
    /// Problem.
    pub message: String,
    /// Hint.
    pub hint: String,
}

/// The columns of a line of names with a line of units below it. `quantity` gives the quantity of the name at an index.
///
/// One entry per name; `None` where a name is unknown, with any unit.
///
/// # Errors
/// Every name whose unit is missing or is not a unit of its quantity.
pub(super) fn of_names_and_units(
    names: &[Cell<'_>],
    units: &[Cell<'_>],
    quantity: impl Fn(usize, &str) -> Option<Quantity>,
) -> Result<Vec<Option<Column>>, Vec<Unfit>> {
    let mut columns = Vec::with_capacity(names.len());
    let mut unfit = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let Some(quantity) = quantity(index, &name.text) else {
            columns.push(None);
            continue;
        };
        let unit = units.get(index).map_or("", |cell| &cell.text);
        let factor = quantity.factor(unit);
        columns.push(factor.map(|factor| Column { quantity, factor }));
        if factor.is_some() {
            continue;
        }
        let understood = quantity.units();
        let (message, hint) = match unit.is_empty() || number(unit, ';').is_some() {
            true => (
                format!("no unit is given for `{}`", name.text),
                format!(
                    "name the columns with their units, such as `time_s,fx_n,fy_n,fz_n`, or put a row of units below: \
                     {understood}"
                ),
            ),
            false => (
                format!("`{unit}` is not a unit of `{}`", name.text),
                format!("known units are {understood}; volts require the range of the amplifier"),
            ),
        };
        unfit.push(Unfit { index, message, hint });
    }
    match unfit.is_empty() {
        true => Ok(columns),
        false => Err(unfit),
    }
}

/// The first column with the same quantity as an earlier one.
pub(super) fn doubled(columns: &[Option<Column>]) -> Option<usize> {
    let quantity = |index: usize| columns[index].map(|column| column.quantity);
    (0..columns.len()).find(|index| {
        quantity(*index).is_some() && (0..*index).any(|before| quantity(before) == quantity(*index))
    })
}

/// The number in a cell, if it is a valid measured value.
///
/// `None` for text that is not a number and for numbers beyond 1e12 in any unit. `separator` decides whether a comma
/// can be a decimal mark.
pub(super) fn measured(text: &str, separator: char) -> Option<f64> {
    number(text, separator).filter(|number| number.abs() <= LARGEST)
}

/// Rows as far as they have been read, in SI units.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    /// Columns of the rows.
    columns: Vec<Option<Column>>,
    /// Time between rows, s, if no column gives the time.
    step: Option<f64>,
    /// s, increasing.
    time: Vec<f64>,
    /// N, axes of the sensor.
    force: Vec<Vector3<f64>>,
    /// N m about the sensor's origin; `None` if there are no moments.
    moment: Option<Vec<Vector3<f64>>>,
}

impl Samples {
    /// No rows yet. `step` (s) is used if there is no column of time.
    pub fn new(columns: Vec<Option<Column>>, step: Option<f64>) -> Samples {
        let moments = columns
            .iter()
            .flatten()
            .any(|column| matches!(column.quantity, Quantity::Moment(_)));
        Samples {
            columns,
            step,
            time: Vec::new(),
            force: Vec::new(),
            moment: moments.then(Vec::new),
        }
    }

    /// Number of columns in a row, unknown ones included.
    pub fn width(&self) -> usize {
        self.columns.len()
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// Adds a row: the number of each known column, in order.
    ///
    /// A refused row is not stored; the next row is compared with the one before it.
    ///
    /// # Errors
    /// Problem and hint.
    pub fn push(&mut self, numbers: &[f64]) -> Result<(), (String, &'static str)> {
        let mut time = self.step.map(|step| step * self.time.len() as f64);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (column, number) in self.columns.iter().flatten().zip(numbers) {
            let value = number * column.factor;
            match column.quantity {
                Quantity::Time => time = Some(value),
                Quantity::Force(axis) => force[axis] = value,
                Quantity::Moment(axis) => moment[axis] = value,
            }
        }
        // The readers ensure that there is a column of time or a step.
        let time = time.unwrap_or(0.0);
        if let Some(before) = self.time.last().filter(|before| **before >= time) {
            let message = format!("time does not increase: {time} s after {before} s");
            return Err((
                message,
                "each row must be later than the one before; check whether digits of the time are missing",
            ));
        }
        if self.time.len() == MOST_SAMPLES {
            return Err((format!("more than {MOST_SAMPLES} samples"), "split the record"));
        }
        self.time.push(time);
        self.force.push(force);
        if let Some(moments) = &mut self.moment {
            moments.push(moment);
        }
        Ok(())
    }

    /// The record of these rows.
    ///
    /// # Errors
    /// Records that the core refuses.
    pub fn record(self, acts_on: ActsOn) -> Result<Record, RecordError> {
        Record::new(self.time, self.force, self.moment, acts_on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_with_brackets_and_are_case_sensitive() {
        let force = Quantity::Force(0);
        assert_eq!(force.factor("[kN]"), Some(1e3));
        assert_eq!(force.factor("mN"), Some(1e-3));
        assert_eq!(force.factor("MN"), None, "mega or milli?");
        assert_eq!(force.factor("mn"), None, "mega or milli?");
        assert_eq!(force.factor("V"), None);
        assert_eq!(Quantity::Moment(1).factor("N.m"), Some(1.0));
        assert_eq!(Quantity::Moment(1).factor("N"), None);
        assert_eq!(Quantity::Time.factor("ms"), Some(1e-3));
    }

    #[test]
    fn names_must_match_a_channel_exactly() {
        assert_eq!(Quantity::of_name("FY"), Some(Quantity::Force(1)));
        assert_eq!(Quantity::of_name("mz"), Some(Quantity::Moment(2)));
        assert_eq!(Quantity::of_name("Zeit"), Some(Quantity::Time));
        for name in ["Fx1", "F", "fw", "", "Force x"] {
            assert_eq!(Quantity::of_name(name), None, "{name}");
        }
    }

    #[test]
    fn refuses_text_that_is_not_a_measured_number() {
        assert_eq!(measured("-0,5", ';'), Some(-0.5));
        assert_eq!(measured("-0.5", ';'), Some(-0.5));
        for text in ["1.234,5", "nan", "inf", "1e300", "", "1 N"] {
            assert_eq!(measured(text, ';'), None, "{text}");
        }
        assert_eq!(measured("0,5", ','), None);
    }
}
