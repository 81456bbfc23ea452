//! Tables and pictures of a record.
//!
//! ```text
//! forces.csv        time_s, fx_n, fy_n, fz_n, fx_before_n, fy_before_n, fz_before_n
//! revolutions.csv   start_s, fx_mean_n, ... fz_mean_n, then least, most, strongest; if revolutions were averaged
//! forces.svg        each component and the size over time, before and after; forces.png is the same
//! ```

use std::path::PathBuf;

use armill_core::load::record::revolutions::Revolution;
use armill_core::nalgebra::Vector3;
use armill_core::units::to_mm;
use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, Table, csv};
use armill_study::StudyError;
use armill_study::measured::force_picture::plot;
use armill_study::measured::treatment::ProcessedRecord;
use armill_study::output::{Picture, column, picture_files, write_pictures};

use super::ForcesAnswer;

/// Decimals of forces that mean something: a millionth of a newton.
const FORCE_DECIMALS: u8 = 6;
/// Decimals of times: nanoseconds.
const TIME_DECIMALS: u8 = 9;

/// Writes tables and pictures into the folder `out` and returns their paths.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write(
    answer: &ForcesAnswer,
    treated: &ProcessedRecord,
    out: &ResultFolder,
) -> Result<Vec<PathBuf>, StudyError> {
    let svg = plot("measured force".to_owned(), subtitle(answer), treated).to_svg();
    let mut files = vec![("forces.csv", csv::write(&forces(treated)?))];
    if let Some(turns) = &treated.turns {
        files.push(("revolutions.csv", csv::write(&turns_table(turns)?)));
    }
    let pictures = [Picture {
        name: "forces".to_owned(),
        caption: String::new(),
        svg,
    }];
    let drawn: Vec<String> = pictures.iter().flat_map(picture_files).collect();
    out.allow(
        files
            .iter()
            .map(|(name, _)| *name)
            .chain(drawn.iter().map(String::as_str)),
    )?;
    let mut written = Vec::new();
    for (name, bytes) in files {
        out.write(name, &bytes)?;
        written.push(out.path().join(name));
    }
    write_pictures(&pictures, out)?;
    written.extend(drawn.iter().map(|name| out.path().join(name)));
    out.finish()?;
    Ok(written)
}

/// What was done, for the second line of a picture.
fn subtitle(answer: &ForcesAnswer) -> String {
    let mut parts = vec![format!("{}, {} Hz", answer.file, Short(answer.rate_hz))];
    parts.push(
        if answer.drift.is_some() {
            "drift removed"
        } else {
            "drift left in"
        }
        .to_owned(),
    );
    parts.extend(answer.low_pass_hz.map(|hz| format!("low-pass {hz} Hz")));
    parts.extend(
        answer
            .spindle_rpm
            .map(|rpm| format!("means of turns at {rpm} rpm")),
    );
    parts.join("; ")
}

/// A number without superfluous decimals.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", to_mm(self.0).round() / 1e3)
    }
}

/// One row per sample: the processed and the measured force.
fn forces(treated: &ProcessedRecord) -> Result<Table, StudyError> {
    let mut columns = vec![time("time_s", "instant", treated.before.time().to_vec())];
    for (suffix, what, record) in [
        ("n", "as it was treated", &treated.after),
        ("before_n", "as it was measured", &treated.before),
    ] {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            columns.push(force(
                &format!("f{letter}_{suffix}"),
                &format!("force along {letter} of the sensor, {what}"),
                record.force().iter().map(|force| force[axis]).collect(),
            ));
        }
    }
    Ok(Table::new("forces", columns)?)
}

/// A force of a revolution.
type OfTurn = fn(&Revolution) -> Vector3<f64>;

/// One row per revolution of the spindle.
fn turns_table(turns: &[Revolution]) -> Result<Table, StudyError> {
    let starts = turns.iter().map(|turn| turn.start).collect();
    let mut columns = vec![time("start_s", "start of the revolution", starts)];
    let groups: [(&str, &str, OfTurn); 4] = [
        ("mean", "mean over the turn", |turn| turn.mean),
        ("least", "least in the turn", |turn| turn.least),
        ("most", "most in the turn", |turn| turn.most),
        ("strongest", "where the size is largest in the turn", |turn| {
            turn.strongest
        }),
    ];
    for (suffix, what, of) in groups {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            columns.push(force(
                &format!("f{letter}_{suffix}_n"),
                &format!("force along {letter} of the sensor, {what}"),
                turns.iter().map(|turn| of(turn)[axis]).collect(),
            ));
        }
    }
    Ok(Table::new("revolutions", columns)?)
}

/// A column of instants, s.
fn time(name: &str, description: &str, values: Vec<f64>) -> Column {
    column(name, "s", description, TIME_DECIMALS, values)
}

/// A column of forces, N.
fn force(name: &str, description: &str, values: Vec<f64>) -> Column {
    column(name, "N", description, FORCE_DECIMALS, values)
}
