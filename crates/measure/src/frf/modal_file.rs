//! The modes as a file of modal data, which `armill stability --modes` reads.

use std::fmt::Write;

use armill_formats::modal;
use armill_study::StudyError;

use super::answer::FrfModesAnswer;

/// The file with all modes that have a modal mass.
///
/// # Errors
/// No such mode; a mode outside the range of the format.
pub fn modal_file(path: &str, answer: &FrfModesAnswer) -> Result<String, StudyError> {
    // A string of JSON is one of TOML.
    let quoted = |text: &str| serde_json::to_string(text);
    let mut text = format!(
        "format = 1\nname = {}\nsource = {}\nnote = {}\n",
        quoted(&format!("modes at point {}", answer.tip_point))?,
        quoted(&format!("armill frf, from {}", answer.files.join(", ")))?,
        quoted(&answer.notes.join("; "))?,
    );
    let mut count = 0;
    for mode in &answer.modes {
        let (Some([x, y, z]), Some(stiffness), Some(u)) =
            (mode.direction, mode.stiffness_n_per_um, mode.stiffness_u_percent)
        else {
            continue;
        };
        count += 1;
        let _ = write!(
            text,
            "\n[[mode]]\nname = \"{:.1} Hz\"\nfrequency_hz = {}\nfrequency_u_hz = {}\ndamping_percent = {}\ndamping_u_percent = {}\ndirection = [{x}, {y}, {z}]\n\
             stiffness_n_per_um = {stiffness}\nstiffness_u_percent = {}\n",
            mode.frequency_hz,
            mode.frequency_hz,
            mode.frequency_u_hz,
            mode.damping_percent,
            mode.damping_u_percent,
            u.min(100.0)
        );
    }
    if count == 0 {
        return Err(StudyError::value(
            "no mode has a modal mass: there is nothing to write",
            answer.notes.last().cloned().unwrap_or_default(),
        ));
    }
    modal::read(path, &text)?;
    Ok(text)
}
