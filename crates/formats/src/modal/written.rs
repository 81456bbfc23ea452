//! A new file of modal data.

use std::fmt::Write;

use toml_edit::Value;

use super::read;
use crate::document::Problems;

/// The content of a file, in its units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenModes {
    /// For people.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// What a user should know before trusting the numbers.
    pub note: String,
    /// The modes.
    pub modes: Vec<WrittenMode>,
}

/// A mode of a file, in its units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenMode {
    /// Name in results.
    pub name: String,
    /// Undamped natural frequency.
    pub frequency_hz: f64,
    /// Its standard uncertainty.
    pub frequency_u_hz: f64,
    /// Damping ratio.
    pub damping_percent: f64,
    /// Its standard uncertainty, in the same unit.
    pub damping_u_percent: f64,
    /// Direction in which the tip moves; feed frame.
    pub direction: [f64; 3],
    /// Modal stiffness in this direction.
    pub stiffness_n_per_um: f64,
    /// Its standard uncertainty; values above 100 are written as 100.
    pub stiffness_u_percent: f64,
}

/// The text of a file; `path` is what errors show.
///
/// # Errors
/// Modes that the format does not permit: no mode, a value out of range.
pub fn write(path: &str, content: &WrittenModes) -> Result<String, Problems> {
    let quoted = |text: &str| Value::from(text).to_string();
    let mut text = format!(
        "format = 1\nname = {}\nsource = {}\nnote = {}\n",
        quoted(&content.name),
        quoted(&content.source),
        quoted(&content.note)
    );
    for mode in &content.modes {
        let [x, y, z] = mode.direction;
        let _ = write!(
            text,
            "\n[[mode]]\nname = {}\nfrequency_hz = {}\nfrequency_u_hz = {}\ndamping_percent = {}\ndamping_u_percent = {}\n\
             direction = [{x}, {y}, {z}]\nstiffness_n_per_um = {}\nstiffness_u_percent = {}\n",
            quoted(&mode.name),
            mode.frequency_hz,
            mode.frequency_u_hz,
            mode.damping_percent,
            mode.damping_u_percent,
            mode.stiffness_n_per_um,
            mode.stiffness_u_percent.min(100.0)
        );
    }
    read(path, &text)?;
    Ok(text)
}
