//! Quantity and unit of a column of measured points.
//!
//! | column | meaning | units |
//! |---|---|---|
//! | `x_mm`, `y_mm`, `z_mm`; `actual_x`, `measured_x`, `x_act` | measured point | `_mm`, `_um`, `_m`, `_in`; none: that of the options |
//! | `nominal_x_mm` ..., `nom_x`, `x_nom` | nominal point | the same |
//! | `nx`, `ny`, `nz`; `i`, `j`, `k` | outer normal | none |
//! | `deviation_um`, `dev`, `error` | deviation from nominal | as for points |
//! | `name`, `feature`, `label`, `point`, `id` | name of the point or its feature | |
//!
//! A unit is the end of a name (`x_mm`), or in brackets (`X [mm]`, `X (mm)`). Names and units are not case-sensitive. Cells are
//! separated by `;`, tab, `,` or blanks; a line of names may begin with `//`.

use crate::measurement::numbers::blank_separated;
use crate::measurement::profile::LengthUnit;
use crate::table::sheet::{Cell, cells};

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Measured coordinate x, y or z: 0, 1, 2.
    Measured(usize),
    /// Nominal coordinate.
    Nominal(usize),
    /// Component of the normal.
    Normal(usize),
    /// Deviation from nominal.
    Deviation,
    /// Name of the point.
    Name,
}

/// A column: its quantity, and its unit if the name gives one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    pub quantity: Quantity,
    pub unit: Option<LengthUnit>,
}

impl Quantity {
    /// The quantity of a lower-case name without its unit.
    fn of_name(name: &str) -> Option<Quantity> {
        let axis = |name: &str| ["x", "y", "z"].iter().position(|axis| *axis == name);
        if let Some(found) = axis(name) {
            return Some(Quantity::Measured(found));
        }
        if let Some(found) = ["nx", "ny", "nz"].iter().position(|axis| *axis == name) {
            return Some(Quantity::Normal(found));
        }
        if let Some(found) = ["i", "j", "k"].iter().position(|axis| *axis == name) {
            return Some(Quantity::Normal(found));
        }
        match name {
            "deviation" | "dev" | "error" | "normal_deviation" => return Some(Quantity::Deviation),
            "name" | "feature" | "label" | "point" | "id" => return Some(Quantity::Name),
            _ => {}
        }
        let parts: Vec<&str> = name.split('_').filter(|part| !part.is_empty()).collect();
        let [first, second] = parts[..] else { return None };
        let (of, axis) = axis(second)
            .map(|found| (first, found))
            .or(axis(first).map(|found| (second, found)))?;
        match of {
            "actual" | "act" | "measured" | "meas" => Some(Quantity::Measured(axis)),
            "nominal" | "nom" => Some(Quantity::Nominal(axis)),
            "normal" => Some(Quantity::Normal(axis)),
            _ => None,
        }
    }

    /// Whether it is a length.
    pub fn is_length(self) -> bool {
        matches!(
            self,
            Quantity::Measured(_) | Quantity::Nominal(_) | Quantity::Deviation
        )
    }
}

/// What is meant by a name; `None` for an unknown one.
///
/// # Errors
/// A known name with a unit that is not known: problem and hint.
pub(super) fn named(name: &str) -> Result<Option<Column>, (String, String)> {
    let plain: String = name.trim().to_lowercase();
    let plain = plain
        .replace(['[', '('], "_")
        .replace([']', ')'], "")
        .replace([' ', '-', '.'], "_");
    let plain = plain.trim_matches('_');
    if let Some(quantity) = Quantity::of_name(plain) {
        return Ok(Some(Column { quantity, unit: None }));
    }
    let Some((before, unit)) = plain.rsplit_once('_') else {
        return Ok(None);
    };
    let Some(quantity) = Quantity::of_name(before.trim_end_matches('_')) else {
        return Ok(None);
    };
    match unit.parse() {
        Ok(unit) if quantity.is_length() => Ok(Some(Column {
            quantity,
            unit: Some(unit),
        })),
        _ if quantity.is_length() => Err((
            format!("`{unit}` is not a unit of `{before}`"),
            "known units are mm, um, m and in".to_owned(),
        )),
        _ => Ok(None),
    }
}

/// The cells of a line of names or of a row, separated as the names are.
pub(super) fn apart(text: &str, separator: char) -> Vec<Cell<'_>> {
    match separator {
        ' ' => blank_separated(text),
        _ => cells(text, separator),
    }
}

/// What separates the names on this line.
pub(super) fn separator(names: &str) -> char {
    [';', '\t', ',']
        .into_iter()
        .find(|c| names.contains(*c))
        .unwrap_or(' ')
}

/// Names without the mark of a remark.
pub(super) fn without_mark(line: &str) -> &str {
    line.trim_start().trim_start_matches('/')
}

/// Whether a line names x, y and z.
pub(super) fn are_names(line: &str) -> bool {
    let line = without_mark(line);
    let found = apart(line, separator(line));
    let has = |axis: usize| {
        let is_axis = |cell: &Cell<'_>| matches!(named(&cell.text), Ok(Some(column)) if column.quantity == Quantity::Measured(axis));
        found.iter().any(is_axis)
    };
    // Two of them: a table without the third is a table with a problem.
    (0..3).filter(|axis| has(*axis)).count() >= 2
}
