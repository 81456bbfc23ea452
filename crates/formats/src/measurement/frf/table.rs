//! FRFs as a table.
//!
//! | column | meaning | unit |
//! |---|---|---|
//! | `frequency_hz` | frequency, rising for each FRF | Hz |
//! | `receptance_real_um_per_n`, `receptance_imag_um_per_n` | real and imaginary part | `_m_per_n`, `_mm_per_n`, `_um_per_n` |
//! | `receptance_magnitude_um_per_n`, `phase_deg` | magnitude and phase, in place of the parts | the same; `_deg`, `_rad` |
//! | `mobility_...`, `accelerance_...` | velocity or acceleration by force, in place of `receptance` | `_m_per_s_per_n`, `_mm_per_s_per_n`; `_m_per_s2_per_n`, `_mm_per_s2_per_n`, `_g_per_n` |
//! | `coherence` | coherence, 0 to 1; without it all values have the same weight | - |
//! | `response`, `reference` | point and direction: `1X`, `12-Y`; both `1X` if left out | - |
//!
//! One row per frequency. Cells are separated by `;`, tab or `,`. Other columns are ignored and listed.

use std::f64::consts::TAU;
use std::io::BufRead;

use armill_core::nalgebra::Complex;
use armill_core::units::from_deg;

use super::measured::{MOST_FREQUENCIES, MeasuredFrfs, SignedDof};
use super::quantity::{Quantity, Samples};
use super::unit;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{RowLimit, each_row, named_columns, number, row_cells, separator_of};

const HINT: &str = "columns such as frequency_hz, receptance_real_um_per_n, receptance_imag_um_per_n; or accelerance_magnitude_g_per_n, phase_deg";

/// Meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    Frequency,
    /// Real part, imaginary part or magnitude: 0, 1, 2; with its factor to SI.
    Part(usize, Quantity, f64),
    /// Whether it is in degrees.
    Phase(bool),
    Coherence,
    Response,
    Reference,
}

/// The column of a name; `None` for an unknown name.
fn named(name: &str) -> Result<Option<Column>, (String, String)> {
    let lower = name.trim().to_lowercase();
    let plain = match lower.as_str() {
        "frequency_hz" => Some(Column::Frequency),
        "phase_deg" => Some(Column::Phase(true)),
        "phase_rad" => Some(Column::Phase(false)),
        "coherence" => Some(Column::Coherence),
        "response" => Some(Column::Response),
        "reference" => Some(Column::Reference),
        _ => None,
    };
    if plain.is_some() {
        return Ok(plain);
    }
    if let "frequency" | "phase" = lower.as_str() {
        let message = format!("no unit is given for `{name}`");
        return Err((message, "frequency_hz, phase_deg, phase_rad".to_owned()));
    }
    let kinds = [
        ("receptance_", Quantity::Displacement),
        ("mobility_", Quantity::Velocity),
        ("accelerance_", Quantity::Acceleration),
    ];
    let Some((rest, quantity)) = kinds
        .iter()
        .find_map(|(kind, quantity)| Some((lower.strip_prefix(kind)?, *quantity)))
    else {
        return Ok(None);
    };
    let parts = ["real", "imag", "magnitude"];
    let part = parts
        .iter()
        .enumerate()
        .find_map(|(index, part)| Some((index, rest.strip_prefix(part)?)));
    let hint = || HINT.to_owned();
    let Some((part, rest)) = part else {
        return Err((format!("`{name}` is not real, imag or magnitude"), hint()));
    };
    let label = rest
        .strip_suffix("_per_n")
        .map(|label| label.trim_start_matches('_').replace("_per_", "/"));
    let known = label.as_deref().and_then(unit::motion);
    match known.filter(|(own, _)| *own == quantity) {
        Some((_, factor)) => Ok(Some(Column::Part(part, quantity, factor))),
        None => Err((format!("`{name}` has no unit that is known for it"), hint())),
    }
}

/// A row, SI.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    frequency: f64,
    parts: [f64; 3],
    phase: f64,
    coherence: f64,
    dofs: [Option<SignedDof>; 2],
}

/// Reads a table.
///
/// # Errors
/// All problems of the file, at most 200.
pub(super) fn read(path: &str, reader: impl BufRead) -> Result<MeasuredFrfs, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(header) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no frequencies", HINT).into());
    };
    let is_same = |one, other| match (one, other) {
        (Column::Part(own, ..), Column::Part(other, ..)) => own == other,
        (one, other) => std::mem::discriminant(&one) == std::mem::discriminant(&other),
    };
    let table = named_columns(path, &header, named, is_same);
    Problems::from(table.problems).into_result()?;
    let separator = separator_of(&header.text);
    let columns = table.columns;
    let is_polar = form(path, &header, &columns)?;
    let has = |wanted: Column| columns.iter().flatten().any(|own| *own == wanted);
    let quantity = columns.iter().flatten().find_map(|column| match column {
        Column::Part(_, quantity, _) => Some(*quantity),
        _ => None,
    });
    let mut samples: Vec<Samples> = Vec::new();
    let limit = RowLimit {
        most: MOST_FREQUENCIES,
        rows: "frequencies",
        hint: "divide the file",
    };
    each_row(&mut lines, separator, limit, |line| {
        let row = row(path, line, separator, &columns)?;
        let [Some(response), Some(reference)] = row.dofs else {
            return Ok(());
        };
        let own = samples
            .iter()
            .position(|own| own.response == response && own.reference == reference);
        let own = own.unwrap_or_else(|| {
            samples.push(Samples {
                quantity: quantity.unwrap_or(Quantity::Displacement),
                response,
                reference,
                angular_frequencies: Vec::new(),
                values: Vec::new(),
                coherence: has(Column::Coherence).then(Vec::new),
            });
            samples.len() - 1
        });
        let own = &mut samples[own];
        let w = TAU * row.frequency;
        if own.angular_frequencies.last().is_some_and(|before| w <= *before) {
            let message = format!("the frequency {} Hz does not rise", row.frequency);
            let hint = "sort the rows of each FRF by frequency";
            return Err(line.problem(path, 0..line.text.len(), message, hint).into());
        }
        own.angular_frequencies.push(w);
        own.values.push(match is_polar {
            true => Complex::from_polar(row.parts[2], row.phase),
            false => Complex::new(row.parts[0], row.parts[1]),
        });
        if let Some(coherence) = &mut own.coherence {
            coherence.push(row.coherence);
        }
        Ok(())
    })?;
    if samples.is_empty() {
        return Err(Problem::of_file(path, "the file has no frequencies", HINT).into());
    }
    let mut notes = Vec::new();
    if !has(Column::Response) || !has(Column::Reference) {
        notes.push(format!(
            "{path}: points are not given: response or reference is taken as 1X"
        ));
    }
    let (frfs, coherences) = samples.iter().map(Samples::receptance).unzip();
    Ok(MeasuredFrfs {
        frfs,
        coherences,
        unused: table.unused,
        notes,
    })
}

/// Whether values are given by magnitude and phase.
///
/// # Errors
/// Missing columns; different quantities.
fn form(path: &str, header: &Line, columns: &[Option<Column>]) -> Result<bool, Problems> {
    let known = || columns.iter().flatten();
    let parts = [0, 1, 2].map(|part| known().any(|own| matches!(own, Column::Part(k, ..) if *k == part)));
    let phase = known().any(|own| matches!(own, Column::Phase(_)));
    let frequency = known().any(|own| *own == Column::Frequency);
    let mut quantities = known().filter_map(|own| match own {
        Column::Part(_, quantity, _) => Some(*quantity),
        _ => None,
    });
    let first = quantities.next();
    let message = match (parts, phase) {
        _ if !frequency => "the column `frequency_hz` is missing",
        ([true, true, false], false) | ([false, false, true], true) => {
            match quantities.all(|own| Some(own) == first) {
                true => return Ok(parts[2]),
                false => "real and imaginary part are not of the same quantity",
            }
        }
        _ => "an FRF needs real and imaginary part, or magnitude and phase",
    };
    Err(header.problem(path, 0..header.text.len(), message, HINT).into())
}

fn row(path: &str, line: &Line, separator: char, columns: &[Option<Column>]) -> Result<Row, Problems> {
    let found = row_cells(path, line, separator, columns.len())?;
    let drive = SignedDof::of_direction(1, 1);
    let mut row = Row {
        dofs: [drive, drive],
        ..Row::default()
    };
    let mut problems = Vec::new();
    for (cell, column) in found.iter().zip(columns) {
        let Some(column) = column else { continue };
        let mut problem = |message: String, hint: &str| {
            problems.push(line.problem(path, cell.span.clone(), message, hint));
        };
        if let Column::Response | Column::Reference = column {
            let dof = SignedDof::of_name(&cell.text);
            if dof.is_none() {
                let message = format!("`{}` is not a point with a direction", cell.text);
                problem(message, "a number and X, Y or Z: 1X, 12-Y");
            }
            row.dofs[usize::from(*column == Column::Reference)] = dof;
            continue;
        }
        let value = number(&cell.text, separator).filter(|value| value.is_finite());
        let Some(value) = value else {
            problem(
                format!("`{}` is not a finite number", cell.text),
                "remove rows that were not measured",
            );
            continue;
        };
        match column {
            Column::Frequency if value < 0.0 => {
                problem(
                    format!("the frequency {value} Hz is below 0"),
                    "frequencies are 0 or above",
                );
            }
            Column::Frequency => row.frequency = value,
            Column::Part(part, _, factor) => row.parts[*part] = value * factor,
            Column::Phase(true) => row.phase = from_deg(value),
            Column::Phase(false) => row.phase = value,
            Column::Coherence if !(0.0..=1.0).contains(&value) => {
                problem(
                    format!("the coherence {value} is not within 0 to 1"),
                    "coherence has no unit",
                );
            }
            Column::Coherence => row.coherence = value,
            Column::Response | Column::Reference => {}
        }
    }
    Problems::from(problems).into_result()?;
    Ok(row)
}
