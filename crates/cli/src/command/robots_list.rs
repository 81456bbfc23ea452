//! `armill robots` without a name: the library, one line a robot.

use armill_core::robot::reach;
use armill_formats::robot::RobotDescription;
use armill_study::{StudyError, library, robots};
use serde_json::{Value, json};

use crate::Outcome;
use crate::terminal::print;

pub(crate) fn run(as_json: bool) -> Result<Outcome, StudyError> {
    let found = library::ROBOTS.iter().map(|entry| {
        let found = robots::find(entry.name, ".".as_ref())?;
        Ok((entry.name, found))
    });
    let found: Vec<(&str, RobotDescription)> = found.collect::<Result<_, StudyError>>()?;
    print(&if as_json {
        let rows = found.iter().map(|(name, found)| row_as_json(name, found));
        Value::from(rows.collect::<Vec<_>>()).to_string()
    } else {
        table(&found)
    })?;
    Ok(Outcome::Fine)
}

fn table(found: &[(&str, RobotDescription)]) -> String {
    let width = |text: fn(&(&str, RobotDescription)) -> usize| found.iter().map(text).max().unwrap_or(0);
    let (name_width, title_width) = (
        width(|(name, _)| name.len()),
        width(|(_, found)| found.title.chars().count()),
    );
    let line = |(name, found): &(&str, RobotDescription)| {
        let payload = found.payload_kg.map_or("-".to_owned(), |kg| format!("{kg} kg"));
        let reach = reach(&found.robot).map_or("-".to_owned(), |m| format!("{:.0} mm", m * 1e3));
        format!(
            "{name:name_width$}  {:title_width$}  {payload:>7}  {reach:>7}  inverse {:<3}  compliance {}",
            found.title,
            yes_or_no(found.robot.ortho_parallel().is_some()),
            if found.robot.compliance().is_some() {
                "known"
            } else {
                "not known"
            }
        )
    };
    found.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn yes_or_no(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}

fn row_as_json(name: &str, found: &RobotDescription) -> Value {
    json!({
        "name": name,
        "title": found.title,
        "payload_kg": found.payload_kg,
        "reach_mm": reach(&found.robot).map(|m| (m * 1e6).round() / 1e3),
        "inverse": found.robot.inverse().word(),
        "compliance": found.robot.compliance().is_some(),
    })
}
