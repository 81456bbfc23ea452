//! `armill new`: a commented study that runs.
//!
//! Its text is from [`armill_study::new`] for `--robot`, or all files of an example from [`armill_study::library`];
//! here they are written into `DIR`, all or none. Stderr reports the next steps; stdout is empty, or has the paths as
//! JSON.

use std::path::PathBuf;

use armill_formats::file::create_folder;
use armill_study::new::{Compliances, MadeStudy, new_study};
use armill_study::{StudyError, library};

use crate::arguments::NewArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Creates the folder and the study in it.
///
/// # Errors
/// No such robot or example; a file that already exists; a folder that cannot be written.
pub(crate) fn run(arguments: &NewArguments) -> Result<Outcome, StudyError> {
    let (files, first) = match &arguments.example {
        Some(name) => {
            let files = library::example(name)?;
            let texts = files.into_iter().map(|(name, file)| (name, file.text.to_owned()));
            (texts.collect(), "check it")
        }
        None => {
            let made = new_study(&arguments.robot, &arguments.dir)?;
            let first = match made.compliances {
                Compliances::Missing => "add its joint compliances",
                Compliances::Known | Compliances::Assumed => "edit it",
            };
            (vec![("study.toml", made.text)], first)
        }
    };
    let mut made = written(arguments, files)?.into_iter();
    let study = made.next().unwrap_or_default();
    let given = format!(
        "created {study}; {first}, then: armill run {}",
        arguments.dir.display()
    );
    if arguments.json {
        let files = made.collect();
        print(&serde_json::to_string(&MadeStudy { study, files })?)?;
    }
    say(&given);
    Ok(Outcome::Fine)
}

/// Writes all of these files or none, and returns their paths.
fn written(arguments: &NewArguments, files: Vec<(&str, String)>) -> Result<Vec<String>, StudyError> {
    let files: Vec<(PathBuf, &[u8])> = (files.iter())
        .map(|(name, text)| (arguments.dir.join(name), text.as_bytes()))
        .collect();
    create_folder(&arguments.dir)?;
    let writer = arguments.writing.writer("new").for_the_user();
    writer.write_all(&files)?;
    Ok(files.iter().map(|(path, _)| path.display().to_string()).collect())
}
