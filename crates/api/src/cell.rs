//! The study that is served, and the folder of its files.
//!
//! Of an example, and of a study in a folder that takes no files, results and uploads go into a folder that is made for
//! this start and removed at its end.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use armill_formats::file::{remove_abandoned, write_atomically};
use armill_formats::input;
use armill_study::live::StudyText;
use armill_study::{StudyError, studies};
use tempfile::TempDir;

use crate::error::ApiError;

/// The study that is served where none is named and none is in the current folder.
const EXAMPLE: &str = "mh12-groove";
/// The version of a file that does not exist.
const ABSENT: &str = "absent";
/// The ports from which that of a study is chosen: above those that Linux gives to outgoing connections.
const FIRST_PORT: u16 = 61000;
const PORTS: u16 = 4500;

/// The study and its folder.
pub struct Cell {
    /// The name of the file in messages.
    pub shown: String,
    /// Folder of uploads and results, and of the files that the study names: a real path.
    pub root: PathBuf,
    /// The file on disk; none of an example.
    file: Option<PathBuf>,
    /// The text as found at the start; used if there is no file.
    example: Vec<u8>,
    /// Whether the file may be written.
    pub writable: bool,
    /// Whether it is the example, because no study was named and none was found.
    pub fallback: bool,
    /// One writer at a time.
    writing: Mutex<()>,
    /// Kept until the end.
    _made: Option<TempDir>,
}

impl Cell {
    /// The study at `given`; without, that of the current folder, else the example.
    ///
    /// # Errors
    /// No study there; a folder for results that cannot be made.
    pub fn find(given: Option<&Path>) -> Result<Cell, StudyError> {
        let here = Path::new("study.toml").is_file();
        let fallback = given.is_none() && !here;
        let given = given.unwrap_or_else(|| Path::new(if here { "." } else { EXAMPLE }));
        let found = studies::find(given)?;
        let file = if given.is_dir() {
            given.join("study.toml")
        } else {
            given.to_owned()
        };
        let file = file.canonicalize().ok().filter(|file| file.is_file());
        let folder = file.as_deref().and_then(Path::parent).map(Path::to_owned);
        let open = folder.filter(|folder| tempfile::tempfile_in(folder).is_ok());
        let (made, root) = match open {
            Some(folder) => (None, folder),
            None => {
                let made = private_folder("armill-").map_err(|error| {
                    StudyError::value(format!("cannot make a folder for results: {error}"), "set TMPDIR")
                })?;
                let root = made
                    .path()
                    .canonicalize()
                    .unwrap_or_else(|_| made.path().to_owned());
                (Some(made), root)
            }
        };
        // What uploads left that were killed with their server.
        remove_abandoned(&root);
        let locked = |file: &PathBuf| file.metadata().is_ok_and(|meta| meta.permissions().readonly());
        Ok(Cell {
            shown: found.shown,
            writable: made.is_none() && file.as_ref().is_some_and(|file| !locked(file)),
            fallback,
            root,
            file,
            example: found.bytes,
            writing: Mutex::default(),
            _made: made,
        })
    }

    /// The study of a folder that takes files; its text is in `study.toml`.
    pub fn of_folder(root: PathBuf) -> Cell {
        let file = root.join("study.toml");
        Cell {
            shown: "study.toml".to_owned(),
            root,
            file: Some(file),
            example: Vec::new(),
            writable: true,
            fallback: false,
            writing: Mutex::default(),
            _made: None,
        }
    }

    /// The bytes as they are now.
    ///
    /// # Errors
    /// The file cannot be read any more.
    pub(crate) fn bytes(&self) -> Result<Vec<u8>, StudyError> {
        match &self.file {
            None => Ok(self.example.clone()),
            Some(file) => input::read(file).map_err(|error| {
                let message = format!("cannot read {}: {error}", self.shown);
                StudyError::value(message, "check whether the file was moved")
            }),
        }
    }

    /// Identifies the study over restarts of the server: the path of its file, or the name of the example.
    pub(crate) fn identity(&self) -> String {
        self.file
            .as_deref()
            .map_or_else(|| self.shown.clone(), |file| file.display().to_string())
    }

    /// The port that a server of this study prefers: always the same, so that a browser finds again what it has kept.
    pub fn preferred_port(&self) -> u16 {
        // FNV-1a: the same in every version.
        let hash = self.identity().bytes().fold(0x811c_9dc5_u32, |hash, byte| {
            (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
        });
        FIRST_PORT + u16::try_from(hash % u32::from(PORTS)).unwrap_or_default()
    }

    /// Whether its file is there; an example always is.
    pub(crate) fn exists(&self) -> bool {
        self.file
            .as_deref()
            .is_none_or(|file| file.try_exists().unwrap_or(true))
    }

    /// Identifies the present state of the file.
    pub(crate) fn state(&self) -> String {
        match self.bytes() {
            Ok(bytes) => version(&bytes),
            Err(_) if !self.exists() => ABSENT.to_owned(),
            // There, but not readable: no page has seen it like that.
            Err(_) => String::new(),
        }
    }

    /// Replaces the text on disk, if that is still what the page has read. A file that was removed is made again, if the
    /// page has seen that.
    ///
    /// # Errors
    /// An example; a file that was changed by another program; one that cannot be written.
    pub(crate) fn write(&self, text: &str, seen: &str) -> Result<(), ApiError> {
        let (true, Some(file)) = (self.writable, &self.file) else {
            return Err(ApiError::forbidden(
                "this study cannot be written: `armill new DIR` makes one that can",
            ));
        };
        let _writing = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        let state = self.state();
        if state != seen || state.is_empty() {
            return Err(ApiError::conflict(match state == ABSENT {
                true => "the file was deleted since it was read",
                false => "the file on disk was changed since it was read",
            }));
        }
        write_atomically(file, text.as_bytes()).map_err(StudyError::from)?;
        Ok(())
    }

    /// Whether a file of this name would be that of the study itself, also where the file system ignores case.
    pub(crate) fn is_study(&self, name: &str) -> bool {
        let own = self.file.as_deref().and_then(|file| file.file_name()?.to_str());
        own.is_some_and(|own| own.to_lowercase() == name.to_lowercase())
    }

    /// A text of the page as a study of this folder.
    pub(crate) fn text<'a>(&'a self, text: &'a str) -> StudyText<'a> {
        StudyText {
            shown: &self.shown,
            folder: &self.root,
            bytes: text.as_bytes(),
        }
    }
}

/// A new folder for temporary files that no other user may look into.
///
/// # Errors
/// It cannot be made.
pub fn private_folder(prefix: &str) -> std::io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    builder.prefix(prefix).tempdir()
}

/// Identifies one state of the file.
pub(crate) fn version(bytes: &[u8]) -> String {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
