//! `armill new`: a commented study that runs.

use armill_formats::file::{create_folder, write_atomically};
use armill_study::{ENOUGH_JOINTS, StudyError, library, robots};

use crate::Outcome;
use crate::arguments::NewArguments;
use crate::terminal::{print, say};

const TEMPLATE: &str = include_str!("new.toml");
const COMPLIANCE: &str = "
# No joint compliance is known for this robot. Put in what you measured; as long as it is a guess, leave
# assumed = true, and every result says so.
[compliance]
rad_per_n_m = [COMPLIANCES]
source = \"a guess\"
assumed = true
";

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
    // A guess for a mid-size arm, 1e6 N m/rad at every joint.
    let guess = vec!["1.0e-6"; found.robot.joints().len()].join(", ");
    let compliance = match found.robot.compliance() {
        Some(_) => String::new(),
        None => COMPLIANCE.replace("COMPLIANCES", &guess),
    };
    let robot = toml_string(&robot_for(&arguments.robot)?);
    let text = TEMPLATE
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
