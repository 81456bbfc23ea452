//! `armill drives`: delay, torsion and stiffness of drives from a log of both encoders.
//!
//! ```text
//! joint   delay, compliance, stiffness, step at a reversal, with standard uncertainties; torsion before and after, rms
//! ```

use armill_formats::measurement::joint_log::LogReadOptions;
use armill_measure::drives::answer::{DriveAnswer, EstimateAnswer};
use armill_measure::drives::{DrivesAnswer, DrivesQuestion, MatlabNames, evaluate, picture, read};
use armill_study::StudyError;

use super::drawing;
use crate::arguments::DrivesArguments;
use crate::arguments::numbers::above_zero;
use crate::outcome::Outcome;
use crate::terminal::print;

/// Reads, fits and prints the result.
///
/// # Errors
/// Invalid options; the problems of a log; a ratio for each joint is missing.
pub(crate) fn run(arguments: &DrivesArguments) -> Result<Outcome, StudyError> {
    let question = question(arguments)?;
    let log = read(&arguments.log, &question)?;
    let joints = log.joints.len();
    if !question.ratios.is_empty() && question.ratios.len() != joints {
        return Err(StudyError::value(
            format!(
                "--gear: {} ratios, but the log has {joints} joints",
                question.ratios.len()
            ),
            "one for each joint, such as 257,267,252",
        ));
    }
    let compared = match &arguments.compare {
        Some(other) => Some(read(other, &question)?),
        None => None,
    };
    let evaluated = evaluate(&log, compared.as_ref(), &question);
    if let Some(file) = &arguments.drawing {
        let writer = arguments.writing.writer("drives").for_new_files();
        drawing::write(&writer, file, &picture(&evaluated).to_svg())?;
    }
    let answer = evaluated.answer;
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn question(arguments: &DrivesArguments) -> Result<DrivesQuestion, StudyError> {
    let names = arguments
        .names
        .clone()
        .map(<[String; 4]>::try_from)
        .transpose()
        .map_err(|names| {
            StudyError::value(
                format!("--names: {} names", names.len()),
                "four: those of time, motor, link and torque",
            )
        })?;
    Ok(DrivesQuestion {
        units: LogReadOptions {
            time: arguments.time_unit.map(Into::into),
            angle: arguments.angle_unit.map(Into::into),
        },
        names: names.map(|paths| MatlabNames { paths }),
        ratios: arguments
            .gear
            .iter()
            .map(|ratio| above_zero("--gear", *ratio))
            .collect::<Result<_, _>>()?,
    })
}

fn as_text(answer: &DrivesAnswer) -> String {
    let mut lines = vec![
        format!(
            "{}: {} instants, {:.1} s",
            answer.file, answer.samples, answer.duration_s
        ),
        String::new(),
        format!(
            "{:<6} {:>18} {:>24} {:>26} {:>20} {:>20}",
            "joint", "delay", "compliance", "stiffness at the joint", "step at reversal", "torsion, rms"
        ),
    ];
    lines.extend(answer.joints.iter().map(joint_text));
    for joint in &answer.joints {
        let extra = [
            joint.lost_motion_urad.map(|width| format!("lost motion of at least {width:.1} urad")),
            joint.friction_nm.map(|friction| format!("friction between motor and gear of at least {friction:.2} N m")),
            joint.compared_rms_urad.zip(answer.compared.as_ref()).map(|([before, after, own], file)| {
                format!("{file}: {before:.1} urad, less the prediction {after:.1} urad, with an offset of its own {own:.1} urad (rms)")
            }),
        ];
        lines.extend(
            extra
                .into_iter()
                .flatten()
                .map(|text| format!("joint {}: {text}", joint.joint)),
        );
        for (index, error) in joint
            .transmission_error_urad
            .iter()
            .enumerate()
            .filter(|(_, error)| error.found)
        {
            lines.push(format!(
                "joint {}: transmission error of order {} of the motor: {} urad",
                joint.joint,
                index + 1,
                plus_minus(*error, 1)
            ));
        }
    }
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn joint_text(joint: &DriveAnswer) -> String {
    let shown = |estimate: Option<EstimateAnswer>, decimals: usize, unit: &str| match estimate {
        Some(estimate) => format!("{} {unit}", plus_minus(estimate, decimals)),
        None => "-".to_owned(),
    };
    let stiffness = joint.stiffness_nm_per_rad.map_or_else(
        || "-".to_owned(),
        |stiffness| format!("{:.3e} +- {:.1e} N m/rad", stiffness.value, stiffness.u),
    );
    format!(
        "{:<6} {:>18} {:>24} {:>26} {:>20} {:>20}",
        joint.joint,
        shown(joint.delay_ms, 2, "ms"),
        shown(joint.compliance_urad_per_nm, 2, "urad/(N m)"),
        stiffness,
        shown(joint.reversal_urad, 1, "urad"),
        format!("{:.1} -> {:.1} urad", joint.before_rms_urad, joint.after_rms_urad),
    )
}

fn plus_minus(estimate: EstimateAnswer, decimals: usize) -> String {
    format!("{:.decimals$} +- {:.decimals$}", estimate.value, estimate.u)
}
