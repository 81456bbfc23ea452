//! Runs a robot program.

use std::path::Path;

use crate::event::Event;
use crate::log::Log;
use crate::source::{ReplayError, SourceFile};
use crate::{inform, krl, rapid, tp, urscript, val3};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// KUKA.
    Krl,
    /// ABB.
    Rapid,
    /// Yaskawa.
    Inform,
    /// FANUC.
    Tp,
    /// Universal Robots.
    UrScript,
    /// Staubli.
    Val3,
}

/// The events of a program.
///
/// `files` are names and texts; `main` is the name of the program that is started.
///
/// # Errors
/// The first statement that is not known, with its file and line.
pub fn run<N: AsRef<str>, T: AsRef<str>>(
    language: Language,
    files: &[(N, T)],
    main: &str,
) -> Result<Vec<Event>, ReplayError> {
    let files: Vec<SourceFile> = files
        .iter()
        .map(|(name, text)| SourceFile::new(name.as_ref(), text.as_ref()))
        .collect();
    let log = Log::default();
    let log = match language {
        Language::Krl => krl::run(&files, main, log),
        Language::Rapid => rapid::run(&files, main, log),
        Language::Inform => inform::run(&files, main, log),
        Language::Tp => tp::run(&files, main, log),
        Language::UrScript => urscript::run(&files, main, log),
        Language::Val3 => val3::run(&files, main, log),
    };
    Ok(log?.into_events())
}

/// The events of the program of a folder, of all files of its language in it.
///
/// # Errors
/// As [`run`].
pub fn run_folder(language: Language, folder: &Path, main: &str) -> Result<Vec<Event>, ReplayError> {
    let extensions: &[&str] = match language {
        Language::Krl => &["src", "dat"],
        Language::Rapid => &["mod", "sys"],
        Language::Inform => &["jbi"],
        Language::Tp => &["ls"],
        Language::UrScript => &["script"],
        Language::Val3 => &["pjx", "pgx", "dtx"],
    };
    let mut files: Vec<(String, String)> = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let extension = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        if extensions.contains(&extension.as_str()) {
            let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
            files.push((name, text));
        }
    }
    files.sort();
    run(language, &files, main)
}
