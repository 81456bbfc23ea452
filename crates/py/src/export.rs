//! A robot as the text of a file for other programs.

use armill_formats::robot::export::{
    CoupledJoints, DhConvention, ExportFormat, ExportOptions, ExportedStiffness, export,
};
use armill_study::exported_robot;
use pyo3::prelude::*;

use crate::errors::{exception, refused};
use crate::robot::Robot;

/// A word of an option.
pub(crate) type Word<'a> = Option<&'a str>;

/// The text of a robot without stiffness; words of coupling and convention.
///
/// # Errors
/// Another word than one of the command; a robot that the format cannot express.
pub(crate) fn rigid(
    robot: &Robot,
    py: Python<'_>,
    format: &str,
    [coupling, convention]: [Word<'_>; 2],
) -> PyResult<String> {
    let word = |message: String| refused(py, message, HINT);
    let options = ExportOptions {
        coupling: coupled(py, coupling)?,
        convention: match convention {
            None => DhConvention::default(),
            Some(name) => name.parse().map_err(word)?,
        },
        ..ExportOptions::default()
    };
    text(robot, py, (format, &options))
}

/// The text of a robot with its stiffness; words of stiffness and coupling, and joint positions (dof,), rad (m).
///
/// # Errors
/// As of [`rigid`]; positions of another shape.
pub(crate) fn elastic(
    robot: &Robot,
    py: Python<'_>,
    format: &str,
    ([stiffness, coupling], joints): &([Word<'_>; 2], Option<&Bound<'_, PyAny>>),
) -> PyResult<String> {
    let options = ExportOptions {
        coupling: coupled(py, *coupling)?,
        stiffness: match stiffness {
            None => ExportedStiffness::None,
            Some("passive") => ExportedStiffness::Passive,
            Some("joints") => ExportedStiffness::Joints,
            Some(other) => {
                let message = format!("stiffness: `{other}` is none of passive, joints");
                return Err(refused(py, message, HINT));
            }
        },
        joints: joints
            .map(|joints| robot.one_a_joint(joints, "joints"))
            .transpose()?,
        ..ExportOptions::default()
    };
    text(robot, py, (format, &options))
}

/// Where the words of options are explained.
const HINT: &str = "the words are those of `armill export`";

fn coupled(py: Python<'_>, word: Word<'_>) -> PyResult<Option<CoupledJoints>> {
    match word {
        None => Ok(None),
        Some("own") => Ok(Some(CoupledJoints::Own)),
        Some("mimic") => Ok(Some(CoupledJoints::Follower)),
        Some(other) => {
            let message = format!("coupling: `{other}` is none of own, mimic");
            Err(refused(py, message, HINT))
        }
    }
}

/// The text of the file; its head names what it does not express.
fn text(robot: &Robot, py: Python<'_>, (format, options): (&str, &ExportOptions)) -> PyResult<String> {
    let format: ExportFormat = format
        .parse()
        .map_err(|message: String| refused(py, message, HINT))?;
    let exported = export(&robot.description, format, options);
    let exported = exported.map_err(|error| exception(py, &exported_robot::refused(error)))?;
    Ok(exported.text)
}
