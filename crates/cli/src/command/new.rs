//! `armill new`: a commented study that runs.

use armill_core::robot::forward::forward;
use armill_core::robot::{Robot, reach};
use armill_formats::file::{create_folder, write_atomically};
use armill_study::{ComplianceClass, ENOUGH_JOINTS, StudyError, library, robots};

use crate::Outcome;
use crate::arguments::NewArguments;
use crate::terminal::{print, say};

const TEMPLATE: &str = include_str!("new.toml");
const COMPLIANCE: &str = "
# No joint compliance is known for this robot. These are values of a class of arms, assumed and wide: light (up to
# 20 kg payload), medium (to 100 kg), heavy (to 300 kg); every result says so. Once you know yours from load tests:
# rad_per_n_m = [...], one a joint, u_rad_per_n_m = [...], source = \"...\".
[compliance]
class = \"CLASS\"
";

/// Reach of the arm that the plate of the template fits, m: Yaskawa MH12.
const REACH_OF_TEMPLATE: f64 = 1.44;
/// Height of its second axis, mm.
const SHOULDER_OF_TEMPLATE: f64 = 450.0;

pub(crate) fn run(arguments: &NewArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let joints = found.robot.joints().len();
    if joints < ENOUGH_JOINTS {
        let message = format!(
            "robot `{}` has {joints} joints: no study of it would run",
            arguments.robot
        );
        return Err(StudyError::value(
            message,
            "`armill pose` takes its joints; `armill robots` lists robots for studies",
        ));
    }
    let path = arguments.dir.join("study.toml");
    if path.exists() {
        let message = format!("{} exists already", path.display());
        return Err(StudyError::value(
            message,
            "choose another folder: armill never overwrites a study",
        ));
    }
    let class = found
        .payload_kg
        .map_or(ComplianceClass::Medium, ComplianceClass::of_payload);
    let compliance = match found.robot.compliance() {
        Some(_) => String::new(),
        None => COMPLIANCE.replace("CLASS", class.name()),
    };
    let robot = toml_string(&robot_for(&arguments.robot)?);
    let text = scaled(&found.robot)
        .replace("\"ROBOT\"", &robot)
        .replace("# COMPLIANCE\n", &compliance);
    create_folder(&arguments.dir)?;
    write_atomically(&path, text.as_bytes())?;
    let shown = path.display().to_string();
    if arguments.json {
        print(&serde_json::json!({ "study": shown }).to_string())?;
    }
    say(&format!(
        "made {shown}; edit it, then: armill run {}",
        arguments.dir.display()
    ));
    Ok(Outcome::Fine)
}

/// The template with its plate in the same place of the working range of `robot`.
fn scaled(robot: &Robot) -> String {
    let factor = reach(robot).unwrap_or(REACH_OF_TEMPLATE) / REACH_OF_TEMPLATE;
    let scaled = |mm: f64, step: f64| (mm * factor / step).round().max(1.0) * step;
    let shoulder = forward(robot, &vec![0.0; robot.joints().len()]).origin(1).z * 1e3;
    // An arm with a low shoulder does not get as high as it gets far.
    let height = (800.0 * factor).min(shoulder + (800.0 - SHOULDER_OF_TEMPLATE) * factor);
    let [x, half] = [scaled(1000.0, 50.0), scaled(200.0, 20.0)];
    let z = (height / 50.0).round().max(1.0) * 50.0;
    let distances =
        [-200.0, -100.0, 0.0, 100.0].map(|mm| (x + (mm * factor / 10.0).round() * 10.0).to_string());
    TEMPLATE
        .replace("CENTRE", &format!("{x}, 0, {z}"))
        .replace("HALF_SIZE", &half.to_string())
        .replace("STEP", &(half / 10.0).to_string())
        .replace("DISTANCES", &distances.join(", "))
        .replace("RADIUS", &(half / 2.0).to_string())
}

/// The robot as the study names it: paths there count from its folder, not from the current one.
fn robot_for(given: &str) -> Result<String, StudyError> {
    if library::robot(given).is_some() {
        return Ok(given.to_owned());
    }
    let path = std::path::absolute(given).map_err(|error| {
        StudyError::value(
            format!("cannot tell where {given} is: {error}"),
            "give its whole path",
        )
    })?;
    Ok(path.display().to_string())
}

/// A TOML basic string.
fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
