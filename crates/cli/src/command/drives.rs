//! `armill drives`: friction, load, torsion and stiffness of drives from a log of motor encoders, torques and link encoders.
//!
//! ```text
//! joint   delay, compliance, stiffness, step at a reversal, with standard uncertainties; torsion before and after, rms
//! joint   Coulomb and viscous friction, inertia, with standard uncertainties; torque before and after, rms; load
//! ```

use armill_core::robot::Robot;
use armill_formats::measurement::joint_log::LogReadOptions;
use armill_measure::drives::answer::DriveAnswer;
use armill_measure::drives::motor::{LoadUnitAnswer, MotorAnswer};
use armill_measure::drives::{
    DrivesAnswer, DrivesQuestion, EstimateAnswer, MatlabNames, evaluate, picture, read, robot_file,
};
use armill_study::{StudyError, robots};

use super::drawing;
use crate::arguments::DrivesArguments;
use crate::arguments::numbers::{above_zero, within};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Greatest inertia of a rotor, kg m^2: far above that of any robot.
const MOST_INERTIA: f64 = 10.0;

/// Reads, fits, writes the robot and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of a log; a ratio for each joint is missing; nothing was found for a robot file.
pub(crate) fn run(arguments: &DrivesArguments) -> Result<Outcome, StudyError> {
    let found = match &arguments.robot {
        Some(name) => Some((name, robots::find(name, ".".as_ref())?)),
        None => None,
    };
    let robot = found.as_ref().map(|(_, found)| found.robot.clone());
    let question = question(arguments, robot)?;
    let log = read(&arguments.log, &question)?;
    question.check(log.joints.len())?;
    let compared = match &arguments.compare {
        Some(other) => Some(read(other, &question)?),
        None => None,
    };
    if let Some(compared) = &compared {
        question.check(compared.joints.len())?;
    }
    let evaluated = evaluate(&log, compared.as_ref(), &question);
    if let Some(file) = &arguments.drawing {
        let writer = arguments.writing.writer("drives").for_new_files();
        drawing::write(&writer, file, &picture(&evaluated).to_svg())?;
    }
    let answer = evaluated.answer;
    if let (Some(file), Some((name, found))) = (&arguments.out, &found) {
        let [path, text] = robots::text_of(name, found)?;
        let written = robot_file(&found.robot, [&path, &text], &answer)?;
        let writer = arguments.writing.writer("drives").for_new_files();
        writer.write(file, written.as_bytes())?;
        say(&format!("robot with these values in {}", file.display()));
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn question(arguments: &DrivesArguments, robot: Option<Robot>) -> Result<DrivesQuestion, StudyError> {
    let names = match &arguments.names {
        Some(names) => Some(MatlabNames::of(names).ok_or_else(|| {
            StudyError::value(
                format!("--names: {} names", names.len()),
                "four: those of time, motor, link and torque; three without link encoders",
            )
        })?),
        None => None,
    };
    Ok(DrivesQuestion {
        units: LogReadOptions {
            time: arguments.time_unit.map(Into::into),
            angle: arguments.angle_unit.map(Into::into),
        },
        names,
        ratios: arguments
            .gear
            .iter()
            .map(|ratio| above_zero("--gear", *ratio))
            .collect::<Result<_, _>>()?,
        rotor_inertias: arguments
            .rotor_inertia
            .iter()
            .map(|inertia| within("--rotor-inertia", *inertia, [0.0, MOST_INERTIA]))
            .collect::<Result<_, _>>()?,
        robot,
    })
}

fn as_text(answer: &DrivesAnswer) -> String {
    let mut lines = vec![format!(
        "{}: {} instants, {:.1} s",
        answer.file, answer.samples, answer.duration_s
    )];
    if !answer.joints.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:<6} {:>18} {:>24} {:>26} {:>20} {:>20}",
            "joint", "delay", "compliance", "stiffness at the joint", "step at reversal", "torsion, rms"
        ));
    }
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
    if !answer.motors.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:<6} {:>20} {:>28} {:>24} {:>20}",
            "joint", "Coulomb friction", "viscous friction", "inertia", "torque, rms"
        ));
        lines.extend(answer.motors.iter().map(motor_text));
        for motor in &answer.motors {
            lines.extend(load_texts(motor, answer.compared.as_deref()));
        }
    }
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn motor_text(motor: &MotorAnswer) -> String {
    format!(
        "{:<6} {:>20} {:>28} {:>24} {:>20}",
        motor.joint,
        shown(motor.coulomb_nm, 3, "N m"),
        shown(motor.viscous_nm_s_per_rad, 3, "N m s/rad"),
        shown(motor.inertia_kg_m2, 3, "kg m2"),
        format!("{:.2} -> {:.2} N m", motor.before_rms_nm, motor.after_rms_nm),
    )
}

fn load_texts(motor: &MotorAnswer, compared: Option<&str>) -> Vec<String> {
    let loads = motor.loads.iter().map(|load| {
        let (unit, decimals) = match load.unit {
            LoadUnitAnswer::Torque => ("N m", 3),
            LoadUnitAnswer::PerTorque => ("N m per N m at the joint", 6),
        };
        format!(
            "load, {}: {}",
            load.name,
            shown(Some(load.coefficient), decimals, unit)
        )
    });
    let constant = motor
        .constant_nm
        .map(|constant| format!("constant part: {}", shown(Some(constant), 3, "N m")));
    let prediction = motor.compared_rms_nm.zip(compared).map(|([before, after, own], file)| {
        format!("{file}: {before:.2} N m, less the prediction {after:.2} N m, with a constant part of its own {own:.2} N m (rms)")
    });
    loads
        .chain(constant)
        .chain(prediction)
        .map(|text| format!("joint {}: {text}", motor.joint))
        .collect()
}

fn shown(estimate: Option<EstimateAnswer>, decimals: usize, unit: &str) -> String {
    estimate.map_or_else(
        || "-".to_owned(),
        |estimate| format!("{} {unit}", plus_minus(estimate, decimals)),
    )
}

fn joint_text(joint: &DriveAnswer) -> String {
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
