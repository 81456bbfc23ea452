//! `armill receptance`: receptance at the tip of a tool, from the modes of an arm and beams of holder and cutter.
//!
//! ```text
//! direction    static stiffness, least dynamic stiffness, its frequency
//! mode         frequency, damping, modal mass, stiffness, direction
//! ```

use std::f64::consts::TAU;
use std::path::PathBuf;

use armill_core::dynamics::coupling::Frequencies;
use armill_core::nalgebra::Rotation3;
use armill_core::units::from_deg;
use armill_study::StudyError;
use armill_study::input::quantities::pose_mm_deg;
use armill_study::receptance::answer::{DirectionAnswer, TipModeAnswer};
use armill_study::receptance::evaluate::feed_from_nose;
use armill_study::receptance::machine::measured_in;
use armill_study::receptance::{
    ArmAtNose, Machine, Question, ReceptanceAnswer, answer, assembly_of, evaluate, modal_file, picture, table,
};

use super::drawing;
use super::pose_subject::{PoseSubject, with_compliances};
use crate::arguments::ReceptanceArguments;
use crate::arguments::numbers::{above_zero, finite, three_or_six, within};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Lowest and highest frequency, Hz, and their number, if not given.
const FREQUENCIES: [f64; 3] = [5.0, 5000.0, 400.0];
/// Highest frequency, Hz.
const HIGHEST_HZ: f64 = 1e5;
/// Fewest and most frequencies.
const COUNTS: [f64; 2] = [50.0, 5000.0];
/// Where the assembly may be attached.
const BASES: &str =
    "give a robot with --joints-deg, --modes FILE with modal data of the spindle nose, or --rigid";

/// Reads, evaluates, writes the requested files and prints the result.
///
/// # Errors
/// Invalid options; problems of a file; an arm without compliances or masses; a file that cannot be written.
pub(crate) fn run(arguments: &ReceptanceArguments) -> Result<Outcome, StudyError> {
    let frequencies = frequencies(arguments.frequencies_hz.as_deref())?;
    finite("--feed-deg", &[arguments.feed_deg])?;
    let feed_from_nose = feed_from_nose(from_deg(arguments.feed_deg));
    let assembly = assembly_of(&arguments.assembly)?;
    let question = Question {
        machine: machine(arguments, &feed_from_nose)?,
        assembly,
        frequencies,
        feed_from_nose,
    };
    let answer = answer(&question, &evaluate(&question)?);
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    if let Some(file) = &arguments.out {
        files.push((file.clone(), table(&answer).into_bytes()));
    }
    if let Some(file) = &arguments.modal_out {
        let text = modal_file(&file.display().to_string(), &answer)?;
        files.push((file.clone(), text.into_bytes()));
    }
    if let Some(file) = &arguments.drawing {
        files.push((file.clone(), drawing::bytes(file, &picture(&answer).to_svg())?));
    }
    let bytes: Vec<(PathBuf, &[u8])> = files
        .iter()
        .map(|(file, bytes)| (file.clone(), &bytes[..]))
        .collect();
    arguments
        .writing
        .writer("receptance")
        .for_new_files()
        .write_all(&bytes)?;
    for (what, file) in [
        ("table", &arguments.out),
        ("modes", &arguments.modal_out),
        ("drawing", &arguments.drawing),
    ] {
        if let Some(file) = file {
            say(&format!("{what} in {}", file.display()));
        }
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn frequencies(given: Option<&[f64]>) -> Result<Frequencies, StudyError> {
    let flag = "--frequencies-hz";
    let [low, high, count] = match given {
        None => FREQUENCIES,
        Some(&[low, high]) => [low, high, FREQUENCIES[2]],
        Some(&[low, high, count]) => [low, high, count],
        Some(values) => {
            return Err(StudyError::value(
                format!("{flag}: {} numbers", values.len()),
                "the lowest and the highest frequency, and how many: 5,5000,400",
            ));
        }
    };
    finite(flag, &[low, high, count])?;
    above_zero(flag, low)?;
    within(flag, high, [low, HIGHEST_HZ])?;
    within(flag, count, COUNTS)?;
    if low == high {
        let message = format!("{flag}: {low} to {high} is no range");
        return Err(StudyError::value(message, "such as 5,5000"));
    }
    Ok(Frequencies {
        low: low * TAU,
        high: high * TAU,
        // unit: none, a count within 50 to 5000
        count: count as usize,
    })
}

/// What the assembly is attached to.
fn machine(arguments: &ReceptanceArguments, feed_from_nose: &Rotation3<f64>) -> Result<Machine, StudyError> {
    if arguments.rigid && arguments.modes.is_none() {
        return Ok(Machine::rigid());
    }
    if let Some(file) = &arguments.modes {
        return measured_in(file, feed_from_nose);
    }
    let Some(name) = &arguments.robot else {
        return Err(StudyError::value("the spindle nose is not known", BASES));
    };
    let Some(joints_deg) = arguments.joints_deg.clone() else {
        return Err(StudyError::value(
            format!("the posture of {name} is not known"),
            "give --joints-deg",
        ));
    };
    finite("--joints-deg", &joints_deg)?;
    let mut subject = PoseSubject::named(name)?;
    let caution = with_compliances(
        arguments.compliance_rad_per_n_m.as_deref(),
        arguments.compliance_class.as_deref(),
        subject.robot(),
    )?;
    if matches!(subject, PoseSubject::Study(_)) && arguments.nose_mm.is_none() {
        return Err(StudyError::value(
            format!("the spindle nose of {name} is not known: its tool gives the TCP only"),
            "give --nose-mm, flange to spindle nose",
        ));
    }
    let arm = ArmAtNose {
        joints_deg,
        flange_from_nose: pose_mm_deg(&three_or_six("--nose-mm", arguments.nose_mm.as_deref())?),
        damping_ratio: arguments.damping_ratio,
        caution,
    };
    match &subject {
        PoseSubject::Robot(robot) => Machine::arm(robot, &arm),
        PoseSubject::Study(study) => Machine::arm_of_study(study, &arm),
    }
}

fn as_text(answer: &ReceptanceAnswer) -> String {
    let mut lines = vec![
        format!("{} on {}", answer.assembly, answer.machine),
        String::new(),
        format!(
            "{:<9}  {:>16}  {:>23}  {:>10}  {:>26}",
            "direction", "static stiffness", "least dynamic stiffness", "at", "spindle nose, least dynamic"
        ),
    ];
    lines.extend(answer.directions.iter().map(direction_text));
    lines.push(String::new());
    lines.push(format!(
        "{:>10}  {:>9}  {:>11}  {:>13}  tip moves along",
        "frequency", "damping", "modal mass", "stiffness"
    ));
    lines.extend(answer.modes.iter().map(mode_text));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn direction_text(own: &DirectionAnswer) -> String {
    let stiffness = |value: f64| format!("{value:.3} N/um");
    let nose = own
        .nose_least_dynamic_stiffness_n_per_um
        .map_or_else(|| "-".to_owned(), stiffness);
    format!(
        "{:<9}  {:>16}  {:>23}  {:>10}  {nose:>26}",
        own.direction,
        stiffness(own.static_stiffness_n_per_um),
        stiffness(own.least_dynamic_stiffness_n_per_um),
        format!("{:.1} Hz", own.at_frequency_hz)
    )
}

fn mode_text(own: &TipModeAnswer) -> String {
    let [x, y, z] = own.direction;
    format!(
        "{:>10}  {:>9}  {:>11}  {:>13}  ({x:.3}, {y:.3}, {z:.3})",
        format!("{:.1} Hz", own.frequency_hz),
        format!("{:.3} %", own.damping_percent),
        format!("{:.4} kg", own.modal_mass_kg),
        format!("{:.3} N/um", own.stiffness_n_per_um)
    )
}
