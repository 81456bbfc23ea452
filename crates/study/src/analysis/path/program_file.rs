//! The file of a program: its language, and how it is read.

use std::io::Read;
use std::path::{Path, PathBuf};

use armill_core::path::{Sampling, TooManyPoints};
use armill_formats::input;
use armill_formats::toolpath::format::{Format, HEAD_BYTES};
use armill_programs::Language;

use crate::input::problem_log::ProblemLog;

/// Most points of a program: limited by the memory of a study.
pub const MOST_POINTS: usize = 8_000_000;
/// Hint for a file that is not found.
pub const FILE_HINT: &str = "paths are relative to the folder of the study";

/// The file of a program, and how it is read.
pub struct ProgramFile<'a> {
    /// Its path.
    pub path: PathBuf,
    /// That of the study.
    pub folder: &'a Path,
    /// Resolution of its points.
    pub sampling: Sampling,
}

impl ProgramFile<'_> {
    /// The robot language of the program, if it is a robot program; `None` if it cannot be read, reported at its key.
    pub fn robot_language(&self, log: &mut ProblemLog<'_>) -> Option<Option<Language>> {
        if self.path.is_dir() {
            // A project of VAL3 is a folder.
            let is_project = |name: &str| Path::new(name).extension().is_some_and(|ending| ending == "pjx");
            let entries = std::fs::read_dir(&self.path).into_iter().flatten().flatten();
            let mut names = entries.map(|entry| entry.file_name().to_string_lossy().to_lowercase());
            if names.any(|name| is_project(&name)) {
                return Some(Some(Language::Val3));
            }
            let message = format!("{} is a folder", self.path.display());
            log.problem("program.file", message, "name the file in it");
            return None;
        }
        let mut head = Vec::new();
        let read = input::open(&self.path).and_then(|file| file.take(HEAD_BYTES).read_to_end(&mut head));
        if let Err(error) = read {
            let message = format!("cannot read {}: {error}", self.path.display());
            log.problem("program.file", message, FILE_HINT);
            return None;
        }
        match Format::of(&self.path, &String::from_utf8_lossy(&head)) {
            Ok(Format::Robot(language)) => Some(Some(language)),
            // What is none at all its reader says.
            _ => Some(None),
        }
    }

    /// Reports a program with more points than fit into memory.
    pub fn too_many(&self, log: &mut ProblemLog<'_>, error: TooManyPoints) {
        let message = format!("{} gives {error}", self.path.display());
        log.problem(
            "program.step_mm",
            message,
            "use a larger step, or split the program",
        );
    }
}
