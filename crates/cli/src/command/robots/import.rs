//! `armill robots import`: a robot file of ours from one of another format, or from the library, to be changed.
//!
//! The file goes to `--out`, or to stdout; with `--json` stdout holds an [`ImportedRobot`]. Stderr says what was assumed and
//! what is missing. What cannot be read again is not written.

use std::path::Path;

use armill_formats::robot::RobotDescription;
use armill_formats::robot::armill;
use armill_formats::robot::format::Wanted;
use armill_study::robot_answers::ImportedRobot;
use armill_study::{StudyError, library, robots};

use crate::Outcome;
use crate::arguments::ImportArguments;
use crate::terminal::{print, say};

/// Reads the foreign file, writes it as ours, and reads that again before it is kept.
///
/// # Errors
/// A file that may not be replaced; a format that is not known; the problems of the file; a place where
/// nothing can be written.
pub(super) fn run(arguments: &ImportArguments) -> Result<Outcome, StudyError> {
    let out = arguments.out.as_deref();
    let (found, text) = source(arguments)?;
    let shown = out.map(|path| path.display().to_string());
    armill::read(
        shown.as_deref().unwrap_or("imported robot"),
        found.robot.name(),
        &text,
    )?;
    if let Some(path) = out {
        arguments
            .writing
            .writer("robots import")
            .write(path, text.as_bytes())?;
    }
    if arguments.json {
        let answer = ImportedRobot::of(&found, shown.clone(), &text);
        print(&serde_json::to_string(&answer)?)?;
    } else if out.is_none() {
        print(text.trim_end())?;
    }
    for line in summary(&found, shown.as_deref()) {
        say(&line);
    }
    Ok(Outcome::Fine)
}

/// The robot, and the text of its file: of the library as it stands there, with its comments.
fn source(arguments: &ImportArguments) -> Result<(RobotDescription, String), StudyError> {
    let file = &arguments.file;
    let name = file.to_string_lossy();
    if !file.exists() && library::robot(&name).is_some() {
        let found = robots::find(&name, Path::new("."))?;
        let [_, text] = robots::text_of(&name, &found)?;
        return Ok((found, text));
    }
    let requested = Wanted {
        format: arguments.format,
        tip: arguments.tip.clone(),
    };
    let found = robots::import(file, &requested)?;
    let text = armill::write(&found);
    Ok((found, text))
}

/// What a user should know of the robot that was made.
fn summary(found: &RobotDescription, file: Option<&str>) -> Vec<String> {
    let count = found.robot.joints().len();
    let mut lines = vec![format!(
        "{}: {count} joints; inverse: {}",
        found.title,
        found.robot.inverse()
    )];
    lines.extend(found.remarks.iter().map(|remark| format!("assumed: {remark}")));
    if found.robot.compliance().is_none() {
        lines.push("missing: joint compliances; see the comments in the file".to_owned());
    }
    lines.extend(file.map(|file| {
        format!("made {file}; compare it with the pendant: armill pose {file} --joints-deg ...")
    }));
    lines
}
