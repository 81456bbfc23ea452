//! The modes as a file of modal data, which `armill stability --modes` reads.

use armill_formats::modal::{self, WrittenMode, WrittenModes};
use armill_study::StudyError;

use super::answer::{FrfModeAnswer, FrfModesAnswer};

/// The file with all modes that have a modal mass.
///
/// # Errors
/// No such mode; a mode outside the range of the format.
pub fn modal_file(path: &str, answer: &FrfModesAnswer) -> Result<String, StudyError> {
    let modes: Vec<WrittenMode> = answer.modes.iter().filter_map(written).collect();
    if modes.is_empty() {
        return Err(StudyError::value(
            "no mode has a modal mass: there is nothing to write",
            answer.notes.last().cloned().unwrap_or_default(),
        ));
    }
    let content = WrittenModes {
        name: format!("modes at point {}", answer.tip_point),
        source: format!("armill frf, from {}", answer.files.join(", ")),
        note: answer.notes.join("; "),
        modes,
    };
    Ok(modal::write(path, &content)?)
}

fn written(mode: &FrfModeAnswer) -> Option<WrittenMode> {
    Some(WrittenMode {
        name: format!("{:.1} Hz", mode.frequency_hz),
        frequency_hz: mode.frequency_hz,
        frequency_u_hz: mode.frequency_u_hz,
        damping_percent: mode.damping_percent,
        damping_u_percent: mode.damping_u_percent,
        direction: mode.direction?,
        stiffness_n_per_um: mode.stiffness_n_per_um?,
        stiffness_u_percent: mode.stiffness_u_percent?,
    })
}
