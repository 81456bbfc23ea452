//! Finding the study that a user means: a folder, a file, or an example by name.

use std::path::{Path, PathBuf};

use armill_study::file::resolve::{Study, read};
use armill_study::{StudyError, library};

/// A study as it was found.
pub(crate) struct Found {
    /// What errors call the file.
    pub shown: String,
    /// Folder that robot files are looked for in, and where `out` goes.
    pub folder: PathBuf,
    /// The file.
    pub bytes: Vec<u8>,
}

impl Found {
    pub(crate) fn read(&self) -> Result<Study, StudyError> {
        read(&self.shown, &self.folder, &self.bytes)
    }
}

/// The study at `given`; an example of the library where nothing of that name is on disk.
pub(crate) fn find(given: &Path) -> Result<Found, StudyError> {
    let file = if given.is_dir() {
        given.join("study.toml")
    } else {
        given.to_owned()
    };
    let shown = file.display().to_string();
    if !file.exists() {
        let name = given
            .strip_prefix("studies")
            .unwrap_or(given)
            .display()
            .to_string();
        let Some(example) = library::STUDIES.iter().find(|study| study.name == name) else {
            let examples: Vec<&str> = library::STUDIES.iter().map(|study| study.name).collect();
            return Err(StudyError::value(
                format!("no study at {shown}"),
                format!(
                    "make one with `armill new DIR`, or run an example: {}",
                    examples.join(", ")
                ),
            ));
        };
        return Ok(Found {
            shown: example.path.to_owned(),
            folder: PathBuf::from(example.name),
            bytes: example.text.into(),
        });
    }
    let bytes = std::fs::read(&file).map_err(|error| {
        StudyError::value(format!("cannot read {shown}: {error}"), "give a readable file")
    })?;
    let folder = file.parent().map_or_else(|| PathBuf::from("."), Path::to_owned);
    Ok(Found { shown, folder, bytes })
}
