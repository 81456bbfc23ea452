//! `armill ballbar`: circularity and its causes, from ball-bar files.
//!
//! Stdout has the answer of `armill_measure::ballbar`, as text or JSON; `--out` receives it with tables, pictures and a
//! report, `--teach` the points of the corrected circle, `--program` a robot program of it.
//!
//! `text` formats the result.

mod text;

use std::path::PathBuf;

use armill_measure::ballbar::{
    BallbarAnalysis, TaughtAnswer, TaughtCircle, analyse, answer, before, output, points_within,
    taught_program, teach,
};
use armill_programs::Written;
use armill_study::StudyError;
use armill_study::measured::circular_test::read;
use armill_study::studies;

use super::program::{self, save};
use crate::arguments::BallbarArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads, analyses, writes the requested files and prints the result.
///
/// # Errors
/// Files that cannot be read, or their problems; invalid options; files that cannot be written.
pub(crate) fn run(arguments: &BallbarArguments) -> Result<Outcome, StudyError> {
    let (requested, question) = (arguments.file_options()?, arguments.question()?);
    let measured = read(&arguments.files, &requested)?;
    let found = analyse(&measured, &question)?;
    let mut answer = answer(&question, &found);
    if !arguments.before.is_empty() {
        let first = read(&arguments.before, &requested)?;
        let shown = analyse(&first, &question)?;
        answer.before = Some(before(&shown, &found)?);
    }
    let taught = taught(arguments, &found)?;
    let table = match &taught {
        None => None,
        Some((given, circle, _)) => {
            answer.warnings.extend(given.warnings(arguments.teach_lobes));
            answer.taught = Some(given.clone());
            Some(circle.csv()?)
        }
    };
    let writer = arguments.writing.writer("ballbar");
    if let Some(out) = &arguments.out {
        let out = writer.folder(out)?;
        output::write(&answer, &found, &out, table.as_deref())?;
        say(&format!(
            "tables, pictures and report in {}",
            out.path().display()
        ));
    }
    // Last, so that no points are written if the folder cannot be written.
    if let (Some(file), Some(table)) = (&arguments.teach, &table) {
        writer.write(file, table)?;
        say(&format!("corrected points in {}", file.display()));
    }
    if let Some((_, _, Some((folder, written)))) = &taught {
        save(&writer, folder, written)?;
    }
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        text::as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// A program and its folder.
type Program = (PathBuf, Written);

/// The corrected circle, if requested, and its program.
fn taught(
    arguments: &BallbarArguments,
    found: &BallbarAnalysis<'_>,
) -> Result<Option<(TaughtAnswer, TaughtCircle, Option<Program>)>, StudyError> {
    let measured = found.measured;
    let file_feed = measured.feed.map(|feed| feed * 60e3);
    let program = program::requested(&arguments.program, arguments.feed_mm_per_min.or(file_feed))?;
    if arguments.teach.is_none() && program.is_none() {
        return Ok(None);
    }
    let radius = measured.test.radius();
    let needed = program
        .as_ref()
        .map(|(_, requested)| points_within(radius, requested.within));
    let points = arguments.point_count(needed)?;
    let (given, circle) = teach(found, points, arguments.teach_lobes)?;
    let Some((folder, requested)) = program else {
        return Ok(Some((given, circle, None)));
    };
    let Some(study) = &arguments.study else {
        return Err(StudyError::value(
            "--program requires a study that gives the circle and the robot",
            "--study STUDY",
        ));
    };
    let place = arguments.placement()?;
    let study = studies::find(study)?.read()?;
    let written = taught_program(&study, &circle, &place, &requested)?;
    Ok(Some((given, circle, Some((folder, written)))))
}
