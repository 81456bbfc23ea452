//! One writer a folder: `.armill-lock`, locked as long as it writes and removed at its end.
//!
//! The lock is that of the operating system and ends with its process: a run that was killed leaves a file without a lock,
//! which the next run takes. Where a file system has no locks, a second run is not refused.

use std::fs::{self, File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::error::FileError;
use crate::input::Identity;

/// The name of the lock.
const LOCK: &str = ".armill-lock";
/// Time between attempts.
const AGAIN: Duration = Duration::from_millis(20);
/// Most bytes of the holder's name.
const HOLDER_BYTES: u64 = 200;

/// A folder that this process alone writes into, until this is dropped.
#[derive(Debug)]
pub(super) struct Lock {
    file: PathBuf,
    /// `None` where the file system has no locks.
    _lock: Option<File>,
}

impl Lock {
    /// Locks `folder` for the command `by`, waiting no longer than `patience`.
    ///
    /// # Errors
    /// Another run writes there; a folder that takes no files; a link in place of the lock.
    pub(super) fn of(folder: &Path, by: &str, patience: Duration) -> Result<Lock, FileError> {
        let file = folder.join(LOCK);
        let give_up = Instant::now() + patience;
        loop {
            if let Some(lock) = attempt(&file)? {
                return Ok(Lock::with(file, lock, by));
            }
            if Instant::now() >= give_up {
                return Err(FileError::InUse {
                    folder: folder.to_owned(),
                    holder: holder(&file),
                });
            }
            std::thread::sleep(AGAIN);
        }
    }

    /// Writes the holder into the file.
    fn with(file: PathBuf, mut lock: Option<File>, by: &str) -> Lock {
        if let Some(lock) = &mut lock {
            // Only the message to a second run depends on this.
            let _ = lock.set_len(0);
            let _ = lock.rewind();
            let _ = write!(lock, "armill {by}, process {}", std::process::id());
        }
        Lock { file, _lock: lock }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While it is locked: no other run can have taken it.
        let _ = fs::remove_file(&self.file);
    }
}

/// The locked file, `Some(None)` where there are no locks; `None` while another run has locked it.
fn attempt(file: &Path) -> Result<Option<Option<File>>, FileError> {
    if file.is_symlink() {
        return Err(FileError::IsLink {
            path: file.to_owned(),
        });
    }
    let opened = File::options()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(file)
        .map_err(|source| FileError::of(file, None, source))?;
    match opened.try_lock() {
        Ok(()) if is_called(&opened, file) => Ok(Some(Some(opened))),
        // Its holder removed it between opening and locking.
        Ok(()) | Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(_)) => Ok(Some(None)),
    }
}

/// Whether the open file is still the one of this name.
fn is_called(opened: &File, file: &Path) -> bool {
    let (Ok(metadata), Some(there)) = (opened.metadata(), Identity::of(file)) else {
        return false;
    };
    Identity::with(file, &metadata) == Some(there)
}

/// The holder of the lock, as the file names it.
fn holder(file: &Path) -> String {
    let mut said = Vec::new();
    let _ = File::open(file).and_then(|file| file.take(HOLDER_BYTES).read_to_end(&mut said));
    let said = String::from_utf8_lossy(&said);
    let said: String = said.chars().filter(|c| !c.is_control()).collect();
    if said.is_empty() {
        "another run".to_owned()
    } else {
        said
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_run_is_refused_with_the_holder_and_admitted_when_the_folder_is_free() {
        let folder = tempfile::tempdir().unwrap();
        let first = Lock::of(folder.path(), "run", Duration::ZERO).unwrap();
        let refused = Lock::of(folder.path(), "place", Duration::ZERO).unwrap_err();
        let own = format!("armill run, process {}", std::process::id());
        assert!(
            matches!(&refused, FileError::InUse { holder, .. } if *holder == own),
            "{refused}"
        );
        std::thread::scope(|scope| {
            let second = scope.spawn(|| Lock::of(folder.path(), "place", Duration::from_secs(60)));
            std::thread::sleep(2 * AGAIN);
            drop(first);
            assert!(second.join().unwrap().is_ok());
        });
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_lock_that_a_killed_run_left_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(
            folder.path().join(LOCK),
            "armill run, process 1, and more text than the next",
        )
        .unwrap();
        let lock = Lock::of(folder.path(), "run", Duration::ZERO).unwrap();
        let text = fs::read_to_string(folder.path().join(LOCK)).unwrap();
        assert_eq!(text, format!("armill run, process {}", std::process::id()));
        drop(lock);
        assert!(!folder.path().join(LOCK).exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_place_of_the_lock_is_refused_and_what_it_leads_to_stays() {
        let folder = tempfile::tempdir().unwrap();
        let other = folder.path().join("other");
        fs::write(&other, "mine").unwrap();
        std::os::unix::fs::symlink("other", folder.path().join(LOCK)).unwrap();
        let refused = Lock::of(folder.path(), "run", Duration::ZERO).unwrap_err();
        assert!(matches!(refused, FileError::IsLink { .. }), "{refused}");
        assert_eq!(fs::read_to_string(&other).unwrap(), "mine");
    }
}
