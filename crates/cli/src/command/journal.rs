//! `armill journal`: what all measurements of an arm say of it.
//!
//! ```text
//! robot: journal, measurements
//! measurement      date, temperature, kind, file, readings; residuals before, predicted, after
//! drives           compliance +- u, before
//! backlash         gap +- u, before
//! work             deviation, its uncertainty before and after each measurement
//! next             line, kind, joint positions
//! ```

use armill_core::units::from_um;
use armill_measure::journal::answer::{JournalAnswer, ParameterAnswer};
use armill_measure::journal::{Planned, Question, answer, learn, read, robot_file};
use armill_study::{StudyError, robots};

use crate::arguments::JournalArguments;
use crate::arguments::numbers::above_zero;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Reads, learns, writes the robot and prints the result.
///
/// # Errors
/// Invalid options; the problems of the journal or of a file; measurements of another robot; a file that cannot be written.
pub(crate) fn run(arguments: &JournalArguments) -> Result<Outcome, StudyError> {
    let u = |flag: &str, um: f64| Ok::<f64, StudyError>(from_um(above_zero(flag, um)?));
    let position_u = u("--position-u-um", arguments.position_u_um)?;
    let displacement_u = u("--displacement-u-um", arguments.displacement_u_um)?;
    let question = Question {
        work: arguments.work.clone(),
        planned: arguments.next.map(|count| Planned {
            count,
            candidates: arguments.candidates.clone(),
            position_u,
            displacement_u,
        }),
    };
    let measurements = read(&arguments.journal)?;
    let progress = Progress::of("measurements", measurements.campaigns.len());
    let learning = progress.watch(|watch| learn(&measurements, &question, watch))?;
    let answer = answer(&measurements, &learning);
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    if let Some(file) = &arguments.out {
        let [path, text] = robots::text_of(&measurements.robot_name, &measurements.robot)?;
        let written = robot_file([&path, &text], &measurements, &learning)?;
        let writer = arguments.writing.writer("journal");
        writer.for_new_files().write(file, written.as_bytes())?;
        say(&format!("robot after these measurements in {}", file.display()));
    }
    Ok(Outcome::Fine)
}

fn as_text(answer: &JournalAnswer) -> String {
    let count = answer.measurements.len();
    let plural = if count == 1 { "" } else { "s" };
    let mut lines = vec![format!(
        "{}: {}, {count} measurement{plural}",
        answer.robot, answer.file
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    lines.push(String::new());
    lines.push(
        "residuals over the stated uncertainty, rms             readings   before predicted    after"
            .to_owned(),
    );
    for one in &answer.measurements {
        let name = format!(
            "{} {} deg C {}: {}",
            one.date, one.temperature_c, one.kind, one.file
        );
        lines.push(format!(
            "{name:<54} {:>8} {:>8} {:>9} {:>8}",
            one.readings, one.before, one.predicted, one.after
        ));
    }
    for (name, parameters) in [("compliance", &answer.drives), ("backlash", &answer.backlash)] {
        if parameters.is_empty() {
            continue;
        }
        lines.push(String::new());
        lines.push(format!(
            "{name:<16} {:>12} {:>12}    before       u          from measurements",
            "value", "u"
        ));
        lines.extend(parameters.iter().map(parameter_text));
    }
    let geometry = &answer.geometry;
    lines.push(String::new());
    lines.push(format!(
        "geometry: {} of {} parameters mostly known from the measurements; largest {} mm, {} deg",
        geometry.determined, geometry.parameters, geometry.largest_mm, geometry.largest_deg
    ));
    if let Some(work) = &answer.work {
        let rounds: Vec<String> = work.uncertainty_um.iter().map(|u| format!("{u:.1}")).collect();
        lines.push(format!(
            "work: deviation {:.1} um rms; its uncertainty {} um (before, and after each measurement)",
            work.deviation_um,
            rounds.join(", ")
        ));
    }
    if !answer.next.is_empty() {
        lines.push(String::new());
        lines.push("next: line, kind, uncertainty at the work afterwards (um), joint positions".to_owned());
        for one in &answer.next {
            let joints: Vec<String> = one.joints.iter().map(f64::to_string).collect();
            lines.push(format!(
                "{:>10}  {:<9} {:>9.2}   {}",
                one.line,
                one.kind,
                one.uncertainty_um,
                joints.join(", ")
            ));
        }
    }
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

fn parameter_text(parameter: &ParameterAnswer) -> String {
    format!(
        "{:<16} {:>12.3e} {:>12.1e}    {:.2e} {:.0e}   {:>5.1} %  {}",
        parameter.joint,
        parameter.value,
        parameter.u,
        parameter.before,
        parameter.before_u,
        parameter.from_measurements_percent,
        parameter.unit
    )
}
