//! Finding the study that a user means: a folder, a file, or an example by name.
//!
//! A folder means the `study.toml` in it. What is on disk comes before an example of the same name.

use std::path::{Path, PathBuf};

use crate::error::StudyError;
use crate::file::format::StudyFile;
use crate::file::resolve::{Study, read, read_changed};
use crate::library;

/// A study as it was found.
#[derive(Clone, Debug)]
pub struct FoundStudy {
    /// What errors call the file.
    pub shown: String,
    /// Folder that robot files are looked for in, and where `out` goes.
    pub folder: PathBuf,
    /// The file.
    pub bytes: Vec<u8>,
}

impl FoundStudy {
    /// The study, checked.
    ///
    /// # Errors
    /// Every problem of the file.
    pub fn read(&self) -> Result<Study, StudyError> {
        read(&self.shown, &self.folder, &self.bytes)
    }

    /// The study with what `change` makes of its file, checked.
    ///
    /// # Errors
    /// Every problem of the file.
    pub fn read_changed(&self, change: impl FnOnce(&mut StudyFile)) -> Result<Study, StudyError> {
        read_changed((&self.shown, &self.folder), &self.bytes, change)
    }
}

/// The study at `given`; an example of the library where nothing of that name is on disk.
///
/// # Errors
/// Neither; a file that cannot be read.
pub fn find(given: &Path) -> Result<FoundStudy, StudyError> {
    let file = if given.is_dir() {
        given.join("study.toml")
    } else {
        given.to_owned()
    };
    let shown = file.display().to_string();
    if !file.exists() {
        return example(given, &shown);
    }
    let bytes = std::fs::read(&file).map_err(|error| {
        StudyError::value(format!("cannot read {shown}: {error}"), "give a readable file")
    })?;
    let folder = file.parent().map_or_else(|| PathBuf::from("."), Path::to_owned);
    Ok(FoundStudy { shown, folder, bytes })
}

/// The example `given`, with or without its folder `studies`.
fn example(given: &Path, shown: &str) -> Result<FoundStudy, StudyError> {
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
    Ok(FoundStudy {
        shown: example.path.to_owned(),
        folder: PathBuf::from(example.name),
        bytes: example.text.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_example_is_found_by_name_and_what_is_none_is_told_with_those_there_are() {
        let found = find(Path::new("studies/mh12-groove")).unwrap();
        assert_eq!(found.shown, "studies/mh12-groove/study.toml");
        assert!(found.read().is_ok());
        let error = find(Path::new("no-such-study")).unwrap_err().to_string();
        assert!(error.contains("mh12-groove, kr120-groove"), "{error}");
    }
}
