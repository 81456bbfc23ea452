//! A file that is written whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

#[cfg(not(target_os = "wasi"))]
use tempfile::NamedTempFile;

use super::error::{FileError, file_in_the_way, folder_of};
#[cfg(target_os = "wasi")]
use super::wasi::NamedTempFile;

/// Writes a file whole, in place of what may have been there, which keeps its permissions. Whether it may be replaced
/// is the question of [`super::Writer`].
///
/// A link is refused. Devices and pipes (`/dev/stdout`) are written directly.
///
/// # Errors
/// The operation that failed; then the old content is untouched and no temporary file remains.
pub fn write_atomically(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FileError> {
    let path = path.as_ref();
    PartFile::write(path, bytes)?.take_name()?;
    sync_folder(&folder_of(path));
    Ok(())
}

/// A file that is written and does not have its name yet. It is removed if dropped before.
#[derive(Debug)]
pub struct PartFile {
    /// As it was given, for errors.
    path: PathBuf,
    /// Its size, for errors.
    bytes: usize,
    /// The temporary file and the name that it is to take; none for a device, which is written already.
    part: Option<(NamedTempFile, PathBuf)>,
}

impl PartFile {
    /// Writes `bytes` to a temporary file next to `path`; see [`write_atomically`].
    ///
    /// # Errors
    /// The operation that failed; then no temporary file remains.
    pub fn write(path: impl AsRef<Path>, bytes: &[u8]) -> Result<PartFile, FileError> {
        let path = path.as_ref();
        let part = named_error(
            path,
            bytes.len(),
            write_temporary(path, &mut |out| out.write_all(bytes)),
        )?;
        Ok(PartFile {
            path: path.to_owned(),
            bytes: bytes.len(),
            part,
        })
    }

    /// Forces the bytes to the disk and gives them their name. The name itself is safe after [`sync_folder`].
    ///
    /// # Errors
    /// The operation that failed; then the old content is untouched and no temporary file remains.
    pub fn take_name(self) -> Result<(), FileError> {
        let Some((part, target)) = self.part else {
            return Ok(());
        };
        let named = || {
            part.as_file().sync_all()?;
            part.persist(&target).map_err(|error| error.error)?;
            Ok(())
        };
        named_error(&self.path, self.bytes, named())
    }
}

/// Forces the names in a folder to the disk; not every file system supports that.
pub fn sync_folder(folder: &Path) {
    #[cfg(unix)]
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    #[cfg(not(unix))]
    let _ = folder;
}

/// A temporary file in `folder`, locked while it is open; one that is left is found by [`remove_abandoned`].
///
/// Not checked: that it is written through this handle or a clone of it, which the lock requires on some systems.
///
/// # Errors
/// It cannot be made.
#[cfg(not(target_os = "wasi"))]
pub fn new_part(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PART_PREFIX).suffix(PART_SUFFIX);
    // Without this the file would be readable by its owner alone; the user's mask still applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let part = builder.tempfile_in(folder)?;
    // Shows other runs that it is being written; some file systems have no locks.
    let _ = part.as_file().try_lock();
    Ok(part)
}

/// A temporary file in `folder`.
///
/// # Errors
/// It cannot be made.
#[cfg(target_os = "wasi")]
pub fn new_part(folder: &Path) -> io::Result<NamedTempFile> {
    NamedTempFile::new(folder, PART_PREFIX, PART_SUFFIX)
}

/// Removes the temporary files in `folder` that no process writes any more, as a killed run leaves them.
///
/// What cannot be looked at, locked or removed stays: it does no harm.
pub fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let ours = name.starts_with(PART_PREFIX) && name.ends_with(PART_SUFFIX);
        if !ours || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let path = entry.path();
        let unlocked = File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if unlocked {
            let _ = fs::remove_file(path);
        }
    }
}

/// Creates a folder and those above it; success if it is there already.
///
/// # Errors
/// A name that is not free, such as a file of that name.
pub fn create_folder(path: impl AsRef<Path>) -> Result<(), FileError> {
    let path = path.as_ref();
    fs::create_dir_all(path).map_err(|source| match file_in_the_way(path) {
        Some(file) => FileError::FileInTheWay {
            path: path.to_owned(),
            file,
        },
        None => FileError::of(path, None, source),
    })
}

/// Temporary files are called `.armill-XXXXXX.part`, with letters and digits in place of the X.
const PART_PREFIX: &str = ".armill-";
const PART_SUFFIX: &str = ".part";

/// Either a situation that was recognised, or the message of the operating system.
enum Failure {
    Named(FileError),
    System(io::Error),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::System(error)
    }
}

/// The failure of writing `bytes` bytes to `path`, as a known situation with advice.
fn named_error<T>(path: &Path, bytes: usize, result: Result<T, Failure>) -> Result<T, FileError> {
    result.map_err(|failure| match failure {
        Failure::Named(error) => error,
        Failure::System(source) => FileError::of(path, Some(bytes), source),
    })
}

/// The temporary file and the name that it is to take; none where a device was written.
fn write_temporary(
    path: &Path,
    write: &mut dyn FnMut(&mut File) -> io::Result<()>,
) -> Result<Option<(NamedTempFile, PathBuf)>, Failure> {
    if path.file_name().is_none() {
        let path = path.to_owned();
        return Err(Failure::Named(if path.is_dir() {
            FileError::IsFolder { path }
        } else {
            FileError::NoFileName { path }
        }));
    }
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(Failure::Named(FileError::IsFolder {
            path: path.to_owned(),
        }));
    }
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        // A device or pipe must keep its place: there is nothing to replace.
        write(&mut File::options().write(true).open(path)?)?;
        return Ok(None);
    }
    // WASI has no permissions, and would seem to forbid everything.
    if !cfg!(target_os = "wasi") && old.as_ref().is_some_and(|old| old.permissions().readonly()) {
        // Renaming would replace it all the same: the folder alone decides about that.
        return Err(Failure::Named(FileError::WriteProtected {
            path: path.to_owned(),
        }));
    }
    if path.is_symlink() {
        return Err(Failure::Named(FileError::IsLink {
            path: path.to_owned(),
        }));
    }
    let mut part = new_part(&folder_of(path))?;
    write(part.as_file_mut())?;
    // WASI has no permissions.
    #[cfg(not(target_os = "wasi"))]
    if let Some(old) = old {
        part.as_file().set_permissions(old.permissions())?;
    }
    Ok(Some((part, path.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_written_and_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.csv");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names_in(folder.path()), ["result.csv"]);
    }

    #[test]
    fn a_failed_write_keeps_the_old_content_and_leaves_no_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.csv");
        write_atomically(&path, b"old").unwrap();
        let failure = write_temporary(&path, &mut |out| {
            out.write_all(b"half of the n")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert!(matches!(failure, Err(Failure::System(error)) if error.kind() == io::ErrorKind::StorageFull));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["result.csv"]);
    }

    #[test]
    fn a_part_takes_its_name_on_request() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.csv");
        drop(PartFile::write(&path, b"given up").unwrap());
        assert!(names_in(folder.path()).is_empty());
        let part = PartFile::write(&path, b"one").unwrap();
        assert!(!path.exists());
        part.take_name().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one");
    }

    #[test]
    fn temporary_files_of_a_killed_run_are_removed_and_those_in_use_stay() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".armill-a1B2c3.part", ".armill-files", "a.part", "map.csv"] {
            fs::write(folder.path().join(name), "half").unwrap();
        }
        let part = PartFile::write(folder.path().join("plate.csv"), b"whole").unwrap();
        remove_abandoned(folder.path());
        part.take_name().unwrap();
        assert_eq!(
            names_in(folder.path()),
            [".armill-files", "a.part", "map.csv", "plate.csv"]
        );
        remove_abandoned(&folder.path().join("nowhere"));
    }

    #[test]
    fn a_folder_in_place_of_the_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_atomically(folder.path(), b"x").unwrap_err();
        assert!(matches!(error, FileError::IsFolder { .. }), "{error}");
        assert!(
            error.to_string().contains(&*folder.path().to_string_lossy()),
            "{error}"
        );
        assert!(names_in(folder.path()).is_empty());
        for path in ["/", ".", "a/..", ""] {
            let error = write_atomically(path, b"x").unwrap_err();
            assert!(
                matches!(error, FileError::IsFolder { .. } | FileError::NoFileName { .. }),
                "{error}"
            );
        }
    }

    #[test]
    fn a_missing_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_atomically(folder.path().join("maps").join("a.csv"), b"x").unwrap_err();
        assert!(
            matches!(&error, FileError::FolderMissing { folder, .. } if folder.ends_with("maps")),
            "{error}"
        );
        assert!(error.to_string().contains("create it first"), "{error}");
    }

    #[test]
    fn a_file_in_place_of_a_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("maps");
        write_atomically(&file, b"a file").unwrap();
        let errors = [
            write_atomically(file.join("a.csv"), b"x").unwrap_err(),
            create_folder(&file).unwrap_err(),
            create_folder(file.join("deep").join("deeper")).unwrap_err(),
        ];
        for error in errors {
            assert!(
                matches!(&error, FileError::FileInTheWay { file: named, .. } if *named == file),
                "{error}"
            );
            assert!(error.to_string().contains("is a file"), "{error}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"a file");
    }

    #[test]
    fn a_folder_is_created_with_those_above_it_and_twice_is_no_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a").join("b");
        create_folder(&path).unwrap();
        create_folder(&path).unwrap();
        assert!(path.is_dir());
    }

    #[test]
    fn refusals_of_the_system_become_situations_with_advice() {
        let said =
            |kind: io::ErrorKind| FileError::of(Path::new("maps/a.csv"), Some(12), kind.into()).to_string();
        assert_eq!(
            said(io::ErrorKind::PermissionDenied),
            "cannot write `maps/a.csv`: no permission in `maps`; change its permissions or choose another folder"
        );
        assert_eq!(
            said(io::ErrorKind::StorageFull),
            "cannot write `maps/a.csv` (12 bytes): no space left; free some or choose another disk"
        );
        let folder = FileError::of(Path::new("maps"), None, io::ErrorKind::StorageFull.into());
        assert!(
            folder
                .to_string()
                .starts_with("cannot write `maps`: no space left")
        );
        assert!(said(io::ErrorKind::QuotaExceeded).contains("no space left"));
        assert!(said(io::ErrorKind::ReadOnlyFilesystem).contains("read-only"));
        assert!(said(io::ErrorKind::TimedOut).starts_with("cannot write `maps/a.csv`: "));
        let error = FileError::of(
            Path::new("a.csv"),
            Some(12),
            io::ErrorKind::PermissionDenied.into(),
        );
        assert!(error.to_string().contains("no permission in `.`"), "{error}");
        assert_eq!(error.path(), Path::new("a.csv"));
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_without_permission_is_named_and_stays_empty() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o555)).unwrap();
        // Root may write anyway: then there is nothing to refuse.
        let refuses = File::create(folder.path().join("probe")).is_err();
        let result = write_atomically(folder.path().join("a.csv"), b"x");
        if refuses {
            assert!(matches!(result, Err(FileError::NotPermitted { .. })));
            assert!(names_in(folder.path()).is_empty());
        } else {
            assert!(result.is_ok());
        }
        fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o755)).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported_as_no_space_and_stays_a_device() {
        let error = write_atomically("/dev/full", b"12345").unwrap_err();
        assert!(
            matches!(error, FileError::NoSpace { bytes: Some(5), .. }),
            "{error}"
        );
        write_atomically("/dev/null", b"12345").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn a_write_protected_file_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("robot.toml");
        fs::write(&path, "old").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = write_atomically(&path, b"new").unwrap_err();
        assert!(matches!(error, FileError::WriteProtected { .. }), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["robot.toml"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_takes_no_files_is_not_called_missing() {
        let error = write_atomically("/proc/armill.csv", b"x").unwrap_err();
        assert!(!matches!(error, FileError::FolderMissing { .. }), "{error}");
        assert!(error.to_string().contains("/proc/armill.csv"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_refused_wherever_it_leads() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "old").unwrap();
        for (name, target) in [("link", "file"), ("loop", "loop"), ("nowhere", "no-such-file")] {
            let link = folder.path().join(name);
            std::os::unix::fs::symlink(target, &link).unwrap();
            let error = write_atomically(&link, b"new").unwrap_err();
            assert!(matches!(error, FileError::IsLink { .. }), "{error}");
            assert!(link.is_symlink());
        }
        assert_eq!(fs::read(&file).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["file", "link", "loop", "nowhere"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_is_replaced_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).unwrap();
        write_atomically(&file, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_has_the_permissions_of_any_other_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| {
            fs::metadata(folder.path().join(name))
                .unwrap()
                .permissions()
                .mode()
        };
        File::create(folder.path().join("plain")).unwrap();
        write_atomically(folder.path().join("ours"), b"x").unwrap();
        assert_eq!(mode("ours"), mode("plain"));
    }
}
