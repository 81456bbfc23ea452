//! `armill path-accuracy`: path accuracy and repeatability of the tip.
//!
//! ```text
//! path: file, points, runs
//! AT     largest and mean, where
//! RT     largest, where
//! ```
//!
//! Without a commanded path: RT of the passes in each direction, and how far the directions are apart.

use armill_measure::path_accuracy::{PathAccuracyAnswer, PlaceAnswer, answer, drawing, points, read};
use armill_measure::path_repeatability::{self, PathRepeatabilityAnswer};
use armill_study::StudyError;

use crate::arguments::PathAccuracyArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads, writes the requested files and prints the result.
///
/// # Errors
/// Files that cannot be read, or their problems; runs that do not match the path; a file that cannot be written.
pub(crate) fn run(arguments: &PathAccuracyArguments) -> Result<Outcome, StudyError> {
    let Some(commanded) = &arguments.commanded else {
        return of_passes(arguments);
    };
    let measured = read(commanded, &arguments.files)?;
    let (found, answer) = answer(&measured)?;
    let writer = arguments.writing.writer("path-accuracy");
    if let Some(file) = &arguments.points {
        writer.write(file, &points(&measured, &found)?)?;
        say(&format!("points in {}", file.display()));
    }
    if let Some(file) = &arguments.drawing {
        super::drawing::write(&writer, file, &drawing(&answer, &found))?;
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

/// The passes of a path of which nothing is commanded.
fn of_passes(arguments: &PathAccuracyArguments) -> Result<Outcome, StudyError> {
    let (files, passes) = path_repeatability::read(&arguments.files)?;
    let directions = path_repeatability::directions(&passes)?;
    let answer = path_repeatability::answer(&files, &directions);
    if let Some(file) = &arguments.drawing {
        let writer = arguments.writing.writer("path-accuracy");
        super::drawing::write(&writer, file, &path_repeatability::drawing(&directions))?;
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => passes_as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn passes_as_text(answer: &PathRepeatabilityAnswer) -> String {
    let mut lines = vec![format!("passes in {}", answer.files.join(", ")), String::new()];
    lines.extend(answer.directions.iter().map(|of| {
        let rt = match (of.rt_mm, of.rt_at_mm, of.rt_mean_mm) {
            (Some(rt), Some(at), Some(mean)) => {
                format!("RT {rt:.4} mm at {at:.1} mm; mean of all points {mean:.4} mm")
            }
            _ => "RT not known".to_owned(),
        };
        let passes = if of.cycles == 1 { "pass" } else { "passes" };
        format!(
            "{:<6} {} {passes} of {:.1} mm: {rt}",
            of.direction, of.cycles, of.length_mm
        )
    }));
    lines.extend(answer.apart.map(|apart| {
        format!(
            "apart  {:.4} mm at {:.1} mm: largest distance of the mean paths forth and back; mean {:.4} mm",
            apart.largest_mm, apart.at_mm, apart.mean_mm
        )
    }));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

fn as_text(answer: &PathAccuracyAnswer) -> String {
    let at = |place: &PlaceAnswer| {
        let [x, y, z] = place.commanded_mm;
        format!("at line {}, ({x:.3}, {y:.3}, {z:.3}) mm", place.line)
    };
    let runs = if answer.cycles == 1 { "run" } else { "runs" };
    let mut lines = vec![format!(
        "{}: {} points, {} {runs} in {}",
        answer.commanded,
        answer.points + answer.not_passed,
        answer.cycles,
        answer.files.join(", ")
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    lines.push(String::new());
    lines.push(format!(
        "AT   {:.4} mm {}; mean of all points {:.4} mm",
        answer.at_mm,
        at(&answer.at_worst),
        answer.at_mean_mm
    ));
    let both = answer.rt_mm.zip(answer.rt_worst.as_ref());
    lines.extend(both.map(|(rt, place)| format!("RT   {rt:.4} mm {}", at(place))));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}
