//! `armill robots masses`: masses of the links, estimated from the mass of the arm, as tables of a robot file.
//!
//! The tables go to `--out`, or to stdout; with `--json` stdout has an [`EstimatedLinksAnswer`](armill_study::estimated_links::EstimatedLinksAnswer).

use armill_formats::robot::armill;
use armill_study::StudyError;
use armill_study::estimated_links::{ArmMass, EstimatedLinks};

use super::tables::TablesOutput;
use crate::arguments::MassesArguments;
use crate::outcome::Outcome;

/// Estimates the masses, and writes the tables.
///
/// # Errors
/// A file that must not be replaced; the problems of the robot; a robot without bodies; a file that cannot be written.
pub(super) fn run(arguments: &MassesArguments) -> Result<Outcome, StudyError> {
    let found = EstimatedLinks::of(
        &arguments.robot,
        ArmMass {
            total_kg: arguments.total_kg,
            total_u_percent: arguments.total_u_percent,
        },
    )?;
    let text = armill::mass_tables(&found.robot);
    let links = found.robot.robot.structure().masses.len();
    TablesOutput {
        command: "robots masses",
        file: arguments.out.as_ref(),
        writing: &arguments.writing,
        json: arguments.json,
    }
    .write(
        &text,
        |file| found.answer(file, &text),
        &format!("{}: masses of {links} links", found.robot.title),
    )?;
    Ok(Outcome::Fine)
}
