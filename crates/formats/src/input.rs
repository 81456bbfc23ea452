//! Files that are read: opened in one place, bounded, and remembered.
//!
//! | rule | reason |
//! |---|---|
//! | a regular file is read to the length that it had when it was opened | a file that grows, or that the kernel makes while it is read (`/proc`), ends |
//! | a pipe or device is opened only where the command line names it | a study from elsewhere must not make the program wait for ever |
//! | a file that is read as a whole has at most [`MOST_BYTES`], any other at most [`MOST_STREAM_BYTES`] | a wrong file must not take all memory |
//! | reading ends where the command is cancelled | work whose client has left must not go on |
//! | every file that was opened is remembered for the time of a command | no command may replace its own input, see [`crate::file::Writer`] |
//!
//! [`Inputs`] are the inputs of one command: set for the thread that runs it, for the time that it runs. Without them
//! files are opened under the same rules and not remembered.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// A file that is read as a whole may have this many bytes: studies, robots, programs of robots, tables that were typed
/// have some kB, the largest some MB.
pub const MOST_BYTES: u64 = 64 << 20;
/// Largest size of any other file, bytes: a record of a dynamometer has some 100 MB.
pub const MOST_STREAM_BYTES: u64 = 16 << 30;

/// Identifies a file, whatever its name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Identity {
    /// Device and number on it.
    #[cfg_attr(not(unix), allow(dead_code))]
    Node(u64, u64),
    /// Its path without links, where the system gives no number.
    #[cfg_attr(unix, allow(dead_code))]
    Path(PathBuf),
}

impl Identity {
    /// The file that `path` leads to, through links; `None` where there is none.
    pub(crate) fn of(path: &Path) -> Option<Identity> {
        Self::with(path, &path.metadata().ok()?)
    }

    #[cfg(unix)]
    pub(crate) fn with(_: &Path, metadata: &Metadata) -> Option<Identity> {
        use std::os::unix::fs::MetadataExt;
        Some(Self::Node(metadata.dev(), metadata.ino()))
    }

    #[cfg(not(unix))]
    pub(crate) fn with(path: &Path, _: &Metadata) -> Option<Identity> {
        real_path(path).ok().map(Self::Path)
    }
}

/// The path without links, from the root; of a file or folder that exists.
///
/// # Errors
/// There is nothing at the path.
pub fn real_path(path: &Path) -> io::Result<PathBuf> {
    // WASI cannot resolve links, and the folder of a browser has none.
    #[cfg(target_os = "wasi")]
    return path.metadata().map(|_| path.to_owned());
    #[cfg(not(target_os = "wasi"))]
    path.canonicalize()
}

/// A file as it was when it was opened.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FileState {
    identity: Option<Identity>,
    length: u64,
    modified: Option<SystemTime>,
}

impl FileState {
    fn of(path: &Path, metadata: &Metadata) -> FileState {
        FileState {
            identity: Identity::with(path, metadata),
            length: metadata.len(),
            modified: metadata.modified().ok(),
        }
    }
}

/// The inputs of one command: the files that its command line names, and all that it has opened.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    named: Arc<BTreeSet<Identity>>,
    opened: Arc<Mutex<BTreeSet<Identity>>>,
    states: Arc<Mutex<BTreeMap<PathBuf, FileState>>>,
    cancel: Arc<AtomicBool>,
}

thread_local! {
    static CURRENT: RefCell<Option<Inputs>> = const { RefCell::new(None) };
}

impl Inputs {
    /// Those of a command line with these words; words that are not paths have no effect.
    pub fn naming<'a>(words: impl IntoIterator<Item = &'a Path>) -> Inputs {
        Inputs {
            named: Arc::new(words.into_iter().filter_map(Identity::of).collect()),
            ..Inputs::default()
        }
    }

    /// Those of work that this flag cancels: files that are being read then end with an error.
    pub fn cancelled_by(cancel: Arc<AtomicBool>) -> Inputs {
        Inputs {
            cancel,
            ..Inputs::default()
        }
    }

    /// Runs `work` with these as the inputs of this thread; those before are back afterwards, also where `work` panics.
    pub fn during<T>(&self, work: impl FnOnce() -> T) -> T {
        struct Before(Option<Inputs>);
        impl Drop for Before {
            fn drop(&mut self) {
                CURRENT.set(self.0.take());
            }
        }
        let _before = Before(CURRENT.replace(Some(self.clone())));
        work()
    }

    /// Whether the command line names the file that `path` leads to.
    pub fn name(&self, path: &Path) -> bool {
        Identity::of(path).is_some_and(|file| self.named.contains(&file))
    }

    /// Those of this thread; none where nothing was set.
    pub fn current() -> Inputs {
        CURRENT.with_borrow(Clone::clone).unwrap_or_default()
    }

    /// Whether every file that was opened is as it was then.
    pub fn are_unchanged(&self) -> bool {
        let states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        states.iter().all(|(path, state)| {
            path.metadata()
                .is_ok_and(|metadata| FileState::of(path, &metadata) == *state)
        })
    }

    /// Whether this file was opened.
    pub(crate) fn contains(&self, file: &Identity) -> bool {
        let opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        opened.contains(file)
    }
}

/// A file that is being read; it ends where it ended when it was opened.
#[derive(Debug)]
pub struct InputFile {
    from: io::Take<File>,
    /// Whether an end at the limit is one too early.
    endless: bool,
    cancel: Arc<AtomicBool>,
}

impl Read for InputFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(io::Error::other("reading was cancelled"));
        }
        let count = self.from.read(buffer)?;
        if count == 0 && !buffer.is_empty() && self.endless && self.from.limit() == 0 {
            return Err(too_large(MOST_STREAM_BYTES));
        }
        Ok(count)
    }
}

/// Opens the file at `path`.
///
/// # Errors
/// A file that cannot be opened; a folder; a pipe or device that the command line does not name; a file of more than
/// [`MOST_STREAM_BYTES`].
pub fn open(path: &Path) -> io::Result<InputFile> {
    let inputs = Inputs::current();
    // A pipe without a writer would keep the one who opens it waiting: what it is comes first.
    let identity = Identity::with(path, &path.metadata()?);
    let named = identity.as_ref().is_some_and(|file| inputs.named.contains(file));
    let file = if named {
        File::open(path)?
    } else {
        open_without_waiting(path)?
    };
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if !metadata.is_file() && !named {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is not a regular file; a pipe or device can be read only where the command line names it",
        ));
    }
    if metadata.len() > MOST_STREAM_BYTES {
        return Err(too_large(MOST_STREAM_BYTES));
    }
    let mut opened = inputs.opened.lock().unwrap_or_else(PoisonError::into_inner);
    opened.extend(Identity::with(path, &metadata));
    let mut states = inputs.states.lock().unwrap_or_else(PoisonError::into_inner);
    // Of a file that changes between two readings the first state is kept: it is not unchanged.
    states
        .entry(path.to_owned())
        .or_insert_with(|| FileState::of(path, &metadata));
    let endless = !metadata.is_file();
    let limit = if endless {
        MOST_STREAM_BYTES
    } else {
        metadata.len()
    };
    Ok(InputFile {
        from: file.take(limit),
        endless,
        cancel: Arc::clone(&inputs.cancel),
    })
}

/// The bytes of the file at `path`.
///
/// # Errors
/// Those of [`open`]; [`io::ErrorKind::FileTooLarge`] where it has more than [`MOST_BYTES`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    bytes_of(open(path)?)
}

/// All that `reader` gives.
///
/// # Errors
/// As of [`read`].
pub fn bytes_of(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(too_large(MOST_BYTES));
    }
    Ok(bytes)
}

/// The text of the file at `path`.
///
/// # Errors
/// As of [`read`], and bytes that are not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

fn too_large(most: u64) -> io::Error {
    let message = format!(
        "it has more than {} MiB: check that it is the right file",
        most >> 20
    );
    io::Error::new(io::ErrorKind::FileTooLarge, message)
}

/// Opens a file so that neither opening nor reading waits, even if it became a pipe meanwhile.
fn open_without_waiting(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    options.open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_the_largest_size_is_read_and_a_larger_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some");
        let file = File::create(&path).unwrap();
        // Holes take no room on the disk.
        file.set_len(MOST_BYTES).unwrap();
        assert_eq!(read(&path).unwrap().len() as u64, MOST_BYTES);
        file.set_len(MOST_BYTES + 1).unwrap();
        let refused = read(&path).unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::FileTooLarge);
        assert!(refused.to_string().contains("more than 64 MiB"), "{refused}");
        file.set_len(MOST_STREAM_BYTES + 1).unwrap();
        assert_eq!(open(&path).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
    }

    #[test]
    fn bytes_that_are_not_utf8_are_refused_as_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some");
        std::fs::write(&path, b"caf\xe9").unwrap();
        assert_eq!(read(&path).unwrap(), b"caf\xe9");
        assert_eq!(read_text(&path).unwrap_err().kind(), io::ErrorKind::InvalidData);
    }

    #[test]
    fn a_file_that_grows_while_it_is_read_ends_where_it_ended_when_it_was_opened() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        std::fs::write(&path, "one\n").unwrap();
        let mut file = open(&path).unwrap();
        std::fs::write(&path, "one\ntwo\n").unwrap();
        let mut text = String::new();
        file.read_to_string(&mut text).unwrap();
        assert_eq!(text, "one\n");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn files_that_the_kernel_makes_are_empty_and_devices_are_refused() {
        assert_eq!(read(Path::new("/proc/self/environ")).unwrap(), b"");
        for device in ["/dev/zero", "/dev/null"] {
            let refused = open(Path::new(device)).unwrap_err();
            assert!(refused.to_string().contains("not a regular file"), "{refused}");
        }
        assert_eq!(
            open(Path::new("/")).unwrap_err().kind(),
            io::ErrorKind::IsADirectory
        );
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_that_the_command_line_names_is_read_and_ends_at_the_limit() {
        let null = Path::new("/dev/null");
        let inputs = Inputs::naming([null, Path::new("no such file")]);
        assert_eq!(inputs.during(|| read(null)).unwrap(), b"");
        // Another device stays refused, and so does the same one afterwards.
        assert!(inputs.during(|| read(Path::new("/dev/zero"))).is_err());
        assert!(read(null).is_err());
        let zero = Path::new("/dev/zero");
        let endless = Inputs::naming([zero]).during(|| read(zero)).unwrap_err();
        assert_eq!(endless.kind(), io::ErrorKind::FileTooLarge);
        let mut file = Inputs::naming([zero]).during(|| open(zero)).unwrap();
        file.from.set_limit(3);
        let cut = file.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(cut.kind(), io::ErrorKind::FileTooLarge);
    }

    #[test]
    fn reading_ends_where_the_work_is_cancelled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        std::fs::write(&path, "one\ntwo\n").unwrap();
        let cancel = Arc::new(AtomicBool::new(false));
        let mut file = Inputs::cancelled_by(Arc::clone(&cancel))
            .during(|| open(&path))
            .unwrap();
        let mut line = [0; 4];
        file.read_exact(&mut line).unwrap();
        cancel.store(true, Ordering::Relaxed);
        let error = file.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(
            (&line, error.to_string()),
            (b"one\n", "reading was cancelled".to_owned())
        );
    }

    #[test]
    fn a_file_that_was_written_again_or_removed_is_not_unchanged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("path.csv");
        let inputs = Inputs::default();
        std::fs::write(&path, "1").unwrap();
        inputs.during(|| read(&path)).unwrap();
        assert!(inputs.are_unchanged());
        std::fs::write(&path, "12").unwrap();
        assert!(!inputs.are_unchanged());
        let inputs = Inputs::default();
        inputs.during(|| read(&path)).unwrap();
        assert!(inputs.are_unchanged());
        std::fs::remove_file(&path).unwrap();
        assert!(!inputs.are_unchanged());
    }

    #[test]
    fn an_opened_file_is_recognised_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("a"), folder.path().join("b"));
        std::fs::write(&path, "x").unwrap();
        std::fs::write(&other, "x").unwrap();
        let inputs = Inputs::default();
        inputs.during(|| read(&path)).unwrap();
        let same = folder.path().join(".").join("a");
        assert!(inputs.contains(&Identity::of(&same).unwrap()));
        assert!(!inputs.contains(&Identity::of(&other).unwrap()));
        #[cfg(unix)]
        {
            let link = folder.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            assert!(inputs.contains(&Identity::of(&link).unwrap()));
            let hard = folder.path().join("hard");
            std::fs::hard_link(&path, &hard).unwrap();
            assert!(inputs.contains(&Identity::of(&hard).unwrap()));
        }
    }
}
