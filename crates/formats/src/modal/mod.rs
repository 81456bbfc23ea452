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
    let found = document.read::<ModalFile>();
    let mut problems = contradictions(&document);
    let file = match found {
        Ok(file) => file,
        Err(others) => {
            problems.extend(others.as_slice().iter().cloned());
            return Err(Problems::from(problems));
        }
    };
    Problems::from(problems).into_result()?;
    Ok(ModalData {
        name: file.name,
        source: file.source,
        note: file.note,
        modes: file.mode.iter().enumerate().filter_map(mode).collect(),
    })
}

/// What no schema can say: values that exclude each other, and values of which one is needed. Values of a wrong type are not
/// considered.
fn contradictions(document: &Document) -> Vec<Problem> {
    let tree = document.to_json();
    let modes = tree["mode"].as_array().map_or(&[][..], Vec::as_slice);
    let mut problems = Vec::new();
    for (index, table) in modes.iter().enumerate() {
        let mut problem = |key: &str, message: &str, hint: &str| {
            let path = format!("mode[{index}]{key}");
            problems.push(document.problem(&path, message, Some(hint)));
        };
        let given = |key: &str| table.get(key).is_some();
        match [given("damping_percent"), given("damping_ratio")] {
            [false, false] => problem(
                "",
                "the mode has no damping",
                "give `damping_percent`, or `damping_ratio`",
            ),
            [true, true] => problem(
                ".damping_ratio",
                "`damping_percent` and `damping_ratio` are both given",
                "remove one of them",
            ),
            _ => {}
        }
        match [given("modal_mass_kg"), given("stiffness_n_per_um")] {
            [false, false] => problem(
                "",
                "the mode has neither modal mass nor stiffness",
                "give `modal_mass_kg` or `stiffness_n_per_um`, in `direction`",
            ),
            [true, true] => problem(
                ".stiffness_n_per_um",
                "`modal_mass_kg` and `stiffness_n_per_um` are both given",
                "remove one of them: with the frequency either gives the other",
            ),
            _ => {}
        }
        let parts = table["direction"].as_array();
        if parts.is_some_and(|parts| parts.iter().all(|part| part.as_f64() == Some(0.0))) {
            problem(
                ".direction",
                "`direction` is zero",
                "along the feed, to its left, from part to spindle: [1, 0, 0]",
            );
        }
    }
    problems
}

/// A mode in SI, of a table without contradictions.
fn mode(numbered: (usize, &ModeTable)) -> Option<NamedMode> {
    let (index, table) = numbered;
    let of_percent = table.damping_percent.map(|percent| percent / 100.0);
    let damping = of_percent.or(table.damping_ratio)?;
    let omega = TAU * table.frequency_hz;
    // N/um is N per 1e-6 m.
    let of_stiffness = table
        .stiffness_n_per_um
        .map(|stiffness| stiffness / from_um(1.0) / (omega * omega));
    let mass = table.modal_mass_kg.or(of_stiffness)?;
    let direction = Vector3::from(table.direction).try_normalize(f64::MIN_POSITIVE)?;
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
