//! `armill frf`: modes from measured frequency response functions.
//!
//! ```text
//! FRF          band, part that is described
//! mode         frequency, damping, modal mass, stiffness, direction, with standard uncertainties
//! ```

use std::f64::consts::TAU;
use std::path::PathBuf;

use armill_measure::frf::answer::{FrfAnswer, FrfModeAnswer};
use armill_measure::frf::{Axes, FrfModesAnswer, FrfQuestion, answer, fit_all, modal_file, picture, read};
use armill_study::StudyError;

use super::drawing;
use crate::arguments::FrfArguments;
use crate::arguments::numbers::{above_zero, within};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Highest frequency, Hz, and largest number of modes.
const HIGHEST_HZ: f64 = 1e6;
const MOST_MODES: usize = 25;

/// Reads, fits, writes the requested files and prints the result.
///
/// # Errors
/// Invalid options; the problems of a file; no drive point; no mode; a file that cannot be written.
pub(crate) fn run(arguments: &FrfArguments) -> Result<Outcome, StudyError> {
    let question = question(arguments)?;
    let read = read(&arguments.files)?;
    let fitted = fit_all(&read, &question)?;
    let answer = answer(&read, &fitted);
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    if let Some(file) = &arguments.out {
        let text = modal_file(&file.display().to_string(), &answer)?;
        files.push((file.clone(), text.into_bytes()));
    }
    if let Some(file) = &arguments.drawing {
        files.push((
            file.clone(),
            drawing::bytes(file, &picture(&read, &fitted).to_svg())?,
        ));
    }
    let bytes: Vec<(PathBuf, &[u8])> = files
        .iter()
        .map(|(file, bytes)| (file.clone(), &bytes[..]))
        .collect();
    let writer = arguments.writing.writer("frf").for_new_files();
    writer.write_all(&bytes)?;
    if let Some(file) = &arguments.out {
        say(&format!("modes in {}", file.display()));
    }
    if let Some(file) = &arguments.drawing {
        say(&format!("drawing in {}", file.display()));
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn question(arguments: &FrfArguments) -> Result<FrfQuestion, StudyError> {
    let band = match arguments.band_hz.as_deref() {
        None => None,
        Some(&[low, high]) => {
            above_zero("--band-hz", low)?;
            above_zero("--band-hz", high)?;
            within("--band-hz", high, [low, HIGHEST_HZ])?;
            Some([low, high].map(|hz| hz * TAU))
        }
        Some(values) => {
            return Err(StudyError::value(
                format!("--band-hz: {} numbers", values.len()),
                "the lowest and the highest frequency: 300,4000",
            ));
        }
    };
    Ok(FrfQuestion {
        band,
        modes: match arguments.modes {
            Some(modes) => Some(within("--modes", modes, [1, MOST_MODES])?),
            None => None,
        },
        point: arguments.point,
        axes: arguments.axes.as_deref().map(Axes::parse).transpose()?,
    })
}

fn as_text(answer: &FrfModesAnswer) -> String {
    let mut lines = vec![format!(
        "{:<16} {:>22} {:>12} {:>20}",
        "FRF", "band", "described", "residual, rms"
    )];
    lines.extend(answer.frfs.iter().map(frf_text));
    lines.push(String::new());
    lines.push(format!(
        "{:>22} {:>20} {:>12} {:>22}  direction at point {}",
        "frequency", "damping", "modal mass", "stiffness", answer.tip_point
    ));
    lines.extend(answer.modes.iter().map(mode_text));
    lines.push(String::new());
    lines.extend(answer.unused.iter().map(|name| format!("ignored: {name}")));
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn frf_text(frf: &FrfAnswer) -> String {
    let [low, high] = frf.band_hz;
    format!(
        "{:<16} {:>22} {:>10.2} % {:>14.3e} um/N",
        format!("{}/{}", frf.response, frf.reference),
        format!("{low:.1} to {high:.1} Hz"),
        frf.explained_percent,
        frf.residual_um_per_n
    )
}

fn mode_text(mode: &FrfModeAnswer) -> String {
    let modal = mode
        .direction
        .zip(mode.modal_mass_kg)
        .zip(mode.stiffness_n_per_um.zip(mode.stiffness_u_percent));
    let modal = match modal {
        Some((([x, y, z], mass), (stiffness, u))) => format!(
            "{mass:>9.4} kg {:>22}  ({x:.3}, {y:.3}, {z:.3})",
            format!("{stiffness:.3} N/um +- {u:.1} %")
        ),
        None => format!("{:>12} {:>22}", "-", "-"),
    };
    format!(
        "{:>22} {:>20} {modal}",
        format!("{:.2} +- {:.2} Hz", mode.frequency_hz, mode.frequency_u_hz),
        format!("{:.3} +- {:.3} %", mode.damping_percent, mode.damping_u_percent)
    )
}
