//! A robot as a file, for what reads robots by name or path: commands and studies.

use std::fs;

use pyo3::prelude::*;
use tempfile::TempDir;

use crate::errors::refused;
use crate::robot::Robot;

/// The file of a robot.
pub(crate) struct RobotFile {
    /// Its path; the name of a robot of the library.
    pub path: String,
    _folder: Option<TempDir>,
}

impl RobotFile {
    /// A file with this robot, called after it.
    ///
    /// # Errors
    /// A robot that cannot be written.
    pub(crate) fn of(py: Python<'_>, robot: &Robot) -> PyResult<RobotFile> {
        if let Some(name) = robot.source.name_in_library() {
            return Ok(RobotFile {
                path: name.to_owned(),
                _folder: None,
            });
        }
        let text = robot.source.toml(py)?;
        let name = robot.source.name().rsplit(['/', '\\']).next().unwrap_or("robot");
        let made = tempfile::Builder::new()
            .prefix("armill-")
            .tempdir()
            .and_then(|folder| {
                let path = folder.path().join(format!("{name}.toml"));
                fs::write(&path, text).map(|()| RobotFile {
                    path: path.to_string_lossy().into_owned(),
                    _folder: Some(folder),
                })
            });
        made.map_err(|error| {
            let message = format!("robot `{name}` cannot be written to a temporary file: {error}");
            refused(py, message, "write `robot.to_toml()` to a file and give its path")
        })
    }
}
