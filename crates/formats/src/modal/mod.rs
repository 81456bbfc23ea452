//! File of modal data, format 1: TOML, modes of vibration at the tip of a cutter, from an impact test or a calculation.
//!
//! | in the file | here |
//! |---|---|
//! | `frequency_hz`, `damping_percent` or `damping_ratio` | undamped angular frequency (rad/s), damping ratio |
//! | `direction` | direction in which the tip moves; feed frame: along the feed, to its left, from part to spindle |
//! | `modal_mass_kg` or `stiffness_n_per_um` | modal mass or stiffness in this direction; the shape is `direction/sqrt(mass)` |
//! | `frequency_u_hz`, `damping_u_percent`, `stiffness_u_percent` | standard uncertainties, relative |
//!
//! `file` has the tables as written; here they are checked and converted to SI; `written` writes a file. All keys: `docs/guide/stability.md`.

mod file;
mod written;

use std::f64::consts::TAU;

use armill_core::dynamics::Mode;
use armill_core::nalgebra::{Vector3, Vector6};
use armill_core::stability::{ModeUncertainty, NamedMode};
use armill_core::units::from_um;

use self::file::{ModalFile, ModeTable};
pub use self::written::{WrittenMode, WrittenModes, write};
use crate::document::{Document, Problem, Problems};

/// Modes of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalData {
    /// For people.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// The modes, in the feed frame, in the order of the file.
    pub modes: Vec<NamedMode>,
}

/// The modal data of this file; `path` is what errors show.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(path: &str, text: &str) -> Result<ModalData, Problems> {
    let document = Document::parse(path, text)?;
    let file: ModalFile = document.read()?;
    let mut problems = Vec::new();
    let modes: Vec<Option<NamedMode>> = file
        .mode
        .iter()
        .enumerate()
        .map(|(index, table)| mode(&document, index, table, &mut problems))
        .collect();
    Problems::from(problems).into_result()?;
    Ok(ModalData {
        name: file.name,
        source: file.source,
        note: file.note,
        modes: modes.into_iter().flatten().collect(),
    })
}

/// A mode in SI; `None` if it has a problem.
fn mode(
    document: &Document,
    index: usize,
    table: &ModeTable,
    problems: &mut Vec<Problem>,
) -> Option<NamedMode> {
    let mut problem = |key: &str, message: String, hint: &str| {
        let path = format!("mode[{index}]{key}");
        problems.push(document.problem(&path, message, Some(hint)));
    };
    let damping = match (table.damping_percent, table.damping_ratio) {
        (Some(percent), None) => Some(percent / 100.0),
        (None, Some(ratio)) => Some(ratio),
        (None, None) => {
            let message = "the mode has no damping".to_owned();
            problem("", message, "give `damping_percent`, or `damping_ratio`");
            None
        }
        (Some(_), Some(_)) => {
            let message = "`damping_percent` and `damping_ratio` are both given".to_owned();
            problem(".damping_ratio", message, "remove one of them");
            None
        }
    };
    let omega = TAU * table.frequency_hz;
    let mass = match (table.modal_mass_kg, table.stiffness_n_per_um) {
        (Some(mass), None) => Some(mass),
        // N/um is N per 1e-6 m.
        (None, Some(stiffness)) => Some(stiffness / from_um(1.0) / (omega * omega)),
        (None, None) => {
            let message = "the mode has neither modal mass nor stiffness".to_owned();
            problem(
                "",
                message,
                "give `modal_mass_kg` or `stiffness_n_per_um`, in `direction`",
            );
            None
        }
        (Some(_), Some(_)) => {
            let message = "`modal_mass_kg` and `stiffness_n_per_um` are both given".to_owned();
            let hint = "remove one of them: with the frequency either gives the other";
            problem(".stiffness_n_per_um", message, hint);
            None
        }
    };
    let direction = Vector3::from(table.direction).try_normalize(f64::MIN_POSITIVE);
    if direction.is_none() {
        let message = "`direction` is zero".to_owned();
        problem(
            ".direction",
            message,
            "along the feed, to its left, from part to spindle: [1, 0, 0]",
        );
    }
    let (damping, mass, direction) = (damping?, mass?, direction?);
    let shape = direction / mass.sqrt();
    Some(NamedMode {
        name: table.name.clone().unwrap_or_else(|| (index + 1).to_string()),
        mode: Mode {
            angular_frequency: omega,
            damping_ratio: damping,
            shape: Vector6::new(shape.x, shape.y, shape.z, 0.0, 0.0, 0.0),
        },
        uncertainty: ModeUncertainty {
            frequency: table.frequency_u_hz.unwrap_or(0.0) / table.frequency_hz,
            damping: table.damping_u_percent.unwrap_or(0.0) / 100.0 / damping,
            stiffness: table.stiffness_u_percent.unwrap_or(0.0) / 100.0,
        },
    })
}

#[cfg(test)]
mod tests;
