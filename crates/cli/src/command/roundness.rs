//! `armill roundness`: roundness of a measured profile, by the four circles of ISO 12181.
//!
//! `--unit` and `--radius-mm` control how a file is read, `--upr` and `--harmonics` the evaluation. Stdout has a
//! [`RoundnessAnswer`], as text or JSON: one for a file, a list of them for several. `--out` receives tables and
//! pictures, with one folder per file if there are several.
//!
//! ```text
//! bore.csv: table, 3600 points, largest gap 0.10 deg                 file, format
//! plane  normal (0, 0, 1), flatness 1.20 um                          of points in space
//! circle   RONt um   radius mm   centre mm                           LSCI, MZCI, MCCI, MICI, or why there is none
//! RONp, RONv, RONq                                                   about LSCI
//! waves   amplitude um   phase deg                                   harmonics
//! ```
//!
//! Roundness is reported to a nanometre, positions to a ten thousandth of a millimetre.

use armill_core::units::um_from_mm;
use std::path::Path;

use armill_formats::measurement::profile::ProfileReadOptions;
use armill_measure::roundness::{Question, RoundnessAnswer, answer, evaluate, output};
use armill_study::StudyError;
use armill_study::measured::profile::read;
use armill_study::number::decimals;

use crate::arguments::RoundnessArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Harmonics above this are noise, and their sums take long.
const MOST_HARMONICS: usize = 500;
/// A filter with a higher cut-off passes what no instrument measures.
const MOST_UPR: u32 = 15_000;
/// Number of outliers listed.
const MOST_NAMED: usize = 5;

/// Reads, evaluates, writes the requested files and prints the result.
///
/// # Errors
/// A file that cannot be read, or its problems; points without a circle; invalid options; a folder or stdout that
/// cannot be written.
pub(crate) fn run(arguments: &RoundnessArguments) -> Result<Outcome, StudyError> {
    let question = question(arguments)?;
    let requested = ProfileReadOptions {
        radius_mm: arguments.radius_mm,
        else_radius_mm: None,
        unit: arguments.unit,
    };
    let mut answers = Vec::new();
    let mut evaluations = Vec::new();
    for file in &arguments.files {
        let shown = file.display().to_string();
        let measured = read(&shown, file, &requested)?;
        let found = evaluate(&shown, &measured, &question)?;
        answers.push(answer(&shown, &measured, &question, &found));
        evaluations.push(found);
    }
    if let Some(out) = &arguments.out {
        for (index, (answer, evaluation)) in answers.iter().zip(&evaluations).enumerate() {
            let folder = folder(out, arguments, index);
            output::write(
                answer,
                evaluation,
                &arguments.writing.writer("roundness").folder(&folder)?,
            )?;
        }
        say(&format!("tables and pictures in {}", out.display()));
    }
    let text = match (arguments.json, &answers[..]) {
        (true, [one]) => serde_json::to_string_pretty(one)?,
        (true, all) => serde_json::to_string_pretty(all)?,
        (false, all) => all.iter().map(as_text).collect::<Vec<_>>().join("\n\n"),
    };
    print(&text)?;
    Ok(Outcome::Fine)
}

/// Settings of the evaluation.
fn question(arguments: &RoundnessArguments) -> Result<Question, StudyError> {
    if let Some(upr) = arguments.upr.filter(|upr| !(1..=MOST_UPR).contains(upr)) {
        return Err(StudyError::value(
            format!("--upr: {upr} is not from 1 to {MOST_UPR}"),
            "usual cut-offs are 15, 50, 150, 500 and 1500 undulations per revolution",
        ));
    }
    if arguments.harmonics > MOST_HARMONICS {
        return Err(StudyError::value(
            format!("--harmonics: {} is above {MOST_HARMONICS}", arguments.harmonics),
            "high harmonics are mostly noise",
        ));
    }
    Ok(Question {
        upr: arguments.upr,
        harmonics: arguments.harmonics,
    })
}

/// Folder of the table and pictures of a file: if there are several files, named after the file and its number.
fn folder(out: &Path, arguments: &RoundnessArguments, index: usize) -> std::path::PathBuf {
    if arguments.files.len() == 1 {
        return out.to_owned();
    }
    let stem = arguments.files[index].file_stem().unwrap_or_default();
    out.join(format!("{}-{}", index + 1, stem.to_string_lossy()))
}

/// The result as text, see the documentation of this module.
fn as_text(answer: &RoundnessAnswer) -> String {
    let filter = match answer.filter_upr {
        Some(upr) => format!("Gaussian filter {upr} UPR"),
        None => "not filtered".to_owned(),
    };
    let mut lines = vec![format!(
        "{}: {}, {} points, largest gap {} deg, {filter}",
        answer.file,
        answer.format,
        answer.points,
        decimals(answer.largest_gap_deg, 4)
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    if let Some(plane) = &answer.plane {
        lines.push(format!(
            "plane        normal {}, x along {}, flatness {:.3} um",
            direction(plane.normal),
            direction(plane.x_axis),
            um_from_mm(plane.flatness_mm)
        ));
    }
    lines.push(String::new());
    lines.push(format!(
        "{:<8} {:>12} {:>14}   centre mm",
        "circle", "RONt um", "radius mm"
    ));
    let lsci = &answer.lsci;
    lines.push(circle(
        "LSCI",
        lsci.ront_mm,
        &reported(lsci.radius_mm),
        &lsci.centre_mm,
    ));
    lines.push(match &answer.mzci {
        Some(zone) => {
            let [inner, outer] = zone.radii_mm;
            let mean = reported((inner + outer) / 2.0);
            circle("MZCI", zone.ront_mm, &mean, &zone.centre_mm)
        }
        None => format!(
            "MZCI     none: {}",
            answer.mzci_refused.as_deref().unwrap_or_default()
        ),
    });
    let mcci = &answer.mcci;
    lines.push(circle(
        "MCCI",
        mcci.ront_mm,
        &reported(mcci.radius_mm),
        &mcci.centre_mm,
    ));
    lines.push(match &answer.mici {
        Some(mici) => circle("MICI", mici.ront_mm, &reported(mici.radius_mm), &mici.centre_mm),
        None => format!(
            "MICI     none: {}",
            answer.mici_refused.as_deref().unwrap_or_default()
        ),
    });
    lines.push(String::new());
    lines.push(format!(
        "about LSCI   RONp {:.3} um, RONv {:.3} um, RONq {:.3} um",
        um_from_mm(lsci.ronp_mm),
        um_from_mm(lsci.ronv_mm),
        um_from_mm(lsci.ronq_mm)
    ));
    if !answer.harmonics.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:>5} {:>14} {:>10}",
            "waves", "amplitude um", "phase deg"
        ));
        lines.extend(answer.harmonics.iter().map(|wave| {
            format!(
                "{:>5} {:>14.3} {:>10.1}",
                wave.waves, wave.amplitude_um, wave.phase_deg
            )
        }));
    }
    if !answer.outliers.is_empty() {
        lines.push(String::new());
    }
    lines.extend(answer.outliers.iter().take(MOST_NAMED).map(|point| {
        format!(
            "outlier      line {}, at {:.2} deg: {:+.2} um from its neighbours",
            point.line, point.angle_deg, point.off_um
        )
    }));
    if answer.outliers.len() > MOST_NAMED {
        lines.push(format!(
            "             and {} more",
            answer.outliers.len() - MOST_NAMED
        ));
    }
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

/// A row of the table of circles.
fn circle(name: &str, ront_mm: f64, radius: &str, centre_mm: &[f64]) -> String {
    let centre: Vec<String> = centre_mm
        .iter()
        .map(|x| format!("{:.4}", decimals(*x, 4)))
        .collect();
    format!(
        "{name:<8} {:>12.3} {radius:>14}   ({})",
        um_from_mm(ront_mm),
        centre.join(", ")
    )
}

/// A radius, to a ten thousandth of a millimetre.
fn reported(radius_mm: f64) -> String {
    format!("{radius_mm:.4}")
}

/// A unit vector, without rounding noise.
fn direction(direction: [f64; 3]) -> String {
    let [x, y, z] = direction.map(|part| decimals(part, 4));
    format!("({x}, {y}, {z})")
}
