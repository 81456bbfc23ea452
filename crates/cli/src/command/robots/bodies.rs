//! `armill robots bodies`: capsules around the collision meshes of a robot, as tables of a robot file.
//!
//! The tables go to `--out`, or to stdout; with `--json` stdout has an [`EnclosedLinksAnswer`](armill_study::enclosed_links::EnclosedLinksAnswer).
//! Stderr reports how near the capsules come to the links.

use armill_formats::robot::armill;
use armill_study::StudyError;
use armill_study::enclosed_links::EnclosedLinks;

use crate::arguments::BodiesArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Encloses the links, and writes the tables.
///
/// # Errors
/// A file that must not be replaced; the problems of the robot and of its meshes; a robot without meshes; a file that cannot be written.
pub(super) fn run(arguments: &BodiesArguments) -> Result<Outcome, StudyError> {
    let found = EnclosedLinks::of(&arguments.file, arguments.capsules)?;
    let text = armill::body_tables(&found.robot);
    let shown = arguments.out.as_ref().map(|path| path.display().to_string());
    if let Some(path) = &arguments.out {
        arguments
            .writing
            .writer("robots bodies")
            .for_new_files()
            .write(path, text.as_bytes())?;
    }
    if arguments.json {
        print(&serde_json::to_string(&found.answer(shown.clone(), &text))?)?;
    } else if shown.is_none() {
        print(text.trim_end())?;
    }
    let notes = found.robot.body_notes.iter();
    let largest = notes.filter_map(|note| note.accuracy_mm).fold(0.0, f64::max);
    let ratio = match found.volume_ratio {
        Some(ratio) => format!("{ratio:.2} times the volume of the meshes"),
        None => "an open mesh has no volume".to_owned(),
    };
    say(&format!(
        "{}: {} capsules, no farther than {largest} mm from the links; {ratio}",
        found.robot.title,
        found.robot.bodies.len()
    ));
    if let Some(file) = shown {
        say(&format!("created {file}: append it to the robot file"));
    }
    Ok(Outcome::Fine)
}
