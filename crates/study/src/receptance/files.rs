//! Files of a receptance: table of FRFs, picture, modal data.

use std::fmt::Write;

use armill_core::units::to_deg;
use armill_formats::modal::{self, WrittenMode, WrittenModes};
use armill_report::{FrfCurve, FrfPlot};

use super::answer::{ReceptanceAnswer, TipModeAnswer};
use crate::StudyError;

/// Axes of the tip.
const AXES: [&str; 3] = ["X", "Y", "Z"];
/// A direction with less than this part of the largest receptance of all is not drawn.
const FLAT: f64 = 1e-3;

/// The translations by forces as a table of FRFs, which `armill frf` reads: response and reference at point 1.
pub fn table(answer: &ReceptanceAnswer) -> String {
    let mut text =
        "frequency_hz,receptance_real_um_per_n,receptance_imag_um_per_n,response,reference\n".to_owned();
    for (i, response) in AXES.iter().enumerate() {
        for (j, reference) in AXES.iter().enumerate().take(i + 1) {
            let rows = answer.receptance.iter().map(|own| {
                let (re, im) = (
                    own.translation_by_force_real_um_per_n,
                    own.translation_by_force_imag_um_per_n,
                );
                (own.frequency_hz, re[i][j], im[i][j])
            });
            let rows: Vec<(f64, f64, f64)> = rows.collect();
            if rows.iter().all(|(_, re, im)| *re == 0.0 && *im == 0.0) {
                continue;
            }
            for (hz, re, im) in rows {
                let _ = writeln!(text, "{hz},{re:e},{im:e},1{response},1{reference}");
            }
        }
    }
    text
}

/// Magnitude and phase in x, y and z.
pub fn picture(answer: &ReceptanceAnswer) -> FrfPlot {
    let curves: Vec<FrfCurve> = (0..3).map(|k| curve(answer, k)).collect();
    let most = |curve: &FrfCurve| curve.magnitudes_um_per_n.iter().copied().fold(0.0, f64::max);
    let largest = curves.iter().map(most).fold(0.0, f64::max);
    FrfPlot {
        title: "Receptance at the tip".to_owned(),
        subtitle: format!("{} on {}", answer.assembly, answer.machine),
        modes_hz: answer.modes.iter().map(|mode| mode.frequency_hz).collect(),
        curves: curves
            .into_iter()
            .filter(|curve| most(curve) >= FLAT * largest)
            .collect(),
    }
}

fn curve(answer: &ReceptanceAnswer, k: usize) -> FrfCurve {
    let parts: Vec<[f64; 2]> = (answer.receptance.iter())
        .map(|own| {
            [
                own.translation_by_force_real_um_per_n[k][k],
                own.translation_by_force_imag_um_per_n[k][k],
            ]
        })
        .collect();
    let name = ["x, along the feed", "y, to its left", "z, along the axis"][k];
    FrfCurve {
        name: name.to_owned(),
        colour: k,
        frequencies_hz: answer.receptance.iter().map(|own| own.frequency_hz).collect(),
        magnitudes_um_per_n: parts.iter().map(|[re, im]| re.hypot(*im)).collect(),
        phases_deg: parts.iter().map(|[re, im]| to_deg(im.atan2(*re))).collect(),
        ..FrfCurve::default()
    }
}

/// The modes of the tip as a file of modal data, which `armill stability --modes` reads.
///
/// # Errors
/// No mode; a mode outside the range of the format.
pub fn modal_file(path: &str, answer: &ReceptanceAnswer) -> Result<String, StudyError> {
    if answer.modes.is_empty() {
        return Err(StudyError::value(
            "the receptance has no modes: there is nothing to write",
            "widen --frequencies-hz",
        ));
    }
    let content = WrittenModes {
        name: format!("{} on {}", answer.assembly, answer.machine),
        source: format!(
            "armill receptance, from {} ({})",
            answer.assembly, answer.assembly_source
        ),
        note: format!(
            "predicted by receptance coupling; without uncertainties; {}",
            answer.notes.join("; ")
        ),
        modes: answer.modes.iter().map(written).collect(),
    };
    Ok(modal::write(path, &content)?)
}

fn written(mode: &TipModeAnswer) -> WrittenMode {
    WrittenMode {
        name: format!("{:.1} Hz", mode.frequency_hz),
        frequency_hz: mode.frequency_hz,
        damping_percent: mode.damping_percent,
        direction: mode.direction,
        stiffness_n_per_um: mode.stiffness_n_per_um,
        ..WrittenMode::default()
    }
}
