//! Why a file or folder was not written: what failed, and what to try.

use std::io;
use std::path::{Path, PathBuf};

/// Why a file or folder was not written: what failed, and what to try.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The path has no file name.
    #[error("`{}` names no file: give a path that ends in a file name", path.display())]
    NoFileName {
        /// The path as it was given.
        path: PathBuf,
    },
    /// A folder has the name of the file.
    #[error("cannot write `{}`: it is a folder; give the name of a file inside it", path.display())]
    IsFolder {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The folder the file should be in does not exist.
    #[error("cannot write `{}`: the folder `{}` does not exist; create it first", path.display(), folder.display())]
    FolderMissing {
        /// The path as it was given.
        path: PathBuf,
        /// The folder that is missing.
        folder: PathBuf,
    },
    /// A file has the name of the folder.
    #[error("cannot use `{}` as a folder: `{}` is a file; move it away or choose another folder",
            path.display(), file.display())]
    FileInTheWay {
        /// The folder that is required.
        path: PathBuf,
        /// The file of that name.
        file: PathBuf,
    },
    /// Files that armill did not make, or that were changed since.
    #[error("cannot write {}: {}; choose another place, or replace with --force", listed(paths),
            if paths.len() == 1 { "the file exists, and armill did not make it or it was changed since" }
            else { "the files exist, and armill did not make them or they were changed since" })]
    NotOurs {
        /// The paths as they were given; at least one.
        paths: Vec<PathBuf>,
    },
    /// Files that no command replaces unasked.
    #[error("cannot write {}: {}; choose another place, or replace with --force", listed(paths),
            if paths.len() == 1 { "the file exists" } else { "the files exist" })]
    Exists {
        /// The paths as they were given; at least one.
        paths: Vec<PathBuf>,
    },
    /// The file is an input of the same command.
    #[error("cannot write `{}`: this command reads that file; choose another name", path.display())]
    IsInput {
        /// The path as it was given.
        path: PathBuf,
    },
    /// A link has the name of the file.
    #[error("cannot write `{}`: it is a link, and links are not followed; remove it or choose another name",
            path.display())]
    IsLink {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The folder for results that was not chosen by the user is a link to somewhere else.
    #[error("cannot write into `{}`: it is a link that leads out of the folder of the study; remove it, or name the folder that it leads to",
            path.display())]
    LeadsOut {
        /// The link.
        path: PathBuf,
    },
    /// Another run writes into the folder.
    #[error("cannot write into `{}`: {holder} is writing there; wait for it or choose another folder", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// Who writes there, such as `armill run, process 123`.
        holder: String,
    },
    /// The user may not write there.
    #[error("cannot write `{}`: no permission in `{}`; change its permissions or choose another folder",
            path.display(), folder.display())]
    NotPermitted {
        /// The path as it was given.
        path: PathBuf,
        /// The folder that refuses.
        folder: PathBuf,
    },
    /// The file is there and may not be changed.
    #[error("cannot write `{}`: it is write-protected; remove the protection or choose another name", path.display())]
    WriteProtected {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The file system is read-only.
    #[error("cannot write `{}`: its file system is read-only; choose another folder", path.display())]
    ReadOnly {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The disk or the quota is full.
    #[error("cannot write `{}`{}: no space left; free some or choose another disk", path.display(), in_brackets(*bytes))]
    NoSpace {
        /// The path as it was given.
        path: PathBuf,
        /// The size that was to be written; `None` for a folder.
        bytes: Option<usize>,
    },
    /// Any other refusal of the operating system, in its own words.
    #[error("cannot write `{}`: {source}", path.display())]
    Other {
        /// The path as it was given.
        path: PathBuf,
        /// The message of the operating system.
        source: io::Error,
    },
}

impl FileError {
    /// The path that could not be written, as it was given.
    pub fn path(&self) -> &Path {
        match self {
            Self::NoFileName { path }
            | Self::IsFolder { path }
            | Self::FolderMissing { path, .. }
            | Self::IsInput { path }
            | Self::IsLink { path }
            | Self::LeadsOut { path }
            | Self::FileInTheWay { path, .. }
            | Self::NotPermitted { path, .. }
            | Self::WriteProtected { path }
            | Self::ReadOnly { path }
            | Self::NoSpace { path, .. }
            | Self::Other { path, .. } => path,
            Self::InUse { folder, .. } => folder,
            Self::NotOurs { paths } | Self::Exists { paths } => {
                paths.first().map_or(Path::new(""), PathBuf::as_path)
            }
        }
    }

    /// The situation behind an error of the operating system.
    pub(super) fn of(path: &Path, bytes: Option<usize>, source: io::Error) -> Self {
        let path = path.to_owned();
        let folder = folder_of(&path);
        match source.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
                match file_in_the_way(&folder) {
                    Some(file) => Self::FileInTheWay { path: folder, file },
                    None if folder.exists() => Self::Other { path, source },
                    None => Self::FolderMissing { path, folder },
                }
            }
            io::ErrorKind::PermissionDenied => {
                let refusing = folder.ancestors().find(|part| part.exists()).map(Path::to_owned);
                Self::NotPermitted {
                    path,
                    folder: refusing.unwrap_or(folder),
                }
            }
            io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly { path },
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::NoSpace { path, bytes },
            _ => Self::Other { path, source },
        }
    }
}

/// A size behind the name of a file.
fn in_brackets(bytes: Option<usize>) -> String {
    bytes.map_or_else(String::new, |bytes| format!(" ({bytes} bytes)"))
}

/// Paths for a message: the first few by name.
fn listed(paths: &[PathBuf]) -> String {
    const MOST: usize = 3;
    let named = paths
        .iter()
        .take(MOST)
        .map(|path| format!("`{}`", path.display()));
    let named = named.collect::<Vec<_>>().join(", ");
    match paths.len().checked_sub(MOST) {
        Some(more) if more > 0 => format!("{named} and {more} more"),
        _ => named,
    }
}

/// The folder of a path; the current one for a bare name.
pub(super) fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// The nearest part of a path that exists, if it is not a folder.
pub(super) fn file_in_the_way(path: &Path) -> Option<PathBuf> {
    path.ancestors()
        .find(|part| part.exists())
        .filter(|part| !part.is_dir())
        .map(Path::to_owned)
}
