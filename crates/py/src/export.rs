//! A robot as the text of a file for other programs.

use armill_formats::robot::export::{CoupledJoints, ExportFormat, ExportOptions, ExportedStiffness, export};
use armill_study::exported_robot;
use pyo3::prelude::*;

use crate::errors::{exception, refused};
use crate::robot::Robot;

/// What a caller may decide, in the words of the command.
#[derive(Default)]
pub(crate) struct Wishes<'a, 'py> {
    pub stiffness: Option<&'a str>,
    /// (dof,), rad (m).
    pub joints: Option<&'a Bound<'py, PyAny>>,
    pub coupling: Option<&'a str>,
    pub convention: Option<&'a str>,
}

/// The text of the file. A warning of Python for each thing that the format does not express is not given: the head of the file names them.
///
/// # Errors
/// Another word than one of the command; a robot that the format cannot express.
pub(crate) fn text(robot: &Robot, py: Python<'_>, format: &str, wishes: &Wishes<'_, '_>) -> PyResult<String> {
    let word = |message: String| refused(py, message, "the words are those of `armill export`");
    let format: ExportFormat = format.parse().map_err(word)?;
    let options = ExportOptions {
        coupling: match wishes.coupling {
            None => None,
            Some("own") => Some(CoupledJoints::Own),
            Some("mimic") => Some(CoupledJoints::Follower),
            Some(other) => return Err(word(format!("coupling: `{other}` is none of own, mimic"))),
        },
        stiffness: match wishes.stiffness {
            None => ExportedStiffness::None,
            Some("passive") => ExportedStiffness::Passive,
            Some("joints") => ExportedStiffness::Joints,
            Some(other) => return Err(word(format!("stiffness: `{other}` is none of passive, joints"))),
        },
        joints: wishes
            .joints
            .map(|joints| robot.one_a_joint(joints, "joints"))
            .transpose()?,
        convention: match wishes.convention {
            None => Default::default(),
            Some(name) => name.parse().map_err(word)?,
        },
        ..ExportOptions::default()
    };
    let exported = export(&robot.description, format, &options);
    let exported = exported.map_err(|error| exception(py, &exported_robot::refused(error)))?;
    Ok(exported.text)
}
