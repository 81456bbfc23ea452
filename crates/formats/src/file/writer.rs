//! What a command may replace and remove: the one guard that everything written goes through.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::error::{FileError, folder_of};
use super::ledger::{FileRecord, Ledger, sum_of};
use super::lock::Lock;
use super::part::{PartFile, create_folder, remove_abandoned, sync_folder, write_atomically};
use crate::input::{Identity, Inputs, real_path};

/// How long a file waits for another command that writes into the same folder.
const PATIENCE: Duration = Duration::from_secs(30);

/// The right of one command to write files.
///
/// It replaces a file that armill made and that was not changed since, with `force` any other file too, an input of the
/// command never. The inputs are those of the thread that makes it, see [`Inputs::during`].
#[derive(Clone, Debug)]
pub struct Writer {
    by: &'static str,
    force: bool,
    /// Whether what is written is armill's, to be replaced by later commands.
    lists: bool,
    /// Whether files that armill made are replaced without `force`.
    replaces: bool,
    inputs: Inputs,
}

impl Writer {
    /// That of the command `by`; `force`: replace files that are not ours.
    pub fn new(by: &'static str, force: bool) -> Writer {
        Writer {
            by,
            force,
            lists: true,
            replaces: true,
            inputs: Inputs::current(),
        }
    }

    /// One whose files belong to the user from the beginning, such as a new study: they are not listed as armill's.
    #[must_use]
    pub fn for_the_user(self) -> Writer {
        Writer { lists: false, ..self }
    }

    /// One that replaces no file without `force`, not even one that armill made: a robot file may be the only record of a
    /// measurement. A file that is there with the same bytes is done: a command that was killed after it can be repeated.
    #[must_use]
    pub fn for_new_files(self) -> Writer {
        Writer {
            replaces: false,
            ..self
        }
    }

    /// Writes one file. A device or pipe is written directly.
    ///
    /// # Errors
    /// A file that may not be replaced; the operation that failed. Then the old content is untouched.
    pub fn write(&self, path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FileError> {
        let path = path.as_ref();
        if self.is_done(path, bytes) {
            return Ok(());
        }
        let folder = folder_of(path);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        let is_file = path.metadata().map_or(true, |found| found.is_file());
        let (true, true, Some(name)) = (is_file, folder.is_dir(), name) else {
            return write_atomically(path, bytes);
        };
        // Where no lock or list can be made, as in a folder of all users, the file itself may be possible: it is not
        // listed.
        let lock = match Lock::of(&folder, self.by, PATIENCE) {
            Err(refused @ FileError::InUse { .. }) => return Err(refused),
            lock => lock.ok(),
        };
        let mut ledger = Ledger::of(&folder);
        self.allow(&ledger, &[(name.clone(), path.to_owned())])?;
        let part = PartFile::write(path, bytes)?;
        let listed = self.lists && lock.is_some() && ledger.add(&name, self.made(bytes)).is_ok();
        part.take_name()?;
        if listed {
            // The line is there already; it is one too many at worst.
            let _ = ledger.tidy(&folder, &[]);
        }
        sync_folder(&folder);
        Ok(())
    }

    /// Writes several files, or none of them where one may not be replaced.
    ///
    /// # Errors
    /// As of [`Writer::write`]; all files that may not be replaced are named.
    pub fn write_all(&self, files: &[(PathBuf, &[u8])]) -> Result<(), FileError> {
        let missing = || files.iter().filter(|(path, bytes)| !self.is_done(path, bytes));
        let mut refused = Vec::new();
        for (path, _) in missing() {
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            match self.allow(&Ledger::of(&folder_of(path)), &[(name, path.clone())]) {
                Err(FileError::NotOurs { paths } | FileError::Exists { paths }) => refused.extend(paths),
                other => other?,
            }
        }
        if !refused.is_empty() {
            return Err(self.refusing(refused));
        }
        missing().try_for_each(|(path, bytes)| self.write(path, bytes))
    }

    /// Takes a folder for results, makes it where it is missing, and clears what a killed run left half-written.
    ///
    /// # Errors
    /// A folder that another run writes into, or where nothing can be written.
    pub fn folder(&self, out: &Path) -> Result<ResultFolder, FileError> {
        create_folder(out)?;
        let lock = Lock::of(out, self.by, Duration::ZERO)?;
        remove_abandoned(out);
        Ok(ResultFolder {
            path: out.to_owned(),
            writer: self.clone(),
            state: Mutex::new(State {
                ledger: Ledger::of(out),
                allowed: BTreeSet::new(),
                written: BTreeMap::new(),
            }),
            _lock: lock,
        })
    }

    /// [`Writer::folder`] for the folder `name` of the study folder `root`, where the user did not choose one: a study
    /// from elsewhere must not choose where on this machine its results go.
    ///
    /// # Errors
    /// As of [`Writer::folder`]; a link that leads out of `root`, or nowhere.
    pub fn folder_in(&self, root: &Path, name: &str) -> Result<ResultFolder, FileError> {
        let path = root.join(name);
        let real = |path: &Path| real_path(&Path::new(".").join(path)).ok();
        // A link that leads nowhere is a link too.
        let is_inside = || {
            real(&path)
                .zip(real(root))
                .is_some_and(|(path, root)| path.starts_with(root))
        };
        if path.is_symlink() && !is_inside() {
            return Err(FileError::LeadsOut { path });
        }
        self.folder(&path)
    }

    /// Whether these files, each with its name in the folder of the list, may be written.
    fn allow(&self, ledger: &Ledger, files: &[(String, PathBuf)]) -> Result<(), FileError> {
        let mut refused = Vec::new();
        for (name, path) in files {
            if path.is_symlink() && path.metadata().map_or(true, |found| found.is_file()) {
                return Err(FileError::IsLink { path: path.clone() });
            }
            let Some(identity) = Identity::of(path) else {
                continue;
            };
            if self.inputs.contains(&identity) {
                return Err(FileError::IsInput { path: path.clone() });
            }
            let may_replace = self.replaces && ledger.is_ours(name, path);
            if path.is_file() && !self.force && !may_replace {
                refused.push(path.clone());
            }
        }
        match refused.is_empty() {
            true => Ok(()),
            false => Err(self.refusing(refused)),
        }
    }

    /// Whether this writer leaves the file as it is, because it has these bytes.
    fn is_done(&self, path: &Path, bytes: &[u8]) -> bool {
        let is_as_long = || {
            path.metadata()
                .is_ok_and(|found| found.is_file() && found.len() == bytes.len() as u64)
        };
        !self.replaces && is_as_long() && fs::read(path).is_ok_and(|found| found == bytes)
    }

    /// The error where these files may not be replaced.
    fn refusing(&self, paths: Vec<PathBuf>) -> FileError {
        match self.replaces {
            true => FileError::NotOurs { paths },
            false => FileError::Exists { paths },
        }
    }

    fn made(&self, bytes: &[u8]) -> FileRecord {
        FileRecord {
            sum: sum_of(bytes),
            by: self.by.to_owned(),
        }
    }
}

/// A folder for the results of one run, which no other run writes into until this is dropped.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
    writer: Writer,
    state: Mutex<State>,
    _lock: Lock,
}

#[derive(Debug)]
struct State {
    ledger: Ledger,
    /// Files that may be replaced, as was found before.
    allowed: BTreeSet<String>,
    /// Files that were written, with their SHA-256.
    written: BTreeMap<String, String>,
}

impl ResultFolder {
    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether all files of these names may be written.
    ///
    /// # Errors
    /// Files that may not be replaced, all together.
    pub fn allow<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<(), FileError> {
        let mut state = self.state();
        let new: Vec<(String, PathBuf)> = names
            .into_iter()
            .filter(|name| !state.allowed.contains(*name))
            .map(|name| (name.to_owned(), self.path.join(name)))
            .collect();
        self.writer.allow(&state.ledger, &new)?;
        state.allowed.extend(new.into_iter().map(|(name, _)| name));
        Ok(())
    }

    /// Writes a file.
    ///
    /// # Errors
    /// One that may not be replaced, or that cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        self.part(name, bytes)?.take_name()?;
        sync_folder(&self.path);
        Ok(())
    }

    /// Writes a file that takes its name later.
    ///
    /// # Errors
    /// As of [`ResultFolder::write`].
    pub fn part(&self, name: &str, bytes: &[u8]) -> Result<PartFile, FileError> {
        self.allow([name])?;
        let part = PartFile::write(self.path.join(name), bytes)?;
        let made = self.writer.made(bytes);
        let mut state = self.state();
        state.written.insert(name.to_owned(), made.sum.clone());
        state.ledger.add(name, made)?;
        Ok(part)
    }

    /// Writes a file that is kept until [`ResultFolder::finish`] alone, such as what a search has found so far.
    ///
    /// # Errors
    /// As of [`ResultFolder::write`].
    pub fn write_for_now(&self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        self.write(name, bytes)?;
        self.state().written.remove(name);
        Ok(())
    }

    /// The files that were written so far and are to stay, by name, with their SHA-256.
    pub fn written(&self) -> BTreeMap<String, String> {
        self.state().written.clone()
    }

    /// Removes a file if this command made it and it was not changed since.
    pub fn remove(&self, name: &str) {
        let mut state = self.state();
        state.written.remove(name);
        if state.ledger.made_by(self.writer.by).iter().any(|one| one == name) {
            self.remove_unchanged(&state.ledger, name);
        }
    }

    /// Removes a file that was not changed since it was made; whether it is gone.
    fn remove_unchanged(&self, ledger: &Ledger, name: &str) -> bool {
        let path = self.path.join(name);
        ledger.is_ours(name, &path) && fs::remove_file(path).is_ok()
    }

    /// Removes what earlier runs of this command made and this one did not, and rewrites the list of files.
    ///
    /// # Errors
    /// The list cannot be written.
    pub fn finish(&self) -> Result<(), FileError> {
        let mut state = self.state();
        let mut stale = state.ledger.made_by(self.writer.by);
        stale.retain(|name| !state.written.contains_key(name) && self.remove_unchanged(&state.ledger, name));
        state.ledger.tidy(&self.path, &stale)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input;

    const RUN: &str = "run";

    fn writer() -> Writer {
        Writer::new(RUN, false)
    }

    fn is_not_ours(result: Result<(), FileError>) -> bool {
        matches!(result, Err(FileError::NotOurs { .. }))
    }

    #[test]
    fn a_file_of_ours_is_kept_by_a_writer_for_new_files_unless_forced() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("robot.toml");
        Writer::new("calibrate", false).write(&file, b"first").unwrap();
        let careful = Writer::new("calibrate", false).for_new_files();
        let refused = careful.write(&file, b"second");
        assert!(matches!(refused, Err(FileError::Exists { .. })), "{refused:?}");
        assert_eq!(fs::read(&file).unwrap(), b"first");
        let forced = Writer::new("calibrate", true).for_new_files();
        forced.write(&file, b"second").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"second");
    }

    #[test]
    fn new_files_that_are_there_with_the_same_bytes_are_done() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let careful = Writer::new("learn", false).for_new_files();
        let files = [(at("residuals.csv"), &b"1,2"[..]), (at("robot.toml"), b"name")];
        // As a command leaves it that was killed after the first.
        careful.write(&files[0].0, files[0].1).unwrap();
        careful.write_all(&files).unwrap();
        assert_eq!(fs::read(at("robot.toml")).unwrap(), b"name");
        careful.write_all(&files).unwrap();
        let others = [(at("residuals.csv"), &b"3,4"[..]), (at("robot.toml"), b"eman")];
        match careful.write_all(&others).unwrap_err() {
            FileError::Exists { paths } => assert_eq!(paths, [at("residuals.csv"), at("robot.toml")]),
            other => panic!("{other}"),
        }
        assert_eq!(fs::read(at("residuals.csv")).unwrap(), b"1,2");
    }

    #[test]
    fn a_file_of_the_user_is_replaced_by_force_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        fs::write(&path, "mine").unwrap();
        let error = writer().write(&path, b"x").unwrap_err();
        assert!(
            error.to_string().contains("a.csv") && error.to_string().contains("--force"),
            "{error}"
        );
        assert_eq!(fs::read(&path).unwrap(), b"mine");
        assert!(!folder.path().join(".armill-lock").exists());
        Writer::new(RUN, true).write(&path, b"x").unwrap();
        // Now it is ours, until it is changed.
        writer().write(&path, b"y").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"y");
        fs::write(&path, "filled in").unwrap();
        assert!(is_not_ours(writer().write(&path, b"z")));
    }

    #[test]
    fn a_file_that_is_made_for_the_user_is_the_users() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.toml");
        let new = Writer::new("new", false).for_the_user();
        new.write(&path, b"x").unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(is_not_ours(new.write(&path, b"x")) && is_not_ours(writer().write(&path, b"x")));
    }

    #[test]
    fn an_input_of_the_command_is_not_replaced_even_by_force() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        writer().write(&path, b"x").unwrap();
        Inputs::default().during(|| {
            let writer = Writer::new(RUN, true);
            writer.write(&path, b"y").unwrap();
            input::read(&path).unwrap();
            let error = writer.write(&path, b"z").unwrap_err();
            assert!(matches!(error, FileError::IsInput { .. }), "{error}");
            let folder = writer.folder(folder.path()).unwrap();
            assert!(folder.write("a.csv", b"z").is_err());
        });
        assert_eq!(fs::read(&path).unwrap(), b"y");
        // The next command may.
        writer().write(&path, b"z").unwrap();
    }

    #[test]
    fn of_several_files_none_is_written_where_one_may_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("b"), "mine").unwrap();
        fs::write(at("c"), "mine").unwrap();
        let files = [(at("a"), &b"x"[..]), (at("b"), b"x"), (at("c"), b"x")];
        match writer().write_all(&files).unwrap_err() {
            FileError::NotOurs { paths } => assert_eq!(paths, [at("b"), at("c")]),
            other => panic!("{other}"),
        }
        assert!(!at("a").exists());
        Writer::new(RUN, true).write_all(&files).unwrap();
        assert_eq!(fs::read(at("c")).unwrap(), b"x");
    }

    #[test]
    fn a_run_removes_what_it_made_earlier_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("photo.png"), "mine").unwrap();
        Writer::new("place", false)
            .write(at("other.csv"), b"other")
            .unwrap();
        let first = writer().folder(folder.path()).unwrap();
        for name in ["a.csv", "b.csv", "c.csv"] {
            first.write(name, b"first").unwrap();
        }
        first.finish().unwrap();
        drop(first);
        fs::write(at("b.csv"), "changed").unwrap();
        let second = writer().folder(folder.path()).unwrap();
        second.write("a.csv", b"second").unwrap();
        second.write_for_now("rounds", b"some").unwrap();
        assert!(at("rounds").is_file());
        assert_eq!(second.written().into_keys().collect::<Vec<_>>(), ["a.csv"]);
        second.finish().unwrap();
        drop(second);
        let mut names: Vec<String> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(
            names,
            [".armill-files", "a.csv", "b.csv", "other.csv", "photo.png"]
        );
        let third = writer().folder(folder.path()).unwrap();
        match third
            .allow(["a.csv", "b.csv", "other.csv", "photo.png", "new"])
            .unwrap_err()
        {
            FileError::NotOurs { paths } => assert_eq!(paths, [at("b.csv"), at("photo.png")]),
            other => panic!("{other}"),
        }
        third.remove("a.csv");
        third.remove("other.csv");
        third.remove("photo.png");
        assert!(!at("a.csv").exists() && at("other.csv").exists() && at("photo.png").exists());
    }

    #[test]
    fn a_second_run_into_the_same_folder_is_refused_while_the_first_writes() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let first = writer().folder(&out).unwrap();
        let error = Writer::new("place", false).folder(&out).unwrap_err();
        assert!(error.to_string().contains("armill run, process"), "{error}");
        drop(first);
        assert!(Writer::new("place", false).folder(&out).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn the_usual_folder_does_not_lead_out_of_that_of_the_study() {
        use std::os::unix::fs::symlink;
        let (study, outer) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let root = study.path();
        symlink(outer.path(), root.join("out")).unwrap();
        symlink("nowhere", root.join("place")).unwrap();
        fs::create_dir(root.join("results")).unwrap();
        symlink("results", root.join("posture")).unwrap();
        for name in ["out", "place"] {
            let error = writer().folder_in(root, name).unwrap_err();
            assert!(matches!(error, FileError::LeadsOut { .. }), "{error}");
        }
        for name in ["posture", "advice"] {
            writer().folder_in(root, name).unwrap().write("a", b"x").unwrap();
        }
        assert!(root.join("results/a").is_file() && fs::read_dir(outer.path()).unwrap().next().is_none());
        // Named by the user it is followed.
        assert!(writer().folder(&root.join("out")).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_never_followed_but_to_devices() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("precious"), "mine").unwrap();
        symlink("precious", at("link")).unwrap();
        symlink("nowhere", at("dangling")).unwrap();
        symlink("/dev/null", at("null")).unwrap();
        for force in [false, true] {
            let writer = Writer::new(RUN, force);
            for name in ["link", "dangling"] {
                let error = writer.write(at(name), b"x").unwrap_err();
                assert!(matches!(error, FileError::IsLink { .. }), "{error}");
                let results = writer.folder(folder.path()).unwrap();
                assert!(matches!(results.write(name, b"x"), Err(FileError::IsLink { .. })));
            }
            writer.write(at("null"), b"x").unwrap();
        }
        assert_eq!(fs::read(at("precious")).unwrap(), b"mine");
        assert!(!at("nowhere").exists() && at("null").is_symlink());
    }
}
