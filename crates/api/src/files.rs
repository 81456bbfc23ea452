//! Files of the study's folder: listed, found, recognised. Never one outside of it.
//!
//! | path | does |
//! |---|---|
//! | `GET /api/files` | what is there, two folders deep at most |
//!
//! How a file is sent and taken is up to the server or the browser; which paths are in the folder: see `folder`.

use std::path::{Path, PathBuf};

use armill_study::live::{FileKind, kind_of};
use schemars::JsonSchema;
use serde::Serialize;

use crate::cell::Cell;
use crate::context::Context;
use crate::error::ApiError;
use crate::folder::{FileRow, inside, is_plain, listed};

/// Largest size of an uploaded file, bytes.
pub const MOST_FILE_BYTES: u64 = 256 << 20;
/// Letters of a name.
const LONGEST_NAME: usize = 100;

/// The content of the folder.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Files {
    /// By name; at most 2000.
    pub files: Vec<FileRow>,
}

/// A file that was uploaded.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct UploadedFile {
    /// Its name in the folder.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Its detected kind.
    pub kind: FileKind,
    /// Example of the lines of a study that use such a file.
    pub hint: String,
}

pub(crate) fn list(context: &Context) -> Result<Files, ApiError> {
    Ok(Files {
        files: listed(&context.cell.root),
    })
}

/// The file at this path of the folder.
///
/// # Errors
/// There is none in it.
pub fn file_path(cell: &Cell, path: &str) -> Result<PathBuf, ApiError> {
    inside(&cell.root, path)
}

/// Whether a file may be uploaded under this name.
///
/// # Errors
/// A name with a folder or odd letters; that of the study itself.
pub fn check_name(cell: &Cell, name: &str) -> Result<(), ApiError> {
    let letters = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    if !is_plain(name)
        || !name.chars().all(letters)
        || name.chars().count() > LONGEST_NAME
        || name.trim() != name
    {
        let message =
            "a file name has letters, digits, `-`, `_`, points and blanks, 100 at most, and no folder";
        return Err(ApiError::forbidden(message));
    }
    if cell.is_study(name) {
        return Err(ApiError::forbidden("the study is written by /api/study"));
    }
    Ok(())
}

/// What was uploaded to this path.
pub fn uploaded(path: &Path, name: String, bytes: u64) -> UploadedFile {
    let (kind, hint) = kind_of(path, &name);
    UploadedFile {
        name,
        bytes,
        kind,
        hint,
    }
}
