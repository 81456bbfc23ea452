//! `armill tracker`: files of a laser tracker and of a controller as one table of poses.
//!
//! ```text
//! robot: poses
//! tool, base       distances of the reflectors, scatter, drift, misreadings
//! ```

use armill_measure::tracker::answer::BodyAnswer;
use armill_measure::tracker::{Files, JointUnit, TrackerAnswer, answer, table, together};
use armill_study::{StudyError, robots};

use crate::arguments::{JointUnitArgument, TrackerArguments};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads, writes the table and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of a file; a file that cannot be written.
pub(crate) fn run(arguments: &TrackerArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let base = match &arguments.base {
        None => None,
        Some(files) => Some(files.clone().try_into().map_err(|_| {
            StudyError::value(
                format!("--base: {} files are given", files.len()),
                "three files, one for each reflector: --base base1.txt,base2.txt,base3.txt",
            )
        })?),
    };
    let files = Files {
        measured: arguments.file.clone(),
        base,
        joints: arguments.joints.clone(),
        joint_unit: match arguments.joint_unit {
            JointUnitArgument::Deg => JointUnit::Degree,
            JointUnitArgument::Rad => JointUnit::Radian,
        },
    };
    let together = together(&found.robot, &files)?;
    let answer = answer(&found.robot, &together);
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    if let Some(file) = &arguments.out {
        let written = table(&found.robot, &together.poses);
        arguments
            .writing
            .writer("tracker")
            .write(file, written.as_bytes())?;
        say(&format!("table of poses in {}", file.display()));
    }
    Ok(Outcome::Fine)
}

fn as_text(answer: &TrackerAnswer) -> String {
    let orientations = if answer.has_orientations {
        "with"
    } else {
        "without"
    };
    let mut lines = vec![format!(
        "{}: {} poses, {orientations} orientations",
        answer.robot, answer.poses
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    for (name, body) in [("tool", &answer.tool), ("base", &answer.base)] {
        if let Some(body) = body {
            lines.push(String::new());
            lines.extend(body_text(name, body));
        }
    }
    if !answer.notes.is_empty() {
        lines.push(String::new());
    }
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn body_text(name: &str, body: &BodyAnswer) -> Vec<String> {
    let mut lines = vec![format!("{name:<8} distance mm   scatter um   drift um")];
    for (pair, label) in ["1-2", "1-3", "2-3"].iter().enumerate() {
        lines.push(format!(
            "{label:<8} {:>11.3} {:>12.1} {:>10.1}",
            body.distances_mm[pair], body.scatter_um[pair], body.drift_um[pair]
        ));
    }
    if let Some(um) = body.moved_um {
        lines.push(format!("moved in the frame of the tracker by up to {um} um"));
    }
    for one in &body.misread {
        lines.push(format!(
            "row {}: reflector {} is read {} mm from its place",
            one.row, one.reflector, one.distance_mm
        ));
    }
    if !body.undetermined_rows.is_empty() {
        let rows: Vec<String> = body.undetermined_rows.iter().map(usize::to_string).collect();
        lines.push(format!(
            "rows with more than one wrong reflector: {}",
            rows.join(", ")
        ));
    }
    lines
}
