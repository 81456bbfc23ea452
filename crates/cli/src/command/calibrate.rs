//! `armill calibrate`: the geometry of this very arm from measured poses.
//!
//! Stdout holds a [`CalibrateAnswer`], in words or as JSON; `--out` takes the robot with the small motions that were found,
//! `--residuals` what is left at every pose, `--drawing` a picture of it.
//!
//! ```text
//! robot: file, poses, parameters
//! errors            mean   rms   max             before and after; of the poses that it was found from, and held out
//! parameter         value +- standard uncertainty
//! not told          what does the same
//! base, point                                    where they were found
//! ```

use armill_core::calibrate::{Asked, Prior};
use armill_study::calibrate::answer::ParameterAnswer;
use armill_study::calibrate::{
    CalibrateAnswer, HoldOut, SetAnswer, answer, calibrate, drawing, read, residuals, robot_file,
};
use armill_study::{StudyError, robots};

use super::numbers::above_zero;
use super::poses::{errors_head, errors_text, frames_text, question};
use crate::Outcome;
use crate::arguments::{CalibrateArguments, UnknownsArgument};
use crate::terminal::{print, say};

/// Reads, calibrates, writes what was asked for and prints.
///
/// # Errors
/// No such robot; options that cannot be; the problems of a file; poses that tell too little; a file that cannot be
/// written.
pub(crate) fn run(arguments: &CalibrateArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let requested = match arguments.unknowns {
        UnknownsArgument::Geometry => Asked::Geometry,
        UnknownsArgument::Zeros => Asked::Zeros,
    };
    let (mut question, given) = question(&arguments.poses, requested)?;
    question.prior = prior(arguments)?;
    let hold_out = hold_out(arguments)?;
    let shown = arguments.poses_file.display().to_string();
    let measured = read((&shown, &arguments.poses_file), &found.robot, &given, &question)?;
    let calibration = calibrate(&found.robot, (&shown, &measured), &question, (&hold_out, &given))?;
    let answer = answer(&found.robot, &calibration, &question);
    let writer = arguments.writing.writer("calibrate");
    if let Some(file) = &arguments.out {
        let [path, text] = robots::text_of(&arguments.robot, &found)?;
        let written = robot_file(&found.robot, [&path, &text], &calibration)?;
        writer.write(file, written.as_bytes())?;
        say(&format!("calibrated robot in {}", file.display()));
    }
    if let Some(file) = &arguments.residuals {
        writer.write(file, residuals(&calibration).as_bytes())?;
        say(&format!("residuals in {}", file.display()));
    }
    if let Some(file) = &arguments.drawing {
        super::drawing::write(&writer, file, &drawing(&answer, &calibration))?;
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

/// How far small motions of the chain are from zero, as the options tell it.
fn prior(arguments: &CalibrateArguments) -> Result<Option<Prior>, StudyError> {
    let Some((mm, deg)) = arguments.prior_mm.zip(arguments.prior_deg) else {
        return Ok(None);
    };
    Ok(Some(Prior {
        length: above_zero("--prior-mm", mm)? * 1e-3,
        angle: above_zero("--prior-deg", deg)?.to_radians(),
    }))
}

/// A number is a part of the file, all else another file.
fn hold_out(arguments: &CalibrateArguments) -> Result<HoldOut, StudyError> {
    let Some(text) = &arguments.hold_out else {
        return Ok(HoldOut::Nothing);
    };
    match text.parse::<f64>() {
        Err(_) => Ok(HoldOut::File {
            path: text.into(),
            same_set_up: arguments.same_set_up,
        }),
        Ok(part) if arguments.same_set_up => Err(StudyError::value(
            format!("--same-set-up: the part {part} is of the same file, and so of the same set-up"),
            "it goes with a file of other poses",
        )),
        Ok(part) if part > 0.0 && part < 1.0 => Ok(HoldOut::Fraction(part)),
        Ok(part) => Err(StudyError::value(
            format!("--hold-out: {part} is not between 0 and 1"),
            "a part such as 0.2, or a file of other poses",
        )),
    }
}

fn as_text(answer: &CalibrateAnswer) -> String {
    let training = &answer.training;
    let mut lines = vec![format!(
        "{}: {}, {} poses, {} parameters of the chain",
        answer.robot,
        training.file,
        training.poses,
        answer.parameters.len()
    )];
    lines.extend(answer.prior.as_ref().map(|prior| {
        format!(
            "prior {} mm and {} deg; of parameters, base and point the poses tell {:.1}",
            prior.length_mm, prior.angle_deg, answer.effective_parameters
        )
    }));
    if !answer.unused.is_empty() {
        lines.push(format!("passed over: {}", answer.unused.join(", ")));
    }
    if answer.not_measured > 0 {
        lines.push(format!("rows without a measured point: {}", answer.not_measured));
    }
    let mut set = |name: &str, set: &SetAnswer| {
        lines.push(String::new());
        lines.push(errors_head(&format!("{name}, {}", set.poses)));
        lines.push(errors_text("before", &set.before));
        lines.push(errors_text("after", &set.after));
        let standing_out = set.worst.iter().filter(|pose| pose.stands_out);
        lines.extend(standing_out.map(|pose| {
            format!(
                "stands out             line {} of {}: {:.3} mm",
                pose.line, set.file, pose.error_mm
            )
        }));
    };
    set("found from", training);
    if let Some(held_out) = &answer.held_out {
        set("held out", held_out);
    }
    lines.push(String::new());
    lines.push(format!(
        "{:<16} {:>10}    standard uncertainty",
        "after joint", "value"
    ));
    lines.extend(answer.parameters.iter().map(parameter_text));
    lines.push(String::new());
    lines.extend(
        answer
            .not_identifiable
            .iter()
            .map(|redundant| match &redundant.same_as[..] {
                [] => format!("not seen        {}: no pose shows it", redundant.name),
                [one] => format!("not told apart  {}: {one} does the same", redundant.name),
                same => format!(
                    "not told apart  {}: {} together do the same",
                    redundant.name,
                    same.join(", ")
                ),
            }),
    );
    lines.push(String::new());
    lines.extend(frames_text(&answer.tracker_from_base, &answer.flange_from_point));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

fn parameter_text(parameter: &ParameterAnswer) -> String {
    let zero = if parameter.zero { "   zero" } else { "" };
    let (value, u, unit) = match (parameter.value_mm, parameter.u_mm) {
        (Some(value), Some(u)) => (value, u, "mm"),
        _ => (
            parameter.value_deg.unwrap_or_default(),
            parameter.u_deg.unwrap_or_default(),
            "deg",
        ),
    };
    format!("{:<16} {value:>10.4} {unit:<3} +- {u:.4}{zero}", parameter.name)
}
