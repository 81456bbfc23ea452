//! Objects in place of files: robots and studies become the files that commands read.
//!
//! A robot of the library stands for its name, and a study that is on disk as it was read for its path. All else is
//! written to a temporary file, which is removed with the value that keeps it.

use std::io::Write;
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyString;
use tempfile::NamedTempFile;

use crate::errors::{refused, wrong_type};
use crate::robot::Robot;
use crate::robot_file::RobotFile;
use crate::study::Study;

/// A temporary file with this text in the folder of a study, which the paths in it are relative to.
///
/// # Errors
/// A folder that cannot be written.
fn study_file(py: Python<'_>, folder: &Path, text: &[u8]) -> PyResult<NamedTempFile> {
    let made = tempfile::Builder::new()
        .prefix(".armill-")
        .suffix(".toml")
        .tempfile_in(if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        });
    let written = made.and_then(|mut file| file.write_all(text).map(|()| file));
    written.map_err(|error| {
        let message = format!(
            "the study cannot be written to its folder {}: {error}",
            folder.display()
        );
        refused(py, message, "save the study and give its path")
    })
}

/// Temporary files of the operands of a command.
#[derive(Default)]
pub(crate) struct OperandFiles {
    robots: Vec<RobotFile>,
    studies: Vec<NamedTempFile>,
}

impl OperandFiles {
    /// The name or path of a robot or study; `None` for any other value.
    ///
    /// # Errors
    /// A robot or study that cannot be written.
    pub(crate) fn object(&mut self, value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
        let py = value.py();
        if let Ok(robot) = value.cast::<Robot>() {
            let file = RobotFile::of(py, robot.get())?;
            let path = file.path.clone();
            self.robots.push(file);
            return Ok(Some(path));
        }
        let Ok(study) = value.cast::<Study>() else {
            return Ok(None);
        };
        let study = study.get();
        if let Some(path) = study.path() {
            return Ok(Some(path));
        }
        let file = study_file(py, study.folder(), &study.text_with_robot(py)?)?;
        let path = file.path().to_string_lossy().into_owned();
        self.studies.push(file);
        Ok(Some(path))
    }

    /// The text of an operand: a robot, a study, or a path.
    ///
    /// # Errors
    /// As [`OperandFiles::object`]; any other value.
    pub(crate) fn operand(&mut self, value: &Bound<'_, PyAny>) -> PyResult<String> {
        if let Some(path) = self.object(value)? {
            return Ok(path);
        }
        if let Ok(text) = value.cast::<PyString>() {
            return Ok(text.to_string());
        }
        match value.extract::<PathBuf>() {
            Ok(path) => Ok(path.to_string_lossy().into_owned()),
            Err(_) => {
                let kind = value.get_type().name()?;
                Err(wrong_type(format!(
                    "expected a name, a path, a Robot or a Study, given {kind}"
                )))
            }
        }
    }
}
