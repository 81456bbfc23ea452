//! The list of files that armill made in a folder: `.armill-files`, a line a file.
//!
//! ```text
//! SHA-256 in hexadecimal <tab> command <tab> name
//! ```
//!
//! A line is added before its file takes its name, so that a run that is killed leaves no file that its next run does
//! not know. A name may have several lines until the list is rewritten: the file is ours if it agrees with one of them.
//! Lines of another form are passed over.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::error::FileError;
use super::part::write_atomically;
use crate::input;

/// The name of the list.
const LIST: &str = ".armill-files";

/// What a file was when armill made it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FileRecord {
    /// SHA-256 of its bytes, hexadecimal.
    pub sum: String,
    /// The command that made it.
    pub by: String,
}

/// The files that armill made in one folder.
#[derive(Debug)]
pub(super) struct Ledger {
    file: PathBuf,
    made: BTreeMap<String, Vec<FileRecord>>,
}

impl Ledger {
    /// The list of `folder`; empty where there is none that can be read.
    pub(super) fn of(folder: &Path) -> Ledger {
        let file = folder.join(LIST);
        let regular = file.symlink_metadata().is_ok_and(|found| found.is_file());
        let bytes = regular.then(|| File::open(&file).and_then(input::bytes_of).ok());
        let text = String::from_utf8_lossy(&bytes.flatten().unwrap_or_default()).into_owned();
        let mut made: BTreeMap<String, Vec<FileRecord>> = BTreeMap::new();
        for (name, one) in text.lines().filter_map(line) {
            made.entry(name).or_default().push(one);
        }
        Ledger { file, made }
    }

    /// Whether the file `path`, called `name` in this folder, is as armill made it.
    pub(super) fn is_ours(&self, name: &str, path: &Path) -> bool {
        let Some(made) = self.made.get(name) else {
            return false;
        };
        sum_of_file(path).is_ok_and(|sum| made.iter().any(|one| one.sum == sum))
    }

    /// Names of the files that `by` made, whether they were changed since or not.
    pub(super) fn made_by(&self, by: &str) -> Vec<String> {
        let of_command = |made: &[FileRecord]| made.iter().any(|one| one.by == by);
        let found = self.made.iter().filter(|(_, made)| of_command(made));
        found.map(|(name, _)| name.clone()).collect()
    }

    /// Adds a file that is about to take its name. A name that does not fit a line is not listed.
    ///
    /// # Errors
    /// The list cannot be written.
    pub(super) fn add(&mut self, name: &str, one: FileRecord) -> Result<(), FileError> {
        if !fits_a_line(name) {
            return Ok(());
        }
        let given = |source| FileError::of(&self.file, None, source);
        if self.file.is_symlink() {
            return Err(FileError::IsLink {
                path: self.file.clone(),
            });
        }
        let mut list = File::options()
            .append(true)
            .create(true)
            .open(&self.file)
            .map_err(given)?;
        // A line that was cut off by a full disk must not take this one with it.
        let text = format!("\n{}\t{}\t{name}\n", one.sum, one.by);
        list.write_all(text.as_bytes()).map_err(given)?;
        self.made.entry(name.to_owned()).or_default().push(one);
        Ok(())
    }

    /// Rewrites the list: the last line of each file that exists, without the files `gone`.
    ///
    /// # Errors
    /// The list cannot be written.
    pub(super) fn tidy(&mut self, folder: &Path, gone: &[String]) -> Result<(), FileError> {
        self.made
            .retain(|name, _| !gone.contains(name) && folder.join(name).is_file());
        for made in self.made.values_mut() {
            made.drain(..made.len() - 1);
        }
        let lines = self.made.iter().flat_map(|(name, made)| {
            made.iter()
                .map(move |one| format!("{}\t{}\t{name}\n", one.sum, one.by))
        });
        write_atomically(&self.file, lines.collect::<String>().as_bytes())
    }
}

/// Name and origin of a line; `None` of a line of another form.
fn line(text: &str) -> Option<(String, FileRecord)> {
    let mut parts = text.splitn(3, '\t');
    let (sum, by, name) = (parts.next()?, parts.next()?, parts.next()?);
    let made = FileRecord {
        sum: sum.to_owned(),
        by: by.to_owned(),
    };
    fits_a_line(name).then(|| (name.to_owned(), made))
}

/// Whether this is the name of a file of the same folder, on one line.
fn fits_a_line(name: &str) -> bool {
    let bare = Path::new(name).file_name().is_some_and(|file| file == name);
    bare && !name.contains(char::is_control)
}

/// SHA-256 of bytes, hexadecimal.
pub fn sum_of(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

fn sum_of_file(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let mut digest = Sha256::new();
    let mut block = vec![0; 1 << 16];
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hexadecimal(&digest.finalize())),
            count => digest.update(&block[..count]),
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn made(text: &str, by: &str) -> FileRecord {
        FileRecord {
            sum: sum_of(text.as_bytes()),
            by: by.to_owned(),
        }
    }

    #[test]
    fn a_sum_is_that_of_the_standard() {
        // FIPS 180-4, example of one block.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sum_of(b"abc"), abc);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let long = vec![7; (1 << 17) + 5];
        fs::write(&path, &long).unwrap();
        assert_eq!(sum_of_file(&path).unwrap(), sum_of(&long));
    }

    #[test]
    fn a_file_is_ours_until_it_is_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let mut ledger = Ledger::of(folder.path());
        ledger.add("a.csv", made("one", "run")).unwrap();
        assert!(!ledger.is_ours("a.csv", &path));
        fs::write(&path, "one").unwrap();
        assert!(Ledger::of(folder.path()).is_ours("a.csv", &path));
        // A run that was killed between the line and the name leaves the old file, which is still ours.
        ledger.add("a.csv", made("two", "run")).unwrap();
        assert!(Ledger::of(folder.path()).is_ours("a.csv", &path));
        fs::write(&path, "mine").unwrap();
        assert!(!Ledger::of(folder.path()).is_ours("a.csv", &path));
    }

    #[test]
    fn a_list_names_only_files_of_its_folder_and_accepts_any_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let text = "x\trun\tplate.csv\nx\trun\t../study.toml\nx\trun\t/etc/passwd\nx\trun\t..\n\nplate.csv\nx\trun\tsub/x\nx\trun\tcut";
        fs::write(folder.path().join(LIST), [text.as_bytes(), b"\xff\n"].concat()).unwrap();
        let ledger = Ledger::of(folder.path());
        let names: Vec<&String> = ledger.made.keys().collect();
        assert_eq!(names, ["cut\u{fffd}", "plate.csv"]);
        // A name that does not fit a line is not listed.
        let mut ledger = Ledger::of(folder.path());
        ledger.add("a\nb", made("x", "run")).unwrap();
        assert_eq!(Ledger::of(folder.path()).made.len(), 2);
    }

    #[test]
    fn a_tidy_list_has_one_line_for_each_file_that_exists() {
        let folder = tempfile::tempdir().unwrap();
        let mut ledger = Ledger::of(folder.path());
        for (name, text, by) in [
            ("b", "old", "run"),
            ("gone", "x", "run"),
            ("b", "new", "run"),
            ("a", "y", "place"),
        ] {
            ledger.add(name, made(text, by)).unwrap();
        }
        for (name, text) in [("a", "y"), ("b", "new"), ("stale", "z")] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        ledger.add("stale", made("z", "run")).unwrap();
        assert_eq!(ledger.made_by("run"), ["b", "gone", "stale"]);
        ledger.tidy(folder.path(), &["stale".to_owned()]).unwrap();
        let text = fs::read_to_string(folder.path().join(LIST)).unwrap();
        let expected = format!("{}\tplace\ta\n{}\trun\tb\n", sum_of(b"y"), sum_of(b"new"));
        assert_eq!(text, expected);
    }

    #[cfg(unix)]
    #[test]
    fn a_list_that_is_a_link_is_neither_read_nor_written() {
        let folder = tempfile::tempdir().unwrap();
        let other = tempfile::tempdir().unwrap();
        let list = other.path().join("list");
        let text = format!("{}\trun\ta\n", sum_of(b"mine"));
        fs::write(&list, &text).unwrap();
        fs::write(folder.path().join("a"), "mine").unwrap();
        std::os::unix::fs::symlink(&list, folder.path().join(LIST)).unwrap();
        let mut ledger = Ledger::of(folder.path());
        assert!(!ledger.is_ours("a", &folder.path().join("a")));
        let refused = ledger.add("b", made("x", "run")).unwrap_err();
        assert!(matches!(refused, FileError::IsLink { .. }), "{refused}");
        assert_eq!(fs::read_to_string(&list).unwrap(), text);
    }
}
