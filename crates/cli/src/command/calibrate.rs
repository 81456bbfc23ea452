//! `armill calibrate`: the geometry of one robot from measured poses.
//!
//! Stdout has a [`CalibrateAnswer`], as text or JSON; `--out` receives the robot with the identified corrections,
//! `--residuals` the residual of every pose, `--drawing` a picture of them.
//!
//! ```text
//! robot: file, poses, parameters
//! errors            mean   rms   max             before and after; of the training poses and the validation poses
//! parameter         value +- standard uncertainty
//! not separable     parameters with the same effect
//! base, point                                    their identified frames
//! ```

use armill_core::calibrate::{ParameterSet, Prior};
use armill_core::units::{from_deg, from_mm};
use armill_formats::measurement::poses::PoseReadOptions;
use armill_measure::calibrate::answer::ParameterAnswer;
use armill_measure::calibrate::{
    CalibrateAnswer, SetAnswer, ValidationPoses, answer, calibrate, drawing, read, residuals, robot_file,
};
use armill_study::{StudyError, robots};

use super::poses::{errors_head, errors_text, frames_text, question};
use crate::arguments::numbers::above_zero;
use crate::arguments::{CalibrateArguments, UnknownsArgument};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads, calibrates, writes the requested files and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of a file; poses that determine too little; a file that cannot be
/// written.
pub(crate) fn run(arguments: &CalibrateArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let requested = match arguments.unknowns {
        UnknownsArgument::Geometry => ParameterSet::Geometry,
        UnknownsArgument::Zeros => ParameterSet::Zeros,
    };
    let (mut question, given) = question(&arguments.poses, requested)?;
    question.prior = prior(arguments)?;
    let validation = validation(arguments, &given)?;
    let shown = arguments.poses_file.display().to_string();
    let measured = read(&shown, &arguments.poses_file, &found.robot, &given, &question)?;
    let calibration = calibrate(&found.robot, &shown, &measured, &question, &validation)?;
    let answer = answer(&found.robot, &calibration, &question);
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    if let Some(slip) = &answer.slip {
        say(&format!(
            "warning: the calibration is not usable: {}",
            slip.sentence()
        ));
    }
    let writer = arguments.writing.writer("calibrate");
    if let Some(file) = &arguments.out {
        calibration.check_usable()?;
        let [path, text] = robots::text_of(&arguments.robot, &found)?;
        let written = robot_file(&found.robot, [&path, &text], &calibration)?;
        writer.clone().for_new_files().write(file, written.as_bytes())?;
        say(&format!("calibrated robot in {}", file.display()));
    }
    if let Some(file) = &arguments.residuals {
        writer.write(file, residuals(&calibration).as_bytes())?;
        say(&format!("residuals in {}", file.display()));
    }
    if let Some(file) = &arguments.drawing {
        super::drawing::write(&writer, file, &drawing(&answer, &calibration))?;
    }
    Ok(Outcome::Fine)
}

/// Prior standard deviations of the corrections, from the options.
fn prior(arguments: &CalibrateArguments) -> Result<Option<Prior>, StudyError> {
    let Some((mm, deg)) = arguments.prior_mm.zip(arguments.prior_deg) else {
        return Ok(None);
    };
    Ok(Some(Prior {
        length: from_mm(above_zero("--prior-mm", mm)?),
        angle: from_deg(above_zero("--prior-deg", deg)?),
    }))
}

/// A number is a fraction of the file, any other text another file.
fn validation(
    arguments: &CalibrateArguments,
    given: &PoseReadOptions,
) -> Result<ValidationPoses, StudyError> {
    let Some(text) = &arguments.validation else {
        return Ok(ValidationPoses::Nothing);
    };
    match text.parse::<f64>() {
        Err(_) => Ok(ValidationPoses::File {
            path: text.into(),
            given: given.clone(),
            same_set_up: arguments.same_set_up,
        }),
        Ok(part) if arguments.same_set_up => Err(StudyError::value(
            format!(
                "--same-set-up: the fraction {part} is of the same file and therefore of the same set-up"
            ),
            "use it with a file of other poses",
        )),
        Ok(part) if part > 0.0 && part < 1.0 => Ok(ValidationPoses::Fraction(part)),
        Ok(part) => Err(StudyError::value(
            format!("--validation: {part} is not between 0 and 1"),
            "a fraction such as 0.2, or a file of other poses",
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
            "prior {} mm and {} deg; effective number of parameters, base and point included: {:.1}",
            prior.length_mm, prior.angle_deg, answer.effective_parameters
        )
    }));
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    if answer.not_measured > 0 {
        lines.push(format!("rows without a measured point: {}", answer.not_measured));
    }
    let mut set = |name: &str, set: &SetAnswer| {
        lines.push(String::new());
        lines.push(errors_head(&format!("{name}, {}", set.poses)));
        lines.push(errors_text("before", &set.before));
        lines.push(errors_text("after", &set.after));
        let outliers = set.worst.iter().filter(|pose| pose.is_outlier);
        lines.extend(outliers.map(|pose| {
            format!(
                "outlier                line {} of {}: {:.3} mm",
                pose.line, set.file, pose.error_mm
            )
        }));
    };
    set("training", training);
    if let Some(validation) = &answer.validation {
        set("validation", validation);
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
                [] => format!("no effect       {}: not determined by any pose", redundant.name),
                [one] => format!("not separable   {}: same effect as {one}", redundant.name),
                same => format!(
                    "not separable   {}: same effect as {} together",
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
