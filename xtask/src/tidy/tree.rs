//! The files of the repository: those that git tracks and those it would take with the next commit.
//!
//! Read once; rules share it and touch no disk. For the tests of a rule a tree is made of a few files in
//! memory.

use super::rust::{RustFile, is_test_path};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::{fs, io};

/// Paths from the repository root (with `/`), in order, each with its text.
pub struct Tree {
    /// No text where a file is not UTF-8: a picture, a font.
    files: BTreeMap<String, Option<String>>,
    /// The Rust files that ship, in the order of their paths.
    rust: Vec<RustFile>,
}

impl Tree {
    /// Reads the checkout at `root`; ignored files are not part of it.
    ///
    /// # Errors
    /// When git does not answer, a listed file cannot be read, or a Rust file is not Rust.
    pub fn read(root: &Path) -> io::Result<Self> {
        let mut git = Command::new("git");
        git.current_dir(root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
        let answer = git.output()?;
        if !answer.status.success() {
            return Err(io::Error::other(
                String::from_utf8_lossy(&answer.stderr).trim().to_owned(),
            ));
        }
        let mut files = BTreeMap::new();
        for path in String::from_utf8_lossy(&answer.stdout).split_terminator('\0') {
            let file = root.join(path);
            // Git still lists a file that was just deleted.
            if file.is_file() {
                files.insert(path.to_owned(), String::from_utf8(fs::read(file)?).ok());
            }
        }
        Self::with(files).map_err(io::Error::other)
    }

    /// A tree of these files, or the first that is not Rust.
    fn with(files: BTreeMap<String, Option<String>>) -> Result<Self, String> {
        let texts = files
            .iter()
            .filter(|(path, _)| path.ends_with(".rs") && !is_test_path(path));
        let texts = texts.filter_map(|(path, text)| Some((path, text.as_deref()?)));
        let rust: Result<Vec<_>, _> = texts.map(|(path, text)| RustFile::read(path, text)).collect();
        let mut rust = rust?;
        let declared_tests: BTreeSet<String> = rust.iter().flat_map(RustFile::test_files).collect();
        rust.retain(|file| !file.only_tests && !declared_tests.contains(&file.path));
        Ok(Self { files, rust })
    }

    /// All paths.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// All paths that are text, with their text.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files
            .iter()
            .filter_map(|(path, text)| Some((path.as_str(), text.as_deref()?)))
    }

    /// The texts whose path begins with `folder` (which ends in `/`, or is empty for all) and ends with
    /// `ending`.
    pub fn texts_in(&self, folder: &str, ending: &str) -> impl Iterator<Item = (&str, &str)> {
        self.texts()
            .filter(move |(path, _)| path.starts_with(folder) && path.ends_with(ending))
    }

    /// The text of the file at `path`, if it is there and is text.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path)?.as_deref()
    }

    /// Whether there is a file or a folder at `path`; the empty path is the root.
    pub fn has(&self, path: &str) -> bool {
        path.is_empty()
            || self.files.contains_key(path)
            || self
                .files
                .range(format!("{path}/")..)
                .next()
                .is_some_and(|(next, _)| next.strip_prefix(path).is_some_and(|rest| rest.starts_with('/')))
    }

    /// The names of the folders right inside `folder` (which ends in `/`, or is empty for the root).
    pub fn folders_in(&self, folder: &str) -> BTreeSet<&str> {
        self.paths()
            .filter_map(|path| Some(path.strip_prefix(folder)?.split_once('/')?.0))
            .collect()
    }

    /// The Rust files in `folder` that ship, that is, are not tests from their first line to their last.
    pub fn rust_files(&self, folder: &str) -> impl Iterator<Item = &RustFile> {
        self.rust.iter().filter(move |file| file.path.starts_with(folder))
    }
}

#[cfg(test)]
impl Tree {
    /// A made-up repository.
    pub fn of(files: &[(&str, &str)]) -> Self {
        let file = |(path, text): &(&str, &str)| ((*path).to_owned(), Some((*text).to_owned()));
        Self::with(files.iter().map(file).collect()).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_files_are_found_by_path() {
        let tree = Tree::of(&[("a/b/c.rs", ""), ("a/d.rs", ""), ("a-b/e.rs", "")]);
        assert!(tree.has("a/b") && tree.has("a/b/c.rs") && tree.has("a"));
        assert!(!tree.has("a/b/c") && !tree.has("b"));
        assert_eq!(tree.folders_in("a/"), BTreeSet::from(["b"]));
        assert_eq!(tree.folders_in(""), BTreeSet::from(["a", "a-b"]));
    }

    #[test]
    fn files_declared_as_tests_do_not_ship() {
        let tree = Tree::of(&[
            ("src/lib.rs", "mod real;\n#[cfg(test)]\nmod samples;\n"),
            ("src/real.rs", "#[cfg(test)]\nmod cases;\n"),
            ("src/real/cases.rs", ""),
            ("src/samples.rs", ""),
            ("tests/all.rs", ""),
        ]);
        let shipped: Vec<&str> = tree.rust_files("").map(|file| file.path.as_str()).collect();
        assert_eq!(shipped, ["src/lib.rs", "src/real.rs"]);
    }
}
