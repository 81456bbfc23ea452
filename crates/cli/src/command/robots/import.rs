//! `armill robots import`: converts a robot file of another format, or copies one of the library for editing.
//!
//! The file goes to `--out`, or to stdout; with `--json` stdout has an [`ImportedRobot`]. Stderr reports what was
//! assumed and what is missing. A file that could not be read again is not written.

use std::path::Path;

use armill_formats::robot::format::RobotReadOptions;
use armill_formats::robot::{RobotDescription, armill};
use armill_study::robot_answers::ImportedRobot;
use armill_study::{StudyError, library, robots};

use crate::arguments::ImportArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads the foreign file, writes it in the format of armill, and reads the result again as a check.
///
/// # Errors
/// A file that must not be replaced; an unknown format; the problems of the file; a file that
/// cannot be written.
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
            .for_new_files()
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

/// The robot, and the text of its file: for a library robot its own text, with its comments.
fn source(arguments: &ImportArguments) -> Result<(RobotDescription, String), StudyError> {
    let file = &arguments.file;
    let name = file.to_string_lossy();
    if !file.exists() && library::robot(&name).is_some() {
        let found = robots::find(&name, Path::new("."))?;
        let [_, text] = robots::text_of(&name, &found)?;
        return Ok((found, text));
    }
    let requested = RobotReadOptions {
        format: arguments.format,
        tip: arguments.tip.clone(),
    };
    let found = robots::import(file, &requested)?;
    let text = armill::write(&found);
    Ok((found, text))
}

/// Notes on the imported robot.
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
        format!("created {file}; compare it with the pendant: armill pose {file} --joints-deg ...")
    }));
    lines
}
