//! Temporary files on WASI, where `tempfile` has none: a folder of a browser, which one program writes at a time.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// A file without its name, removed unless it takes it.
#[derive(Debug)]
pub struct NamedTempFile {
    file: File,
    path: PathBuf,
    /// Whether it has taken its name.
    is_named: bool,
}

/// A file that could not take its name.
#[derive(Debug)]
pub struct PersistError {
    /// The reason.
    pub error: io::Error,
}

impl NamedTempFile {
    /// One in `folder`, the first of these names that is free.
    ///
    /// # Errors
    /// It cannot be made.
    pub(super) fn new(folder: &Path, prefix: &str, suffix: &str) -> io::Result<NamedTempFile> {
        for number in 0_u32.. {
            let path = folder.join(format!("{prefix}{number}{suffix}"));
            match File::options()
                .read(true)
                .write(true)
                .create_new(true)
                .open(&path)
            {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                opened => {
                    return opened.map(|file| NamedTempFile {
                        file,
                        path,
                        is_named: false,
                    });
                }
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// The file.
    pub fn as_file(&self) -> &File {
        &self.file
    }

    /// The file, to be written.
    pub(super) fn as_file_mut(&mut self) -> &mut File {
        &mut self.file
    }

    /// Gives it this name, in place of another file.
    ///
    /// # Errors
    /// It cannot be renamed.
    pub(super) fn persist(mut self, target: &Path) -> Result<(), PersistError> {
        fs::rename(&self.path, target).map_err(|error| PersistError { error })?;
        self.is_named = true;
        Ok(())
    }
}

impl Drop for NamedTempFile {
    fn drop(&mut self) {
        if !self.is_named {
            let _ = fs::remove_file(&self.path);
        }
    }
}
