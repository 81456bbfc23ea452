//! `armill robots bodies`: capsules around the collision meshes of a robot, as tables of a robot file.
//!
//! The tables go to `--out`, or to stdout; with `--json` stdout has an [`EnclosedLinksAnswer`](armill_study::enclosed_links::EnclosedLinksAnswer).
//! Stderr reports how near the capsules come to the links.

use armill_formats::robot::armill;
use armill_study::StudyError;
use armill_study::enclosed_links::EnclosedLinks;

use super::tables::TablesOutput;
use crate::arguments::BodiesArguments;
use crate::outcome::Outcome;

/// Encloses the links, and writes the tables.
///
/// # Errors
/// A file that must not be replaced; the problems of the robot and of its meshes; a robot without meshes; a file that cannot be written.
pub(super) fn run(arguments: &BodiesArguments) -> Result<Outcome, StudyError> {
    let found = EnclosedLinks::of(&arguments.file, arguments.capsules)?;
    let text = armill::body_tables(&found.robot);
    let notes = found.robot.body_notes.iter();
    let largest = notes.filter_map(|note| note.accuracy_mm).fold(0.0, f64::max);
    let ratio = match found.volume_ratio {
        Some(ratio) => format!("{ratio:.2} times the volume of the meshes"),
        None => "an open mesh has no volume".to_owned(),
    };
    TablesOutput {
        command: "robots bodies",
        file: arguments.out.as_ref(),
        writing: &arguments.writing,
        json: arguments.json,
    }
    .write(
        &text,
        |file| found.answer(file, &text),
        &format!(
            "{}: {} capsules, no farther than {largest} mm from the links; {ratio}",
            found.robot.title,
            found.robot.bodies.len()
        ),
    )?;
    Ok(Outcome::Fine)
}
