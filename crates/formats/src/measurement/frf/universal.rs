//! A universal file: datasets between lines `-1`. Functions are in datasets 58 (58b: with binary data), units in dataset 164.
//!
//! The unit of an axis is that of its label; without one, that of dataset 164; without both, SI. A coherence (function 6) belongs to the FRF with the same response and
//! reference. Other functions and datasets are left out and listed.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io::BufRead;

use armill_core::nalgebra::Complex;

use super::binary::BinaryForm;
use super::function::{self, Axis, Function, fortran, is_delimiter};
use super::measured::{MOST_FREQUENCIES, MeasuredFrfs, SignedDof};
use super::quantity::{Quantity, Samples};
use super::unit;
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// Functions at most.
const MOST_FUNCTIONS: usize = 10_000;

/// Reads a universal file.
///
/// # Errors
/// All problems of the file, at most 200; no FRF.
pub(super) fn read(path: &str, reader: impl BufRead) -> Result<MeasuredFrfs, Problems> {
    let mut lines = Lines::new(path, reader);
    let mut units: Option<[f64; 2]> = None;
    let (mut functions, mut problems, mut frequencies) = (Vec::new(), Vec::new(), 0);
    let mut left_out: BTreeMap<String, usize> = BTreeMap::new();
    while let Some(number) = dataset(&mut lines)? {
        match number.text.trim() {
            "58" => {
                let found = function::read(&mut lines, MOST_FREQUENCIES - frequencies, None)?;
                frequencies += found.values.len();
                within_limits(path, &number, [functions.len(), frequencies])?;
                functions.push((found, units));
                if let Some(line) = lines.next()?
                    && !is_delimiter(&line.text)
                {
                    let message = "the dataset has more numbers than it says";
                    let hint = "the seventh line of the dataset has the number of values";
                    return Err(line.problem(path, 0..line.text.len(), message, hint).into());
                }
                continue;
            }
            binary if binary.starts_with("58b") => {
                let form = BinaryForm::of(path, &number)?;
                let found = function::read(&mut lines, MOST_FREQUENCIES - frequencies, Some(&form))?;
                frequencies += found.values.len();
                within_limits(path, &number, [functions.len(), frequencies])?;
                functions.push((found, units));
                if !ends_here(&mut lines) {
                    let message = "the binary data of the function do not end where its counts say";
                    let hint = "the seventh line of the dataset has the number of values: export the file again, or as text (dataset 58)";
                    return Err(number.problem(path, 0..number.text.len(), message, hint).into());
                }
                continue;
            }
            "164" => units = Some(factors(&mut lines)?),
            other => *left_out.entry(format!("dataset {other}")).or_default() += 1,
        }
        // What remains of the dataset.
        while let Some(line) = lines.next()? {
            if is_delimiter(&line.text) {
                break;
            }
        }
    }
    let mut measured = MeasuredFrfs::default();
    let mut samples: Vec<Samples> = Vec::new();
    for (found, units) in functions.iter().filter(|(found, _)| found.kind == 4) {
        measured.notes.extend(found.note.clone());
        match self::samples(path, found, *units, &mut measured.notes) {
            Ok(own) => samples.push(own),
            Err(wrong) => problems.extend(wrong),
        }
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
    }
    Problems::from(problems).into_result()?;
    for (found, _) in functions.iter().filter(|(found, _)| found.kind != 4) {
        let belongs = |own: &&mut Samples| {
            let dofs = found
                .dofs
                .map(|[node, direction]| SignedDof::of_direction(node, direction));
            dofs == [Some(own.response), Some(own.reference)] && own.values.len() == found.values.len()
        };
        match samples.iter_mut().find(belongs).filter(|_| found.kind == 6) {
            Some(own) => own.coherence = Some(found.values.iter().map(|value| value[0]).collect()),
            None => {
                *left_out
                    .entry(format!("function of type {}", found.kind))
                    .or_default() += 1;
            }
        }
    }
    measured.unused = left_out
        .iter()
        .map(|(name, count)| format!("{count} x {name}"))
        .collect();
    (measured.frfs, measured.coherences) = samples.iter().map(Samples::receptance).unzip();
    measured.notes.dedup();
    match measured.frfs.is_empty() {
        true => Err(Problem::of_file(
            path,
            "the file has no frequency response function",
            "functions of type 4 in datasets 58 are read",
        )
        .into()),
        false => Ok(measured),
    }
}

/// Whether there are not too many functions and frequencies.
fn within_limits(path: &str, number: &Line, counts: [usize; 2]) -> Result<(), Problems> {
    if counts[0] < MOST_FUNCTIONS && counts[1] < MOST_FREQUENCIES {
        return Ok(());
    }
    let message = format!("more than {MOST_FUNCTIONS} functions or {MOST_FREQUENCIES} frequencies");
    Err(number
        .problem(path, 0..number.text.len(), message, "divide the file")
        .into())
}

/// Whether the dataset ends after its binary data: here, or after an end of a line.
fn ends_here(lines: &mut Lines<impl BufRead>) -> bool {
    for _ in 0..2 {
        match lines.next() {
            Ok(Some(line)) if line.text.trim().is_empty() => {}
            Ok(Some(line)) => return is_delimiter(&line.text),
            Ok(None) | Err(_) => return false,
        }
    }
    false
}

/// The line with the number of the next dataset.
fn dataset(lines: &mut Lines<impl BufRead>) -> Result<Option<Line>, Problems> {
    while let Some(line) = lines.next()? {
        if !line.text.trim().is_empty() && !is_delimiter(&line.text) {
            return Ok(Some(line));
        }
    }
    Ok(None)
}

/// Factors of length and force of dataset 164: values are divided by them.
fn factors(lines: &mut Lines<impl BufRead>) -> Result<[f64; 2], Problems> {
    lines.next()?;
    let Some(line) = lines.next()? else {
        let hint = "the file is not complete: export it again";
        return Err(Problem::of_file(lines.name(), "the file ends within a dataset", hint).into());
    };
    let found: Vec<f64> = line.text.split_ascii_whitespace().map_while(fortran).collect();
    match found[..] {
        [length, force, ..] if length > 0.0 && force > 0.0 => Ok([length, force]),
        _ => {
            let message = "the factors of length and force are not numbers above 0";
            let hint = "dataset 164: three factors in its second record";
            Err(line
                .problem(lines.name(), 0..line.text.len(), message, hint)
                .into())
        }
    }
}

/// An FRF in SI.
fn samples(
    path: &str,
    found: &Function,
    units: Option<[f64; 2]>,
    notes: &mut Vec<String>,
) -> Result<Samples, Problems> {
    let mut problems = Vec::new();
    let [frequency, numerator, denominator] = &found.axes;
    if !matches!(frequency.kind, 0 | 1 | 18) {
        let message = format!("the abscissa is of type {}, not frequency (18)", frequency.kind);
        problems.push(at(
            path,
            frequency,
            message,
            "export FRFs over the frequency in Hz",
        ));
    }
    let rises = found.abscissa.windows(2).all(|pair| pair[0] < pair[1]);
    if !rises || found.abscissa.first().is_some_and(|first| *first < 0.0) {
        let message = "the frequencies do not rise from 0 or above".to_owned();
        problems.push(at(
            path,
            frequency,
            message,
            "sort the values by frequency, in Hz",
        ));
    }
    let motion = match numerator.kind {
        8 => Some(Quantity::Displacement),
        11 => Some(Quantity::Velocity),
        12 => Some(Quantity::Acceleration),
        _ => None,
    };
    let label = unit::motion(&numerator.unit);
    let (quantity, length) = match (motion, label) {
        (Some(own), Some((other, factor))) if own == other => (own, factor),
        (Some(own), None) => {
            note(numerator, units.is_some(), notes);
            (own, units.map_or(1.0, |[length, _]| 1.0 / length))
        }
        (None, Some(known)) if matches!(numerator.kind, 0 | 1) => known,
        _ => {
            let message = format!(
                "numerator of type {} with the unit `{}` is no displacement (8), velocity (11) or acceleration (12)",
                numerator.kind, numerator.unit
            );
            problems.push(at(
                path,
                numerator,
                message,
                "units such as m/s^2, mm/s, um or g are known",
            ));
            (Quantity::Displacement, 1.0)
        }
    };
    let label = unit::force(&denominator.unit);
    let force = match (matches!(denominator.kind, 9 | 13), label) {
        (_, Some(factor)) if matches!(denominator.kind, 0 | 1 | 9 | 13) => factor,
        (true, _) => {
            note(denominator, units.is_some(), notes);
            units.map_or(1.0, |[_, force]| 1.0 / force)
        }
        _ => {
            let message = format!(
                "denominator of type {} with the unit `{}` is no force (13)",
                denominator.kind, denominator.unit
            );
            problems.push(at(
                path,
                denominator,
                message,
                "only FRFs of a force are evaluated",
            ));
            1.0
        }
    };
    let mut dof = |[node, direction]: [i64; 2], columns: std::ops::Range<usize>, what: &str| {
        let found_dof = SignedDof::of_direction(node, direction);
        if found_dof.is_none() {
            let message = format!("the direction {direction} of the {what} is no translation");
            let hint = "directions are 1, 2, 3 for +X, +Y, +Z and -1, -2, -3 for the opposite ones";
            problems.push(found.line.problem(path, columns, message, hint));
        }
        found_dof
    };
    let response = dof(found.dofs[0], 51..55, "response");
    let reference = dof(found.dofs[1], 76..80, "reference");
    Problems::from(problems).into_result()?;
    let (Some(response), Some(reference)) = (response, reference) else {
        return Err(Problem::of_file(path, "a direction is not known", "give directions 1 to 3").into());
    };
    Ok(Samples {
        quantity,
        response,
        reference,
        angular_frequencies: found.abscissa.iter().map(|frequency| TAU * frequency).collect(),
        values: found
            .values
            .iter()
            .map(|[re, im]| Complex::new(*re, *im) * (length / force))
            .collect(),
        coherence: None,
    })
}

fn at(path: &str, axis: &Axis, message: String, hint: &str) -> Problem {
    axis.line.problem(path, 0..axis.line.text.len(), message, hint)
}

/// Notes which unit is assumed for an axis whose label has none that is known.
fn note(axis: &Axis, has_units: bool, notes: &mut Vec<String>) {
    let by = if has_units {
        "dataset 164"
    } else {
        "SI, as no dataset 164 gives others"
    };
    let text = match axis.unit.is_empty() {
        true => format!("an axis has no unit: {by}"),
        false => format!("the unit `{}` of an axis is not known: {by}", axis.unit),
    };
    if !notes.contains(&text) {
        notes.push(text);
    }
}
