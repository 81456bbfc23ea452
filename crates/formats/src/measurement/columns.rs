//! Which column holds which channel, in which unit; and the samples of its rows.
//!
//! | quantity | names, in any case | units, with their factor to SI |
//! |---|---|---|
//! | time | `t`, `time`, `zeit` | s 1, ms 1e-3, us 1e-6 |
//! | force | `fx`, `fy`, `fz` | N 1, kN 1e3, mN 1e-3 |
//! | moment | `mx`, `my`, `mz` | N m 1, kN m 1e3, N cm 1e-2, N mm 1e-3 |
//!
//! Brackets, points, blanks and `_` in a unit do not count: `[N.m]`, `N m` and `n_m` are one. Newtons may be written
//! small, but for `mN`.

use armill_core::load::{ActsOn, Record, RecordError};
use armill_core::nalgebra::Vector3;

use crate::table::sheet::{Cell, number};

/// No measured number is larger, in its own unit.
const LARGEST: f64 = 1e12;
/// No record has more samples: some minutes of all channels at 100 kHz.
const MOST_SAMPLES: usize = 50_000_000;

/// What a channel measures; numbers are axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// When.
    Time,
    /// Axis of the sensor: 0, 1, 2 for x, y, z.
    Force(usize),
    /// About this axis of the sensor.
    Moment(usize),
}

/// A channel and the factor from its unit to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    /// What it measures.
    pub quantity: Quantity,
    /// What one of its unit is in s, N or N m.
    pub factor: f64,
}

impl Quantity {
    /// Units that are understood, for people.
    pub fn units(self) -> &'static str {
        match self {
            Quantity::Time => "s, ms or us",
            Quantity::Force(_) => "N, kN or mN",
            Quantity::Moment(_) => "N m, kN m, N cm or N mm",
        }
    }

    /// The factor to SI of a unit as it is written, in brackets or not; `None` if it is none of this quantity.
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

    /// The quantity of a plain name such as `Fx`, in any case.
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

/// What is missing among the columns, and what to do; nothing if a record can be made of them.
///
/// Three forces must be there, of moments three or none. Whether anything tells the time the readers look after.
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
            "a record has all three forces; one that was not measured may be a column of zeros",
        ));
    }
    let moments = absent(Quantity::Moment, 'M');
    (!moments.is_empty() && moments.len() < 3)
        .then(|| (moments.join(", "), "a record has all three moments, or none"))
}

/// A column that cannot be taken: its place, and what to say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unfit {
    /// From 0.
    pub index: usize,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub hint: String,
}

/// The columns of a line of names with a line of units below it; `quantity` tells what the name at an index means.
///
/// As many as there are names; `None` where a name means nothing, whatever its unit.
///
/// # Errors
/// Every name whose unit is missing or none of its quantity.
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
                format!("nothing tells the unit of `{}`", name.text),
                format!(
                    "name the columns with their units, such as `time_s,fx_n,fy_n,fz_n`, or put a row of units below: \
                     {understood}"
                ),
            ),
            false => (
                format!("`{unit}` is no unit of `{}`", name.text),
                format!("understood are {understood}; volts need the range of the amplifier"),
            ),
        };
        unfit.push(Unfit { index, message, hint });
    }
    match unfit.is_empty() {
        true => Ok(columns),
        false => Err(unfit),
    }
}

/// The first column that tells what one before it tells.
pub(super) fn doubled(columns: &[Option<Column>]) -> Option<usize> {
    let quantity = |index: usize| columns[index].map(|column| column.quantity);
    (0..columns.len()).find(|index| {
        quantity(*index).is_some() && (0..*index).any(|before| quantity(before) == quantity(*index))
    })
}

/// The number in a cell, if it is one that was measured.
///
/// `None` for what is no number and for one beyond 1e12, in whatever unit; `separator` tells whether a comma can be a
/// decimal mark.
pub(super) fn measured(text: &str, separator: char) -> Option<f64> {
    number(text, separator).filter(|number| number.abs() <= LARGEST)
}

/// Rows, as far as they were read, in SI.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    /// Of the rows that are pushed.
    columns: Vec<Option<Column>>,
    /// Time between rows, s, where no column tells it.
    step: Option<f64>,
    /// s, rising.
    time: Vec<f64>,
    /// N, axes of the sensor.
    force: Vec<Vector3<f64>>,
    /// N m about the sensor's origin; `None` where no column tells any.
    moment: Option<Vec<Vector3<f64>>>,
}

impl Samples {
    /// No row yet; `step` (s) where there is no column of time.
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

    /// How many columns a row has, those without meaning included.
    pub fn width(&self) -> usize {
        self.columns.len()
    }

    /// How many rows there are.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// Takes a row: the number of each column that means something, in order.
    ///
    /// A row that is refused is not kept; the next is compared with the one before it.
    ///
    /// # Errors
    /// What is wrong with it, and what to do.
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
        // The readers see to it that there is a column of time or a step.
        let time = time.unwrap_or(0.0);
        if let Some(before) = self.time.last().filter(|before| **before >= time) {
            let message = format!("time does not go on: {time} s after {before} s");
            return Err((
                message,
                "each row is later than the one before; are digits of the time missing?",
            ));
        }
        if self.time.len() == MOST_SAMPLES {
            return Err((
                format!("more than {MOST_SAMPLES} samples"),
                "cut the record into pieces",
            ));
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
    /// What the core refuses of a record.
    pub fn record(self, acts_on: ActsOn) -> Result<Record, RecordError> {
        Record::new(self.time, self.force, self.moment, acts_on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_in_brackets_and_by_their_case() {
        let force = Quantity::Force(0);
        assert_eq!(force.factor("[kN]"), Some(1e3));
        assert_eq!(force.factor("mN"), Some(1e-3));
        assert_eq!(force.factor("MN"), None, "mega or milli?");
        assert_eq!(force.factor("mn"), None, "likewise");
        assert_eq!(force.factor("V"), None);
        assert_eq!(Quantity::Moment(1).factor("N.m"), Some(1.0));
        assert_eq!(Quantity::Moment(1).factor("N"), None);
        assert_eq!(Quantity::Time.factor("ms"), Some(1e-3));
    }

    #[test]
    fn names_are_those_of_channels_and_nothing_longer() {
        assert_eq!(Quantity::of_name("FY"), Some(Quantity::Force(1)));
        assert_eq!(Quantity::of_name("mz"), Some(Quantity::Moment(2)));
        assert_eq!(Quantity::of_name("Zeit"), Some(Quantity::Time));
        for name in ["Fx1", "F", "fw", "", "Force x"] {
            assert_eq!(Quantity::of_name(name), None, "{name}");
        }
    }

    #[test]
    fn what_nobody_measured_is_no_number() {
        assert_eq!(measured("-0,5", ';'), Some(-0.5));
        assert_eq!(measured("-0.5", ';'), Some(-0.5));
        for text in ["1.234,5", "nan", "inf", "1e300", "", "1 N"] {
            assert_eq!(measured(text, ';'), None, "{text}");
        }
        assert_eq!(measured("0,5", ','), None);
    }
}
