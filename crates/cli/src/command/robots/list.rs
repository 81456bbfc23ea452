//! `armill robots` without a name: the library, one line per robot, or a list of [`RobotRow`].

use armill_study::StudyError;
use armill_study::robot_answers::{RobotRow, library_rows};

use crate::arguments::RobotsArguments;
use crate::outcome::Outcome;
use crate::terminal::{Align, columns, print};

/// Prints the library; all its robots are read for this.
///
/// # Errors
/// Stdout cannot be written.
pub(super) fn run(arguments: &RobotsArguments) -> Result<Outcome, StudyError> {
    let rows = library_rows()?;
    print(&if arguments.json {
        serde_json::to_string(&rows)?
    } else {
        table(&rows)
    })?;
    Ok(Outcome::Fine)
}

/// One line per robot; a dash for an unknown payload or reach.
fn table(rows: &[RobotRow]) -> String {
    let cells = |row: &RobotRow| {
        let known = if row.compliance_known {
            "known"
        } else {
            "not known"
        };
        vec![
            row.name.clone(),
            row.title.clone(),
            row.payload_kg.map_or("-".to_owned(), |kg| format!("{kg} kg")),
            row.reach_mm.map_or("-".to_owned(), |mm| format!("{mm:.0} mm")),
            format!("inverse {}", row.inverse.replace('_', " ")),
            format!("compliance {known}"),
        ]
    };
    let cells: Vec<Vec<String>> = rows.iter().map(cells).collect();
    let aligned = [
        Align::Left,
        Align::Left,
        Align::Right,
        Align::Right,
        Align::Left,
        Align::Left,
    ];
    columns(&cells, &aligned).join("\n")
}
