//! Many files in one folder: made on all threads and flushed to disk at the same time.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};

use armill_formats::file::{FileError, PartFile, ResultFolder, sync_folder};

use crate::error::StudyError;

/// Threads that wait for the disk: enough that a small file need not wait for a large one.
const WAITING: usize = 4;
/// Files that are written and wait for their name at most: each is open, and systems allow some hundred.
const QUEUE: usize = 64;

/// A folder that accepts files from any thread.
pub struct Folder<'a> {
    out: &'a ResultFolder,
    /// To the threads that name files; `None` on WASI, where the program has no threads for them and no disk to wait for.
    queue: Option<SyncSender<(String, PartFile)>>,
    note: &'a (dyn Fn(&str) + Sync),
}

impl Folder<'_> {
    /// Writes a file under a temporary name; it is renamed soon after.
    ///
    /// # Errors
    /// The file cannot be written; one that cannot be renamed is reported when all are written.
    pub fn save(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        let part = self.out.part(name, bytes)?;
        match &self.queue {
            // The other end is open as long as this one.
            Some(queue) => drop(queue.send((name.to_owned(), part))),
            None => {
                part.take_name()?;
                (self.note)(name);
            }
        }
        Ok(())
    }
}

/// Runs `work`, which saves files into `out`; when this returns they have their names. `note` receives each name.
///
/// # Errors
/// That of `work`; or of the first file, by name, that could not be written.
pub(super) fn write_together(
    out: &ResultFolder,
    note: &(dyn Fn(&str) + Sync),
    work: impl FnOnce(&Folder<'_>) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    if cfg!(target_os = "wasi") {
        let queue = None;
        return work(&Folder { out, queue, note });
    }
    let (queue, waiting) = sync_channel(QUEUE);
    let waiting = Mutex::new(waiting);
    let (worked, refused) = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..WAITING)
            .map(|_| scope.spawn(|| name_all(&waiting, note)))
            .collect();
        let queue = Some(queue);
        let worked = work(&Folder { out, queue, note });
        let refused = threads
            .into_iter()
            .flat_map(|thread| thread.join().unwrap_or_default());
        (worked, refused.min_by(|a, b| a.0.cmp(&b.0)))
    });
    sync_folder(out.path());
    worked?;
    refused.map_or(Ok(()), |(_, error)| Err(error.into()))
}

/// Renames files until no more arrive; returns those that could not be renamed, with the reason.
fn name_all(
    waiting: &Mutex<Receiver<(String, PartFile)>>,
    note: &(dyn Fn(&str) + Sync),
) -> Vec<(String, FileError)> {
    let mut refused = Vec::new();
    loop {
        let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok((name, part)) = next else { return refused };
        match part.take_name() {
            Ok(()) => note(&name),
            Err(error) => refused.push((name, error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use armill_formats::file::Writer;

    use super::*;

    #[test]
    fn reports_the_first_by_name_of_the_files_that_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let said = |name: &str| {
            let part = PartFile::write(folder.path().join(name), b"x").unwrap();
            std::fs::create_dir(folder.path().join(name)).unwrap();
            part
        };
        let (b, a) = (said("b"), said("a"));
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let error = write_together(&out, &|_| (), |files| {
            let queue = files.queue.as_ref().unwrap();
            queue.send(("b".to_owned(), b)).unwrap();
            queue.send(("a".to_owned(), a)).unwrap();
            files.save("c", b"whole")
        });
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains(&*folder.path().join("a").to_string_lossy()),
            "{error}"
        );
        assert_eq!(std::fs::read(folder.path().join("c")).unwrap(), b"whole");
    }
}
