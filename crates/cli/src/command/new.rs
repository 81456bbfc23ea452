//! `armill new`: a commented study that runs.
//!
//! The text comes from [`armill_study::new`] by `--robot`; here it goes into `DIR/study.toml`, never over one that is
//! there. Stderr says what to do next; stdout is empty, or holds the path as JSON.

use armill_formats::file::{create_folder, write_atomically};
use armill_study::StudyError;
use armill_study::new::{Compliances, MadeStudy, new_study};

use crate::Outcome;
use crate::arguments::NewArguments;
use crate::terminal::{print, say};

/// Makes the folder and the study in it.
///
/// # Errors
/// No such robot; a study that is there already; a place where nothing can be written.
pub(crate) fn run(arguments: &NewArguments) -> Result<Outcome, StudyError> {
    let made = new_study(&arguments.robot)?;
    let path = arguments.dir.join("study.toml");
    if path.exists() {
        let message = format!("{} exists already", path.display());
        return Err(StudyError::value(
            message,
            "choose another folder: armill never overwrites a study",
        ));
    }
    create_folder(&arguments.dir)?;
    write_atomically(&path, made.text.as_bytes())?;
    let study = path.display().to_string();
    let first = match made.compliances {
        Compliances::Missing => "fill in its joint compliances",
        Compliances::Known | Compliances::Assumed => "edit it",
    };
    let told = format!(
        "made {study}; {first}, then: armill run {}",
        arguments.dir.display()
    );
    if arguments.json {
        print(&serde_json::to_string(&MadeStudy { study })?)?;
    }
    say(&told);
    Ok(Outcome::Fine)
}
