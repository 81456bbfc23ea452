//! `armill new`: a commented study that runs.
//!
//! Its text comes from [`armill_study::new`] by `--robot`, or all files of an example from [`armill_study::library`]; here
//! they go into `DIR`, never over one that is there. Stderr says what to do next; stdout is empty, or holds the paths as
//! JSON.

use std::path::Path;

use armill_formats::file::{create_folder, write_atomically};
use armill_study::new::{Compliances, MadeStudy, new_study};
use armill_study::{StudyError, library};

use crate::Outcome;
use crate::arguments::NewArguments;
use crate::terminal::{print, say};

/// Makes the folder and the study in it.
///
/// # Errors
/// No such robot or example; a file that is there already; a place where nothing can be written.
pub(crate) fn run(arguments: &NewArguments) -> Result<Outcome, StudyError> {
    let (files, first) = match &arguments.example {
        Some(name) => {
            let files = library::example(name)?;
            let texts = files.into_iter().map(|(name, file)| (name, file.text.to_owned()));
            (texts.collect(), "look at it")
        }
        None => {
            let made = new_study(&arguments.robot)?;
            let first = match made.compliances {
                Compliances::Missing => "fill in its joint compliances",
                Compliances::Known | Compliances::Assumed => "edit it",
            };
            (vec![("study.toml", made.text)], first)
        }
    };
    let mut made = written(&arguments.dir, files)?.into_iter();
    let study = made.next().unwrap_or_default();
    let told = format!(
        "made {study}; {first}, then: armill run {}",
        arguments.dir.display()
    );
    if arguments.json {
        let beside = made.collect();
        print(&serde_json::to_string(&MadeStudy { study, beside })?)?;
    }
    say(&told);
    Ok(Outcome::Fine)
}

/// Writes these files, or none of them, and gives their paths.
fn written(folder: &Path, files: Vec<(&str, String)>) -> Result<Vec<String>, StudyError> {
    let paths: Vec<_> = files.iter().map(|(name, _)| folder.join(name)).collect();
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        let message = format!("{} exists already", there.display());
        return Err(StudyError::value(
            message,
            "choose another folder: armill never overwrites a study",
        ));
    }
    create_folder(folder)?;
    for (path, (_, text)) in paths.iter().zip(&files) {
        write_atomically(path, text.as_bytes())?;
    }
    Ok(paths.iter().map(|path| path.display().to_string()).collect())
}
